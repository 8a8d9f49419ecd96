// SPDX-License-Identifier: MIT
#include "parallel/helper_threads.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <system_error>

#if defined(__SSE2__) || defined(_M_X64)
#include <emmintrin.h>
#endif

namespace quickses {
namespace {

void pause_a_little() {
#if defined(__SSE2__) || defined(_M_X64)
  for (int k = 0; k < 16; ++k) _mm_pause();
#else
  std::this_thread::yield();
#endif
}

// Longer than what is done between two passes, as a rule.
constexpr std::chrono::microseconds kAwake{100};
// A thread that lost its processor in the middle of its work needs one of those that wait.
constexpr int kPausesBeforeYield = 64;

}  // namespace

HelperThreads::HelperThreads(unsigned helpers) {
  try {
    threads_.reserve(helpers);
    while (threads_.size() < helpers) threads_.emplace_back([this] { help(); });
  } catch (const std::system_error &) {
  } catch (const std::bad_alloc &) {
  }
}

HelperThreads::~HelperThreads() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    quits_ = true;
  }
  called_.notify_all();
  for (std::thread &thread : threads_) thread.join();
}

void HelperThreads::run(size_t workers, Work work, const void *context) noexcept {
  work_ = work;
  context_ = context;
  next_worker_ = 1;
  const size_t seats = std::min(workers - 1, count());
  seats_ = seats;
  if (asleep_ > 0) {
    { const std::lock_guard<std::mutex> lock(mutex_); }  // who is about to sleep has looked at the seats, or sleeps
    for (size_t k = 0; k < seats; ++k) called_.notify_one();
  }
  work(context, 0);
  seats_ = 0;
  for (int pauses = 0; at_work_ > 0; ++pauses) {
    if (pauses < kPausesBeforeYield)
      pause_a_little();
    else
      std::this_thread::yield();
  }
}

void HelperThreads::help() {
  for (;;) {
    wait_to_be_called();
    if (quits_) return;
    ++at_work_;
    if (take_seat()) work_(context_, next_worker_++);
    --at_work_;
  }
}

void HelperThreads::wait_to_be_called() {
  if (is_called()) return;
  const auto end = std::chrono::steady_clock::now() + kAwake;
  do {
    pause_a_little();
    if (is_called()) return;
    std::this_thread::yield();  // to whoever has something to do
  } while (std::chrono::steady_clock::now() < end);
  std::unique_lock<std::mutex> lock(mutex_);
  ++asleep_;
  called_.wait(lock, [&] { return is_called(); });
  --asleep_;
}

bool HelperThreads::take_seat() {
  size_t left = seats_;
  while (left > 0 && !seats_.compare_exchange_weak(left, left - 1)) {
  }
  return left > 0;
}

}  // namespace quickses
