// SPDX-License-Identifier: MIT
// What splits at creases are made of, one by one: circles and corners of spheres, pieces of triangles, and which
// vertices snap onto a crease.
#include "surface/exact_reference.h"
#include "surface/stages/crease_snaps.h"
#include "surface/stages/edge_splits.h"
#include "surface/stages/sphere_sheets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace {

using Vector = quickses::Vec3<float>;

exact_reference::Point to_point(const Vector &v) { return {v.x, v.y, v.z}; }
double distance(const Vector &a, const Vector &b) { return exact_reference::length(to_point(a) - to_point(b)); }
double depth_in(const quickses::Sphere &ball, const Vector &x) {
  return static_cast<double>(ball.radius) - distance(Vector(ball.center), x);
}

TEST(SphereCircles, NearestPointsLieOnTheSpheres) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> number(-1, 1);
  const auto place = [&](float size) {
    return glm::vec3(size * number(random), size * number(random), size * number(random));
  };
  size_t circles = 0, corners = 0, apart = 0;
  for (int k = 0; k < 3000; ++k) {
    const quickses::Sphere a{place(2), 2 + number(random)}, b{place(2), 2 + number(random)},
        c{place(3), 2 + number(random)};
    const Vector x(place(4));
    const quickses::SphereCircle circle = quickses::circle_of_spheres(a, b);
    Vector nearest, corner;
    if (circle.radius <= 0.f) {
      ++apart;
      EXPECT_FALSE(quickses::nearest_on_circle(circle, x, &nearest));
      EXPECT_FALSE(quickses::nearest_corner(circle, c, x, &corner));
      continue;
    }
    ++circles;
    ASSERT_TRUE(quickses::nearest_on_circle(circle, x, &nearest));
    EXPECT_NEAR(depth_in(a, nearest), 0, 1e-4);
    EXPECT_NEAR(depth_in(b, nearest), 0, 1e-4);
    // All around: where the circle is nearest to x, and where it enters the third ball.
    const exact_reference::Point axis = to_point(circle.axis), u = exact_reference::perpendicular(axis),
                                 v = exact_reference::cross(axis, u);
    double least = 1e9, shallowest = 1e9, deepest = -1e9, nearest_entry = 1e9, depth_before = 0;
    constexpr int kSteps = 720;
    for (int step = 0; step <= kSteps; ++step) {
      const double angle = 2 * std::acos(-1.0) * step / kSteps, r = static_cast<double>(circle.radius);
      const exact_reference::Point at = to_point(circle.center) + r * std::cos(angle) * u + r * std::sin(angle) * v;
      const double from_x = exact_reference::length(at - to_point(x)),
                   depth = static_cast<double>(c.radius) - exact_reference::length(at - to_point(Vector(c.center)));
      least = std::min(least, from_x);
      shallowest = std::min(shallowest, depth);
      deepest = std::max(deepest, depth);
      if (step > 0 && (depth > 0) != (depth_before > 0)) nearest_entry = std::min(nearest_entry, from_x);
      depth_before = depth;
    }
    EXPECT_LE(distance(nearest, x), least + 1e-4);
    if (quickses::nearest_corner(circle, c, x, &corner)) {
      ++corners;
      for (const quickses::Sphere &ball : {a, b, c}) EXPECT_NEAR(depth_in(ball, corner), 0, 1e-3);
      EXPECT_LE(distance(corner, x), nearest_entry + 0.05);
      EXPECT_LT(shallowest, 1e-3);
      EXPECT_GT(deepest, -1e-3);
    } else {
      EXPECT_TRUE(shallowest > -1e-3 || deepest < 1e-3) << "they meet";
    }
  }
  EXPECT_GT(circles, 1000u);
  EXPECT_GT(corners, 500u);
  EXPECT_GT(apart, 100u);
}

// On the axis no point of the circle is nearer than others, and a ball there meets it everywhere or nowhere.
TEST(SphereCircles, HaveNoNearestPointOnTheirAxis) {
  const quickses::Sphere a{glm::vec3(0, 0, -1), 2}, b{glm::vec3(0, 0, 1), 2};
  const quickses::SphereCircle circle = quickses::circle_of_spheres(a, b);
  ASSERT_NEAR(static_cast<double>(circle.radius), std::sqrt(3.0), 1e-6);
  Vector nearest;
  EXPECT_FALSE(quickses::nearest_on_circle(circle, {0.f, 0.f, 0.5f}, &nearest));
  for (const float radius : {1.f, 1.7320508f, 3.f})
    EXPECT_FALSE(quickses::nearest_corner(circle, {glm::vec3(0, 0, 0), radius}, {1.f, 0.f, 0.f}, &nearest));
}

double least_angle(const exact_reference::Point &a, const exact_reference::Point &b, const exact_reference::Point &c) {
  const exact_reference::Point corner[3] = {a, b, c};
  double least = 9;
  for (int k = 0; k < 3; ++k) {
    const auto u = corner[(k + 1) % 3] - corner[k], v = corner[(k + 2) % 3] - corner[k];
    least = std::min(least, std::atan2(exact_reference::length(exact_reference::cross(u, v)), dot(u, v)));
  }
  return least;
}

// Whatever is split: the pieces cover the triangle, none of them reversed, and are as many as room is made for.
TEST(CutTriangles, ArePiecesOfTheTriangle) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> part(0.08f, 0.92f), number(-1, 1);
  for (int k = 0; k < 300; ++k) {
    Vector x[7] = {{0.f, 0.f, 0.f}, {1.f, 0.f, 0.f}, {number(random), 0.2f + part(random), 0.f}};
    for (int e = 0; e < 3; ++e) x[3 + e] = x[e] + (x[(e + 1) % 3] - x[e]) * part(random);
    x[6] = (x[0] + x[1] + x[2]) * (1.f / 3.f);
    const auto area = [&](const uint8_t *c) {
      return static_cast<double>(cross(x[c[1]] - x[c[0]], x[c[2]] - x[c[0]]).z);
    };
    const uint8_t whole[3] = {0, 1, 2};
    for (int mask = 0; mask < 16; ++mask) {
      const bool on[3] = {(mask & 1) != 0, (mask & 2) != 0, (mask & 4) != 0}, within = mask >= 8;
      const quickses::Pieces pieces = quickses::cut_triangle(on[0], on[1], on[2], within, [&](int c) { return x[c]; });
      const auto edge = [&](int e) { return on[e] ? 1u : quickses::kNoNumber; };
      const quickses::TriangleSplits splits{{edge(0), edge(1), edge(2)}, within};
      ASSERT_EQ(pieces.count, 1 + splits.new_triangles()) << mask;
      double sum = 0, slimmest = 9;
      std::set<int> corners;
      for (int p = 0; p < pieces.count; ++p) {
        const uint8_t *const c = pieces.corner[p];
        EXPECT_GT(area(c), 0) << mask;
        sum += area(c);
        corners.insert(c, c + 3);
        slimmest = std::min(slimmest, least_angle(to_point(x[c[0]]), to_point(x[c[1]]), to_point(x[c[2]])));
      }
      EXPECT_NEAR(sum, area(whole), 1e-5) << mask;
      EXPECT_EQ(corners.size(), size_t(3 + splits.edges() + (within ? 1 : 0))) << mask;
      if (splits.edges() != 2 || within) continue;
      // Of the two diagonals of what is left beside the corner between the edges neither gives larger angles.
      const int a = !on[0] ? 0 : !on[1] ? 1 : 2, b = (a + 1) % 3, c = (a + 2) % 3;
      const exact_reference::Point q[4] = {to_point(x[a]), to_point(x[b]), to_point(x[3 + b]), to_point(x[3 + c])};
      const double cut_off = least_angle(q[3], q[2], to_point(x[c]));
      for (const double other : {std::min(least_angle(q[0], q[1], q[2]), least_angle(q[0], q[2], q[3])),
                                 std::min(least_angle(q[0], q[1], q[3]), least_angle(q[1], q[2], q[3]))})
        EXPECT_GE(slimmest, std::min(cut_off, other) - 1e-3) << mask;
    }
  }
}

// The nearer end that may be moved and is near enough.
TEST(Snaps, TakeTheNearerEndThatFits) {
  using quickses::CreasePoint;
  for (const float first : {0.f, 0.2f, 0.39f, 0.41f, 0.5f, 0.7f, 1.f})
    for (const float length : {1.f, 1.6f})
      for (const bool first_fits : {false, true})
        for (const bool second_fits : {false, true}) {
          CreasePoint p{};
          p.kind = CreasePoint::kCrossed;
          p.to_first = first * length;
          p.to_second = (1.f - first) * length;
          p.first_fits = first_fits;
          p.second_fits = second_fits;
          const bool takes_first = first_fits && first < quickses::kSnapPart,
                     takes_second = second_fits && 1.f - first < quickses::kSnapPart;
          EXPECT_EQ(quickses::end_to_snap(p), takes_first ? 0 : takes_second ? 1 : -1) << first;
          p.kind = CreasePoint::kAlong;
          EXPECT_EQ(quickses::end_to_snap(p), -1) << "a vertex on a crease stays there";
          p.kind = CreasePoint::kNone;
          EXPECT_EQ(quickses::end_to_snap(p), -1);
        }
  CreasePoint p{};
  p.kind = CreasePoint::kCrossed;
  p.first_fits = p.second_fits = true;
  p.to_first = p.to_second = 0.f;
  EXPECT_EQ(quickses::end_to_snap(p), -1) << "an edge of no length";
}

TEST(Snaps, OfSeveralPointsTheNearestCounts) {
  using quickses::Snaps;
  EXPECT_LT(Snaps::key(0.1f, 9), Snaps::key(0.2f, 3));
  EXPECT_LT(Snaps::key(0.f, 9), Snaps::key(1e-20f, 3));
  EXPECT_LT(Snaps::key(0.2f, 3), Snaps::key(0.2f, 9)) << "of two as near, that of the first edge";
  EXPECT_LT(Snaps::key(1e6f, quickses::kNoNumber - 1), Snaps::kNone);
  uint64_t nearest[3] = {Snaps::kNone, Snaps::key(0.3f, 1), Snaps::key(0.3f, 0)};
  uint8_t refused[2] = {1, 0};
  quickses::CreaseEdges edges{};
  edges.snap_refused = refused;
  const Snaps snaps{nearest, edges};
  EXPECT_FALSE(snaps.is_wanted(0));
  EXPECT_FALSE(snaps.is_moved(0));
  EXPECT_TRUE(snaps.is_wanted(1) && snaps.is_moved(1));
  EXPECT_TRUE(snaps.is_wanted(2));
  EXPECT_FALSE(snaps.is_moved(2));
}

}  // namespace
