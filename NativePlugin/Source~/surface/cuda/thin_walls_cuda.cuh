// SPDX-License-Identifier: MIT
// GPU driver of thin walls: of the edges that may pass through one (wall_edges_cuda.cuh), the few that are left are
// walked by some lanes each.
#pragma once

#include "surface/cuda/held_candidates_cuda.cuh"
#include "surface/cuda/sign_leaves_cuda.cuh"
#include "surface/cuda/wall_edges_cuda.cuh"

namespace quickses {
namespace gpu {

// nearest_probe() by all teams of a warp in step, of which some ask.
template <int kLanes>
__device__ __forceinline__ NearestProbe nearest_probe_if(bool asks, const FeatureView &f,
                                                         LaneCandidates<kLanes, true> near, const Vec3<float> &x) {
  if (!asks) near.atom_total = 0;
  DeepestAtom deepest = deepest_atom(f, near, x);
  const bool told = tells_probe(f.parameters, deepest);
  const NearestProbe said = told_probe(f.parameters, deepest, x);
  if (told) deepest.depth = kNoDepth;
  const bool contact = is_on_contact(f, near, deepest, x);
  if (told || contact) near.arc_total = 0;
  const NearestArc nearest = nearest_arc(f, near, x);
  return told ? said : contact ? probe_on_atom(f, deepest, x) : probe_on_arc(f, nearest, x);
}

__device__ __forceinline__ NearestProbe nearest_probe_if(bool asks, const FeatureView &f, const HeldCandidates &near,
                                                         const Vec3<float> &x) {
  return asks ? nearest_probe(f, near, x) : NearestProbe{x, 0.f};
}

// Walks the edge of an item by a team of lanes, if it is on; all teams of a warp in step.
template <class Near>
__device__ __forceinline__ void walk_edge(const WallJob &job, const uint64_t *item, const WallEdge &e,
                                          const Vec3<float> &a, const Vec3<float> &b, bool on, const Near &near) {
  const FeatureView &f = job.features;
  const SurfaceParameters &p = f.parameters;
  const NearestProbe probe_a = decided_probe(f, first_decider(job, e.slot, e.bit, a), a);
  const uint32_t decider_b = decider_at(job, e.brick, e.second());
  const bool looks_for_b = decider_b == kNotLookedAt;
  NearestProbe probe_b{b, 0.f};
  if (__any_sync(kFullWarp, looks_for_b)) probe_b = nearest_probe_if(looks_for_b, f, near, b);
  if (!looks_for_b) probe_b = decided_probe(f, decider_b, b);
  WallWalk walk = begin_wall_walk(p, e.step, a, probe_a, b, probe_b);
  if (!on) walk = {0.f, 0.f};
  const Vec3<float> direction = wall_direction(e.step);
  for (int look = 0; look < kMostWallLooks && __any_sync(kFullWarp, !walk.is_open()); ++look) {
    const float at = walk.next(look);
    const Vec3<float> x = a + direction * at;
    const NearestProbe probe = nearest_probe_if(!walk.is_open(), f, near, x);
    if (walk.is_open()) continue;
    if (probe.distance > p.depth) {
      if (near.rank() == 0) {
        const WallEdge wall = edge_to_walk(job, *item);  // once more: walls are few, and registers are
        mark_wall(job.bricks, wall.brick, marks_first_end(probe_a, probe_b) ? wall.first() : wall.second(), job.marks);
      }
      walk = {0.f, 0.f};
    } else {
      walk_through(p, probe, x, e.step, at, &walk);
    }
  }
}

// How far from the middle of an edge balls decide about its points.
__device__ __forceinline__ float walk_reach(const WallJob &job, int step) {
  return 0.5f * wall_step_length(step) * job.reach.spacing + 2.f * job.reach.slack;
}

// What can decide about any of the edges, each of which several lanes of a warp have: chosen by all lanes, for those of
// one row at a time. A choice that there is no room for is the row itself, and takes none.
__device__ __forceinline__ LaneCandidates<kWarp, true> choose_for_run(const WallJob &job, const WallEdge &e,
                                                                      const Vec3<float> &middle, uint32_t *room,
                                                                      int most) {
  LaneCandidates<kWarp, true> own{};
  const uint32_t row = e.slot >> job.view.row_shift;
  for (unsigned left = kFullWarp; left != 0;) {
    const uint32_t slot = __shfl_sync(kFullWarp, e.slot, lowest_bit32(left));
    const bool mine = row == slot >> job.view.row_shift;
    const auto highest = [&](float x) { return warp_maximum(mine ? x : -kFarAway); };
    const Vec3<float> low(-highest(-middle.x), -highest(-middle.y), -highest(-middle.z)),
        high(highest(middle.x), highest(middle.y), highest(middle.z)), center = (low + high) * 0.5f;
    const float reach = square_root(length_squared(high - center)) + walk_reach(job, kWallSteps - 1) + job.reach.slack;
    const auto chosen = choose_near<kWarp>(job.features, row_candidates(job.view, slot), center, reach, room, most);
    if (mine) own = chosen;
    if (chosen.atoms == room) {
      room += chosen.atom_total + chosen.arc_total;
      most -= chosen.atom_total + chosen.arc_total;
    }
    left &= ~__ballot_sync(kFullWarp, mine);
  }
  return own;
}

constexpr int kRunRoom = 640;  // for what is chosen for a run

// Some lanes for each edge that is left, so that a warp takes a run of as many as it has teams. They wait for memory:
// more blocks at a time are worth registers, but for a warp for each, which few edges have. Where rows are long, what
// can decide about any edge of a run is chosen first, and from that what can decide about each.
template <int kLanes>
static __global__ __launch_bounds__(kWallThreads,
                                    blocks_at_once(kWallThreads,
                                                   kLanes == kWarp ? 4 : 8)) void walk_edges_kernel(QueuedItems queued,
                                                                                                    WallJob job) {
  const LaunchItems items = queued.in_turn();
  constexpr int kTeams = kWallThreads / kLanes, kRun = kWarp / kLanes, kRoom = 2560 / kTeams;
  __shared__ uint32_t edge_memory[kTeams][kRoom];
  extern __shared__ uint32_t run_memory[];  // run_room for each warp
  const size_t walks = job.counters->walks, total = walks < items.last ? walks : items.last;
  const int team = static_cast<int>(threadIdx.x) / kLanes, warp = team / kRun, n = team % kRun;
  for (size_t first = items.first + (blockIdx.x * size_t(kWallWarps) + static_cast<size_t>(warp)) * kRun; first < total;
       first += size_t(gridDim.x) * kWallWarps * kRun) {
    const bool on = static_cast<size_t>(n) < total - first;
    const uint64_t *const item = job.walks + first + (on ? n : 0);
    const WallEdge e = edge_to_walk(job, *item);
    const Vec3<float> a = wall_point(job, e.brick, e.first()), b = wall_point(job, e.brick, e.second()),
                      middle = (a + b) * 0.5f;
    const auto choose = [&](const auto &all) {
      return choose_near<kLanes>(job.features, all, middle, walk_reach(job, e.step), edge_memory[team], kRoom);
    };
    if constexpr (kLanes == kWarp) {
      walk_edge(job, item, e, a, b, on, HeldCandidates(job.features, choose(row_candidates(job.view, e.slot))));
    } else {
      const auto near = job.run_room > 0
                            ? choose(choose_for_run(job, e, middle, run_memory + warp * job.run_room, job.run_room))
                            : choose(row_candidates(job.view, e.slot));
      walk_edge(job, item, e, a, b, on, near);
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
void mark_thin_walls(E &executor, const CudaSlice &s, const uint64_t *signs, uint64_t *marks) {
  const FeatureView &features = s.features;
  CudaRooms &rooms = s.rooms;
  const CudaCandidates &candidates = s.candidates;
  const size_t leaves = static_cast<size_t>(s.slice.size()) * kLeavesPerBrick;
  if (!candidates.include(s.slice)) gather_candidates(executor, s, nullptr);
  if (!candidates.have_deciders()) evaluate_leaves(executor, s, true, nullptr);
  const auto mark = executor.arena().mark();
  WallJob job{};
  job.features = features;
  job.bricks = s.bricks;
  job.reach = CandidateReach::of(features.parameters);
  job.view = candidates.view;
  job.first_slot = (s.slice.first - job.view.first_brick) * kLeavesPerBrick;
  job.signs = signs;
  job.marks = marks;
  job.has_short_cuts = short_cuts_hold(s.bricks.lattice);
  WallCounters *const counters = executor.template take_counts<WallCounters>();
  job.counters = counters;
  job.leaves = executor.template allocate<uint32_t>(leaves).data;
  job.edges = executor.template allocate<uint64_t>(leaves * kWallSteps).data;
  executor.launch("find_wall_candidates", find_wall_candidates_kernel, leaves,
                  LaunchShape{kWallThreads, kWallThreads, 96}, job);
  const uint64_t look = candidates.look_steps(features);
  WallCounters found{};
  const double usual_walks = walked_edges(features.parameters) * static_cast<double>(leaves);
  job.walk_room = static_cast<unsigned long long>(rooms.walked_edges * usual_walks);
  for (;;) {
    const auto before_walks = executor.arena().mark();
    job.walks = executor.template allocate<uint64_t>(static_cast<size_t>(job.walk_room)).data;
    // Of a leaf: first ends and edges for each lane, and as many asked of the others' probes.
    constexpr uint64_t kStarts = 64 / kWarp, kEdges = kStarts * kWallSteps;
    // By blocks where there is one for each leaf that has edges, which half of them have, or fewer.
    const size_t blocks = blocks_in_turns(executor);
    const bool by_blocks = leaves <= 2 * blocks;
    executor.launch("drop_open_edges", by_blocks ? drop_open_edges_kernel<true> : drop_open_edges_kernel<false>, leaves,
                    LaunchShape{kWallThreads, by_blocks ? size_t(1) : size_t(kWallWarps),
                                kStarts * (64 + uint64_t(candidates.longest_row)) +
                                    kEdges * (kWarp * 2 + uint64_t(features.most_caps) * 3 / 4),
                                blocks},
                    job);
    found = executor.expect("walls", counters, WallCounters{static_cast<uint32_t>(leaves), job.walk_room});
    if (found.walks <= job.walk_room) break;
    executor.arena().rewind(before_walks);
    job.walk_room = found.walks;
    rooms.walked_edges = std::max(rooms.walked_edges, kRoomToSpare * static_cast<double>(found.walks) / usual_walks);
    executor.fill(Span<unsigned long long>{&counters->walks, 1}, 0);
  }
  // Few edges leave a GPU idle with few lanes each. Of many edges' lanes fewer are idle then, unless rows are so long
  // that there is much to look at for each. And it pays to choose from a row twice, unless it is short. As the spacing
  // tells how long they are.
  constexpr double kLongRow = 100, kVeryLongRow = 500;
  const bool by_bricks = candidates.view.row_shift == kRowOfBrick;
  const double row = listed_candidates(features.parameters, by_bricks ? kBrickEdge : kLeafEdge);
  const auto are_many = [&](size_t lanes) { return found.walks * lanes > executor.multiprocessors() * kFullThreads; };
  const size_t lanes = !are_many(kWarp) ? kWarp : are_many(4) && row < kVeryLongRow ? 4 : 8;
  job.run_room = lanes < kWarp && row > kLongRow ? kRunRoom : 0;
  executor.launch(
      "walk_edges",
      lanes == kWarp ? walk_edges_kernel<kWarp>
      : lanes == 8   ? walk_edges_kernel<8>
                     : walk_edges_kernel<4>,
      static_cast<size_t>(found.walks),
      LaunchShape{kWallThreads, kWallThreads / lanes, look / lanes + (2 + kMostWallLooks) * (64 + look / lanes),
                  blocks_in_turns(executor), kWallWarps * sizeof(uint32_t) * static_cast<size_t>(job.run_room)},
      job);
  executor.arena().rewind(mark);
}

}  // namespace gpu

}  // namespace quickses
