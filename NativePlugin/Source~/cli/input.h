// SPDX-License-Identifier: MIT
// The structures that a command is about.
#pragma once

#include <string>

#include "cli/options.h"
#include "io/structure.h"

namespace quickses::cli {

// The structures of a file, or "-" for standard input, with their radii. Warnings go to standard error unless quiet.
// Throws Failure, io::Error.
io::StructureFile load(const std::string &path, const Options &options, bool quiet);

// The input of a command, which has what the options need of it. Throws as load() does.
struct Input {
  Input(const Options &given, bool quiet);

  Options options;  // those given, with the radii that are used
  double read_ms = 0;
  io::StructureFile file;
};

}  // namespace quickses::cli
