// SPDX-License-Identifier: MIT
// GPU driver of thin walls: a thread per leaf finds by signs which edges may pass through one; a warp per leaf drops
// those that the probes nearest to their ends cover, which signs have left behind; the few that are left are walked by
// eight lanes each.
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
    words.at[n] = word_of_leaf(leaf_at(n), [&](int) {
      return found[n] < 0 ? nullptr : job.signs + static_cast<size_t>(found[n]) * kLeavesPerBrick;
    });
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

// Shared memory of one warp.
struct WallScratch {
  float4 probe[64];      // of first ends, by their bit
  uint32_t decider[64];  // about them
  uint32_t candidates[kWallSteps][2];
  uint16_t edge[kWallSteps * 64];  // 64 * step + bit
  uint8_t bit[64];                 // of first ends
};

__device__ __forceinline__ Vec3<float> from_lane(const Vec3<float> &v, int lane) {
  return {__shfl_sync(kFullWarp, v.x, lane), __shfl_sync(kFullWarp, v.y, lane), __shfl_sync(kFullWarp, v.z, lane)};
}

// Lists the edges of leaves that the probes nearest to their ends, as far as they are known, do not cover together. A
// warp per leaf that has edges.
static __global__ __launch_bounds__(kWallThreads, 8) void drop_open_edges_kernel(QueuedItems queued, WallJob job) {
  const LaunchItems items = queued.in_turn();
  __shared__ WallScratch scratch_memory[kWallWarps];
  const int warp = static_cast<int>(threadIdx.x) / kWarp, lane = lane_id();
  WallScratch &scratch = scratch_memory[warp];
  const FeatureView &f = job.features;
  const size_t leaves = job.counters->leaves, total = leaves < items.last ? leaves : items.last;
  for (size_t k = items.first + blockIdx.x * size_t(kWallWarps) + static_cast<size_t>(warp); k < total;
       k += size_t(gridDim.x) * kWallWarps) {
    const uint32_t slot = job.leaves[k], brick = job.view.first_brick + slot / kLeavesPerBrick;
    const int leaf = static_cast<int>(slot % kLeavesPerBrick);
    const glm::ivec3 low = job.bricks.lattice.first_point(job.bricks.place(brick)) + brick_point(leaf, 0);
    const auto position = [&](int bit, const glm::ivec3 &step) {
      return job.bricks.lattice.position(low.x + (bit & 3) + step.x, low.y + (bit >> 2 & 3) + step.y,
                                         low.z + (bit >> 4) + step.z);
    };
    const uint64_t own = lane < kWallSteps ? job.edges[size_t(slot) * kWallSteps + size_t(lane)] : 0;
    const uint32_t own_low = static_cast<uint32_t>(own), own_high = static_cast<uint32_t>(own >> 32);
    const uint64_t points = static_cast<uint64_t>(warp_or(own_high)) << 32 | warp_or(own_low);
    __syncwarp();
    if (lane < kWallSteps) {
      scratch.candidates[lane][0] = own_low;
      scratch.candidates[lane][1] = own_high;
    }
    for (int bit = lane; bit < 64; bit += kWarp)
      if (points >> bit & 1) scratch.bit[popcount64(points & ((uint64_t(1) << bit) - 1))] = static_cast<uint8_t>(bit);
    __syncwarp();

    // By the probes of the first ends.
    const int starts = popcount64(points);
    int count = 0;
    for (int n0 = 0; n0 < starts; n0 += kWarp) {
      const bool on = n0 + lane < starts;
      const int bit = scratch.bit[on ? n0 + lane : starts - 1];
      const Vec3<float> x = position(bit, glm::ivec3(0));
      const uint32_t decider = first_decider(job, slot, bit, x);
      const NearestProbe probe = decided_probe(f, decider, x);
      __syncwarp();
      if (on) {
        scratch.probe[bit] = make_float4(probe.center.x, probe.center.y, probe.center.z, probe.distance);
        scratch.decider[bit] = decider;
      }
      const float depth2 = f.parameters.depth * f.parameters.depth;
      uint32_t left = 0;
#pragma unroll
      for (int s = 0; s < kWallSteps; ++s) {
        const bool covered = length_squared(second_offset(x - probe.center, s, job.reach.spacing)) < depth2;
        const uint32_t candidate = scratch.candidates[s][bit >> 5] >> (bit & 31) & 1;
        left |= covered ? 0u : candidate << s;
      }
      if (!on || probe.distance > f.parameters.depth) left = 0;
      const int own_count = __popc(left), with_own = warp_inclusive_sum(own_count, lane);
      for (int place = count + with_own - own_count; left; left &= left - 1)
        scratch.edge[place++] = static_cast<uint16_t>(64 * (__ffs(static_cast<int>(left)) - 1) + bit);
      count += __shfl_sync(kFullWarp, with_own, kWarp - 1);
    }
    __syncwarp();

    // By those of both ends.
    int walks = 0;
    for (int n0 = 0; n0 < count; n0 += kWarp) {
      bool left = n0 + lane < count, rests = false;
      const int number = scratch.edge[left ? n0 + lane : 0];
      WallRest rest{};
      if (left) {
        const WallEdge e = wall_edge(job, slot, number / 64, number % 64);
        const uint32_t decider = decider_at(job, brick, e.second);
        if (decider != kNotLookedAt) {
          const float4 v = scratch.probe[e.bit];
          const Vec3<float> a = position(e.bit, glm::ivec3(0)), b = position(e.bit, wall_step(e.step));
          const bool same_atom = decider == scratch.decider[e.bit] && (decider & kOnContact) && decider < kNotLookedAt;
          const WallWalk walk =
              begin_wall_walk(f.parameters, e.step, a, {{v.x, v.y, v.z}, v.w}, b, decided_probe(f, decider, b));
          left = rests = !walk.is_open() && !(same_atom && rolls_over(f, decider & ~kOnContact, a, b));
          rest = rest_of_walk(walk, e.step, a);
        }
      }
      // By those of the leaf's other first ends.
      for (unsigned open = __ballot_sync(kFullWarp, rests); open; open &= open - 1) {
        const int whose = __ffs(static_cast<int>(open)) - 1;
        const WallRest asked{from_lane(rest.from, whose), from_lane(rest.to, whose)};
        bool covered = false;
        for (int bit = lane; bit < 64; bit += kWarp) {
          if (!(points >> bit & 1)) continue;
          const float4 v = scratch.probe[bit];
          covered |= v.w <= f.parameters.depth && covers_rest(f.parameters, {v.x, v.y, v.z}, asked);
        }
        if (__any_sync(kFullWarp, covered) && lane == whose) left = false;
      }
      __syncwarp();
      const int place = append_place(left, &walks);  // never beyond those looked at
      if (left) scratch.edge[place] = static_cast<uint16_t>(number);
      __syncwarp();
    }
    const uint32_t places = (static_cast<uint32_t>(walks) + job.walk_run - 1) / job.walk_run * job.walk_run;
    unsigned long long base = 0;
    if (lane == 0 && places > 0) base = atomicAdd(&job.counters->walks, static_cast<unsigned long long>(places));
    base = __shfl_sync(kFullWarp, base, 0);
    for (int n = lane; n < static_cast<int>(places); n += kWarp)
      if (base + static_cast<unsigned>(n) < job.walk_room)
        job.walks[base + static_cast<unsigned>(n)] =
            n < walks ? static_cast<uint64_t>(slot) * (kWallSteps * 64) + scratch.edge[n] : kNoWalk;
  }
}

// nearest_probe() by all teams of a warp in step, of which some ask.
template <int kLanes>
__device__ __forceinline__ NearestProbe nearest_probe_if(bool asks, const FeatureView &f,
                                                         LaneCandidates<kLanes, true> near, const Vec3<float> &x) {
  if (!asks) near.atom_total = 0;
  DeepestAtom deepest = deepest_atom(f, near, x);
  const bool told = tells_probe(f.parameters, deepest);
  const NearestProbe said = told_probe(f.parameters, deepest, x);
  if (told) deepest.depth = -2.f * kFarAway;
  const bool contact = is_on_contact(f, near, deepest, x);
  if (told || contact) near.arc_total = 0;
  const NearestArc nearest = nearest_arc(f, near, x);
  return told ? said : contact ? probe_on_atom(f, deepest, x) : probe_on_arc(f, nearest, x);
}

// Walks an edge by a team of lanes, if it is on; all teams of a warp in step.
template <int kLanes>
__device__ __forceinline__ void walk_edge(const WallJob &job, const WallEdge &e, const Vec3<float> &a,
                                          const Vec3<float> &b, bool on, const LaneCandidates<kLanes, true> &near) {
  const FeatureView &f = job.features;
  const SurfaceParameters &p = f.parameters;
  const NearestProbe probe_a = decided_probe(f, first_decider(job, e.slot, e.bit, a), a);
  const uint32_t decider_b = decider_at(job, e.brick, e.second);
  const bool looks_for_b = decider_b == kNotLookedAt;
  NearestProbe probe_b{b, 0.f};
  if (__any_sync(kFullWarp, looks_for_b)) probe_b = nearest_probe_if(looks_for_b, f, near, b);
  if (!looks_for_b) probe_b = decided_probe(f, decider_b, b);
  WallWalk walk = begin_wall_walk(p, e.step, a, probe_a, b, probe_b);
  if (!on) walk = {0.f, 0.f};
  const Vec3<float> direction = wall_direction(e.step);
  for (int round = 0; round < kMostWallSteps && __any_sync(kFullWarp, !walk.is_open()); ++round) {
    const Vec3<float> x = a + direction * (walk.at + kWallStep);
    const NearestProbe probe = nearest_probe_if(!walk.is_open(), f, near, x);
    if (walk.is_open()) continue;
    if (probe.distance > p.depth) {
      if (near.rank() == 0)
        mark_wall(job.bricks, e.brick, marks_first_end(probe_a, probe_b) ? e.first : e.second, job.marks);
      walk = {0.f, 0.f};
    } else {
      walk.at += kWallStep + way_out(p, probe, x, direction);
    }
  }
}

__device__ __forceinline__ WallEdge edge_to_walk(const WallJob &job, uint64_t item) {
  return wall_edge(job, static_cast<uint32_t>(item / (64 * kWallSteps)), static_cast<int>(item / 64 % kWallSteps),
                   static_cast<int>(item % 64));
}
// How far from the middle of an edge balls decide about its points.
__device__ __forceinline__ float walk_reach(const WallJob &job, int step) {
  return 0.5f * wall_step_length(step) * job.reach.spacing + 2.f * job.reach.slack;
}

// What can decide about any edge of a run, which are all of one leaf.
__device__ __forceinline__ LaneCandidates<kWarp, true> choose_for_run(const WallJob &job, const uint64_t *run,
                                                                      int count, uint32_t *room, int most) {
  const uint64_t own = run[lane_id() < count ? lane_id() : 0];
  const WallEdge e = edge_to_walk(job, own == kNoWalk ? run[0] : own);
  const Vec3<float> middle = (wall_point(job, e.brick, e.first) + wall_point(job, e.brick, e.second)) * 0.5f;
  const Vec3<float> low(-warp_maximum(-middle.x), -warp_maximum(-middle.y), -warp_maximum(-middle.z)),
      high(warp_maximum(middle.x), warp_maximum(middle.y), warp_maximum(middle.z)), center = (low + high) * 0.5f;
  const float reach = square_root(length_squared(high - center)) + walk_reach(job, kWallSteps - 1) + job.reach.slack;
  return choose_near<kWarp>(job.features, row_candidates(job.view, e.slot), center, reach, room, most);
}

// Some lanes for each edge that is left. They wait for memory: more blocks at a time are worth registers. A warp takes
// so many edges one after the other. Where leaves have many, as at wide spacings, what can decide about any edge of a
// run is chosen first, and from that what can decide about each.
template <int kLanes, int kRun>
static __global__ __launch_bounds__(kWallThreads,
                                    blocks_at_once(kWallThreads, 10)) void walk_edges_kernel(QueuedItems queued,
                                                                                             WallJob job) {
  const LaunchItems items = queued.in_turn();
  constexpr int kTeams = kWallThreads / kLanes, kWarpTeams = kWarp / kLanes, kRoom = 2560 / kTeams;
  constexpr bool kChosenTwice = kRun > kWarpTeams;
  constexpr int kRunRoom = kChosenTwice ? 640 : 1;
  static_assert(kRun % kWarpTeams == 0 && kRun <= kWarp, "a lane for each edge, and none of another run");
  __shared__ uint32_t edge_memory[kTeams][kRoom];
  __shared__ uint32_t run_memory[kWallWarps][kRunRoom];
  const size_t walks = job.counters->walks, total = walks < items.last ? walks : items.last;
  const int team = static_cast<int>(threadIdx.x) / kLanes, warp = team / kWarpTeams;
  for (size_t first = items.first + (blockIdx.x * size_t(kWallWarps) + static_cast<size_t>(warp)) * kRun; first < total;
       first += size_t(gridDim.x) * kWallWarps * kRun) {
    const uint64_t *const run = job.walks + first;
    const int count = total - first < kRun ? static_cast<int>(total - first) : kRun;
    LaneCandidates<kWarp, true> near_run{};
    if constexpr (kChosenTwice) near_run = choose_for_run(job, run, count, run_memory[warp], kRunRoom);
    for (int n0 = 0; n0 < count && run[n0] != kNoWalk; n0 += kWarpTeams) {
      const int n = n0 + team % kWarpTeams;
      const uint64_t own = run[n < count ? n : n0];
      const bool on = n < count && own != kNoWalk;
      const WallEdge e = edge_to_walk(job, on ? own : run[n0]);
      const Vec3<float> a = wall_point(job, e.brick, e.first), b = wall_point(job, e.brick, e.second);
      const auto choose = [&](const auto &all) {
        return choose_near<kLanes>(job.features, all, (a + b) * 0.5f, walk_reach(job, e.step), edge_memory[team],
                                   kRoom);
      };
      if constexpr (kChosenTwice)
        walk_edge(job, e, a, b, on, choose(near_run));
      else
        walk_edge(job, e, a, b, on, choose(row_candidates(job.view, e.slot)));
    }
  }
}

// How many edges of a leaf are left to be walked, at most as a rule: the wider the spacing beside the probe, the fewer
// are covered by the probes at their ends. Of 1AON with a probe of 1.4 Å, at spacings of 1 and 2 Å: 2 and 21.
inline double walked_edges(const SurfaceParameters &p) {
  const double ratio = static_cast<double>(p.spacing) / static_cast<double>(p.depth);
  return std::min(32.0, std::max(1.0, 8 * ratio * ratio * ratio));
}

// Waits once if nothing is anticipated, or twice if there are far more edges to walk than is usual.
template <class E>
void mark_thin_walls(E &executor, const FeatureView &features, const BrickSet &bricks, BrickRange slice,
                     CudaRooms &rooms, CudaCandidates &candidates, const uint64_t *signs, uint64_t *marks) {
  if (slice.size() == 0) return;
  const size_t leaves = static_cast<size_t>(slice.size()) * kLeavesPerBrick;
  if (!candidates.are_of(slice)) gather_candidates(executor, features, bricks, slice, rooms, candidates, nullptr);
  if (!candidates.have_deciders) evaluate_leaves(executor, features, bricks, candidates, true, nullptr);
  const auto mark = executor.arena().mark();
  WallJob job{};
  job.features = features;
  job.bricks = bricks;
  job.reach = CandidateReach::of(features.parameters);
  job.view = candidates.view;
  job.signs = signs;
  job.marks = marks;
  WallCounters *const counters = executor.template take_counts<WallCounters>();
  job.counters = counters;
  job.leaves = executor.template allocate<uint32_t>(leaves).data;
  job.edges = executor.template allocate<uint64_t>(leaves * kWallSteps).data;
  executor.launch("find_wall_candidates", find_wall_candidates_kernel, leaves,
                  LaunchShape{kWallThreads, kWallThreads, 96}, job);
  const uint64_t look = 64 + 2 * uint64_t(candidates.longest_row) + features.most_caps;
  const size_t most_blocks = executor.multiprocessors() * size_t(16);
  WallCounters found{};
  const double usual_walks = walked_edges(features.parameters) * static_cast<double>(leaves);
  job.walk_room = static_cast<unsigned long long>(rooms.walked_edges * usual_walks);
  constexpr int kLongWalkRun = 8;
  job.walk_run = walked_edges(features.parameters) > kLongWalkRun ? kLongWalkRun : 1;
  for (;;) {
    const auto before_walks = executor.arena().mark();
    job.walks = executor.template allocate<uint64_t>(static_cast<size_t>(job.walk_room)).data;
    executor.launch("drop_open_edges", drop_open_edges_kernel, leaves,
                    LaunchShape{kWallThreads, kWallWarps, 36 * 48 + 2 * look, most_blocks}, job);
    found = executor.expect("walls", counters, WallCounters{static_cast<uint32_t>(leaves), job.walk_room});
    if (found.walks <= job.walk_room) break;
    executor.arena().rewind(before_walks);
    job.walk_room = found.walks;
    rooms.walked_edges = std::max(rooms.walked_edges, kRoomToSpare * static_cast<double>(found.walks) / usual_walks);
    executor.fill(Span<unsigned long long>{&counters->walks, 1}, 0);
  }
  const auto walk = [&](size_t lanes, size_t run, auto kernel) {
    const uint64_t rounds = run * lanes / kWarp;
    executor.launch("walk_edges", kernel, static_cast<size_t>(found.walks),
                    LaunchShape{kWallThreads, kWallWarps * run,
                                look / kWarp + rounds * (2 + kMostWallSteps) * (64 + look / lanes), most_blocks},
                    job);
  };
  // Few edges leave a GPU idle with eight lanes each.
  constexpr size_t kFullThreads = 1024;  // of a multiprocessor
  if (found.walks * kWarp <= executor.multiprocessors() * kFullThreads)
    walk(kWarp, 1, walk_edges_kernel<kWarp, 1>);
  else if (job.walk_run > 1)
    walk(8, kLongWalkRun, walk_edges_kernel<8, kLongWalkRun>);
  else
    walk(8, 4, walk_edges_kernel<8, 4>);
  executor.arena().rewind(mark);
}

}  // namespace gpu

}  // namespace quickses
