// SPDX-License-Identifier: MIT
// Atoms that are said to be buried before their circles are looked at: they are, and most of those that are, are found.
#include "surface/cpu/cpu_covered_sphere.h"
#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

using namespace quickses;
using namespace surface_fixture;

namespace {

struct Caps {
  std::vector<float> x, y, z, cosine, sine, slope;

  int count() const { return static_cast<int>(x.size()); }
  // slope: of one Å by default, as of a cap whose border is hit at a right angle
  void add(const glm::dvec3 &axis, double cosine_of_cap, double slope_of_cap = 1) {
    x.push_back(static_cast<float>(axis.x)), y.push_back(static_cast<float>(axis.y));
    z.push_back(static_cast<float>(axis.z)), cosine.push_back(static_cast<float>(cosine_of_cap));
    sine.push_back(static_cast<float>(std::sqrt(std::max(0., 1 - cosine_of_cap * cosine_of_cap))));
    slope.push_back(static_cast<float>(slope_of_cap));
  }
  // What a ball at an offset covers of one in the origin.
  void add_ball(double radius, const glm::dvec3 &offset, double other_radius) {
    const double distance = glm::length(offset);
    if (distance >= radius + other_radius) return;
    const double c = (radius * radius + distance * distance - other_radius * other_radius) / (2 * radius * distance);
    add(offset / distance, c, radius * distance * std::sqrt(std::max(0., 1 - c * c)) / other_radius);
  }
  bool cover(const glm::dvec3 &direction) const {
    for (size_t k = 0; k < x.size(); ++k)
      if (glm::dot(direction, glm::dvec3(x[k], y[k], z[k])) > cosine[k]) return true;
    return false;
  }
  bool are_said_to_cover_all() const {
    Caps padded = *this;
    for (int k = 0; k < base::kPackSize; ++k) padded.add(glm::dvec3(0), 2, 0);
    std::vector<float> room[base::CoveredSphere::kLevels];
    float *bounds[base::CoveredSphere::kLevels];
    for (int level = 0; level < base::CoveredSphere::kLevels; ++level) {
      room[level].resize(padded.x.size());
      bounds[level] = room[level].data();
    }
    const Vec3<const float *> axes(padded.x.data(), padded.y.data(), padded.z.data());
    return base::CoveredSphere(axes, padded.cosine.data(), padded.sine.data(), padded.slope.data(), count(),
                               base::least_covered_depth(3), bounds)
        .is_covered();
  }
};

glm::dvec3 random_direction(std::mt19937 &random) {
  std::normal_distribution<double> normal;
  return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

TEST(CoveredSphere, HasNoHole) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> some(0, 1);
  int sets_but_for_the_hole = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const glm::dvec3 hole = random_direction(random);
    const double width = std::pow(10, -4 * some(random));  // 1 to .0001 radians
    Caps caps;
    for (int k = 0; k < 60; ++k) {
      const glm::dvec3 axis = random_direction(random);
      const double angle = std::acos(glm::dot(axis, hole)) - width;
      if (angle > 0) caps.add(axis, std::cos(angle));
    }
    ASSERT_FALSE(caps.are_said_to_cover_all()) << "trial " << trial << ", hole of " << width;
    caps.add(hole, std::cos(width + 0.5));
    sets_but_for_the_hole += caps.are_said_to_cover_all();
  }
  EXPECT_GT(sets_but_for_the_hole, 10000);  // it was the hole that was found
}

TEST(CoveredSphere, OfAFewCaps) {
  Caps caps;
  caps.add({0, 0, 1}, -0.1);
  EXPECT_FALSE(caps.are_said_to_cover_all());
  caps.add({0, 0, -1}, 0);  // and meets the other one in a band
  EXPECT_TRUE(caps.are_said_to_cover_all());
  Caps halves;  // which only touch
  halves.add({0, 0, 1}, 0);
  halves.add({0, 0, -1}, 0);
  EXPECT_FALSE(halves.are_said_to_cover_all());
}

// A ball that almost coincides covers a half, but nowhere is there more of it than rounding.
TEST(CoveredSphere, OfBallsThatAlmostCoincide) {
  Caps caps;
  caps.add_ball(3, {0, 0, -1}, 3.5);
  EXPECT_FALSE(caps.are_said_to_cover_all());
  Caps with_a_twin = caps, with_another = caps;
  with_a_twin.add_ball(3, {0, 0, 2e-5}, 3);
  EXPECT_FALSE(with_a_twin.are_said_to_cover_all());
  with_another.add_ball(3, {0, 0, 0.5}, 3);
  EXPECT_TRUE(with_another.are_said_to_cover_all());
}

// By directions tried one by one.
TEST(CoveredSphere, OfCrambin) {
  const Atoms atoms = crambin();
  const double probe = 1.4;
  std::mt19937 random(2);
  std::vector<glm::dvec3> directions(3000);
  for (glm::dvec3 &d : directions) d = random_direction(random);
  int buried = 0, found = 0;
  for (size_t i = 0; i < atoms.size(); ++i) {
    const auto center = [&](size_t k) {
      return glm::dvec3(atoms.positions[3 * k], atoms.positions[3 * k + 1], atoms.positions[3 * k + 2]);
    };
    Caps caps;
    const double radius = atoms.radii[i] + probe;
    for (size_t k = 0; k < atoms.size(); ++k)
      if (k != i) caps.add_ball(radius, center(k) - center(i), atoms.radii[k] + probe);
    const bool is_buried =
        std::all_of(directions.begin(), directions.end(), [&](const glm::dvec3 &d) { return caps.cover(d); });
    const bool is_found = caps.are_said_to_cover_all();
    ASSERT_LE(is_found, is_buried) << "atom " << i;
    buried += is_buried, found += is_found;
  }
  EXPECT_GT(buried, 50);
  EXPECT_GT(found, 0.75 * buried);
}

}  // namespace
