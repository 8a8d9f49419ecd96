// SPDX-License-Identifier: MIT
// GPU driver of thin walls: a thread per leaf finds by signs which edges may pass through one, a warp per leaf the
// probes nearest to their first ends, and with them which of the edges are left; these few are walked by eight lanes
// each.
#pragma once

#include "surface/cuda/projection_cuda.cuh"
#include "surface/stages/thin_walls.h"

namespace quickses {
namespace gpu {

// What there is of edges that may be walls, of a slice.
struct WallCounters {
  uint32_t leaves;
  unsigned long long starts, edges;  // first ends, and edges
  unsigned long long walks;          // edges that are left to be walked
};

// Of a leaf: the first ends of its edges, and the place of the probe of the lowest.
struct WallStarts {
  uint64_t points;
  unsigned long long first;
};

struct WallProbe {
  float x, y, z, distance;
};

struct WallJob {
  FeatureView features;
  BrickSet bricks;
  CandidateReach reach;
  CandidateView view;
  const uint64_t *signs;
  uint64_t *marks;
  WallCounters *counters;
  uint32_t *leaves;    // that have edges: 8 * brick of the slice + leaf
  WallStarts *starts;  // by that number
  uint64_t *edges;     // kWallSteps words each: those that may be walls
  float4 *probes;
  uint64_t *walks;  // 64 * kWallSteps * number of the leaf + 64 * step + bit
};

constexpr int kWallThreads = 128;
constexpr int kWallWarps = kWallThreads / kWarp;

// A thread per leaf of the slice.
static __global__ __launch_bounds__(kWallThreads) void find_wall_candidates_kernel(LaunchItems items, WallJob job) {
  const size_t k = items.first + blockIdx.x * size_t(kWallThreads) + threadIdx.x;
  const bool on = k < items.last;
  const uint32_t slot = static_cast<uint32_t>(on ? k : items.first);
  const int leaf = static_cast<int>(slot % kLeavesPerBrick), brick = static_cast<int>(job.view.first_brick + slot / 8);
  const glm::ivec3 place = job.bricks.lattice.brick_at(job.bricks.linear[brick]);
  const auto words_of = [&](int at) -> const uint64_t * {
    const int found = at == kOwnPlace ? brick : job.bricks.find(place + neighbor_step(at));
    return found < 0 ? nullptr : job.signs + static_cast<size_t>(found) * kLeavesPerBrick;
  };
  LeafNeighborhood words;
#pragma unroll
  for (int n = 0; n < kNeighborhood; ++n)
    words.at[n] = word_of_leaf(glm::ivec3(leaf & 1, leaf >> 1 & 1, leaf >> 2) + neighbor_step(n), words_of);
  uint64_t edges[kWallSteps];
  const bool any = on && find_wall_candidates(words, edges);
  uint64_t points = 0;
  unsigned long long edge_count = 0;
  if (any) {
#pragma unroll
    for (int s = 0; s < kWallSteps; ++s) {
      points |= edges[s];
      edge_count += static_cast<unsigned long long>(popcount64(edges[s]));
      job.edges[size_t(slot) * kWallSteps + size_t(s)] = edges[s];
    }
  }
  const int lane = lane_id();
  const unsigned long long count = static_cast<unsigned long long>(popcount64(points));
  const unsigned long long sum = warp_inclusive_sum(count, lane);
  unsigned long long first = 0;
  edge_count = warp_inclusive_sum(edge_count, lane);
  if (lane == kWarp - 1 && sum > 0) {
    first = atomicAdd(&job.counters->starts, sum);
    atomicAdd(&job.counters->edges, edge_count);
  }
  first = __shfl_sync(kFullWarp, first, kWarp - 1) + sum - count;
  if (on) job.starts[slot] = {points, first};
  append(job.leaves, &job.counters->leaves, slot, any);
}

// The probes of the first ends, and the edges that they do not cover. A warp per leaf that has edges.
static __global__ __launch_bounds__(kSignWarps *kWarp, 8) void probe_first_ends_kernel(LaunchItems items, WallJob job) {
  __shared__ LeafScratch scratch_memory[kSignWarps];
  __shared__ uint8_t bit_memory[kSignWarps][64];
  const int warp = static_cast<int>(threadIdx.x) / kWarp, lane = lane_id();
  LeafScratch &scratch = scratch_memory[warp];
  const size_t k = items.first + blockIdx.x * kSignWarps + static_cast<uint32_t>(warp);
  if (k >= items.last) return;
  const FeatureView &f = job.features;
  const CandidateReach &reach = job.reach;
  const Lattice &lattice = job.bricks.lattice;
  const float h = reach.spacing, depth = reach.depth;

  const uint32_t slot = job.leaves[k], b = slot / kLeavesPerBrick;
  const int leaf = static_cast<int>(slot % kLeavesPerBrick);
  const WallStarts starts = job.starts[slot];
  const BrickRow brick_row = job.view.brick_rows[b];
  const uint32_t *const atoms = job.view.atoms + brick_row.first_atom;
  const uint32_t *const arcs = job.view.arcs + brick_row.first_arc;
  const uint8_t *const arc_leaves = job.view.arc_leaves + brick_row.first_arc;
  glm::ivec3 first = lattice.first_point(lattice.brick_at(job.bricks.linear[job.view.first_brick + b]));
  const Vec3<float> center = leaf_center(lattice.position(first.x, first.y, first.z), leaf, h);
  first += brick_point(leaf, 0);
  for (int bit = lane; bit < 64; bit += kWarp)
    if (starts.points >> bit & 1)
      bit_memory[warp][popcount64(starts.points & ((uint64_t(1) << bit) - 1))] = static_cast<uint8_t>(bit);
  DeepestAtom best;
  const int atom_count = stage_leaf_atoms(f, reach, brick_row.atom_count, atoms, center, scratch, &best);
  const int count = popcount64(starts.points);
  uint64_t *const edges = job.edges + size_t(slot) * kWallSteps;

  for (int n0 = 0; n0 < count; n0 += kWarp) {
    __syncwarp();
    const bool on = n0 + lane < count;
    const int bit = bit_memory[warp][on ? n0 + lane : count - 1];
    const Vec3<float> x = lattice.position(first.x + (bit & 3), first.y + (bit >> 2 & 3), first.z + (bit >> 4));
    // As nearest_probe() has it, of a point that is outside.
    DeepestAtom deepest{0, reach.least_depth};
    if (atom_count <= kLeafAtoms) {
      for (int a = 0; a < atom_count; ++a) {
        const float d = ball_depth(scratch.atom[a], x);
        if (d > deepest.depth) deepest = {scratch.atom_number[a], d};
      }
    } else {
      for (uint32_t a = 0; a < brick_row.atom_count; ++a) {
        const uint32_t i = __ldg(atoms + a);
        const float d = ball_depth(load(f.atoms.items + i), x);
        if (d > deepest.depth) deepest = {i, d};
      }
    }
    NearestProbe probe{x, kFarAway};
    bool open = true;
    if (deepest.depth <= reach.least_depth) {
      probe.distance = 0.f;
      open = false;
    } else if (deepest.depth > depth) {
      open = false;
    } else if (projection_exposed(f, deepest.atom, x, deepest.depth)) {
      probe = {boundary_on_atom(load(f.atoms.items + deepest.atom), deepest.depth, x, true).position, deepest.depth};
      open = false;
    }
    __syncwarp();
    if (__any_sync(kFullWarp, open)) {
      NearestArc nearest;
      for (uint32_t k0 = 0; k0 < brick_row.arc_count;) {
        // As many arcs as there is room for.
        int staged = 0;
        for (; k0 < brick_row.arc_count && staged <= kLeafArcs - kWarp; k0 += kWarp) {
          const uint32_t a = k0 + static_cast<uint32_t>(lane);
          const bool near = a < brick_row.arc_count && (__ldg(arc_leaves + a) >> leaf & 1) != 0;
          const int place = append_place(near, &staged);
          if (near) {
            scratch.arc[place] = load(f.arcs + __ldg(arcs + a));
            scratch.arc_number[place] = __ldg(arcs + a);
          }
        }
        __syncwarp();
        for (int a = 0; a < staged; ++a)
          nearest.offer(static_cast<int>(scratch.arc_number[a]), arc_distance2(scratch.arc[a], x));
        __syncwarp();
      }
      if (open && nearest.distance2 <= depth * depth) {
        const BoundaryPoint y = boundary_on_arc(load(f.arcs + nearest.arc), x);
        probe = {y.position, y.distance};
      }
    }
    if (on)
      job.probes[starts.first + static_cast<unsigned>(n0 + lane)] =
          make_float4(probe.center.x, probe.center.y, probe.center.z, probe.distance);
    for (int s = 0; s < kWallSteps; ++s) {
      const glm::ivec3 step = wall_step(s);
      const Vec3<float> other = lattice.position(first.x + (bit & 3) + step.x, first.y + (bit >> 2 & 3) + step.y,
                                                 first.z + (bit >> 4) + step.z);
      const bool covered = on && probe_covers(f.parameters, probe, other);
      const uint64_t set = covered ? uint64_t(1) << bit : 0;
      const uint32_t low = warp_or(static_cast<uint32_t>(set)), high = warp_or(static_cast<uint32_t>(set >> 32));
      if (lane == s) edges[s] &= ~(static_cast<uint64_t>(high) << 32 | low);
    }
  }
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

__device__ __forceinline__ NearestProbe stored_probe(const WallJob &job, const WallStarts &starts, int bit) {
  const unsigned long long k =
      starts.first + static_cast<unsigned long long>(popcount64(starts.points & ((uint64_t(1) << bit) - 1)));
  const float4 v = job.probes[k];
  return {{v.x, v.y, v.z}, v.w};
}
__device__ __forceinline__ NearestProbe first_probe(const WallJob &job, const WallEdge &e) {
  return stored_probe(job, job.starts[e.slot], e.bit);
}
// False if it is not known: the point is no first end, or not of this slice.
__device__ __forceinline__ bool second_probe(const WallJob &job, const WallEdge &e, NearestProbe *probe) {
  const glm::ivec3 &p = e.second;
  uint32_t b = e.slot / kLeavesPerBrick;
  if ((p.x | p.y | p.z) & ~7) {
    const glm::ivec3 place = job.bricks.lattice.brick_at(job.bricks.linear[e.brick]);
    const int found = job.bricks.find(place + glm::ivec3(p.x >> 3, p.y >> 3, p.z >> 3));
    if (found < 0) return false;
    b = static_cast<uint32_t>(found) - job.view.first_brick;
    if (b >= job.view.bricks) return false;
  }
  const int x = p.x & 7, y = p.y & 7, z = p.z & 7, bit = leaf_bit(x & 3, y & 3, z & 3);
  const WallStarts starts = job.starts[b * kLeavesPerBrick + static_cast<uint32_t>(leaf_of(x, y, z))];
  if (!(starts.points >> bit & 1)) return false;
  *probe = stored_probe(job, starts, bit);
  return true;
}
__device__ __forceinline__ Vec3<float> wall_point(const WallJob &job, uint32_t brick, const glm::ivec3 &p) {
  const glm::ivec3 at = job.bricks.lattice.first_point(job.bricks.lattice.brick_at(job.bricks.linear[brick])) + p;
  return job.bricks.lattice.position(at.x, at.y, at.z);
}

// Lists the edges that the probes of both ends, as far as they are known, do not cover together. A warp per leaf that
// has edges.
static __global__ __launch_bounds__(kWallThreads) void list_walks_kernel(LaunchItems items, WallJob job) {
  const int lane = lane_id();
  const size_t k = items.first + blockIdx.x * kWallWarps + threadIdx.x / kWarp;
  if (k >= items.last) return;
  const uint32_t slot = job.leaves[k];
  // Edges are numbered through the words, 32 at a time.
  const uint64_t own = lane < kWallSteps ? job.edges[size_t(slot) * kWallSteps + size_t(lane)] : 0;
  const int sum = warp_inclusive_sum(popcount64(own), lane), total = __shfl_sync(kFullWarp, sum, kWarp - 1);
  for (int n0 = 0; n0 < total; n0 += kWarp) {
    const int n = n0 + lane;
    bool left = false;
    int step = 0, before = 0;
#pragma unroll
    for (int s = 0; s < kWallSteps; ++s) {
      const int up_to = __shfl_sync(kFullWarp, sum, s);
      if (up_to <= n) step = s + 1, before = up_to;
    }
    uint64_t word = __shfl_sync(kFullWarp, own, step < kWallSteps ? step : 0);
    uint64_t item = 0;
    if (n < total) {
      for (int skip = n - before; skip > 0; --skip) word &= word - 1;
      const int bit = lowest_bit64(word);
      const WallEdge e = wall_edge(job, slot, step, bit);
      NearestProbe b;
      left = !second_probe(job, e, &b) ||
             !begin_wall_walk(job.features.parameters, step, wall_point(job, e.brick, e.first), first_probe(job, e),
                              wall_point(job, e.brick, e.second), b)
                  .is_open();
      item = (static_cast<uint64_t>(slot) * kWallSteps + static_cast<uint64_t>(step)) * 64 + static_cast<uint64_t>(bit);
    }
    uint32_t count = 0;
    const uint32_t place = append_place(left, &count);
    unsigned long long base = 0;
    if (lane == 0 && count > 0) base = atomicAdd(&job.counters->walks, static_cast<unsigned long long>(count));
    base = __shfl_sync(kFullWarp, base, 0);
    if (left) job.walks[base + place] = item;
  }
}

// Eight lanes for each edge that is left.
static __global__ __launch_bounds__(kWallThreads) void walk_edges_kernel(LaunchItems items, WallJob job) {
  __shared__ uint32_t edge_memory[kWallThreads / kVertexLanes][kEdgeRoom];
  const FeatureView &f = job.features;
  const SurfaceParameters &p = f.parameters;
  const size_t teams = size_t(gridDim.x) * (kWallThreads / kVertexLanes), walks = job.counters->walks;
  const size_t total = walks < items.last ? walks : items.last;
  const int team = static_cast<int>(threadIdx.x) / kVertexLanes;
  for (size_t k = items.first + blockIdx.x * (kWallThreads / kVertexLanes) + static_cast<size_t>(team); k < total;
       k += teams) {
    const uint64_t item = job.walks[k];
    const WallEdge e = wall_edge(job, static_cast<uint32_t>(item / (64 * kWallSteps)),
                                 static_cast<int>(item / 64 % kWallSteps), static_cast<int>(item % 64));
    const Vec3<float> a = wall_point(job, e.brick, e.first), b = wall_point(job, e.brick, e.second);
    const float half = 0.5f * wall_step_length(e.step) * p.spacing + 2.f * job.reach.slack;
    const ListedCandidates all = brick_candidates(job.view, e.slot / kLeavesPerBrick);
    const SharedCandidates near = choose_for_edge(f, all, (a + b) * 0.5f, half, edge_memory[team]);
    const NearestProbe probe_a = first_probe(job, e);
    NearestProbe probe_b;
    if (!second_probe(job, e, &probe_b)) probe_b = nearest_probe(f, near, b);
    WallWalk walk = begin_wall_walk(p, e.step, a, probe_a, b, probe_b);
    const Vec3<float> direction = wall_direction(e.step);
    for (int round = 0; round < kMostWallSteps && !walk.is_open(); ++round) {
      const Vec3<float> x = a + direction * (walk.at + kWallStep);
      const NearestProbe probe = nearest_probe(f, near, x);
      if (probe.distance > p.depth) {
        if (near.rank() == 0)
          mark_wall(job.bricks, e.brick, marks_first_end(probe_a, probe_b) ? e.first : e.second, job.marks);
        break;
      }
      walk.at += kWallStep + way_out(p, probe, x, direction);
    }
  }
}

// What a run of bricks is expected to have: about a first end per vertex, and five edges per first end.
inline WallCounters expected_walls(const WorkFacts &facts, uint32_t bricks) {
  const double vertices = facts.size.bricks > 0 ? facts.size.vertices / facts.size.bricks : 64;
  const unsigned long long starts = static_cast<unsigned long long>(std::min(512.0, 1.25 * vertices + 16) * bricks);
  return {bricks * 4, starts, 6 * starts, 0};
}
template <class E>
WallCounters fetch_walls(E &executor, const WallCounters *counters, uint32_t) {
  return executor.fetch(counters);
}
template <class E>
WallCounters fetch_walls(CountingExecutor<E> &executor, const WallCounters *, uint32_t bricks) {
  return expected_walls(executor.facts(), bricks);
}

// Waits once.
template <class E>
void mark_thin_walls(E &executor, const FeatureView &features, const BrickSet &bricks, BrickRange slice,
                     CudaRooms &rooms, CudaCandidates &candidates, const uint64_t *signs, uint64_t *marks) {
  if (slice.size() == 0) return;
  const size_t leaves = static_cast<size_t>(slice.size()) * kLeavesPerBrick;
  WallJob job{};
  const bool gathered = candidates.slice.first == slice.first && candidates.slice.last == slice.last;
  if (!gathered) gather_candidates(executor, features, bricks, slice, rooms, candidates, nullptr);
  const auto mark = executor.arena().mark();
  job.features = features;
  job.bricks = bricks;
  job.reach = CandidateReach::of(features.parameters);
  job.view = candidates.view;
  job.signs = signs;
  job.marks = marks;
  Span<WallCounters> counters = executor.template allocate<WallCounters>(1);
  job.counters = counters.data;
  job.leaves = executor.template allocate<uint32_t>(leaves).data;
  job.starts = executor.template allocate<WallStarts>(leaves).data;
  job.edges = executor.template allocate<uint64_t>(leaves * kWallSteps).data;
  executor.fill(counters, 0);
  executor.launch("find_wall_candidates", find_wall_candidates_kernel, leaves,
                  LaunchShape{kWallThreads, kWallThreads, 96}, job);
  const WallCounters found = fetch_walls(executor, counters.data, slice.size());
  job.probes = executor.template allocate<float4>(static_cast<size_t>(found.starts)).data;
  job.walks = executor.template allocate<uint64_t>(static_cast<size_t>(found.edges)).data;
  const uint64_t row = candidates.longest_row, look = 64 + 2 * row + features.most_caps;
  executor.launch("probe_first_ends", probe_first_ends_kernel, found.leaves,
                  LaunchShape{kSignWarps * kWarp, kSignWarps, 2 * look}, job);
  executor.launch("list_walks", list_walks_kernel, found.leaves, LaunchShape{kWallThreads, kWallWarps, 18 * 48}, job);
  // As a rule few edges are left.
  const LaunchShape few{kWallThreads, kWallThreads / kVertexLanes, (2 + kMostWallSteps) * (64 + look / kVertexLanes),
                        executor.multiprocessors() * size_t(16)};
  size_t left = static_cast<size_t>(found.edges);
  if (!E::kCounts && !executor.is_few_launches(left, few))
    left = static_cast<size_t>(executor.fetch(&job.counters->walks));
  executor.launch("walk_edges", walk_edges_kernel, left, few, job);
  executor.arena().rewind(mark);
}

}  // namespace gpu

}  // namespace quickses
