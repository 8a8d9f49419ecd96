// SPDX-License-Identifier: MIT
// Normals that point against triangles are turned to all of them, where that can be, and others stay.
#include "surface/stages/facing_normals.h"

#include "parallel/cpu_executor.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace {

using namespace quickses;
using Point = std::array<float, 3>;

struct Fans {
  std::vector<float> positions, normals;
  std::vector<uint32_t> indices, tips;

  uint32_t add(const Point &x, const Point &normal) {
    positions.insert(positions.end(), x.begin(), x.end());
    normals.insert(normals.end(), normal.begin(), normal.end());
    return static_cast<uint32_t>(positions.size() / 3 - 1);
  }
  // A pyramid without a base, whose tip is that much above it, and its normal.
  void add_pyramid(float height, const Point &normal, int sides = 6) {
    const float at = 10.f * static_cast<float>(tips.size());
    const uint32_t tip = add({at, 0, height}, normal);
    tips.push_back(tip);
    for (int k = 0; k < sides; ++k) {
      const float angle = 6.2831853f * static_cast<float>(k) / static_cast<float>(sides);
      add({at + std::cos(angle), std::sin(angle), 0}, {0, 0, 1});
    }
    for (int k = 0; k < sides; ++k)
      for (const uint32_t v :
           {tip, tip + 1 + static_cast<uint32_t>(k), tip + 1 + static_cast<uint32_t>((k + 1) % sides)})
        indices.push_back(v);
  }
  Point normal(uint32_t v) const { return {normals[3 * v], normals[3 * v + 1], normals[3 * v + 2]}; }

  void face(unsigned threads = 2) {
    CpuExecutor executor(threads);
    MeshView view;
    view.positions = positions.data();
    view.normals = normals.data();
    view.indices = indices.data();
    face_triangles(executor, view, MeshCounts{positions.size() / 3, indices.size() / 3});
  }
  // The smallest cosine between the normal of a tip and its triangles.
  float least_facing(uint32_t tip) const {
    float least = 1;
    MeshView view;
    view.positions = const_cast<float *>(positions.data());
    for (size_t k = 0; k < indices.size(); k += 3) {
      if (indices[k] != tip) continue;
      const Vec3<float> face = face_normal(view, indices.data() + k);
      const float length2 = length_squared(face);
      if (length2 > 0) least = std::min(least, dot(face, load_vec3(normals.data() + 3 * tip)) / std::sqrt(length2));
    }
    return least;
  }
};

void expect_unit_length(const Fans &fans) {
  for (uint32_t tip : fans.tips) {
    const Point n = fans.normal(tip);
    EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-5) << tip;
  }
}

// More of them than are worked on at a time.
TEST(FacingNormals, FaceAllTrianglesOfEachOfVeryMany) {
  Fans fans;
  for (int k = 0; k < 300; ++k) {
    const float angle = 0.7f * static_cast<float>(k);
    fans.add_pyramid(0.1f + 0.003f * static_cast<float>(k), {0.8f * std::cos(angle), 0.8f * std::sin(angle), -0.6f});
  }
  for (uint32_t tip : fans.tips) ASSERT_LT(fans.least_facing(tip), 0);
  Fans threaded = fans;
  fans.face(1);
  threaded.face(4);
  expect_unit_length(fans);
  for (uint32_t tip : fans.tips) EXPECT_GT(fans.least_facing(tip), 0) << tip;
  EXPECT_EQ(fans.normals, threaded.normals);
}

TEST(FacingNormals, ComeFromTheVeryOpposite) {
  Fans fans;
  fans.add_pyramid(0, {0, 0, -1});
  fans.face();
  EXPECT_EQ(fans.normal(fans.tips[0]), (Point{0, 0, 1}));
}

TEST(FacingNormals, StayWhereTheyFaceAllTriangles) {
  Fans fans;
  for (int k = 0; k < 5; ++k)
    fans.add_pyramid(0.5f, {0.1f * static_cast<float>(k), 0, 1 - 0.1f * static_cast<float>(k)});
  const std::vector<float> before = fans.normals;
  fans.face();
  EXPECT_EQ(fans.normals, before);
}

// A triangle without area faces nothing, and is in nobody's way.
TEST(FacingNormals, PassOverTrianglesWithoutArea) {
  Fans fans;
  fans.add_pyramid(0.3f, {0.6f, 0, -0.8f});
  for (const uint32_t v : {0, 1, 1, 0, 0, 2}) fans.indices.push_back(v);
  fans.face();
  expect_unit_length(fans);
  EXPECT_GT(fans.least_facing(0), 0);
}

// Of a vertex with more triangles than there is room for, the normal stays.
TEST(FacingNormals, StayAmongVeryManyTriangles) {
  constexpr int kRoom = static_cast<int>(MarkedFans::kRoom);
  Fans fans;
  fans.add_pyramid(0.3f, {0.6f, 0, -0.8f}, kRoom);
  fans.add_pyramid(0.3f, {0.6f, 0, -0.8f}, kRoom + 1);
  fans.face();
  EXPECT_GT(fans.least_facing(fans.tips[0]), 0);
  EXPECT_EQ(fans.normal(fans.tips[1]), (Point{0.6f, 0, -0.8f}));
}

}  // namespace
