// SPDX-License-Identifier: MIT
#include "parallel/worker_threads.h"

#if defined(_WIN32)
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>
#elif defined(__linux__)
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#endif

#include <algorithm>
#include <thread>

namespace quickses {
namespace {

#if defined(_WIN32)

struct Priority {
  bool read() {
    normal_ = GetThreadPriority(GetCurrentThread());
    return normal_ != THREAD_PRIORITY_ERROR_RETURN;
  }
  bool set(bool in_background) {
    const int below = normal_ > THREAD_PRIORITY_BELOW_NORMAL ? THREAD_PRIORITY_BELOW_NORMAL : normal_;
    return SetThreadPriority(GetCurrentThread(), in_background ? below : normal_) != 0;
  }

 private:
  int normal_ = 0;
};

#elif defined(__linux__)

struct Priority {
  bool read() {
    errno = 0;
    normal_ = getpriority(PRIO_PROCESS, thread());  // -1 is a priority too
    return errno == 0;
  }
  bool set(bool in_background) {
    // A tenth of the time of a busy thread of normal priority beside it; half a scale above the least.
    constexpr int kBelow = 10, kLeast = 19;
    const int nice = in_background ? normal_ + kBelow : normal_;
    return setpriority(PRIO_PROCESS, thread(), nice < kLeast ? nice : kLeast) == 0;
  }

 private:
  // Threads have priorities of their own, under their own numbers.
  static id_t thread() { return static_cast<id_t>(syscall(SYS_gettid)); }
  int normal_ = 0;
};

#else

struct Priority {
  bool read() { return false; }
  bool set(bool) { return false; }
};

#endif

thread_local bool stands_back = false, is_known = false;
thread_local Priority priority;

}  // namespace

unsigned processors() noexcept {
#if defined(__linux__)
  // hardware_concurrency() counts the machine's.
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return static_cast<unsigned>(std::max(1, CPU_COUNT(&set)));
#endif
  return std::max(1u, std::thread::hardware_concurrency());
}

void stand_back(bool in_background) noexcept {
  if (in_background == stands_back) return;
  if (!is_known && !priority.read()) return;
  is_known = true;
  priority.set(in_background);
  stands_back = in_background;  // also where it was refused: it would be the next time
}

}  // namespace quickses
