// SPDX-License-Identifier: MIT
// What Linux's control groups leave to a program: containers and batch systems limit memory and time of processors by
// them. They end a program that takes more memory, and stop one for a while that takes more time.
#pragma once

#include <cstdint>

namespace quickses {

struct GroupMemory {
  uint64_t limit = ~uint64_t(0), free = ~uint64_t(0);  // bytes; all bits: there is no limit
};

// The narrowest of the group of the program and of those around it, of either version of control groups. membership: a
// file as /proc/self/cgroup. root: where the groups are mounted.
GroupMemory read_group_memory(const char *membership, const char *root);
// The same of processors: for how many there is time, perhaps for a part of one. 0: there is no limit.
double read_group_processors(const char *membership, const char *root);

// Where Linux has them.
constexpr const char *kGroupsOfProcess = "/proc/self/cgroup", *kMountedGroups = "/sys/fs/cgroup";

}  // namespace quickses
