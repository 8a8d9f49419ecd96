// SPDX-License-Identifier: MIT
#include "parallel/later_release.h"

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <vector>

namespace quickses {
namespace {

class LaterReleases {
 public:
  // False: it is the caller's still.
  bool take(void (*release)(void *), void *memory) noexcept {
    try {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (is_ending_) return true;  // the system has it in a moment
      waiting_.push_back({release, memory});
      if (is_working_) return true;
      try {
        std::thread([this] { work(); }).detach();
      } catch (...) {
        waiting_.pop_back();
        throw;
      }
      is_working_ = true;
      return true;
    } catch (...) {  // no memory for the note, or no thread
      return false;
    }
  }

  // Waits for the one that is being released: drivers must not end meanwhile.
  void end() {
    std::unique_lock<std::mutex> lock(mutex_);
    is_ending_ = true;
    done_.notify_all();
    done_.wait(lock, [this] { return !is_working_; });
  }

 private:
  struct Item {
    void (*release)(void *);
    void *memory;
  };

  // The thread ends when there is nothing left. Drivers do one thing at a time: whoever gave the memory up is likely to
  // give up more, and should not have to wait for this.
  void work() {
    std::unique_lock<std::mutex> lock(mutex_);
    done_.wait_for(lock, std::chrono::milliseconds(200), [this] { return is_ending_; });
    while (!waiting_.empty() && !is_ending_) {
      const Item item = waiting_.back();
      waiting_.pop_back();
      lock.unlock();
      item.release(item.memory);
      lock.lock();
    }
    is_working_ = false;
    done_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable done_;
  std::vector<Item> waiting_;
  bool is_working_ = false, is_ending_ = false;
};

LaterReleases &later_releases() {
  static LaterReleases &all = *new LaterReleases;  // never destroyed: the thread may be late
#if !defined(_WIN32)
  // Whatever the driver registers was registered before. (Windows ends all threads before anything else.)
  static const int registered = std::atexit([] { later_releases().end(); });
  (void)registered;
#endif
  return all;
}

}  // namespace

void release_later(void (*release)(void *), void *memory) noexcept {
  if (memory && !later_releases().take(release, memory)) release(memory);
}

}  // namespace quickses
