// SPDX-License-Identifier: MIT
// The CPU's threads: TBB's, by Thrust, or the library's own where there is no TBB. Which is a build option; nothing
// outside this file knows.
#pragma once

#include "parallel/worker_threads.h"
#include "parallel/working_thread.h"

#if defined(QSES_CPU_SYSTEM_OWN)
#include "parallel/helper_threads.h"
#else
#include "parallel/lasting_tbb.h"
#include "parallel/startable_threads.h"

#include <tbb/task_arena.h>
#include <thrust/for_each.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/system/tbb/execution_policy.h>
#endif

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <memory>
#include <thread>

namespace quickses {

class CpuThreads {
 public:
  explicit CpuThreads(const WorkerThreads &threads)
      : count_(threads.count ? threads.count : std::max(1u, std::thread::hardware_concurrency())),
        in_background_(threads.in_background) {
#if !defined(QSES_CPU_SYSTEM_OWN)
    // Now, not when there is something to do: the process may be ending then.
    if (count_ > 1) there_are_ = threads_of_tbb();
#endif
  }
#if !defined(QSES_CPU_SYSTEM_OWN)
  ~CpuThreads() {
    if (arena_ && !is_tbb_of_this_process()) arena_.release();
  }
#endif

  unsigned count() const { return count_; }

  // body(worker, chunk) for all chunks, each taken by the next thread that is free; workers count from 0, and are no
  // more than count(). stop: the flag of look_for_stop() meanwhile, or nullptr. What one of them throws is thrown here.
  template <class Body>
  void share_out(size_t chunks, const std::atomic<bool> *stop, const Body &body) {
    if (chunks == 0) return;
    // That workers see what was done before them, and the caller what they did, is also said here: the thread sanitizer
    // knows nothing of what a parallel system makes sure of.
    std::atomic<size_t> next{0}, ended{0};
    // What one thread throws (memory that is refused) ends all of them and is thrown again here: not every parallel
    // system lets exceptions out.
    std::exception_ptr thrown;
    std::atomic<bool> failed{false};
    const std::thread::id caller = std::this_thread::get_id();
    const auto work = [&](size_t worker) {
      const WorkScope scope(stop);
      try {
        for (size_t c; !failed && (c = next.fetch_add(1, std::memory_order_acquire)) < chunks;) {
          if (std::this_thread::get_id() != caller) stand_back(in_background_);
          look_for_stop();
          body(worker, c);
        }
      } catch (...) {
        if (!failed.exchange(true)) thrown = std::current_exception();
      }
      ended.fetch_add(1, std::memory_order_release);
    };
    next.store(0, std::memory_order_release);
    const size_t workers = std::min<size_t>(chunks > 1 ? usable() : 1, chunks);
    if (workers == 1 || !run(workers, work)) work(0);
    if (ended.load(std::memory_order_acquire) > 0 && thrown) std::rethrow_exception(thrown);
  }

 private:
  // How many there are to work. The first call finds out; where that itself is refused, the caller is alone this time.
  unsigned usable() {
    if (count_ == 1) return 1;
#if !defined(QSES_CPU_SYSTEM_OWN)
    if (!is_tbb_of_this_process()) return 1;
#endif
    try {
      if (usable_ == 0) find_usable();
    } catch (const std::exception &) {
      usable_ = 0;
      return 1;
    }
    return usable_ == 1 ? 1 : count_;
  }
  void find_usable() {
    // More than the machine has are of no use, and TBB would complain on stderr.
#if defined(QSES_CPU_SYSTEM_OWN)
    const unsigned there_are = std::thread::hardware_concurrency();
    helpers_ = std::make_unique<HelperThreads>((there_are > 0 ? std::min(count_, there_are) : count_) - 1);
    usable_ = 1 + static_cast<unsigned>(helpers_->count());
#else
    usable_ = 1 + count_startable_threads(std::min(count_, there_are_) - 1);
    if (usable_ == 1) return;
    arena_ = std::make_unique<tbb::task_arena>(static_cast<int>(usable_));
    arena_->initialize();
#endif
  }

  // work(worker) for workers from 0 on, by the calling thread and those that help. False if TBB had none to give after
  // all: what was left undone is then to be done by the caller.
  template <class Work>
  bool run(size_t workers, const Work &work) {
#if defined(QSES_CPU_SYSTEM_OWN)
    helpers_->run(
        workers, [](const void *of, size_t worker) { (*static_cast<const Work *>(of))(worker); }, &work);
#else
    const thrust::counting_iterator<size_t> first(0), last(workers);
    try {
      arena_->execute([&] { thrust::for_each(thrust::tbb::par, first, last, work); });
    } catch (const std::exception &) {
      usable_ = 1;
      return false;
    }
#endif
    return true;
  }

  unsigned count_;
  bool in_background_;
  unsigned usable_ = 0;  // of them; 0: not known yet
#if defined(QSES_CPU_SYSTEM_OWN)
  std::unique_ptr<HelperThreads> helpers_;
#else
  unsigned there_are_ = 1;  // of TBB's
  std::unique_ptr<tbb::task_arena> arena_;
#endif
};

}  // namespace quickses
