// SPDX-License-Identifier: MIT
#include "process/worker_threads.h"

#if defined(_WIN32)
#include <windows.h>
#elif defined(__linux__)
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>

#include "process/control_groups.h"
#endif

#include <algorithm>
#include <thread>

namespace quickses {

unsigned hardware_threads() noexcept {
  unsigned count = std::thread::hardware_concurrency();
#if defined(_WIN32)
  // That counts those of one group, of up to 64. From Windows 11 on a process has all groups, unless it was told
  // otherwise.
  USHORT groups[64], group_count = 64;
  if (GetProcessGroupAffinity(GetCurrentProcess(), &group_count, groups) && group_count > 1) {
    count = 0;
    for (USHORT k = 0; k < group_count; ++k) count += static_cast<unsigned>(GetActiveProcessorCount(groups[k]));
  }
#endif
  return std::max(1u, count);
}

unsigned processors() noexcept {
  unsigned count = hardware_threads();
#if defined(__linux__)
  // Those are the machine's.
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) count = static_cast<unsigned>(std::max(1, CPU_COUNT(&set)));
  // Threads that are more than there is time for use it up, and then all of them stand still.
  static const double time_for = read_group_processors(kGroupsOfProcess, kMountedGroups);
  if (time_for > 0 && time_for < count) count = static_cast<unsigned>(std::ceil(time_for));
#endif
  return count;
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
