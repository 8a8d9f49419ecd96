// SPDX-License-Identifier: MIT
// The CPU's threads: TBB's, by Thrust, or the library's own where there is no TBB. Which is a build option; nothing
// outside this file knows.
#pragma once

#include "parallel/worker_threads.h"

#if defined(QSES_CPU_SYSTEM_OWN)
#include "parallel/helper_threads.h"

#include <memory>
#else
#include "parallel/lasting_tbb.h"
#include "parallel/startable_threads.h"

#include <tbb/task_arena.h>
#include <thrust/for_each.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/system/tbb/execution_policy.h>
#endif

#include <algorithm>
#include <cstddef>
#include <exception>
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

  unsigned count() const { return count_; }
  bool in_background() const { return in_background_; }

  // How many there are to work. The first call finds out.
  unsigned usable() {
    if (count_ == 1) return 1;
    if (usable_ == 0) {
      // More than the machine has are of no use, and TBB would complain on stderr.
#if defined(QSES_CPU_SYSTEM_OWN)
      const unsigned there_are = std::thread::hardware_concurrency();
      helpers_ = std::make_unique<HelperThreads>((there_are > 0 ? std::min(count_, there_are) : count_) - 1);
      usable_ = 1 + static_cast<unsigned>(helpers_->count());
#else
      usable_ = 1 + count_startable_threads(std::min(count_, there_are_) - 1);
      if (usable_ > 1) arena_.initialize(static_cast<int>(usable_));
#endif
    }
    return usable_ == 1 ? 1 : count_;
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
      arena_.execute([&] { thrust::for_each(thrust::tbb::par, first, last, work); });
    } catch (const std::exception &) {
      usable_ = 1;
      return false;
    }
#endif
    return true;
  }

 private:
  unsigned count_;
  bool in_background_;
  unsigned usable_ = 0;  // of them; 0: not known yet
#if defined(QSES_CPU_SYSTEM_OWN)
  std::unique_ptr<HelperThreads> helpers_;
#else
  unsigned there_are_ = 1;  // of TBB's
  tbb::task_arena arena_;
#endif
};

}  // namespace quickses
