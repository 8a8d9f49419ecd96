// SPDX-License-Identifier: MIT
// What the program says on standard error: a line each time, in which names of files, and what is in them, neither
// begin another line nor steer the terminal.
#pragma once

#include <cstdio>
#include <string>

#include "io/error.h"

namespace quickses::cli {

inline void tell(const std::string &sentence) {
  std::fprintf(stderr, "quickses: %s\n", io::printable(sentence).c_str());
}

}  // namespace quickses::cli
