// SPDX-License-Identifier: MIT
// What the program does. Both throw Failure, io::Error or std::bad_alloc.
#pragma once

#include "cli/options.h"

namespace quickses::cli {

void run_surface(const Options &options);  // quickses INPUT
void run_bench(const Options &options);    // quickses bench FILE...

}  // namespace quickses::cli
