// SPDX-License-Identifier: MIT
// The pieces of meshes that were put together from known shapes.
#include "surface/components.h"

#include "mesh_shapes.h"
#include "parallel/cpu_executor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace {

using namespace quickses;
using mesh_checks::Mesh;

std::vector<Component> components_of(Mesh &m, unsigned threads = 2, bool reversed = false, float spacing = 0.5f) {
  CpuExecutor executor(threads);
  const MeshView view = {m.positions.data(), nullptr, nullptr, nullptr, m.indices.data(), reversed};
  return find_components(executor, view, MeshCounts{m.vertex_count(), m.triangle_count()}, spacing);
}

TEST(Components, OfSeparateShapes) {
  Mesh m = mesh_shapes::tetrahedron(), cube = mesh_shapes::cube(), hole = mesh_shapes::cube();
  mesh_shapes::scale_and_move(cube, 2, 100, 200, 300);
  mesh_shapes::scale_and_move(hole, 0.5, 100, 200, 300);
  mesh_shapes::reverse(hole);
  mesh_shapes::append(m, cube);
  mesh_shapes::append(m, hole);
  for (bool reversed : {false, true}) {
    if (reversed) mesh_shapes::reverse(m);
    const std::vector<Component> found = components_of(m, 2, reversed);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].triangles, 4u);
    EXPECT_NEAR(found[0].volume, 1.0 / 6.0, 1e-6);
    EXPECT_NEAR(found[0].area, 1.5 + std::sqrt(3.0) / 2, 1e-6);
    EXPECT_FALSE(found[0].cavity);
    EXPECT_EQ(found[1].triangles, 12u);
    EXPECT_NEAR(found[1].volume, 64.0, 1e-6);
    EXPECT_NEAR(found[1].area, 96.0, 1e-6);
    EXPECT_FALSE(found[1].cavity);
    EXPECT_EQ(found[2].triangles, 12u);
    EXPECT_NEAR(found[2].volume, -1.0, 1e-6);
    EXPECT_NEAR(found[2].area, 6.0, 1e-6);
    EXPECT_TRUE(found[2].cavity);
  }
}

// Vertices and triangles in random order: long chains of hooks.
TEST(Components, OfShuffledSpheres) {
  Mesh m;
  for (int k = 0; k < 20; ++k) {
    Mesh s = mesh_shapes::sphere(k % 5);
    mesh_shapes::scale_and_move(s, 1 + 0.1 * k, 5 * k, 0, 0);
    mesh_shapes::append(m, s);
  }
  std::mt19937 random(7);
  std::vector<uint32_t> new_number(m.vertex_count());
  for (size_t v = 0; v < new_number.size(); ++v) new_number[v] = static_cast<uint32_t>(v);
  std::shuffle(new_number.begin(), new_number.end(), random);
  Mesh shuffled = m;
  for (size_t v = 0; v < new_number.size(); ++v)
    for (size_t d = 0; d < 3; ++d) shuffled.positions[3 * new_number[v] + d] = m.positions[3 * v + d];
  std::vector<size_t> order(m.triangle_count());
  for (size_t t = 0; t < order.size(); ++t) order[t] = t;
  std::shuffle(order.begin(), order.end(), random);
  for (size_t t = 0; t < order.size(); ++t)
    for (size_t k = 0; k < 3; ++k) shuffled.indices[3 * t + k] = new_number[m.indices[3 * order[t] + k]];

  const std::vector<Component> found = components_of(shuffled);
  ASSERT_EQ(found.size(), 20u);
  uint64_t triangles = 0;
  double area = 0, volume = 0;
  for (const Component &c : found) {
    triangles += c.triangles;
    area += c.area;
    volume += c.volume;
    EXPECT_FALSE(c.cavity);
  }
  EXPECT_EQ(triangles, m.triangle_count());
  EXPECT_NEAR(area, mesh_checks::area(m), 1e-6 * area);
  EXPECT_NEAR(volume, mesh_checks::signed_volume(m), 1e-6 * volume);
  for (unsigned threads : {1u, 4u}) {
    const std::vector<Component> again = components_of(shuffled, threads);
    ASSERT_EQ(again.size(), found.size());
    for (size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(again[k].triangles, found[k].triangles);
      EXPECT_EQ(again[k].area, found[k].area);
      EXPECT_EQ(again[k].volume, found[k].volume);
    }
  }
}

TEST(Components, LabelIsTheSmallestVertex) {
  Mesh m = mesh_shapes::octahedron();
  mesh_shapes::append(m, mesh_shapes::cube());
  CpuExecutor executor(2);
  std::vector<uint32_t> labels(m.vertex_count(), 99);
  const MeshView view = {m.positions.data(), nullptr, nullptr, nullptr, m.indices.data(), false};
  label_components(executor, view, MeshCounts{m.vertex_count(), m.triangle_count()}, labels.data());
  for (size_t v = 0; v < labels.size(); ++v) EXPECT_EQ(labels[v], v < 6 ? 0u : 6u);
}

TEST(Components, OfNothing) {
  Mesh m;
  EXPECT_TRUE(components_of(m).empty());
}

}  // namespace
