// SPDX-License-Identifier: MIT
// GPU: edges that may pass through thin walls. A thread per leaf finds by signs which they are; then, by a thread per
// first end and a thread per edge, those are dropped that the probes nearest to their ends cover, which signs have left
// behind.
#pragma once

#include "surface/cuda/vertex_candidates_cuda.cuh"
#include "surface/stages/thin_walls.h"

#include <algorithm>

namespace quickses {
namespace gpu {

// Leaves that have edges which may be walls, and edges that are left to be walked.
struct WallCounters {
  uint32_t leaves;
  unsigned long long walks;

  static WallCounters anticipated(const WallCounters &last, const WallCounters &most) {
    return {most.leaves, std::min(and_some_more(last.walks), most.walks)};
  }
  bool covers(const WallCounters &found) const { return found.leaves <= leaves && found.walks <= walks; }
};

struct WallJob {
  FeatureView features;
  BrickSet bricks;
  CandidateReach reach;
  CandidateView view;
  const uint64_t *signs;
  uint64_t *marks;
  WallCounters *counters;
  uint32_t first_slot;  // of the slice
  uint32_t *leaves;     // slots of those that have edges
  uint64_t *edges;      // edges_of()
  uint64_t *walks;      // 64 * kWallSteps * slot + 64 * step + bit
  unsigned long long walk_room;
  int run_room;         // of shared memory for what edges of a warp choose together; 0: they do not
  bool has_short_cuts;  // whether what rules edges out without a walk is what walks would find

  // Those of a leaf that may be walls: kWallSteps words.
  __device__ __forceinline__ uint64_t *edges_of(uint32_t slot) const {
    return edges + size_t(slot - first_slot) * kWallSteps;
  }
};

// Where coordinates are coarse beside the steps of a walk it may not be. An edge between two slices that share
// nothing is walked for lack of knowledge, and would be a wall there that is none in a mesh made as a whole.
inline bool short_cuts_hold(const Lattice &lattice) {
  constexpr float kRounding = 0x1p-24f;
  const glm::ivec3 first = glm::abs(lattice.first_brick), last = glm::abs(lattice.first_brick + lattice.brick_count);
  const int farthest = std::max({first.x, first.y, first.z, last.x, last.y, last.z});
  return static_cast<float>(farthest) * lattice.brick_size() * kRounding < 0.25f * kWallStep;
}

constexpr int kWallThreads = 128;
constexpr int kWallWarps = kWallThreads / kWarp;

// A thread per leaf of the slice.
static __global__ __launch_bounds__(kWallThreads, 6) void find_wall_candidates_kernel(QueuedItems queued, WallJob job) {
  const LaunchItems items = queued.in_turn();
  const size_t k = items.first + blockIdx.x * size_t(kWallThreads) + threadIdx.x;
  const bool on = k < items.last;
  const uint32_t slot = job.first_slot + static_cast<uint32_t>(on ? k : items.first);
  const int leaf = static_cast<int>(slot % kLeavesPerBrick),
            brick = static_cast<int>(job.view.first_brick + slot / kLeavesPerBrick);
  const glm::ivec3 place = job.bricks.place(brick);
  const auto leaf_at = [&](int n) { return glm::ivec3(leaf & 1, leaf >> 1 & 1, leaf >> 2) + neighbor_step(n); };
  int found[kNeighborhood];
  job.bricks.find_each<kNeighborhood>(
      [&](int n) {
        const glm::ivec3 p = leaf_at(n);
        return place + glm::ivec3(p.x >> 1, p.y >> 1, p.z >> 1);
      },
      found);
  LeafNeighborhood words;
#pragma unroll
  for (int n = 0; n < kNeighborhood; ++n)
    words.at[n] =
        word_of_leaf(leaf_at(n), found[n] < 0 ? nullptr : job.signs + static_cast<size_t>(found[n]) * kLeavesPerBrick);
  uint64_t edges[kWallSteps];
  const bool any = on && find_wall_candidates(words, edges);
  if (any) {
#pragma unroll
    for (int s = 0; s < kWallSteps; ++s) job.edges_of(slot)[s] = edges[s];
  }
  append(job.leaves, &job.counters->leaves, slot, any);
}

// An edge of a slice.
struct WallEdge {
  uint32_t brick;  // of the set
  uint32_t slot;
  int step, bit;
  // Points, counted from the first one of the brick.
  __device__ __forceinline__ glm::ivec3 first() const {
    return brick_point(static_cast<int>(slot % kLeavesPerBrick), bit);
  }
  __device__ __forceinline__ glm::ivec3 second() const { return first() + wall_step(step); }
};
__device__ __forceinline__ WallEdge wall_edge(const WallJob &job, uint32_t slot, int step, int bit) {
  return {job.view.first_brick + slot / kLeavesPerBrick, slot, step, bit};
}
// By its number in the list.
__device__ __forceinline__ WallEdge edge_to_walk(const WallJob &job, uint64_t item) {
  return wall_edge(job, static_cast<uint32_t>(item / (64 * kWallSteps)), static_cast<int>(item / 64 % kWallSteps),
                   static_cast<int>(item % 64));
}
__device__ __forceinline__ Vec3<float> wall_point(const WallJob &job, uint32_t brick, const glm::ivec3 &p) {
  const glm::ivec3 at = job.bricks.lattice.first_point(job.bricks.place(brick)) + p;
  return job.bricks.lattice.position(at.x, at.y, at.z);
}

// What decides about a point, by its bit in a leaf; or about one that is counted from the first of a brick.
__device__ __forceinline__ uint32_t decider_at(const WallJob &job, uint32_t slot, int bit) {
  if (!(job.view.brick_leaves[slot / kLeavesPerBrick] >> (slot % kLeavesPerBrick) & 1)) return kNotLookedAt;
  return job.view.deciders_of(slot)[bit];
}
__device__ __forceinline__ uint32_t decider_at(const WallJob &job, uint32_t brick, const glm::ivec3 &p) {
  const LocatedPoint at = job.bricks.locate(brick, p);
  if (at.brick < 0) return kNotLookedAt;
  const uint32_t brick_there = static_cast<uint32_t>(at.brick);
  if (brick_there - job.view.decided.first >= job.view.decided.size()) return kNotLookedAt;
  return decider_at(job, job.view.slot_of(brick_there, at.leaf), at.bit);
}

// That of a first end. It is not known in leaves that no feature's part of the surface may pass: to be outside there is
// to be on the contact side of the ball the point is deepest in.
__device__ __forceinline__ uint32_t first_decider(const WallJob &job, uint32_t slot, int bit, const Vec3<float> &x) {
  const uint32_t decider = decider_at(job, slot, bit);
  if (decider != kNotLookedAt) return decider;
  const DeepestAtom deepest = deepest_atom(job.features, row_candidates(job.view, slot), x);
  return deepest.depth > job.reach.least_depth ? kOnContact | deepest.atom : kOutsideBalls;
}

// nearest_probe() of a point, by what decides about it.
__device__ __forceinline__ NearestProbe decided_probe(const FeatureView &f, uint32_t decider, const Vec3<float> &x) {
  if (decider == kOutsideBalls) return {x, 0.f};
  const bool contact = (decider & kOnContact) != 0;
  BoundaryPoint y;
  if (contact) {
    const Sphere ball = load(f.atoms.items + (decider & ~kOnContact));
    y = boundary_on_atom(ball, ball_depth(ball, x), x, true);
  } else {
    y = boundary_on_arc(load(f.arcs + decider), x);
  }
  return {y.position, y.distance};
}

// A warp takes a run of leaves, shorter where the GPU has room for more warps, and in a round as many of their next
// first ends, of which the last ones of a leaf may be left to the next round.
constexpr int kRoundStarts = 64, kRoundLeaves = 16;
constexpr uint32_t kMostWallLeaves = 12;

// A lane for each of the next leaves.
struct WallRound {
  int starts;  // how many first ends
  uint32_t slot;
  uint64_t points;  // first ends
  int starts_with;  // of the leaves before, and its own
  uint32_t next;    // leaf of the next round
  int taken;        // of its first ends, by this round or before

  // Of leaves first to last, of the first of which so many first ends were taken before.
  __device__ __forceinline__ WallRound(const WallJob &job, uint32_t first, uint32_t last, int taken_before)
      : slot(0), points(0) {
    const uint32_t k = first + static_cast<uint32_t>(lane_id());
    const bool on = lane_id() < kRoundLeaves && k < last;
    if (on) {
      slot = job.leaves[k];
#pragma unroll
      for (int s = 0; s < kWallSteps; ++s) points |= job.edges_of(slot)[s];
    }
    if (taken_before > 0 && lane_id() == 0) points &= ~uint64_t(0) << nth_bit64(points, taken_before);
    starts_with = warp_inclusive_sum(popcount64(points), lane_id());
    const int all = __shfl_sync(kFullWarp, starts_with, kWarp - 1),
              whole = __popc(__ballot_sync(kFullWarp, on && starts_with <= kRoundStarts));
    starts = all < kRoundStarts ? all : kRoundStarts;
    next = first + static_cast<uint32_t>(whole);
    taken = starts - __shfl_sync(kFullWarp, starts_with, whole - 1);
  }
};
static_assert(kRoundStarts >= 64, "there is room for the first ends of any leaf");

// A first end: its leaf, and its bit.
struct WallStart {
  uint32_t slot;
  int bit;
};
constexpr int kStepUnit = kRoundStarts;
// What a warp knows of its round.
struct WallScratch {
  float4 probe[kRoundStarts];  // of each first end
  uint32_t decider[kRoundStarts];
  WallStart start[kRoundStarts];
  uint16_t edge[kRoundStarts * kWallSteps];  // number of the first end, and the step in kStepUnit

  __device__ __forceinline__ uint64_t walk(uint32_t k) const {
    const WallStart s = start[edge[k] % kStepUnit];
    return static_cast<uint64_t>(s.slot) * (kWallSteps * 64) + edge[k] / kStepUnit * 64u + static_cast<uint32_t>(s.bit);
  }
};
static_assert(kStepUnit * kWallSteps <= 0x10000, "two bytes");

// The steps to second ends that the probe of a first end does not cover. That is put into the scratch.
__device__ __forceinline__ uint32_t uncovered_steps(const WallJob &job, const WallStart &start, int n,
                                                    WallScratch *scratch) {
  const FeatureView &f = job.features;
  const WallEdge e = wall_edge(job, start.slot, 0, start.bit);
  const Vec3<float> x = wall_point(job, e.brick, e.first());
  const uint32_t decider = first_decider(job, start.slot, start.bit, x);
  const NearestProbe probe = decided_probe(f, decider, x);
  scratch->probe[n] = make_float4(probe.center.x, probe.center.y, probe.center.z, probe.distance);
  scratch->decider[n] = decider;
  if (probe.distance > f.parameters.depth) return 0;
  // Halves of the words of its leaf.
  const uint32_t *const edges = reinterpret_cast<const uint32_t *>(job.edges_of(start.slot)) + start.bit / 32;
  uint32_t listed = 0;
#pragma unroll
  for (int s = 0; s < kWallSteps; ++s) listed |= (edges[2 * s] >> start.bit % 32 & 1) << s;
  look_around(f.parameters.spacing, x - probe.center, f.parameters.depth * f.parameters.depth,
              [&](int step, float along, float left) { listed &= ~(along < left ? 1u << step : 0u); });
  return listed;
}

// Does the probe of an end, when it rolls on along its arc or atom to where it is nearest to the middle of a rest,
// cover all of that? A quick answer for many edges: no means nothing.
__device__ __forceinline__ bool rolls_over(const FeatureView &f, uint32_t decider, const WallRest &rest) {
  const Vec3<float> middle = (rest.from + rest.to) * 0.5f;
  if (!(decider & kOnContact))
    return covers_rest(f.parameters, nearest_on_arc(load(f.arcs + decider), middle).position, rest);
  if (decider >= kNotLookedAt) return false;
  const uint32_t atom = decider & ~kOnContact;
  const DeepestAtom on{atom, ball_depth(load(f.atoms.items + atom), middle)};
  return covers_rest(f.parameters, probe_on_atom(f, on, middle).center, rest) && is_on_contact(f, on, middle);
}

// Do the probes of both ends leave something of an edge, as they are and when they roll on?
__device__ __forceinline__ bool is_left_by_probes(const WallJob &job, const WallScratch &scratch, int number) {
  const FeatureView &f = job.features;
  const int n = number % kStepUnit, step = number / kStepUnit;
  const WallStart start = scratch.start[n];
  const WallEdge e = wall_edge(job, start.slot, step, start.bit);
  const uint32_t first = scratch.decider[n], second = decider_at(job, e.brick, e.second());
  if (second == kNotLookedAt) return true;
  const float4 v = scratch.probe[n];
  const Vec3<float> a = wall_point(job, e.brick, e.first()), b = wall_point(job, e.brick, e.second());
  const WallWalk walk = begin_wall_walk(f.parameters, step, a, {{v.x, v.y, v.z}, v.w}, b, decided_probe(f, second, b));
  if (walk.is_open()) return false;
  if (!job.has_short_cuts) return true;
  const WallRest rest = rest_of_walk(walk, step, a);
  return !rolls_over(f, second, rest) && (first == second || !rolls_over(f, first, rest));
}

// Lists the edges of a round that its probes leave, in its scratch; returns how many. Of those that one of several
// warps looks at, where they take the round together.
__device__ __forceinline__ uint32_t find_edges_to_walk(const WallJob &job, const WallRound &round, uint32_t part,
                                                       uint32_t parts, WallScratch *scratch) {
  const int lane = lane_id();
  uint32_t edges = 0;
  for (int n0 = 0; n0 < round.starts; n0 += kWarp) {
    const int n = n0 + lane;
    const int leaf = lane_beyond<kRoundLeaves>(round.starts_with, n);
    const uint32_t slot = __shfl_sync(kFullWarp, round.slot, leaf);
    const uint64_t points = __shfl_sync(kFullWarp, round.points, leaf);
    const int first = __shfl_sync(kFullWarp, round.starts_with, leaf) - popcount64(points);
    uint32_t left = 0;
    if (n < round.starts) {
      const WallStart start{slot, nth_bit64(points, n - first)};
      scratch->start[n] = start;
      left = uncovered_steps(job, start, n, scratch);
    }
    __syncwarp();
    const uint32_t own = static_cast<uint32_t>(__popc(left)), with_own = warp_inclusive_sum(own, lane);
    for (uint32_t place = edges + with_own - own; left; left &= left - 1)
      scratch->edge[place++] = static_cast<uint16_t>(kStepUnit * lowest_bit32(left) + n);
    edges += __shfl_sync(kFullWarp, with_own, kWarp - 1);
  }
  __syncwarp();

  uint32_t walks = 0;
  for (uint32_t e0 = part * kWarp; e0 < edges; e0 += parts * kWarp) {
    const bool on = e0 + static_cast<uint32_t>(lane) < edges;
    const uint16_t edge = on ? scratch->edge[e0 + static_cast<uint32_t>(lane)] : uint16_t(0);
    const bool left = on && is_left_by_probes(job, *scratch, edge);
    // Never beyond those looked at, once each lane has read its own.
    __syncwarp();
    const uint32_t place = append_place(left, &walks);
    if (left) scratch->edge[place] = edge;
    __syncwarp();
  }
  return walks;
}

__device__ __forceinline__ void write_walk(const WallJob &job, unsigned long long place, uint64_t walk) {
  if (place < job.walk_room) job.walks[place] = walk;
}

// Puts the edges that are left of a round behind those of others.
__device__ __forceinline__ void list_walks(const WallJob &job, uint32_t walks, const WallScratch &scratch) {
  unsigned long long base = 0;
  if (lane_id() == 0) base = atomicAdd(&job.counters->walks, static_cast<unsigned long long>(walks));
  base = __shfl_sync(kFullWarp, base, 0);
  for (uint32_t w = static_cast<uint32_t>(lane_id()); w < walks; w += kWarp) write_walk(job, base + w, scratch.walk(w));
}

// The same for those that the warps of a block have found of one leaf.
__device__ __forceinline__ void list_walks_of_leaf(const WallJob &job, uint32_t own, const WallScratch &scratch) {
  __shared__ uint32_t words[kWallWarps];
  __shared__ unsigned long long base;
  const BlockSum sum = sum_of_block(own, words);
  if (sum.all == 0) return;
  if (threadIdx.x == 0) base = atomicAdd(&job.counters->walks, static_cast<unsigned long long>(sum.all));
  __syncthreads();
  for (uint32_t w = static_cast<uint32_t>(lane_id()); w < own; w += kWarp)
    write_walk(job, base + sum.before + w, scratch.walk(w));
}

// Lists the edges of leaves that the probes nearest to their ends, as far as they are known, do not cover together. A
// leaf has few first ends, and few edges that are left by the first probe: a warp takes several leaves at a time, so
// that its lanes are not idle. Or, where leaves are few, all warps of a block take one: each has all first ends, and
// looks at a share of the edges that their probes leave.
template <bool kByBlocks>
static __global__ __launch_bounds__(kWallThreads,
                                    blocks_at_once(kWallThreads, 10)) void drop_open_edges_kernel(QueuedItems queued,
                                                                                                  WallJob job) {
  const LaunchItems items = queued.in_turn();
  __shared__ WallScratch scratch_memory[kWallWarps];
  const uint32_t warp = threadIdx.x / kWarp;
  WallScratch &scratch = scratch_memory[warp];
  const uint32_t first = static_cast<uint32_t>(items.first);
  const uint32_t end = job.counters->leaves < items.last ? job.counters->leaves : static_cast<uint32_t>(items.last);
  if (end <= first) return;
  if constexpr (kByBlocks) {
    for (uint32_t own = first + blockIdx.x; own < end; own += gridDim.x) {
      const uint32_t walks = find_edges_to_walk(job, WallRound(job, own, own + 1, 0), warp, kWallWarps, &scratch);
      list_walks_of_leaf(job, walks, scratch);
      __syncthreads();  // neither scratch nor words are looked at any more
    }
  } else {
    const uint32_t warps = gridDim.x * kWallWarps, even = (end - first - 1) / warps + 1,
                   share = even < kMostWallLeaves ? even : kMostWallLeaves;
    for (uint32_t own = first + (blockIdx.x * kWallWarps + warp) * share; own < end; own += warps * share) {
      const uint32_t own_end = own + share < end ? own + share : end;
      int taken = 0;
      for (uint32_t next = own; next < own_end;) {
        const WallRound round(job, next, own_end, taken);
        const uint32_t walks = find_edges_to_walk(job, round, 0, 1, &scratch);
        if (walks > 0) list_walks(job, walks, scratch);
        next = round.next;
        taken = round.taken;
        __syncwarp();  // the scratch is not looked at any more
      }
    }
  }
}

}  // namespace gpu
}  // namespace quickses
