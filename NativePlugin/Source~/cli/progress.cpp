// SPDX-License-Identifier: MIT
// A bar on standard error while a surface is computed, where somebody can see it.
#include "cli/progress.h"

#include <algorithm>
#include <cstdio>
#include <string>

#if defined(_WIN32)
#include <io.h>
#define QSES_STDERR_IS_TERMINAL (_isatty(2) != 0)
#else
#include <unistd.h>
#define QSES_STDERR_IS_TERMINAL (isatty(2) != 0)
#endif

namespace quickses::cli {
namespace {

constexpr int kWidth = 40;
constexpr std::chrono::milliseconds kDelay(200);  // what is done sooner needs no bar

}  // namespace

ProgressBar::ProgressBar(qses_context *context, bool quiet) : context_(context) {
  if (quiet || !QSES_STDERR_IS_TERMINAL) return;
  active_ = qses_set_progress_callback(context_, &ProgressBar::on_progress, this) == QSES_OK;
}

ProgressBar::~ProgressBar() {
  if (!active_) return;
  qses_set_progress_callback(context_, nullptr, nullptr);
  if (percent_ >= 0) std::fprintf(stderr, "\r%*s\r", kWidth + 8, "");
}

void ProgressBar::on_progress(void *self, double fraction) { static_cast<ProgressBar *>(self)->show(fraction); }

void ProgressBar::show(double fraction) {
  if (std::chrono::steady_clock::now() - start_ < kDelay) return;
  const int percent = static_cast<int>(100 * std::min(1.0, std::max(0.0, fraction)));
  if (percent == percent_) return;
  percent_ = percent;
  const size_t done = static_cast<size_t>(percent) * kWidth / 100;
  const std::string bar = std::string(done, '#') + std::string(kWidth - done, '.');
  std::fprintf(stderr, "\r[%s] %3d %%", bar.c_str(), percent);
  std::fflush(stderr);
}

}  // namespace quickses::cli
