// SPDX-License-Identifier: MIT
// The files of a run, and that none is written over another one.
#include "cli/used_files.h"

#include <system_error>
#include <utility>

#include "cli/each_input.h"
#include "cli/exit_code.h"
#include "cli/shown_output.h"
#include "io/atomic_file.h"
#include "io/file_path.h"
#include "io/mesh_writer.h"
#include "io/radii.h"

#if defined(_WIN32)
#include <windows.h>
#endif

namespace quickses::cli {
namespace {

namespace fs = std::filesystem;

const char kOutputFlag[] = "--output (-o)";

}  // namespace

UsedFiles::File UsedFiles::file_of(const char *flag, const std::string &name, bool is_output) {
  const bool is_standard = name == "-" || (is_output && io::is_standard_output(name));
#if defined(_WIN32)
  const char *const standard = is_output ? "<stdout>" : "<stdin>";  // names that no file can have
#else
  const char *const standard = is_output ? "/dev/stdout" : "/dev/stdin";  // what a shell leads there may be a file
#endif
  const fs::path path = is_standard ? fs::path(standard) : io::path_of(name);
  return {flag, is_standard ? "-" : name, is_output, path, place_of(path)};
}

// As io::place_of, which asks about every folder of the path; of many files of one folder once.
fs::path UsedFiles::place_of(const fs::path &path) {
  if (io::is_link(path)) return io::place_of(path);
  const auto [folder, is_new] = folders_.try_emplace(path.parent_path());
  if (is_new) folder->second = io::place_of(path).parent_path();
  return folder->second / path.filename();
}

UsedFiles::Key UsedFiles::key_of(const File &file) {
  Key key = file.place.native();
#if defined(_WIN32)
  // Of all alphabets, as file systems compare there.
  const int size = static_cast<int>(key.size());
  LCMapStringEx(LOCALE_NAME_INVARIANT, LCMAP_UPPERCASE, key.data(), size, &key[0], size, nullptr, nullptr, 0);
#endif
  return key;
}

bool UsedFiles::is_same(const File &a, const File &b) {
  std::error_code error;
  const fs::file_status status_a = fs::status(a.path, error), status_b = fs::status(b.path, error);
  if (fs::exists(status_a) != fs::exists(status_b)) return false;
  if (!fs::exists(status_a)) return key_of(a) == key_of(b);
  return fs::is_regular_file(status_a) && fs::equivalent(a.path, b.path, error);
}

void UsedFiles::check(const File &output) const {
  for (const File &file : files_)
    if (is_same(output, file))
      throw Failure(kUsage, output.flag + ": '" + output.name + "' is " +
                                (file.is_output ? "the file of " + file.flag + " as well"
                                                : "one of the inputs (" + file.flag + ") and would be overwritten"));
}

// Of meshes, which may be many, only those at the place of another file are compared. Hard links don't matter: a mesh
// takes the place of a name, not of what is in the file.
void UsedFiles::check_place(const File &mesh) const {
  if (places_.count(key_of(mesh)) != 0) check(mesh);
}

void UsedFiles::add(File file) {
  places_.insert(key_of(file));
  files_.push_back(std::move(file));
}

void UsedFiles::add_input(const char *flag, const std::string &name) {
  if (!name.empty()) add(file_of(flag, name, false));
}

void UsedFiles::add_meshes(const Options &options) {
  if (!options.has_several_inputs()) {
    if (options.read.model == 0 && !makes_page(options)) return;
    for (const std::string &name : io::mesh_files_of(options.output)) add_output(kOutputFlag, name);
    return;
  }
  std::map<Key, const std::string *> meshes;  // the inputs that they are of
  for (const std::string &input : options.inputs)
    for (const std::string &name : io::mesh_files_of(output_of_input(options, input))) {
      const File file = file_of(kOutputFlag, name, true);
      const auto [other, is_new] = meshes.emplace(key_of(file), &input);
      if (!is_new)
        throw Failure(kUsage, file.flag + ": '" + *other->second + "' and '" + input + "' would both be written to '" +
                                  file.name + "'");
      if (options.read.model == 0 && !makes_page(options)) continue;  // its meshes have names that are made of this one
      check_place(file);
      add(file);
    }
}

void UsedFiles::add_output(const char *flag, const std::string &name) {
  if (name.empty()) return;
  const File file = file_of(flag, name, true);
  check(file);
  add(file);
}

UsedFiles::UsedFiles(const Options &options) {
  for (const std::string &input : options.inputs) add_input("INPUT", input);
  for (const std::string &trajectory : options.trajectories) add_input("--trajectory", trajectory);
  if (!io::is_radius_set(options.compute.radii)) add_input("--radii", options.compute.radii);
  if (!options.output.empty() && (options.trajectories.empty() || makes_page(options))) add_meshes(options);
  add_output("--csv", options.csv);
  add_output("--per-atom", options.per_atom);
  add_output("--per-residue", options.per_residue);
  add_output("--json", options.json);
}

void UsedFiles::check_mesh(const std::string &path) {
  for (const std::string &name : io::mesh_files_of(path)) check_place(file_of(kOutputFlag, name, true));
}

}  // namespace quickses::cli
