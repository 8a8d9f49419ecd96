// SPDX-License-Identifier: MIT
// Names with * and ? in them, which Windows' shells leave to programs.
#pragma once

#include <string>
#include <vector>

namespace quickses::cli {

// On Windows, in the place of each such name, all files that fit it, in the order of their names;
// one that none fits stays. Elsewhere nothing: there shells have done it.
void expand_wildcards(std::vector<std::string> *names);

}  // namespace quickses::cli
