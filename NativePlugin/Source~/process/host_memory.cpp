// SPDX-License-Identifier: MIT
#include "process/host_memory.h"

#if defined(_WIN32)
#include <windows.h>
#else
#include <algorithm>
#include <cstring>

#include <unistd.h>

#include "process/control_groups.h"
#include "process/small_file.h"
#endif

namespace quickses {
namespace {

#if !defined(_WIN32)
// A line of /proc/meminfo, in bytes; 0 where there is none. Nothing is taken from the heap.
uint64_t read_meminfo(const char *name) {
  const SmallFile<4096> meminfo("/proc/meminfo");
  const char *const line = std::strstr(meminfo.text(), name);
  return line ? std::strtoull(line + std::strlen(name), nullptr, 10) * 1024 : 0;
}

uint64_t pages(int name) {
  const long page = sysconf(_SC_PAGESIZE), count = sysconf(name);
  return page > 0 && count > 0 ? static_cast<uint64_t>(page) * static_cast<uint64_t>(count) : 0;
}
#endif

}  // namespace

HostMemoryStatus describe_host_memory() {
#if defined(_WIN32)
  MEMORYSTATUSEX status;
  status.dwLength = sizeof status;
  if (!GlobalMemoryStatusEx(&status)) return {0, 0};
  return {status.ullTotalPhys, status.ullAvailPhys};
#else
  HostMemoryStatus status{pages(_SC_PHYS_PAGES), read_meminfo("MemAvailable:")};
#if defined(_SC_AVPHYS_PAGES)
  if (status.free == 0) status.free = pages(_SC_AVPHYS_PAGES);
#endif
  const GroupMemory group = read_group_memory(kGroupsOfProcess, kMountedGroups);
  if (group.limit < status.total) status.total = group.limit;
  if (group.free < status.free) status.free = std::max<uint64_t>(1, group.free);  // 0: not known
  return status;
#endif
}

}  // namespace quickses
