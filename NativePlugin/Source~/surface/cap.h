// SPDX-License-Identifier: MIT
// Caps: what a neighbour's ball covers of an inflated sphere, and when one cap makes another superfluous.
#pragma once

#include "surface/types.h"

namespace quickses {

// Cosine of the cap that the ball (offset, other_radius) covers on a sphere of the given radius about the origin:
// >= 1 where they do not meet, <= -1 where the ball swallows the sphere. inverse_distance = 1 / |offset|.
template <class T>
QSES_FN T cap_cosine(T radius, T other_radius, T distance2, T inverse_distance) {
  return quotient(((radius - other_radius) * (radius + other_radius) + distance2) * inverse_distance, radius + radius);
}

// Nearly tangent spheres share no circle worth the name.
constexpr float kTangentCosine = 0.9999999f;

// Is the point in direction d (any length) covered? The cosine carries the exposure tolerance already.
template <class T>
QSES_FN auto cap_covers(const Cap &cap, const Vec3<T> &d, T length) -> decltype(length > length) {
  return dot(d, Vec3<T>(cap.axis)) > T(cap.cosine) * length;
}

// Does the larger cap k contain cap j? Their angle plus j's is at most k's: cos(angle) >= cos(theta_k - theta_j), with
// a margin so that rounding never drops both of two equal caps.
template <class T>
QSES_FN auto cap_contains(T cosine_k, T sine_k, T cosine_j, T sine_j, T cosine_between)
    -> decltype(cosine_k < cosine_j) {
  return (cosine_between >= cosine_k * cosine_j + sine_k * sine_j + T(1e-6f)) & (cosine_k < cosine_j);
}

QSES_FN float cap_sine(float cosine) { return square_root(maximum(0.f, 1.f - cosine * cosine)); }

// What is stored for exposure tests: the cap shrunk by the tolerance.
QSES_FN float stored_cap_cosine(float cosine, float radius) { return cosine + kExposureTolerance / radius; }

// Does the ball (center, radius) swallow atom i so that i owns no surface? order tells which of two equal ones stays.
QSES_FN bool swallows(const Sphere &j, uint32_t order_j, const Sphere &i, uint32_t order_i) {
  if (j.radius < i.radius || (j.radius == i.radius && order_j >= order_i)) return false;
  const float reach = j.radius - i.radius + 1e-5f;
  return length_squared(Vec3<float>(j.center) - Vec3<float>(i.center)) <= reach * reach;
}

}  // namespace quickses
