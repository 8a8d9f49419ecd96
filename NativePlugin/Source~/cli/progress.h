// SPDX-License-Identifier: MIT
// Bars on standard error while something is computed, where somebody can see them.
#pragma once

#include <chrono>
#include <string>

#include "quickses/quickses.h"

namespace quickses::cli {

// One line of a terminal that is written over and over. Nothing is shown if quiet or if standard error is no terminal,
// nor before a moment has passed since the start, or since it was written last.
class TerminalBar {
 public:
  explicit TerminalBar(bool quiet);
  ~TerminalBar() { clear(); }
  TerminalBar(const TerminalBar &) = delete;
  TerminalBar &operator=(const TerminalBar &) = delete;

  bool is_active() const { return active_; }
  bool is_due() const;  // whether something would be shown now
  void show(double fraction, const std::string &text = "");
  void clear();  // before something else is printed

 private:
  bool active_;
  size_t width_ = 0;  // of what stands there
  std::string shown_;
  std::chrono::steady_clock::time_point next_;  // when something may be shown
};

// While one surface is computed.
class ProgressBar {
 public:
  ProgressBar(qses_context *context, bool quiet);
  ~ProgressBar();

 private:
  static void on_progress(void *self, double fraction);

  qses_context *context_;
  TerminalBar bar_;
};

// While the frames of a trajectory are computed: how many are done, how many per second, how long it will take.
class FrameProgress {
 public:
  FrameProgress(size_t frame_count, bool quiet) : frame_count_(frame_count), bar_(quiet) {}

  // Everything is ready: time counts from now on.
  void begin() { start_ = std::chrono::steady_clock::now(); }
  void advance();
  void clear() { bar_.clear(); }
  double seconds() const;
  double frames_per_second() const { return static_cast<double>(done_) / seconds(); }

 private:
  const size_t frame_count_;
  size_t done_ = 0;
  TerminalBar bar_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace quickses::cli
