// SPDX-License-Identifier: MIT
// The CPU's threads, by one of Thrust's parallel systems: TBB, or OpenMP where there is no TBB. Which one is a build
// option; nothing outside this file knows.
#pragma once

#include "parallel/startable_threads.h"
#include "parallel/worker_threads.h"

#if defined(QSES_CPU_SYSTEM_OMP)
#include <omp.h>
#include <thrust/system/omp/execution_policy.h>
#else
#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <thrust/system/tbb/execution_policy.h>
#endif
#include <thrust/for_each.h>
#include <thrust/iterator/counting_iterator.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <thread>

namespace quickses {

class CpuThreads {
 public:
  explicit CpuThreads(const WorkerThreads &threads)
      : count_(threads.count ? threads.count : std::max(1u, std::thread::hardware_concurrency())),
        in_background_(threads.in_background) {}

  unsigned count() const { return count_; }
  bool in_background() const { return in_background_; }

  // How many there are to work. The first call finds out.
  unsigned usable() {
    if (count_ == 1) return 1;
    if (usable_ == 0) {
#if !defined(QSES_CPU_SYSTEM_OMP)
      // More than the machine has are of no use, and TBB would complain on stderr.
      const unsigned wanted = std::min(count_, static_cast<unsigned>(tbb::info::default_concurrency()));
#else
      const unsigned wanted = count_;
#endif
      usable_ = 1 + count_startable_threads(wanted - 1);
#if !defined(QSES_CPU_SYSTEM_OMP)
      arena_.initialize(static_cast<int>(usable_));
#endif
    }
    return usable_ == 1 ? 1 : count_;
  }

  // work(worker) for all workers, by the calling thread and those of the parallel system. False if that had none to
  // give after all: what was left undone is then to be done by the caller.
  template <class Work>
  bool run(size_t workers, const Work &work) {
    const thrust::counting_iterator<size_t> first(0), last(workers);
#if defined(QSES_CPU_SYSTEM_OMP)
    const struct Restore {
      int threads = omp_get_max_threads();
      ~Restore() { omp_set_num_threads(threads); }
    } restore;
    omp_set_num_threads(static_cast<int>(usable_));
    thrust::for_each(thrust::omp::par, first, last, work);
#else
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
#if !defined(QSES_CPU_SYSTEM_OMP)
  tbb::task_arena arena_;
#endif
};

}  // namespace quickses
