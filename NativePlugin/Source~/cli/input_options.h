// SPDX-License-Identifier: MIT
// The flags that say which atoms of which structures.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/options.h"

namespace quickses::cli {

// Of commands that take several structures, one after the other, or one at a time.
void add_input_options(CLI::App *app, Options &options, const char *model_help);
void add_single_input_options(CLI::App *app, Options &options, const char *model_help);

void add_input_format(CLI::App *app, Options &options);

// Whether several structures fit to the rest. Throws Failure (kUsage).
void check_inputs(const Options &options);

}  // namespace quickses::cli
