// SPDX-License-Identifier: MIT
// GPU: which atoms and arcs can matter in a brick, gathered once and kept as rows of numbers, and which of its leaves
// can hold surface.
#pragma once

#include "parallel/cuda_executor.cuh"
#include "parallel/cuda_warp.cuh"
#include "surface/stages.h"

namespace quickses {
namespace gpu {

// How far things can matter, from the spacing h and the depth d. A leaf's points are within 1.5 root(3) h of its centre.
struct CandidateReach {
  float depth, spacing;
  float overhang;        // of vertex starts around the points of a brick or leaf
  float grown;           // of vertices around them: a start moves by up to kStartReach when it is projected
  float leaf_radius;     // ball around the points of a leaf
  float start_reach;     // arcs this near to a start decide about it
  float sign_arcs2;      // squared: arcs this near to a leaf's centre can be within depth of one of its points
  float slack;

  static CandidateReach of(const SurfaceParameters &p) {
    const float h = p.spacing, d = p.depth;
    CandidateReach r;
    r.depth = d;
    r.spacing = h;
    r.slack = 1e-3f + 0.01f * h;
    r.overhang = kStartOverhang * h;
    r.grown = (kStartOverhang + kStartReach) * h;
    r.leaf_radius = 1.5f * kRoot3 * h;
    r.start_reach = d + kStartReach * h + r.slack;
    const float sign = d + r.leaf_radius + r.slack;
    r.sign_arcs2 = sign * sign;
    return r;
  }
};

// Rows of a brick: runs in the lists of atoms and arcs.
struct BrickRow {
  unsigned long long first_atom, first_arc;
  uint32_t atom_count, arc_count;
};

struct CandidateCounters {
  unsigned long long atoms, arcs, leaves;
};

// The lists for a slice of bricks, as kernels see them.
struct CandidateView {
  uint32_t first_brick, bricks;
  BrickRow *brick_rows;
  uint32_t *atoms;
  uint32_t *arcs;
  uint8_t *arc_leaves;    // per entry of arcs: bit set = can be within depth of a point of that leaf
  uint32_t *leaf_list;    // leaves between whose points the surface may pass: 8 * brick of the slice + leaf
};

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

// Calls visit(item, on) for the items of the cells around a box.
template <class Visit>
__device__ __forceinline__ void visit_cells(const NeighborGridView &grid, const Vec3<float> &low, float extent,
                                            float reach, const Visit &visit) {
  if (grid.count == 0) return;
  const CellBox box = cells_around(grid.cells, {low.x - reach, low.y - reach, low.z - reach},
                                   {low.x + extent + reach, low.y + extent + reach, low.z + extent + reach});
  const int rows_y = box.y1 - box.y0 + 1;
  visit_runs(
      rows_y * (box.z1 - box.z0 + 1),
      [&](int r) { return grid.run(box.x0, box.x1, box.y0 + r % rows_y, box.z0 + r / rows_y); }, visit);
}

constexpr int kGatherWarps = 4;
constexpr int kGatherRoom = 192;  // of each kind, in shared memory; longer rows are gathered twice

struct GatherJob {
  FeatureView features;
  BrickSet bricks;
  CandidateReach reach;
  CandidateView view;
  CandidateCounters *counters;
  unsigned long long atom_room, arc_room;
  uint64_t *signs;  // of inactive leaves; nullptr: known already
};

// Sign of a leaf between whose points no surface passes: that of its centre. No arc is as near to it as depth.
__device__ __forceinline__ bool uniform_leaf_inside(const GatherJob &job, const uint32_t *atoms, uint32_t count,
                                                    const Vec3<float> &center) {
  float depth = -kFarAway;
  uint32_t atom = 0xffffffffu;
  for (uint32_t k = static_cast<uint32_t>(lane_id()); k < count; k += kWarp) {
    const uint32_t i = atoms[k];
    const float d = ball_depth(load(job.features.atoms.items + i), center);
    if (d > depth) {
      depth = d;
      atom = i;
    }
  }
#pragma unroll
  for (int d = kWarp / 2; d > 0; d >>= 1) {
    const float other_depth = __shfl_xor_sync(kFullWarp, depth, d);
    const uint32_t other = __shfl_xor_sync(kFullWarp, atom, d);
    if (other_depth > depth || (other_depth == depth && other < atom)) {
      depth = other_depth;
      atom = other;
    }
  }
  if (depth <= 0.f) return false;
  if (depth > job.reach.depth) return true;
  const Sphere ball = load(job.features.atoms.items + atom);
  return !is_exposed(job.features, atom, center - Vec3<float>(ball.center), offset_length(ball, depth));
}

// The rows of one brick. A warp per brick.
__global__ __launch_bounds__(kGatherWarps *kWarp) void gather_candidates_kernel(GatherJob job) {
  __shared__ uint32_t atom_memory[kGatherWarps][kGatherRoom], arc_memory[kGatherWarps][kGatherRoom];
  __shared__ uint8_t leaf_memory[kGatherWarps][kGatherRoom];
  const int warp = static_cast<int>(threadIdx.x) / kWarp, lane = lane_id();
  uint32_t *const near_atoms = atom_memory[warp], *const near_arcs = arc_memory[warp];
  uint8_t *const near_leaves = leaf_memory[warp];
  const uint32_t b = blockIdx.x * kGatherWarps + static_cast<uint32_t>(warp);
  if (b >= job.view.bricks) return;
  const FeatureView &f = job.features;
  const CandidateReach &reach = job.reach;
  const Lattice &lattice = job.bricks.lattice;
  const float h = reach.spacing, extent = 7.f * h;
  const glm::ivec3 first = lattice.first_point(lattice.brick_at(job.bricks.linear[job.view.first_brick + b]));
  const Vec3<float> low = lattice.position(first.x, first.y, first.z);

  // Atoms whose ball meets the box of the brick's vertices. store(place, atom).
  uint32_t active = 0;
  const float grown = reach.grown, atom_extent = extent + 2.f * grown;
  const Vec3<float> atom_low(low.x - grown, low.y - grown, low.z - grown);
  const auto gather_atoms = [&](const auto &store, bool mark) {
    uint32_t n = 0;
    visit_cells(f.atoms, atom_low, atom_extent, f.parameters.max_radius + reach.slack, [&](uint32_t k, bool on) {
      Sphere atom{glm::vec3(kFarAway), 0.f};
      if (on) atom = load(f.atoms.items + k);
      const float radius = atom.radius + reach.slack;
      const bool near = on && box_distance2(atom_low, atom_extent, atom.center) < radius * radius;
      const unsigned ballot = __ballot_sync(kFullWarp, near);
      if (near) {
        store(n + static_cast<uint32_t>(place_in(ballot, lane)), k);
        if (mark && f.cap_ranges[k].count != kBuriedAtom) {
          const float radius = atom.radius - reach.depth, shell = reach.leaf_radius + reach.slack;
          const float inner = fmaxf(0.f, radius - shell), outer = radius + shell;
#pragma unroll
          for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) {
            const float d2 = length_squared(leaf_center(low, leaf, h) - Vec3<float>(atom.center));
            if (d2 >= inner * inner && d2 <= outer * outer) active |= 1u << leaf;
          }
        }
      }
      n += static_cast<uint32_t>(__popc(ballot));
    });
    return n;
  };
  const uint32_t atom_count = gather_atoms(
      [&](uint32_t place, uint32_t k) {
        if (place < kGatherRoom) near_atoms[place] = k;
      },
      true);

  // Arcs that can decide about a vertex start or a point of a leaf. store(place, arc, leaves).
  const float overhang = reach.overhang, arc_extent = extent + 2.f * overhang;
  const Vec3<float> arc_low(low.x - overhang, low.y - overhang, low.z - overhang);
  const auto gather_arcs = [&](const auto &store) {
    uint32_t n = 0;
    visit_cells(f.arc_bounds, arc_low, arc_extent, reach.start_reach + f.max_arc_bound, [&](uint32_t k, bool on) {
      uint32_t leaves = 0;
      bool near = false;
      if (on) {
        const Sphere ball = load(f.arc_bounds.items + k);
        const float limit = ball.radius + reach.start_reach, sign_limit = ball.radius + reach.depth + reach.slack;
        near = box_distance2(arc_low, arc_extent, ball.center) < limit * limit;
        if (near && box_distance2(low, extent, ball.center) < sign_limit * sign_limit) {
          const Arc arc = load(f.arcs + k);
#pragma unroll
          for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf)
            if (arc_distance2(arc, leaf_center(low, leaf, h)) <= reach.sign_arcs2) leaves |= 1u << leaf;
          active |= leaves;
        }
      }
      const unsigned ballot = __ballot_sync(kFullWarp, near);
      if (near) store(n + static_cast<uint32_t>(place_in(ballot, lane)), k, static_cast<uint8_t>(leaves));
      n += static_cast<uint32_t>(__popc(ballot));
    });
    return n;
  };
  const uint32_t arc_count = gather_arcs([&](uint32_t place, uint32_t k, uint8_t leaves) {
    if (place < kGatherRoom) {
      near_arcs[place] = k;
      near_leaves[place] = leaves;
    }
  });

  BrickRow row{0, 0, atom_count, arc_count};
  unsigned long long first_leaf = 0;
  active = warp_or(active);
  if (lane == 0) {
    row.first_atom = atomicAdd(&job.counters->atoms, static_cast<unsigned long long>(atom_count));
    row.first_arc = atomicAdd(&job.counters->arcs, static_cast<unsigned long long>(arc_count));
    first_leaf = atomicAdd(&job.counters->leaves, static_cast<unsigned long long>(__popc(active)));
    job.view.brick_rows[b] = row;
  }
  row.first_atom = __shfl_sync(kFullWarp, row.first_atom, 0);
  row.first_arc = __shfl_sync(kFullWarp, row.first_arc, 0);
  first_leaf = __shfl_sync(kFullWarp, first_leaf, 0);
  if (row.first_atom + atom_count > job.atom_room || row.first_arc + arc_count > job.arc_room) return;  // done again

  uint32_t *const atoms = job.view.atoms + row.first_atom, *const arcs = job.view.arcs + row.first_arc;
  uint8_t *const arc_leaves = job.view.arc_leaves + row.first_arc;
  __syncwarp();
  if (atom_count <= kGatherRoom)
    for (uint32_t k = static_cast<uint32_t>(lane); k < atom_count; k += kWarp) atoms[k] = near_atoms[k];
  else
    gather_atoms([&](uint32_t place, uint32_t k) { atoms[place] = k; }, false);
  if (arc_count <= kGatherRoom)
    for (uint32_t k = static_cast<uint32_t>(lane); k < arc_count; k += kWarp) {
      arcs[k] = near_arcs[k];
      arc_leaves[k] = near_leaves[k];
    }
  else
    gather_arcs([&](uint32_t place, uint32_t k, uint8_t leaves) {
      arcs[place] = k;
      arc_leaves[place] = leaves;
    });
  __syncwarp();

  if (lane < kLeavesPerBrick) {
    if (active >> lane & 1)
      job.view.leaf_list[first_leaf + static_cast<unsigned>(place_in(active, lane))] =
          b * kLeavesPerBrick + static_cast<uint32_t>(lane);
  }
  if (!job.signs) return;
  for (uint32_t rest = ~active & 0xffu; rest; rest &= rest - 1) {
    const int leaf = __ffs(static_cast<int>(rest)) - 1;
    const bool inside = uniform_leaf_inside(job, atom_count <= kGatherRoom ? near_atoms : atoms, atom_count,
                                            leaf_center(low, leaf, h));
    if (lane == 0)
      job.signs[static_cast<size_t>(job.view.first_brick + b) * kLeavesPerBrick + static_cast<size_t>(leaf)] =
          inside ? ~uint64_t(0) : 0;
  }
}

}  // namespace gpu
}  // namespace quickses
