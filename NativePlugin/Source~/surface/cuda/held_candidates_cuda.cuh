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
  const int rank = held.rank();
  NumberedValue best{kNoDepth, kNoAtom};
  if (rank < held.listed.atom_count()) best = {ball_depth(held.ball, x), static_cast<uint32_t>(rank)};
  meet_atoms(f, held.listed, rank + kWarp, x, &best);
  return deepest_of_lanes(held.listed, best);
}

__device__ __forceinline__ NearestArc nearest_arc(const FeatureView &f, const HeldCandidates &held,
                                                  const Vec3<float> &x) {
  const int rank = held.rank();
  NearestArc best;
  if (rank < held.listed.arc_count()) best.offer(static_cast<int>(held.listed.arc(rank)), arc_distance2(held.arc, x));
  meet_arcs(f, held.listed, rank + kWarp, x, &best);
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
  const CoveringCaps caps(f, deepest, x);
  const bool has_cap = held.rank() < caps.range.count;
  Cap cap{};
  if (has_cap) cap = load(caps.caps + held.rank());
  const NearestArc nearest = nearest_arc(f, held, x);
  const bool covered = (has_cap && caps.covers(cap)) || caps.are_covering<kWarp>(held.rank() + kWarp);
  return __any_sync(kFullWarp, covered) ? probe_on_arc(f, nearest, x) : probe_on_atom(f, deepest, x);
}

}  // namespace gpu
}  // namespace quickses
