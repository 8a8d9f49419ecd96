// SPDX-License-Identifier: MIT
// The flags of pictures and pages.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "cli/options.h"

namespace quickses::cli {

void add_picture_options(CLI::App *app, PictureOptions &picture);

// given: whether a flag was on the command line. Throws Failure (kUsage) if one does not fit to the output, and
// io::Error (usage) if the program can't make the page that is asked for.
void check_picture_options(const Options &options, const std::function<bool(const char *)> &given);

}  // namespace quickses::cli
