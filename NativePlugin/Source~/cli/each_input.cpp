// SPDX-License-Identifier: MIT
// A command for each of the structures that were given.
#include "cli/each_input.h"

#include <exception>
#include <filesystem>

#include "cli/tell.h"
#include "io/file_path.h"

namespace quickses::cli {
namespace {

std::string stem_of(const std::string &input) {
  if (input == "-") return "stdin";
  std::filesystem::path name = io::path_of(input).filename();
  if (io::lower_extension(name) == ".gz") name = name.stem();
  return io::utf8_of(name.stem());
}

}  // namespace

std::string output_of_input(const std::string &output, const std::string &input, bool is_pattern) {
  std::string stem;
  for (const char c : stem_of(input)) stem += is_pattern && c == '%' ? "%%" : std::string(1, c);
  std::string name;
  for (size_t i = 0; i < output.size(); ++i) {
    if (output.compare(i, 2, "%s") == 0) {
      name += stem;
      ++i;
    } else {
      name += output[i];
    }
  }
  return name;
}

std::string output_of_input(const Options &options, const std::string &input) {
  return options.has_several_inputs() ? output_of_input(options.output, input, false) : options.output;
}

size_t for_each_input(const Options &options, const std::function<void(const Options &one)> &action,
                      const std::function<void(const Options &one, const Failure &failure)> &failed) {
  size_t failed_count = 0;
  Options one = options;
  for (const std::string &input : options.inputs) {
    one.input = input;
    one.output = output_of_input(options, input);
    if (!options.has_several_inputs()) {
      action(one);
      continue;
    }
    try {
      action(one);
    } catch (...) {
      const Failure failure = failure_of(std::current_exception());
      if (failure.code() == kBackendUnavailable) throw;  // for all of them
      tell(input + " failed: " + failure.what());
      failed(one, failure);
      ++failed_count;
    }
  }
  return failed_count;
}

void check_failed_inputs(const Options &options, size_t failed_count) {
  if (failed_count == 0) return;
  throw Failure(kSomeFailed,
                std::to_string(failed_count) + " of " + std::to_string(options.inputs.size()) + " structures failed");
}

}  // namespace quickses::cli
