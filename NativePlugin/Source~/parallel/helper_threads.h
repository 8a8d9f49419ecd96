// SPDX-License-Identifier: MIT
// Threads that help another one, where there is no TBB: as on Windows, where MinGW's OpenMP lets its threads sleep
// between passes, and they wake up late.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <thread>
#include <vector>

namespace quickses {

// They wait awake for a little while after they helped, since passes follow each other soon, and then sleep. One caller
// at a time.
class HelperThreads {
 public:
  // Starts so many, or as many as the system gives.
  explicit HelperThreads(unsigned helpers);
  ~HelperThreads();
  HelperThreads(const HelperThreads &) = delete;
  HelperThreads &operator=(const HelperThreads &) = delete;

  size_t count() const { return threads_.size(); }

  // work(context, worker), which must not throw, for worker 0 by the calling thread, and for others up to workers - 1
  // by the helpers that come before it is through. Nobody waits for those that do not: what is to be done is shared out
  // by `work`. All that began have ended when this returns.
  using Work = void (*)(const void *context, size_t worker);
  void run(size_t workers, Work work, const void *context) noexcept;

 private:
  void help();
  bool is_called() const { return seats_ > 0 || quits_; }
  void wait_to_be_called();
  bool take_seat();

  // What is to be done; who has a seat may read it.
  Work work_ = nullptr;
  const void *context_ = nullptr;
  std::atomic<size_t> next_worker_{1};

  // A helper counts itself in before it takes a seat, and who calls takes back the seats before it looks whether any
  // is in: so one of them always sees the other. (All in one order, as atomics have them by default.)
  std::atomic<size_t> seats_{0}, at_work_{0};
  std::atomic<bool> quits_{false};
  std::atomic<size_t> asleep_{0};
  std::mutex mutex_;
  std::condition_variable called_;
  std::vector<std::thread> threads_;
};

}  // namespace quickses
