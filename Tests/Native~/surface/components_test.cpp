// SPDX-License-Identifier: MIT
// The pieces of meshes that were put together from known shapes.
#include "surface/stages/components.h"

#include "parallel/cpu_executor.h"
#include "surface/mesh_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace {

using namespace quickses;
using mesh_checks::Mesh;

MeshView view_of(Mesh &m, bool reversed = false) {
  MeshView view;
  view.positions = m.positions.data();
  view.indices = m.indices.data();
  view.reversed = reversed;
  return view;
}

constexpr double kOrigin[3] = {};

// All components together measure what the mesh does.
void expect_measures(const Measures &found, const Measures &wanted) {
  const double size = 1e-12 * (std::abs(wanted.sums.volume) + wanted.sums.area * std::sqrt(wanted.sums.area));
  EXPECT_NEAR(found.sums.area, wanted.sums.area, 1e-12 * wanted.sums.area);
  EXPECT_NEAR(found.sums.flat_area, wanted.sums.flat_area, 1e-12 * wanted.sums.area);
  EXPECT_NEAR(found.sums.volume, wanted.sums.volume, size);
  EXPECT_NEAR(found.sums.flat_volume, wanted.sums.flat_volume, size);
  for (int d = 0; d < 3; ++d) {
    EXPECT_EQ(found.bounds.min[d], wanted.bounds.min[d]);
    EXPECT_EQ(found.bounds.max[d], wanted.bounds.max[d]);
  }
}

std::vector<qses_component> components_of(Mesh &m, unsigned threads = 2, bool reversed = false, float spacing = 0.5f) {
  CpuExecutor executor(threads);
  ComponentMemory memory;
  const MeshView view = view_of(m, reversed);
  const MeshCounts counts{m.vertex_count(), m.triangle_count()};
  const uint32_t unplaced = 37;
  uint64_t found_unplaced = 0;
  const MeshComponents found =
      find_components(executor, view, counts, spacing, false, memory, &unplaced, &found_unplaced);
  expect_measures(found.total, sum_mesh(executor, measured_sums(view, counts, false, kOrigin, nullptr), nullptr));
  EXPECT_EQ(found_unplaced, counts.triangles > 0 ? unplaced : 0);
  return {found.list.begin(), found.list.end()};
}

void expect_same(const std::vector<qses_component> &a, const std::vector<qses_component> &b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].triangles, b[k].triangles);
    EXPECT_EQ(a[k].area, b[k].area);
    EXPECT_EQ(a[k].volume, b[k].volume);
    EXPECT_EQ(a[k].is_cavity, b[k].is_cavity);
    for (int d = 0; d < 3; ++d) {
      EXPECT_EQ(a[k].center[d], b[k].center[d]);
      EXPECT_EQ(a[k].bounds_min[d], b[k].bounds_min[d]);
      EXPECT_EQ(a[k].bounds_max[d], b[k].bounds_max[d]);
    }
  }
}

TEST(Components, OfSeparateShapes) {
  Mesh m = mesh_shapes::tetrahedron(), cube = mesh_shapes::cube(), hole = mesh_shapes::cube();
  mesh_shapes::scale_and_move(cube, 2, 100, 200, 300);
  mesh_shapes::scale_and_move(hole, 0.5, 100, 200, 300);
  mesh_shapes::reverse(hole);
  mesh_shapes::append(m, cube);
  mesh_shapes::append(m, hole);
  const std::vector<qses_component> outward = components_of(m);
  for (bool reversed : {false, true}) {
    if (reversed) mesh_shapes::reverse(m);
    const std::vector<qses_component> found = components_of(m, 2, reversed);
    expect_same(found, outward);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].triangles, 4u);
    EXPECT_NEAR(found[0].volume, 1.0 / 6.0, 1e-15);
    EXPECT_NEAR(found[0].area, 1.5 + std::sqrt(3.0) / 2, 1e-14);
    EXPECT_FALSE(found[0].is_cavity);
    EXPECT_EQ(found[1].triangles, 12u);
    EXPECT_NEAR(found[1].volume, 64.0, 1e-12);
    EXPECT_NEAR(found[1].area, 96.0, 1e-12);
    EXPECT_FALSE(found[1].is_cavity);
    EXPECT_EQ(found[2].triangles, 12u);
    EXPECT_NEAR(found[2].volume, -1.0, 1e-14);
    EXPECT_NEAR(found[2].area, 6.0, 1e-14);
    EXPECT_TRUE(found[2].is_cavity);
    const float middle[3] = {100, 200, 300};
    for (int d = 0; d < 3; ++d) {
      EXPECT_NEAR(found[0].center[d], 0.25, 1e-7);
      EXPECT_EQ(found[1].center[d], middle[d]);
      EXPECT_EQ(found[1].bounds_min[d], middle[d] - 2);
      EXPECT_EQ(found[1].bounds_max[d], middle[d] + 2);
      EXPECT_EQ(found[2].center[d], middle[d]);
      EXPECT_EQ(found[2].bounds_min[d], middle[d] - 0.5f);
      EXPECT_EQ(found[2].bounds_max[d], middle[d] + 0.5f);
    }
  }
}

// Two sides of the same triangle: there is no volume whose centre could be told.
TEST(Components, WithoutAVolumeAreCentredInTheirBox) {
  Mesh m;
  m.positions = {1, 2, 3, 4, 2, 3, 1, 6, 3};
  m.indices = {0, 1, 2, 0, 2, 1};
  const std::vector<qses_component> found = components_of(m);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].volume, 0);
  EXPECT_EQ(found[0].center[0], 2.5f);
  EXPECT_EQ(found[0].center[1], 4.f);
  EXPECT_EQ(found[0].center[2], 3.f);
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

  const std::vector<qses_component> found = components_of(shuffled);
  ASSERT_EQ(found.size(), 20u);
  // In the order of their first vertices.
  std::vector<size_t> sphere_of;
  for (size_t k = 0; k < 20; ++k) sphere_of.insert(sphere_of.end(), mesh_shapes::sphere(int(k % 5)).vertex_count(), k);
  std::vector<size_t> old_number(new_number.size()), order_of_spheres;
  for (size_t v = 0; v < new_number.size(); ++v) old_number[new_number[v]] = v;
  for (size_t v : old_number)
    if (std::count(order_of_spheres.begin(), order_of_spheres.end(), sphere_of[v]) == 0)
      order_of_spheres.push_back(sphere_of[v]);
  for (size_t k = 0; k < 20; ++k) {
    const double radius = 1 + 0.1 * static_cast<double>(order_of_spheres[k]);
    EXPECT_EQ(found[k].triangles, size_t(8) << 2 * (order_of_spheres[k] % 5));
    EXPECT_LT(found[k].volume, 4.1888 * radius * radius * radius);
    EXPECT_GT(found[k].volume, 4 / 3.0 * radius * radius * radius * 0.999);  // an octahedron's
  }
  uint64_t triangles = 0;
  double area = 0, volume = 0;
  for (const qses_component &c : found) {
    triangles += c.triangles;
    area += c.area;
    volume += c.volume;
    EXPECT_FALSE(c.is_cavity);
  }
  EXPECT_EQ(triangles, m.triangle_count());
  EXPECT_NEAR(area, mesh_checks::area(m), 1e-12 * area);
  EXPECT_NEAR(volume, mesh_checks::signed_volume(m), 1e-12 * volume);
  for (unsigned threads : {1u, 4u}) expect_same(components_of(shuffled, threads), found);
}

TEST(Components, LabelIsTheSmallestVertex) {
  Mesh m = mesh_shapes::octahedron();
  mesh_shapes::append(m, mesh_shapes::cube());
  CpuExecutor executor(2);
  std::vector<uint32_t> labels(m.vertex_count(), 99);
  const MeshView view = view_of(m);
  Tally<uint32_t> count{0};
  label_components(executor, view, MeshCounts{m.vertex_count(), m.triangle_count()}, labels.data(), &count);
  EXPECT_EQ(count.count, 2u);
  for (size_t v = 0; v < labels.size(); ++v) EXPECT_EQ(labels[v], v < 6 ? 0u : 6u);
}

// Nothing is lost where coordinates, and the volumes under single triangles, are large against the piece itself.
TEST(Components, KeepTheirDigits) {
  Mesh m = mesh_shapes::sphere(6);
  mesh_shapes::scale_and_move(m, 100, 1 << 16, -(1 << 15), 1 << 14);
  Mesh small = mesh_shapes::cube();
  mesh_shapes::scale_and_move(small, 0.0078125, -(1 << 16), 0, 0);
  mesh_shapes::append(m, small);
  for (float spacing : {0.01f, 0.1f, 0.5f}) {
    const std::vector<qses_component> found = components_of(m, 2, false, spacing);
    ASSERT_EQ(found.size(), 2u);
    Mesh sphere = mesh_shapes::sphere(6);
    mesh_shapes::scale_and_move(sphere, 100, 1 << 16, -(1 << 15), 1 << 14);
    EXPECT_NEAR(found[0].area, mesh_checks::area(sphere), 1e-11 * found[0].area) << spacing;
    for (int d = 0; d < 3; ++d) EXPECT_NEAR(found[0].center[d], d == 0 ? 1 << 16 : d == 1 ? -(1 << 15) : 1 << 14, 1e-2);
    EXPECT_NEAR(found[1].area, 24 * std::pow(0.0078125, 2), 1e-12) << spacing;
    EXPECT_NEAR(found[1].volume, 8 * std::pow(0.0078125, 3), 1e-12) << spacing;
  }
}

TEST(Components, OfNothing) {
  Mesh m;
  EXPECT_TRUE(components_of(m).empty());
}

// As a mesh that did not fit on the GPU may be large, and its job be cancelled.
TEST(HostComponents, GiveUpWhereTheyAreToldToStop) {
  Mesh m = mesh_shapes::sphere(7);
  const MeshCounts counts{m.vertex_count(), m.triangle_count()};
  HostComponents finder(2);
  ComponentMemory memory;
  std::atomic<bool> stop{true};
  EXPECT_THROW(finder.find(view_of(m), counts, 0.5f, false, memory, stop), Cancelled);
  stop = false;
  EXPECT_EQ(finder.find(view_of(m), counts, 0.5f, false, memory, stop).list.size, 1u);
}

}  // namespace
