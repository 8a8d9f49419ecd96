// SPDX-License-Identifier: MIT
// The CPU's threads. Which they are nothing outside this file knows.
#pragma once

#include "parallel/working_thread.h"
#include "process/helper_threads.h"
#include "process/worker_threads.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <memory>
#include <new>

namespace quickses {

class CpuThreads {
 public:
  explicit CpuThreads(const WorkerThreads &threads)
      : count_(threads.count ? threads.count : hardware_threads()), in_background_(threads.in_background) {}

  unsigned count() const { return count_; }
  // How many of them work at a time: more than there are processors are of no use.
  unsigned at_a_time() const { return std::min(count_, processors()); }

  // body(worker, chunk) for all chunks, each taken by the next thread that is free; workers count from 0, and are no
  // more than count(). stop: the flag of look_for_stop() meanwhile, or nullptr. What one of them throws is thrown here.
  template <class Body>
  void share_out(size_t chunks, const std::atomic<bool> *stop, const Body &body) {
    if (chunks == 0) return;
    std::atomic<size_t> next{0};
    // What one thread throws (memory that is refused) ends all of them and is thrown again here.
    std::exception_ptr thrown;
    std::atomic<bool> failed{false};
    const auto work = [&](size_t worker) {
      const WorkScope scope(stop);
      try {
        for (size_t c; !failed && (c = next++) < chunks;) {
          look_for_stop();
          body(worker, c);
        }
      } catch (...) {
        if (!failed.exchange(true)) thrown = std::current_exception();
      }
    };
    const size_t workers = std::min<size_t>(chunks > 1 ? usable() : 1, chunks);
    if (workers == 1)
      work(0);
    else
      helpers_->run(
          workers, [](const void *of, size_t worker) { (*static_cast<decltype(&work)>(of))(worker); }, &work);
    if (thrown) std::rethrow_exception(thrown);
  }

 private:
  // How many there are to work. The first call starts them; where memory for that is refused, the caller is alone this
  // time.
  unsigned usable() {
    if (count_ == 1) return 1;
    try {
      if (!helpers_) helpers_ = std::make_unique<HelperThreads>(at_a_time() - 1, in_background_);
    } catch (const std::bad_alloc &) {
      return 1;
    }
    return helpers_->count() == 0 ? 1 : count_;
  }

  unsigned count_;
  bool in_background_;
  std::unique_ptr<HelperThreads> helpers_;
};

}  // namespace quickses
