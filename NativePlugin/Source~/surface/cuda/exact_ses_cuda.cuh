// SPDX-License-Identifier: MIT
// GPU driver of the exact field: only signs are found. A warp per active leaf, two lattice points per lane; the sphere
// a point is deepest in decides about it by its caps, or else the nearest arc.
#pragma once

#include "surface/cuda/gather_candidates_cuda.cuh"

namespace quickses {
namespace gpu {

constexpr int kSignWarps = 2, kSignThreads = kSignWarps * kWarp;
// Atoms of a leaf in shared memory, as a rule, and where spacings are so wide that leaves have rows of their own; more
// are read from the row. Arcs; of more some are staged at a time.
constexpr int kLeafAtoms = 64, kWideLeafAtoms = 192, kLeafArcs = 64;

struct SignJob {
  FeatureView features;
  BrickSet bricks;
  CandidateReach reach;
  CandidateView view;
  uint64_t *signs;  // nullptr: known already
};

// Shared memory of one warp.
template <int kAtoms>
struct LeafScratch {
  Sphere atom[kAtoms];
  Arc arc[kLeafArcs];
  uint32_t atom_number[kAtoms], arc_number[kLeafArcs];
};

// A candidate is superfluous if another ball is deeper everywhere in a box. Its depth is at most that of its tangent
// plane at the box's centre, and what exceeds the other's depth is then greatest at a corner.
struct BoxCull {
  Vec3<float> center, half;
  float corner_depth[8];  // of the other ball

  // By teams of so many lanes, of which lane k < 8 works for corner k.
  template <int kLanes>
  __device__ __forceinline__ void set(const Vec3<float> &box_center, const Vec3<float> &half_extents,
                                      const Sphere &other, float slack) {
    center = box_center;
    half = half_extents;
    const int rank = rank_in_team<kLanes>(), first = lane_id() - rank;
    const Vec3<float> corner(center.x + (rank & 1 ? half.x : -half.x), center.y + (rank & 2 ? half.y : -half.y),
                             center.z + (rank & 4 ? half.z : -half.z));
    const float depth = ball_depth(other, corner) - slack;
#pragma unroll
    for (int k = 0; k < 8; ++k) corner_depth[k] = __shfl_sync(kFullWarp, depth, first + k);
  }

  // depth: of the box's centre in the ball.
  __device__ __forceinline__ bool keeps(const Sphere &ball, float depth) const {
    const float scale = quotient(1.f, fmaxf(ball.radius - depth, 1e-6f));
    const float x = (ball.center.x - center.x) * half.x * scale, y = (ball.center.y - center.y) * half.y * scale,
                z = (ball.center.z - center.z) * half.z * scale;
    bool keep = false;
#pragma unroll
    for (int k = 0; k < 8; ++k)
      keep |= depth + (k & 1 ? x : -x) + (k & 2 ? y : -y) + (k & 4 ? z : -z) > corner_depth[k];
    return keep;
  }
};

// Of `count` atoms, atom_at(k), those that can be deepest at a point of a box, as far as they come up to `floor` at its
// centre: visit(chosen, ball, number) for as many as a team has lanes after the other. Returns the one that is deepest
// at the centre, which is chosen in any case. Each team of a warp may ask for other atoms and another box.
template <int kLanes, class AtomAt, class Visit>
__device__ __forceinline__ DeepestAtom choose_deepest_atoms(const FeatureView &f, uint32_t count, const AtomAt &atom_at,
                                                            const Vec3<float> &center, const Vec3<float> &half,
                                                            float floor, float slack, const Visit &visit) {
  struct Looked {
    Sphere ball;
    float depth;
    uint32_t number;
  };
  const auto look_at = [&](uint32_t k) {
    Looked atom{{glm::vec3(0.f), 0.f}, kNoDepth, kNoAtom};
    if (k < count) {
      atom.number = atom_at(k);
      atom.ball = load(f.atoms.items + atom.number);
      atom.depth = ball_depth(atom.ball, center);
    }
    return atom;
  };
  // Two for each lane: a warp's hold as many as there are as a rule, and look at them once.
  constexpr uint32_t kStep = kLanes, kHeld = 2;
  const uint32_t rank = static_cast<uint32_t>(rank_in_team<kLanes>());
  Looked held[kHeld];
  NumberedValue best{kNoDepth, kNoAtom};
  const auto meet = [&](const Looked &atom) {
    if (atom.depth > best.value) best = {atom.depth, atom.number};
  };
#pragma unroll
  for (uint32_t c = 0; c < kHeld; ++c) held[c] = look_at(rank + c * kStep);
#pragma unroll
  for (uint32_t c = 0; c < kHeld; ++c) meet(held[c]);
  for (uint32_t k = rank + kHeld * kStep; k < count; k += kStep) meet(look_at(k));
  __syncwarp();
  best = warp_largest<kLanes>(best);
  if (!holds_for_any_team<kLanes>(count > 0)) return {best.number, best.value};
  BoxCull cull;
  cull.template set<kLanes>(center, half, load(f.atoms.items + (count > 0 ? best.number : 0)), slack);
  const auto choose = [&](const Looked &atom) {
    const bool is_there = atom.number != kNoAtom, is_best = is_there && atom.number == best.number;
    visit(is_best || (is_there && atom.depth >= floor && cull.keeps(atom.ball, atom.depth)), atom.ball, atom.number);
  };
#pragma unroll
  for (uint32_t c = 0; c < kHeld; ++c)
    if (holds_for_any_team<kLanes>(c * kStep < count)) choose(held[c]);
  for (uint32_t k0 = kHeld * kStep; holds_for_any_team<kLanes>(k0 < count); k0 += kStep) choose(look_at(k0 + rank));
  return {best.number, best.value};
}

enum class LeafKind { kMixed, kInside, kOutside };

template <int kAtoms>
static __global__ __launch_bounds__(kSignThreads,
                                    blocks_at_once(kSignThreads, 18)) void evaluate_leaves_kernel(QueuedItems queued,
                                                                                                  SignJob job) {
  const LaunchItems leaves = queued.in_turn();
  __shared__ LeafScratch<kAtoms> scratch_memory[kSignWarps];
  const int warp = static_cast<int>(threadIdx.x) / kWarp, lane = lane_id();
  LeafScratch<kAtoms> &scratch = scratch_memory[warp];
  constexpr int kPoints = 2;  // of each lane
  const size_t leaf_place = leaves.first + blockIdx.x * kSignWarps + static_cast<uint32_t>(warp);
  if (leaf_place >= leaves.last || leaf_place >= job.view.counted->leaves) return;
  const FeatureView &f = job.features;
  const CandidateReach &reach = job.reach;
  const Lattice &lattice = job.bricks.lattice;
  const float h = reach.spacing, depth = reach.depth;

  const uint32_t slot = job.view.leaf_list[leaf_place], b = slot / kLeavesPerBrick;
  const int leaf = static_cast<int>(slot % kLeavesPerBrick);
  const CandidateRow row = job.view.row_of(slot);
  const uint32_t *const atoms = job.view.atoms + row.first_atom;
  const uint32_t *const arcs = job.view.arcs + row.first_arc;
  const uint8_t *const arc_leaves = job.view.arc_leaves + row.first_arc;
  glm::ivec3 first = lattice.first_point(job.bricks.place(job.view.first_brick + b));
  const Vec3<float> center = leaf_center(lattice.position(first.x, first.y, first.z), leaf, h);
  first += brick_point(leaf, 0);

  // The first arcs are asked for before the atoms are looked at.
  struct ListedArc {
    uint32_t number, leaves;
  };
  const auto listed_arc = [&](uint32_t k0) {
    const uint32_t k = k0 + static_cast<uint32_t>(lane);
    return k < row.arc_count ? ListedArc{__ldg(arcs + k), __ldg(arc_leaves + k)} : ListedArc{0, 0};
  };
  constexpr int kAhead = 2;
  ListedArc ahead[kAhead];
#pragma unroll
  for (int c = 0; c < kAhead; ++c) ahead[c] = listed_arc(static_cast<uint32_t>(c * kWarp));

  // Those that can be deepest at one of its points; what there is no room for is left out.
  int atom_count = 0;
  const float half = 1.5f * h;
  const DeepestAtom best = choose_deepest_atoms<kWarp>(
      f, row.atom_count, [&](uint32_t k) { return __ldg(atoms + k); }, center, {half, half, half},
      -reach.leaf_radius - reach.slack, reach.slack,
      [&](bool chosen, const Sphere &ball, uint32_t number) {
        const int place = append_place(chosen, &atom_count);
        if (chosen && place < kAtoms) {
          scratch.atom[place] = ball;
          scratch.atom_number[place] = number;
        }
      });

  LeafKind kind = LeafKind::kMixed;
  const bool far_out = best.depth <= -reach.leaf_radius - reach.slack;
  // Where points may be next to one that is inside, what decides about them is asked for.
  const bool is_asked = job.view.deciders && best.depth > depth - kRoot3 * h - reach.leaf_radius - reach.slack;
  if (far_out || (best.depth <= reach.least_depth && depth > reach.leaf_radius + reach.slack && !is_asked))
    kind = LeafKind::kOutside;
  else if (best.depth - reach.leaf_radius - reach.slack > depth)
    kind = LeafKind::kInside;

  // Arcs that can be within depth of a point.
  int arc_count = 0;
  const auto stage_arcs = [&](const ListedArc &arc) {
    const bool near = (arc.leaves >> leaf & 1) != 0;
    const int place = append_place(near, &arc_count);
    if (near && place < kLeafArcs) {
      scratch.arc_number[place] = arc.number;
      scratch.arc[place] = load(f.arcs + arc.number);
    }
  };
  if (kind == LeafKind::kMixed) {
#pragma unroll
    for (int c = 0; c < kAhead; ++c)
      if (static_cast<uint32_t>(c * kWarp) < row.arc_count) stage_arcs(ahead[c]);
    for (uint32_t k0 = kAhead * kWarp; k0 < row.arc_count; k0 += kWarp) stage_arcs(listed_arc(k0));
  }
  __syncwarp();
  if (kind == LeafKind::kMixed && arc_count == 0 && best.depth > 0.f && best.depth < depth) {
    // No arc is within depth of a point. If the centre is not on an exposed part, none of the points is.
    const CapRange range = f.cap_ranges[best.atom];
    bool covered = range.count == kBuriedAtom;
    const Sphere ball = load(f.atoms.items + best.atom);
    const Vec3<float> offset = center - Vec3<float>(ball.center);
    const float length = offset_length(ball, best.depth);
    for (int32_t k = lane; k < range.count; k += kWarp)
      covered |= cap_covers(load(f.caps + range.first + k), offset, length);
    if (__any_sync(kFullWarp, covered)) kind = LeafKind::kInside;
  }
  bool inside[kPoints];
  uint32_t decider[kPoints];
#pragma unroll
  for (int c = 0; c < kPoints; ++c) {
    inside[c] = kind == LeafKind::kInside;
    decider[c] = far_out ? kOutsideBalls : kNotLookedAt;
  }
  if (kind == LeafKind::kMixed) {
    Vec3<float> p[kPoints];
    float deepest[kPoints];
    uint32_t atom[kPoints] = {};
#pragma unroll
    for (int c = 0; c < kPoints; ++c) {
      p[c] = lattice.position(first.x + (lane & 3), first.y + (lane >> 2 & 3), first.z + (lane >> 4) + 2 * c);
      deepest[c] = reach.least_depth;
    }
    const auto meet_ball = [&](const Sphere &ball, uint32_t number) {
#pragma unroll
      for (int c = 0; c < kPoints; ++c) {
        const float d = ball_depth(ball, p[c]);
        atom[c] = d > deepest[c] ? number : atom[c];
        deepest[c] = fmaxf(deepest[c], d);
      }
    };
    if (atom_count <= kAtoms) {
      for (int k = 0; k < atom_count; ++k) meet_ball(scratch.atom[k], static_cast<uint32_t>(k));
#pragma unroll
      for (int c = 0; c < kPoints; ++c)
        if (deepest[c] > reach.least_depth) atom[c] = scratch.atom_number[atom[c]];
    } else {
      for (uint32_t k = 0; k < row.atom_count; ++k) {
        const uint32_t i = __ldg(atoms + k);
        meet_ball(load(f.atoms.items + i), i);
      }
    }
    bool open[kPoints], any_open = false;
#pragma unroll
    for (int c = 0; c < kPoints; ++c) {
      inside[c] = deepest[c] > depth;
      open[c] = deepest[c] > reach.least_depth && !inside[c];
      decider[c] = deepest[c] > reach.least_depth ? kOnContact | atom[c] : kOutsideBalls;
    }
#pragma unroll
    for (int c = 0; c < kPoints; ++c) {
      __syncwarp();
      if (open[c]) open[c] = !projection_exposed(f, atom[c], p[c], deepest[c]);
      any_open |= open[c];
    }
    __syncwarp();
    if (__any_sync(kFullWarp, any_open)) {
      float nearest[kPoints];
#pragma unroll
      for (int c = 0; c < kPoints; ++c) nearest[c] = kFarAway;
      const auto meet_arcs = [&](int count) {
        int place[kPoints];
#pragma unroll
        for (int c = 0; c < kPoints; ++c) place[c] = -1;
#pragma unroll 2
        for (int k = 0; k < count; ++k) {
          const Arc arc = scratch.arc[k];
#pragma unroll
          for (int c = 0; c < kPoints; ++c) {
            const float d = arc_distance2(arc, p[c]);
            place[c] = d < nearest[c] ? k : place[c];  // of several, the first, which has the lowest number
            nearest[c] = fminf(nearest[c], d);
          }
        }
#pragma unroll
        for (int c = 0; c < kPoints; ++c)
          if (open[c] && place[c] >= 0) decider[c] = scratch.arc_number[place[c]];
      };
      if (arc_count <= kLeafArcs) {
        meet_arcs(arc_count);
      } else {
        for (uint32_t k0 = 0; k0 < row.arc_count; k0 += kWarp) {
          arc_count = 0;
          stage_arcs(listed_arc(k0));
          __syncwarp();
          meet_arcs(arc_count);
          __syncwarp();
        }
      }
#pragma unroll
      for (int c = 0; c < kPoints; ++c)
        if (open[c]) inside[c] = nearest[c] > depth * depth;
    }
  }
  unsigned words[kPoints];
#pragma unroll
  for (int c = 0; c < kPoints; ++c) {
    if (job.view.deciders) job.view.deciders[size_t(slot) * 64 + static_cast<size_t>(c * kWarp + lane)] = decider[c];
    words[c] = __ballot_sync(kFullWarp, inside[c]);
  }
  if (lane == 0 && job.signs)
    job.signs[static_cast<size_t>(job.view.first_brick + b) * kLeavesPerBrick + static_cast<size_t>(leaf)] =
        static_cast<uint64_t>(words[1]) << 32 | words[0];
}

// Evaluates the active leaves of a slice. deciders: whether what decides about their points is kept for thin walls.
template <class E>
void evaluate_leaves(E &executor, const FeatureView &features, const BrickSet &bricks, CudaCandidates &candidates,
                     bool deciders, uint64_t *signs) {
  if (deciders) {
    if (candidates.decider_room.size == 0)
      candidates.decider_room = executor.template allocate<uint32_t>(size_t(candidates.slice.size()) * kBrickPoints);
    candidates.view.deciders = candidates.decider_room.data;
    candidates.have_deciders = true;
  }
  const bool are_wide = candidates.view.row_shift == kRowOfLeaf;
  executor.launch("evaluate_leaves",
                  are_wide ? evaluate_leaves_kernel<kWideLeafAtoms> : evaluate_leaves_kernel<kLeafAtoms>,
                  candidates.leaves, LaunchShape{kSignThreads, kSignWarps, candidates.look_steps(features)},
                  SignJob{features, bricks, CandidateReach::of(features.parameters), candidates.view, signs});
}

}  // namespace gpu

}  // namespace quickses
