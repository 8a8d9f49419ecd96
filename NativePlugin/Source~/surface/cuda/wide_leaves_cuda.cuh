// SPDX-License-Identifier: MIT
// GPU: signs of leaves that have rows of their own (have_leaf_rows): hundreds of atoms and arcs are near each, and
// there are so few of them that a block of warps shares the work on one. Each warp looks at every kWideWarps-th
// candidate, for all points, and of what the warps found the best counts; of several, that with the lowest number.
#pragma once

#include "surface/cuda/leaf_signs_cuda.cuh"

namespace quickses {
namespace gpu {

constexpr int kWideWarps = 4, kWideSignThreads = kWideWarps * kWarp;
// In shared memory; as of narrow leaves, more atoms are read from the row, and more arcs staged in turns.
constexpr int kWideAtoms = 192, kWideArcs = 96;

struct WideLeafScratch {
  Sphere atom[kWideAtoms];
  Arc arc[kWideArcs];
  uint32_t atom_number[kWideAtoms], arc_number[kWideArcs];
  uint32_t atoms, arcs;               // how many there are, with those for which there is no room
  NumberedValue deepest[kWideWarps];  // at the leaf's centre
  NumberedValue found[kWideWarps][kLanePoints][kWarp];
  uint32_t covered[kLanePoints];  // bits of lanes

  // Of a point of the lane, the best that any warp found. All threads call this.
  __device__ __forceinline__ void combine(NumberedValue (&own)[kLanePoints]) {
    const int warp = static_cast<int>(threadIdx.x) / kWarp, lane = lane_id();
#pragma unroll
    for (int c = 0; c < kLanePoints; ++c) found[warp][c][lane] = own[c];
    __syncthreads();
#pragma unroll
    for (int w = 0; w < kWideWarps; ++w)
#pragma unroll
      for (int c = 0; c < kLanePoints; ++c) own[c].offer(found[w][c][lane]);
  }
};

static __global__ __launch_bounds__(kWideSignThreads,
                                    blocks_at_once(kWideSignThreads,
                                                   8)) void evaluate_wide_leaves_kernel(QueuedItems queued,
                                                                                        SignJob job) {
  const LaunchItems leaves = queued.in_turn();
  __shared__ WideLeafScratch scratch;
  const int warp = static_cast<int>(threadIdx.x) / kWarp, lane = lane_id();
  const size_t place = leaves.first + blockIdx.x;
  if (place >= leaves.last || place >= job.view.counted->leaves) return;
  if (threadIdx.x == 0) {
    scratch.atoms = scratch.arcs = 0;
    for (uint32_t &lanes : scratch.covered) lanes = 0;
  }
  __syncthreads();
  const FeatureView &f = job.features;
  const CandidateReach &reach = job.reach;
  const float depth = reach.depth;
  const SignLeaf leaf = job.open(place);
  const CandidateRow &row = leaf.row;

  // The warps take turns, 32 candidates at a time. The first arcs are asked for before the atoms are looked at.
  const uint32_t first = static_cast<uint32_t>(warp * kWarp);
  const ListedArc ahead = leaf.listed_arc(first);

  // Atoms that can be deepest at one of the points.
  const uint32_t left = row.atom_count % kWideSignThreads,
                 own = row.atom_count / kWideWarps / kWarp * kWarp + min(left - min(left, first), uint32_t(kWarp));
  const DeepestAtom deepest_of_warp = job.choose_atoms(
      leaf, own, [&](uint32_t k) { return __ldg(row.atoms + k / kWarp * kWideSignThreads + first + k % kWarp); },
      [&](bool chosen, const Sphere &ball, uint32_t number) {
        const uint32_t at = append_place_of_all(chosen, &scratch.atoms);
        if (chosen && at < kWideAtoms) {
          scratch.atom[at] = ball;
          scratch.atom_number[at] = number;
        }
      });
  if (lane == 0) scratch.deepest[warp] = {deepest_of_warp.depth, deepest_of_warp.atom};
  __syncthreads();
  NumberedValue deepest_of_all = scratch.deepest[0];
#pragma unroll
  for (int w = 1; w < kWideWarps; ++w) deepest_of_all.offer(scratch.deepest[w]);
  const DeepestAtom best{deepest_of_all.number, deepest_of_all.value};
  LeafKind kind = job.kind(best.depth);

  // Arcs that can be within depth of a point.
  const auto stage_arcs = [&](const ListedArc &arc) {
    const bool near = leaf.meets(arc);
    const uint32_t at = append_place_of_all(near, &scratch.arcs);
    if (near && at < kWideArcs) {
      scratch.arc_number[at] = arc.number;
      begin_copy(scratch.arc + at, f.arcs + arc.number);
    }
  };
  if (kind == LeafKind::kMixed) {
    if (first < row.arc_count) stage_arcs(ahead);
    for (uint32_t k0 = first + kWideSignThreads; k0 < row.arc_count; k0 += kWideSignThreads)
      stage_arcs(leaf.listed_arc(k0));
  }
  __syncthreads();
  const uint32_t atoms = scratch.atoms, arcs = scratch.arcs;
  if (kind == LeafKind::kMixed && arcs == 0 && best.depth > 0.f && best.depth < depth) {
    // No arc is within depth of a point. If the centre is not on an exposed part, none of the points is.
    if (__syncthreads_or(
            CoveringCaps(f, best, leaf.center).are_covering<kWideSignThreads>(static_cast<int>(threadIdx.x))))
      kind = LeafKind::kInside;
  }
  LaneSigns signs(kind);
  if (kind == LeafKind::kMixed) {
    Vec3<float> p[kLanePoints];
    NumberedValue deepest[kLanePoints];
#pragma unroll
    for (int c = 0; c < kLanePoints; ++c) {
      p[c] = job.point(leaf, c);
      deepest[c] = {reach.least_depth, kNoAtom};
    }
    const auto meet_ball = [&](const Sphere &ball, uint32_t number) {
#pragma unroll
      for (int c = 0; c < kLanePoints; ++c) deepest[c].offer({ball_depth(ball, p[c]), number});
    };
    if (atoms <= kWideAtoms) {
      for (uint32_t k = static_cast<uint32_t>(warp); k < atoms; k += kWideWarps)
        meet_ball(scratch.atom[k], scratch.atom_number[k]);
    } else {
      for (uint32_t k = static_cast<uint32_t>(warp); k < row.atom_count; k += kWideWarps) {
        const uint32_t i = __ldg(row.atoms + k);
        meet_ball(load(f.atoms.items + i), i);
      }
    }
    scratch.combine(deepest);

    bool open[kLanePoints], any_open = false;
#pragma unroll
    for (int c = 0; c < kLanePoints; ++c) {
      const DeepestAtom of_point{deepest[c].number, deepest[c].value};
      open[c] = signs.settle_by_ball(c, reach, of_point);
      const bool covers = open[c] && CoveringCaps(f, of_point, p[c]).are_covering<kWideWarps>(warp);
      const unsigned covered = __ballot_sync(kFullWarp, covers);
      if (lane == 0 && covered) atomicOr(&scratch.covered[c], covered);
    }
    wait_for_copies();
    __syncthreads();
#pragma unroll
    for (int c = 0; c < kLanePoints; ++c) {
      open[c] = open[c] & ((scratch.covered[c] >> lane & 1) != 0);
      any_open |= open[c];
    }
    if (__any_sync(kFullWarp, any_open)) {  // the same in all warps
      NumberedValue nearest[kLanePoints];   // minus the squared distance
#pragma unroll
      for (int c = 0; c < kLanePoints; ++c) nearest[c] = {-kFarAway, kNoAtom};
      const auto meet_arcs = [&](uint32_t count) {
#pragma unroll 2
        for (uint32_t k = static_cast<uint32_t>(warp); k < count; k += kWideWarps) {
          const Arc arc = scratch.arc[k];
          const uint32_t number = scratch.arc_number[k];
#pragma unroll
          for (int c = 0; c < kLanePoints; ++c) nearest[c].offer({-arc_distance2(arc, p[c]), number});
        }
      };
      if (arcs <= kWideArcs) {
        meet_arcs(arcs);
      } else {
        for (uint32_t k0 = 0; k0 < row.arc_count; k0 += kWideArcs / kWarp * kWarp) {
          __syncthreads();  // those before are not looked at any more
          if (threadIdx.x == 0) scratch.arcs = 0;
          __syncthreads();
          if (warp < kWideArcs / kWarp) stage_arcs(leaf.listed_arc(k0 + first));
          wait_for_copies();
          __syncthreads();
          meet_arcs(scratch.arcs);
        }
      }
      scratch.combine(nearest);
#pragma unroll
      for (int c = 0; c < kLanePoints; ++c) {
        if (!open[c]) continue;
        if (nearest[c].number != kNoAtom) signs.decider[c] = nearest[c].number;
        signs.inside[c] = -nearest[c].value > depth * depth;
      }
    }
  }
  if (warp == 0) job.put(leaf, signs);
}

}  // namespace gpu
}  // namespace quickses
