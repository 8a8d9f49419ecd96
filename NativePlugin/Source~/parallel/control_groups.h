// SPDX-License-Identifier: MIT
// What Linux's control groups leave to a program: containers and batch systems limit memory by them, and end a program
// that takes more.
#pragma once

#include <cstdint>

namespace quickses {

struct ControlGroupMemory {
  uint64_t limit = ~uint64_t(0), free = ~uint64_t(0);  // bytes; all bits: there is no limit
};

// The narrowest of the group of the program and of those around it, of either version of control groups. membership: a
// file as /proc/self/cgroup. root: where the groups are mounted.
ControlGroupMemory read_control_groups(const char *membership, const char *root);

}  // namespace quickses
