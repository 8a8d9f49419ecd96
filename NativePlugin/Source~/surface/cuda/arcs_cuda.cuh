// SPDX-License-Identifier: MIT
// GPU driver of the arcs: each lane of a warp finds those of one circle; lanes that are done are given new circles
// together, since most circles are covered after a few balls and some need many. Of few circles, a team of lanes finds
// those of each.
#pragma once

#include "surface/cuda/circles_cuda.cuh"

#include <algorithm>

namespace quickses {
namespace gpu {

// Where there are few circles, which leave a GPU idle with a lane for each, a team of lanes cuts each by as many caps
// at a time. What is exposed of it, as ExposedIntervals has it.
constexpr int kArcLanes = 16;
constexpr size_t kFewTurns = 4;  // of teams that fill the GPU: more circles are many
struct TeamIntervals {
  struct Memory {
    Interval stretch[kArcLanes], exposed[kArcLanes];
  };
  Memory &memory;
  int count = 0;
  bool whole = true;

  __device__ __forceinline__ bool empty() const { return !whole && count == 0; }

  // Covers a stretch for each lane that has one: what is left begins where an interval does or a stretch ends that some
  // interval has, unless a stretch has that too, and reaches to where the next stretch begins or the interval ends. By
  // all teams of a warp together. False if more are left than lanes.
  __device__ __forceinline__ bool cover(bool has_stretch, const Interval &stretch) {
    const int rank = rank_in_team<kArcLanes>();
    const unsigned team = lanes_of_team<kArcLanes>();
    int stretches = 0, left = 0;
    const int own_place = append_place(has_stretch, &stretches, team);
    if (has_stretch) memory.stretch[own_place] = stretch;
    __syncwarp();
    bool has_first = rank < count, has_second = has_stretch;
    Interval first{0.f, 0.f}, second{stretch.end, stretch.begin};
    for (int r = 0; r < stretches; ++r) {
      const Interval other = memory.stretch[r];
      has_second &=
          !(comes_before(other.begin, second.begin, other.end) || (r < own_place && other.end == second.begin));
    }
    if (count > 0) {  // few rounds come here: their loops are kept short
      first = memory.exposed[rank];
      bool within = false;
#pragma unroll 1
      for (int r = 0; r < count; ++r) {
        const Interval other = memory.exposed[r];
        if (other.begin == second.begin || !comes_before(other.begin, second.begin, other.end)) continue;
        within = true;
        second.end = other.end;
      }
      has_second &= within;
#pragma unroll 1
      for (int r = 0; r < stretches; ++r) {
        const Interval other = memory.stretch[r];
        has_first &= !comes_before(other.begin, first.begin, other.end);
        if (comes_before(first.begin, other.begin, first.end)) first.end = other.begin;
      }
    }
    __syncwarp();
    const int first_place = append_place(has_first, &left, team), second_place = append_place(has_second, &left, team);
    whole &= stretches == 0;
    count = left <= kArcLanes ? left : 0;
    if (count > 0) {
#pragma unroll 1
      for (int r = 0; r < stretches; ++r) {
        const float begin = memory.stretch[r].begin;
        if (comes_before(second.begin, begin, second.end)) second.end = begin;
      }
      if (has_first) memory.exposed[first_place] = first;
      if (has_second) memory.exposed[second_place] = second;
    }
    __syncwarp();
    return left <= kArcLanes;
  }
};

// What a team has found.
__device__ __forceinline__ void stage_circle_of_team(const CircleJob &job, bool found, const OpenCircle &c,
                                                     const TeamIntervals &exposed) {
  if (!__any_sync(kFullWarp, found)) return;
  const int rank = rank_in_team<kArcLanes>();
  Interval own{0.f, 0.f};
  if (rank < exposed.count) own = exposed.memory.exposed[rank];
  const bool has = exposed.whole ? rank == 0 : rank < exposed.count && !is_sliver(own);
  const unsigned kept = ballot_of_team<kArcLanes>(has);
  const uint32_t arcs = static_cast<uint32_t>(__popc(kept));
  uint32_t order = 0;
  for (unsigned rest = kept; rest; rest &= rest - 1)
    order += exposed.memory.exposed[lowest_bit32(rest) % kArcLanes].begin < own.begin && !exposed.whole ? 1 : 0;
  __syncwarp();
  found = found && arcs > 0;
  StagedPlace place = places_to_stage(job, found && rank == 0, arcs);
  place.slot = __shfl_sync(kFullWarp, place.slot, 0, kArcLanes);
  place.first = __shfl_sync(kFullWarp, place.first, 0, kArcLanes);
  const bool fits = found && begin_circle(job, c, place, arcs);
  uint32_t pieces = 0;
  if (fits && has) pieces = stage_arc(job, c, exposed.whole ? nullptr : &own, place.first + order);
  __syncwarp();
  pieces = fold_lanes<kArcLanes>(pieces, [](uint32_t a, uint32_t b) { return a + b; });
  if (fits && rank == 0) count_arcs(job, c, pieces);
}

static __global__ __launch_bounds__(kArcThreads,
                                    blocks_at_once(kArcThreads, 10)) void find_few_arcs_kernel(QueuedItems queued,
                                                                                               CircleJob job) {
  const LaunchItems circles = queued.in_turn();
  constexpr int kTeams = kArcThreads / kArcLanes;
  __shared__ TeamIntervals::Memory memory[kTeams];
  const uint32_t listed = job.circle_first[job.run.size()];
  if (listed > job.room.circles) return;  // all will be done again
  const size_t total = listed < circles.last ? listed : circles.last;
  const int team = static_cast<int>(threadIdx.x) / kArcLanes, rank = rank_in_team<kArcLanes>();
  const size_t number = circles.first + blockIdx.x * size_t(kTeams) + static_cast<size_t>(team);
  if (number - static_cast<size_t>(lane_id() / kArcLanes) >= total) return;
  bool open = number < total;  // not known to be covered, nor left to another kernel
  OpenCircle c{};
  if (open) c = open_circle(job, static_cast<uint32_t>(number));
  TeamIntervals exposed{memory[team]};
  for (int k0 = 0; __any_sync(kFullWarp, open && k0 < c.cap_count); k0 += kArcLanes) {
    CutKind cut = CutKind::kNone;
    Interval stretch{0.f, 0.f};
    const int k = k0 + rank;
    if (open && k < c.cap_count && k != c.rank)
      cut = cut_by_cap(job, c, cap_of(job, c, k), &stretch.begin, &stretch.end);
    __syncwarp();
    const bool hidden = ballot_of_team<kArcLanes>(cut == CutKind::kAll) != 0;
    const bool unclear = ballot_of_team<kArcLanes>(cut == CutKind::kUnclear) != 0;
    open &= !hidden && !unclear;
    const bool fits = exposed.cover(open && cut == CutKind::kPart, stretch);
    if (rank == 0 && !hidden && (unclear || (open && !fits))) leave_circle(job, c.number);
    open &= fits && !exposed.empty();
  }
  stage_circle_of_team(job, open, c, exposed);
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
        stage_circles(job, state == State::kDone, c, &intervals);
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
            cut = cut_by_cap(job, c, cap, &begin, &end_of);
            if (cut == CutKind::kAll) state = State::kIdle;
            if (cut == CutKind::kUnclear) {
              intervals.overflow = true;
              state = State::kDone;
            }
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

constexpr uint32_t kCutSteps = 4;        // of one cap of a circle
constexpr uint32_t kCutAnewSteps = 256;  // in double precision

// The circles that are unclear. A lane each; those that have more intervals than it holds are left to
// find_long_circle_arcs.
static __global__ __launch_bounds__(kWarp) void find_unclear_arcs_kernel(QueuedItems queued, CircleJob job) {
  const LaunchItems places = queued.in_turn();
  __shared__ Interval memory[kLaneIntervals * kWarp];
  const size_t count = job.counters->unclear_circles, end = count < places.last ? count : places.last;
  for (size_t t = places.first + blockIdx.x * kWarp + threadIdx.x; t < end; t += gridDim.x * kWarp) {
    const OpenCircle c = open_circle(job, job.unclear_circles[t]);
    ExposedIntervals<StridedIntervals> intervals{StridedIntervals{memory + threadIdx.x, kWarp}, kLaneIntervals};
    bool hidden = false;
    for (int k = 0; k < c.cap_count && !hidden && !intervals.overflow; ++k) {
      if (k == c.rank) continue;
      float begin, end_of;
      const CutKind cut = cut_by_cap_anew(job, c, k, &begin, &end_of);
      if (cut == CutKind::kPart) intervals.cover(begin, end_of);
      hidden = cut == CutKind::kAll || (!intervals.overflow && intervals.empty());
    }
    if (intervals.overflow)
      job.long_circles[atomicAdd(&job.counters->long_circles, 1u)] = c.number;
    else if (!hidden)
      stage_circle(job, c, &intervals);
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
constexpr uint32_t kSortSteps = 32;  // of an interval, in the end
// Each cap can cost as much as there are intervals: a thread that has taken so many steps leaves the rest to the next
// launch.
constexpr uint32_t kLongCircleSteps = 1u << 18;

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
      const CutKind cut = cut_by_cap_anew(job, c, k, &begin, &end);
      if (cut == CutKind::kPart) intervals.cover(begin, end);
      hidden = cut == CutKind::kAll || intervals.empty();
      steps += (job.exactly ? kCutAnewSteps : kCutSteps) + static_cast<uint32_t>(intervals.count);
    }
    if (k < c.cap_count && !hidden) {
      state = {state.done, k, intervals.count, intervals.whole ? 0u : 1u};
      atomicAdd(&job.counters->unfinished_circles, 1u);
      break;
    }
    if (!hidden) {
      stage_circle(job, c, &intervals);
      steps += kSortSteps * static_cast<uint32_t>(intervals.count);
    }
  }
  states[thread] = state;
}

// Writes the staged arcs, split, to their places in order. And atoms that are not exposed are marked as buried, once no
// circle is left: those of later runs are none of theirs, since a circle is the earlier atom's.
static __global__ __launch_bounds__(128) void write_arcs_kernel(QueuedItems queued, CircleJob job,
                                                                const uint32_t *arc_first) {
  const LaunchItems items = queued.in_turn();
  const size_t first = items.first + blockIdx.x * blockDim.x + threadIdx.x, step = gridDim.x * blockDim.x;
  if (job.counters->unfinished_circles == 0)
    for (size_t k = first; k < items.last && k < job.run.size(); k += step)
      if (!job.exposed[job.run.first + k]) job.cap_ranges[job.run.first + k].count = kBuriedAtom;
  if (job.circle_first[job.run.size()] > job.room.circles) return;
  const unsigned long long staged = job.counters->staged;
  const bool fits = (staged >> 32) <= job.room.staged_circles && (staged & 0xffffffffu) <= job.room.staged_arcs;
  if (first == 0) {
    const uint32_t arcs = arc_first[job.run.size()];
    job.counters->arcs = arcs;
    job.counters->written_arcs = fits && arcs <= job.room.arcs ? arcs : 0;
  }
  if (!fits) return;
  const size_t end = (staged >> 32) < items.last ? static_cast<size_t>(staged >> 32) : items.last;
  for (size_t s = first; s < end; s += step) {
    const StagedCircle staged_circle = job.staged[s];
    const OpenCircle c = open_circle(job, staged_circle.circle);
    const Sphere atom = load(job.atoms.items + c.atom);
    const uint32_t atom_of_run = c.atom - job.run.first;
    uint32_t place = arc_first[atom_of_run];  // behind the arcs of its circles before: they are few
    for (uint32_t k = job.circle_first[atom_of_run]; k < c.number; ++k) place += job.arc_count[k];
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
  Span<uint32_t> arc_first;  // per atom of the run
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
  executor.exclusive_scan(job.run.size(), LoadCount<uint32_t>{job.atom_arcs}, search.arc_first);
  // A circle's arcs are split into no more pieces than its length in Å, and one for each: max_arc_bound() is 1 Å or
  // more.
  const uint64_t intervals = std::max({uint64_t(kLaneIntervals), uint64_t(kArcLanes), uint64_t(room.intervals)});
  const uint64_t pieces = static_cast<uint64_t>(6.3f * search.max_radius) + intervals;
  executor.launch("write_arcs", write_arcs_kernel, std::max(room.staged_circles, size_t(job.run.size())),
                  LaunchShape{128, 128, 32 + 4 * pieces + room.longest_row() / 2,
                              std::min(job.run.size() / 64 + size_t(1), blocks_in_turns(executor))},
                  job, search.arc_first.data);
}

// The arcs of a run of atoms from their caps. The counters tell what was not finished.
template <class E>
ArcSearch find_arcs(E &executor, CircleJob job, float max_radius) {
  const FeatureRoom &room = job.room;
  const size_t processors = executor.multiprocessors();
  const uint64_t caps = room.longest_row();
  job.names = executor.template allocate<CircleName>(room.circles).data;
  job.arc_count = executor.template allocate<uint32_t>(room.circles).data;
  job.atom_arcs = executor.template allocate_zeros<uint32_t>(job.run.size()).data;
  const Span<uint32_t> arc_first = executor.template allocate<uint32_t>(job.run.size() + size_t(1));
  job.staged = executor.template allocate<StagedCircle>(room.staged_circles).data;
  job.staged_arcs = executor.template allocate<ExposedArc>(room.staged_arcs).data;
  if (job.exactly) job.unclear_circles = executor.template allocate<uint32_t>(room.circles).data;
  job.long_circles = executor.template allocate<uint32_t>(room.circles).data;

  executor.launch("list_circles", list_circles_kernel, job.run.size(),
                  LaunchShape{128, 4, 8 + caps / 8, processors * 32}, job);
  if (room.circles * kArcLanes <= kFewTurns * processors * kFullThreads) {
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
  if (job.exactly)
    executor.launch("find_unclear_arcs", find_unclear_arcs_kernel, room.circles,
                    LaunchShape{kWarp, kWarp, (kCutSteps + kCutAnewSteps) * caps, processors * 32}, job);
  ArcSearch search{job, max_radius, arc_first, {}, {}};
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
