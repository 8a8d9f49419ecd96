// SPDX-License-Identifier: MIT
// The structures that a command is about.
#include "cli/input.h"

#include <cstdio>

#include "cli/area_tables.h"
#include "cli/clock.h"
#include "cli/exit_code.h"
#include "cli/water_hint.h"
#include "io/radii.h"

namespace quickses::cli {

io::StructureFile load(const std::string &path, const io::ReadOptions &read, const ComputeOptions &options,
                       bool quiet) {
  io::StructureFile file = io::read_structure(path, read);
  if (io::has_own_radii(file.format) && options.radii_given)
    throw Failure(kUsage, "--radii: '" + path + "' has radii of its own");
  io::assign_radii(file, options.radii_given ? options.radii : "");
  if (!quiet)
    for (const std::string &warning : file.warnings) std::fprintf(stderr, "quickses: warning: %s\n", warning.c_str());
  return file;
}

Input::Input(const Options &given, bool quiet) : options(given) {
  const auto start = Clock::now();
  file = load(options.input, options.read, options.compute, quiet);
  read_ms = ms_since(start);
  if (io::has_own_radii(file.format)) options.compute.radii = "file";
  if (!quiet) hint_at_water(options, file.models.front());
  for (const io::Structure &structure : file.models) check_has_residues(options, structure);
}

}  // namespace quickses::cli
