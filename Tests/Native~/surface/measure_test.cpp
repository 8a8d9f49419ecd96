// SPDX-License-Identifier: MIT
// Area, volume and bounds of shapes that have them in closed form.
#include "surface/stages/measure.h"

#include "parallel/cpu_executor.h"
#include "surface/cpu/cpu_kernels.h"
#include "surface/mesh_shapes.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

namespace {

using namespace quickses;
using mesh_checks::Mesh;

const double kPi = std::acos(-1.0);
const double kOrigin[3] = {};

struct Flat {
  double area, volume;
  Bounds bounds;
};
Flat measure_mesh(Mesh &mesh, unsigned threads = 2, bool reversed = false) {
  CpuExecutor executor(threads);
  MeshView view;
  view.positions = mesh.positions.data();
  view.indices = mesh.indices.data();
  view.reversed = reversed;
  const MeshCounts counts{mesh.vertex_count(), mesh.triangle_count()};
  const Measures m = sum_mesh(executor, measured_sums(view, counts, false, kOrigin, nullptr), nullptr);
  EXPECT_EQ(m.sums.area, m.sums.flat_area);
  EXPECT_EQ(m.sums.volume, m.sums.flat_volume);
  return {m.sums.area, m.sums.volume, m.bounds};
}

TEST(Measure, Tetrahedron) {
  Mesh m = mesh_shapes::tetrahedron();
  const Flat found = measure_mesh(m);
  EXPECT_NEAR(found.volume, 1.0 / 6.0, 1e-12);
  EXPECT_NEAR(found.area, 1.5 + std::sqrt(3.0) / 2, 1e-12);
  for (int d = 0; d < 3; ++d) {
    EXPECT_EQ(found.bounds.min[d], 0.f);
    EXPECT_EQ(found.bounds.max[d], 1.f);
  }
}

TEST(Measure, Cube) {
  Mesh m = mesh_shapes::cube();
  mesh_shapes::scale_and_move(m, 1.5, -10, 20, -30);
  const Flat found = measure_mesh(m);
  EXPECT_NEAR(found.volume, 27.0, 1e-9);
  EXPECT_NEAR(found.area, 54.0, 1e-9);
  const float low[3] = {-11.5f, 18.5f, -31.5f}, high[3] = {-8.5f, 21.5f, -28.5f};
  for (int d = 0; d < 3; ++d) {
    EXPECT_EQ(found.bounds.min[d], low[d]);
    EXPECT_EQ(found.bounds.max[d], high[d]);
  }
}

// 131,072 triangles: many chunks, more than one thread.
TEST(Measure, Sphere) {
  Mesh m = mesh_shapes::sphere(7);
  const double radius = 12.5;
  mesh_shapes::scale_and_move(m, radius, 100, 200, 300);
  const Flat found = measure_mesh(m);
  const double area = 4 * kPi * radius * radius, volume = area * radius / 3;
  EXPECT_NEAR(found.area, area, 2e-4 * area);
  EXPECT_LT(found.area, area);
  EXPECT_NEAR(found.volume, volume, 3e-4 * volume);
  EXPECT_LT(found.volume, volume);
  EXPECT_NEAR(found.area, mesh_checks::area(m), 1e-9 * area);
  EXPECT_NEAR(found.volume, mesh_checks::signed_volume(m), 1e-9 * volume);
  EXPECT_FLOAT_EQ(found.bounds.min[0], 87.5f);
  EXPECT_FLOAT_EQ(found.bounds.max[2], 312.5f);
  for (unsigned threads : {1u, 3u}) {
    const Flat again = measure_mesh(m, threads);
    EXPECT_EQ(again.area, found.area);
    EXPECT_EQ(again.volume, found.volume);
  }
}

TEST(Measure, KeepsItsDigitsFarAway) {
  Mesh m = mesh_shapes::cube();
  mesh_shapes::scale_and_move(m, 8, 1 << 19, -(1 << 19), 1 << 18);  // exact in float32
  const Flat found = measure_mesh(m);
  EXPECT_NEAR(found.volume, 4096.0, 1e-6);
  EXPECT_NEAR(found.area, 1536.0, 1e-6);
}

TEST(Measure, CavitiesCountNegativeWhateverTheWinding) {
  Mesh m = mesh_shapes::cube(), hole = mesh_shapes::cube();
  mesh_shapes::scale_and_move(m, 2, 0, 0, 0);
  mesh_shapes::reverse(hole);
  mesh_shapes::append(m, hole);
  EXPECT_NEAR(measure_mesh(m).volume, 64.0 - 8.0, 1e-9);
  EXPECT_NEAR(measure_mesh(m).area, 96.0 + 24.0, 1e-9);
  mesh_shapes::reverse(m);
  EXPECT_NEAR(measure_mesh(m, 2, true).volume, 64.0 - 8.0, 1e-9);
}

// ---- along the normals

TriangleSums measure_bent(Mesh &mesh, const std::vector<float> &normals, const std::vector<float> &second = {},
                          bool reversed = false) {
  CpuExecutor executor(2);
  MeshView view;
  view.positions = mesh.positions.data();
  view.normals = const_cast<float *>(normals.data());
  if (!second.empty()) view.second_normals = const_cast<float *>(second.data());
  view.indices = mesh.indices.data();
  view.reversed = reversed;
  const MeshCounts counts{mesh.vertex_count(), mesh.triangle_count()};
  return sum_mesh(executor, measured_sums(view, counts, true, kOrigin, nullptr), nullptr).sums;
}

// Four triangles at a time measure what each of them does, to the last bit: crests, corners that face away, and
// triangles without area among them, whatever their number.
TEST(Measure, FourAtATimeAsOneByOne) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-1, 1);
  constexpr size_t kTriangles = 400;
  Mesh m;
  std::vector<float> normals, second;
  const auto unit = [](glm::vec3 v) { return v / std::sqrt(glm::dot(v, v)); };
  const auto add = [](std::vector<float> &to, const glm::vec3 &v) { to.insert(to.end(), {v.x, v.y, v.z}); };
  for (uint32_t t = 0; t < kTriangles; ++t) {
    const auto anywhere = [&] { return glm::vec3(place(random), place(random), place(random)); };
    const glm::vec3 a = anywhere(), b = t % 11 == 0 ? a : a + 0.3f * anywhere(), c = a + 0.3f * anywhere();
    const glm::vec3 facing = t % 11 == 0 ? glm::vec3(0, 0, 1) : unit(glm::cross(b - a, c - a));
    for (const glm::vec3 &x : {a, b, c}) {
      const glm::vec3 n = unit(facing + (t % 7 == 0 ? 2.f : 0.4f) * anywhere());
      add(m.positions, x);
      add(normals, n);
      add(second, t % 3 == 0 ? unit(facing + 0.8f * anywhere()) : n);
      m.indices.push_back(static_cast<uint32_t>(m.indices.size()));
    }
  }
  for (const bool reversed : {false, true})
    for (const bool has_second : {false, true})
      for (const bool bent : {false, true}) {
        MeshView view;
        view.positions = m.positions.data();
        view.normals = normals.data();
        view.second_normals = has_second ? second.data() : nullptr;
        view.indices = m.indices.data();
        view.reversed = reversed;
        const MeasureTriangle measure{view, {0.5, -0.25, 3.0}, bent};
        for (const CpuKernels *kernels : usable_cpu_kernels())
          for (size_t first = 0, count = 0; first + count <= kTriangles; first += count, count = count % 9 + 1) {
            TriangleSums sums[9];
            kernels->measure_triangles(measure, first, count, sums);
            for (size_t k = 0; k < count; ++k) {
              const TriangleSums one = measure(first + k);
              ASSERT_EQ(std::memcmp(&one, sums + k, sizeof one), 0)
                  << kernels->name << " " << first + k << ": " << one.area << " " << sums[k].area << " " << one.volume
                  << " " << sums[k].volume;
            }
          }
      }
}

// What is left falls with the fourth power of the size of triangles, where that of flat ones falls with the second.
TEST(Measure, AlongTheNormalsOfASphere) {
  const double radius = 3, area = 4 * kPi * radius * radius, volume = area * radius / 3;
  double flat_before = 0, bent_before = 0;
  for (int halvings = 2; halvings <= 5; ++halvings) {
    Mesh m = mesh_shapes::sphere(halvings);
    const std::vector<float> normals = m.positions;
    mesh_shapes::scale_and_move(m, radius, 5, -7, 11);
    const TriangleSums sums = measure_bent(m, normals);
    const double flat = area - sums.flat_area, bent = std::abs(area - sums.area);
    EXPECT_NEAR(sums.flat_area, mesh_checks::area(m), 1e-9 * area);
    EXPECT_LT(bent, 0.06 * flat);
    EXPECT_LT(std::abs(volume - sums.volume), 0.06 * (volume - sums.flat_volume));
    if (halvings > 2) {
      EXPECT_NEAR(flat_before / flat, 4, 0.5);
      EXPECT_GT(bent_before / bent, 10);
    }
    flat_before = flat;
    bent_before = bent;
    mesh_shapes::reverse(m);
    const TriangleSums turned = measure_bent(m, normals, {}, true);
    EXPECT_NEAR(turned.area, sums.area, 1e-9 * area);
    EXPECT_NEAR(turned.volume, sums.volume, 1e-9 * volume);
  }
}

// Two halves of balls on each other: at the crest each side goes by its own normal.
TEST(Measure, AlongTheNormalsOfBothSidesOfACrest) {
  // The sphere with all z mirrored up and lowered: a lens of two caps, its rim at the equator of neither.
  const double low = 0.6;  // centres lie so far from the plane of the rim
  Mesh m = mesh_shapes::sphere(5);
  const size_t vertices = m.vertex_count();
  std::vector<float> normals(3 * vertices), second(3 * vertices);
  for (size_t v = 0; v < vertices; ++v) {
    // From the half spheres to caps of as many rings: angles shrink, so that the equator comes to the rim.
    float *const p = &m.positions[3 * v];
    const double z = static_cast<double>(p[2]),
                 polar = std::acos(std::min(1.0, std::abs(z))) / (kPi / 2) * std::acos(low);
    const double turn = std::atan2(static_cast<double>(p[1]), static_cast<double>(p[0])), side = z < 0 ? -1 : 1;
    const double n[3] = {std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), side * std::cos(polar)};
    const bool on_rim = std::abs(z) < 1e-6;
    for (size_t d = 0; d < 3; ++d) {
      p[d] = static_cast<float>(n[d] - (d == 2 ? side * low : 0));
      normals[3 * v + d] = second[3 * v + d] = static_cast<float>(n[d]);
      if (on_rim && d == 2) second[3 * v + d] = static_cast<float>(-n[d]);
    }
    if (on_rim) p[2] = 0.f;
  }
  const double area = 2 * 2 * kPi * (1 - low), volume = 2 * kPi / 3 * (1 - low) * (1 - low) * (2 + low);
  const TriangleSums sums = measure_bent(m, normals, second), one_side = measure_bent(m, normals);
  EXPECT_NEAR(sums.area, area, 2e-5 * area);
  EXPECT_NEAR(sums.volume, volume, 2e-5 * volume);
  EXPECT_LT(sums.flat_area, area * (1 - 1e-4));
  EXPECT_GT(std::abs(one_side.area - area), 4 * std::abs(sums.area - area));
}

// A corner whose normal points elsewhere says nothing about the triangle.
TEST(Measure, NormalsThatPointElsewhereAreLeftOut) {
  Mesh m = mesh_shapes::cube();
  const std::vector<float> normals = m.positions;  // of the corners, 55 degrees and more from those of the faces
  const TriangleSums sums = measure_bent(m, normals);
  std::vector<float> away(normals.size(), 0.f);
  for (size_t v = 0; v < m.vertex_count(); ++v) away[3 * v] = 1.f;
  const TriangleSums other = measure_bent(m, away);
  EXPECT_TRUE(std::isfinite(sums.area) && std::isfinite(sums.volume));
  EXPECT_NEAR(other.area, sums.flat_area, 1e-12);
  EXPECT_NEAR(other.volume, sums.flat_volume, 1e-12);
}

// Once, however many parts the mesh is summed up in.
TEST(Measure, BringsAnotherNumberAlong) {
  Mesh m = mesh_shapes::sphere(7);
  MeshView view;
  view.positions = m.positions.data();
  view.indices = m.indices.data();
  const MeshCounts counts{m.vertex_count(), m.triangle_count()};
  const uint32_t unplaced = 7;
  for (unsigned threads : {1u, 3u}) {
    CpuExecutor executor(threads);
    uint64_t with_bounds = 0, with_measures = 0;
    sum_mesh(executor, bound_sums(view, counts, &unplaced), &with_bounds);
    sum_mesh(executor, measured_sums(view, counts, false, kOrigin, &unplaced), &with_measures);
    EXPECT_EQ(with_bounds, 7u);
    EXPECT_EQ(with_measures, 7u);
  }
}

TEST(Measure, AZeroOfTheBoundsHasNoSign) {
  for (const float zero : {0.f, -0.f}) {
    Mesh m = mesh_shapes::tetrahedron();
    for (float &p : m.positions)
      if (p == 0) p = zero;
    for (float &p : m.positions)
      if (p == 1) p = -1;
    const Flat low = measure_mesh(m);
    for (float &p : m.positions)
      if (p == -1) p = 1;
    const Flat high = measure_mesh(m);
    for (int d = 0; d < 3; ++d) {
      EXPECT_EQ(low.bounds.max[d], 0);
      EXPECT_FALSE(std::signbit(low.bounds.max[d]));
      EXPECT_EQ(high.bounds.min[d], 0);
      EXPECT_FALSE(std::signbit(high.bounds.min[d]));
    }
  }
}

TEST(Measure, EmptyMesh) {
  Mesh m;
  const Flat found = measure_mesh(m);
  EXPECT_EQ(found.area, 0.0);
  EXPECT_EQ(found.volume, 0.0);
  for (int d = 0; d < 3; ++d) {
    EXPECT_EQ(found.bounds.min[d], 0.f);
    EXPECT_EQ(found.bounds.max[d], 0.f);
  }
}

TEST(Measure, OrderedBitsKeepTheOrderOfFloats) {
  const float values[] = {
      -std::numeric_limits<float>::infinity(), -1e30f, -2.f, -1.f, -1e-40f, -0.f, 0.f, 1e-40f, 1.f, 1.5f, 1e30f};
  for (size_t k = 0; k < std::size(values); ++k) {
    EXPECT_EQ(from_ordered_bits(ordered_bits(values[k])), values[k]);
    for (size_t j = 0; j < k; ++j) EXPECT_LT(ordered_bits(values[j]), ordered_bits(values[k])) << j << " " << k;
  }
}

}  // namespace
