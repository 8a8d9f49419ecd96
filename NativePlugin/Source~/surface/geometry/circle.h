// SPDX-License-Identifier: MIT
// The circle where two inflated spheres meet, what a third ball covers of it, and the arcs that remain.
#pragma once

#include "surface/geometry/cap.h"
#include "surface/geometry/exposed_intervals.h"

namespace quickses {

// Circle of sphere i (radius R) with its neighbour j: in units of R about i's centre, the plane dot(u, axis) = cosine.
struct Circle {
  Vec3<float> axis;    // from atom i towards atom j
  Vec3<float> e1, e2;  // right-handed in-plane axes: e1 x e2 = axis
  float cosine, sine;  // of the cap, without tolerance
  float inverse_sine;
  float same2;  // another circle of the sphere within this is the same one: squared, in units of this one's radius
};

// The frame is branch-free and continuous but at the south pole (Duff et al. 2017).
QSES_FN Circle make_circle(const glm::vec3 &axis, float cosine, float sphere_radius) {
  const float sign = axis.z < 0.f ? -1.f : 1.f;
  const float a = -1.f / (sign + axis.z), b = axis.x * axis.y * a;
  Circle c;
  c.axis = Vec3<float>(axis);
  c.e1 = {1.f + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
  c.e2 = {b, sign + axis.y * axis.y * a, -axis.y};
  c.cosine = cosine;
  c.sine = square_root(maximum(1e-12f, 1.f - cosine * cosine));
  c.inverse_sine = 1.f / c.sine;
  const float same = maximum(kExposureTolerance / sphere_radius, 2e-6f) * c.inverse_sine;
  c.same2 = same * same;
  return c;
}

// On the circle, with in-plane unit coordinates (x, y), the ball behind cap (axis, cosine) covers a x + b y > c.
template <class T>
struct HalfPlane {
  T a, b, c;
};
template <class T>
QSES_FN HalfPlane<T> cut_circle(const Circle &circle, const Vec3<T> &axis, T cosine) {
  const T along = dot(axis, Vec3<T>(T(circle.axis.x), T(circle.axis.y), T(circle.axis.z)));
  return {dot(axis, Vec3<T>(T(circle.e1.x), T(circle.e1.y), T(circle.e1.z))),
          dot(axis, Vec3<T>(T(circle.e2.x), T(circle.e2.y), T(circle.e2.z))),
          (cosine - T(circle.cosine) * along) * T(circle.inverse_sine)};
}

// Do the ball's surface and the circle run along each other within rounding? For the SES such a ball covers nothing: of
// several balls through one circle each could hide it behind the others, and nothing would be left. For the surface of
// balls: cut_exactly() (close_cut.h).
template <class T>
QSES_FN auto same_circle(const Circle &circle, const HalfPlane<T> &h) -> decltype(h.a <= h.b) {
  return h.a * h.a + h.b * h.b + h.c * h.c <= T(circle.same2);
}
// Does the ball's surface come so near to touching the circle, or to running along it, that it depends on rounding what
// it covers? That is so of every circle that is the same.
constexpr float kUnclearTimes = 128.f, kUnclearLeast = 2e-5f;  // more than what is the same; however large the circle
template <class T>
QSES_FN auto is_unclear(const Circle &circle, const HalfPlane<T> &h) -> decltype(h.a <= h.b) {
  return absolute(h.a * h.a + h.b * h.b - h.c * h.c) <=
         T(circle.same2 * (kUnclearTimes * kUnclearTimes) + kUnclearLeast);
}
// The whole circle is covered, or nothing of it, where the line a x + b y = c misses it.
template <class T>
QSES_FN auto misses_circle(const HalfPlane<T> &h) -> decltype(h.a <= h.b) {
  return h.a * h.a + h.b * h.b <= h.c * h.c;
}
template <class T>
QSES_FN auto covers_circle(const HalfPlane<T> &h) -> decltype(h.a <= h.b) {
  return misses_circle(h) & (h.c <= T(0.f));
}

// What a ball covers of a circle: nothing, a stretch from begin to end, as pseudo-angles, or all; or rounding decides.
enum class CutKind { kNone, kPart, kAll, kUnclear };
struct CircleCut {
  CutKind kind;
  float begin, end;
};

// The stretch of the circle that the half-plane covers, as pseudo-angles, for lines that meet the circle. begin == end
// means that it is too short (c > 0) or what remains is too short (c < 0) to be told from a point.
template <class T>
QSES_FN void covered_stretch(const HalfPlane<T> &h, T *begin, T *end) {
  const T inverse = reciprocal_root(h.a * h.a + h.b * h.b);
  const T x = h.a * inverse, y = h.b * inverse, cosine = h.c * inverse;
  const T sine = square_root(maximum(T(0.f), T(1.f) - cosine * cosine));
  *begin = pseudo_angle(x * cosine + y * sine, y * cosine - x * sine);
  *end = pseudo_angle(x * cosine - y * sine, y * cosine + x * sine);
}

// The arc over an exposed interval, and into how many equal pieces it must be split (a power of two).
struct ExposedArc {
  float middle_x, middle_y;    // in-plane direction of the middle of the whole arc
  float cos_piece, sin_piece;  // half angle of one piece
  float radius;
  int halvings;
};

// most: radius of the enclosing ball of a piece. exactly: for measures.
QSES_FN ExposedArc exposed_arc(const Interval *interval, float radius, float most, bool exactly) {
  ExposedArc arc{1.f, 0.f, -1.f, 0.f, radius, 0};
  if (interval) {
    const glm::vec2 a = pseudo_direction(interval->begin), b = pseudo_direction(interval->end);
    const glm::vec2 chord = b - a;
    float x, y;
    if (chord.x * chord.x + chord.y * chord.y >
        0.5f) {  // perpendicular to the chord: well conditioned but for short arcs
      x = chord.y;
      y = -chord.x;
    } else {
      // Of a very short arc, or nearly a full circle: the directions alone would not tell which.
      const float sign = pseudo_way(interval->begin, interval->end) > 2.f ? -1.f : 1.f;
      x = sign * (a.x + b.x);
      y = sign * (a.y + b.y);
    }
    const float k = reciprocal_root(x * x + y * y);
    arc.middle_x = x * k;
    arc.middle_y = y * k;
    arc.cos_piece = a.x * arc.middle_x + a.y * arc.middle_y;
    arc.sin_piece = fabsf(arc.middle_x * b.y - arc.middle_y * b.x);
  }
  while (radius * (arc.cos_piece <= 0.f ? 1.f : arc.sin_piece) > most && arc.halvings < 16) {
    const float c = arc.cos_piece, s = arc.sin_piece;
    arc.cos_piece = square_root(maximum(0.f, 0.5f * (1.f + c)));
    // Of a short piece 1 - c has hardly a digit left, and the sum of pieces would not be the arc.
    arc.sin_piece = c > 0.f ? quotient(s, arc.cos_piece + arc.cos_piece) : square_root(maximum(0.f, 0.5f * (1.f - c)));
    // Nor has 1 + c of nearly a full circle.
    if (exactly && c < -0.99f) arc.cos_piece = quotient(s, arc.sin_piece + arc.sin_piece);
    ++arc.halvings;
  }
  return arc;
}

// Writes the pieces of an exposed arc of the circle of sphere i. out has room for 1 << halvings arcs.
QSES_FN void write_arc_pieces(const Circle &circle, const Sphere &sphere, const ExposedArc &arc, Arc *out) {
  const int pieces = 1 << arc.halvings;
  const float c = arc.cos_piece, s = arc.sin_piece;
  // Turn the middle back to that of the first piece: by (pieces - 1) half angles.
  float x = arc.middle_x, y = arc.middle_y;
  for (int k = 1; k < pieces; ++k) {
    const float t = x * c + y * s;
    y = y * c - x * s;
    x = t;
  }
  const float c2 = c * c - s * s, s2 = 2.f * c * s;
  const Vec3<float> center = Vec3<float>(sphere.center) + circle.axis * (sphere.radius * circle.cosine);
  for (int k = 0; k < pieces; ++k) {
    out[k].center = to_glm(center);
    out[k].radius = arc.radius;
    out[k].middle = to_glm(circle.e1 * x + circle.e2 * y);
    out[k].cos_half = c;
    out[k].side = to_glm(circle.e2 * x - circle.e1 * y);
    out[k].sin_half = s;
    const float t = x * c2 - y * s2;
    y = y * c2 + x * s2;
    x = t;
  }
}

}  // namespace quickses
