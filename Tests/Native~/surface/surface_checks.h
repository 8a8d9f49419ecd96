// SPDX-License-Identifier: MIT
// What must hold for every exact surface: connection, normals, owners, and the distance from the true surface.
#pragma once

#include "surface/exact_reference.h"

#include <gtest/gtest.h>

namespace surface_checks {

using namespace surface_fixture;
using exact_reference::Boundary;
using exact_reference::Point;
using exact_reference::point;

struct Limits {
  double p99 = 1e-3, worst = 0.05;  // Å from the exact surface
  double owner_tie = 1e-4;          // Å: atoms this much further away may own a vertex, too
  size_t stride = 1;                // every so many vertices are measured
};

inline double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(q * static_cast<double>(values.size() - 1))];
}

// Distance from the exact surface.
inline double surface_error(const Boundary &boundary, const qses_settings &s, const Point &x) {
  if (s.surface == QSES_SURFACE_SES && s.probe_radius >= 0.05f)
    return std::abs(boundary.nearest(x).distance - static_cast<double>(s.probe_radius));
  return std::abs(boundary.depth(x));
}

inline double boundary_probe(const qses_settings &s) {
  const bool vdw = s.surface == QSES_SURFACE_VDW || (s.surface == QSES_SURFACE_SES && s.probe_radius < 0.05f);
  return vdw ? 0.0 : static_cast<double>(s.probe_radius);
}

inline void check_connection(const mesh_checks::Mesh &mesh) {
  EXPECT_EQ(mesh_checks::manifold_fault(mesh), "");
  EXPECT_TRUE(mesh.vertex_count() == 0 || mesh_checks::worst_normal_length(mesh) < 1e-5);
}

inline void check_owners(const Atoms &atoms, const mesh_checks::Mesh &mesh, const Limits &limits) {
  size_t wrong = 0;
  for (size_t v = 0; v < mesh.vertex_count(); v += limits.stride) {
    const Point x = point(mesh.position(v));
    ASSERT_LT(mesh.owners[v], atoms.size()) << "vertex " << v;
    double nearest = exact_reference::kInfinity;
    for (size_t i = 0; i < atoms.size(); ++i)
      nearest =
          std::min(nearest, exact_reference::length(x - point(atoms.center(i))) - static_cast<double>(atoms.radii[i]));
    const size_t owner = mesh.owners[v];
    const double own =
        exact_reference::length(x - point(atoms.center(owner))) - static_cast<double>(atoms.radii[owner]);
    if (own > nearest + limits.owner_tie && ++wrong < 4)
      ADD_FAILURE() << "vertex " << v << " belongs to atom " << owner << ", " << own - nearest << " Å too far away";
  }
  EXPECT_EQ(wrong, 0u);
}

// A normal leads from a vertex of the SES to where the probe's centre is: nowhere inside an inflated atom, and on one.
// On the other two surfaces it is that of the owner.
inline void check_normals(const Atoms &atoms, const qses_settings &s, const Surface &surface, const Boundary &boundary,
                          const Limits &limits) {
  std::vector<double> errors;
  const bool ses = s.surface == QSES_SURFACE_SES && boundary_probe(s) > 0;
  for (size_t v = 0; v < surface.vertex_count(); v += limits.stride) {
    const Point x = point(surface.mesh.position(v)), n = point(surface.normal(v));
    if (ses) {
      errors.push_back(std::abs(boundary.depth(x + static_cast<double>(s.probe_radius) * n)));
    } else {
      const Point d = x - point(atoms.center(surface.mesh.owners[v]));
      errors.push_back(exact_reference::length((1 / exact_reference::length(d)) * d - n));
    }
  }
  EXPECT_LE(quantile(errors, 0.99), limits.p99) << "along the normals";
  EXPECT_LE(quantile(errors, 1.0), limits.worst) << "along the normals";
}

inline void check_distances(const qses_settings &s, const mesh_checks::Mesh &mesh, const Boundary &boundary,
                            const Limits &limits) {
  std::vector<double> errors;
  size_t worst = 0;
  for (size_t v = 0; v < mesh.vertex_count(); v += limits.stride) {
    errors.push_back(surface_error(boundary, s, point(mesh.position(v))));
    if (errors.back() > errors[worst]) worst = errors.size() - 1;
  }
  EXPECT_LE(quantile(errors, 0.99), limits.p99);
  EXPECT_LE(quantile(errors, 1.0), limits.worst) << "at vertex " << worst * limits.stride;
}

// Measures of the report against those of the triangles it delivered.
inline void check_report(const Surface &surface) {
  const double area = mesh_checks::area(surface.mesh), volume = mesh_checks::signed_volume(surface.mesh);
  EXPECT_NEAR(surface.report.area, area, 1e-4 * area + 1e-9);
  EXPECT_NEAR(surface.report.volume, volume, 1e-4 * std::abs(volume) + 2e-5 * area + 1e-9);
}

// All of the above. Returns the surface for what only one test asks.
inline Surface checked_surface(const Atoms &atoms, const qses_settings &s, const Limits &limits = {}) {
  Surface surface = compute(atoms, s);
  EXPECT_GT(surface.vertex_count(), 3u);
  check_connection(surface.mesh);
  check_owners(atoms, surface.mesh, limits);
  const Boundary boundary(atoms, boundary_probe(s));
  check_distances(s, surface.mesh, boundary, limits);
  check_normals(atoms, s, surface, boundary, limits);
  check_report(surface);
  return surface;
}

}  // namespace surface_checks
