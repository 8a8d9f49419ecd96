// SPDX-License-Identifier: MIT
// What a third ball covers of a circle where single precision can't tell, since its surface nearly touches the circle
// or nearly runs along it: from the three spheres, in double.
#pragma once

#include "surface/geometry/circle.h"

namespace quickses {

QSES_FN Vec3<double> to_double(const glm::vec3 &v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

// The plane in which a neighbour's sphere meets a sphere, in units of its radius about its centre.
struct ExactPlane {
  Vec3<double> axis;  // towards the neighbour
  double cosine;
};
QSES_FN ExactPlane exact_plane(const Sphere &sphere, const Sphere &neighbor) {
  const Vec3<double> apart = to_double(neighbor.center) - to_double(sphere.center);
  const double r = static_cast<double>(sphere.radius), q = static_cast<double>(neighbor.radius);
  const double distance2 = length_squared(apart), distance = sqrt(distance2);
  return {apart * (1.0 / distance), ((r - q) * (r + q) + distance2) / (2.0 * r * distance)};
}

// Do the two neighbours' balls cover the sphere between them, and meet each other in the circle that they leave of it?
// Then all three spheres pass through one circle.
constexpr double kOnePlane = 1e-10;  // no plane is farther from another that is the same; rounding is a millionth of it
QSES_FN bool share_sphere(const ExactPlane &a, const ExactPlane &b) {
  const double sine2 = 1.0 + a.cosine * b.cosine, gap = a.cosine + b.cosine;
  return length_squared(a.axis + b.axis) * sine2 + gap * gap <= kOnePlane * kOnePlane;
}

// What ball k covers of the circle of spheres i and j, whose frame is that of sphere i. Every circle of the three
// spheres is cut at the same two points, whichever of them asks. Of three spheres through one circle, it is that of the
// outer two, and the one between them has none: as if balls were larger the farther they are from the middle, by next
// to nothing.
QSES_FN CircleCut cut_exactly(const Circle &circle, const Sphere &i, const Sphere &j, const Sphere &k) {
  const ExactPlane own = exact_plane(i, j), other = exact_plane(i, k);
  const double ij = length_squared(to_double(j.center) - to_double(i.center));
  const double ik = length_squared(to_double(k.center) - to_double(i.center));
  const double jk = length_squared(to_double(k.center) - to_double(j.center));
  if (ij > ik && ij > jk) {
    if (share_sphere(exact_plane(k, i), exact_plane(k, j))) return {CutKind::kNone, 0.f, 0.f};
  } else if (jk > ik ? share_sphere(own, other) : share_sphere(exact_plane(j, i), exact_plane(j, k))) {
    return {CutKind::kAll, 0.f, 0.f};
  }

  // As cut_circle(), covers_circle() and covered_stretch(). The stored frame is only good to single precision, so it
  // gives the direction alone.
  const double along = dot(other.axis, own.axis), sine2 = 1.0 - own.cosine * own.cosine;
  const Vec3<double> across = other.axis - own.axis * along;
  const double reach2 = length_squared(across) * (sine2 > 0.0 ? sine2 : 0.0), c = other.cosine - own.cosine * along;
  const double left2 = reach2 - c * c;
  if (left2 <= 0.0) return {c <= 0.0 ? CutKind::kAll : CutKind::kNone, 0.f, 0.f};
  const double a = dot(across, to_double(to_glm(circle.e1))), b = dot(across, to_double(to_glm(circle.e2)));
  const double left = sqrt(left2);
  // Not of unit length: pseudo-angles do not ask for it.
  const auto angle_of = [&](double x, double y) {
    const double scale = 1.0 / (fabs(x) + fabs(y));
    return pseudo_angle(static_cast<float>(x * scale), static_cast<float>(y * scale));
  };
  const float begin = angle_of(a * c + b * left, b * c - a * left), end = angle_of(a * c - b * left, b * c + a * left);
  if (begin == end) return {c < 0.0 ? CutKind::kAll : CutKind::kNone, 0.f, 0.f};
  return {CutKind::kPart, begin, end};
}

}  // namespace quickses
