// SPDX-License-Identifier: MIT
// GPU driver of the arcs: each lane of a warp finds those of one circle; lanes that are done are given new circles
// together, since most circles are covered after a few balls and some need many. Of few circles, a few lanes find those
// of each.
#pragma once

#include "parallel/cuda_executor.cuh"
#include "parallel/cuda_warp.cuh"
#include "surface/cuda/learnt_rooms_cuda.cuh"
#include "surface/stages/solvent_features.h"

namespace quickses {
namespace gpu {

QSES_FN bool is_far_away(const Sphere &s) { return s.center.x >= 0.5f * kFarAway; }

// The atoms a pass is about.
struct AtomRun {
  uint32_t first, last;
  QSES_FN uint32_t size() const { return last - first; }
};

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
  const CapRange *cap_ranges;
  const Cap *caps;
  const uint32_t *neighbors;
  const uint32_t *circle_first;  // per atom of the run
  uint8_t *exposed;
  Arc *arcs;
  ArcAtoms *arc_atoms;  // of each arc; nullptr: not wanted
  // Made by find_arcs().
  CircleName *names = nullptr;     // of the circles, by atom and rank
  uint32_t *arc_count = nullptr;   // per circle: pieces of arcs
  StagedCircle *staged = nullptr;  // circles with exposed arcs, in any order
  ExposedArc *staged_arcs = nullptr;
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

// What a cap of the atom covers of the circle: a stretch from begin to end, nothing, or all.
enum class CutKind { kNone, kPart, kAll };
__device__ __forceinline__ CutKind cut_by_cap(const OpenCircle &c, const Cap &cap, float *begin, float *end) {
  const HalfPlane<float> h = cut_circle(c.circle, Vec3<float>(cap.axis), cap.cosine - c.shrink);
  if (same_circle(c.circle, h)) return CutKind::kNone;
  if (misses_circle(h)) return covers_circle(h) ? CutKind::kAll : CutKind::kNone;
  covered_stretch(h, begin, end);
  if (*begin == *end) return h.c < 0.f ? CutKind::kAll : CutKind::kNone;
  return CutKind::kPart;
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
    const ExposedArc arc = exposed_arc(intervals.whole ? nullptr : &interval, c.radius, job.max_arc_bound);
    job.staged_arcs[first + k] = arc;
    pieces += 1u << arc.halvings;
  }
  job.arc_count[c.number] = pieces;
}

// Stages what the lanes of a warp have found of a circle each, of which some have one; those that have more intervals
// than they hold are left to find_long_circle_arcs.
template <class Storage>
__device__ __forceinline__ void stage_circles(const CircleJob &job, bool found, const OpenCircle &c,
                                              const ExposedIntervals<Storage> &intervals) {
  if (!__any_sync(kFullWarp, found)) return;
  const int lane = lane_id();
  const bool keep = found && !intervals.overflow;
  if (found && intervals.overflow) job.long_circles[atomicAdd(&job.counters->long_circles, 1u)] = c.number;
  const unsigned long long own = keep ? (1ull << 32) + arcs_of(intervals) : 0;
  const unsigned long long sum = warp_inclusive_sum(own, lane);
  unsigned long long place = 0;
  if (lane == kWarp - 1 && sum > 0) place = atomicAdd(&job.counters->staged, sum);
  place = __shfl_sync(kFullWarp, place, kWarp - 1) + sum - own;
  if (keep) stage_circle(job, c, intervals, place);
}

// Where there are few circles, which leave a GPU idle with a lane for each: so many lanes cut each by as many caps at a
// time.
constexpr int kArcLanes = 4;
static __global__ __launch_bounds__(kArcThreads) void find_few_arcs_kernel(QueuedItems queued, CircleJob job) {
  const LaunchItems circles = queued.in_turn();
  constexpr int kTeams = kArcThreads / kArcLanes;
  __shared__ Interval memory[kLaneIntervals * kTeams];
  const uint32_t listed = job.circle_first[job.run.size()];
  if (listed > job.room.circles) return;  // all will be done again
  const size_t total = listed < circles.last ? listed : circles.last;
  const int team = static_cast<int>(threadIdx.x) / kArcLanes, lane = lane_id(), rank = lane % kArcLanes;
  const size_t first = circles.first + blockIdx.x * size_t(kTeams) + static_cast<size_t>(team);
  if (first - static_cast<size_t>(lane / kArcLanes) >= total) return;
  OpenCircle c{};
  if (first < total) c = open_circle(job, static_cast<uint32_t>(first));
  ExposedIntervals<StridedIntervals> intervals{StridedIntervals{memory + team, kTeams}, kLaneIntervals};
  bool open = first < total;  // of rank 0: not known to be covered
  for (int k0 = 0; __any_sync(kFullWarp, open && rank == 0 && k0 < c.cap_count); k0 += kArcLanes) {
    CutKind cut = CutKind::kNone;
    float begin = 0.f, end = 0.f;
    const int k = k0 + rank;
    if (k < c.cap_count && k != c.rank) cut = cut_by_cap(c, cap_of(job, c, k), &begin, &end);
    __syncwarp();
#pragma unroll
    for (int r = 0; r < kArcLanes; ++r) {
      const CutKind kind = static_cast<CutKind>(__shfl_sync(kFullWarp, static_cast<int>(cut), r, kArcLanes));
      const float from = __shfl_sync(kFullWarp, begin, r, kArcLanes), to = __shfl_sync(kFullWarp, end, r, kArcLanes);
      if (rank == 0 && open && !intervals.overflow && kind != CutKind::kNone) {
        if (kind == CutKind::kPart) intervals.cover(from, to);
        if (kind == CutKind::kAll || (!intervals.overflow && intervals.empty())) open = false;
      }
      __syncwarp();
    }
  }
  stage_circles(job, open && rank == 0, c, intervals);
}

static __global__ __launch_bounds__(kArcThreads) void find_arcs_kernel(QueuedItems queued, CircleJob job,
                                                                       uint32_t chunk) {
  const LaunchItems circles = queued.in_turn();
  __shared__ Interval memory[kLaneIntervals * kArcThreads];
  const StridedIntervals storage{memory + threadIdx.x, kArcThreads};
  enum class State { kIdle, kActive, kDone };
  const int lane = lane_id();
  // Those that are listed: atoms whose caps had no room are counted, but list none.
  const unsigned long long listed = job.circle_first[job.run.size()];
  if (listed > job.room.circles) return;  // all will be done again
  const unsigned long long total = listed < circles.last ? listed : circles.last;
  const uint32_t warps = gridDim.x * kArcThreads / kWarp;
  for (unsigned long long base =
           circles.first + (blockIdx.x * kArcThreads + threadIdx.x) / kWarp * static_cast<unsigned long long>(chunk);
       base < total; base += static_cast<unsigned long long>(warps) * chunk) {
    uint32_t next = static_cast<uint32_t>(base);
    const uint32_t end = static_cast<uint32_t>(base + chunk < total ? base + chunk : total);
    State state = State::kIdle;
    OpenCircle c{};
    ExposedIntervals<StridedIntervals> intervals{storage, kLaneIntervals};
    int k = 0;    // the cap that is next
    Cap ahead{};  // that one, asked for while the one before is looked at
    const auto go_on = [&] {
      if (k == c.rank) ++k;
      if (k < c.cap_count) ahead = cap_of(job, c, k);
    };
    for (;;) {
      const unsigned idle = __ballot_sync(kFullWarp, state != State::kActive);
      if (idle == kFullWarp || (next < end && __popc(idle) >= kIdleLanes)) {
        stage_circles(job, state == State::kDone, c, intervals);
        __syncwarp();
        if (idle == kFullWarp && next >= end) break;
        if (state != State::kActive) {
          const uint32_t number = next + static_cast<uint32_t>(place_in(idle, lane));
          state = State::kIdle;
          if (number < end) {
            c = open_circle(job, number);
            intervals.count = 0;
            intervals.whole = true;
            intervals.overflow = false;
            k = 0;
            go_on();
            state = State::kActive;
          }
        }
        next += static_cast<uint32_t>(__popc(idle));
        __syncwarp();
      }
#pragma unroll
      for (int further = 0; further < kCapsAtOnce; ++further) {
        CutKind cut = CutKind::kNone;
        float begin = 0.f, end_of = 0.f;
        if (state == State::kActive) {
          if (k >= c.cap_count) {
            state = State::kDone;
          } else {
            const Cap cap = ahead;
            ++k;
            go_on();
            cut = cut_by_cap(c, cap, &begin, &end_of);
            if (cut == CutKind::kAll) state = State::kIdle;
          }
        }
        __syncwarp();
        if (cut == CutKind::kPart) {
          intervals.cover(begin, end_of);
          if (intervals.overflow)
            state = State::kDone;
          else if (intervals.empty())
            state = State::kIdle;
        }
        __syncwarp();
      }
    }
  }
}

// How far a thread has come with the long circles that are its own.
struct LongCircleState {
  uint32_t done;       // circles
  int32_t next_cap;    // of the circle at hand
  int32_t count;       // of its intervals
  uint32_t is_partly;  // covered already
};
constexpr uint32_t kLongCircleThreads = 512;
// Each cap can cost as much as there are intervals: a thread that has taken so many steps leaves the rest to the next
// launch.
constexpr uint32_t kLongCircleSteps = 1u << 18;
constexpr uint32_t kCutSteps = 4;  // of one cap of a circle

// The circles that have more exposed intervals, with room for as many as they can have: one more than there are caps.
static __global__ __launch_bounds__(kWarp) void find_long_circle_arcs_kernel(QueuedItems queued, CircleJob job,
                                                                             Interval *memory,
                                                                             LongCircleState *states) {
  const LaunchItems slots = queued.in_turn();
  const uint32_t thread = static_cast<uint32_t>(slots.first) + blockIdx.x * kWarp + threadIdx.x;
  const uint32_t count = job.counters->long_circles;
  LongCircleState state = states[thread];
  uint32_t steps = 0;
  for (;; ++state.done, state.next_cap = 0, state.count = 0, state.is_partly = 0) {
    const uint32_t t = thread + state.done * kLongCircleThreads;
    if (t >= count) break;
    const OpenCircle c = open_circle(job, job.long_circles[t]);
    if (static_cast<size_t>(c.cap_count) + 1 > job.room.intervals) continue;  // all will be done again
    ExposedIntervals<StridedIntervals> intervals{{memory + thread, static_cast<int>(kLongCircleThreads)},
                                                 static_cast<int>(job.room.intervals)};
    intervals.count = state.count;
    intervals.whole = !state.is_partly;
    bool hidden = false;
    int k = state.next_cap;
    for (; k < c.cap_count && !hidden && steps < kLongCircleSteps; ++k) {
      if (k == c.rank) continue;
      float begin, end;
      const CutKind cut = cut_by_cap(c, cap_of(job, c, k), &begin, &end);
      if (cut == CutKind::kPart) intervals.cover(begin, end);
      hidden = cut == CutKind::kAll || intervals.empty();
      steps += kCutSteps + static_cast<uint32_t>(intervals.count);
    }
    if (k < c.cap_count && !hidden) {
      state = {state.done, k, intervals.count, intervals.whole ? 0u : 1u};
      atomicAdd(&job.counters->unfinished_circles, 1u);
      break;
    }
    if (!hidden) stage_circle(job, c, intervals, atomicAdd(&job.counters->staged, (1ull << 32) + arcs_of(intervals)));
  }
  states[thread] = state;
}

// Writes the staged arcs, split, to their places in order.
static __global__ __launch_bounds__(128) void write_arcs_kernel(QueuedItems queued, CircleJob job,
                                                                const uint32_t *arc_first) {
  const LaunchItems items = queued.in_turn();
  if (job.circle_first[job.run.size()] > job.room.circles) return;
  const unsigned long long staged = job.counters->staged;
  const bool fits = (staged >> 32) <= job.room.staged_circles && (staged & 0xffffffffu) <= job.room.staged_arcs;
  if (items.first + blockIdx.x + threadIdx.x == 0) {
    const uint32_t arcs = arc_first[job.room.circles];
    job.counters->arcs = arcs;
    job.counters->written_arcs = fits && arcs <= job.room.arcs ? arcs : 0;
  }
  if (!fits) return;
  const size_t end = (staged >> 32) < items.last ? static_cast<size_t>(staged >> 32) : items.last;
  for (size_t s = items.first + blockIdx.x * blockDim.x + threadIdx.x; s < end; s += gridDim.x * blockDim.x) {
    const StagedCircle staged_circle = job.staged[s];
    const OpenCircle c = open_circle(job, staged_circle.circle);
    const Sphere atom = load(job.atoms.items + c.atom);
    uint32_t place = arc_first[staged_circle.circle];
    for (uint32_t k = 0; k < staged_circle.count; ++k) {
      const ExposedArc arc = job.staged_arcs[staged_circle.first + k];
      const uint32_t pieces = 1u << arc.halvings;
      if (place + size_t(pieces) <= job.room.arcs) {
        write_arc_pieces(c.circle, atom, arc, job.arcs + place);
        for (uint32_t p = 0; job.arc_atoms && p < pieces; ++p) job.arc_atoms[place + p] = {c.atom, c.other};
      }
      place += pieces;
    }
  }
}

// The circles of a run of atoms and their exposed arcs. All in memory of the arena; what is not done yet can go on.
struct ArcSearch {
  CircleJob job;
  float max_radius;
  Span<uint32_t> arc_count, arc_first;
  Span<Interval> long_memory;
  Span<LongCircleState> long_states;
};

// A further launch for the long circles.
template <class E>
void find_long_circle_arcs(E &executor, const ArcSearch &search) {
  if (!E::kCounts) executor.fill(Span<uint32_t>{&search.job.counters->unfinished_circles, 1}, 0);
  executor.launch("find_long_circle_arcs", find_long_circle_arcs_kernel, kLongCircleThreads,
                  LaunchShape{kWarp, kWarp, kLongCircleSteps}, search.job, search.long_memory.data,
                  search.long_states.data);
}

// Puts what is staged in order.
template <class E>
void write_arcs(E &executor, const ArcSearch &search) {
  const CircleJob &job = search.job;
  const FeatureRoom &room = job.room;
  executor.exclusive_scan(room.circles, LoadCount<uint32_t>{search.arc_count.data}, search.arc_first);
  // A circle's arcs are split into no more pieces than its length in Å, and one for each: max_arc_bound() is 1 Å or
  // more.
  const uint64_t intervals = std::max<uint64_t>(kLaneIntervals, room.intervals);
  const uint64_t pieces = static_cast<uint64_t>(6.3f * search.max_radius) + intervals;
  executor.launch("write_arcs", write_arcs_kernel, room.staged_circles,
                  LaunchShape{128, 128, 32 + 4 * pieces,
                              std::min(job.run.size() / 64 + size_t(1), size_t(executor.multiprocessors()) * 16)},
                  job, search.arc_first.data);
}

// The arcs of a run of atoms from their caps. The counters tell what was not finished.
template <class E>
ArcSearch find_arcs(E &executor, CircleJob job, float max_radius) {
  const FeatureRoom &room = job.room;
  const size_t processors = executor.multiprocessors();
  const uint64_t caps = room.longest_row();
  job.names = executor.template allocate<CircleName>(room.circles).data;
  Span<uint32_t> arc_count = executor.template allocate_zeros<uint32_t>(room.circles);
  Span<uint32_t> arc_first = executor.template allocate<uint32_t>(room.circles + 1);
  job.arc_count = arc_count.data;
  job.staged = executor.template allocate<StagedCircle>(room.staged_circles).data;
  job.staged_arcs = executor.template allocate<ExposedArc>(room.staged_arcs).data;
  job.long_circles = executor.template allocate<uint32_t>(room.circles).data;

  executor.launch("list_circles", list_circles_kernel, job.run.size(),
                  LaunchShape{128, 4, 8 + caps / 8, processors * 32}, job);
  if (room.circles * kArcLanes <= processors * kFullThreads) {
    executor.launch("find_few_arcs", find_few_arcs_kernel, room.circles,
                    LaunchShape{kArcThreads, kArcThreads / kArcLanes, kCutSteps * caps}, job);
  } else {
    // Enough warps to fill the GPU, and enough circles per warp to refill its lanes.
    const uint32_t chunk =
        static_cast<uint32_t>(std::min<size_t>(256, std::max<size_t>(kWarp, room.circles / (processors * 64))));
    const uint64_t rounds = chunk / (kWarp - kIdleLanes) + 1;
    executor.launch(
        "find_arcs", find_arcs_kernel, room.circles,
        LaunchShape{kArcThreads, size_t(kArcThreads / kWarp) * chunk, kCutSteps * caps * rounds, processors * 64}, job,
        chunk);
  }
  ArcSearch search{job, max_radius, arc_count, arc_first, {}, {}};
  if (room.intervals > 0) {
    search.long_memory = executor.template allocate<Interval>(kLongCircleThreads * room.intervals);
    search.long_states = executor.template allocate<LongCircleState>(kLongCircleThreads);
    executor.fill(search.long_states, 0);
    find_long_circle_arcs(executor, search);
  }
  write_arcs(executor, search);
  return search;
}

}  // namespace gpu
}  // namespace quickses
