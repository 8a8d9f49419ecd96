// SPDX-License-Identifier: MIT
// Names of mesh files with the number of a frame in them.
#pragma once

#include <cstddef>
#include <string>

namespace quickses::cli {

class OutputPattern {
 public:
  // A name with one %d, %5d or %05d where the frame's number goes; %% stands for a percent sign.
  // Throws Failure (kUsage) naming --output.
  explicit OutputPattern(const std::string &text);

  std::string name(size_t frame) const;

 private:
  std::string before_, after_;
  size_t width_ = 0;
  char fill_ = ' ';
};

}  // namespace quickses::cli
