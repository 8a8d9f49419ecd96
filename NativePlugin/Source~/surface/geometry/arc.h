// SPDX-License-Identifier: MIT
// Distance from a point to an exposed arc, ends included, and the nearest point itself.
#pragma once

#include "surface/geometry/types.h"

namespace quickses {

// A point t away from the centre of an arc: its coordinates in the plane of the circle, and |t|².
template <class T>
struct PlaceAtArc {
  T along_middle, along_side, length2;
};

// Squared distance from a point to the arc. The point of the full circle in the direction of t's in-plane part is
// nearest if it lies on the arc, else the end on t's side is. On the axis of the circle every point is at the same
// distance and the formula still gives it.
// AnyArc: one arc for all the points, or one for each.
template <class AnyArc, class T>
QSES_FN T arc_distance2(const AnyArc &arc, const PlaceAtArc<T> &t) {
  const T in_plane = square_root(t.along_middle * t.along_middle + t.along_side * t.along_side);
  const T reach = select(t.along_middle >= T(arc.cos_half) * in_plane, in_plane,
                         T(arc.cos_half) * t.along_middle + T(arc.sin_half) * absolute(t.along_side));
  return t.length2 + T(arc.radius * arc.radius) - T(2.f * arc.radius) * reach;
}
template <class AnyArc, class T>
QSES_FN T arc_distance2(const AnyArc &arc, const Vec3<T> &x) {
  const Vec3<T> t = x - Vec3<T>(arc.center);
  return arc_distance2(arc, PlaceAtArc<T>{dot(t, Vec3<T>(arc.middle)), dot(t, Vec3<T>(arc.side)), length_squared(t)});
}

struct ArcPoint {
  Vec3<float> position;
  bool at_end;  // an exposed vertex: the point is off the arc by more than rounding, so this is no joint of a split arc
};

QSES_FN ArcPoint nearest_on_arc(const Arc &arc, const Vec3<float> &x) {
  const Vec3<float> t = x - Vec3<float>(arc.center), m(arc.middle), s(arc.side);
  const float along_middle = dot(t, m), along_side = dot(t, s);
  const float in_plane = square_root(along_middle * along_middle + along_side * along_side);
  float cosine, sine;
  const bool beyond = !(along_middle >= arc.cos_half * in_plane);
  // By how much, as sine and cosine of the angle past the end, times in_plane. Near a joint either of its arcs may come
  // out as the nearest: distances are the same within rounding for about its square root in angle.
  const float past = arc.cos_half * absolute(along_side) - arc.sin_half * along_middle;
  const float near = arc.cos_half * along_middle + arc.sin_half * absolute(along_side);
  const bool at_end = beyond && !(past <= 1e-3f * in_plane + 1e-6f * arc.radius && near >= 0.f);
  if (beyond) {
    cosine = arc.cos_half;
    sine = along_side < 0.f ? -arc.sin_half : arc.sin_half;
  } else if (in_plane > 1e-6f * arc.radius) {
    cosine = quotient(along_middle, in_plane);
    sine = quotient(along_side, in_plane);
  } else {  // on the axis: any direction is as near, so a fixed one
    cosine = 1.f;
    sine = 0.f;
  }
  return {Vec3<float>(arc.center) + m * (arc.radius * cosine) + s * (arc.radius * sine), at_end};
}

// Ball around an arc: the circle's for more than half a turn, the one over the chord otherwise.
QSES_FN Sphere arc_bound(const Arc &arc) {
  if (arc.cos_half <= 0.f) return {arc.center, arc.radius};
  return {arc.center + arc.middle * (arc.radius * arc.cos_half), arc.radius * arc.sin_half};
}

}  // namespace quickses
