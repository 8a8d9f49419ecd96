// SPDX-License-Identifier: MIT
// The quickses program: molecular surfaces from the command line: files are read and written by io/, surfaces computed
// by the C API.
#include <iostream>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/options.h"
#include "cli/processes.h"
#include "cli/stopping.h"
#include "cli/tell.h"
#include "cli/text_output.h"
#include "cli/utf8.h"
#include "io/file_bytes.h"

namespace quickses::cli {
namespace {

void run_command(const Options &options, Processes &processes) {
  io::set_input_limit(options.max_input);
  if (!options.trajectories.empty()) {
    run_trajectory(options, processes);
  } else if (processes.is_first()) {  // nothing to share
    if (options.command == Options::Command::kSurface) run_surface(options);
    if (options.command == Options::Command::kMeasure) run_measure(options);
    if (options.command == Options::Command::kCavities) run_cavities(options);
    if (options.command == Options::Command::kBench) run_bench(options);
  }
  flush_standard_output();
}

// What all processes say alike is said by the first.
int run(int argc, char **argv) {
  std::unique_ptr<Processes> processes;
  try {
    prepare_for_stopping();
    use_utf8(&argc, &argv);
    processes = start_processes(&argc, &argv);
    std::ostream nowhere(nullptr);
    run_command(parse_options(argc, argv, processes->is_first() ? std::cout : nowhere), *processes);
    return kOk;
  } catch (...) {
    const Failure failure = failure_of(std::current_exception());
    if (!processes || processes->is_first()) tell(failure.what());
    return failure.code();
  }
}

}  // namespace
}  // namespace quickses::cli

int main(int argc, char **argv) { return quickses::cli::run(argc, argv); }
