// SPDX-License-Identifier: MIT
// A command for each of the structures that were given, one after the other.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "cli/exit_code.h"
#include "cli/options.h"

namespace quickses::cli {

// The file of a structure's mesh: the name of --output, in which %s stands for the name of the input without its folder
// and extensions: of a/1crn.pdb.gz it is 1crn, of standard input stdin. is_pattern: the result is one of OutputPattern,
// so percent signs of that name are doubled.
std::string output_of_input(const std::string &output, const std::string &input, bool is_pattern);

// The same of one of the structures of options whose output is resolved.
std::string output_of_input(const Options &options, const std::string &input);

// Calls action with the options of each: input and output are its own. What a single one throws, goes on. Of several,
// one that fails does not stop the others: its message is printed, and failed is called, then. Gives how many failed.
size_t for_each_input(const Options &options, const std::function<void(const Options &one)> &action,
                      const std::function<void(const Options &one, const Failure &failure)> &failed);

// After everything else is done. Throws Failure (kSomeFailed) unless none failed.
void check_failed_inputs(const Options &options, size_t failed_count);

}  // namespace quickses::cli
