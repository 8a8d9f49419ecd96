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

unsigned processors() noexcept {
#if defined(__linux__)
  // hardware_concurrency() counts the machine's.
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return static_cast<unsigned>(std::max(1, CPU_COUNT(&set)));
#endif
  return std::max(1u, std::thread::hardware_concurrency());
}

void stand_back() noexcept {
#if defined(_WIN32)
  const int own = GetThreadPriority(GetCurrentThread());
  if (own != THREAD_PRIORITY_ERROR_RETURN && own > THREAD_PRIORITY_BELOW_NORMAL)
    SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_BELOW_NORMAL);
#elif defined(__linux__)
  // A tenth of the time of a busy thread of normal priority beside it; half a scale above the least. Threads have
  // priorities of their own, under their own numbers, and begin with that of the thread that started them, which may
  // stand back already: normal is what the first thread of the process has.
  constexpr int kBelow = 10, kLeast = 19;
  const auto thread = static_cast<id_t>(syscall(SYS_gettid));
  errno = 0;  // -1 is a priority too
  const int own = getpriority(PRIO_PROCESS, thread), normal = getpriority(PRIO_PROCESS, static_cast<id_t>(getpid()));
  if (errno == 0 && own < normal + kBelow) setpriority(PRIO_PROCESS, thread, std::min(normal + kBelow, kLeast));
#endif
}

}  // namespace quickses
