// SPDX-License-Identifier: MIT
// --device: which CUDA devices.
#include "cli/device_choice.h"

#include <algorithm>
#include <numeric>

#include "cli/exit_code.h"
#include "io/text.h"

namespace quickses::cli {

DeviceChoice::DeviceChoice(const std::string &text) : text_(text), is_all_(text == "all") {
  if (is_all_) return;
  for (const std::string &part : io::split(text, ',')) {
    int number = 0;
    if (!io::parse_integer(part, number) || number < 0)
      throw Failure(kUsage, "--device: '" + part + "' is no number of a CUDA device" +
                                (part == text ? ", nor is it all" : ", in '" + text + "'"));
    if (std::find(numbers_.begin(), numbers_.end(), number) != numbers_.end())
      throw Failure(kUsage, "--device: '" + text + "' names device " + std::to_string(number) + " twice");
    numbers_.push_back(number);
  }
}

std::vector<int> DeviceChoice::select(unsigned device_count, unsigned nth) const {
  const unsigned at_least_one = std::max(1u, device_count);
  if (!is_given()) return {static_cast<int>(nth % at_least_one)};
  if (is_all_) {
    std::vector<int> all(at_least_one);
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  for (const int number : numbers_)
    if (device_count > 0 && static_cast<unsigned>(number) >= device_count)
      throw Failure(kBackendUnavailable,
                    "--device " + text_ + ": " + io::there_are(device_count, "CUDA device") + ", from 0 on");
  return numbers_;
}

}  // namespace quickses::cli
