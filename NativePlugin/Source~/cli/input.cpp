// SPDX-License-Identifier: MIT
// The structures that a command is about.
#include "cli/input.h"

#include <algorithm>

#include "cli/area_tables.h"
#include "cli/clock.h"
#include "cli/exit_code.h"
#include "cli/shown_output.h"
#include "cli/tell.h"
#include "cli/water_hint.h"
#include "io/file_bytes.h"
#include "io/radii.h"

namespace quickses::cli {

namespace {

io::StructureFile read(const std::string &path, const Options &options) {
  if (path == "-")
    return io::parse_structure(io::read_standard_input(), options.input_format, options.read, io::kStandardInput);
  if (options.input_format) return io::read_structure(path, *options.input_format, options.read);
  return io::read_structure(path, options.read);
}

bool has_one_chain(const io::Structure &structure) {
  return std::all_of(structure.atoms.begin(), structure.atoms.end(),
                     [&](const io::AtomInfo &atom) { return atom.chain == structure.atoms.front().chain; });
}

// The number that the file gives it may be another one.
void hint_at_number(const Options &options, const io::StructureFile &file) {
  const io::Structure &structure = file.models.front();
  if (!options.model_given || options.read.model == 0 || structure.model_name == std::to_string(structure.model))
    return;
  tell("'" + file.name + "': --model " + std::to_string(structure.model) +
       " is the model that the file gives the number " + structure.model_name);
}

// The frames of a trajectory are taken whatever models the structure has.
void hint_at_models(const Options &options, const io::StructureFile &file) {
  if (file.model_count == 1 || options.model_given || !options.trajectories.empty()) return;
  tell("'" + file.name + "': model 1 of " + std::to_string(file.model_count) + " is used" +
       (file.has_model_records ? "" : " (END and ENDMDL end a model)") + "; --model N chooses another");
}

}  // namespace

io::StructureFile load(const std::string &path, const Options &options, bool quiet) {
  io::StructureFile file = read(path, options);
  const ComputeOptions &compute = options.compute;
  if (io::has_own_radii(file.format) && compute.radii_given)
    throw Failure(kUsage, "--radii: '" + file.name + "' has radii of its own");
  io::assign_radii(file, compute.radii_given ? compute.radii : "");
  if (!quiet)
    for (const std::string &warning : file.warnings) tell("warning: " + warning);
  return file;
}

Input::Input(const Options &given, bool quiet) : options(given) {
  const auto start = Clock::now();
  file = load(options.input, options, quiet);
  read_ms = ms_since(start);
  if (io::has_own_radii(file.format)) options.compute.radii = "file";
  if (options.mesh.colors == MeshColors::kDefault && makes_shown(options))
    options.mesh.colors = has_one_chain(file.models.front()) ? MeshColors::kElement : MeshColors::kChain;
  if (!quiet) {
    hint_at_models(options, file);
    hint_at_number(options, file);
    hint_at_water(options, file.models.front());
  }
  for (const io::Structure &structure : file.models) check_has_residues(options, structure);
}

}  // namespace quickses::cli
