// SPDX-License-Identifier: MIT
// GPU: edges that may pass through thin walls. A thread per leaf finds by signs which they are; a warp per leaf drops
// those that the probes nearest to their ends cover, which signs have left behind.
#pragma once

#include "surface/cuda/projection_cuda.cuh"
#include "surface/stages/thin_walls.h"

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
  uint32_t *leaves;  // that have edges: 8 * brick of the slice + leaf
  uint64_t *edges;   // by that number, kWallSteps words each: those that may be walls
  uint64_t *walks;   // 64 * kWallSteps * number of the leaf + 64 * step + bit
  unsigned long long walk_room;
  uint32_t walk_run;  // those of a leaf take whole runs of so many places; kNoWalk in the rest
};

constexpr uint64_t kNoWalk = ~uint64_t(0);

constexpr int kWallThreads = 128;
constexpr int kWallWarps = kWallThreads / kWarp;

// A thread per leaf of the slice.
static __global__ __launch_bounds__(kWallThreads, 6) void find_wall_candidates_kernel(QueuedItems queued, WallJob job) {
  const LaunchItems items = queued.in_turn();
  if (job.view.counted->leaves > job.view.leaf_room) return;  // of some, nothing is known
  const size_t k = items.first + blockIdx.x * size_t(kWallThreads) + threadIdx.x;
  const bool on = k < items.last;
  const uint32_t slot = static_cast<uint32_t>(on ? k : items.first);
  const int leaf = static_cast<int>(slot % kLeavesPerBrick), brick = static_cast<int>(job.view.first_brick + slot / 8);
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
    for (int s = 0; s < kWallSteps; ++s) job.edges[size_t(slot) * kWallSteps + size_t(s)] = edges[s];
  }
  append(job.leaves, &job.counters->leaves, slot, any);
}

// An edge of a slice, by the number in the list.
struct WallEdge {
  uint32_t brick;  // of the set
  uint32_t slot;
  int step, bit;
  glm::ivec3 first, second;  // points, counted from the first one of the brick
};
__device__ __forceinline__ WallEdge wall_edge(const WallJob &job, uint32_t slot, int step, int bit) {
  const glm::ivec3 first = brick_point(static_cast<int>(slot % kLeavesPerBrick), bit);
  return {job.view.first_brick + slot / kLeavesPerBrick, slot, step, bit, first, first + wall_step(step)};
}
__device__ __forceinline__ Vec3<float> wall_point(const WallJob &job, uint32_t brick, const glm::ivec3 &p) {
  const glm::ivec3 at = job.bricks.lattice.first_point(job.bricks.place(brick)) + p;
  return job.bricks.lattice.position(at.x, at.y, at.z);
}

// What decides about a point, by its bit in a leaf; or about one that is counted from the first of a brick.
__device__ __forceinline__ uint32_t decider_at(const WallJob &job, uint32_t slot, int bit) {
  if (!(job.view.brick_leaves[slot / kLeavesPerBrick] >> (slot % kLeavesPerBrick) & 1)) return kNotLookedAt;
  return job.view.deciders[size_t(slot) * 64 + size_t(bit)];
}
__device__ __forceinline__ uint32_t decider_at(const WallJob &job, uint32_t brick, const glm::ivec3 &p) {
  if ((p.x | p.y | p.z) & ~7) {
    const glm::ivec3 place = job.bricks.place(brick);
    const int found = job.bricks.find(place + glm::ivec3(p.x >> 3, p.y >> 3, p.z >> 3));
    if (found < 0) return kNotLookedAt;
    brick = static_cast<uint32_t>(found);
  }
  brick -= job.view.first_brick;  // of the slice
  if (brick >= job.view.bricks) return kNotLookedAt;
  const int x = p.x & 7, y = p.y & 7, z = p.z & 7;
  return decider_at(job, brick * kLeavesPerBrick + static_cast<uint32_t>(leaf_of(x, y, z)),
                    leaf_bit(x & 3, y & 3, z & 3));
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

// What a warp knows of its leaf, in shared memory. No edges: it has none.
struct WallScratch {
  float4 probe[64];      // of first ends, by their bit
  uint32_t decider[64];  // about them
  uint32_t candidates[kWallSteps][2];
  uint32_t points[2];              // first ends
  uint16_t edge[kWallSteps * 64];  // 64 * step + bit
  uint8_t bit[64];                 // of first ends
  uint32_t slot;
  int edge_count;
  glm::ivec3 low;  // its first point

  __device__ __forceinline__ Vec3<float> position(const Lattice &lattice, int bit, const glm::ivec3 &step) const {
    return lattice.position(low.x + (bit & 3) + step.x, low.y + (bit >> 2 & 3) + step.y, low.z + (bit >> 4) + step.z);
  }
};
constexpr uint16_t kOpenEdge = 0xffff;

__device__ __forceinline__ Vec3<float> from_lane(const Vec3<float> &v, int lane) {
  return {__shfl_sync(kFullWarp, v.x, lane), __shfl_sync(kFullWarp, v.y, lane), __shfl_sync(kFullWarp, v.z, lane)};
}

// Lists the edges of a leaf that the probes of their first ends do not cover. A warp together.
__device__ __forceinline__ void list_uncovered_edges(const WallJob &job, uint32_t slot, WallScratch *scratch) {
  const FeatureView &f = job.features;
  const int lane = lane_id();
  const uint64_t own = lane < kWallSteps ? job.edges[size_t(slot) * kWallSteps + size_t(lane)] : 0;
  const uint32_t own_low = static_cast<uint32_t>(own), own_high = static_cast<uint32_t>(own >> 32);
  const uint32_t points_low = warp_or(own_low), points_high = warp_or(own_high);
  const uint64_t points = static_cast<uint64_t>(points_high) << 32 | points_low;
  if (lane < kWallSteps) {
    scratch->candidates[lane][0] = own_low;
    scratch->candidates[lane][1] = own_high;
  }
  if (lane == 0) {
    scratch->points[0] = points_low;
    scratch->points[1] = points_high;
    scratch->slot = slot;
    scratch->low = job.bricks.lattice.first_point(job.bricks.place(job.view.first_brick + slot / kLeavesPerBrick)) +
                   brick_point(static_cast<int>(slot % kLeavesPerBrick), 0);
  }
  for (int bit = lane; bit < 64; bit += kWarp)
    if (points >> bit & 1) scratch->bit[popcount64(points & ((uint64_t(1) << bit) - 1))] = static_cast<uint8_t>(bit);
  __syncwarp();

  const int starts = popcount64(points);
  int count = 0;
  for (int n0 = 0; n0 < starts; n0 += kWarp) {
    const bool on = n0 + lane < starts;
    const int bit = scratch->bit[on ? n0 + lane : starts - 1];
    const Vec3<float> x = scratch->position(job.bricks.lattice, bit, glm::ivec3(0));
    const uint32_t decider = first_decider(job, slot, bit, x);
    const NearestProbe probe = decided_probe(f, decider, x);
    __syncwarp();
    if (on) {
      scratch->probe[bit] = make_float4(probe.center.x, probe.center.y, probe.center.z, probe.distance);
      scratch->decider[bit] = decider;
    }
    const float depth2 = f.parameters.depth * f.parameters.depth;
    uint32_t left = 0;
#pragma unroll
    for (int s = 0; s < kWallSteps; ++s) {
      const bool covered = length_squared(second_offset(x - probe.center, s, job.reach.spacing)) < depth2;
      const uint32_t candidate = scratch->candidates[s][bit >> 5] >> (bit & 31) & 1;
      left |= covered ? 0u : candidate << s;
    }
    if (!on || probe.distance > f.parameters.depth) left = 0;
    const int own_count = __popc(left), with_own = warp_inclusive_sum(own_count, lane);
    for (int place = count + with_own - own_count; left; left &= left - 1)
      scratch->edge[place++] = static_cast<uint16_t>(64 * (__ffs(static_cast<int>(left)) - 1) + bit);
    count += __shfl_sync(kFullWarp, with_own, kWarp - 1);
  }
  if (lane == 0) scratch->edge_count = count;
}

// Which of a warp's edges, one to each lane, are left by the probes of both ends, and those of the other first ends of
// the same leaf.
__device__ __forceinline__ bool is_left_by_probes(const WallJob &job, const WallScratch *leaves, int whose, int number,
                                                  bool on) {
  const FeatureView &f = job.features;
  const int lane = lane_id();
  const WallScratch &leaf = leaves[whose];
  bool left = on, rests = false;
  WallRest rest{};
  if (on) {
    const WallEdge e = wall_edge(job, leaf.slot, number / 64, number % 64);
    const uint32_t decider = decider_at(job, e.brick, e.second);
    if (decider != kNotLookedAt) {
      const float4 v = leaf.probe[e.bit];
      const Vec3<float> a = leaf.position(job.bricks.lattice, e.bit, glm::ivec3(0)),
                        b = leaf.position(job.bricks.lattice, e.bit, wall_step(e.step));
      const bool same_atom = decider == leaf.decider[e.bit] && (decider & kOnContact) && decider < kNotLookedAt;
      const WallWalk walk =
          begin_wall_walk(f.parameters, e.step, a, {{v.x, v.y, v.z}, v.w}, b, decided_probe(f, decider, b));
      left = rests = !walk.is_open() && !(same_atom && rolls_over(f, decider & ~kOnContact, a, b));
      rest = rest_of_walk(walk, e.step, a);
    }
  }
  for (unsigned open = __ballot_sync(kFullWarp, rests); open; open &= open - 1) {
    const int asking = __ffs(static_cast<int>(open)) - 1;
    const WallRest asked{from_lane(rest.from, asking), from_lane(rest.to, asking)};
    const WallScratch &asked_leaf = leaves[__shfl_sync(kFullWarp, whose, asking)];
    bool covered = false;
#pragma unroll
    for (int half = 0; half < 2; ++half) {
      if (!(asked_leaf.points[half] >> lane & 1)) continue;
      const float4 v = asked_leaf.probe[kWarp * half + lane];
      covered |= v.w <= f.parameters.depth && covers_rest(f.parameters, {v.x, v.y, v.z}, asked);
    }
    if (__any_sync(kFullWarp, covered) && lane == asking) left = false;
  }
  return left;
}

// Lists the edges of leaves that the probes nearest to their ends, as far as they are known, do not cover together. A
// warp per leaf that has edges. So many leaves' edges are looked at together: of all in a block where each has a dozen,
// so that lanes are not idle, and else, where the warps would wait for each other, of one.
template <int kTogether>
static __global__ __launch_bounds__(kWallThreads, 8) void drop_open_edges_kernel(QueuedItems queued, WallJob job) {
  static_assert(kTogether == 1 || kTogether == kWallWarps, "a warp or a block");
  const LaunchItems items = queued.in_turn();
  __shared__ WallScratch leaves_memory[kWallWarps];
  const int warp = static_cast<int>(threadIdx.x) / kWarp, rank = warp % kTogether, lane = lane_id();
  WallScratch &own = leaves_memory[warp], *const together = leaves_memory + (warp - rank);
  const size_t leaves = job.counters->leaves, total = leaves < items.last ? leaves : items.last;
  for (size_t first = items.first + blockIdx.x * size_t(kWallWarps) + static_cast<size_t>(warp - rank); first < total;
       first += size_t(gridDim.x) * kWallWarps) {
    const size_t k = first + static_cast<size_t>(rank);
    if (k < total)
      list_uncovered_edges(job, job.leaves[k], &own);
    else if (lane == 0)
      own.edge_count = 0;
    sync_warps<kTogether>();

    int ends[kTogether], all = 0;
#pragma unroll
    for (int w = 0; w < kTogether; ++w) ends[w] = all += together[w].edge_count;
    for (int n0 = kWarp * rank; n0 < all; n0 += kWarp * kTogether) {
      const bool on = n0 + lane < all;
      const int n = on ? n0 + lane : n0;
      int whose = 0, before = 0;
#pragma unroll
      for (int w = 0; w + 1 < kTogether; ++w)
        if (n >= ends[w]) whose = w + 1, before = ends[w];
      uint16_t &edge = together[whose].edge[n - before];
      const bool left = is_left_by_probes(job, together, whose, edge, on);
      if (on && !left) edge = kOpenEdge;
    }
    sync_warps<kTogether>();

    if (k < total) {
      int walks = 0;
      const int count = own.edge_count;
      for (int n0 = 0; n0 < count; n0 += kWarp) {
        const uint16_t edge = n0 + lane < count ? own.edge[n0 + lane] : kOpenEdge;
        const int place = append_place(edge != kOpenEdge, &walks);  // never beyond those looked at
        __syncwarp();
        if (edge != kOpenEdge) own.edge[place] = edge;
        __syncwarp();
      }
      const uint32_t places = (static_cast<uint32_t>(walks) + job.walk_run - 1) / job.walk_run * job.walk_run;
      unsigned long long base = 0;
      if (lane == 0 && places > 0) base = atomicAdd(&job.counters->walks, static_cast<unsigned long long>(places));
      base = __shfl_sync(kFullWarp, base, 0);
      for (int n = lane; n < static_cast<int>(places); n += kWarp)
        if (base + static_cast<unsigned>(n) < job.walk_room)
          job.walks[base + static_cast<unsigned>(n)] =
              n < walks ? static_cast<uint64_t>(own.slot) * (kWallSteps * 64) + own.edge[n] : kNoWalk;
    }
    sync_warps<kTogether>();  // the leaves are not looked at any more
  }
}

}  // namespace gpu
}  // namespace quickses
