// SPDX-License-Identifier: MIT
// The ladder of plans: ways to make the same surface, byte for byte, with less and less memory in more and more time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace quickses {

// Slices are not cut smaller than this, in bricks.
constexpr uint32_t kLeastSlice = 16;
// Nor runs of atoms.
constexpr uint32_t kLeastRun = 128;
// With room for the work on so many bricks at a time, slices cost next to nothing.
constexpr uint32_t kRoomySlice = 4096;

struct MemoryPlan {
  bool single_slice;    // all bricks at once; what signs and vertices share is kept
  bool low_memory;      // features are found in runs of atoms, and only what later stages read is kept
  bool mesh_in_pieces;  // the mesh leaves the device slice by slice; on the CPU it is where it is read anyway
  uint32_t least_slice, most_slice;  // bricks that are worked on at a time, if they are not all
  uint32_t most_atoms;               // whose features are looked for at a time, with low memory

  // Bricks per slice, if there are several, where so many fit.
  uint32_t slice(uint64_t fitting, uint32_t bricks) const {
    const uint64_t wanted = std::min<uint64_t>(most_slice, std::max<uint64_t>(least_slice, fitting));
    return static_cast<uint32_t>(std::min<uint64_t>(bricks, wanted));
  }
};

constexpr uint32_t kAny = ~uint32_t(0);
constexpr MemoryPlan kMemoryPlans[] = {
    {true, false, false, kRoomySlice, kAny, kAny},
    {false, false, false, kRoomySlice, kAny, kAny},
    {false, true, false, kRoomySlice, kAny, kAny},
    {false, true, true, kLeastSlice, kAny, kAny},
    // Bricks and atoms differ: where pieces of the mean size do not fit, smaller ones may.
    {false, true, true, kLeastSlice, 16 * kLeastSlice, 16 * kLeastRun},
    {false, true, true, kLeastSlice, kLeastSlice, kLeastRun},
};
constexpr size_t kMemoryPlanCount = sizeof kMemoryPlans / sizeof kMemoryPlans[0];

}  // namespace quickses
