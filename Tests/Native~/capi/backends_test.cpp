// SPDX-License-Identifier: MIT
// GPU and CPU must make the same surface: signs may differ at lattice points within rounding of it only, so meshes of
// one structure are the same up to a few vertices, and vertex by vertex where their connection is the same.
#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <iterator>
#include <random>

using namespace surface_fixture;

namespace {

class Backends : public ::testing::Test {
 protected:
  void SetUp() override {
    qses_backend_description d;
    qses_backend_description_init(&d);
    ASSERT_EQ(qses_backend_info(QSES_BACKEND_CUDA, &d), QSES_OK);
    if (!d.available) GTEST_SKIP() << "skipped: no CUDA device (" << d.reason << ")";
  }
};

void expect_same(const Atoms &atoms, const qses_settings &s, size_t other_vertices) {
  const Context cpu(2, 0, QSES_BACKEND_CPU), gpu(2, 0, QSES_BACKEND_CUDA);
  const Surface a = compute(cpu, atoms, s), b = compute(gpu, atoms, s);
  EXPECT_EQ(mesh_checks::manifold_fault(a.mesh), "");
  EXPECT_EQ(mesh_checks::manifold_fault(b.mesh), "");
  const size_t n = a.vertex_count(), m = b.vertex_count();
  ASSERT_GT(n, 0u);
  ASSERT_LE(n > m ? n - m : m - n, other_vertices);
  EXPECT_NEAR(a.report.volume, b.report.volume, 1e-4 * a.report.volume);
  EXPECT_NEAR(a.report.area, b.report.area, 1e-4 * a.report.area);
  if (a.mesh.indices != b.mesh.indices) {
    EXPECT_GT(other_vertices, 0u) << "the meshes are connected differently";
    return;
  }
  size_t far_apart = 0, other_owner = 0;
  for (size_t v = 0; v < n; ++v) {
    const auto p = a.mesh.position(v), q = b.mesh.position(v);
    far_apart += std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) > 1e-3 ? 1 : 0;
    other_owner += a.mesh.owners[v] != b.mesh.owners[v] ? 1 : 0;
  }
  // A vertex that starts as far from one probe as from another may go either way.
  EXPECT_LE(far_apart, n / 1000);
  EXPECT_LE(other_owner, n / 500);
}

TEST_F(Backends, MakeTheSameExactSurfaces) {
  const Atoms atoms = crambin();
  for (qses_surface kind : {QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW}) {
    SCOPED_TRACE(kind);
    expect_same(atoms, settings(0.5, 1.4, kind), 8);
  }
  for (double spacing : {0.3, 1.0, 2.0, 5.0}) {
    SCOPED_TRACE(spacing);
    expect_same(atoms, settings(spacing), 8);
  }
  qses_settings s = settings();
  for (uint32_t steps : {0u, 3u}) {
    s.relaxation_steps = steps;
    expect_same(atoms, s, 8);
  }
}

// So many that with CUDA several threads copy them.
TEST_F(Backends, MakeTheSameSurfaceOfManyAtoms) {
  const Atoms one = crambin();
  Atoms atoms;
  for (int copy = 0; copy < 64; ++copy)
    for (size_t i = 0; i < one.size(); ++i) {
      const auto p = one.center(i);
      atoms.add(p[0] + 50 * (copy % 4), p[1] + 50 * (copy / 4 % 4), p[2] + 50 * (copy / 16),
                static_cast<double>(one.radii[i]));
    }
  ASSERT_GE(atoms.size(), 16384u);
  expect_same(atoms, settings(1.0), 64 * 8);
}

// Two balls whose inflated spheres meet in a circle so short that it is one arc.
Atoms hardly_meeting(std::mt19937 &random) {
  std::uniform_real_distribution<double> radius(0.8, 3.5), of_circle(0.05, 0.3);
  const double r = radius(random), q = radius(random), c = of_circle(random), probe = 1.4;
  const auto to_circle = [&](double ball) { return std::sqrt((ball + probe) * (ball + probe) - c * c); };
  return turned(Atoms().add(0, 0, 0, r).add(0, 0, to_circle(r) + to_circle(q), q));
}

// Balls anywhere in a box, as crowded as no molecule's.
Atoms crowd(size_t count, double x, double y, double z, double least, double most, std::mt19937 &random) {
  std::uniform_real_distribution<double> unit(-0.5, 0.5), radius(least, most);
  Atoms atoms;
  for (size_t i = 0; i < count; ++i) {
    const double at_x = x * unit(random), at_y = y * unit(random), at_z = z * unit(random);
    atoms.add(at_x, at_y, at_z, radius(random));
  }
  return atoms;
}

// How many of so many sets of few atoms, atoms_of(set), have meshes that are connected differently. Of so few hardly
// any lattice point is within rounding of the surface: a sign that one of the back ends never looked at would show.
template <class AtomsOf>
int other_meshes(int sets, std::mt19937 &random, const AtomsOf &atoms_of) {
  const Context cpu(2, 0, QSES_BACKEND_CPU), gpu(2, 0, QSES_BACKEND_CUDA);
  const double spacings[] = {0.3, 0.5, 0.7, 1.0, 1.3, 2.0, 3.0};
  std::uniform_real_distribution<double> offset(-4, 4);
  int others = 0;
  for (int set = 0; set < sets; ++set) {
    const Atoms some = atoms_of(set);
    const double x = offset(random), y = offset(random), z = offset(random);
    const qses_settings s = settings(spacings[random() % std::size(spacings)]);
    const Atoms atoms = shifted(some, x, y, z);
    others += compute(cpu, atoms, s).mesh.indices != compute(gpu, atoms, s).mesh.indices ? 1 : 0;
  }
  return others;
}

TEST_F(Backends, MakeTheSameMeshesOfFewAtoms) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(0.8, 3.5);
  const int others = other_meshes(2000, random, [&](int set) {
    if (set % 4 == 0) return Atoms().add(0, 0, 0, radius(random));
    if (set % 4 == 1) return hardly_meeting(random);
    const size_t count = 2 + random() % 48;
    return cluster(count, static_cast<unsigned>(random()));
  });
  constexpr int kWithinRounding = 6;
  EXPECT_LE(others, kWithinRounding);
}

// More atoms matter to a leaf than a warp looks at together.
TEST_F(Backends, MakeTheSameMeshesOfCrowdedAtoms) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> extent(3, 8);
  const int others = other_meshes(400, random, [&](int) {
    const double x = extent(random), y = extent(random), z = extent(random);
    return crowd(100 + random() % 400, x, y, z, 0.3, 1.5, random);
  });
  constexpr int kWithinRounding = 4;
  EXPECT_LE(others, kWithinRounding);
}

// So many vertices that each is found by one lane, which remembers fewer arcs than there are near some of them.
TEST_F(Backends, MakeTheSameSurfaceOfManyCrowdedAtoms) {
  std::mt19937 random(3);
  const Atoms atoms = crowd(40000, 120, 120, 2, 0.4, 0.6, random);
  expect_same(atoms, settings(0.7, 0.6), 64);
}

// Between each four balls of a sheet the probe leaves a wall 0.3 Å thick, from both sides. There are so many that a
// warp looks at several leaves.
TEST_F(Backends, MakeTheSameSurfaceOfManyThinWalls) {
  constexpr double kRadius = 1.5, kProbe = 1.4, kHalfWall = 0.15, kHeight = kProbe + kHalfWall;
  const double step = std::sqrt(2 * ((kRadius + kProbe) * (kRadius + kProbe) - kHeight * kHeight));
  Atoms sheet;
  for (int i = 0; i < 100; ++i)
    for (int j = 0; j < 100; ++j) sheet.add(step * i, step * j, 0, kRadius);
  expect_same(turned(sheet), settings(0.5, kProbe), 16);
}

TEST_F(Backends, MakeTheSameGridSurfaces) {
  qses_settings s = settings();
  s.method = QSES_METHOD_GRID;
  for (float spacing : {0.7f, 0.5f, 0.35f}) {
    s.spacing = spacing;
    expect_same(crambin(), s, 64);
  }
}

// The same bytes, whatever the slices.
void expect_same_bytes_in_slices(const Atoms &atoms, qses_settings s) {
  const Context gpu(2, 0, QSES_BACKEND_CUDA);
  s.patch_types = 1;
  const Surface first = compute(gpu, atoms, s);
  EXPECT_EQ(mesh_checks::manifold_fault(first.mesh), "");
  for (uint32_t slice : {0u, 0u, 8u, 40u, 100u}) {
    SCOPED_TRACE(slice);
    s.slice_size = slice;
    const Surface again = compute(gpu, atoms, s);
    ASSERT_EQ(again.mesh.positions.size(), first.mesh.positions.size());
    EXPECT_EQ(std::memcmp(again.mesh.positions.data(), first.mesh.positions.data(),
                          first.mesh.positions.size() * sizeof(float)),
              0);
    EXPECT_EQ(
        std::memcmp(again.mesh.normals.data(), first.mesh.normals.data(), first.mesh.normals.size() * sizeof(float)),
        0);
    EXPECT_EQ(again.mesh.owners, first.mesh.owners);
    EXPECT_EQ(again.mesh.indices, first.mesh.indices);
    EXPECT_EQ(again.patches, first.patches);
    EXPECT_EQ(again.report.area, first.report.area);
  }
}

TEST_F(Backends, GpuGivesTheSameBytesAlways) { expect_same_bytes_in_slices(cluster(3000, 7), settings()); }

// Where coordinates are coarse beside the steps by which walls are looked for.
TEST_F(Backends, GpuGivesTheSameBytesFarAway) {
  const Atoms atoms = with(cluster(1000, 7), shifted(cluster(1000, 8), 60000, 31000, -47000));
  for (double spacing : {0.35, 0.5, 1.0}) {
    SCOPED_TRACE(spacing);
    expect_same_bytes_in_slices(atoms, settings(spacing));
  }
}

TEST_F(Backends, GpuStaysUsableAfterRefusedMemory) {
  const Atoms atoms = cluster(20000, 3);
  const Context tight(2, 4 << 20, QSES_BACKEND_CUDA);
  set_atoms(tight, atoms);
  const qses_settings s = settings(0.3);
  EXPECT_EQ(qses_compute(tight, &s, nullptr), QSES_OUT_OF_MEMORY);
  EXPECT_NE(std::string(qses_last_error()), "");
  const Atoms few = cluster(20, 3);
  EXPECT_EQ(mesh_checks::manifold_fault(compute(tight, few, settings(1.0)).mesh), "");
}

}  // namespace
