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
  uint32_t *arc_count = nullptr;   // per circle that is listed: pieces of arcs
  uint32_t *atom_arcs = nullptr;   // per atom of the run: of all its circles
  StagedCircle *staged = nullptr;  // circles with exposed arcs, in any order
  ExposedArc *staged_arcs = nullptr;
  // Circles left to find_unclear_arcs, since single precision can't tell what some cap covers of them; nullptr: none
  // is.
  uint32_t *unclear_circles = nullptr;
  uint32_t *long_circles = nullptr;  // circles that need more intervals than a lane, or a team of them, holds
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
      if (owns) {
        job.names[slot] = {i, static_cast<uint32_t>(q)};
        job.arc_count[slot] = 0;
      }
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

// Where the arcs of a circle go that is staged.
struct StagedPlace {
  uint32_t slot, first;  // in both lists
  __device__ __forceinline__ explicit StagedPlace(unsigned long long taken)
      : slot(static_cast<uint32_t>(taken >> 32)), first(static_cast<uint32_t>(taken)) {}
  static __device__ __forceinline__ unsigned long long taken(uint32_t arcs) { return (1ull << 32) + arcs; }
};

// Marks a circle's atoms as exposed; false if there is no room for its arcs.
__device__ __forceinline__ bool begin_circle(const CircleJob &job, const OpenCircle &c, const StagedPlace &place,
                                             uint32_t arcs) {
  job.exposed[c.atom] = 1;
  job.exposed[c.other] = 1;
  if (place.slot >= job.room.staged_circles || place.first + size_t(arcs) > job.room.staged_arcs) return false;
  job.staged[place.slot] = {c.number, place.first, arcs};
  return true;
}
// The arc over an interval, or all of the circle; returns into how many pieces it is split.
__device__ __forceinline__ uint32_t stage_arc(const CircleJob &job, const OpenCircle &c, const Interval *interval,
                                              uint32_t place) {
  const ExposedArc arc = exposed_arc(interval, c.radius, job.max_arc_bound, job.exactly);
  job.staged_arcs[place] = arc;
  return 1u << arc.halvings;
}

__device__ __forceinline__ void count_arcs(const CircleJob &job, const OpenCircle &c, uint32_t pieces) {
  job.arc_count[c.number] = pieces;
  atomicAdd(&job.atom_arcs[c.atom - job.run.first], pieces);
}

// Stages a circle's arcs.
template <class Storage>
__device__ __forceinline__ void stage_circle(const CircleJob &job, const OpenCircle &c,
                                             const ExposedIntervals<Storage> &intervals, const StagedPlace &place) {
  const uint32_t count = arcs_of(intervals);
  if (!begin_circle(job, c, place, count)) return;
  uint32_t pieces = 0;
  for (uint32_t k = 0; k < count; ++k) {
    Interval interval{0.f, 0.f};
    if (!intervals.whole) interval = intervals.interval[static_cast<int>(k)];
    pieces += stage_arc(job, c, intervals.whole ? nullptr : &interval, place.first + k);
  }
  count_arcs(job, c, pieces);
}
// The same of a lane that has one alone.
template <class Storage>
__device__ __forceinline__ void stage_circle(const CircleJob &job, const OpenCircle &c,
                                             ExposedIntervals<Storage> *intervals) {
  intervals->settle();
  if (intervals->empty()) return;
  stage_circle(job, c, *intervals,
               StagedPlace(atomicAdd(&job.counters->staged, StagedPlace::taken(arcs_of(*intervals)))));
}

// Leaves a circle to another kernel: it is unclear, or has more intervals than there is room for.
__device__ __forceinline__ void leave_circle(const CircleJob &job, uint32_t number) {
  if (job.exactly)
    job.unclear_circles[atomicAdd(&job.counters->unclear_circles, 1u)] = number;
  else
    job.long_circles[atomicAdd(&job.counters->long_circles, 1u)] = number;
}

// Places for what lanes of a warp stage, of which some have a circle with so many arcs. All of them call this.
__device__ __forceinline__ StagedPlace places_to_stage(const CircleJob &job, bool has, uint32_t arcs) {
  const int lane = lane_id();
  const unsigned long long own = has ? StagedPlace::taken(arcs) : 0, sum = warp_inclusive_sum(own, lane);
  unsigned long long place = 0;
  if (lane == kWarp - 1 && sum > 0) place = atomicAdd(&job.counters->staged, sum);
  return StagedPlace(__shfl_sync(kFullWarp, place, kWarp - 1) + sum - own);
}

// Stages what the lanes of a warp have found of a circle each, of which some have one; what overflows, by number or as
// unclear, is left to another kernel.
template <class Storage>
__device__ __forceinline__ void stage_circles(const CircleJob &job, bool found, const OpenCircle &c,
                                              ExposedIntervals<Storage> *intervals) {
  if (!__any_sync(kFullWarp, found)) return;
  if (found && intervals->overflow) leave_circle(job, c.number);
  bool keep = found && !intervals->overflow;
  if (keep) intervals->settle();
  keep = keep && !intervals->empty();
  __syncwarp();
  const StagedPlace place = places_to_stage(job, keep, arcs_of(*intervals));
  if (keep) stage_circle(job, c, *intervals, place);
}

}  // namespace gpu
}  // namespace quickses
