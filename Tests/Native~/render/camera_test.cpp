// SPDX-License-Identifier: MIT
// From where molecules are looked at, and that they fill the picture.
#include "render/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace quickses::render {
namespace {

using glm::vec2;
using glm::vec3;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
  vec3 unit() {
    for (;;) {
      const vec3 v(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      if (glm::length(v) > 0.1f && glm::length(v) < 1) return glm::normalize(v);
    }
  }
  // Orthonormal and right-handed.
  glm::mat3 axes() {
    const vec3 x = unit(), z = glm::normalize(glm::cross(x, unit()));
    return {x, glm::cross(z, x), z};
  }

 private:
  std::mt19937 engine_;
};

struct Molecule {
  std::vector<float> centers, radii;

  void add(vec3 center, float radius) {
    centers.insert(centers.end(), {center.x, center.y, center.z});
    radii.push_back(radius);
  }
  Balls balls() const { return {centers.data(), radii.data(), radii.size(), 0}; }
  Balls points() const { return {centers.data(), nullptr, radii.size(), 0}; }
  vec3 center(size_t i) const { return {centers[3 * i], centers[3 * i + 1], centers[3 * i + 2]}; }
};

Molecule some_molecule(unsigned seed, vec3 around = vec3(0)) {
  Random random(seed);
  Molecule molecule;
  for (int n = 0; n < 40; ++n)
    molecule.add(around + vec3(random.uniform(-9, 9), random.uniform(-6, 6), random.uniform(-4, 4)),
                 random.uniform(1, 2));
  return molecule;
}

void expect_near(vec3 a, vec3 b, float slack = 1e-4f) {
  EXPECT_LT(glm::length(a - b), slack) << "(" << a.x << " " << a.y << " " << a.z << ") and (" << b.x << " " << b.y
                                       << " " << b.z << ")";
}

vec3 seen(const Camera &camera, vec3 p) {
  return {glm::dot(p, camera.right), glm::dot(p, camera.up), glm::dot(p, camera.toward)};
}

TEST(Camera, AxesAreOrthonormalAndRightHanded) {
  Random random(1);
  const Molecule molecule = some_molecule(1);
  for (int n = 0; n < 200; ++n) {
    View view;
    if (n % 2) view.toward = random.uniform(0.1f, 9) * random.unit();
    if (n % 4 > 1) view.up = random.uniform(0.1f, 9) * random.unit();
    view.turn[0] = random.uniform(-400, 400), view.turn[1] = random.uniform(-400, 400);
    const Camera camera(molecule.balls(), molecule.balls(), view, n % 8 > 3);
    EXPECT_NEAR(glm::length(camera.right), 1, 1e-5);
    EXPECT_NEAR(glm::length(camera.up), 1, 1e-5);
    expect_near(glm::cross(camera.right, camera.up), camera.toward);
  }
}

// What is upwards is so as far as the direction lets it, and exactly where only that is given.
TEST(Camera, LooksFromWhereItIsAskedTo) {
  Random random(2);
  const Molecule molecule = some_molecule(2);
  for (int n = 0; n < 100; ++n) {
    View view;
    const vec3 toward = random.unit(), up = random.unit();
    view.toward = 3.f * toward;
    const Camera from_there(molecule.balls(), molecule.balls(), view, n % 2 != 0);
    expect_near(from_there.toward, toward);
    EXPECT_NEAR(glm::dot(from_there.right, vec3(0, 0, 1)), 0, 1e-5) << "z is upwards";
    EXPECT_GT(from_there.up.z, 0);
    view.up = 2.f * up;
    const Camera both(molecule.balls(), molecule.balls(), view, n % 2 != 0);
    expect_near(both.toward, toward);
    EXPECT_NEAR(glm::dot(both.right, up), 0, 1e-5);
    EXPECT_GT(glm::dot(both.up, up), 0);
    view.toward.reset();
    const Camera upright(molecule.balls(), molecule.balls(), view, n % 2 != 0);
    expect_near(upright.up, up);
  }
}

TEST(Camera, WhatIsUpwardsMayBeAlongTheView) {
  const Molecule molecule = some_molecule(3);
  for (const vec3 axis : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(0, 0, -1)}) {
    View view;
    view.toward = axis;
    view.up = 2.f * axis + vec3(2e-4f);  // next to it
    const Camera camera(molecule.balls(), molecule.balls(), view, false);
    expect_near(camera.toward, axis);
    expect_near(camera.up, std::abs(axis.z) > 0.5f ? vec3(0, 1, 0) : vec3(0, 0, 1));
  }
}

// As the manual says: the near side to the right, then the top towards the eye. The molecule turns, not the eye.
TEST(Camera, TurnsTheMolecule) {
  const Molecule molecule = some_molecule(4);
  View view;
  view.toward = vec3(0, 0, 1);
  view.up = vec3(0, 1, 0);
  const auto camera_for = [&](float spin, float nod) {
    View turned = view;
    turned.turn[0] = spin, turned.turn[1] = nod;
    return Camera(molecule.balls(), molecule.balls(), turned, false);
  };
  const vec3 near_side(0, 0, 1), top(0, 1, 0), right(1, 0, 0);
  expect_near(seen(camera_for(90, 0), near_side), vec3(1, 0, 0));
  expect_near(seen(camera_for(90, 0), top), vec3(0, 1, 0));
  expect_near(seen(camera_for(0, 90), top), vec3(0, 0, 1));
  expect_near(seen(camera_for(0, 90), right), vec3(1, 0, 0));
  EXPECT_GT(seen(camera_for(30, 0), near_side).x, 0.49f);
  EXPECT_GT(seen(camera_for(0, 30), top).z, 0.49f);
  // First about the vertical, then about the horizontal.
  expect_near(seen(camera_for(90, 90), near_side), vec3(1, 0, 0));
  expect_near(seen(camera_for(90, 90), right), vec3(0, 1, 0));
}

// A box of points whose sides are known, with a tail at one end of the two longer ones.
Molecule box_of_points(const glm::mat3 &axes, vec3 middle) {
  Molecule molecule;
  for (int x = -5; x <= 5; ++x)
    for (int y = -3; y <= 3; ++y)
      for (int z = -1; z <= 1; ++z) molecule.add(middle + axes * vec3(x, y, z), 1);
  for (int k = 6; k < 9; ++k) molecule.add(middle + axes * vec3(k, 0, 0), 1);
  for (int k = 4; k < 6; ++k) molecule.add(middle + axes * vec3(0, k, 0), 1);
  return molecule;
}

TEST(Camera, LongestAxesAndTailsAreAlongTheSides) {
  Random random(5);
  for (int n = 0; n < 60; ++n) {
    const glm::mat3 axes = random.axes();
    const Molecule molecule = box_of_points(axes, 20.f * random.unit());
    const Camera wide(molecule.balls(), molecule.balls(), View(), false);
    expect_near(wide.right, axes[0], 2e-2f);
    expect_near(wide.up, axes[1], 2e-2f);
    const Camera tall(molecule.balls(), molecule.balls(), View(), true);
    expect_near(tall.up, axes[0], 2e-2f);
    expect_near(tall.right, axes[1], 2e-2f);
    // Copies look the same, wherever they are.
    const Molecule straight = box_of_points(glm::mat3(1), vec3(0));
    const Camera other(straight.balls(), straight.balls(), View(), false);
    for (size_t i = 0; i < straight.radii.size(); i += 7)
      expect_near(seen(wide, molecule.center(i) - wide.middle(molecule.balls())),
                  seen(other, straight.center(i) - other.middle(straight.balls())), 1e-2f);
  }
}

// With the longest axis upwards the second one, not the third, points at the eye.
TEST(Camera, UpwardsAlongTheViewOfTheAxes) {
  const Molecule molecule = box_of_points(glm::mat3(1), vec3(0));
  View view;
  view.up = vec3(0, 0, 1);
  const Camera camera(molecule.balls(), molecule.balls(), view, false);
  expect_near(camera.up, vec3(0, 0, 1));
  EXPECT_GT(std::abs(camera.toward.y), 0.99f);
}

// Axes are those of the atoms also where something else is seen; what is seen decides about place and scale.
TEST(Camera, LooksAtTheAtomsButShowsWhatIsSeen) {
  const Molecule molecule = box_of_points(glm::mat3(1), vec3(0));
  Molecule other;
  other.add(vec3(0, 0, -50), 0), other.add(vec3(2, 0, 70), 0);
  const Camera camera(molecule.balls(), other.balls(), View(), false);
  expect_near(camera.right, vec3(1, 0, 0), 2e-2f);
  expect_near(camera.up, vec3(0, 1, 0), 2e-2f);
  expect_near(camera.middle(molecule.balls()), vec3(1, 0, 10), 1);
  EXPECT_NEAR(camera.distance, 6 * 60, 2);
}

// No ball reaches beyond the picture, and one reaches its border: by many points of each of them.
TEST(Camera, WhatIsSeenFillsThePicture) {
  Random random(6);
  for (unsigned n = 0; n < 20; ++n) {
    const Molecule molecule = some_molecule(n, vec3(30, -20, 10));
    View view;
    if (n % 2) view.toward = random.unit();
    view.turn[0] = random.uniform(0, 360);
    Balls balls = n % 5 == 4 ? molecule.points() : molecule.balls();
    balls.more = n % 5 == 3 ? 1.4f : 0;
    const Camera camera(molecule.balls(), balls, view, n % 3 == 0);
    const vec3 middle = camera.middle(molecule.balls());
    vec2 most(0);
    vec3 low(1e30f), high(-1e30f);
    float radius = 0;
    for (size_t i = 0; i < balls.count; ++i) {
      const vec3 center = seen(camera, molecule.center(i) - middle);
      low = glm::min(low, center - balls.radius(i)), high = glm::max(high, center + balls.radius(i));
      radius = std::max(radius, glm::length(center) + balls.radius(i));
      for (int a = 0; a < 720; ++a)
        for (int axis = 0; axis < 2; ++axis) {
          // The outline of a ball along an axis lies on the circle through that axis and the eye's.
          vec3 p = center;
          p[axis] += balls.radius(i) * std::cos(glm::radians(0.5f * static_cast<float>(a)));
          p.z += balls.radius(i) * std::sin(glm::radians(0.5f * static_cast<float>(a)));
          most[axis] = std::max(most[axis], std::abs(p[axis]) * camera.distance / (camera.distance - p.z));
        }
    }
    expect_near(low + high, vec3(0), 1e-3f);
    EXPECT_NEAR(camera.distance, 6 * radius, 1e-3f * radius);
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_LT(most[axis], camera.half[axis] * 1.0001f);
      EXPECT_GT(most[axis], camera.half[axis] * 0.9998f);
    }
  }
}

TEST(Camera, TheNarrowerSideDecidesAboutTheScale) {
  Camera camera;
  camera.half = vec2(4, 2);
  EXPECT_FLOAT_EQ(camera.pixels_per_angstrom(vec2(100, 100)), 0.97f * 100 / 8);
  EXPECT_FLOAT_EQ(camera.pixels_per_angstrom(vec2(400, 100)), 0.97f * 100 / 4);
  const Molecule molecule = some_molecule(7);
  View view;
  view.fill = 0.5f;
  view.zoom = 3;
  EXPECT_FLOAT_EQ(Camera(molecule.balls(), molecule.balls(), view, false).enlargement(), 1.5f);
}

TEST(Camera, FollowsTheAtoms) {
  const Molecule molecule = some_molecule(8), moved = some_molecule(8, vec3(5, 6, 7));
  const Camera camera(molecule.balls(), molecule.balls(), View(), false);
  expect_near(camera.middle(moved.balls()) - camera.middle(molecule.balls()), vec3(5, 6, 7));
}

// A single point, and many at one place, have no axes and no size.
TEST(Camera, NothingButAPoint) {
  for (size_t count : {1u, 5u}) {
    Molecule molecule;
    for (size_t i = 0; i < count; ++i) molecule.add(vec3(1, 2, 3), 0);
    const Camera camera(molecule.points(), molecule.points(), View(), false);
    expect_near(glm::cross(camera.right, camera.up), camera.toward);
    expect_near(camera.middle(molecule.points()), vec3(1, 2, 3));
    EXPECT_GT(camera.half.x, 0);
    EXPECT_LT(camera.half.x, 0.01f);
    EXPECT_GT(camera.distance, 0);
    EXPECT_LT(camera.distance, 0.1f);
  }
}

}  // namespace
}  // namespace quickses::render
