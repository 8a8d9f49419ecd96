// SPDX-License-Identifier: MIT
// Corners of triangles at creases have the normal of the sheet that their triangle is on: by the spheres themselves.
#include "surface/exact_reference.h"
#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using namespace surface_fixture;
using exact_reference::dot;
using exact_reference::length;
using exact_reference::Point;
using exact_reference::point;

struct Sheet {
  Point center;
  double radius;
  bool is_concave;  // normals lead to the centre

  bool has(const Point &x) const { return std::abs(length(x - center) - radius) < 3e-4; }
  Point normal(const Point &x) const { return ((is_concave ? -1 : 1) / radius) * (x - center); }
};

struct Corners {
  size_t on_crease = 0, of_another_side = 0;
};

// Of triangles that lie on one sheet: corners that others have too, and those whose normal is not that of the sheet.
Corners count_corners(const std::vector<Sheet> &sheets, const Surface &surface) {
  Corners counts;
  const mesh_checks::Mesh &mesh = surface.mesh;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    const uint32_t *const c = mesh.indices.data() + 3 * t;
    const Sheet *own = nullptr;
    int sharing = 0;
    for (const Sheet &sheet : sheets) {
      bool on_all = true;
      for (int k = 0; k < 3; ++k) on_all &= sheet.has(point(mesh.position(c[k])));
      if (on_all) own = &sheet, ++sharing;
    }
    if (sharing != 1) continue;
    for (int k = 0; k < 3; ++k) {
      const Point x = point(mesh.position(c[k]));
      int here = 0;
      for (const Sheet &sheet : sheets) here += sheet.has(x) ? 1 : 0;
      if (here < 2) continue;
      ++counts.on_crease;
      counts.of_another_side += dot(point(surface.normal(c[k])), own->normal(x)) < 0.999 ? 1 : 0;
    }
  }
  return counts;
}

qses_settings hard_creases(double spacing, double probe, qses_surface surface) {
  qses_settings s = settings(spacing, probe, surface);
  s.creases = s.hard_edges = 1;
  return s;
}

// Also where balls meet at so small an angle that a triangle faces the normals of both.
TEST(HardSides, OfTwoBallsAreTheirSpheres) {
  for (const qses_surface surface : {QSES_SURFACE_SAS, QSES_SURFACE_VDW})
    for (const double apart : {0.5, 0.9, 1.4, 2.2})
      for (const double spacing : {0.5, 0.3}) {
        SCOPED_TRACE(testing::Message() << "surface " << surface << ", " << apart << " apart, spacing " << spacing);
        const double p = surface == QSES_SURFACE_SAS ? 1.4 : 0, r = 1.7, q = 1.6;
        Atoms atoms;
        atoms.add(0, 0, 0, r).add(0.6 * apart, 0.64 * apart, 0.48 * apart, q);
        const std::vector<Sheet> sheets = {{point(atoms.center(0)), r + p, false},
                                           {point(atoms.center(1)), q + p, false}};
        const Corners corners = count_corners(sheets, compute(atoms, hard_creases(spacing, 1.4, surface)));
        EXPECT_GT(corners.on_crease, 50u);
        EXPECT_EQ(corners.of_another_side, 0u);
      }
}

// Three atoms that a probe touches from above and from below: its two spheres meet in a circle between them.
TEST(HardSides, OfTwoProbesAreTheirSpheres) {
  const double distance = 2.7, r = 1.6, probe = static_cast<double>(1.4f),
               height = std::sqrt((r + probe) * (r + probe) - distance * distance);
  Atoms atoms;
  for (int k = 0; k < 3; ++k) atoms.add(distance * std::cos(k * 2.0943951), distance * std::sin(k * 2.0943951), 0, r);
  const std::vector<Sheet> sheets = {{{0, 0, height}, probe, true}, {{0, 0, -height}, probe, true}};
  Corners all;
  for (const double spacing : {0.4, 0.3, 0.2}) {
    const Corners corners = count_corners(sheets, compute(atoms, hard_creases(spacing, 1.4, QSES_SURFACE_SES)));
    all.on_crease += corners.on_crease;
    all.of_another_side += corners.of_another_side;
  }
  EXPECT_GT(all.on_crease, 50u);
  EXPECT_EQ(all.of_another_side, 0u);
}

}  // namespace
