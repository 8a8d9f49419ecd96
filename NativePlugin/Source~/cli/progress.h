// SPDX-License-Identifier: MIT
// A bar on standard error while a surface is computed, where somebody can see it.
#pragma once

#include <chrono>

#include "quickses/quickses.h"

namespace quickses::cli {

class ProgressBar {
 public:
  // Shows nothing if quiet or if standard error is no terminal, and nothing before a moment has passed.
  ProgressBar(qses_context *context, bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar &) = delete;
  ProgressBar &operator=(const ProgressBar &) = delete;

 private:
  static void on_progress(void *self, double fraction);
  void show(double fraction);

  qses_context *context_;
  bool active_ = false;
  int percent_ = -1;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace quickses::cli
