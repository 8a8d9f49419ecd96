// SPDX-License-Identifier: MIT
// Boxes around triangles hide nothing from a ray that it meets without them.
#include "surface/stages/pick_boxes.h"

#include "kept/kept_mesh.h"
#include "parallel/cpu_executor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace {

using namespace quickses;

// Any triangles, all of one atom.
struct Triangles {
  std::vector<float> positions;
  std::vector<uint32_t> indices;

  uint32_t vertex(float x, float y, float z) {
    positions.insert(positions.end(), {x, y, z});
    return static_cast<uint32_t>(positions.size() / 3 - 1);
  }
  void add(uint32_t a, uint32_t b, uint32_t c) { indices.insert(indices.end(), {a, b, c}); }
  const float *position(size_t vertex) const { return positions.data() + 3 * vertex; }
};

class Pickable {
 public:
  explicit Pickable(const Triangles &given)
      : triangles_(given), normals_(given.positions.size(), 1.f), owners_(given.positions.size() / 3, 0) {
    const size_t count = given.indices.size() / 3;
    runs_.resize(PickBoxes::run_count(count));
    groups_.resize(PickBoxes::group_count(count));
    boxes_ = {runs_.data(), groups_.data()};
    MeshView view;
    view.positions = triangles_.positions.data();
    view.indices = triangles_.indices.data();
    view.boxes = boxes_;
    CpuExecutor executor(1);
    fill_pick_boxes(executor, view, count);
    qses_mesh_init(&mesh_);
    mesh_.vertex_count = static_cast<uint32_t>(owners_.size());
    mesh_.triangle_count = static_cast<uint32_t>(count);
    mesh_.positions = triangles_.positions.data();
    mesh_.normals = normals_.data();
    mesh_.indices = triangles_.indices.data();
    mesh_.owners = owners_.data();
    for (size_t d = 0; d < 3; ++d) mesh_.bounds_min[d] = mesh_.bounds_max[d] = given.positions[d];
    for (size_t k = 0; k < given.positions.size(); ++k) {
      mesh_.bounds_min[k % 3] = std::min(mesh_.bounds_min[k % 3], given.positions[k]);
      mesh_.bounds_max[k % 3] = std::max(mesh_.bounds_max[k % 3], given.positions[k]);
    }
  }
  qses_hit fast(const float *origin, const float *direction) const {
    return pick(mesh_, boxes_, origin, direction, nullptr);
  }
  qses_hit plain(const float *origin, const float *direction) const {
    return pick(mesh_, {}, origin, direction, nullptr);
  }

 private:
  Triangles triangles_;
  std::vector<float> normals_;
  std::vector<uint32_t> owners_;
  std::vector<Box> runs_, groups_;
  PickBoxes boxes_;
  qses_mesh mesh_;
};

// Rays to the corners and edges of a box that is no larger than its triangle, where rounding decides.
TEST(PickBoxes, HideNothingThatARayJustTouches) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(-1, 1);
  int met = 0;
  for (int round = 0; round < 30000; ++round) {
    Triangles one;
    for (int k = 0; k < 3; ++k) one.vertex(30 + unit(random), 5 * unit(random), round % 3 == 0 ? 2.f : unit(random));
    one.add(0, 1, 2);
    const Pickable mesh(one);
    const float origin[3] = {10 * unit(random), 10 * unit(random), 10 * unit(random)}, along = round % 2 ? 0.f : 0.5f;
    float direction[3];
    for (size_t d = 0; d < 3; ++d) {
      const float target = one.position(0)[d] + along * (one.position(1)[d] - one.position(0)[d]);
      direction[d] = target - origin[d];
    }
    const qses_hit plain = mesh.plain(origin, direction), fast = mesh.fast(origin, direction);
    ASSERT_EQ(std::memcmp(&plain, &fast, sizeof plain), 0) << "round " << round;
    met += plain.found;
  }
  EXPECT_GT(met, 1000);
}

// Also where all is negative, the eye is far away, or the mesh. All are multiples of 8: rays go through corners.
TEST(PickBoxes, HideNothingWhereverItIs) {
  struct Place {
    int mesh, mesh_size, eye, eye_size;
  };
  std::mt19937 random(8);
  const auto some = [&random](int middle, int size) {
    return 8 * static_cast<float>(middle + static_cast<int>(random() % static_cast<unsigned>(2 * size + 1)) - size);
  };
  for (const Place &place : {Place{-200, 100, -200, 150}, Place{0, 2, 0, 8'000'000}, Place{6'000'000, 2, 0, 2},
                             Place{-6'000'000, 2, 0, 2}}) {
    int met = 0;
    for (int round = 0; round < 5000; ++round) {
      Triangles one;
      for (int k = 0; k < 3; ++k)
        one.vertex(some(place.mesh, place.mesh_size), some(place.mesh, place.mesh_size),
                   some(place.mesh, place.mesh_size));
      one.add(0, 1, 2);
      const Pickable mesh(one);
      float origin[3], direction[3];
      for (size_t d = 0; d < 3; ++d) {
        origin[d] = some(place.eye, place.eye_size);
        direction[d] = one.position(0)[d] - origin[d];
      }
      if (direction[0] == 0 && direction[1] == 0 && direction[2] == 0) continue;
      const qses_hit plain = mesh.plain(origin, direction), fast = mesh.fast(origin, direction);
      ASSERT_EQ(std::memcmp(&plain, &fast, sizeof plain), 0) << place.mesh << " round " << round;
      met += plain.found;
    }
    EXPECT_GT(met, 500) << place.mesh;
  }
}

// More groups than there is room for to put them in order: each holds a triangle far away, the last one a near one.
TEST(PickBoxes, TheNearestTriangleMayBeBehindVeryManyGroups) {
  constexpr size_t kGroupTriangles = kRunTriangles * kGroupRuns, kGroups = 300;
  Triangles many;
  for (const float z : {-5.f, 5.f}) many.vertex(-9, -9, z), many.vertex(9, -9, z), many.vertex(0, 9, z);
  for (size_t k = 0; k < kGroups * kGroupTriangles; ++k) many.add(0, 1, 2);
  many.indices.resize(many.indices.size() - 3);
  many.add(3, 4, 5);
  const Pickable mesh(many);
  const float origin[3] = {0, 0, 10}, direction[3] = {0, 0, -1};
  const qses_hit hit = mesh.fast(origin, direction);
  EXPECT_EQ(hit.found, 1u);
  EXPECT_EQ(hit.distance, 5.f);
  EXPECT_EQ(hit.triangle, kGroups * kGroupTriangles - 1);
}

// In whatever order boxes are visited.
TEST(PickBoxes, OfTrianglesAtOneDistanceTheFirstCounts) {
  Triangles same;
  same.vertex(-9, -9, 0), same.vertex(9, -9, 0), same.vertex(0, 9, 0), same.vertex(0, 0, 3), same.vertex(0, 1, 3);
  // The ray enters the second run before the first, since it has one triangle that is nearer, but beside the ray.
  for (size_t k = 0; k < 2 * kRunTriangles; ++k) same.add(0, 1, 2);
  same.indices[3 * kRunTriangles] = 3;
  same.indices[3 * kRunTriangles + 1] = 4;
  same.indices[3 * kRunTriangles + 2] = same.vertex(9, 9, 3);
  const Pickable mesh(same);
  const float origin[3] = {-0.5f, 0, 10}, direction[3] = {0, 0, -1};
  EXPECT_EQ(mesh.plain(origin, direction).distance, 10.f);
  EXPECT_EQ(mesh.plain(origin, direction).triangle, 0u);
  EXPECT_EQ(mesh.fast(origin, direction).triangle, 0u);
}

}  // namespace
