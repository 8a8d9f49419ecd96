// SPDX-License-Identifier: MIT
// Files as the kernel's documentation has them: cgroup-v2.rst, cgroup-v1/memory.rst.
#include "parallel/control_groups.h"

#if !defined(_WIN32)

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "parallel/small_file.h"

namespace quickses {
namespace {

constexpr size_t kPath = 1024;

// Where a version says what about a group.
struct Files {
  const char *mount, *limit, *usage, *cache;  // cache: in memory.stat, what can be given back
};
constexpr Files kVersion2{"", "memory.max", "memory.current", "\ninactive_file "};
constexpr Files kVersion1{"/memory", "memory.limit_in_bytes", "memory.usage_in_bytes", "\ntotal_inactive_file "};

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

uint64_t read_cache(const char *folder, const Files &files) {
  const auto file = file_in<8192>(folder, "memory.stat");
  const char *const line = std::strstr(file.text(), files.cache);
  return line ? std::strtoull(line + std::strlen(files.cache), nullptr, 10) : 0;
}

void include(const char *folder, const Files &files, ControlGroupMemory *memory) {
  uint64_t limit = 0, usage = 0;
  if (!read_number(folder, files.limit, &limit) || !read_number(folder, files.usage, &usage)) return;
  usage -= std::min(usage, read_cache(folder, files));
  memory->limit = std::min(memory->limit, limit);
  memory->free = std::min(memory->free, limit - std::min(limit, usage));
}

// The group at a path, and those around it. In a container the path may be one that is only there outside.
void include_groups(const char *root, const Files &files, const char *group, size_t length,
                    ControlGroupMemory *memory) {
  char folder[kPath];
  const int mount = std::snprintf(folder, sizeof folder, "%s%s", root, files.mount);
  if (mount < 0 || static_cast<size_t>(mount) + length >= sizeof folder) return;
  std::memcpy(folder + mount, group, length);
  for (size_t end = static_cast<size_t>(mount) + length;;) {
    folder[end] = '\0';
    include(folder, files, memory);
    if (end <= static_cast<size_t>(mount)) return;
    do --end;
    while (end > static_cast<size_t>(mount) && folder[end] != '/');
  }
}

}  // namespace

ControlGroupMemory read_control_groups(const char *membership, const char *root) {
  ControlGroupMemory memory;
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
        include_groups(root, kVersion2, group + 1, path, &memory);
      else if (kinds_length < sizeof list - 3 &&
               std::strstr(std::strcat(std::strncat(list, kinds + 1, kinds_length), ","), ",memory,"))
        include_groups(root, kVersion1, group + 1, path, &memory);
    }
    line += length + (line[length] == '\n' ? 1 : 0);
  }
  return memory;
}

}  // namespace quickses

#endif
