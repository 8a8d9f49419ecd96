// SPDX-License-Identifier: MIT
// GPU: whether what a point is projected on is covered, as far as threads can tell that share the look at the caps.
#pragma once

#include "surface/cuda/candidates_cuda.cuh"
#include "surface/stages/projection.h"

namespace quickses {
namespace gpu {

// The caps of the ball that a point is deepest in. is_on_contact() of projection.h is that none covers it.
struct CoveringCaps {
  CapRange range{0, kBuriedAtom};
  const Cap *caps;
  Vec3<float> offset;  // from the ball's centre
  float length;

  __device__ __forceinline__ CoveringCaps(const FeatureView &f, const DeepestAtom &deepest, const Vec3<float> &x) {
    if (deepest.depth > -kFarAway) range = f.cap_ranges[deepest.atom];
    caps = f.caps + range.first;
    const Sphere ball = load(f.atoms.items + deepest.atom);
    offset = x - Vec3<float>(ball.center);
    length = offset_length(ball, deepest.depth);
  }
  __device__ __forceinline__ bool covers(const Cap &cap) const { return cap_covers(cap, offset, length); }
  // By a thread that looks at the k-th and every kThreads-th behind it.
  template <int kThreads>
  __device__ __forceinline__ bool are_covering(int32_t k) const {
    bool covered = range.count == kBuriedAtom;
    for (; k < range.count && !covered; k += kThreads) covered = covers(load(caps + k));
    return covered;
  }
};

}  // namespace gpu
}  // namespace quickses
