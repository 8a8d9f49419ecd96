// SPDX-License-Identifier: MIT
// --device: which CUDA devices.
#pragma once

#include <string>
#include <vector>

namespace quickses::cli {

class DeviceChoice {
 public:
  DeviceChoice() = default;  // not given

  // "1", "0,1" or "all". Throws Failure (kUsage) naming --device.
  explicit DeviceChoice(const std::string &text);

  bool is_given() const { return !text_.empty(); }
  // "all" may be many.
  bool may_be_many() const { return is_all_ || numbers_.size() > 1; }
  const std::string &text() const { return text_; }

  // Their numbers, at least one, of device_count that there are. Not given: the nth, counted round and round. Where
  // there are none at all, those that were named, or 0: whoever tries to use one is told why not. Throws Failure
  // (kBackendUnavailable) if some are there, but not one that was named.
  std::vector<int> select(unsigned device_count, unsigned nth) const;

 private:
  std::string text_;
  bool is_all_ = false;
  std::vector<int> numbers_;
};

}  // namespace quickses::cli
