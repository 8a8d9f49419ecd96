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
};
QSES_FN CornerNormal side_normal(const MeshView &mesh, uint32_t vertex, const double *facing, double length) {
  const float *const first = mesh.normal(vertex);
  CornerNormal c = {{static_cast<double>(first[0]), static_cast<double>(first[1]), static_cast<double>(first[2])}, 0.0};
  c.along = dot_product(c.n, facing);
  if (mesh.second_normals) {
    const float *const second = mesh.second_normal(vertex);
    CornerNormal other = {
        {static_cast<double>(second[0]), static_cast<double>(second[1]), static_cast<double>(second[2])}, 0.0};
    other.along = dot_product(other.n, facing);
    if (other.along > c.along) c = other;
  }
  if (c.along < rounded_product(kLeastCosineOfSide, length)) c = {{0.0, 0.0, 0.0}, length};
  return c;
}

// The surface over a triangle is taken for the quadratic patch that has the corners' normals: over the edge from a to b
// it rises to z_ab = (g_a - g_b) (x_b - x_a) / 8 in the middle, g being its slope at a corner, -n / (n N) in the plane
// of the triangle with normal N. Over the triangle, z = 4 sum(z_ab l_a l_b) in barycentric coordinates, of which the
// mean is the third of the sum, and the slope is known at the middles of the edges.
QSES_FN TriangleSums measure_triangle(const MeshView &mesh, const uint32_t *t, const double *origin, bool bent) {
  constexpr double kThird = 1.0 / 3.0, kSixth = 1.0 / 6.0;
  const DoubleTriangle d = load_triangle(mesh, t, origin);
  const double length2 = dot_product(d.n, d.n), length = sqrt(length2), sign = mesh.reversed ? -1.0 : 1.0;
  TriangleSums sums;
  sums.area = sums.flat_area = 0.5 * length;
  sums.volume = sums.flat_volume = rounded_product(sign * kSixth, dot_product(d.a, d.n));
  if (!bent || !(length > 0.0)) return sums;
  const double facing[3] = {sign * d.n[0], sign * d.n[1], sign * d.n[2]};
  const CornerNormal m0 = side_normal(mesh, t[0], facing, length), m1 = side_normal(mesh, t[1], facing, length),
                     m2 = side_normal(mesh, t[2], facing, length);
  // One division for the three of them.
  const double a01 = rounded_product(m0.along, m1.along), inverse = 0.125 * length / rounded_product(a01, m2.along);
  const double s0 = rounded_product(inverse, rounded_product(m1.along, m2.along));
  const double s1 = rounded_product(inverse, rounded_product(m0.along, m2.along));
  const double s2 = rounded_product(inverse, a01);
  const double w[3] = {d.v[0] - d.u[0], d.v[1] - d.u[1], d.v[2] - d.u[2]};
  const double z01 = rounded_product(s1, dot_product(m1.n, d.u)) - rounded_product(s0, dot_product(m0.n, d.u));
  const double z12 = rounded_product(s2, dot_product(m2.n, w)) - rounded_product(s1, dot_product(m1.n, w));
  const double z20 = rounded_product(s2, dot_product(m2.n, d.v)) - rounded_product(s0, dot_product(m0.n, d.v));
  const double sum = z01 + z12 + z20;
  const auto area_at = [&](double z, const double *edge) {  // twice, in the middle of the edge
    const double rise = 2.0 * sum - 4.0 * z;
    return sqrt(length2 + rounded_product(rounded_product(rise, rise), dot_product(edge, edge)));
  };
  sums.area = rounded_product(kSixth, area_at(z01, d.u) + area_at(z12, w) + area_at(z20, d.v));
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
