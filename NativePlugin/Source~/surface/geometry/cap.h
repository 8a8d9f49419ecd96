// SPDX-License-Identifier: MIT
// Caps: what a neighbour's ball covers of an inflated sphere, and when one cap makes another superfluous.
#pragma once

#include "surface/geometry/types.h"

namespace quickses {

// A circle with a smaller radius than this, in units of the larger sphere's, can't be told from a point. Squared.
constexpr float kPointCircle2 = 2e-7f;

// What two spheres have in common is decided by the functions below. They give both atoms of a pair the same answer, to
// the last bit: if one left the other out and that one did not, the circle between them would belong to neither, and
// an atom without a circle counts as buried. distance2: squared, of the centres.
template <class T>
QSES_FN auto share_circle(T a, T b, T distance2) -> decltype(a < b) {
  const T sum = a + b, difference = a - b, larger = maximum(a, b);
  return T(4.f * kPointCircle2) * distance2 * larger * larger <
         (sum * sum - distance2) * (distance2 - difference * difference);
}
// Is the smaller one's centre on the larger one's side of the plane of their circle?
template <class T>
QSES_FN auto meet_from_within(T a, T b, T distance2) -> decltype(a < b) {
  return distance2 < absolute((a - b) * (a + b));
}
// Do the balls overlap by more than rounding?
template <class T>
QSES_FN auto overlap(T a, T b, T distance2) -> decltype(a < b) {
  return share_circle(a, b, distance2) | meet_from_within(a, b, distance2);
}

// Cosine of the cap that a ball that overlaps covers on a sphere of the given radius: <= -1 where it contains the
// sphere. inverse_distance: one over that of the centres.
constexpr float kLargestCosine = 0.9999999f;
template <class T>
QSES_FN T cap_cosine(T radius, T other_radius, T distance2, T inverse_distance) {
  return minimum(
      T(kLargestCosine),
      quotient(((radius - other_radius) * (radius + other_radius) + distance2) * inverse_distance, radius + radius));
}

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
  return (cosine_between >= T(1e-6f) + sine_k * sine_j + cosine_k * cosine_j) & (cosine_k < cosine_j);
}

QSES_FN float cap_sine(float cosine) { return square_root(maximum(0.f, 1.f - cosine * cosine)); }

// What is stored for exposure tests: the cap grown by the tolerance. So only what is exposed beyond doubt counts as
// exposed; on the border of a cap the arcs there decide, and where rounding left no arc, no single point is open.
QSES_FN float stored_cap_cosine(float cosine, float radius) { return cosine - kExposureTolerance / radius; }

// Does ball j contain ball i so that i owns no surface? order tells which of two equal ones stays.
// i may stand out by so much: of two balls that are nearer to each other float32 can't tell in which one a point is
// deeper, and it might be covered in that one.
QSES_FN float containment_tolerance(float larger_radius) { return maximum(1e-5f, 4e-6f * larger_radius); }  // Å
QSES_FN bool contains(const Sphere &j, uint32_t order_j, const Sphere &i, uint32_t order_i) {
  if (j.radius < i.radius || (j.radius == i.radius && order_j >= order_i)) return false;
  const float distance2 = length_squared(Vec3<float>(j.center) - Vec3<float>(i.center));
  const float reach = j.radius - i.radius + containment_tolerance(j.radius);
  return distance2 <= reach * reach ||
         (meet_from_within(j.radius, i.radius, distance2) && !share_circle(j.radius, i.radius, distance2));
}
// How far away the centre of a ball of at most max_radius can be that contains a ball of the given radius.
QSES_FN float containing_reach(float radius, float max_radius) {
  const float stands_out = minimum(radius, kPointCircle2 * max_radius * quotient(max_radius, maximum(radius, 1e-12f)));
  return max_radius - radius + 2.f * (stands_out + containment_tolerance(max_radius));
}

}  // namespace quickses
