// SPDX-License-Identifier: MIT
// GPU: of many atoms, those that can be deepest at a point of a box.
#pragma once

#include "surface/cuda/candidates_cuda.cuh"
#include "surface/stages/projection.h"

namespace quickses {
namespace gpu {

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

}  // namespace gpu
}  // namespace quickses
