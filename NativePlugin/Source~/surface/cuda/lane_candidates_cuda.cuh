// SPDX-License-Identifier: MIT
// GPU: candidates that the lanes of a warp, or a few of them, look at together for one point, with the same result in
// each. The functions are those of projection.h, to the last bit.
#pragma once

#include "parallel/cuda_warp.cuh"
#include "surface/cuda/covering_caps_cuda.cuh"
#include "surface/cuda/deepest_atoms_cuda.cuh"

namespace quickses {
namespace gpu {

// kTogether: all lanes of the warp call the functions together. Else those of a team do, while others may be elsewhere;
// then each team's turn comes after the others', which takes several times as long.
template <int kLanes, bool kTogether = false>
struct LaneCandidates {
  const uint32_t *atoms;  // in any memory
  const uint32_t *arcs;
  int atom_total, arc_total;
  __device__ __forceinline__ int atom_count() const { return atom_total; }
  __device__ __forceinline__ int arc_count() const { return arc_total; }
  __device__ __forceinline__ uint32_t atom(int k) const { return atoms[k]; }
  __device__ __forceinline__ uint32_t arc(int k) const { return arcs[k]; }
  static __device__ __forceinline__ int rank() { return rank_in_team<kLanes>(); }
  static __device__ __forceinline__ unsigned team() { return lanes_of_team<kLanes>(); }
  static __device__ __forceinline__ unsigned lanes() { return kTogether ? kFullWarp : team(); }
};

// For functions that only some teams of a warp call.
template <int kLanes>
__device__ __forceinline__ LaneCandidates<kLanes> apart(const LaneCandidates<kLanes, true> &c) {
  return {c.atoms, c.arcs, c.atom_total, c.arc_total};
}

// The deepest atom for one lane, of those from place k on that are its own: of several, the first.
template <int kLanes, bool kTogether>
__device__ __forceinline__ void meet_atoms(const FeatureView &f, const LaneCandidates<kLanes, kTogether> &candidates,
                                           int k, const Vec3<float> &x, NumberedValue *best) {
  const int count = candidates.atom_count();
#pragma unroll 4
  for (; k < count; k += kLanes) {
    const float depth = ball_depth(load(f.atoms.items + candidates.atom(k)), x);
    if (depth > best->value) *best = {depth, static_cast<uint32_t>(k)};
  }
}
// That of all lanes, by its place.
template <int kLanes, bool kTogether>
__device__ __forceinline__ DeepestAtom deepest_of_lanes(const LaneCandidates<kLanes, kTogether> &candidates,
                                                        NumberedValue best) {
  best = warp_largest<kLanes>(best, candidates.lanes());
  return {best.number == kNoAtom ? 0u : candidates.atom(static_cast<int>(best.number)), best.value};
}
template <int kLanes, bool kTogether>
__device__ __forceinline__ DeepestAtom deepest_atom(const FeatureView &f,
                                                    const LaneCandidates<kLanes, kTogether> &candidates,
                                                    const Vec3<float> &x) {
  NumberedValue best{kNoDepth, kNoAtom};
  meet_atoms(f, candidates, candidates.rank(), x, &best);
  return deepest_of_lanes(candidates, best);
}

// The nearest arc for one lane.
template <int kLanes, bool kTogether>
__device__ __forceinline__ void meet_arcs(const FeatureView &f, const LaneCandidates<kLanes, kTogether> &candidates,
                                          int k, const Vec3<float> &x, NearestArc *best) {
  const int count = candidates.arc_count();
#pragma unroll 4
  for (; k < count; k += kLanes) {
    const int a = static_cast<int>(candidates.arc(k));
    best->offer(a, arc_distance2(load(f.arcs + a), x));
  }
}
// That of all lanes.
template <int kLanes>
__device__ __forceinline__ NearestArc nearest_of_lanes(NearestArc best, unsigned lanes) {
  if constexpr (kLanes == kWarp) {
    const NumberedValue nearest = warp_largest({-best.distance2, static_cast<uint32_t>(best.arc)});
    const int arc = static_cast<int>(nearest.number);
    return {arc, -nearest.value, -warp_maximum(best.arc == arc ? -best.second2 : -best.distance2)};
  } else {
#pragma unroll
    for (int d = kLanes / 2; d > 0; d >>= 1) {
      const int arc = __shfl_xor_sync(lanes, best.arc, d);
      const float distance2 = __shfl_xor_sync(lanes, best.distance2, d);
      const float second2 = __shfl_xor_sync(lanes, best.second2, d);
      if (arc >= 0) best.offer(arc, distance2);
      best.second2 = minimum(best.second2, second2);
    }
    return best;
  }
}

template <int kLanes, bool kTogether>
__device__ __forceinline__ NearestArc nearest_arc(const FeatureView &f,
                                                  const LaneCandidates<kLanes, kTogether> &candidates,
                                                  const Vec3<float> &x) {
  NearestArc best;
  meet_arcs(f, candidates, candidates.rank(), x, &best);
  return nearest_of_lanes<kLanes>(best, candidates.lanes());
}

template <int kLanes, bool kTogether>
__device__ __forceinline__ bool is_on_contact(const FeatureView &f, const LaneCandidates<kLanes, kTogether> &candidates,
                                              const DeepestAtom &deepest, const Vec3<float> &x) {
  const bool covered = CoveringCaps(f, deepest, x).are_covering<kLanes>(candidates.rank());
  return (__ballot_sync(candidates.lanes(), covered) & candidates.team()) == 0;
}

// Those of some candidates that decide about points within `reach` of a middle, as those of an edge; all of them where
// there is no room for the choice.
template <int kLanes, class Candidates>
__device__ __forceinline__ LaneCandidates<kLanes, true> choose_near(const FeatureView &f, const Candidates &all,
                                                                    const Vec3<float> &middle, float reach,
                                                                    uint32_t *room, int most) {
  using Chosen = LaneCandidates<kLanes, true>;
  const unsigned team = Chosen::team();
  const int rank = Chosen::rank();
  const auto choose = [&](const Sphere *balls, const auto &item_at, int count, float reach, uint32_t *out, int left) {
    constexpr int kAhead = 4;  // loads that are under way together
    int n = 0;
    for (int k0 = rank; __any_sync(kFullWarp, k0 - rank < count); k0 += kAhead * kLanes) {
      uint32_t item[kAhead];
      bool near[kAhead];
#pragma unroll
      for (int j = 0; j < kAhead; ++j) {
        near[j] = k0 + j * kLanes < count;
        item[j] = near[j] ? item_at(k0 + j * kLanes) : 0;
      }
#pragma unroll
      for (int j = 0; j < kAhead; ++j) {
        if (!near[j]) continue;
        const Sphere ball = load(balls + item[j]);
        const float r = ball.radius + reach;
        near[j] = length_squared(Vec3<float>(ball.center) - middle) < r * r;
      }
#pragma unroll
      for (int j = 0; j < kAhead; ++j) {
        const int place = append_place(near[j], &n, team);
        if (near[j] && place < left) out[place] = item[j];
      }
    }
    return n;
  };
  __syncwarp();  // the choice before is not looked at any more
  const int atoms = choose(
      f.atoms.items, [&](int k) { return all.atom(k); }, all.atom_total, reach, room, most);
  const int left = atoms < most ? most - atoms : 0;
  const int arcs = choose(
      f.arc_bounds.items, [&](int k) { return all.arc(k); }, all.arc_total, f.parameters.depth + reach,
      room + (most - left), left);
  __syncwarp();
  if (atoms > most || arcs > left) return {all.atoms, all.arcs, all.atom_total, all.arc_total};
  return {room, room + atoms, atoms, arcs};
}

}  // namespace gpu
}  // namespace quickses
