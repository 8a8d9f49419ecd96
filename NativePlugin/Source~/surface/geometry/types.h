// SPDX-License-Identifier: MIT
// What the stages hand to each other: plain structures in the memory of one back end. Lengths in Å, in the centred
// frame (see lattice.h), atoms in the order of the neighbour grid.
#pragma once

#include "parallel/span.h"
#include "surface/geometry/vec3.h"

namespace quickses {

// An atom with its inflated radius R = r + p, or the ball that encloses an arc. One 16-byte load.
struct alignas(16) Sphere {
  glm::vec3 center;
  float radius;
};

// The part of a unit sphere that a neighbour's ball covers: direction u with dot(u, axis) > cosine.
struct alignas(16) Cap {
  glm::vec3 axis;
  float cosine;
};

// An exposed arc of the circle where two inflated spheres meet: center + radius (cos(a) middle + sin(a) side), |a| up
// to the half angle. Its ends are exposed vertices: places where the probe touches a third atom, or joints of an arc
// that was split. A full circle has cos_half = -1, sin_half = 0.
struct alignas(16) Arc {
  glm::vec3 center;
  float radius;
  glm::vec3 middle;
  float cos_half;
  glm::vec3 side;
  float sin_half;
};

// The two atoms on whose circle an arc lies, the earlier one first.
struct ArcAtoms {
  uint32_t first, second;
};

// Loads of whole structures: on the GPU 16 bytes at a time, through the cache for what no running kernel writes.
QSES_FN Sphere load(const Sphere *p) {
#if defined(__CUDA_ARCH__)
  const float4 v = __ldg(reinterpret_cast<const float4 *>(p));
  return {glm::vec3(v.x, v.y, v.z), v.w};
#else
  return *p;
#endif
}
QSES_FN Cap load(const Cap *p) {
#if defined(__CUDA_ARCH__)
  const float4 v = __ldg(reinterpret_cast<const float4 *>(p));
  return {glm::vec3(v.x, v.y, v.z), v.w};
#else
  return *p;
#endif
}
QSES_FN Arc load(const Arc *p) {
#if defined(__CUDA_ARCH__)
  const float4 *q = reinterpret_cast<const float4 *>(p);
  const float4 a = __ldg(q), b = __ldg(q + 1), c = __ldg(q + 2);
  return {glm::vec3(a.x, a.y, a.z), a.w, glm::vec3(b.x, b.y, b.z), b.w, glm::vec3(c.x, c.y, c.z), c.w};
#else
  return *p;
#endif
}

// The run of an atom's caps in the array of caps, smallest cosine (largest cap) first. count is kBuriedAtom for an atom
// with no exposed part.
struct CapRange {
  uint32_t first;
  int32_t count;
};
constexpr int32_t kBuriedAtom = -1;

// What atoms look like that must not be found any more: contained in another one, or its duplicate.
constexpr float kFarAway = 1e8f;
QSES_FN Sphere removed_atom() { return {glm::vec3(kFarAway), 0.f}; }
QSES_FN bool is_removed(const Sphere &atom) { return atom.center.x >= 0.5f * kFarAway; }

// Tolerance of exposure tests, Å: within this of a ball's surface, rounding decides on which side a point is. One value
// on both back ends.
constexpr float kExposureTolerance = 2e-5f;

}  // namespace quickses
