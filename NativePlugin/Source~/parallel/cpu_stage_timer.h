// SPDX-License-Identifier: MIT
// Wall-clock times of the stages on the CPU. The CUDA executor has a timer with the same members that uses events.
#pragma once

#include <chrono>
#include <cstring>
#include <utility>
#include <vector>

namespace quickses {

class CpuStageTimer {
 public:
  template <class Executor>
  explicit CpuStageTimer(Executor &) {}

  void enable(bool enabled) { enabled_ = enabled; }
  bool is_enabled() const { return enabled_; }
  void reset() {
    times_.clear();
    open_ = false;
  }
  // Ends the stage before, and starts one. A name that has been there before goes on adding to it. Names are literals.
  void begin(const char *name) {
    if (!enabled_) return;
    end();
    name_ = name;
    start_ = Clock::now();
    open_ = true;
  }
  void end() {
    if (!enabled_ || !open_) return;
    const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
    open_ = false;
    for (auto &t : times_)
      if (std::strcmp(t.first, name_) == 0) {
        t.second += ms;
        return;
      }
    times_.emplace_back(name_, ms);
  }
  // Names and milliseconds in the order of first appearance; valid until the next reset.
  const std::vector<std::pair<const char *, double>> &collect() { return times_; }

 private:
  using Clock = std::chrono::steady_clock;
  bool enabled_ = false, open_ = false;
  const char *name_ = nullptr;
  Clock::time_point start_;
  std::vector<std::pair<const char *, double>> times_;
};

}  // namespace quickses
