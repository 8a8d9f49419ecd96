// SPDX-License-Identifier: MIT
// SAS and VDW surfaces with creases where balls come closer to each other than lattice points are, and the area of
// their triangles as what they stand for: pieces of spheres between circles.
#include "surface/exact_reference.h"
#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace surface_fixture;
using exact_reference::cross;
using exact_reference::dot;
using exact_reference::length;
using exact_reference::Point;
using exact_reference::point;

qses_settings creased(double spacing, qses_surface surface) {
  qses_settings s = settings(spacing, 1.4, surface);
  s.creases = 1;
  return s;
}
double inflation(qses_surface surface) { return surface == QSES_SURFACE_VDW ? 0.0 : 1.4; }

class BallChannels : public testing::TestWithParam<qses_surface> {};
INSTANTIATE_TEST_SUITE_P(Surfaces, BallChannels, testing::Values(QSES_SURFACE_SAS, QSES_SURFACE_VDW));

// ---- pieces of spheres -----------------------------------------------------------------------------------------

struct Ball {
  Point center;
  double radius;
};

double solid_angle(const Point &a, const Point &b, const Point &c) {
  const double la = length(a), lb = length(b), lc = length(c);
  return 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

// On a sphere between the great circle through two points and the circle with another sphere: positive where the latter
// covers it.
double sliver(const Ball &ball, const Ball &other, const Point &u, const Point &v) {
  const Point between = other.center - ball.center;
  const double distance = length(between), r = ball.radius;
  const Point axis = (1 / distance) * between;
  const double along = (distance * distance + (r - other.radius) * (r + other.radius)) / (2 * distance);
  const Point from_u = u - ball.center - along * axis, from_v = v - ball.center - along * axis;
  const double angle = std::atan2(length(cross(from_u, from_v)), dot(from_u, from_v));
  return r * r * (angle * (1 - along / r) - std::abs(solid_angle(axis, u - ball.center, v - ball.center)));
}

// Area of a mesh whose triangles stand for the pieces of spheres that their corners have in common, bounded by circles
// where edges have two of them; triangles without such a sphere are flat.
double area_of_patches(const Atoms &atoms, double inflation, const mesh_checks::Mesh &mesh) {
  constexpr double kOn = 3e-4;
  std::vector<Ball> balls;
  for (size_t i = 0; i < atoms.size(); ++i)
    balls.push_back({point(atoms.center(i)), static_cast<double>(atoms.radii[i]) + inflation});
  std::vector<std::vector<size_t>> on(mesh.vertex_count());
  for (size_t v = 0; v < mesh.vertex_count(); ++v)
    for (size_t i = 0; i < balls.size(); ++i)
      if (std::abs(length(point(mesh.position(v)) - balls[i].center) - balls[i].radius) < kOn) on[v].push_back(i);
  const auto has = [&](uint32_t v, size_t i) { return std::find(on[v].begin(), on[v].end(), i) != on[v].end(); };
  double sum = 0;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    const uint32_t *const c = mesh.indices.data() + 3 * t;
    const Point x[3] = {point(mesh.position(c[0])), point(mesh.position(c[1])), point(mesh.position(c[2]))};
    const Point normal = cross(x[1] - x[0], x[2] - x[0]);
    size_t sheet = balls.size();
    for (size_t i : on[c[0]])
      if (has(c[1], i) && has(c[2], i) && dot(normal, x[0] + x[1] + x[2] - 3.0 * balls[i].center) > 0) sheet = i;
    if (sheet == balls.size()) {
      sum += length(normal) / 2;
      continue;
    }
    const Ball &ball = balls[sheet];
    double area = ball.radius * ball.radius * solid_angle(x[0] - ball.center, x[1] - ball.center, x[2] - ball.center);
    for (int k = 0; k < 3; ++k)
      for (size_t i : on[c[k]])
        if (i != sheet && has(c[(k + 1) % 3], i)) {
          area -= sliver(ball, balls[i], x[k], x[(k + 1) % 3]);
          break;
        }
    sum += area;
  }
  return sum;
}

// ---- tests -----------------------------------------------------------------------------------------------------

// However narrow the gap is, and wherever the lattice: what does not touch is in two pieces.
TEST_P(BallChannels, BallsThatDoNotTouchAreTwoPieces) {
  const double p = inflation(GetParam()), a = 1.7, b = 1.5;
  for (double gap : {0.02, 0.05, 0.1, 0.3})
    for (int shift = 0; shift < 8; ++shift) {
      SCOPED_TRACE(testing::Message() << "gap " << gap << " shift " << shift);
      Atoms atoms;
      atoms.add(0, 0, 0, a).add(a + b + 2 * p + gap, 0, 0, b);
      if (shift % 2) atoms = turned(atoms);
      // A far atom moves the lattice, which is laid around the middle of all.
      atoms.add(20 + 0.13 * shift, 0.07 * shift, -0.11 * shift, 1.2);
      const Surface surface = compute(atoms, creased(0.5, GetParam()));
      EXPECT_EQ(mesh_checks::manifold_fault(surface.mesh), "");
      EXPECT_EQ(mesh_checks::piece_count(surface.mesh), 3u);
      EXPECT_NEAR(area_of_patches(atoms, p, surface.mesh) / surface.report.area, 1, 2e-3);
    }
}

// The triangles know nothing of caps and arcs, by which areas are measured.
TEST_P(BallChannels, PatchesOfTwoBallsHaveTheirArea) {
  Atoms atoms;
  atoms.add(0, 0, 0, 1.7).add(1.9, 0.4, 0.3, 1.5);
  const Surface surface = compute(atoms, creased(0.5, GetParam()));
  const double area = area_of_patches(atoms, inflation(GetParam()), surface.mesh);
  EXPECT_NEAR(area / surface.report.area, 1, 1e-4);
}

TEST_P(BallChannels, PatchesOfAProteinHaveItsArea) {
  const Atoms atoms = crambin();
  const Surface surface = compute(atoms, creased(0.5, GetParam()));
  EXPECT_EQ(mesh_checks::manifold_fault(surface.mesh), "");
  const double area = area_of_patches(atoms, inflation(GetParam()), surface.mesh);
  EXPECT_NEAR(area / surface.report.area, 1, GetParam() == QSES_SURFACE_SAS ? 1e-3 : 2e-3);
}

}  // namespace
