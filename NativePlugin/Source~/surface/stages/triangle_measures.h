// SPDX-License-Identifier: MIT
// Area and enclosed volume of one triangle: as it is, and bent along the exact normals of its corners. Triangles cut
// off what bulges beyond them, a per cent of the area at half an Å; the normals tell how much that is.
#pragma once

#include "parallel/executor.h"
#include "parallel/scalar.h"
#include "surface/mesh/mesh_view.h"

namespace quickses {

// GPU and CPU find the same numbers to the last bit.
QSES_FN double dot_product(const double *a, const double *b) {
  return rounded_product(a[0], b[0]) + rounded_product(a[1], b[1]) + rounded_product(a[2], b[2]);
}

struct DoubleTriangle {
  double a[3], u[3], v[3];  // a corner, and the edges from it to the other two
  double n[3];              // twice the area along the normal
};

// A triangle's corners, counter-clockwise seen from outside.
struct Corners {
  uint32_t v[3];
};
QSES_FN Corners outward_corners(const MeshView &mesh, const uint32_t *t) {
  if (mesh.reversed) return {{t[0], t[2], t[1]}};
  return {{t[0], t[1], t[2]}};
}

// Coordinates are taken from an origin near the mesh, so that the volume keeps its digits far away from zero.
QSES_FN DoubleTriangle load_triangle(const MeshView &mesh, const uint32_t *t, const double *origin) {
  DoubleTriangle d;
  for (int k = 0; k < 3; ++k) {
    d.a[k] = static_cast<double>(mesh.position(t[0])[k]) - origin[k];
    d.u[k] = static_cast<double>(mesh.position(t[1])[k]) - origin[k] - d.a[k];
    d.v[k] = static_cast<double>(mesh.position(t[2])[k]) - origin[k] - d.a[k];
  }
  for (int k = 0; k < 3; ++k) {
    const int p = (k + 1) % 3, q = (k + 2) % 3;
    d.n[k] = rounded_product(d.u[p], d.v[q]) - rounded_product(d.u[q], d.v[p]);
  }
  return d;
}

// Area, and signed volume of the tetrahedron over the triangle with its apex at the origin. Positive outward, whatever
// the winding.
struct TriangleSums {
  double area = 0, volume = 0;            // bent, or as it is
  double flat_area = 0, flat_volume = 0;  // as it is
  QSES_FN TriangleSums &operator+=(const TriangleSums &other) {
    area += other.area;
    volume += other.volume;
    flat_area += other.flat_area;
    flat_volume += other.flat_volume;
    return *this;
  }
};

// A normal that is turned away from the triangle's by more than this does not belong to its side of a crest.
constexpr double kLeastCosineOfSide = 0.5;

// A corner's exact normal, of two sheets that of the triangle's side, and how much of it lies along the triangle's own
// one, which has the given length. No normal if none is on this side.
struct CornerNormal {
  double n[3], along;
  const float *other;  // of the other sheet; nullptr: there is only one
};
QSES_FN CornerNormal side_normal(const MeshView &mesh, uint32_t vertex, const double *facing, double length) {
  const float *const first = mesh.normal(vertex);
  CornerNormal c = {
      {static_cast<double>(first[0]), static_cast<double>(first[1]), static_cast<double>(first[2])}, 0.0, nullptr};
  c.along = dot_product(c.n, facing);
  if (mesh.second_normals) {
    const float *const second = mesh.second_normal(vertex);
    if (first[0] != second[0] || first[1] != second[1] || first[2] != second[2]) {
      CornerNormal o = {
          {static_cast<double>(second[0]), static_cast<double>(second[1]), static_cast<double>(second[2])}, 0.0, first};
      o.along = dot_product(o.n, facing);
      c.other = second;
      if (o.along > c.along) c = o;
    }
  }
  if (c.along < rounded_product(kLeastCosineOfSide, length)) c = {{0.0, 0.0, 0.0}, length, nullptr};
  return c;
}

// Where the middle of an edge is moved: up from the triangle, and out of it. Times the length of the triangle's normal,
// and out times that of the edge besides.
struct EdgeRise {
  double up, out;
};

// Of an edge along a crest: what both sheets ask for, each along the mean of its normals at the two ends. False if the
// two are nearly one. facing: the triangle's normal; across: that of the edge in its plane, outward.
QSES_FN bool rise_on_crest(const CornerNormal &a, const CornerNormal &b, const double *edge, const double *facing,
                           const double *across, EdgeRise *rise) {
  double m[3], k[3], dm[3], dk[3];
  for (int d = 0; d < 3; ++d) {
    const double oa = static_cast<double>(a.other[d]), ob = static_cast<double>(b.other[d]);
    m[d] = a.n[d] + b.n[d];
    dm[d] = b.n[d] - a.n[d];
    k[d] = oa + ob;
    dk[d] = ob - oa;
  }
  const double mm = dot_product(m, m), kk = dot_product(k, k), mk = dot_product(m, k);
  const double det = rounded_product(mm, kk) - rounded_product(mk, mk);
  if (!(det > 0.02 * rounded_product(mm, kk))) return false;
  // m and k are twice the means: the rise r has r m = dm edge / 4 and r k = dk edge / 4.
  const double zm = dot_product(dm, edge), zk = dot_product(dk, edge), scale = 0.25 / det;
  const double cm = rounded_product(scale, rounded_product(zm, kk) - rounded_product(zk, mk));
  const double ck = rounded_product(scale, rounded_product(zk, mm) - rounded_product(zm, mk));
  rise->up = rounded_product(cm, dot_product(m, facing)) + rounded_product(ck, dot_product(k, facing));
  rise->out = rounded_product(cm, dot_product(m, across)) + rounded_product(ck, dot_product(k, across));
  return true;
}

// The surface over a triangle is taken for the quadratic patch that has the corners' normals: over the edge from a to b
// it rises to z_ab = (g_a - g_b) (x_b - x_a) / 8 in the middle, g being its slope at a corner, -n / (n N) in the plane
// of the triangle with normal N. Over the triangle, z = 4 sum(z_ab l_a l_b) in barycentric coordinates, of which the
// mean is the third of the sum, and the slope is known at the middles of the edges. The edges rise along the normals at
// their ends, so that patches join: the patch is wider than the triangle by the two thirds of what the middles of its
// edges are moved out.
QSES_FN TriangleSums measure_triangle(const MeshView &mesh, const uint32_t *triangle, const double *origin, bool bent) {
  constexpr double kThird = 1.0 / 3.0, kSixth = 1.0 / 6.0;
  const Corners corners = outward_corners(mesh, triangle);
  const uint32_t *const t = corners.v;
  const DoubleTriangle d = load_triangle(mesh, t, origin);
  const double length2 = dot_product(d.n, d.n), length = sqrt(length2);
  TriangleSums sums;
  sums.area = sums.flat_area = 0.5 * length;
  sums.volume = sums.flat_volume = rounded_product(kSixth, dot_product(d.a, d.n));
  if (!bent || !(length > 0.0)) return sums;
  const CornerNormal m0 = side_normal(mesh, t[0], d.n, length), m1 = side_normal(mesh, t[1], d.n, length),
                     m2 = side_normal(mesh, t[2], d.n, length);
  // One division for the three of them.
  const double a01 = rounded_product(m0.along, m1.along), inverse = 0.125 * length / rounded_product(a01, m2.along);
  const double s0 = rounded_product(inverse, rounded_product(m1.along, m2.along));
  const double s1 = rounded_product(inverse, rounded_product(m0.along, m2.along));
  const double s2 = rounded_product(inverse, a01);
  // An eighth of the slopes down along the two edges.
  const double p0 = rounded_product(s0, dot_product(m0.n, d.u)), q0 = rounded_product(s0, dot_product(m0.n, d.v));
  const double p1 = rounded_product(s1, dot_product(m1.n, d.u)), q1 = rounded_product(s1, dot_product(m1.n, d.v));
  const double p2 = rounded_product(s2, dot_product(m2.n, d.u)), q2 = rounded_product(s2, dot_product(m2.n, d.v));
  const double uu = dot_product(d.u, d.u), uv = dot_product(d.u, d.v), vv = dot_product(d.v, d.v);
  double z01 = p1 - p0, z12 = (q2 - p2) - (q1 - p1), z20 = q2 - q0;
  // From the slopes down across the edges at both ends of each, by a x (b x c) = b (a c) - c (a b).
  double out01 = 4.0 * rounded_product(z01, rounded_product(p0 + p1, uv) - rounded_product(q0 + q1, uu));
  double out12 = 4.0 * rounded_product(z12, rounded_product(p1 + p2, vv - uv) + rounded_product(q1 + q2, uu - uv));
  double out20 = 4.0 * rounded_product(z20, rounded_product(q0 + q2, uv) - rounded_product(p0 + p2, vv));
  // Along a crest. The edge is x u + y v.
  const auto look_for_crest = [&](const CornerNormal &a, const CornerNormal &b, double x, double y, double *z,
                                  double *out) {
    if (!a.other || !b.other) return;
    double e[3], across[3];
    for (int k = 0; k < 3; ++k) e[k] = rounded_product(x, d.u[k]) + rounded_product(y, d.v[k]);
    for (int k = 0; k < 3; ++k) {
      const int p = (k + 1) % 3, q = (k + 2) % 3;
      across[k] = rounded_product(e[p], d.n[q]) - rounded_product(e[q], d.n[p]);
    }
    EdgeRise rise;
    if (!rise_on_crest(a, b, e, d.n, across, &rise)) return;
    *z = rise.up / length;
    *out = rise.out;
  };
  look_for_crest(m0, m1, 1.0, 0.0, &z01, &out01);
  look_for_crest(m1, m2, -1.0, 1.0, &z12, &out12);
  look_for_crest(m2, m0, 0.0, -1.0, &z20, &out20);
  const double sum = z01 + z12 + z20;
  const auto area_at = [&](double z, double edge2) {  // twice, in the middle of the edge
    const double rise = 2.0 * sum - 4.0 * z;
    return sqrt(length2 + rounded_product(rounded_product(rise, rise), edge2));
  };
  sums.area = rounded_product(kSixth, area_at(z01, uu) + area_at(z12, uu + vv - 2.0 * uv) + area_at(z20, vv)) +
              rounded_product(2.0 * kThird, out01 + out12 + out20) / length;
  if (!(sums.area > rounded_product(kThird, sums.flat_area) && sums.area < 3.0 * sums.flat_area)) {
    sums.area = sums.flat_area;  // the corners are so near to each other that rounding has turned the triangle
    return sums;
  }
  sums.volume += rounded_product(rounded_product(sums.flat_area, sum), kThird);
  return sums;
}

struct MeasureTriangle {
  MeshView mesh;
  double origin[3];
  bool bent;
  QSES_HOST_DEVICE TriangleSums operator()(size_t t) const {
    return measure_triangle(mesh, mesh.triangle(t), origin, bent);
  }
};

}  // namespace quickses
