// SPDX-License-Identifier: MIT
// Exposed arcs and caps against brute force, and the functions they are made with.
#include "surface/exact_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bitset>

namespace {

using namespace exact_fixture;
using exact_reference::length;
using surface_fixture::Atoms;
using surface_fixture::cluster;
using surface_fixture::settings;

constexpr double kPi = 3.14159265358979323846;

// ---- pseudo-angles

TEST(PseudoAngle, GrowsWithTheAngle) {
  float last = -1.f;
  for (int k = 0; k < 5000; ++k) {
    const double angle = 2 * kPi * k / 5000;
    const float c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
    const float p = pseudo_angle(c, s);
    ASSERT_GE(p, 0.f);
    ASSERT_LT(p, 4.f);
    ASSERT_GT(p, last) << angle;
    last = p;
    const glm::vec2 d = pseudo_direction(p);
    ASSERT_NEAR(d.x, c, 1e-6f);
    ASSERT_NEAR(d.y, s, 1e-6f);
    ASSERT_NEAR(pseudo_angle(7.5f * c, 7.5f * s), p, 1e-6f);
  }
  EXPECT_EQ(pseudo_angle(1.f, 0.f), 0.f);
  EXPECT_EQ(pseudo_angle(0.f, 1.f), 1.f);
  EXPECT_EQ(pseudo_angle(-1.f, 0.f), 2.f);
  EXPECT_EQ(pseudo_angle(0.f, -1.f), 3.f);
  EXPECT_LT(pseudo_angle(1.f, -1e-20f), 4.f);
}

TEST(PseudoAngle, Way) {
  EXPECT_EQ(pseudo_way(1.f, 3.f), 2.f);
  EXPECT_EQ(pseudo_way(3.f, 1.f), 2.f);
  EXPECT_EQ(pseudo_way(3.5f, 0.25f), 0.75f);
  EXPECT_EQ(pseudo_way(2.f, 2.f), 0.f);
}

// ---- intervals, against a bitmap of the whole turn

TEST(ExposedIntervals, AgainstABitmap) {
  std::mt19937 random(1);
  constexpr size_t kTicks = 400;  // per turn; stretches begin and end between ticks
  const auto at = [](size_t tick) { return 4.f * (static_cast<float>(tick) + 0.5f) / static_cast<float>(kTicks); };
  const auto border = [](size_t tick) { return 4.f * static_cast<float>(tick % kTicks) / static_cast<float>(kTicks); };
  size_t several = 0, covered = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    Interval storage[64];
    ExposedIntervals<Interval *> exposed{storage, 64};
    std::bitset<kTicks> free;
    free.set();
    const size_t stretches = 1 + random() % 12, longest = 1 + random() % (random() % 2 ? kTicks - 1 : 60);
    for (size_t s = 0; s < stretches; ++s) {
      const size_t begin = random() % kTicks, size = 1 + random() % longest;
      exposed.cover(border(begin), border(begin + size));
      for (size_t k = 0; k < size; ++k) free.reset((begin + k) % kTicks);
      ASSERT_FALSE(exposed.overflow);
      ASSERT_EQ(exposed.empty(), free.none());
      std::bitset<kTicks> found;
      for (int i = 0; i < exposed.count; ++i)
        for (size_t tick = 0; tick < kTicks; ++tick)
          if (pseudo_way(storage[i].begin, at(tick)) < pseudo_way(storage[i].begin, storage[i].end)) {
            ASSERT_FALSE(found[tick]) << "intervals overlap";
            found.set(tick);
          }
      ASSERT_EQ(found, free);
    }
    several += exposed.count > 1 ? 1 : 0;
    covered += exposed.empty() ? 1 : 0;
  }
  EXPECT_GT(several, 100u);
  EXPECT_GT(covered, 100u);
}

// Ends that are the same, or next to each other, as many stretches of a lattice's circles have: what is left is that of
// whole numbers, whatever the order.
TEST(ExposedIntervals, OfEndsThatNearlyMeetInAnyOrder) {
  std::mt19937 random(2);
  size_t covered = 0, slivers = 0, over_zero = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    std::vector<float> ends;
    for (const float p : {0.f, 0.7f, 1.f, 2.5f, 3.3f}) {
      const float next = std::nextafter(p, 4.f);
      for (const float q : {p, next, std::nextafter(next, 4.f)}) ends.push_back(q);
    }
    ends.push_back(std::nextafter(4.f, 0.f));
    const size_t n = ends.size(), stretches = 1 + random() % 6;
    std::vector<std::pair<size_t, size_t>> given;  // by number of the end
    while (given.size() < stretches) {
      const size_t begin = random() % n, end = random() % n;
      if (begin != end) given.emplace_back(begin, end);
    }
    // Whether what begins at an end is free, up to the next one.
    std::vector<bool> free(n, true);
    for (const auto &stretch : given)
      for (size_t k = stretch.first; k != stretch.second; k = (k + 1) % n) free[k] = false;
    std::vector<std::pair<float, float>> expected;
    bool is_any_free = false;
    for (size_t k = 0; k < n; ++k) {
      is_any_free = is_any_free || free[k];
      if (!free[k] || free[(k + n - 1) % n]) continue;
      size_t end = k;
      while (free[end]) end = (end + 1) % n;
      const double way = static_cast<double>(ends[end]) - static_cast<double>(ends[k]) + (end < k ? 4 : 0);
      if (way > 5e-7) expected.emplace_back(ends[k], ends[end]);
      slivers += way > 5e-7 ? 0 : 1;
      over_zero += end < k ? 1 : 0;
    }
    covered += is_any_free ? 0 : 1;
    for (int order = 0; order < 3; ++order) {
      std::shuffle(given.begin(), given.end(), random);
      Interval storage[16];
      ExposedIntervals<Interval *> exposed{storage, 16};
      for (const auto &stretch : given) exposed.cover(ends[stretch.first], ends[stretch.second]);
      ASSERT_FALSE(exposed.overflow);
      ASSERT_EQ(exposed.empty(), !is_any_free);
      exposed.settle();
      std::vector<std::pair<float, float>> found;
      for (int k = 0; k < exposed.count; ++k) found.emplace_back(storage[k].begin, storage[k].end);
      ASSERT_EQ(found, expected) << trial;
    }
  }
  EXPECT_GT(covered, 100u);
  EXPECT_GT(slivers, 100u);
  EXPECT_GT(over_zero, 100u);
}

// The way around is rounded to a whole turn there.
TEST(ExposedIntervals, OfAllButAPoint) {
  Interval storage[4];
  ExposedIntervals<Interval *> exposed{storage, 4};
  exposed.cover(0.5f, 0.75f);
  exposed.cover(std::nextafter(1.f, 2.f), 1.f);
  ASSERT_EQ(exposed.count, 1);
  EXPECT_EQ(storage[0].begin, 1.f);
  EXPECT_EQ(storage[0].end, std::nextafter(1.f, 2.f));
  exposed.settle();
  EXPECT_TRUE(exposed.empty());
}

TEST(ExposedIntervals, OverflowIsTold) {
  Interval storage[2];
  ExposedIntervals<Interval *> exposed{storage, 2};
  EXPECT_FALSE(exposed.empty());
  exposed.cover(0.f, 0.1f);
  exposed.cover(1.f, 1.1f);
  EXPECT_FALSE(exposed.overflow);
  exposed.cover(2.f, 2.1f);
  EXPECT_TRUE(exposed.overflow);
}

// ---- arcs

Point at_angle(const Arc &arc, double angle) {
  return point(arc.center) +
         static_cast<double>(arc.radius) * (std::cos(angle) * point(arc.middle) + std::sin(angle) * point(arc.side));
}
double half_angle(const Arc &arc) {
  return std::atan2(static_cast<double>(arc.sin_half), static_cast<double>(arc.cos_half));
}

TEST(Arcs, DistanceAndNearestPoint) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> along(-1.f, 1.f);
  for (int trial = 0; trial < 300; ++trial) {
    glm::vec3 m(along(random), along(random), along(random)), s(along(random), along(random), along(random));
    m = glm::normalize(m);
    s = glm::normalize(s - m * glm::dot(s, m));
    const double half = trial % 5 == 0 ? kPi : kPi * (0.02 + 0.95 * std::abs(static_cast<double>(along(random))));
    const Arc arc = {glm::vec3(3.f, -2.f, 5.f),
                     0.5f + std::abs(2.f * along(random)),
                     m,
                     half == kPi ? -1.f : static_cast<float>(std::cos(half)),
                     s,
                     half == kPi ? 0.f : static_cast<float>(std::sin(half))};
    const Sphere bound = arc_bound(arc);
    for (int k = 0; k < 100; ++k) {
      const Vec3<float> x = Vec3<float>(arc.center + 4.f * glm::vec3(along(random), along(random), along(random)));
      double best = 1e9;
      const Point p{static_cast<double>(x.x), static_cast<double>(x.y), static_cast<double>(x.z)};
      for (int i = 0; i <= 2000; ++i) best = std::min(best, length(at_angle(arc, half * (i / 1000.0 - 1)) - p));
      const double d2 = static_cast<double>(arc_distance2(arc, x));
      ASSERT_NEAR(std::sqrt(std::max(0.0, d2)), best, 4e-3);
      const ArcPoint y = nearest_on_arc(arc, x);
      const Point q = point(to_glm(y.position));
      ASSERT_NEAR(length(q - p), best, 4e-3);
      ASSERT_NEAR(length(q - point(arc.center)), static_cast<double>(arc.radius), 1e-5);
      ASSERT_LE(length(q - point(bound.center)), static_cast<double>(bound.radius) + 1e-5);
      const double to_end = std::min(length(q - at_angle(arc, half)), length(q - at_angle(arc, -half)));
      ASSERT_TRUE(!y.at_end || to_end < 1e-5);
    }
    // On the axis of the circle every point is as near.
    const Vec3<float> axis(glm::cross(m, s));
    const Vec3<float> x = Vec3<float>(arc.center) + axis * 0.7f;
    ASSERT_NEAR(arc_distance2(arc, x), arc.radius * arc.radius + 0.49f, 1e-4f);
    const ArcPoint y = nearest_on_arc(arc, x);
    ASSERT_NEAR(length_squared(y.position - x), arc.radius * arc.radius + 0.49f, 1e-4f);
  }
}

struct Features {
  ExactRun run;
  FeatureView view;
  std::vector<exact_reference::Ball> balls;  // centred frame
  Features(const Atoms &atoms, double probe) : run(atoms, settings(0.5, probe)), view(run.features()) {
    for (size_t i = 0; i < atoms.size(); ++i) {
      const auto c = atoms.center(i);
      balls.push_back({{c[0] - run.lattice.center_x, c[1] - run.lattice.center_y, c[2] - run.lattice.center_z},
                       static_cast<double>(atoms.radii[i]) + static_cast<double>(static_cast<float>(probe))});
    }
  }
};

// How many spheres a point lies on, and how deep it is in the deepest ball.
struct Contact {
  int spheres;
  double depth;
};
Contact contact(const std::vector<exact_reference::Ball> &balls, const Point &x, double tolerance) {
  Contact c{0, -1e9};
  for (const auto &b : balls) {
    const double depth = b.radius - length(x - b.center);
    c.depth = std::max(c.depth, depth);
    c.spheres += std::abs(depth) < tolerance ? 1 : 0;
  }
  return c;
}

void check_arcs(const Atoms &atoms, double probe) {
  const Features f(atoms, probe);
  const exact_reference::Boundary boundary(atoms, static_cast<double>(static_cast<float>(probe)));
  const size_t arcs = f.view.arc_bounds.count;
  // Single precision: ends of arcs are ill-conditioned where three spheres meet at a flat angle.
  constexpr double kOn = 2e-4, kDeep = 2e-4;
  size_t joints = 0, ends = 0;
  double arc_length = 0;
  std::vector<Point> free_ends;
  for (size_t k = 0; k < arcs; ++k) {
    const Arc &arc = f.view.arcs[k];
    const double half = half_angle(arc);
    ASSERT_GT(arc.radius, 0.f);
    ASSERT_NEAR(glm::length(arc.middle), 1.f, 1e-5f);
    ASSERT_NEAR(glm::length(arc.side), 1.f, 1e-5f);
    ASSERT_NEAR(glm::dot(arc.side, arc.middle), 0.f, 1e-5f);
    ASSERT_NEAR(arc.cos_half * arc.cos_half + arc.sin_half * arc.sin_half, 1.f, 1e-5f);
    arc_length += 2 * half * static_cast<double>(arc.radius);
    for (int i = -8; i <= 8; ++i) {
      const Point x = at_angle(arc, half * i / 8);
      const Contact c = contact(f.balls, x, kOn);
      ASSERT_GE(c.spheres, 2) << "arc " << k;
      ASSERT_LT(c.depth, kDeep) << "arc " << k;
      const Sphere &bound = f.view.arc_bounds.items[k];
      ASSERT_LE(length(x - point(bound.center)), static_cast<double>(bound.radius) + 1e-5);
    }
    ASSERT_LE(f.view.arc_bounds.items[k].radius, f.view.max_arc_bound);
    if (arc.cos_half <= -1.f) continue;  // a full circle
    for (double side : {-1.0, 1.0}) {
      const Point x = at_angle(arc, side * half);
      if (contact(f.balls, x, 1e-3).spheres >= 3) {
        ++ends;
        free_ends.push_back(x);
        continue;
      }
      // The joint of an arc that was split: another arc of the same circle goes on from here.
      bool joined = false;
      for (size_t other = 0; other < arcs && !joined; ++other) {
        const Arc &b = f.view.arcs[other];
        if (other == k || glm::length(b.center - arc.center) + std::abs(b.radius - arc.radius) > 1e-5f) continue;
        joined = length(at_angle(b, half_angle(b)) - x) < 1e-4 || length(at_angle(b, -half_angle(b)) - x) < 1e-4;
      }
      ASSERT_TRUE(joined) << "an end of arc " << k << " lies on no third sphere";
      ++joints;
    }
  }

  // Every exposed triple point is the end of some arc.
  size_t missing = 0;
  for (const auto &t : boundary.triple_points()) {
    const Point x = t.position - Point{f.run.lattice.center_x, f.run.lattice.center_y, f.run.lattice.center_z};
    double nearest = 1e9;
    for (const Point &e : free_ends) nearest = std::min(nearest, length(e - x));
    missing += nearest > 2e-3 ? 1 : 0;
  }
  EXPECT_EQ(missing, 0u);
  EXPECT_GT(ends, 10u);

  // All arcs together are as long as what is exposed of all circles.
  double exposed_length = 0;
  for (const auto &c : boundary.circles()) {
    const Point e1 = exact_reference::perpendicular(c.axis), e2 = exact_reference::cross(c.axis, e1);
    constexpr int kSteps = 2000;
    for (int k = 0; k < kSteps; ++k) {
      const double a = 2 * kPi * (k + 0.5) / kSteps;
      if (boundary.exposed(c.i, c.center + c.radius * (std::cos(a) * e1 + std::sin(a) * e2)))
        exposed_length += 2 * kPi * c.radius / kSteps;
    }
  }
  EXPECT_NEAR(arc_length, exposed_length, 2e-3 * exposed_length);
}

TEST(Arcs, OfFewAtoms) {
  Atoms atoms;
  atoms.add(0, 0, 0, 1.7).add(2.9, 0, 0, 1.55).add(1.2, 2.7, 0.2, 1.8).add(1.4, 1.1, 2.2, 1.2);
  check_arcs(atoms, 1.4);
  check_arcs(surface_fixture::turned(atoms, 10, -20, 30), 1.4);
}
TEST(Arcs, OfClusters) {
  for (unsigned seed : {41u, 42u, 43u}) check_arcs(cluster(120, seed), 1.4);
  check_arcs(cluster(80, 44), 0.3);
  check_arcs(cluster(60, 45), 4.0);
}
TEST(Arcs, OfCrambin) { check_arcs(surface_fixture::crambin(), 1.4); }

// ---- caps: exposure of points of a sphere

TEST(Caps, TellWhatIsExposed) {
  for (unsigned seed : {51u, 52u}) {
    const Features f(cluster(150, seed), 1.4);
    const auto directions = exact_reference::fibonacci_directions(300);
    size_t exposed_points = 0, buried = 0;
    for (uint32_t i = 0; i < f.view.atoms.count; ++i) {
      const Sphere &self = f.view.atoms.items[i];
      if (self.center.x > 0.5f * kFarAway) continue;  // contained
      bool any = false;
      for (const Point &d : directions) {
        const Point x = point(self.center) + static_cast<double>(self.radius) * d;
        const double depth = contact(f.balls, x, 0).depth;
        if (std::abs(depth) > 1e-12 && std::abs(depth) < 1e-4 && depth > 2e-6) continue;  // within the tolerance
        const bool expected = depth < 2e-6;
        const Vec3<float> u(static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z));
        const bool found = is_exposed(f.view, i, u, 1.f);
        ASSERT_EQ(found, expected) << "atom " << i << " depth " << depth;
        any = any || expected;
        exposed_points += expected ? 1 : 0;
      }
      ASSERT_TRUE(!any || f.view.cap_ranges[i].count != kBuriedAtom);
      ASSERT_EQ(f.view.exposed[i] != 0, f.view.cap_ranges[i].count != kBuriedAtom);
      buried += f.view.cap_ranges[i].count == kBuriedAtom ? 1 : 0;
    }
    EXPECT_GT(exposed_points, 500u);
    EXPECT_GT(buried, 10u);
  }
}

}  // namespace
