// SPDX-License-Identifier: MIT
// How far a computation is, for whoever waits for it.
#pragma once

#include "parallel/error.h"

#include <atomic>
#include <functional>

namespace quickses {

// Hands the fraction done to the caller, never falling, in steps of a few per mille; and ends the computation where it
// was told to stop.
class Progress {
 public:
  // Called with the fraction, for good; empty: not at all.
  void set(std::function<void(double)> callback) { callback_ = std::move(callback); }
  bool wanted() const { return static_cast<bool>(callback_); }

  // A computation begins: advance is called with the fraction, too. Without a flag nothing is told.
  void restart(const std::atomic<bool> *stop, std::function<void(double)> advance) {
    stop_ = stop;
    advance_ = std::move(advance);
    last_ = -1;
    enter(0, 0);
  }
  const std::atomic<bool> *stop_flag() const { return stop_; }  // of the computation
  // Fractions reported from now on are those of the part from begin to end of the whole.
  void enter(double begin, double end) {
    begin_ = begin;
    end_ = end;
  }
  void report(double fraction) {
    if (!stop_) return;
    if (stop_->load(std::memory_order_relaxed)) throw Cancelled{};
    const double whole = begin_ + (end_ - begin_) * fraction;
    if (whole < last_ + 0.005 && !(whole >= 1.0 && last_ < 1.0)) return;
    last_ = whole;
    advance_(whole);
    if (callback_) callback_(whole);
  }

 private:
  std::function<void(double)> callback_, advance_;
  const std::atomic<bool> *stop_ = nullptr;
  double begin_ = 0, end_ = 1, last_ = -1;
};

}  // namespace quickses
