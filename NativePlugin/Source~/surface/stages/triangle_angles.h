// SPDX-License-Identifier: MIT
// How slim a triangle is.
#pragma once

#include "surface/geometry/vec3.h"

namespace quickses {

QSES_FN float least_cosine_of_angles(const Vec3<float> &a, const Vec3<float> &b, const Vec3<float> &c) {
  const Vec3<float> ab = b - a, bc = c - b, ca = a - c;
  const float u = length_squared(ab), v = length_squared(bc), w = length_squared(ca);
  const float at_a = -dot(ab, ca) * reciprocal_root(maximum(u * w, 1e-30f));
  const float at_b = -dot(ab, bc) * reciprocal_root(maximum(u * v, 1e-30f));
  const float at_c = -dot(bc, ca) * reciprocal_root(maximum(v * w, 1e-30f));
  return maximum(at_a, maximum(at_b, at_c));  // of the smallest angle
}

}  // namespace quickses
