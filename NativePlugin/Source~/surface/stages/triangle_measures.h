// SPDX-License-Identifier: MIT
// Area and enclosed volume of one triangle: as it is, and bent along the exact normals of its corners. Triangles cut
// off what bulges beyond them, a per cent of the area at half an Å; the normals tell how much that is. F is a double,
// or, on the CPU, a pack of them.
#pragma once

#include "parallel/executor.h"
#include "parallel/scalar.h"
#include "surface/geometry/vec3.h"
#include "surface/mesh/mesh_view.h"

namespace quickses {

// GPU and CPU, one triangle or four at a time, find the same numbers to the last bit.
template <class F>
QSES_FN F dot_product(const Vec3<F> &a, const Vec3<F> &b) {
  return rounded_product(a.x, b.x) + rounded_product(a.y, b.y) + rounded_product(a.z, b.z);
}
template <class F>
QSES_FN Vec3<F> cross_product(const Vec3<F> &a, const Vec3<F> &b) {
  return {rounded_product(a.y, b.z) - rounded_product(a.z, b.y), rounded_product(a.z, b.x) - rounded_product(a.x, b.z),
          rounded_product(a.x, b.y) - rounded_product(a.y, b.x)};
}

// A triangle's corners, counter-clockwise seen from outside.
struct Corners {
  uint32_t v[3];
};
QSES_FN Corners outward_corners(const MeshView &mesh, const uint32_t *t) {
  if (mesh.reversed) return {{t[0], t[2], t[1]}};
  return {{t[0], t[1], t[2]}};
}

// What is known at the corners of one triangle.
struct CornersOfOne {
  const MeshView &mesh;
  Corners corners;
  QSES_FN Vec3<double> position(int k) const { return load(mesh.position(corners.v[k])); }
  QSES_FN Vec3<double> normal(int k) const { return load(mesh.normal(corners.v[k])); }
  QSES_FN Vec3<double> second_normal(int k) const { return load(mesh.second_normal(corners.v[k])); }

 private:
  QSES_FN static Vec3<double> load(const float *p) {
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
  }
};

// Area, and signed volume of the tetrahedron over the triangle with its apex at the origin. Positive outward, whatever
// the winding.
template <class F>
struct SumsOfTriangles {
  F area = F(0.0), volume = F(0.0);            // bent, or as it is
  F flat_area = F(0.0), flat_volume = F(0.0);  // as it is
  QSES_FN SumsOfTriangles &operator+=(const SumsOfTriangles &other) {
    area = area + other.area;
    volume = volume + other.volume;
    flat_area = flat_area + other.flat_area;
    flat_volume = flat_volume + other.flat_volume;
    return *this;
  }
};
using TriangleSums = SumsOfTriangles<double>;

// A normal that is turned away from the triangle's by more than this does not belong to its side of a crest.
constexpr double kLeastCosineOfSide = 0.5;

// A corner's exact normal, of two sheets that of the triangle's side, and how much of it lies along the triangle's own
// one, which has the given length. No normal if none is on this side.
template <class F>
struct CornerNormal {
  using Mask = decltype(F() < F());
  Vec3<F> n;
  F along;
  Mask on_crest;  // there are two
  Vec3<F> other;  // that of the other sheet
};
template <class F, class TriangleCorners>
QSES_FN CornerNormal<F> side_normal(const TriangleCorners &corners, bool has_second, int k, const Vec3<F> &facing,
                                    F length) {
  using Mask = typename CornerNormal<F>::Mask;
  CornerNormal<F> c;
  c.n = corners.normal(k);
  c.along = dot_product(c.n, facing);
  c.on_crest = F(0.0) < F(0.0);
  c.other = c.n;
  if (has_second) {
    const Vec3<F> second = corners.second_normal(k);
    c.on_crest = (c.n.x != second.x) | (c.n.y != second.y) | (c.n.z != second.z);
    if (any(c.on_crest)) {
      const F along = dot_product(second, facing);
      const Mask nearer = along > c.along;
      c.other = select(nearer, c.n, second);
      c.n = select(nearer, second, c.n);
      c.along = select(nearer, along, c.along);
    }
  }
  const Mask on_side = rounded_product(F(kLeastCosineOfSide), length) <= c.along;
  c.n = select(on_side, c.n, Vec3<F>(F(0.0), F(0.0), F(0.0)));
  c.along = select(on_side, c.along, length);
  c.on_crest = c.on_crest & on_side;
  return c;
}

// Where the middle of an edge is moved: up from the triangle, and out of it. Times the length of the triangle's normal,
// and out times that of the edge besides.
template <class F>
struct EdgeRise {
  F up, out;
};

// Of an edge along a crest: what both sheets ask for, each along the mean of its normals at the two ends. False if the
// two are nearly one. facing: the triangle's normal; across: that of the edge in its plane, outward.
template <class F>
QSES_FN typename CornerNormal<F>::Mask rise_on_crest(const CornerNormal<F> &a, const CornerNormal<F> &b,
                                                     const Vec3<F> &edge, const Vec3<F> &facing, const Vec3<F> &across,
                                                     EdgeRise<F> *rise) {
  const Vec3<F> m = a.n + b.n, dm = b.n - a.n, k = a.other + b.other, dk = b.other - a.other;
  const F mm = dot_product(m, m), kk = dot_product(k, k), mk = dot_product(m, k);
  const F det = rounded_product(mm, kk) - rounded_product(mk, mk);
  // m and k are twice the means: the rise r has r m = dm edge / 4 and r k = dk edge / 4.
  const F zm = dot_product(dm, edge), zk = dot_product(dk, edge), scale = F(0.25) / det;
  const F cm = rounded_product(scale, rounded_product(zm, kk) - rounded_product(zk, mk));
  const F ck = rounded_product(scale, rounded_product(zk, mm) - rounded_product(zm, mk));
  rise->up = rounded_product(cm, dot_product(m, facing)) + rounded_product(ck, dot_product(k, facing));
  rise->out = rounded_product(cm, dot_product(m, across)) + rounded_product(ck, dot_product(k, across));
  return det > F(0.02) * rounded_product(mm, kk);
}

// The surface over a triangle is taken for the quadratic patch that has the corners' normals: over the edge from a to b
// it rises to z_ab = (g_a - g_b) (x_b - x_a) / 8 in the middle, g being its slope at a corner, -n / (n N) in the plane
// of the triangle with normal N. Over the triangle, z = 4 sum(z_ab l_a l_b) in barycentric coordinates, of which the
// mean is the third of the sum, and the slope is known at the middles of the edges. The edges rise along the normals at
// their ends, so that patches join: the patch is wider than the triangle by the two thirds of what the middles of its
// edges are moved out.
//   origin      a place near the mesh, from which volumes are counted, so that they keep their digits far from zero
//   has_second  whether the corners have second normals
template <class F, class TriangleCorners>
QSES_FN SumsOfTriangles<F> measure_corners(const TriangleCorners &corners, const Vec3<F> &origin, bool bent,
                                           bool has_second) {
  using Mask = typename CornerNormal<F>::Mask;
  const F third(1.0 / 3.0), sixth(1.0 / 6.0), two(2.0), four(4.0);
  const Vec3<F> at = corners.position(0) - origin, u = corners.position(1) - origin - at,
                v = corners.position(2) - origin - at, normal = cross_product(u, v);
  const F length2 = dot_product(normal, normal), length = square_root(length2);
  SumsOfTriangles<F> sums;
  sums.area = sums.flat_area = F(0.5) * length;
  sums.volume = sums.flat_volume = rounded_product(sixth, dot_product(at, normal));
  const Mask has_area = length > F(0.0);
  if (!bent || !any(has_area)) return sums;
  const CornerNormal<F> m0 = side_normal(corners, has_second, 0, normal, length),
                        m1 = side_normal(corners, has_second, 1, normal, length),
                        m2 = side_normal(corners, has_second, 2, normal, length);
  // One division for the three of them.
  const F a01 = rounded_product(m0.along, m1.along), inverse = F(0.125) * length / rounded_product(a01, m2.along);
  const F s0 = rounded_product(inverse, rounded_product(m1.along, m2.along));
  const F s1 = rounded_product(inverse, rounded_product(m0.along, m2.along));
  const F s2 = rounded_product(inverse, a01);
  // An eighth of the slopes down along the two edges.
  const F p0 = rounded_product(s0, dot_product(m0.n, u)), q0 = rounded_product(s0, dot_product(m0.n, v));
  const F p1 = rounded_product(s1, dot_product(m1.n, u)), q1 = rounded_product(s1, dot_product(m1.n, v));
  const F p2 = rounded_product(s2, dot_product(m2.n, u)), q2 = rounded_product(s2, dot_product(m2.n, v));
  const F uu = dot_product(u, u), uv = dot_product(u, v), vv = dot_product(v, v);
  F z01 = p1 - p0, z12 = (q2 - p2) - (q1 - p1), z20 = q2 - q0;
  // From the slopes down across the edges at both ends of each, by a x (b x c) = b (a c) - c (a b).
  F out01 = four * rounded_product(z01, rounded_product(p0 + p1, uv) - rounded_product(q0 + q1, uu));
  F out12 = four * rounded_product(z12, rounded_product(p1 + p2, vv - uv) + rounded_product(q1 + q2, uu - uv));
  F out20 = four * rounded_product(z20, rounded_product(q0 + q2, uv) - rounded_product(p0 + p2, vv));
  // Along a crest.
  const auto look_for_crest = [&](const CornerNormal<F> &a, const CornerNormal<F> &b, const Vec3<F> &edge, F *z,
                                  F *out) {
    const Mask on_crest = a.on_crest & b.on_crest;
    if (!any(on_crest)) return;
    EdgeRise<F> rise;
    const Mask rises = on_crest & rise_on_crest(a, b, edge, normal, cross_product(edge, normal), &rise);
    *z = select(rises, rise.up / length, *z);
    *out = select(rises, rise.out, *out);
  };
  look_for_crest(m0, m1, u, &z01, &out01);
  look_for_crest(m1, m2, v - u, &z12, &out12);
  look_for_crest(m2, m0, v * F(-1.0), &z20, &out20);
  const F sum = z01 + z12 + z20;
  const auto area_at = [&](F z, F edge2) {  // twice, in the middle of the edge
    const F rise = two * sum - four * z;
    return square_root(length2 + rounded_product(rounded_product(rise, rise), edge2));
  };
  const F area = rounded_product(sixth, area_at(z01, uu) + area_at(z12, uu + vv - two * uv) + area_at(z20, vv)) +
                 rounded_product(two * third, out01 + out12 + out20) / length;
  // Else the corners are so near to each other that rounding has turned the triangle.
  const Mask is_right = has_area & (area > rounded_product(third, sums.flat_area)) & (area < F(3.0) * sums.flat_area);
  sums.area = select(is_right, area, sums.flat_area);
  sums.volume =
      select(is_right, sums.volume + rounded_product(rounded_product(sums.flat_area, sum), third), sums.flat_volume);
  return sums;
}

QSES_FN TriangleSums measure_triangle(const MeshView &mesh, size_t t, const Vec3<double> &origin, bool bent) {
  return measure_corners(CornersOfOne{mesh, outward_corners(mesh, mesh.triangle(t))}, origin, bent,
                         mesh.second_normals != nullptr);
}
// How much area of a triangle faces where the normals of its corners point to: negative if it is turned away.
QSES_FN double facing_area(const MeshView &mesh, const uint32_t *triangle) {
  const CornersOfOne corners{mesh, outward_corners(mesh, triangle)};
  const Vec3<double> at = corners.position(0),
                     normal = cross_product(corners.position(1) - at, corners.position(2) - at);
  return rounded_product(1.0 / 6.0, dot_product(normal, corners.normal(0) + corners.normal(1) + corners.normal(2)));
}
struct MeasureTriangle {
  MeshView mesh;
  Vec3<double> origin;
  bool bent;
  QSES_FN TriangleSums operator()(size_t t) const { return measure_triangle(mesh, t, origin, bent); }
};

// The same of so many triangles that follow each other, on the CPU: with the best instructions it has.
constexpr size_t kTriangleRun = 64;  // a caller's usual number
void measure_triangles(const MeasureTriangle &measure, size_t first, size_t count, TriangleSums *sums);

}  // namespace quickses
