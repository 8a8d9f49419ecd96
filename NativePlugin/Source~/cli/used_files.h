// SPDX-License-Identifier: MIT
// The files of a run, and that none is written over another one.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "cli/options.h"

namespace quickses::cli {

// Files are told apart by what they are, not by name: links, and other ways to write a path, don't matter. What is no
// regular file, such as /dev/null, may be used any number of times.
class UsedFiles {
 public:
  // All inputs and outputs that the options name. Throws Failure (kUsage) if one of the outputs is another one of these
  // files as well.
  explicit UsedFiles(const Options &options);

  // The same for a mesh whose name is made of that of --output: of one model of many, or of a frame. There may be
  // millions of them.
  void check_mesh(const std::string &path);

 private:
  struct File {
    std::string flag, name;
    bool is_output;
    std::filesystem::path path, place;
  };

  using Key = std::filesystem::path::string_type;

  File file_of(const char *flag, const std::string &name, bool is_output);
  std::filesystem::path place_of(const std::filesystem::path &path);
  static Key key_of(const File &file);
  static bool is_same(const File &a, const File &b);
  void check(const File &output) const;
  void check_place(const File &mesh) const;
  void add(File file);
  void add_meshes(const Options &options);
  void add_input(const char *flag, const std::string &name);
  void add_output(const char *flag, const std::string &name);

  std::vector<File> files_;
  std::set<Key> places_;                                            // of the files: two are one if these are equal
  std::map<std::filesystem::path, std::filesystem::path> folders_;  // where they are
};

}  // namespace quickses::cli
