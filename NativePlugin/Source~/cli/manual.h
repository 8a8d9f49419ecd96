// SPDX-License-Identifier: MIT
// The manual page and the completion of bash, from the table of options: what the build installs beside the program.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace quickses::cli {

// troff, for man(1). version: of the program.
std::string manual_page(const CLI::App &app, const std::string &version);

// To be sourced by bash.
std::string bash_completion(const CLI::App &app);

}  // namespace quickses::cli
