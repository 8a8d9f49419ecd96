// SPDX-License-Identifier: MIT
// The files of a run, and that none is written over another one.
#include "cli/used_files.h"

#include <system_error>

#include "cli/exit_code.h"
#include "io/file_path.h"
#include "io/mesh_writer.h"
#include "io/radii.h"

#if defined(_WIN32)
#include <cwchar>
#endif

namespace quickses::cli {
namespace {

namespace fs = std::filesystem;

const char kOutputFlag[] = "--output (-o)";

bool is_same_place(const fs::path &a, const fs::path &b) {
#if defined(_WIN32)
  return _wcsicmp(a.c_str(), b.c_str()) == 0;
#else
  return a == b;
#endif
}

}  // namespace

UsedFiles::File UsedFiles::file_of(const char *flag, const std::string &name, bool is_output) {
#if defined(_WIN32)
  const fs::path path = io::path_of(name);
#else
  const fs::path path = is_output && name == "-" ? "/dev/stdout" : io::path_of(name);  // may be a file
#endif
  return {flag, name, is_output, path, io::place_of(path)};
}

bool UsedFiles::is_same(const File &a, const File &b) {
  std::error_code error;
  const fs::file_status status_a = fs::status(a.path, error), status_b = fs::status(b.path, error);
  if (fs::exists(status_a) != fs::exists(status_b)) return false;
  if (!fs::exists(status_a)) return is_same_place(a.place, b.place);
  return fs::is_regular_file(status_a) && fs::equivalent(a.path, b.path, error);
}

void UsedFiles::check(const File &output) const {
  for (const File &file : files_)
    if (is_same(output, file))
      throw Failure(kUsage, output.flag + ": '" + output.name + "' is " +
                                (file.is_output ? "the file of " + file.flag + " as well"
                                                : "one of the inputs (" + file.flag + ") and would be overwritten"));
}

void UsedFiles::add_input(const char *flag, const std::string &name) {
  if (!name.empty()) files_.push_back(file_of(flag, name, false));
}

void UsedFiles::add_output(const char *flag, const std::string &name) {
  if (name.empty()) return;
  const File file = file_of(flag, name, true);
  check(file);
  files_.push_back(file);
}

UsedFiles::UsedFiles(const Options &options) {
  for (const std::string &input : options.inputs) add_input("FILE", input);
  add_input("INPUT", options.input);
  add_input("--trajectory", options.trajectory);
  if (!io::is_radius_set(options.compute.radii)) add_input("--radii", options.compute.radii);
  const bool is_one_mesh = options.trajectory.empty() && options.read.model != 0;
  if (is_one_mesh && !options.output.empty())
    for (const std::string &name : io::mesh_files_of(options.output)) add_output(kOutputFlag, name);
  add_output("--csv", options.csv);
  add_output("--per-atom", options.per_atom);
  add_output("--per-residue", options.per_residue);
  add_output("--json", options.json);
}

void UsedFiles::check_mesh(const std::string &path) const {
  for (const std::string &name : io::mesh_files_of(path)) check(file_of(kOutputFlag, name, true));
}

}  // namespace quickses::cli
