// SPDX-License-Identifier: MIT
// Area, volume and bounds of shapes that have them in closed form.
#include "surface/stages/measure.h"

#include "parallel/cpu_executor.h"
#include "surface/mesh_shapes.h"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace quickses;
using mesh_checks::Mesh;

const double kPi = std::acos(-1.0);

Measures measure_mesh(Mesh &mesh, unsigned threads = 2, bool reversed = false) {
  CpuExecutor executor(threads);
  const MeshView view = {mesh.positions.data(), nullptr, nullptr, nullptr, mesh.indices.data(), reversed};
  return measure(executor, view, MeshCounts{mesh.vertex_count(), mesh.triangle_count()});
}

TEST(Measure, Tetrahedron) {
  Mesh m = mesh_shapes::tetrahedron();
  const Measures found = measure_mesh(m);
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
  const Measures found = measure_mesh(m);
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
  const Measures found = measure_mesh(m);
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
    const Measures again = measure_mesh(m, threads);
    EXPECT_EQ(again.area, found.area);
    EXPECT_EQ(again.volume, found.volume);
  }
}

TEST(Measure, KeepsItsDigitsFarAway) {
  Mesh m = mesh_shapes::cube();
  mesh_shapes::scale_and_move(m, 8, 1 << 19, -(1 << 19), 1 << 18);  // exact in float32
  const Measures found = measure_mesh(m);
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

TEST(Measure, EmptyMesh) {
  Mesh m;
  const Measures found = measure_mesh(m);
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
