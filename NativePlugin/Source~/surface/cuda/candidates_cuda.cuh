// SPDX-License-Identifier: MIT
// GPU: which atoms and arcs can matter in a brick, gathered once and kept as rows of numbers, and which of its leaves
// can hold surface.
#pragma once

#include "parallel/cuda_executor.cuh"
#include "parallel/cuda_warp.cuh"
#include "surface/memory/work_facts.h"
#include "surface/stages/hot_stages.h"

namespace quickses {
namespace gpu {

// How far things can matter, from the spacing h and the depth d. A leaf's points are within 1.5 root(3) h of its
// centre.
struct CandidateReach {
  float depth, spacing;
  float overhang;     // of vertex starts around the points of a brick or leaf
  float grown;        // of vertices around them: a start moves by up to kStartReach when it is projected
  float leaf_radius;  // ball around the points of a leaf
  float start_reach;  // arcs this near to a start decide about it
  float sign_arcs2;   // squared: arcs this near to a leaf's centre can be within depth of one of its points
  float slack;
  float least_depth;  // of a point that may be inside

  static CandidateReach of(const SurfaceParameters &p) {
    const float h = p.spacing, d = p.depth;
    CandidateReach r;
    r.depth = d;
    r.spacing = h;
    r.slack = 1e-3f + 0.01f * h;
    r.least_depth = p.least_depth();
    r.overhang = kStartOverhang * h;
    r.grown = (kStartOverhang + kStartReach) * h;
    r.leaf_radius = 1.5f * kRoot3 * h;
    r.start_reach = d + kStartReach * h + r.slack;
    const float sign = d + r.leaf_radius + r.slack;
    r.sign_arcs2 = sign * sign;
    return r;
  }
};

// How many atoms or arcs a brick lists, as a rule: half of its surroundings filled as densely as a protein.
inline double listed_candidates(const SurfaceParameters &parameters) {
  const CandidateReach reach = CandidateReach::of(parameters);
  const double wide = static_cast<double>(8.f * reach.spacing + 2.f * reach.grown + 2.f * parameters.max_radius);
  return 16.0 + 0.03 * std::min(1e6, wide * wide * wide);
}

// Words of the list that a leaf with vertices has besides (vertex_candidates_cuda.cuh): with its volume, more can
// matter to it.
inline uint32_t leaf_list_words(const SurfaceParameters &parameters) {
  constexpr double kUsual = 64, kUsualSpacing = 0.6, kMost = 2048;
  const double scale = static_cast<double>(parameters.spacing) / kUsualSpacing;
  return static_cast<uint32_t>(std::min(kMost, kUsual * std::max(1.0, std::ceil(scale * scale * scale))));
}
// Room that small structures are given beyond what is usual.
constexpr size_t kSpareCandidates = 1024;

// Rows of a brick: runs in the lists of atoms and arcs.
struct BrickRow {
  unsigned long long first_atom, first_arc;
  uint32_t atom_count, arc_count;
};

// Rows that are longer than this are told of.
constexpr uint32_t kUsualRow = 192;
struct CandidateCounters {
  unsigned long long atoms, arcs, leaves;
  uint32_t longest_row;  // of atoms or arcs; 0: none is longer than usual

  static CandidateCounters anticipated(const CandidateCounters &last, const CandidateCounters &most) {
    return {most.atoms, most.arcs, std::min(and_some_more(last.leaves), most.leaves), and_some_more(last.longest_row)};
  }
  bool covers(const CandidateCounters &found) const {
    return found.atoms <= atoms && found.arcs <= arcs && found.leaves <= leaves && found.longest_row <= longest_row;
  }
};

// The lists for a slice of bricks, as kernels see them.
struct CandidateView {
  uint32_t first_brick, bricks;
  BrickRow *brick_rows;
  uint32_t *atoms;
  uint32_t *arcs;
  uint8_t *arc_leaves;    // per entry of arcs: bit set = can be within depth of a point of that leaf
  uint32_t *leaf_list;    // leaves between whose points the surface may pass: 8 * brick of the slice + leaf
  uint8_t *brick_leaves;  // the same per brick: a bit per leaf
  const CandidateCounters *counted;
  unsigned long long leaf_room;  // so many leaves are evaluated: if there are more, all will be done again
  uint32_t *deciders;  // by 64 * (8 * brick + leaf) + bit, of those leaves: what a sign is from; nullptr: not kept
};

// What decides about a point that is outside, for thin walls, which ask for the nearest probe: the number of the
// nearest arc; that of the atom on whose exposed part the point is projected, with kOnContact; or one of the others.
constexpr uint32_t kOnContact = 0x80000000u, kOutsideBalls = 0xffffffffu, kNotLookedAt = 0xfffffffeu;

__device__ __forceinline__ Vec3<float> leaf_center(const Vec3<float> &low, int leaf, float h) {
  return {low.x + (static_cast<float>(4 * (leaf & 1)) + 1.5f) * h,
          low.y + (static_cast<float>(4 * (leaf >> 1 & 1)) + 1.5f) * h,
          low.z + (static_cast<float>(4 * (leaf >> 2)) + 1.5f) * h};
}

__device__ __forceinline__ float box_distance2(const Vec3<float> &low, float extent, const glm::vec3 &p) {
  const float dx = fmaxf(0.f, fmaxf(low.x - p.x, p.x - low.x - extent));
  const float dy = fmaxf(0.f, fmaxf(low.y - p.y, p.y - low.y - extent));
  const float dz = fmaxf(0.f, fmaxf(low.z - p.z, p.z - low.z - extent));
  return dx * dx + dy * dy + dz * dz;
}

constexpr int kGatherWarps = 4;
constexpr int kGatherRoom = 192;  // of each kind, in a warp's shared memory; longer rows are gathered twice

// The warps that gather for one brick: one, or all of a block where bricks are few. Each goes over a run of the cells.
template <int kWarps>
struct GatherTeam {
  static_assert(kWarps == 1 || kWarps == kGatherWarps, "a warp or a block");
  struct Memory {
    uint32_t words[kWarps];
    unsigned long long first;
  };
  Memory &memory;
  __device__ __forceinline__ int rank() const { return kWarps == 1 ? 0 : static_cast<int>(threadIdx.x) / kWarp; }
  __device__ __forceinline__ bool leads() const { return rank() == 0 && lane_id() == 0; }
  __device__ __forceinline__ void sync() const {
    if constexpr (kWarps == 1)
      __syncwarp();
    else
      __syncthreads();
  }
  // reduce(rank, word) for the words of all warps. Not again before sync().
  template <class Reduce>
  __device__ __forceinline__ void for_each_word(uint32_t own, const Reduce &reduce) const {
    if constexpr (kWarps == 1) {
      reduce(0, own);
    } else {
      if (lane_id() == 0) memory.words[rank()] = own;
      __syncthreads();
      for (int w = 0; w < kWarps; ++w) reduce(w, memory.words[w]);
    }
  }
  // A number that the one who leads has. Not again before sync().
  __device__ __forceinline__ unsigned long long from_leader(unsigned long long value) const {
    if constexpr (kWarps == 1) return __shfl_sync(kFullWarp, value, 0);
    if (leads()) memory.first = value;
    __syncthreads();
    return memory.first;
  }
};

// Calls visit(item, on) for the items of the cells around a box that are this warp's share.
template <int kWarps, class Visit>
__device__ __forceinline__ void visit_cells(const GatherTeam<kWarps> &team, const NeighborGridView &grid,
                                            const Vec3<float> &low, float extent, float reach, const Visit &visit) {
  if (grid.count == 0) return;
  const CellBox box = cells_around(grid.cells, {low.x - reach, low.y - reach, low.z - reach},
                                   {low.x + extent + reach, low.y + extent + reach, low.z + extent + reach});
  const int rows_y = box.y1 - box.y0 + 1, rows = rows_y * (box.z1 - box.z0 + 1);
  const int begin = rows * team.rank() / kWarps, end = rows * (team.rank() + 1) / kWarps;
  visit_runs(
      end - begin,
      [&](int r) { return grid.run(box.x0, box.x1, box.y0 + (begin + r) % rows_y, box.z0 + (begin + r) / rows_y); },
      visit);
}

struct GatherJob {
  FeatureView features;
  BrickSet bricks;
  CandidateReach reach;
  CandidateView view;
  CandidateCounters *counters;
  unsigned long long atom_room, arc_room;
  uint64_t *signs;  // of inactive leaves; nullptr: known already
};

// The ball that a point is deepest in, of `count` atoms: atom_at(k). No atoms: no ball, and a depth below all.
constexpr uint32_t kNoAtom = 0xffffffffu;
template <class AtomAt>
__device__ __forceinline__ DeepestAtom warp_deepest_atom(const FeatureView &f, uint32_t count, const AtomAt &atom_at,
                                                         const Vec3<float> &x) {
  NumberedValue best{-2.f * kFarAway, kNoAtom};
  for (uint32_t k = static_cast<uint32_t>(lane_id()); k < count; k += kWarp) {
    const uint32_t i = atom_at(k);
    const float depth = ball_depth(load(f.atoms.items + i), x);
    if (depth > best.value) best = {depth, i};
  }
  best = warp_largest(best);
  return {best.number, best.value};
}

// Whether the radial projection of a point on the ball it is deepest in is exposed.
__device__ __forceinline__ bool projection_exposed(const FeatureView &f, uint32_t atom, const Vec3<float> &x,
                                                   float depth) {
  const Sphere ball = load(f.atoms.items + atom);
  return is_exposed(f, atom, x - Vec3<float>(ball.center), offset_length(ball, depth));
}

// Sign of a leaf between whose points no surface passes: that of its centre. No arc is as near to it as depth.
__device__ __forceinline__ bool uniform_leaf_inside(const GatherJob &job, const uint32_t *atoms, uint32_t count,
                                                    const Vec3<float> &center) {
  const auto atom_at = [&](uint32_t k) { return atoms[k]; };  // this kernel wrote them
  const DeepestAtom deepest = warp_deepest_atom(job.features, count, atom_at, center);
  if (deepest.depth <= job.reach.least_depth) return false;
  if (deepest.depth > job.reach.depth) return true;
  return !projection_exposed(job.features, deepest.atom, center, deepest.depth);
}

// A list of one kind of things, and a warp's shared memory for the row it gathers.
struct RowMemory {
  uint32_t *near;
  uint8_t *near_leaves;  // nullptr: this kind has none
  uint32_t *items;
  uint8_t *leaves;
  unsigned long long *counter;
  unsigned long long room;
};
struct GatheredRow {
  unsigned long long first;
  uint32_t count;
  bool fits;
};

// Gathers the things around a box for which test(item, &leaves) holds, in the order of the grid. The first round
// counts, and keeps few in shared memory; a second one writes more. One copy of the test for both, so that they never
// disagree.
template <int kWarps, class Test>
__device__ __forceinline__ GatheredRow gather_row(const GatherTeam<kWarps> &team, const NeighborGridView &grid,
                                                  const Vec3<float> &low, float extent, float reach,
                                                  const RowMemory &memory, const Test &test) {
  const int lane = lane_id();
  uint32_t *items = memory.near;
  uint8_t *leaves = memory.near_leaves;
  uint32_t room = kGatherRoom;
  GatheredRow row{0, 0, false};
  for (int round = 0;; ++round) {
    uint32_t n = 0;
    visit_cells(team, grid, low, extent, reach, [&](uint32_t k, bool on) {
      uint32_t set = 0;
      const bool near = on && test(k, &set);
      const uint32_t place = append_place(near, &n);
      if (near && place < room) {
        items[place] = k;
        if (leaves) leaves[place] = static_cast<uint8_t>(set);
      }
    });
    if (round == 1) break;
    uint32_t before = 0;
    team.for_each_word(n, [&](int rank, uint32_t count) {
      if (rank < team.rank()) before += count;
      row.count += count;
    });
    if (team.leads()) row.first = atomicAdd(memory.counter, static_cast<unsigned long long>(row.count));
    row.first = team.from_leader(row.first);
    row.fits = row.first + row.count <= memory.room;
    if (!row.fits) break;  // all will be done again
    items = memory.items + row.first + before;
    if (leaves) leaves = memory.leaves + row.first + before;
    room = 0xffffffffu;
    if (n > kGatherRoom) continue;
    __syncwarp();
    for (uint32_t k = static_cast<uint32_t>(lane); k < n; k += kWarp) {
      items[k] = memory.near[k];
      if (leaves) leaves[k] = memory.near_leaves[k];
    }
    break;
  }
  team.sync();
  return row;
}

// The rows of one brick.
template <int kWarps>
static __global__ __launch_bounds__(kGatherWarps *kWarp, 8) void gather_candidates_kernel(QueuedItems queued,
                                                                                          GatherJob job) {
  const LaunchItems bricks = queued.in_turn();
  __shared__ uint32_t near_memory[kGatherWarps][kGatherRoom];
  __shared__ uint8_t near_leaves[kGatherWarps][kGatherRoom];
  __shared__ typename GatherTeam<kWarps>::Memory team_memory;
  const GatherTeam<kWarps> team{team_memory};
  const int warp = static_cast<int>(threadIdx.x) / kWarp, lane = lane_id();
  const uint32_t b =
      static_cast<uint32_t>(bricks.first) + (blockIdx.x * kGatherWarps + static_cast<uint32_t>(warp)) / kWarps;
  if (b >= bricks.last) return;
  const FeatureView &f = job.features;
  const CandidateReach &reach = job.reach;
  const Lattice &lattice = job.bricks.lattice;
  const float h = reach.spacing, extent = 7.f * h;
  const glm::ivec3 first = lattice.first_point(job.bricks.place(job.view.first_brick + b));
  const Vec3<float> low = lattice.position(first.x, first.y, first.z);

  // Atoms whose ball meets the box of the brick's vertices.
  uint32_t active = 0;
  const float grown = reach.grown, atom_extent = extent + 2.f * grown;
  const Vec3<float> atom_low(low.x - grown, low.y - grown, low.z - grown);
  const GatheredRow atoms =
      gather_row(team, f.atoms, atom_low, atom_extent, f.parameters.max_radius + reach.slack,
                 {near_memory[warp], nullptr, job.view.atoms, nullptr, &job.counters->atoms, job.atom_room},
                 [&](uint32_t k, uint32_t *) {
                   const Sphere atom = load(f.atoms.items + k);
                   const float radius = atom.radius + reach.slack;
                   if (!(box_distance2(atom_low, atom_extent, atom.center) < radius * radius)) return false;
                   if (f.cap_ranges[k].count != kBuriedAtom) {
                     const float surface = atom.radius - reach.depth, shell = reach.leaf_radius + reach.slack;
                     const float inner = fmaxf(0.f, surface - shell), outer = surface + shell;
#pragma unroll
                     for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) {
                       const float d2 = length_squared(leaf_center(low, leaf, h) - Vec3<float>(atom.center));
                       if (d2 >= inner * inner && d2 <= outer * outer) active |= 1u << leaf;
                     }
                   }
                   return true;
                 });

  // Arcs that can decide about a vertex start, and in which leaves about a lattice point.
  const float overhang = reach.overhang, arc_extent = extent + 2.f * overhang;
  const Vec3<float> arc_low(low.x - overhang, low.y - overhang, low.z - overhang);
  const GatheredRow arcs = gather_row(
      team, f.arc_bounds, arc_low, arc_extent, reach.start_reach + f.max_arc_bound,
      {near_memory[warp], near_leaves[warp], job.view.arcs, job.view.arc_leaves, &job.counters->arcs, job.arc_room},
      [&](uint32_t k, uint32_t *leaves) {
        const Sphere ball = load(f.arc_bounds.items + k);
        const float limit = ball.radius + reach.start_reach, sign_limit = ball.radius + reach.depth + reach.slack;
        if (!(box_distance2(arc_low, arc_extent, ball.center) < limit * limit)) return false;
        if (box_distance2(low, extent, ball.center) < sign_limit * sign_limit) {
          const Arc arc = load(f.arcs + k);
#pragma unroll 2
          for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf)
            if (arc_distance2(arc, leaf_center(low, leaf, h)) <= reach.sign_arcs2) *leaves |= 1u << leaf;
          active |= *leaves;
        }
        return true;
      });

  uint32_t active_leaves = 0;
  team.for_each_word(warp_or(active), [&](int, uint32_t leaves) { active_leaves |= leaves; });
  // Without room for its rows the brick has none; all will be done again.
  const bool fits = atoms.fits && arcs.fits;
  if (!fits) active_leaves = 0;
  unsigned long long first_leaf = 0;
  if (team.leads()) {
    if (active_leaves != 0)
      first_leaf = atomicAdd(&job.counters->leaves, static_cast<unsigned long long>(__popc(active_leaves)));
    job.view.brick_rows[b] = fits ? BrickRow{atoms.first, arcs.first, atoms.count, arcs.count} : BrickRow{0, 0, 0, 0};
    const uint32_t longest = atoms.count > arcs.count ? atoms.count : arcs.count;
    if (longest > kUsualRow) atomicMax(&job.counters->longest_row, longest);
  }
  if (team.rank() == 0) {
    first_leaf = __shfl_sync(kFullWarp, first_leaf, 0);
    if (lane == 0) job.view.brick_leaves[b] = static_cast<uint8_t>(active_leaves);
    if (lane < kLeavesPerBrick && (active_leaves >> lane & 1) != 0)
      job.view.leaf_list[first_leaf + static_cast<unsigned>(place_in(active_leaves, lane))] =
          b * kLeavesPerBrick + static_cast<uint32_t>(lane);
  }
  if (!job.signs) return;
  for (int leaf = team.rank(); leaf < kLeavesPerBrick; leaf += kWarps) {
    if (active_leaves >> leaf & 1) continue;
    const bool inside =
        fits && uniform_leaf_inside(job, job.view.atoms + atoms.first, atoms.count, leaf_center(low, leaf, h));
    if (lane == 0)
      job.signs[static_cast<size_t>(job.view.first_brick + b) * kLeavesPerBrick + static_cast<size_t>(leaf)] =
          inside ? ~uint64_t(0) : 0;
  }
}

}  // namespace gpu
}  // namespace quickses
