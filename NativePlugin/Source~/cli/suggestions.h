// SPDX-License-Identifier: MIT
// What those may have meant whose command line can't be understood.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace quickses::cli {

// The command that the arguments (without the program's name) begin with, or the program itself.
const CLI::App &command_of(const CLI::App &app, const std::vector<std::string> &arguments);

// "-spacing" for "--spacing": throws Failure (kUsage), since it would be taken for -s with the value "pacing".
void check_dashes(const CLI::App &command, const std::vector<std::string> &arguments);

// "; did you mean --spacing?" for an argument such as "-spacng" among these that may be why something failed; else "".
std::string suggest_dashes(const CLI::App &command, const std::vector<std::string> &arguments);

// "mesure" for "measure", which would be taken for the first of several inputs: throws Failure (kUsage), unless there
// is a file of that name.
void check_command(const CLI::App &app, const std::string &first_input);

// A sentence about an argument that nobody expected.
std::string explain_extra(const CLI::App &command, const std::vector<std::string> &arguments, const std::string &extra);

// A sentence in the place of CLI11's about a flag without its value, with one that it does not take, or that was given
// too often.
std::string explain_count(const std::string &sentence, const std::vector<std::string> &arguments);

}  // namespace quickses::cli
