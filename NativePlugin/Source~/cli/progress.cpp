// SPDX-License-Identifier: MIT
// Bars on standard error while something is computed, where somebody can see them.
#include "cli/progress.h"

#include <algorithm>
#include <cstdio>

#if defined(_WIN32)
#include <io.h>
#define QSES_STDERR_IS_TERMINAL (_isatty(2) != 0)
#else
#include <unistd.h>
#define QSES_STDERR_IS_TERMINAL (isatty(2) != 0)
#endif

namespace quickses::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kBarWidth = 30;
constexpr std::chrono::milliseconds kDelay(200);    // what is done sooner needs no bar
constexpr std::chrono::milliseconds kInterval(50);  // nobody reads faster, and terminals are slow

std::string duration_text(double seconds) {
  const long s = static_cast<long>(seconds + 0.5);
  char text[48];
  if (s < 60)
    std::snprintf(text, sizeof text, "%ld s", s);
  else if (s < 3600)
    std::snprintf(text, sizeof text, "%ld:%02ld min", s / 60, s % 60);
  else
    std::snprintf(text, sizeof text, "%ld:%02ld h", s / 3600, s / 60 % 60);
  return text;
}

}  // namespace

TerminalBar::TerminalBar(bool quiet) : active_(!quiet && QSES_STDERR_IS_TERMINAL), next_(Clock::now() + kDelay) {}

bool TerminalBar::is_due() const { return active_ && Clock::now() >= next_; }

void TerminalBar::show(double fraction, const std::string &text) {
  if (!is_due()) return;
  const size_t percent = static_cast<size_t>(100 * std::clamp(fraction, 0.0, 1.0));
  const size_t done = percent * kBarWidth / 100;
  std::string line = "[" + std::string(done, '#') + std::string(kBarWidth - done, '.') + "] " +
                     std::string(percent < 10    ? 2
                                 : percent < 100 ? 1
                                                 : 0,
                                 ' ') +
                     std::to_string(percent) + " %" + text;
  if (line == shown_) return;
  shown_ = line;
  next_ = Clock::now() + kInterval;
  const size_t length = line.size();
  if (length < width_) line.append(width_ - length, ' ');
  width_ = length;
  std::fprintf(stderr, "\r%s", line.c_str());
  std::fflush(stderr);
}

void TerminalBar::clear() {
  if (width_ == 0) return;
  std::fprintf(stderr, "\r%*s\r", static_cast<int>(width_), "");
  std::fflush(stderr);
  width_ = 0;
  shown_.clear();
}

ProgressBar::ProgressBar(qses_context *context, bool quiet) : context_(context), bar_(quiet) {
  if (bar_.is_active()) qses_set_progress_callback(context_, &ProgressBar::on_progress, this);
}

ProgressBar::~ProgressBar() {
  if (bar_.is_active()) qses_set_progress_callback(context_, nullptr, nullptr);
}

void ProgressBar::on_progress(void *self, double fraction) { static_cast<ProgressBar *>(self)->bar_.show(fraction); }

void FrameProgress::advance() {
  ++done_;
  if (!bar_.is_due()) return;
  const double rate = frames_per_second();
  char text[128];
  std::snprintf(text, sizeof text, "  %zu/%zu frames, %.*f frames/s, %s left", done_, frame_count_, rate < 10 ? 2 : 0,
                rate, duration_text(static_cast<double>(frame_count_ - done_) / rate).c_str());
  bar_.show(static_cast<double>(done_) / static_cast<double>(frame_count_), text);
}

double FrameProgress::seconds() const {
  return std::max(1e-6, std::chrono::duration<double>(Clock::now() - start_).count());
}

}  // namespace quickses::cli
