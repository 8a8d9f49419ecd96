// SPDX-License-Identifier: MIT
// GPU: which atoms and arcs can matter in a brick, gathered once, and which of its leaves can hold surface. Where
// spacings are wide, each leaf then has the part of its brick's that can matter to it.
#pragma once

#include "surface/cuda/candidate_rows_cuda.cuh"
#include "surface/cuda/learnt_rooms_cuda.cuh"
#include "surface/stages/hot_stages.h"

namespace quickses {

using CudaSlice = SliceWork<CudaRooms, CudaCandidates>;

namespace gpu {

// Where rows are counted, and room for so many items of all of them.
struct RowRoom {
  CandidateCounters *counters;
  unsigned long long atoms, arcs;
  unsigned long long leaves;  // so many are looked at: if there are more, all will be done again
};

struct GatherJob {
  FeatureView features;
  BrickSet bricks;
  CandidateReach reach;
  CandidateView view;
  RowRoom room;
  uint32_t first;   // brick of the view
  uint64_t *signs;  // of inactive leaves; nullptr: known already
};

// A number at the centres of a brick's leaves: that of the first, and what a step along each axis adds, so that it need
// not be found for each anew.
struct AtLeaves {
  float value[kLeavesPerBrick];
  __device__ __forceinline__ AtLeaves(float first, float x, float y, float z) {
    value[0] = first;
    value[1] = first + x;
#pragma unroll
    for (int k = 0; k < 2; ++k) value[2 + k] = value[k] + y;
#pragma unroll
    for (int k = 0; k < 4; ++k) value[4 + k] = value[k] + z;
  }
  __device__ __forceinline__ AtLeaves(float first, const Vec3<float> &each) : AtLeaves(first, each.x, each.y, each.z) {}
};
// Squared lengths of the ways there from a point; t: that to the first.
__device__ __forceinline__ AtLeaves lengths2_at_leaves(const Vec3<float> &t, float step) {
  const auto more = [&](float along) { return step * (along + along + step); };
  return {length_squared(t), more(t.x), more(t.y), more(t.z)};
}

// Without room for its rows a brick or leaf has none; all will be done again.
__device__ __forceinline__ CandidateRow candidate_row(const CandidateView &view, const GatheredRow &atoms,
                                                      const GatheredRow &arcs) {
  if (!atoms.fits || !arcs.fits) return {view.atoms, view.arcs, 0, 0};
  return {view.atoms + atoms.first, view.arcs + arcs.first, atoms.count, arcs.count};
}

// Sign of a leaf between whose points no surface passes: that of its centre, to which no arc is as near as depth. By a
// team of lanes for each of several leaves, all teams of a warp together.
template <int kLanes>
__device__ __forceinline__ bool uniform_leaf_inside(const GatherJob &job, const uint32_t *atoms, uint32_t count,
                                                    const Vec3<float> &center) {
  NumberedValue deepest{kNoDepth, kNoAtom};
  for (uint32_t k = static_cast<uint32_t>(rank_in_team<kLanes>()); k < count; k += kLanes) {
    const uint32_t i = atoms[k];  // this kernel wrote them
    const float depth = ball_depth(load(job.features.atoms.items + i), center);
    if (depth > deepest.value) deepest = {depth, i};
  }
  __syncwarp();
  deepest = warp_largest<kLanes>(deepest);
  if (deepest.value <= job.reach.least_depth) return false;
  if (deepest.value > job.reach.depth) return true;
  return !is_on_contact(job.features, {deepest.number, deepest.value}, center);
}

// The rows of one brick.
template <int kWarps>
static __global__ __launch_bounds__(
    GatherTeam<kWarps>::kBlockWarps *kWarp,
    blocks_at_once(GatherTeam<kWarps>::kBlockWarps *kWarp,
                   36 / GatherTeam<kWarps>::kBlockWarps)) void gather_candidates_kernel(QueuedItems queued,
                                                                                        GatherJob job) {
  const LaunchItems bricks = queued.in_turn();
  constexpr int kBlock = GatherTeam<kWarps>::kBlockWarps;
  __shared__ uint32_t near_memory[kBlock][kGatherRoom];
  __shared__ typename GatherTeam<kWarps>::Memory team_memory;
  const GatherTeam<kWarps> team{team_memory};
  const int warp = static_cast<int>(threadIdx.x) / kWarp, lane = lane_id();
  const uint32_t item =
      static_cast<uint32_t>(bricks.first) + (blockIdx.x * kBlock + static_cast<uint32_t>(warp)) / kWarps;
  if (item >= bricks.last) return;
  const uint32_t b = job.first + item;
  const FeatureView &f = job.features;
  const CandidateReach &reach = job.reach;
  const Lattice &lattice = job.bricks.lattice;
  const float h = reach.spacing, extent = 7.f * h;
  const glm::ivec3 first = lattice.first_point(job.bricks.place(job.view.first_brick + b));
  const Vec3<float> low = lattice.position(first.x, first.y, first.z), first_center = leaf_center(low, 0, h);
  const float leaf_step = 4.f * h;

  uint32_t active = 0;
  const auto around = [&](const NeighborGridView &grid, const PointBox &box, float look) {
    return [=, &grid, &team](const auto &visit) { visit_cells(team, grid, box, look, visit); };
  };
  // Atoms whose ball meets the box of the brick's vertices.
  const PointBox atom_box(low, extent, reach.grown);
  const GatheredRow atoms = gather_row(
      team, around(f.atoms, atom_box, f.atoms.cells.radii.in_cells + reach.slack),
      {near_memory[warp], kGatherRoom, job.view.atoms, &job.room.counters->atoms, job.room.atoms},
      [&](uint32_t k) {
        const Sphere atom = load(f.atoms.items + k);
        return atom_box.meets(atom.center, atom.radius + reach.slack);
      },
      [&](uint32_t k, size_t) {
        if (f.cap_ranges[k].count == kBuriedAtom) return k;
        const Sphere atom = load(f.atoms.items + k);
        const float surface = atom.radius - reach.depth, shell = reach.leaf_radius + reach.slack;
        const float inner = fmaxf(0.f, surface - shell), outer = surface + shell;
        const AtLeaves d2 = lengths2_at_leaves(first_center - Vec3<float>(atom.center), leaf_step);
#pragma unroll
        for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf)
          active |= ((d2.value[leaf] >= inner * inner) & (d2.value[leaf] <= outer * outer)) ? 1u << leaf : 0u;
        return k;
      });

  // Arcs that can decide about a vertex start, and in which leaves about a lattice point.
  const PointBox points(low, extent, 0.f), arc_box(low, extent, reach.overhang);
  const GatheredRow arcs = gather_row(
      team, around(f.arc_bounds, arc_box, reach.start_reach + f.max_arc_bound),
      {near_memory[warp], kGatherRoom, job.view.arcs, &job.room.counters->arcs, job.room.arcs},
      [&](uint32_t k) {
        const Sphere ball = load(f.arc_bounds.items + k);
        return arc_box.meets(ball.center, ball.radius + reach.start_reach);
      },
      [&](uint32_t k, size_t place) {
        uint32_t leaves = 0;
        const Sphere ball = load(f.arc_bounds.items + k);
        if (points.meets(ball.center, ball.radius + reach.depth + reach.slack)) {
          const Arc arc = load(f.arcs + k);
          const Vec3<float> t = first_center - Vec3<float>(arc.center), middle(arc.middle), side(arc.side);
          const AtLeaves along_middle(dot(t, middle), middle * leaf_step), along_side(dot(t, side), side * leaf_step),
              length2 = lengths2_at_leaves(t, leaf_step);
#pragma unroll
          for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) {
            const PlaceAtArc<float> place_there{along_middle.value[leaf], along_side.value[leaf], length2.value[leaf]};
            leaves |= arc_distance2(arc, place_there) <= reach.sign_arcs2 ? 1u << leaf : 0u;
          }
        }
        job.view.arc_leaves[place] = static_cast<uint8_t>(leaves);
        active |= leaves;
        return k;
      });

  uint32_t active_leaves = team.all_bits(warp_or(active));
  const bool fits = atoms.fits && arcs.fits;
  if (!fits) active_leaves = 0;
  unsigned long long first_leaf = 0;
  if (team.leads()) {
    if (active_leaves != 0)
      first_leaf = atomicAdd(&job.room.counters->leaves, static_cast<unsigned long long>(__popc(active_leaves)));
    job.view.rows[b] = candidate_row(job.view, atoms, arcs);
    const uint32_t longest = atoms.count > arcs.count ? atoms.count : arcs.count;
    if (longest > kUsualRow) atomicMax(&job.room.counters->longest_row, longest);
  }
  if (team.rank() == 0) {
    first_leaf = __shfl_sync(kFullWarp, first_leaf, 0);
    const bool are_looked_at = first_leaf + static_cast<unsigned>(__popc(active_leaves)) <= job.room.leaves;
    if (lane == 0) job.view.brick_leaves[b] = static_cast<uint8_t>(are_looked_at ? active_leaves : 0);
    if (lane < kLeavesPerBrick && (active_leaves >> lane & 1) != 0)
      job.view.leaf_list[first_leaf + static_cast<unsigned>(place_in(active_leaves, lane))] =
          b * kLeavesPerBrick + static_cast<uint32_t>(lane);
  }
  if (!job.signs) return;
  constexpr int kLeafLanes = 8, kLeavesAtOnce = kWarp / kLeafLanes;
  const uint32_t uniform = ~active_leaves & ((1u << kLeavesPerBrick) - 1);
  const int leaves = __popc(uniform);
  for (int n0 = kLeavesAtOnce * team.rank(); n0 < leaves; n0 += kLeavesAtOnce * kWarps) {
    const int n = n0 + lane / kLeafLanes, leaf = nth_bit64(uniform, n < leaves ? n : n0);
    const bool inside = uniform_leaf_inside<kLeafLanes>(job, job.view.atoms + atoms.first, fits ? atoms.count : 0,
                                                        leaf_center(low, leaf, h));
    if (n < leaves && lane % kLeafLanes == 0)
      job.signs[static_cast<size_t>(job.view.first_brick + b) * kLeavesPerBrick + static_cast<size_t>(leaf)] =
          inside ? ~uint64_t(0) : 0;
  }
}

struct NarrowJob {
  FeatureView features;
  BrickSet bricks;
  CandidateReach reach;
  CandidateView from, to;
  RowRoom room;
  uint32_t first;  // slot
};

// The rows of the leaves from those of their bricks.
template <int kWarps>
static __global__ __launch_bounds__(kGatherWarps *kWarp) void narrow_candidates_kernel(QueuedItems queued,
                                                                                       NarrowJob job) {
  static_assert(kWarps == 1 || kWarps == kGatherWarps, "a warp or a block");
  const LaunchItems leaves = queued.in_turn();
  __shared__ uint32_t near_memory[kGatherWarps][kNarrowRoom];
  __shared__ typename GatherTeam<kWarps>::Memory team_memory;
  const GatherTeam<kWarps> team{team_memory};
  const int warp = static_cast<int>(threadIdx.x) / kWarp;
  const size_t item = leaves.first + (blockIdx.x * kGatherWarps + static_cast<uint32_t>(warp)) / kWarps;
  if (item >= leaves.last) return;
  const uint32_t slot = job.first + static_cast<uint32_t>(item);
  const FeatureView &f = job.features;
  const CandidateReach &reach = job.reach;
  const Lattice &lattice = job.bricks.lattice;
  const glm::ivec3 first = lattice.first_point(job.bricks.place(job.from.first_brick + slot / kLeavesPerBrick)) +
                           brick_point(static_cast<int>(slot % kLeavesPerBrick), 0);
  const Vec3<float> low = lattice.position(first.x, first.y, first.z);
  const CandidateRow row = job.from.row_of(slot);
  uint32_t number = 0;  // of the item whose place in the brick's row is visited
  const auto along = [&](const uint32_t *items, uint32_t count) {
    return [=, &number, &team](const auto &visit) {
      const uint32_t rank = static_cast<uint32_t>(team.rank()),
                     end = static_cast<uint32_t>(uint64_t(count) * (rank + 1) / kWarps);
      // Asked for some ahead.
      constexpr int kAhead = 4;
      for (uint32_t k0 = static_cast<uint32_t>(uint64_t(count) * rank / kWarps); k0 < end; k0 += kAhead * kWarp) {
        uint32_t ahead[kAhead];
        const auto place_of = [&](int c) { return k0 + static_cast<uint32_t>(c * kWarp + lane_id()); };
#pragma unroll
        for (int c = 0; c < kAhead; ++c) ahead[c] = place_of(c) < end ? __ldg(items + place_of(c)) : 0;
#pragma unroll
        for (int c = 0; c < kAhead; ++c) {
          number = ahead[c];
          if (k0 + static_cast<uint32_t>(c * kWarp) < end) visit(place_of(c), place_of(c) < end);
        }
      }
    };
  };
  const float extent = 3.f * reach.spacing;
  const PointBox atom_box(low, extent, reach.grown), arc_box(low, extent, reach.overhang);
  const uint32_t *const from_atoms = row.atoms, *const from_arcs = row.arcs;
  const uint8_t *const from_leaves = job.from.arc_leaves + (from_arcs - job.from.arcs);
  const GatheredRow atoms = gather_row(
      team, along(from_atoms, row.atom_count),
      {near_memory[warp], kNarrowRoom, job.to.atoms, &job.room.counters->atoms, job.room.atoms},
      [&](uint32_t) {
        const Sphere atom = load(f.atoms.items + number);
        return atom_box.meets(atom.center, atom.radius + reach.slack);
      },
      [&](uint32_t k, size_t) { return __ldg(from_atoms + k); });
  const GatheredRow arcs = gather_row(
      team, along(from_arcs, row.arc_count),
      {near_memory[warp], kNarrowRoom, job.to.arcs, &job.room.counters->arcs, job.room.arcs},
      [&](uint32_t) {
        const Sphere ball = load(f.arc_bounds.items + number);
        return arc_box.meets(ball.center, ball.radius + reach.start_reach);
      },
      [&](uint32_t k, size_t place) {
        job.to.arc_leaves[place] = __ldg(from_leaves + k);
        return __ldg(from_arcs + k);
      });
  if (!team.leads()) return;
  job.to.rows[slot] = candidate_row(job.to, atoms, arcs);
  const uint32_t longest = atoms.count > arcs.count ? atoms.count : arcs.count;
  if (longest > kUsualRow) atomicMax(&job.room.counters->longest_row, longest);
}

// The list that all rows of one kind share: room for as many items as are usual, or were found before.
struct ListRoom {
  double usual;
  double *rate;  // of that, as it was learnt
  size_t items;
  ListRoom(double usual_of_row, size_t rows, uint32_t most_of_row, double *learnt)
      : usual(usual_of_row * static_cast<double>(rows)),
        rate(learnt),
        items(static_cast<size_t>(std::min(*rate * usual_of_row, static_cast<double>(most_of_row)) *
                                  static_cast<double>(rows)) +
              kSpareCandidates) {}
  bool holds(unsigned long long count) {
    if (count <= items) return true;
    *rate = std::max(*rate, kRoomToSpare * static_cast<double>(count) / usual);
    items = static_cast<size_t>(count);
    return false;
  }
};

// Room for the lists of a view, in which launch() fills its rows; once more if there was too little. Returns what was
// counted.
template <class E, class Launch>
CandidateCounters fill_rows(E &executor, const char *name, ListRoom atoms, ListRoom arcs, uint64_t most_leaves,
                            CandidateView *view, const Launch &launch) {
  const auto mark = executor.arena().mark();
  for (;;) {
    CandidateCounters *const counters = executor.template take_counts<CandidateCounters>();
    view->atoms = executor.template allocate<uint32_t>(atoms.items).data;
    view->arcs = executor.template allocate<uint32_t>(arcs.items).data;
    view->arc_leaves = executor.template allocate<uint8_t>(arcs.items).data;
    const CandidateCounters most{atoms.items, arcs.items, most_leaves, 0};
    CandidateCounters foreseen = most;
    executor.foresee(name, counters, most, &foreseen);
    launch(RowRoom{counters, atoms.items, arcs.items, foreseen.leaves});
    const CandidateCounters found = executor.expect(name, counters, most);
    const bool atoms_fit = atoms.holds(found.atoms), arcs_fit = arcs.holds(found.arcs);
    if (atoms_fit && arcs_fit) return found;
    executor.arena().rewind(mark);
  }
}

// Gathers the candidates of a slice, and finds the signs of its inactive leaves unless signs is nullptr. Waits once, or
// more often if the guess of their number was too small.
template <class E>
void gather_candidates(E &executor, const CudaSlice &s, uint64_t *signs) {
  const FeatureView &features = s.features;
  const BrickRange slice = s.slice;
  CudaRooms &rooms = s.rooms;
  const uint32_t n = slice.size();
  const size_t leaves = size_t(n) * kLeavesPerBrick;
  const SurfaceParameters &parameters = features.parameters;
  const CandidateReach reach = CandidateReach::of(parameters);
  CudaCandidates &candidates = s.candidates;
  if (candidates.view.bricks == 0) candidates.open(executor, parameters, slice);
  CandidateView &view = candidates.view;
  const uint32_t first = slice.first - view.first_brick;
  view.rows = candidates.brick_rows;
  view.row_shift = kRowOfBrick;
  view.leaf_list = executor.template allocate<uint32_t>(leaves).data;
  // All items in the cells around a brick are looked at, at most twice.
  const float extent = 7.f * reach.spacing + 2.f * reach.grown;
  // Where rows are few, several warps work on each, the more the longer they are: so many for a multiprocessor are
  // worth it, as measured from 0.5 to 2 Å.
  const double longest = static_cast<double>(features.atoms.count) + static_cast<double>(features.arc_bounds.count),
               row = std::min(listed_candidates(parameters, kBrickEdge), longest),
               most_warps = 0.5 * row * executor.multiprocessors();
  const auto may_have = [&](size_t rows, int warps) {
    return static_cast<double>(rows * static_cast<size_t>(warps)) <= most_warps;
  };
  const int warps = may_have(n, kMostGatherWarps) ? kMostGatherWarps : may_have(n, kGatherWarps) ? kGatherWarps : 1;
  // They share out rows of cells, of which one may have nearly all there is.
  const auto shape = [&](uint64_t near) {
    return LaunchShape{std::max(warps, kGatherWarps) * kWarp, warps > 1 ? size_t(1) : size_t(kGatherWarps),
                       256 + near / 16};
  };
  const auto is_enough = [&](uint64_t items) { return executor.is_few_launches(n, shape(items)); };
  const LaunchShape gather =
      shape(most_atoms_near(executor, features.atoms, extent + 2.f * (parameters.max_radius + reach.slack), is_enough) +
            most_items_near(executor, "fullest cell of arcs", features.arc_bounds,
                            extent + 2.f * (reach.start_reach + features.max_arc_bound), is_enough));
  const auto room_of = [&](size_t rows, int points, uint32_t most, double *learnt) {
    return ListRoom(listed_candidates(parameters, points), rows, most, learnt);
  };
  const uint32_t atoms = features.atoms.count, arcs = features.arc_bounds.count;
  CandidateCounters found =
      fill_rows(executor, "candidates", room_of(n, kBrickEdge, atoms, &rooms.listed_atoms),
                room_of(n, kBrickEdge, arcs, &rooms.listed_arcs), leaves, &view, [&](const RowRoom &room) {
                  view.counted = room.counters;
                  executor.launch("gather_candidates",
                                  warps == kMostGatherWarps ? gather_candidates_kernel<kMostGatherWarps>
                                  : warps == kGatherWarps   ? gather_candidates_kernel<kGatherWarps>
                                                            : gather_candidates_kernel<1>,
                                  n, gather, GatherJob{features, s.bricks, reach, view, room, first, signs});
                });
  candidates.leaves = static_cast<size_t>(found.leaves);
  if (have_leaf_rows(parameters)) {
    const CandidateView of_bricks = view;
    view.rows = candidates.leaf_rows;
    view.row_shift = kRowOfLeaf;
    const bool by_blocks = may_have(leaves, kGatherWarps);
    const LaunchShape narrow{kGatherWarps * kWarp, by_blocks ? size_t(1) : size_t(kGatherWarps),
                             128 + uint64_t(std::max(kUsualRow, found.longest_row)) / 4};
    found = fill_rows(
        executor, "candidates of leaves", room_of(leaves, kLeafEdge, atoms, &rooms.leaf_atoms),
        room_of(leaves, kLeafEdge, arcs, &rooms.leaf_arcs), 0, &view, [&](const RowRoom &room) {
          executor.launch("narrow_candidates",
                          by_blocks ? narrow_candidates_kernel<kGatherWarps> : narrow_candidates_kernel<1>, leaves,
                          narrow, NarrowJob{features, s.bricks, reach, of_bricks, view, room, first * kLeavesPerBrick});
        });
  }
  candidates.longest_row = std::max({candidates.longest_row, kUsualRow, found.longest_row});
  candidates.part = slice;
}

}  // namespace gpu
}  // namespace quickses
