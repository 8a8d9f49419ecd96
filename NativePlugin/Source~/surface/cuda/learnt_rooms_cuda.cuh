// SPDX-License-Identifier: MIT
// How much room the GPU's stages take for what they count only while they work. Where a guess is too small, a stage
// begins anew; what it learnt is kept, so that it does so once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace quickses {
namespace gpu {

// What was counted, whether there was room for it or not.
struct FeatureCounters {
  unsigned long long caps, circles;
  unsigned long long staged;  // circles with exposed arcs in the upper half, arcs before they are split in the lower
  unsigned long long arcs;
  uint32_t neighbors;     // most of an atom for which the rows were too short
  uint32_t long_atoms;    // number of those atoms
  uint32_t longest_row;   // most caps of an atom
  uint32_t long_circles;  // circles with more exposed intervals than a lane holds
};

// How much of each there is room for.
struct FeatureRoom {
  size_t caps, circles, staged_circles, staged_arcs, arcs;
  size_t neighbors;   // per atom in global memory; 0: only what shared memory holds
  size_t long_atoms;  // that need it; at least so many
  size_t intervals;   // per circle in global memory; 0: only what a lane holds

  static FeatureRoom guess(size_t atoms) {
    return {28 * atoms + 1024, 14 * atoms + 512, 3 * atoms + 512, 5 * atoms + 512, 7 * atoms + 1024, 0, 0, 0};
  }
  bool holds(const FeatureCounters &c) const {
    return c.neighbors <= neighbors && c.caps <= caps && c.circles <= circles && (c.staged >> 32) <= staged_circles &&
           (c.staged & 0xffffffffu) <= staged_arcs && c.arcs <= arcs &&
           (c.long_circles == 0 || c.longest_row + 1u <= intervals);
  }
  // With a bit more than was counted, for the next surface.
  void learn(const FeatureRoom &r) {
    const auto take = [](size_t &own, size_t other) { own = std::max(own, other + other / 8); };
    take(caps, r.caps);
    take(circles, r.circles);
    take(staged_circles, r.staged_circles);
    take(staged_arcs, r.staged_arcs);
    take(arcs, r.arcs);
    neighbors = std::max(neighbors, (r.neighbors + r.neighbors / 8 + 31) / 32 * 32);
    long_atoms = std::max(long_atoms, r.long_atoms);
    take(intervals, r.intervals);
  }
  void hold(const FeatureRoom &r) {
    caps = std::max(caps, r.caps);
    circles = std::max(circles, r.circles);
    staged_circles = std::max(staged_circles, r.staged_circles);
    staged_arcs = std::max(staged_arcs, r.staged_arcs);
    arcs = std::max(arcs, r.arcs);
    neighbors = std::max(neighbors, r.neighbors);
    long_atoms = std::max(long_atoms, r.long_atoms);
    intervals = std::max(intervals, r.intervals);
  }
  void grow(const FeatureCounters &c) {
    neighbors = std::max<size_t>(neighbors, (c.neighbors + size_t(31)) / 32 * 32);  // keeps the rows aligned
    long_atoms = std::max<size_t>(long_atoms, c.long_atoms);
    caps = std::max<size_t>(caps, c.caps);
    circles = std::max<size_t>(circles, c.circles);
    staged_circles = std::max<size_t>(staged_circles, c.staged >> 32);
    staged_arcs = std::max<size_t>(staged_arcs, c.staged & 0xffffffffu);
    arcs = std::max<size_t>(arcs, c.arcs);
    if (c.long_circles > 0) intervals = std::max<size_t>(intervals, c.longest_row + 1u);
  }
};

}  // namespace gpu

// Of surfaces of the same number of atoms with the same reach.
struct CudaRooms {
  gpu::FeatureRoom features{};  // of all atoms; 0: the guess was enough
  double listed_atoms = 1, listed_arcs = 1;  // candidates of bricks, in units of the guess
  void forget() { *this = CudaRooms(); }
};

}  // namespace quickses
