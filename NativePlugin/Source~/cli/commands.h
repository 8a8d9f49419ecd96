// SPDX-License-Identifier: MIT
// What the program does. All throw Failure, io::Error or std::bad_alloc.
#pragma once

#include "cli/options.h"
#include "cli/processes.h"

namespace quickses::cli {

void run_surface(const Options &options);                           // quickses INPUT...
void run_trajectory(const Options &options, Processes &processes);  // quickses [measure] INPUT --trajectory FILE
void run_measure(const Options &options);                           // quickses measure INPUT...
void run_cavities(const Options &options);                          // quickses cavities INPUT
void run_bench(const Options &options);                             // quickses bench FILE...

}  // namespace quickses::cli
