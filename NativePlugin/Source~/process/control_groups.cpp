// SPDX-License-Identifier: MIT
// Files as the kernel's documentation has them: cgroup-v2.rst, cgroup-v1/memory.rst, scheduler/sched-bwc.rst.
#include "process/control_groups.h"

#if !defined(_WIN32)

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "process/small_file.h"

namespace quickses {
namespace {

constexpr size_t kPath = 1024;

// What a group limits; version 1 has groups of their own for each, mounted here.
struct Controller {
  const char *name, *mount;
};
constexpr Controller kMemory{",memory,", "/memory"}, kProcessors{",cpu,", "/cpu"};

template <size_t kRoom>
SmallFile<kRoom> file_in(const char *folder, const char *name) {
  char path[kPath + 64];
  std::snprintf(path, sizeof path, "%s/%s", folder, name);
  return SmallFile<kRoom>(path);
}

// A number in a file of a group; false if there is none, as "max".
bool read_number(const char *folder, const char *name, uint64_t *number) {
  const auto file = file_in<64>(folder, name);
  char *end = nullptr;
  *number = std::strtoull(file.text(), &end, 10);
  return end != file.text();
}

// visit(folder) for the group at a path, and those around it. In a container the path may be one that is only there
// outside.
template <class Visit>
void visit_groups(const char *root, const char *mounted, const char *group, size_t length, const Visit &visit) {
  char folder[kPath];
  const int mount = std::snprintf(folder, sizeof folder, "%s%s", root, mounted);
  if (mount < 0 || static_cast<size_t>(mount) + length >= sizeof folder) return;
  std::memcpy(folder + mount, group, length);
  for (size_t end = static_cast<size_t>(mount) + length;;) {
    folder[end] = '\0';
    visit(folder);
    if (end <= static_cast<size_t>(mount)) return;
    do --end;
    while (end > static_cast<size_t>(mount) && folder[end] != '/');
  }
}

// visit(folder, whether its files are those of version 2) for all groups of the program that may limit something.
template <class Visit>
void visit_groups(const char *membership, const char *root, const Controller &controller, const Visit &visit) {
  const SmallFile<4096> file(membership);
  // Lines "0::/path" of version 2, "7:cpu,memory:/path" of version 1.
  for (const char *line = file.text(); *line;) {
    const size_t length = std::strcspn(line, "\n");
    const char *const kinds = static_cast<const char *>(std::memchr(line, ':', length));
    const char *const group =
        kinds ? static_cast<const char *>(std::memchr(kinds + 1, ':', length - static_cast<size_t>(kinds + 1 - line)))
              : nullptr;
    if (group) {
      const size_t path = length - static_cast<size_t>(group + 1 - line);
      char list[256] = ",";
      const auto kinds_length = static_cast<size_t>(group - kinds - 1);
      if (kinds_length == 0)
        visit_groups(root, "", group + 1, path, [&](const char *folder) { visit(folder, true); });
      else if (kinds_length < sizeof list - 3 &&
               std::strstr(std::strcat(std::strncat(list, kinds + 1, kinds_length), ","), controller.name))
        visit_groups(root, controller.mount, group + 1, path, [&](const char *folder) { visit(folder, false); });
    }
    line += length + (line[length] == '\n' ? 1 : 0);
  }
}

// Of a group's memory, what can be given back. name: of the line that tells.
uint64_t read_cache(const char *folder, const char *name) {
  const auto file = file_in<8192>(folder, "memory.stat");
  const char *const line = std::strstr(file.text(), name);
  return line ? std::strtoull(line + std::strlen(name), nullptr, 10) : 0;
}

// Time on processors in a period, and the period, in the same unit; false if there is no limit.
bool read_time(const char *folder, bool is_version_2, long long *time, long long *period) {
  if (!is_version_2) {
    *time = std::strtoll(file_in<64>(folder, "cpu.cfs_quota_us").text(), nullptr, 10);  // -1: no limit
    *period = std::strtoll(file_in<64>(folder, "cpu.cfs_period_us").text(), nullptr, 10);
  } else {
    const auto file = file_in<64>(folder, "cpu.max");  // "50000 100000", or "max 100000"
    char *end = nullptr;
    *time = std::strtoll(file.text(), &end, 10);
    *period = std::strtoll(end, nullptr, 10);
  }
  return *time > 0 && *period > 0;
}

}  // namespace

GroupMemory read_group_memory(const char *membership, const char *root) {
  GroupMemory memory;
  visit_groups(membership, root, kMemory, [&](const char *folder, bool is_version_2) {
    uint64_t limit = 0, usage = 0;
    if (!read_number(folder, is_version_2 ? "memory.max" : "memory.limit_in_bytes", &limit) ||
        !read_number(folder, is_version_2 ? "memory.current" : "memory.usage_in_bytes", &usage))
      return;
    usage -= std::min(usage, read_cache(folder, is_version_2 ? "\ninactive_file " : "\ntotal_inactive_file "));
    memory.limit = std::min(memory.limit, limit);
    memory.free = std::min(memory.free, limit - std::min(limit, usage));
  });
  return memory;
}

double read_group_processors(const char *membership, const char *root) {
  double least = 0;
  visit_groups(membership, root, kProcessors, [&](const char *folder, bool is_version_2) {
    long long time = 0, period = 0;
    if (!read_time(folder, is_version_2, &time, &period)) return;
    const double processors = static_cast<double>(time) / static_cast<double>(period);
    least = least > 0 ? std::min(least, processors) : processors;
  });
  return least;
}

}  // namespace quickses

#endif
