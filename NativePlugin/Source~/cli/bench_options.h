// SPDX-License-Identifier: MIT
// The flags of quickses bench.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "cli/options.h"

namespace quickses::cli {

void add_bench_options(CLI::App *app, BenchOptions &options);

// given: whether a flag was on the command line. Throws Failure (kUsage).
void check_bench(const Options &options, const std::function<bool(const char *)> &given);

}  // namespace quickses::cli
