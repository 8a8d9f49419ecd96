// SPDX-License-Identifier: MIT
// GPU: candidates that a warp looks at for one point after the other, each of which waits for what the last one told: a
// wall, or the place of a vertex on its edge. Where few warps are at work, that is how long a kernel takes.
#pragma once

#include "surface/cuda/lane_candidates_cuda.cuh"
#include "surface/stages/thin_walls.h"

namespace quickses {
namespace gpu {

// Each lane holds its first atom and arc. The functions are those of projection.h and thin_walls.h, to the last bit.
struct HeldCandidates {
  LaneCandidates<kWarp, true> listed;
  Sphere ball;  // where there are so many
  Arc arc;
  __device__ __forceinline__ HeldCandidates(const FeatureView &f, const LaneCandidates<kWarp, true> &candidates)
      : listed(candidates) {
    if (rank() < listed.atom_count()) ball = load(f.atoms.items + listed.atom(rank()));
    if (rank() < listed.arc_count()) arc = load(f.arcs + listed.arc(rank()));
  }
  static __device__ __forceinline__ int rank() { return lane_id(); }
};

__device__ __forceinline__ DeepestAtom deepest_atom(const FeatureView &f, const HeldCandidates &held,
                                                    const Vec3<float> &x) {
  NumberedValue best{-2.f * kFarAway, kNoAtom};  // its place in the list: of several, the first
  const int count = held.listed.atom_count(), rank = held.rank();
  if (rank < count) best = {ball_depth(held.ball, x), static_cast<uint32_t>(rank)};
  for (int k = rank + kWarp; k < count; k += kWarp) {
    const float depth = ball_depth(load(f.atoms.items + held.listed.atom(k)), x);
    if (depth > best.value) best = {depth, static_cast<uint32_t>(k)};
  }
  best = warp_largest(best);
  return {best.number == kNoAtom ? 0u : held.listed.atom(static_cast<int>(best.number)), best.value};
}

__device__ __forceinline__ NearestArc nearest_arc(const FeatureView &f, const HeldCandidates &held,
                                                  const Vec3<float> &x) {
  NearestArc best;
  const int count = held.listed.arc_count(), rank = held.rank();
  if (rank < count) best.offer(static_cast<int>(held.listed.arc(rank)), arc_distance2(held.arc, x));
  for (int k = rank + kWarp; k < count; k += kWarp) {
    const int a = static_cast<int>(held.listed.arc(k));
    best.offer(a, arc_distance2(load(f.arcs + a), x));
  }
  return nearest_of_lanes<kWarp>(best, kFullWarp);
}

__device__ __forceinline__ bool is_on_contact(const FeatureView &f, const HeldCandidates &held,
                                              const DeepestAtom &deepest, const Vec3<float> &x) {
  return is_on_contact(f, held.listed, deepest, x);
}

// The nearest arc is looked for while what may cover the deepest atom is on its way.
__device__ __forceinline__ NearestProbe nearest_probe(const FeatureView &f, const HeldCandidates &held,
                                                      const Vec3<float> &x) {
  const DeepestAtom deepest = deepest_atom(f, held, x);
  if (tells_probe(f.parameters, deepest)) return told_probe(f.parameters, deepest, x);
  const Sphere ball = load(f.atoms.items + deepest.atom);
  const CapRange range = f.cap_ranges[deepest.atom];
  const bool has_cap = held.rank() < range.count;
  Cap cap{};
  if (has_cap) cap = load(f.caps + range.first + held.rank());
  const NearestArc nearest = nearest_arc(f, held, x);
  const Vec3<float> offset = x - Vec3<float>(ball.center);
  const float length = offset_length(ball, deepest.depth);
  bool covered = range.count == kBuriedAtom || (has_cap && cap_covers(cap, offset, length));
  for (int32_t k = held.rank() + kWarp; k < range.count && !covered; k += kWarp)
    covered = cap_covers(load(f.caps + range.first + k), offset, length);
  return __any_sync(kFullWarp, covered) ? probe_on_arc(f, nearest, x) : probe_on_atom(f, deepest, x);
}

}  // namespace gpu
}  // namespace quickses
