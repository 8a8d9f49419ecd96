// SPDX-License-Identifier: MIT
// How much of the lamp vertices see, as rays to many points of it say.
#include "render/lamp_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace quickses::render {
namespace {

using glm::vec3;

struct Scene {
  SeenMesh mesh;
  std::vector<uint32_t> indices;

  uint32_t vertex(vec3 position, vec3 normal) {
    mesh.positions.push_back(position), mesh.normals.push_back(normal);
    return static_cast<uint32_t>(mesh.positions.size() - 1);
  }
  void square(vec3 middle, vec3 normal, vec3 x, vec3 y) {
    uint32_t corner[4];
    const vec3 at[] = {middle - x - y, middle + x - y, middle + x + y, middle - x + y};
    for (int k = 0; k < 4; ++k) corner[k] = vertex(at[k], normal);
    indices.insert(indices.end(), {corner[0], corner[1], corner[2], corner[0], corner[2], corner[3]});
  }
  // Both sides of it: the lamp sees what faces it. x, y and the normal are right-handed.
  void plate(vec3 middle, vec3 normal, vec3 x, vec3 y, float half = 0.01f) {
    square(middle - half * normal, -normal, y, x), square(middle + half * normal, normal, x, y);
  }
  std::vector<float> light(vec3 lamp, unsigned threads = 1) {
    mesh.indices = indices.data(), mesh.index_count = indices.size();
    return lamp_light(mesh, lamp, threads);
  }
};

constexpr double kLampCosine = 0.99;  // of half the lamp's angle

// How much of the lamp is beside a square plate that is parallel to the floor.
double unshaded(vec3 p, vec3 normal, vec3 lamp, vec3 middle, vec3 x, vec3 y) {
  const vec3 side = glm::normalize(glm::cross(lamp, vec3(0.3f, 0.1f, 0.9f))), other = glm::cross(lamp, side);
  const vec3 plate_normal = glm::cross(x, y);
  int free = 0, all = 0;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 60; ++j, ++all) {
      const double z = 1 - (1 - kLampCosine) * (i + 0.5) / 40, r = std::sqrt(1 - z * z), turn = 2 * 3.14159265 * j / 60;
      const vec3 d = lamp * static_cast<float>(z) + side * static_cast<float>(r * std::cos(turn)) +
                     other * static_cast<float>(r * std::sin(turn));
      if (glm::dot(d, normal) <= 0) continue;
      const float t = glm::dot(middle - p, plate_normal) / glm::dot(d, plate_normal);
      const vec3 at = p + t * d - middle;
      const bool is_hidden =
          t > 0.1f && std::abs(glm::dot(at, x)) < glm::dot(x, x) && std::abs(glm::dot(at, y)) < glm::dot(y, y);
      free += is_hidden ? 0 : 1;
    }
  return static_cast<double>(free) / all;
}

TEST(LampLight, ABallSeesTheLampOnItsNearSide) {
  const vec3 lamps[] = {vec3(-0.45f, 0.62f, 0.64f), vec3(1, 0.1f, -0.4f), vec3(0, -0.2f, 1)};
  for (const vec3 given : lamps) {
    const vec3 lamp = glm::normalize(given);
    Scene ball;
    constexpr int kAcross = 40, kAlong = 20;
    const vec3 middle(7, -30, 12);
    for (int i = 0; i <= kAlong; ++i)
      for (int j = 0; j < kAcross; ++j) {
        const float a = 3.14159265f * static_cast<float>(i) / kAlong,
                    b = 2 * 3.14159265f * static_cast<float>(j) / kAcross;
        const vec3 n(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
        ball.vertex(middle + 8.f * n, n);
      }
    const auto at = [&](int i, int j) { return static_cast<uint32_t>(i * kAcross + j % kAcross); };
    for (int i = 0; i < kAlong; ++i)
      for (int j = 0; j < kAcross; ++j)
        for (const uint32_t v : {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)})
          ball.indices.push_back(v);
    const std::vector<float> light = ball.light(lamp);
    ASSERT_EQ(light.size(), ball.mesh.positions.size());
    for (size_t v = 0; v < light.size(); ++v) {
      const float facing = glm::dot(ball.mesh.normals[v], lamp);
      EXPECT_GE(light[v], facing > 0.25f ? 0.99f : 0) << facing;
      EXPECT_LE(light[v], facing < -0.15f ? 0 : 1) << facing;
    }
  }
}

// A plate that stands above a floor, seen from some sides, near and far.
TEST(LampLight, ShadowsAreThoseOfADisk) {
  for (const vec3 given : {vec3(-0.45f, 0.62f, 0.64f), vec3(0.2f, 0.3f, -1), vec3(1, 0, 0)})
    for (const auto &[height, beside] : {std::pair(5.f, 3.f), std::pair(20.f, 3.f), std::pair(8.f, -16.f)}) {
      const vec3 lamp = glm::normalize(given), x = glm::normalize(glm::cross(lamp, vec3(0.1f, 1, 0.2f))),
                 y = glm::cross(lamp, x), origin(3, 40, -8);
      Scene scene;
      scene.plate(origin, lamp, 25.f * x, 25.f * y);
      const vec3 middle = origin + height * lamp + beside * (x + y);
      scene.plate(middle, lamp, 7.f * x, 10.f * y);
      const size_t first = scene.mesh.positions.size();
      std::vector<double> expected;
      for (int i = -12; i <= 12; ++i)
        for (int j = -12; j <= 12; ++j) {
          const vec3 p = origin + (0.01f * lamp + 1.7f * static_cast<float>(i) * x + 1.9f * static_cast<float>(j) * y);
          scene.vertex(p, lamp);
          expected.push_back(unshaded(p + 0.35f * lamp, lamp, lamp, middle, 7.f * x, 10.f * y));
        }
      const std::vector<float> light = scene.light(lamp);
      double difference = 0;
      for (size_t k = 0; k < expected.size(); ++k) {
        EXPECT_NEAR(light[first + k], expected[k], 0.17) << k << " " << height;
        difference += light[first + k] - expected[k];
      }
      EXPECT_NEAR(difference / static_cast<double>(expected.size()), 0, 0.01);
      const std::vector<float> by_others = scene.light(lamp, 7);
      EXPECT_EQ(light, by_others);
    }
}

// The near side of a thing counts: what lies below it, and where it stands in a floor, is dark.
TEST(LampLight, UnderABlockItIsDark) {
  const vec3 lamp = glm::normalize(vec3(-0.45f, 0.62f, 0.64f));
  const vec3 x = glm::normalize(glm::cross(lamp, vec3(0, 1, 0))), y = glm::cross(lamp, x);
  Scene scene;
  scene.plate(vec3(0), lamp, 20.f * x, 20.f * y);
  scene.plate(3.05f * lamp, lamp, 6.f * x, 6.f * y, 3);
  const uint32_t below = scene.vertex(0.01f * lamp, lamp), beside = scene.vertex(0.01f * lamp + 9.f * x, lamp);
  const std::vector<float> light = scene.light(lamp);
  EXPECT_EQ(light[below], 0);
  EXPECT_GT(light[beside], 0.99f);
}

// Nothing lies in its own shadow, not even a point.
TEST(LampLight, SmallThingsAreLit) {
  const vec3 lamp = glm::normalize(vec3(-0.45f, 0.62f, 0.64f));
  const vec3 x = glm::normalize(glm::cross(lamp, vec3(0, 1, 0))), y = glm::cross(lamp, x);
  for (const float size : {0.f, 1e-4f, 0.1f, 2.f, 500.f}) {
    Scene plate;
    plate.plate(vec3(1, 2, 3), lamp, size * x, size * y);
    const std::vector<float> light = plate.light(lamp);
    for (size_t v = 4; v < 8; ++v) EXPECT_GT(light[v], 0.99f) << size;
  }
}

}  // namespace
}  // namespace quickses::render
