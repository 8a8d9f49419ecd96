// SPDX-License-Identifier: MIT
// Gaussian surfaces against their definition, summed up anew in double precision.
#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace surface_fixture;

namespace {

qses_settings gaussian(double spacing = 0.5, double radius_scale = 1, double isovalue = 0.5) {
  qses_settings s = settings(spacing, 1.4, QSES_SURFACE_GAUSSIAN);
  s.gaussian_radius_scale = static_cast<float>(radius_scale);
  s.gaussian_isovalue = static_cast<float>(isovalue);
  return s;
}

struct Density {
  double value = 0;
  std::array<double, 3> gradient{};
};

Density density_at(const Atoms &atoms, const qses_settings &s, const std::array<double, 3> &x) {
  Density sum;
  for (size_t i = 0; i < atoms.size(); ++i) {
    const auto c = atoms.center(i);
    const double width = static_cast<double>(atoms.radii[i]) * static_cast<double>(s.gaussian_radius_scale);
    double d2 = 0;
    for (size_t d = 0; d < 3; ++d) d2 += (x[d] - c[d]) * (x[d] - c[d]);
    if (d2 >= 16 * width * width) continue;
    const double e = std::exp(-d2 / (2 * width * width));
    sum.value += e;
    for (size_t d = 0; d < 3; ++d) sum.gradient[d] -= e * (x[d] - c[d]) / (width * width);
  }
  return sum;
}

std::array<double, 3> vertex(const Surface &s, size_t v) {
  return {s.mesh.positions[3 * v], s.mesh.positions[3 * v + 1], s.mesh.positions[3 * v + 2]};
}

// All that a mesh promises: closed, at the isovalue, normals against the gradient, nearest owners.
void expect_right(const Atoms &atoms, const qses_settings &s) {
  const Surface surface = compute(atoms, s);
  ASSERT_GT(surface.vertex_count(), 0u);
  EXPECT_EQ(mesh_checks::manifold_fault(surface.mesh), "");
  const double spacing = static_cast<double>(s.spacing);
  size_t far_off = 0, turned = 0;
  for (size_t v = 0; v < surface.vertex_count(); ++v) {
    const auto x = vertex(surface, v);
    const Density density = density_at(atoms, s, x);
    double steepness = 0, along = 0;
    for (size_t d = 0; d < 3; ++d) steepness += density.gradient[d] * density.gradient[d];
    steepness = std::sqrt(steepness);
    for (size_t d = 0; d < 3; ++d) along -= density.gradient[d] * surface.normal(v)[d] / steepness;
    // Where an atom ends the density falls by 3e-4, which may be just at the isovalue.
    const double error = std::fabs(density.value - static_cast<double>(s.gaussian_isovalue)) - 4e-4;
    if (error / steepness > 1e-4 * spacing) ++far_off;
    if (along < 0.999) ++turned;
    double nearest = 1e9;
    for (size_t i = 0; i < atoms.size(); ++i) {
      const auto c = atoms.center(i);
      const double distance = std::hypot(x[0] - c[0], x[1] - c[1], x[2] - c[2]) - static_cast<double>(atoms.radii[i]);
      nearest = std::min(nearest, distance);
    }
    const uint32_t owner = surface.mesh.owners[v];
    ASSERT_LT(owner, atoms.size());
    const auto c = atoms.center(owner);
    ASSERT_NEAR(std::hypot(x[0] - c[0], x[1] - c[1], x[2] - c[2]) - static_cast<double>(atoms.radii[owner]), nearest,
                1e-4);
  }
  EXPECT_LE(far_off, surface.vertex_count() / 1000);
  EXPECT_LE(turned, surface.vertex_count() / 200);
}

}  // namespace

TEST(Gaussian, OfOneAtomIsASphere) {
  for (const double scale : {0.5, 1.0, 2.0})
    for (const double isovalue : {0.1, 0.5, 0.9}) {
      const Surface ball = compute(Atoms().add(1, -2, 3, 1.7), gaussian(0.5, scale, isovalue));
      const double radius = 1.7 * scale * std::sqrt(-2 * std::log(isovalue));
      ASSERT_GT(ball.vertex_count(), 0u) << scale << " " << isovalue;
      for (size_t v = 0; v < ball.vertex_count(); ++v) {
        const auto x = vertex(ball, v);
        ASSERT_NEAR(std::hypot(x[0] - 1, x[1] + 2, x[2] - 3), radius, 2e-5);
      }
      if (radius <= 1) continue;  // too few triangles
      EXPECT_NEAR(ball.report.area, 4 * 3.14159265 * radius * radius, 0.02 * ball.report.area);
    }
}

TEST(Gaussian, IsItsDefinition) {
  for (unsigned seed = 0; seed < 4; ++seed) expect_right(cluster(60, seed), gaussian(0.6 + 0.2 * seed));
  expect_right(cluster(80, 9), gaussian(0.7, 0.6, 0.3));
  expect_right(cluster(80, 9), gaussian(1, 1.5, 2));
  expect_right(crambin(), gaussian(1));
}

// Where no atom is near, many can be inside together: the middle of a cage.
TEST(Gaussian, FillsTheMiddleOfACage) {
  Atoms cage;
  for (int k = 0; k < 60; ++k) {
    const double z = 1 - (2 * k + 1.0) / 60, across = std::sqrt(1 - z * z), angle = 2.399963229728653 * k;
    cage.add(3.55 * across * std::cos(angle), 3.55 * across * std::sin(angle), 3.55 * z, 1.7);
  }
  const Surface surface = compute(cage, gaussian());
  EXPECT_GT(density_at(cage, gaussian(), {0, 0, 0}).value, 0.5);
  EXPECT_EQ(mesh_checks::piece_count(surface.mesh), 1u) << "no wall around the middle";
}

// Two atoms at one place count twice, and one within another one counts, too.
TEST(Gaussian, CountsEveryAtom) {
  Atoms atoms;
  atoms.add(0, 0, 0, 1.5).add(0, 0, 0, 1.5).add(0.1, 0, 0, 0.4);
  expect_right(atoms, gaussian());
}

TEST(Gaussian, IsTheSameHoweverTheWorkIsDone) {
  const Atoms atoms = cluster(300, 5);
  const Surface reference = compute(atoms, gaussian());
  EXPECT_EQ(compute(atoms, gaussian(), 1).mesh.positions, reference.mesh.positions) << "one thread";
  qses_settings sliced = gaussian();
  sliced.slice_size = 16;
  EXPECT_EQ(compute(atoms, sliced).mesh.positions, reference.mesh.positions) << "in slices";
  const Context poor(2, uint64_t(8) << 20);
  EXPECT_EQ(compute(poor, atoms, gaussian()).mesh.indices, reference.mesh.indices) << "with a budget";
  const Context context;
  EXPECT_EQ(finest_of_job(context, atoms, gaussian()).mesh.normals, reference.mesh.normals) << "of a job";
}

TEST(Gaussian, SurvivesWhatIsOdd) {
  Atoms stray = cluster(40, 3);
  stray.add(30000, -20000, 100, 1.5);
  EXPECT_EQ(mesh_checks::piece_count(compute(stray, gaussian(1)).mesh), 2u);
  EXPECT_EQ(compute(Atoms(), gaussian()).vertex_count(), 0u);
  EXPECT_EQ(compute(Atoms().add(0, 0, 0, 1.5), gaussian(0.5, 1, 3)).vertex_count(), 0u) << "nowhere so dense";
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-6, 6), radius(0.05, 3);
  for (int k = 0; k < 30; ++k) {
    Atoms atoms;
    const int count = 1 + static_cast<int>(random() % 30);
    for (int i = 0; i < count; ++i) atoms.add(place(random), place(random), place(random), radius(random));
    const Surface surface = compute(atoms, gaussian(1.1, 0.3 + 0.1 * (k % 12), 0.05 + 0.2 * (k % 7)));
    if (surface.vertex_count() > 0) {
      EXPECT_EQ(mesh_checks::manifold_fault(surface.mesh), "") << k;
    }
    for (float n : surface.mesh.normals) ASSERT_TRUE(std::isfinite(n));
  }
}

TEST(Gaussian, RefusesWhatItHasNot) {
  const Context context;
  set_atoms(context, cluster(10, 1));
  const auto refuses = [&](const qses_settings &s, const char *word) {
    EXPECT_EQ(qses_compute(context, &s, nullptr), QSES_INVALID_ARGUMENT);
    EXPECT_NE(std::string(qses_last_error()).find(word), std::string::npos) << qses_last_error();
  };
  refuses(gaussian(0.5, 0), "gaussian_radius_scale");
  refuses(gaussian(0.5, 11), "gaussian_radius_scale");
  refuses(gaussian(0.5, 1, 0), "gaussian_isovalue");
  qses_settings s = gaussian();
  s.creases = 1;
  refuses(s, "GAUSSIAN");
  s = gaussian();
  s.method = QSES_METHOD_GRID;
  refuses(s, "GRID");
}
