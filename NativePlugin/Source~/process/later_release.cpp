// SPDX-License-Identifier: MIT
#include "process/later_release.h"

#include "process/work_before_exit.h"

#include <chrono>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <vector>

namespace quickses {
namespace {

WorkBeforeExit releasing;  // drivers must not end meanwhile

class LaterReleases {
 public:
  // False: it is the caller's still.
  bool take(void (*release)(void *), void *memory) noexcept {
    try {
      const std::lock_guard<std::mutex> lock(mutex_);
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

 private:
  struct Item {
    void (*release)(void *);
    void *memory;
  };

  // The thread ends when there is nothing left. Drivers do one thing at a time: whoever gave the memory up is likely to
  // give up more, and should not have to wait for this.
  void work() {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    std::unique_lock<std::mutex> lock(mutex_);
    while (!waiting_.empty()) {
      const Item item = waiting_.back();
      waiting_.pop_back();
      lock.unlock();
      releasing.run([&] { item.release(item.memory); });
      lock.lock();
    }
    is_working_ = false;
  }

  std::mutex mutex_;
  std::vector<Item> waiting_;
  bool is_working_ = false;
};

LaterReleases &later_releases() {
  // Never destroyed, since the thread may be late; and there where no memory is left.
  alignas(LaterReleases) static unsigned char memory[sizeof(LaterReleases)];
  static LaterReleases &all = *new (memory) LaterReleases;
  // Whatever the driver registers was registered before.
  static const int registered = std::atexit([] { releasing.end(); });
  (void)registered;
  return all;
}

}  // namespace

void release_later(void (*release)(void *), void *memory) noexcept {
  if (memory && !later_releases().take(release, memory)) release(memory);
}

}  // namespace quickses
