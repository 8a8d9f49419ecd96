// SPDX-License-Identifier: MIT
// Smoothing and normals against plain adjacency lists in double precision.
#include "parallel/cpu_executor.h"
#include "surface/grid_fixture.h"
#include "surface/mesh_shapes.h"

#include <gtest/gtest.h>

#include <set>

namespace {

using namespace grid_fixture;
using GridRun = GridRunOn<CpuExecutor>;
using mesh_checks::Mesh;
using Point = std::array<double, 3>;

MeshView view_of(Mesh &m, bool reversed = false) {
  m.normals.resize(m.positions.size());
  return {m.positions.data(), m.normals.data(), nullptr, nullptr, m.indices.data(), reversed};
}
MeshCounts counts_of(const Mesh &m) { return {m.vertex_count(), m.triangle_count()}; }

std::vector<std::set<uint32_t>> neighbors_of(const Mesh &m) {
  std::vector<std::set<uint32_t>> neighbors(m.vertex_count());
  for (size_t t = 0; t < m.indices.size(); t += 3)
    for (size_t k = 0; k < 3; ++k) {
      neighbors[m.indices[t + k]].insert(m.indices[t + (k + 1) % 3]);
      neighbors[m.indices[t + (k + 1) % 3]].insert(m.indices[t + k]);
    }
  return neighbors;
}

std::vector<Point> means_of_neighbors(const std::vector<std::set<uint32_t>> &neighbors, const std::vector<Point> &x) {
  std::vector<Point> means(x.size());
  for (size_t v = 0; v < x.size(); ++v)
    for (uint32_t n : neighbors[v])
      for (size_t d = 0; d < 3; ++d) means[v][d] += x[n][d] / static_cast<double>(neighbors[v].size());
  return means;
}

std::vector<Point> points_of(const Mesh &m) {
  std::vector<Point> x;
  for (size_t v = 0; v < m.vertex_count(); ++v) x.push_back(m.position(v));
  return x;
}

double largest_difference(const std::vector<Point> &a, const std::vector<Point> &b) {
  double largest = a.size() == b.size() ? 0.0 : 1e9;
  for (size_t v = 0; v < a.size(); ++v)
    for (size_t d = 0; d < 3; ++d) largest = std::max(largest, std::abs(a[v][d] - b[v][d]));
  return largest;
}

// Two sums in one word keep apart, whatever their signs, as far as each of them fits.
TEST(RingSums, KeepTwoSumsApart) {
  std::mt19937 random(7);
  for (const int32_t most : {1, 3, 1 << 20, 53'000'000}) {
    std::uniform_int_distribution<int32_t> term(-most, most);
    int64_t both = 0, low = 0, high = 0;
    for (int k = 0; k < 40; ++k) {
      const int32_t a = term(random), b = term(random);
      both += two_sums(a, b);
      low += a, high += b;
      ASSERT_EQ(low_sum(both), low);
      ASSERT_EQ(high_sum(both), high);
    }
  }
  for (const int64_t low : {INT64_C(-2147483648), INT64_C(-1), INT64_C(0), INT64_C(2147483647)})
    for (const int64_t high : {INT64_C(-2147483647), INT64_C(-1), INT64_C(0), INT64_C(2147483647)}) {
      const int64_t both = two_sums(static_cast<int32_t>(low), static_cast<int32_t>(high));
      EXPECT_EQ(low_sum(both), low);
      EXPECT_EQ(high_sum(both), high);
    }
}

TEST(Laplacian, IsTheMeanOfTheNeighbors) {
  GridRun run(random_cluster(40, 3), 1.4f, 0.5f);
  for (uint32_t steps : {0u, 1u, 2u, 5u}) {
    Mesh mesh = run.mesh();
    const std::vector<std::set<uint32_t>> neighbors = neighbors_of(mesh);
    std::vector<Point> expected = points_of(mesh);
    for (uint32_t k = 0; k < steps; ++k) expected = means_of_neighbors(neighbors, expected);
    const std::vector<Point> before = points_of(mesh);
    smooth_laplacian(run.executor, run.view(mesh), run.counts, 0.5f, steps, ring_sums(run.executor, run.counts));
    EXPECT_LT(largest_difference(points_of(mesh), expected), 1e-5) << steps;
    if (steps == 0)
      EXPECT_EQ(points_of(mesh), before);
    else
      EXPECT_GT(largest_difference(points_of(mesh), before), 0.05);
    EXPECT_EQ(mesh_checks::manifold_fault(mesh), "");
  }
}

TEST(Laplacian, OfAnOctahedronIsItsCenter) {
  Mesh m = mesh_shapes::octahedron();
  mesh_shapes::scale_and_move(m, 1, 10, -20, 30);
  CpuExecutor executor(1);
  smooth_laplacian(executor, view_of(m), counts_of(m), 0.5f, 1, ring_sums(executor, counts_of(m)));
  for (const Point &p : points_of(m)) {
    EXPECT_NEAR(p[0], 10, 1e-5);
    EXPECT_NEAR(p[1], -20, 1e-5);
    EXPECT_NEAR(p[2], 30, 1e-5);
  }
}

TEST(Laplacian, ThreadsGiveTheSameBytes) {
  GridRun one(random_cluster(60, 8), 1.4f, 0.35f, 0, 1), four(random_cluster(60, 8), 1.4f, 0.35f, 0, 4);
  Mesh a = one.mesh(), b = four.mesh();
  smooth_laplacian(one.executor, one.view(a), one.counts, 0.35f, 3, ring_sums(one.executor, one.counts));
  smooth_laplacian(four.executor, four.view(b), four.counts, 0.35f, 3, ring_sums(four.executor, four.counts));
  compute_normals(one.executor, one.view(a), one.counts, 0.35f, ring_sums(one.executor, one.counts));
  compute_normals(four.executor, four.view(b), four.counts, 0.35f, ring_sums(four.executor, four.counts));
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
}

std::vector<Point> plain_normals(const Mesh &m) {
  std::vector<Point> sums(m.vertex_count());
  for (size_t t = 0; t < m.indices.size(); t += 3) {
    const Point a = m.position(m.indices[t]), b = m.position(m.indices[t + 1]), c = m.position(m.indices[t + 2]);
    const Point n = {(b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]),
                     (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]),
                     (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])};
    for (size_t k = 0; k < 3; ++k)
      for (size_t d = 0; d < 3; ++d) sums[m.indices[t + k]][d] += n[d];
  }
  return sums;
}

TEST(Normals, AreWeightedByArea) {
  GridRun run(random_cluster(40, 4), 1.4f, 0.5f);
  Mesh mesh = run.mesh();
  smooth_laplacian(run.executor, run.view(mesh), run.counts, 0.5f, 1, ring_sums(run.executor, run.counts));
  compute_normals(run.executor, run.view(mesh), run.counts, 0.5f, ring_sums(run.executor, run.counts));
  EXPECT_LT(mesh_checks::worst_normal_length(mesh), 1e-5);
  const std::vector<Point> expected = plain_normals(mesh);
  size_t compared = 0;
  for (size_t v = 0; v < expected.size(); ++v) {
    const Point &s = expected[v];
    const double length = std::sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
    if (length < 0.01 * 0.25) continue;  // nearly no area: no direction to speak of
    ++compared;
    for (size_t d = 0; d < 3; ++d) ASSERT_NEAR(mesh.normals[3 * v + d], s[d] / length, 1e-3) << v;
  }
  EXPECT_GT(compared, expected.size() * 9 / 10);
}

TEST(Normals, PointOutwardWhateverTheWinding) {
  for (bool reversed : {false, true}) {
    Mesh m = mesh_shapes::sphere(4);
    if (reversed) mesh_shapes::reverse(m);
    CpuExecutor executor(2);
    compute_normals(executor, view_of(m, reversed), counts_of(m), 0.1f, ring_sums(executor, counts_of(m)));
    EXPECT_LT(mesh_checks::worst_normal_length(m), 1e-5);
    for (size_t k = 0; k < m.positions.size(); ++k) ASSERT_NEAR(m.normals[k], m.positions[k], 0.03);
  }
}

// Vertices that coincide leave triangles without area: the normals from before stay.
TEST(Normals, OfAPointStay) {
  Mesh m = mesh_shapes::octahedron();
  m.normals = m.positions;
  const std::vector<float> before = m.normals;
  mesh_shapes::scale_and_move(m, 0, 3, 4, 5);
  CpuExecutor executor(1);
  compute_normals(executor, view_of(m), counts_of(m), 0.5f, ring_sums(executor, counts_of(m)));
  EXPECT_EQ(m.normals, before);
}

struct Tangential {
  GridRun run;
  Mesh mesh;
  std::vector<glm::vec3> starts;
  explicit Tangential(const std::vector<Atom> &atoms)
      : run(atoms, 1.4f, 0.5f), mesh(run.mesh()), starts(mesh.vertex_count()) {
    compute_normals(run.executor, run.view(mesh), run.counts, 0.5f, ring_sums(run.executor, run.counts));
    step();
  }
  void step() {
    tangential_starts(run.executor, run.field.bricks, run.layout, run.view(mesh), run.counts,
                      ring_sums(run.executor, run.counts), starts.data());
  }
  Point start(size_t v) const {
    return {starts[v].x + run.lattice.center_x, starts[v].y + run.lattice.center_y, starts[v].z + run.lattice.center_z};
  }
};

TEST(TangentialStep, FollowsItsFormula) {
  std::vector<Atom> atoms = random_cluster(40, 6);
  for (Atom &a : atoms) {  // the centred frame is not the caller's
    a.x += 100;
    a.y -= 50;
    a.z += 25;
  }
  Tangential t(atoms);
  const std::vector<Point> x = points_of(t.mesh), means = means_of_neighbors(neighbors_of(t.mesh), x);
  size_t moved = 0;
  for (size_t v = 0; v < x.size(); ++v) {
    double d[3], along = 0, length2 = 0;
    for (size_t k = 0; k < 3; ++k) {
      d[k] = means[v][k] - x[v][k];
      along += d[k] * t.mesh.normals[3 * v + k];
    }
    for (size_t k = 0; k < 3; ++k) {
      d[k] = 0.7 * (d[k] - along * t.mesh.normals[3 * v + k]);
      length2 += d[k] * d[k];
    }
    const double limit = std::min(1.0, 0.3 / std::sqrt(length2));
    moved += length2 > 0.01 ? 1 : 0;
    const Point start = t.start(v);
    for (size_t k = 0; k < 3; ++k) ASSERT_NEAR(start[k], x[v][k] + limit * d[k], 3e-5) << v;
  }
  EXPECT_GT(moved, x.size() / 10);
}

// A vertex far from its neighbours moves by no more than 0.6 spacings, and a start stays near the brick that owns it.
TEST(TangentialStep, IsLimited) {
  Tangential t(random_cluster(40, 6));
  const std::vector<float> positions = t.mesh.positions;
  for (size_t v = 0; v < t.mesh.vertex_count(); v += 7) t.mesh.positions[3 * v] += 3.f;
  t.step();
  const BrickSet &bricks = t.run.field.bricks;
  size_t far_moves = 0, held_back = 0;
  for (uint32_t b = 0; b < bricks.count; ++b) {
    const glm::ivec3 first = bricks.lattice.first_point(bricks.place(b));
    for (uint32_t v = t.run.layout.base[b].vertices; v < t.run.layout.base[b + 1].vertices; ++v) {
      double outside = -1e9, length2 = 0;
      for (int d = 0; d < 3; ++d) {
        const double low = 0.5 * first[d] - 0.6, high = 0.5 * (first[d] + 7) + 0.6;
        ASSERT_GE(t.starts[v][d], low);
        ASSERT_LE(t.starts[v][d], high);
        const double at =
            t.mesh.positions[3 * size_t(v) + static_cast<size_t>(d)] - (d == 0   ? t.run.lattice.center_x
                                                                        : d == 1 ? t.run.lattice.center_y
                                                                                 : t.run.lattice.center_z);
        outside = std::max(outside, std::max(low - at, at - high));
        length2 += (t.starts[v][d] - at) * (t.starts[v][d] - at);
      }
      held_back += outside > 0 ? 1 : 0;
      if (outside > -0.6) continue;  // the brick may have held it back
      ASSERT_LE(std::sqrt(length2), 0.3 + 1e-4);
      far_moves += std::sqrt(length2) > 0.29 ? 1 : 0;
    }
  }
  EXPECT_GT(far_moves, 10u);
  EXPECT_GT(held_back, 10u);
}

}  // namespace
