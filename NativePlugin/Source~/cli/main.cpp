// SPDX-License-Identifier: MIT
// The quickses program: molecular surfaces from the command line, by the C API and nothing else.
#include <cstdio>
#include <new>
#include <string>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/options.h"
#include "io/error.h"

namespace quickses::cli {
namespace {

int fail(ExitCode code, const std::string &message) {
  std::fprintf(stderr, "quickses: %s\n", message.c_str());
  return code;
}

ExitCode exit_code_of(io::ErrorKind kind) {
  switch (kind) {
    case io::ErrorKind::kUsage:
      return kUsage;
    case io::ErrorKind::kInput:
      return kInputUnreadable;
    case io::ErrorKind::kOutput:
      return kOutputUnwritable;
  }
  return kComputingFailed;
}

int run(int argc, char **argv) {
  try {
    const Options options = parse_options(argc, argv);
    if (options.command == Options::Command::kSurface) run_surface(options);
    if (options.command == Options::Command::kBench) run_bench(options);
    if (std::fflush(stdout) != 0) return fail(kOutputUnwritable, "standard output can't be written");
    return kOk;
  } catch (const Failure &failure) {
    return fail(failure.code(), failure.what());
  } catch (const io::Error &error) {
    return fail(exit_code_of(error.kind()), error.what());
  } catch (const std::bad_alloc &) {
    return fail(kComputingFailed, "the machine has not enough memory for this");
  } catch (const std::exception &error) {
    return fail(kComputingFailed, std::string("unexpected error: ") + error.what());
  }
}

}  // namespace
}  // namespace quickses::cli

int main(int argc, char **argv) { return quickses::cli::run(argc, argv); }
