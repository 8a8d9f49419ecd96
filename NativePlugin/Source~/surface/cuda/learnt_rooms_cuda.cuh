// SPDX-License-Identifier: MIT
// How much room the GPU's stages take for what they count only while they work. Where a guess is too small, a stage
// begins anew; what it learnt is kept, so that it does so once.
#pragma once

#include "parallel/anticipation.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace quickses {
namespace gpu {

constexpr int kRowNeighbors = 128;  // of an atom: as many have room in shared memory

// What was counted, whether there was room for it or not.
struct FeatureCounters {
  unsigned long long caps, circles;
  unsigned long long staged;  // circles with exposed arcs in the upper half, arcs before they are split in the lower
  unsigned long long arcs;
  unsigned long long written_arcs;  // the same, or 0 where there is no room for some
  uint32_t neighbors;               // most of an atom for which the rows were too short
  uint32_t long_atoms;              // number of those atoms
  uint32_t longest_row;             // most caps of an atom
  uint32_t unclear_circles;         // circles that single precision can't tell about
  uint32_t long_circles;            // circles with more exposed intervals than a lane, or a team of them, holds
  uint32_t unfinished_circles;      // those of them that need another launch

  // Of what there is room for, all may be taken: only arcs are gone through by their number.
  static FeatureCounters anticipated(const FeatureCounters &last, const FeatureCounters &most) {
    FeatureCounters c = most;
    c.arcs = std::min(and_some_more(last.arcs), most.arcs);
    c.longest_row = and_some_more(last.longest_row);
    c.unfinished_circles = 0;
    return c;
  }
  bool covers(const FeatureCounters &found) const {
    return found.caps <= caps && found.circles <= circles && (found.staged >> 32) <= (staged >> 32) &&
           (found.staged & 0xffffffffu) <= (staged & 0xffffffffu) && found.arcs <= arcs &&
           found.neighbors <= neighbors && found.long_atoms <= long_atoms && found.longest_row <= longest_row &&
           found.long_circles <= long_circles && found.unfinished_circles <= unfinished_circles;
  }
};

// How much of each there is room for.
struct FeatureRoom {
  size_t caps, circles, staged_circles, staged_arcs, arcs;
  size_t neighbors;   // per atom in global memory; 0: only what shared memory holds
  size_t long_atoms;  // that need it
  size_t intervals;   // per circle in global memory; 0: only what a lane holds

  static FeatureRoom guess(size_t atoms) {
    return {28 * atoms + 1024, 14 * atoms + 512, 3 * atoms + 512, 5 * atoms + 512, 7 * atoms + 1024, 0, 0, 0};
  }
  bool holds(const FeatureCounters &c) const {
    return c.neighbors <= neighbors && c.long_atoms <= long_atoms && c.caps <= caps && c.circles <= circles &&
           (c.staged >> 32) <= staged_circles && (c.staged & 0xffffffffu) <= staged_arcs && c.arcs <= arcs &&
           (c.long_circles == 0 || c.longest_row + 1u <= intervals);
  }
  // So much is counted at most where it holds it. (Where circles need intervals in memory, their number is always
  // waited for.)
  FeatureCounters most() const {
    return {caps,
            circles,
            static_cast<unsigned long long>(staged_circles) << 32 | staged_arcs,
            arcs,
            arcs,
            static_cast<uint32_t>(neighbors),
            static_cast<uint32_t>(long_atoms),
            0,
            0,
            0,
            0};
  }
  size_t longest_row() const { return std::max<size_t>(kRowNeighbors, neighbors); }  // caps of an atom, at most
  // For what was counted.
  static FeatureRoom of(const FeatureCounters &c) {
    return {static_cast<size_t>(c.caps),
            static_cast<size_t>(c.circles),
            static_cast<size_t>(c.staged >> 32),
            static_cast<size_t>(c.staged & 0xffffffffu),
            static_cast<size_t>(c.arcs),
            (c.neighbors + size_t(31)) / 32 * 32,  // keeps the rows aligned
            c.long_atoms,
            c.long_circles > 0 ? c.longest_row + size_t(1) : 0};
  }
  FeatureRoom with_spare() const {
    const auto more = [](size_t n) { return n + n / 8; };
    return {more(caps),        more(circles),  more(staged_circles),
            more(staged_arcs), more(arcs),     (more(neighbors) + 31) / 32 * 32,
            more(long_atoms),  more(intervals)};
  }
  // For some atoms, as this is for others; rows and circles are as long.
  FeatureRoom scaled(size_t atoms, size_t from) const {
    const auto of = [&](size_t n) { return (n * atoms + from - 1) / from; };
    return {of(caps), of(circles), of(staged_circles), of(staged_arcs), of(arcs), neighbors, of(long_atoms), intervals};
  }
  void include(const FeatureRoom &r) {
    *this = {std::max(caps, r.caps),
             std::max(circles, r.circles),
             std::max(staged_circles, r.staged_circles),
             std::max(staged_arcs, r.staged_arcs),
             std::max(arcs, r.arcs),
             std::max(neighbors, r.neighbors),
             std::max(long_atoms, r.long_atoms),
             std::max(intervals, r.intervals)};
  }
};

}  // namespace gpu

// What was learnt serves surfaces that need a few more, too.
constexpr double kRoomToSpare = 1.125;

// Of surfaces of the same number of atoms with the same reach.
struct CudaRooms {
  gpu::FeatureRoom features{};  // of all atoms; 0: the guess was enough
  gpu::FeatureRoom runs{};      // of all atoms, if they were like the most crowded run of them
  // Candidates of bricks and of leaves, and edges that may pass through thin walls, in units of what is usual.
  double listed_atoms = 1, listed_arcs = 1, leaf_atoms = 1, leaf_arcs = 1, walked_edges = 1;
  void forget() { *this = CudaRooms(); }
};

}  // namespace quickses
