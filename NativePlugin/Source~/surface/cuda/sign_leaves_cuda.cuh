// SPDX-License-Identifier: MIT
// GPU: signs of the active leaves; of the exact field no more is found. A warp per leaf, two lattice points per lane;
// the sphere a point is deepest in decides about it by its caps, or else the nearest arc.
#pragma once

#include "surface/cuda/gather_candidates_cuda.cuh"
#include "surface/cuda/wide_leaves_cuda.cuh"

namespace quickses {
namespace gpu {

constexpr int kSignWarps = 2, kSignThreads = kSignWarps * kWarp;
// Atoms and arcs of a leaf in shared memory, as a rule. More atoms are read from the row; of more arcs some are staged
// at a time.
constexpr int kLeafAtoms = 64, kLeafArcs = 64;
static_assert(kLeafArcs >= kWarp, "so many are staged at a time");

// Shared memory of one warp.
struct LeafScratch {
  Sphere atom[kLeafAtoms];
  Arc arc[kLeafArcs];
  uint32_t atom_number[kLeafAtoms], arc_number[kLeafArcs];
};

static __global__ __launch_bounds__(kSignThreads,
                                    blocks_at_once(kSignThreads, 18)) void evaluate_leaves_kernel(QueuedItems queued,
                                                                                                  SignJob job) {
  const LaunchItems leaves = queued.in_turn();
  __shared__ LeafScratch scratch_memory[kSignWarps];
  const int warp = static_cast<int>(threadIdx.x) / kWarp, lane = lane_id();
  LeafScratch &scratch = scratch_memory[warp];
  const size_t place = leaves.first + blockIdx.x * kSignWarps + static_cast<uint32_t>(warp);
  if (place >= leaves.last || place >= job.view.counted->leaves) return;
  const FeatureView &f = job.features;
  const CandidateReach &reach = job.reach;
  const float depth = reach.depth;
  const SignLeaf leaf = job.open(place);
  const CandidateRow &row = leaf.row;

  // The first arcs are asked for before the atoms are looked at.
  constexpr int kAhead = 2;
  ListedArc ahead[kAhead];
#pragma unroll
  for (int c = 0; c < kAhead; ++c) ahead[c] = leaf.listed_arc(static_cast<uint32_t>(c * kWarp));

  // Those that can be deepest at one of its points; what there is no room for is left out.
  int atom_count = 0;
  const DeepestAtom best = job.choose_atoms(
      leaf, row.atom_count, [&](uint32_t k) { return __ldg(row.atoms + k); },
      [&](bool chosen, const Sphere &ball, uint32_t number) {
        const int at = append_place(chosen, &atom_count);
        if (chosen && at < kLeafAtoms) {
          scratch.atom[at] = ball;
          scratch.atom_number[at] = number;
        }
      });
  LeafKind kind = job.kind(best.depth);

  // Arcs that can be within depth of a point.
  int arc_count = 0;
  const auto stage_arcs = [&](const ListedArc &arc) {
    const bool near = leaf.meets(arc);
    const int at = append_place(near, &arc_count);
    if (near && at < kLeafArcs) {
      scratch.arc_number[at] = arc.number;
      begin_copy(scratch.arc + at, f.arcs + arc.number);
    }
  };
  if (kind == LeafKind::kMixed) {
#pragma unroll
    for (int c = 0; c < kAhead; ++c)
      if (static_cast<uint32_t>(c * kWarp) < row.arc_count) stage_arcs(ahead[c]);
    for (uint32_t k0 = kAhead * kWarp; k0 < row.arc_count; k0 += kWarp) stage_arcs(leaf.listed_arc(k0));
  }
  __syncwarp();
  if (kind == LeafKind::kMixed && arc_count == 0 && best.depth > 0.f && best.depth < depth) {
    // No arc is within depth of a point. If the centre is not on an exposed part, none of the points is.
    if (__any_sync(kFullWarp, CoveringCaps(f, best, leaf.center).are_covering<kWarp>(lane))) kind = LeafKind::kInside;
  }
  LaneSigns found(kind);
  if (kind == LeafKind::kMixed) {
    Vec3<float> p[kLanePoints];
    float deepest[kLanePoints];
    uint32_t atom[kLanePoints] = {};
#pragma unroll
    for (int c = 0; c < kLanePoints; ++c) {
      p[c] = job.point(leaf, c);
      deepest[c] = reach.least_depth;
    }
    const auto meet_ball = [&](const Sphere &ball, uint32_t number) {
#pragma unroll
      for (int c = 0; c < kLanePoints; ++c) {
        const float d = ball_depth(ball, p[c]);
        atom[c] = d > deepest[c] ? number : atom[c];
        deepest[c] = fmaxf(deepest[c], d);
      }
    };
    if (atom_count <= kLeafAtoms) {
      for (int k = 0; k < atom_count; ++k) meet_ball(scratch.atom[k], static_cast<uint32_t>(k));
#pragma unroll
      for (int c = 0; c < kLanePoints; ++c)
        if (deepest[c] > reach.least_depth) atom[c] = scratch.atom_number[atom[c]];
    } else {
      for (uint32_t k = 0; k < row.atom_count; ++k) {
        const uint32_t i = __ldg(row.atoms + k);
        meet_ball(load(f.atoms.items + i), i);
      }
    }
    bool open[kLanePoints], any_open = false;
#pragma unroll
    for (int c = 0; c < kLanePoints; ++c) open[c] = found.settle_by_ball(c, reach, {atom[c], deepest[c]});
#pragma unroll
    for (int c = 0; c < kLanePoints; ++c) {
      __syncwarp();
      if (open[c]) open[c] = !is_on_contact(f, {atom[c], deepest[c]}, p[c]);
      any_open |= open[c];
    }
    __syncwarp();
    if (__any_sync(kFullWarp, any_open)) {
      wait_for_copies();
      __syncwarp();
      float nearest[kLanePoints];
#pragma unroll
      for (int c = 0; c < kLanePoints; ++c) nearest[c] = kFarAway;
      const auto meet_arcs = [&](int count) {
        int at[kLanePoints];
#pragma unroll
        for (int c = 0; c < kLanePoints; ++c) at[c] = -1;
#pragma unroll 2
        for (int k = 0; k < count; ++k) {
          const Arc arc = scratch.arc[k];
#pragma unroll
          for (int c = 0; c < kLanePoints; ++c) {
            const float d = arc_distance2(arc, p[c]);
            at[c] = d < nearest[c] ? k : at[c];  // of several, the first, which has the lowest number
            nearest[c] = fminf(nearest[c], d);
          }
        }
#pragma unroll
        for (int c = 0; c < kLanePoints; ++c)
          if (open[c] && at[c] >= 0) found.decider[c] = scratch.arc_number[at[c]];
      };
      if (arc_count <= kLeafArcs) {
        meet_arcs(arc_count);
      } else {
        for (uint32_t k0 = 0; k0 < row.arc_count; k0 += kWarp) {
          arc_count = 0;
          stage_arcs(leaf.listed_arc(k0));
          wait_for_copies();
          __syncwarp();
          meet_arcs(arc_count);
          __syncwarp();
        }
      }
#pragma unroll
      for (int c = 0; c < kLanePoints; ++c)
        if (open[c]) found.inside[c] = nearest[c] > depth * depth;
    }
  }
  job.put(leaf, found);
}

// Evaluates the active leaves of a slice, which was gathered last. deciders: whether what decides about their points is
// kept for thin walls.
template <class E>
void evaluate_leaves(E &executor, const CudaSlice &s, bool deciders, uint64_t *signs) {
  CudaCandidates &candidates = s.candidates;
  if (deciders) candidates.decide(executor);
  const SignJob job{s.features, s.bricks, CandidateReach::of(s.features.parameters), candidates.view, signs};
  const uint64_t steps = candidates.look_steps(s.features);
  if (candidates.view.row_shift == kRowOfLeaf)
    executor.launch("evaluate_wide_leaves", evaluate_wide_leaves_kernel, candidates.leaves,
                    LaunchShape{kWideSignThreads, 1, steps}, job);
  else
    executor.launch("evaluate_leaves", evaluate_leaves_kernel, candidates.leaves,
                    LaunchShape{kSignThreads, kSignWarps, steps}, job);
}

}  // namespace gpu
}  // namespace quickses
