// SPDX-License-Identifier: MIT
// What must hold for every exact surface: connection, normals, owners, and the distance from the true surface.
#pragma once

#include "surface/exact_reference.h"

#include <gtest/gtest.h>

#include <cstring>

namespace surface_checks {

using namespace surface_fixture;
using exact_reference::Boundary;
using exact_reference::Point;
using exact_reference::point;

inline void expect_same_bytes(const Surface &a, const Surface &b) {
  EXPECT_EQ(a.mesh.indices, b.mesh.indices);
  EXPECT_EQ(a.mesh.owners, b.mesh.owners);
  EXPECT_EQ(a.patches, b.patches);
  // Bytes, not values: NaN or -0 would hide differences.
  ASSERT_EQ(a.mesh.positions.size(), b.mesh.positions.size());
  EXPECT_EQ(std::memcmp(a.mesh.positions.data(), b.mesh.positions.data(), 4 * a.mesh.positions.size()), 0);
  ASSERT_EQ(a.mesh.normals.size(), b.mesh.normals.size());
  EXPECT_EQ(std::memcmp(a.mesh.normals.data(), b.mesh.normals.data(), 4 * a.mesh.normals.size()), 0);
  EXPECT_EQ(a.report.area, b.report.area);
  EXPECT_EQ(a.report.volume, b.report.volume);
}

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

// The triangles of each vertex.
inline std::vector<std::vector<uint32_t>> fans(const mesh_checks::Mesh &mesh) {
  std::vector<std::vector<uint32_t>> all(mesh.vertex_count());
  for (size_t k = 0; k < mesh.indices.size(); ++k) all[mesh.indices[k]].push_back(static_cast<uint32_t>(k / 3));
  return all;
}

inline Point face_normal(const mesh_checks::Mesh &mesh, size_t triangle) {
  const uint32_t *const c = mesh.indices.data() + 3 * triangle;
  const Point a = point(mesh.position(c[0]));
  return exact_reference::cross(point(mesh.position(c[1])) - a, point(mesh.position(c[2])) - a);
}

// Would the exact normal point against a triangle of the vertex, or is there another one, as exact, on the other side
// of what the vertex has? Then its own may be between the sides, or turned to the triangles.
inline bool may_be_turned(const mesh_checks::Mesh &mesh, const std::vector<uint32_t> &fan, const Point &exact,
                          const Point &normal, const Boundary *boundary, const Point &x, double probe) {
  for (uint32_t triangle : fan)
    if (exact_reference::dot(face_normal(mesh, triangle), exact) <= 0) return true;
  const Point other = 2 * exact_reference::dot(exact, normal) * normal - exact;
  return boundary && std::abs(boundary->depth(x + probe * other)) < 1e-3;
}

// A normal leads from a vertex of the SES to where the probe's centre is: nowhere inside an inflated atom, and on one.
// On the other two surfaces it is that of the owner.
inline void check_normals(const Atoms &atoms, const qses_settings &s, const Surface &surface, const Boundary &boundary,
                          const Limits &limits) {
  std::vector<double> errors;
  const bool ses = s.surface == QSES_SURFACE_SES && boundary_probe(s) > 0;
  const auto triangles = fans(surface.mesh);
  for (size_t v = 0; v < surface.vertex_count(); v += limits.stride) {
    const Point x = point(surface.mesh.position(v)), n = point(surface.normal(v));
    const Point d = ses ? boundary.nearest(x).position - x : x - point(atoms.center(surface.mesh.owners[v]));
    const Point exact = (1 / exact_reference::length(d)) * d;
    const double probe = static_cast<double>(s.probe_radius);
    const double error = ses ? std::abs(boundary.depth(x + probe * n)) : exact_reference::length(exact - n);
    if (error < limits.p99 || !may_be_turned(surface.mesh, triangles[v], exact, n, ses ? &boundary : nullptr, x, probe))
      errors.push_back(error);
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
  EXPECT_NEAR(surface.report.triangle_area, area, 1e-4 * area + 1e-9);
  EXPECT_NEAR(surface.report.triangle_volume, volume, 1e-4 * std::abs(volume) + 2e-5 * area + 1e-9);
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
