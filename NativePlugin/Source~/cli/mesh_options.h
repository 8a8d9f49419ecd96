// SPDX-License-Identifier: MIT
// The flags that say what mesh files have in them.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/options.h"

namespace quickses::cli {

void add_mesh_options(CLI::App *app, Options &options);

// "-" for standard output becomes a name with the format in it. Throws Failure (kUsage).
void resolve_output(Options &options);

// Of what was not given, as the output wants it.
void set_mesh_defaults(Options &options);

// Whether they fit to each other and to the format of the output. Throws Failure (kUsage).
void check_mesh_options(const Options &options);

}  // namespace quickses::cli
