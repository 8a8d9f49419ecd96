// SPDX-License-Identifier: MIT
// GPU: the circles in which atoms' spheres meet, listed from their caps; what a cap covers of one, and where the arcs
// that are found of it are staged.
#pragma once

#include "surface/cuda/atom_caps_cuda.cuh"
#include "surface/geometry/close_cut.h"

namespace quickses {
namespace gpu {

// A circle: its atom, and the rank of its cap among the atom's.
struct CircleName {
  uint32_t atom;
  uint32_t rank;
};

struct StagedCircle {
  uint32_t circle;
  uint32_t first, count;  // of its arcs
};

struct CircleJob {
  NeighborGridView atoms;
  AtomRun run;
  float max_arc_bound;
  FeatureRoom room;
  FeatureCounters *counters;
  CapRange *cap_ranges;  // in the end, buried atoms are marked there
  const Cap *caps;
  const uint32_t *neighbors;
  const uint32_t *circle_first;  // per atom of the run
  uint8_t *exposed;
  Arc *arcs;
  ArcAtoms *arc_atoms;  // of each arc; nullptr: not wanted
  bool exactly;         // as if nothing were rounded
  // Made by find_arcs().
  CircleName *names = nullptr;     // of the circles, by atom and rank
  uint32_t *arc_count = nullptr;   // per circle: pieces of arcs
  StagedCircle *staged = nullptr;  // circles with exposed arcs, in any order
  ExposedArc *staged_arcs = nullptr;
  // Circles left to find_unclear_arcs, since single precision can't tell what some cap covers of them; nullptr: none
  // is.
  uint32_t *unclear_circles = nullptr;
  uint32_t *long_circles = nullptr;  // circles that need more intervals than a lane holds
};

constexpr int kArcThreads = 128;
constexpr int kLaneIntervals = 8;  // exposed intervals of a circle that a lane holds
constexpr int kIdleLanes = 8;      // refill when so many have nothing to do, as is asked after so many caps
constexpr int kCapsAtOnce = 2;

// Intervals of one lane, one block's worth apart.
struct StridedIntervals {
  Interval *first;
  int stride;
  __device__ __forceinline__ Interval &operator[](int k) const { return first[k * stride]; }
};

// Lists the circles of each atom: caps behind which a later atom is. A warp per atom.
static __global__ __launch_bounds__(128) void list_circles_kernel(QueuedItems queued, CircleJob job) {
  const LaunchItems atoms = queued.in_turn();
  const int lane = lane_id();
  for (size_t place = atoms.first + (blockIdx.x * blockDim.x + threadIdx.x) / kWarp; place < atoms.last;
       place += gridDim.x * blockDim.x / kWarp) {
    const uint32_t i = job.run.first + static_cast<uint32_t>(place);
    const CapRange range = job.cap_ranges[i];
    uint32_t next = job.circle_first[place];
    if (job.circle_first[place + 1] > job.room.circles) return;  // all will be done again
    for (int q0 = 0; q0 < range.count; q0 += kWarp) {
      const int q = q0 + lane;
      const bool owns = q < range.count && job.neighbors[range.first + static_cast<uint32_t>(q)] > i;
      const uint32_t slot = append_place(owns, &next);
      if (owns) job.names[slot] = {i, static_cast<uint32_t>(q)};
    }
  }
}

// A circle whose arcs are being found.
struct OpenCircle {
  uint32_t number;  // of the circle
  uint32_t atom, other;
  uint32_t first_cap;
  int rank, cap_count;
  float shrink;  // by how much the caps are stored smaller
  float radius;  // of the circle, Å
  Circle circle;
};

__device__ __forceinline__ OpenCircle open_circle(const CircleJob &job, uint32_t number) {
  OpenCircle c;
  const CircleName name = job.names[number];
  const CapRange range = job.cap_ranges[name.atom];
  const float radius = load(job.atoms.items + name.atom).radius;
  c.number = number;
  c.atom = name.atom;
  c.rank = static_cast<int>(name.rank);
  c.first_cap = range.first;
  c.cap_count = range.count;
  c.other = job.neighbors[range.first + name.rank];
  c.shrink = stored_cap_cosine(0.f, radius);
  const Cap cap = load(job.caps + range.first + name.rank);
  c.circle = make_circle(cap.axis, cap.cosine - c.shrink, radius);
  c.radius = radius * c.circle.sine;
  return c;
}

__device__ __forceinline__ Cap cap_of(const CircleJob &job, const OpenCircle &c, int k) {
  return load(job.caps + c.first_cap + static_cast<uint32_t>(k));
}

// What a cap of the atom covers of the circle.
__device__ __forceinline__ CutKind cut_by_cap(const CircleJob &job, const OpenCircle &c, const Cap &cap, float *begin,
                                              float *end) {
  const HalfPlane<float> h = cut_circle(c.circle, Vec3<float>(cap.axis), cap.cosine - c.shrink);
  if (is_unclear(c.circle, h)) {
    if (job.exactly) return CutKind::kUnclear;
    if (same_circle(c.circle, h)) return CutKind::kNone;
  }
  if (misses_circle(h)) return covers_circle(h) ? CutKind::kAll : CutKind::kNone;
  covered_stretch(h, begin, end);
  if (*begin == *end) return h.c < 0.f ? CutKind::kAll : CutKind::kNone;
  return CutKind::kPart;
}

// The same of the k-th cap, with another look where that is unclear. With so many registers that kernels for all
// circles leave it to others.
__device__ __forceinline__ CutKind cut_by_cap_anew(const CircleJob &job, const OpenCircle &c, int k, float *begin,
                                                   float *end) {
  const CutKind kind = cut_by_cap(job, c, cap_of(job, c, k), begin, end);
  if (kind != CutKind::kUnclear) return kind;
  const uint32_t other = job.neighbors[c.first_cap + static_cast<uint32_t>(k)];
  const CircleCut cut = cut_exactly(c.circle, load(job.atoms.items + c.atom), load(job.atoms.items + c.other),
                                    load(job.atoms.items + other));
  *begin = cut.begin;
  *end = cut.end;
  return cut.kind;
}

// Number of arcs, before they are split, of a circle with exposed intervals.
template <class Storage>
__device__ __forceinline__ uint32_t arcs_of(const ExposedIntervals<Storage> &intervals) {
  return intervals.whole ? 1u : static_cast<uint32_t>(intervals.count);
}

// Stages a circle's arcs at a place in both lists, and marks its atoms as exposed.
template <class Storage>
__device__ __forceinline__ void stage_circle(const CircleJob &job, const OpenCircle &c,
                                             const ExposedIntervals<Storage> &intervals, unsigned long long place) {
  job.exposed[c.atom] = 1;
  job.exposed[c.other] = 1;
  const uint32_t slot = static_cast<uint32_t>(place >> 32), first = static_cast<uint32_t>(place);
  const uint32_t count = arcs_of(intervals);
  if (slot >= job.room.staged_circles || first + size_t(count) > job.room.staged_arcs) return;
  job.staged[slot] = {c.number, first, count};
  uint32_t pieces = 0;
  for (uint32_t k = 0; k < count; ++k) {
    Interval interval{0.f, 0.f};
    if (!intervals.whole) interval = intervals.interval[static_cast<int>(k)];
    const ExposedArc arc = exposed_arc(intervals.whole ? nullptr : &interval, c.radius, job.max_arc_bound, job.exactly);
    job.staged_arcs[first + k] = arc;
    pieces += 1u << arc.halvings;
  }
  job.arc_count[c.number] = pieces;
}

// Stages what the lanes of a warp have found of a circle each, of which some have one; what overflows, by number or as
// unclear, is left to another kernel.
template <class Storage>
__device__ __forceinline__ void stage_circles(const CircleJob &job, bool found, const OpenCircle &c,
                                              const ExposedIntervals<Storage> &intervals) {
  if (!__any_sync(kFullWarp, found)) return;
  const int lane = lane_id();
  const bool keep = found && !intervals.overflow;
  if (found && intervals.overflow) {
    if (job.exactly)
      job.unclear_circles[atomicAdd(&job.counters->unclear_circles, 1u)] = c.number;
    else
      job.long_circles[atomicAdd(&job.counters->long_circles, 1u)] = c.number;
  }
  const unsigned long long own = keep ? (1ull << 32) + arcs_of(intervals) : 0;
  const unsigned long long sum = warp_inclusive_sum(own, lane);
  unsigned long long place = 0;
  if (lane == kWarp - 1 && sum > 0) place = atomicAdd(&job.counters->staged, sum);
  place = __shfl_sync(kFullWarp, place, kWarp - 1) + sum - own;
  if (keep) stage_circle(job, c, intervals, place);
}

}  // namespace gpu
}  // namespace quickses
