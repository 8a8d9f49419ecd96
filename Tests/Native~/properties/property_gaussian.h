// SPDX-License-Identifier: MIT
// Gaussian surfaces against the density, summed up anew over all atoms in double precision.
#pragma once

#include "properties/property_checks.h"

namespace properties {

inline double width_scale(const Case &c) { return static_cast<double>(c.settings.gaussian_radius_scale); }

// Å, of a vertex: by how much its place is rounded.
inline double rounding_of_density(const Case &c) {
  const double reach = kReachOfGaussians * width_scale(c) * largest_radius(c.atoms);
  return std::ldexp(largest_coordinate(c.atoms) + half_extent(c.atoms) + reach, -23);
}

// The density within some distance of a place lies between the two, and so does its gradient.
struct DensityAround {
  double least = 0, most = 0;
  Point gradient{0, 0, 0};   // at the place
  double gradient_play = 0;  // by how much that differs at most
};

class GaussianReference {
 public:
  explicit GaussianReference(const Case &c) : case_(c), level_(static_cast<double>(c.settings.gaussian_isovalue)) {}

  DensityAround around(const Point &x, double distance) const {
    DensityAround sum;
    for (size_t i = 0; i < case_.atoms.size(); ++i) {
      const double s = width_scale(case_) * static_cast<double>(case_.atoms.radii[i]), end = kReachOfGaussians * s;
      const Point way = x - point(case_.atoms.center(i));
      const double d = length(way), near_by = std::max(0.0, d - distance), far_off = d + distance;
      if (near_by >= end) continue;
      const auto part = [s](double r) { return std::exp(-r * r / (2 * s * s)); };
      sum.most += part(near_by);
      if (far_off < end) sum.least += part(far_off);
      if (d < end) sum.gradient = sum.gradient - (part(d) / (s * s)) * way;
      // What the steepness can change by per length, and, where the atom's density ends, all of it.
      const double turn = std::max(1.0, far_off * far_off / (s * s));
      sum.gradient_play += distance * part(near_by) * turn / (s * s);
      if (far_off >= end) sum.gradient_play += part(near_by) * end / (s * s);
      sum.gradient_play += kRounded * part(d) * d / (s * s);
    }
    return sum;
  }

  // 1 if the density is above the level everywhere within some distance, -1 if it is below; 0: neither.
  int side(const DensityAround &a) const {
    return a.least * (1 - kRounded) > level_ ? 1 : a.most * (1 + kRounded) < level_ ? -1 : 0;
  }
  int side(const Point &x, double distance) const { return side(around(x, distance)); }

 private:
  static constexpr double kRounded = 1e-5;  // of sums in single precision
  const Case &case_;
  double level_;
};

// A vertex is at the level within a thousandth of the spacing, its normal along the gradient there.
inline void check_density(const Case &c, const Result &r, const GaussianReference &density, Verdict &v) {
  const mesh_checks::Mesh &mesh = r.surface.mesh;
  const double distance = 1e-3 * static_cast<double>(c.settings.spacing) + rounding_of_density(c);
  const size_t stride = 1 + mesh.vertex_count() * c.atoms.size() / 400000;
  for (size_t k = 0; k < mesh.vertex_count(); k += stride) {
    const Point x = point(mesh.position(k)), n = point(r.surface.normal(k));
    const DensityAround a = density.around(x, distance);
    if (density.side(a) != 0)
      return blame(v, Fault::kOffSurface, "vertex %zu (%.9g %.9g %.9g): the density within %.3g Å is %.9g to %.9g", k,
                   x.x, x.y, x.z, distance, a.least, a.most);
    // The gradient of some place there has no part across the normal, and points inside.
    const double along = -exact_reference::dot(n, a.gradient), across = length(a.gradient + along * n);
    const double play = a.gradient_play + 1e-5 * length(a.gradient);
    if (across > play || along < -play)
      return blame(v, Fault::kNormals, "the normal of vertex %zu is not along the gradient: %.4g along, %.4g across", k,
                   along, across);
  }
}

// Where all lattice points around a place are on one side, the mesh has the place on that side.
inline void check_sides_of_density(const Case &c, const Result &r, const GaussianReference &density, Verdict &v) {
  Random random(c.seed + 77);
  const Windings windings(r.surface.mesh);
  const double margin = 2 * static_cast<double>(c.settings.spacing) + rounding_of_density(c);
  for (size_t k = 0; k < 24 && c.atoms.size() > 0; ++k) {
    const size_t i = static_cast<size_t>(random.below(c.atoms.size()));
    const double s = width_scale(c) * static_cast<double>(c.atoms.radii[i]);
    const Point x = point(c.atoms.center(i)) + (3 * s * random.unit()) * random.direction();
    if (const int side = density.side(x, margin)) expect_inside(windings, x, side > 0, v);
  }
}

inline void check_gaussian(const Case &c, const Result &r, Verdict &v) {
  const GaussianReference density(c);
  check_density(c, r, density, v);
  if (v.good()) check_edges(c, r, v);
  if (v.good()) check_sides_of_density(c, r, density, v);
}

}  // namespace properties
