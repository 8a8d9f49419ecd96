// SPDX-License-Identifier: MIT
// Wall-clock times in ms.
#pragma once

#include <chrono>

namespace quickses::cli {

using Clock = std::chrono::steady_clock;

inline double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace quickses::cli
