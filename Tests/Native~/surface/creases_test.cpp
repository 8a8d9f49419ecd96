// SPDX-License-Identifier: MIT
// Edges split at creases: where the new vertices are, against spheres in double precision, and what the mesh becomes.
#include "surface/exact_reference.h"
#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <set>

namespace {

using namespace surface_fixture;

qses_settings creased(qses_settings s) {
  s.creases = 1;
  return s;
}

double inflation(const qses_settings &s) {
  return s.surface == QSES_SURFACE_VDW ? 0.0 : static_cast<double>(s.probe_radius);
}

// How deep a point lies in the inflated ball of an atom.
double depth_in(const Atoms &atoms, size_t i, double inflation, const std::array<double, 3> &x) {
  const auto c = atoms.center(i);
  return static_cast<double>(atoms.radii[i]) + inflation -
         std::sqrt(std::pow(x[0] - c[0], 2) + std::pow(x[1] - c[1], 2) + std::pow(x[2] - c[2], 2));
}

constexpr double kOnSphere = 2e-4;

std::set<size_t> spheres_at(const Atoms &atoms, double inflation, const std::array<double, 3> &x) {
  std::set<size_t> on;
  for (size_t i = 0; i < atoms.size(); ++i)
    if (std::abs(depth_in(atoms, i, inflation, x)) < kOnSphere) on.insert(i);
  return on;
}

struct Counts {
  size_t on_two = 0, on_three = 0;  // vertices
  size_t edges = 0, bridges = 0;    // edges between two vertices that no sphere has in common
};

// All vertices of the SAS or VDW surface, and all edges, by brute force.
Counts examine(const Atoms &atoms, const qses_settings &s, const Surface &surface) {
  Counts counts;
  const double p = inflation(s);
  std::vector<std::set<size_t>> on(surface.vertex_count());
  for (size_t v = 0; v < surface.vertex_count(); ++v) {
    const std::array<double, 3> x = surface.mesh.position(v);
    for (size_t i = 0; i < atoms.size(); ++i)
      EXPECT_LT(depth_in(atoms, i, p, x), kOnSphere) << "vertex " << v << " lies in atom " << i;
    on[v] = spheres_at(atoms, p, x);
    EXPECT_EQ(on[v].count(surface.mesh.owners[v]), 1u) << "vertex " << v << " is not on the sphere of its owner";
    counts.on_two += on[v].size() == 2 ? 1 : 0;
    counts.on_three += on[v].size() > 2 ? 1 : 0;
  }
  for (size_t t = 0; t < surface.mesh.triangle_count(); ++t)
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t u = surface.mesh.indices[3 * t + k], v = surface.mesh.indices[3 * t + (k + 1) % 3];
      bool shared = false;
      for (size_t i : on[u]) shared |= on[v].count(i) > 0;
      ++counts.edges;
      counts.bridges += shared ? 0 : 1;
    }
  return counts;
}

class BallCreases : public testing::TestWithParam<qses_surface> {};

TEST_P(BallCreases, VerticesLieOnTheSpheresAndInNone) {
  const Atoms atoms = cluster(60, 5);
  const qses_settings s = settings(0.5, 1.4, GetParam());
  const Surface plain = compute(atoms, s), sharp = compute(atoms, creased(s));
  EXPECT_EQ(mesh_checks::manifold_fault(sharp.mesh), "");
  const Counts before = examine(atoms, s, plain), after = examine(atoms, creased(s), sharp);
  EXPECT_GT(after.on_two, 10 * before.on_two + 100);
  EXPECT_GT(after.on_three, before.on_three);
  EXPECT_LT(static_cast<double>(after.bridges) / static_cast<double>(after.edges),
            0.25 * static_cast<double>(before.bridges) / static_cast<double>(before.edges));
}

// Few, where a split would have folded a triangle.
TEST_P(BallCreases, FewEdgesBridgeTheCreaseOfTwoBalls) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  size_t before = 0, after = 0;
  for (int k = 0; k < 30; ++k) {
    Atoms atoms;
    const double x = 1.9 + 0.2 * number(random), y = number(random), z = number(random);
    atoms.add(0, 0, 0, 1.7).add(x, y, z, 1.5);
    for (double h : {0.7, 0.5, 0.3}) {
      const qses_settings s = settings(h, 1.4, GetParam());
      const Surface plain = compute(atoms, s), sharp = compute(atoms, creased(s));
      EXPECT_EQ(mesh_checks::manifold_fault(sharp.mesh), "");
      const size_t bridges = examine(atoms, s, plain).bridges, left = examine(atoms, s, sharp).bridges;
      EXPECT_LT(static_cast<double>(left), 0.25 * static_cast<double>(bridges))
          << x << " " << y << " " << z << ", " << h;
      before += bridges;
      after += left;
    }
  }
  EXPECT_LT(static_cast<double>(after), 0.04 * static_cast<double>(before));
}

// Two caps less of two spheres: what is missing then is what chords cut off of curved sheets, which falls with the
// square of the spacing; without splits chords over the crease cut off more.
TEST_P(BallCreases, AreaAndVolumeOfTwoBallsConverge) {
  Atoms atoms;
  const double a = 1.7, b = 1.5, d = std::sqrt(1.9 * 1.9 + 0.4 * 0.4 + 0.3 * 0.3);
  atoms.add(0, 0, 0, a).add(1.9, 0.4, 0.3, b);
  const double pi = 3.14159265358979;
  double before = 0;
  for (double h : {0.5, 0.25, 0.125}) {
    const qses_settings s = settings(h, 1.4, GetParam());
    const double p = inflation(s), r = a + p, q = b + p, x = (d * d + r * r - q * q) / (2 * d), y = d - x;
    const double area = 2 * pi * r * (r + x) + 2 * pi * q * (q + y);
    const auto part = [&](double R, double z) { return pi * (R + z) * (R + z) * (2 * R - z) / 3; };
    const double volume = part(r, x) + part(q, y);
    const Surface plain = compute(atoms, s), sharp = compute(atoms, creased(s));
    const double error = area - mesh_checks::area(sharp.mesh);
    EXPECT_GT(error, 0) << "chords of spheres are shorter";
    EXPECT_LT(error, area - mesh_checks::area(plain.mesh));
    // A chord of length l is off a sphere by l^2 / 8R; edges are about as long as the spacing.
    EXPECT_LT(error / area, h * h / (4 * q * q)) << "spacing " << h;
    EXPECT_LT(std::abs(mesh_checks::signed_volume(sharp.mesh) - volume) / volume, h * h / (2 * q * q));
    if (before > 0) {
      EXPECT_LT(error, before / 3);
    }
    before = error;
  }
}

// Around a vertex within a triangle, where three creases meet, as around any other: each piece looks away from a sphere
// that its corners have in common, and has angles.
TEST_P(BallCreases, TrianglesAroundCornersAreNeitherFoldedNorFlat) {
  using exact_reference::cross, exact_reference::dot, exact_reference::length, exact_reference::point;
  constexpr double kLeastTurn = 0.29, kFlatCosine = 0.9991;  // and what float32 leaves of their limits
  const Atoms atoms = crambin();
  const double p = inflation(settings(1, 1.4, GetParam()));
  size_t corners = 0;
  for (double h : {0.5, 0.8, 1.0, 1.5}) {
    const Surface surface = compute(atoms, creased(settings(h, 1.4, GetParam())));
    std::vector<std::vector<uint32_t>> triangles(surface.vertex_count());
    for (size_t k = 0; k < surface.mesh.indices.size(); ++k)
      triangles[surface.mesh.indices[k]].push_back(static_cast<uint32_t>(k / 3));
    for (size_t v = 0; v < surface.vertex_count(); ++v) {
      if (triangles[v].size() != 3 || spheres_at(atoms, p, surface.mesh.position(v)).size() < 3) continue;
      ++corners;
      for (uint32_t t : triangles[v]) {
        const uint32_t *const c = surface.mesh.indices.data() + 3 * size_t(t);
        const exact_reference::Point x[3] = {point(surface.mesh.position(c[0])), point(surface.mesh.position(c[1])),
                                             point(surface.mesh.position(c[2]))};
        const auto normal = cross(x[1] - x[0], x[2] - x[0]), middle = (1.0 / 3) * (x[0] + x[1] + x[2]);
        bool is_shared = false, looks_away = false;
        for (size_t i : spheres_at(atoms, p, surface.mesh.position(v))) {
          bool on_all = true;
          for (int k = 0; k < 3; ++k) on_all &= spheres_at(atoms, p, surface.mesh.position(c[k])).count(i) > 0;
          if (!on_all) continue;
          is_shared = true;
          looks_away |= dot(normal, middle - point(atoms.center(i))) >
                        kLeastTurn * length(normal) * (static_cast<double>(atoms.radii[i]) + p);
        }
        EXPECT_TRUE(looks_away || !is_shared) << "spacing " << h << ", triangle " << t << " is folded";
        for (int k = 0; k < 3; ++k) {
          const auto a = x[(k + 1) % 3] - x[k], b = x[(k + 2) % 3] - x[k];
          EXPECT_LT(dot(a, b), kFlatCosine * length(a) * length(b)) << "spacing " << h << ", triangle " << t;
        }
      }
    }
  }
  EXPECT_GT(corners, 30u);
}

// So are hardly any elsewhere: only where the mesh was so before it was split, or merged behind that.
TEST_P(BallCreases, HardlyATriangleIsTurnedAwayFromItsSphere) {
  using exact_reference::cross, exact_reference::dot, exact_reference::length, exact_reference::point;
  size_t triangles = 0, turned_away = 0;
  for (const Atoms &atoms : {cluster(60, 5), crambin()})
    for (double h : {0.5, 0.9, 1.5}) {
      const qses_settings s = creased(settings(h, 1.4, GetParam()));
      const double p = inflation(s);
      const Surface surface = compute(atoms, s);
      std::vector<std::set<size_t>> on(surface.vertex_count());
      for (size_t v = 0; v < on.size(); ++v) on[v] = spheres_at(atoms, p, surface.mesh.position(v));
      triangles += surface.mesh.triangle_count();
      for (size_t t = 0; t < surface.mesh.triangle_count(); ++t) {
        const uint32_t *const c = surface.mesh.indices.data() + 3 * t;
        exact_reference::Point x[3];
        for (int k = 0; k < 3; ++k) x[k] = point(surface.mesh.position(c[k]));
        const auto normal = cross(x[1] - x[0], x[2] - x[0]), middle = (1.0 / 3) * (x[0] + x[1] + x[2]);
        bool is_shared = false, looks_away = false;
        for (size_t i : on[c[0]]) {
          if (!on[c[1]].count(i) || !on[c[2]].count(i)) continue;
          is_shared = true;
          looks_away |= dot(normal, middle - point(atoms.center(i))) >
                        0.29 * length(normal) * (static_cast<double>(atoms.radii[i]) + p);
        }
        turned_away += is_shared && !looks_away ? 1 : 0;
      }
    }
  EXPECT_GT(triangles, 50000u);
  EXPECT_LT(static_cast<double>(turned_away), 1e-3 * static_cast<double>(triangles));
}

TEST_P(BallCreases, VerticesOnOneSphereAreOfContactPatches) {
  const Atoms atoms = crambin();
  qses_settings s = creased(settings(0.5, 1.4, GetParam()));
  s.patch_types = 1;
  const Surface surface = compute(atoms, s);
  ASSERT_EQ(surface.patches.size(), surface.vertex_count());
  size_t others = 0;
  for (size_t v = 0; v < surface.vertex_count(); ++v) {
    if (surface.patches[v] == QSES_PATCH_CONTACT) continue;
    ++others;
    EXPECT_GT(spheres_at(atoms, inflation(s), surface.mesh.position(v)).size(), 1u) << "vertex " << v;
  }
  EXPECT_GT(others, 100u);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, BallCreases, testing::Values(QSES_SURFACE_SAS, QSES_SURFACE_VDW));

bool same_bytes(const Surface &a, const Surface &b) {
  const auto same = [](const auto &x, const auto &y) {
    return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0);
  };
  return same(a.mesh.positions, b.mesh.positions) && same(a.mesh.normals, b.mesh.normals) &&
         same(a.mesh.owners, b.mesh.owners) && same(a.mesh.indices, b.mesh.indices) && same(a.patches, b.patches);
}

class Creases : public testing::TestWithParam<qses_surface> {};

TEST_P(Creases, GiveTheSameBytesHoweverTheWorkIsCut) {
  const Atoms atoms = cluster(300, 11);
  qses_settings s = creased(settings(0.5, 1.4, GetParam()));
  s.patch_types = 1;
  const Surface first = compute(atoms, s);
  EXPECT_TRUE(same_bytes(first, compute(atoms, s, 1)));
  EXPECT_TRUE(same_bytes(first, compute(atoms, s)));
  qses_settings sliced = s;
  sliced.slice_size = 16;
  EXPECT_TRUE(same_bytes(first, compute(atoms, sliced)));
  const Context context;
  set_atoms(context, atoms);
  const qses_size_estimate estimate = estimate_of(context, s);
  const Context tight(2, estimate.smallest_budget * 5 / 4);
  EXPECT_TRUE(same_bytes(first, compute(tight, atoms, s)));
}

// The winding says how the corners of a triangle follow each other, and nothing about where they are; nor does it
// matter whether there is anybody to look at them.
TEST_P(Creases, LeaveTheMeshClosedAndItsReversalTheSame) {
  const Atoms atoms = cluster(200, 3);
  for (double spacing : {0.5, 2.0})
    for (qses_bool hard_edges : {0, 1}) {
      SCOPED_TRACE(testing::Message() << spacing << " Å" << (hard_edges ? ", hard edges" : ""));
      qses_settings s = creased(settings(spacing, 1.4, GetParam()));
      s.hard_edges = hard_edges;
      const Surface first = compute(atoms, s);
      s.winding = QSES_WINDING_REVERSED;
      const Surface reversed = compute(atoms, s);
      if (!hard_edges) {
        EXPECT_EQ(mesh_checks::manifold_fault(first.mesh), "");
        EXPECT_EQ(mesh_checks::manifold_fault(reversed.mesh), "");
      }
      EXPECT_TRUE(reversed.mesh.positions == first.mesh.positions);
      EXPECT_TRUE(reversed.mesh.normals == first.mesh.normals);
      EXPECT_TRUE(reversed.mesh.owners == first.mesh.owners);
      ASSERT_EQ(reversed.mesh.indices.size(), first.mesh.indices.size());
      for (size_t k = 0; k < first.mesh.indices.size(); k += 3)
        for (size_t corner : {0, 1, 2})
          ASSERT_EQ(reversed.mesh.indices[k + corner], first.mesh.indices[k + (3 - corner) % 3]) << k;
      EXPECT_EQ(reversed.report.area, first.report.area);
      s.delivery = QSES_DELIVERY_NONE;
      const Context context;
      set_atoms(context, atoms);
      compute_view(context, s);
      EXPECT_EQ(report_of(context).area, first.report.area);
    }
}

TEST_P(Creases, KeepLayoutsAttributesAndHiddenAtoms) {
  const Atoms atoms = cluster(80, 9);
  qses_settings s = creased(settings(0.6, 1.4, GetParam()));
  s.components = 1;
  const Context context;
  set_atoms(context, atoms);
  std::vector<uint8_t> colors(4 * atoms.size()), visible(atoms.size(), 1);
  for (size_t i = 0; i < colors.size(); ++i) colors[i] = static_cast<uint8_t>(7 * i);
  visible[3] = visible[10] = 0;
  expect_ok(qses_set_colors(context, colors.data(), atoms.size()));
  for (const qses_vertex_layout layout : {QSES_VERTICES_SEPARATE, QSES_VERTICES_INTERLEAVED, QSES_VERTICES_COMPACT}) {
    s.vertex_layout = layout;
    const qses_mesh m = compute_view(context, s);
    ASSERT_GT(m.vertex_count, 0u);
    uint64_t triangles = 0;
    for (uint32_t k = 0; k < m.component_count; ++k) triangles += m.components[k].triangles;
    EXPECT_EQ(triangles, m.triangle_count);
    for (uint32_t v = 0; v < m.vertex_count; ++v)
      ASSERT_EQ(std::memcmp(m.colors + 4 * v, colors.data() + 4 * m.owners[v], 4), 0);
  }
  s.vertex_layout = QSES_VERTICES_SEPARATE;
  expect_ok(qses_set_visible(context, visible.data(), atoms.size()));
  const qses_mesh m = compute_view(context, s);
  for (uint32_t v = 0; v < m.vertex_count; ++v) ASSERT_TRUE(m.owners[v] != 3 && m.owners[v] != 10);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, Creases, testing::Values(QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW));

TEST(CreaseSettings, AreNotForTheVoxelMethod) {
  qses_settings s = creased(settings());
  s.method = QSES_METHOD_GRID;
  const Context context;
  set_atoms(context, cluster(5, 1));
  EXPECT_EQ(qses_compute(context, &s, nullptr), QSES_INVALID_ARGUMENT);
}

TEST(CreaseSettings, DegenerateAtoms) {
  Atoms one, twins, tangent, none;
  one.add(0, 0, 0, 1.7);
  twins.add(0, 0, 0, 1.7).add(0, 0, 0, 1.7);
  tangent.add(0, 0, 0, 1.7).add(6.2, 0, 0, 1.7);
  for (const qses_surface surface : {QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW})
    for (const Atoms *atoms : {&one, &twins, &tangent, &none})
      EXPECT_EQ(mesh_checks::manifold_fault(compute(*atoms, creased(settings(0.5, 1.4, surface))).mesh), "");
}

}  // namespace
