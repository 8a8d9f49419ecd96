// SPDX-License-Identifier: MIT
// Lattice points that thin channels open, against a brute force: every lattice edge and all balls, in double precision.
#include "surface/exact_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

namespace {

using namespace exact_fixture;
using surface_fixture::Atoms;
using surface_fixture::cluster;
using surface_fixture::settings;

struct Ball {
  Point center;
  double radius;
};

double deepest(const std::vector<Ball> &balls, const Point &x) {
  double depth = -1e9;
  for (const Ball &b : balls) depth = std::max(depth, b.radius - length(x - b.center));
  return depth;
}

// Does the first gap between balls on the way from x to y end before y, with every radius that much larger?
bool has_gap(const std::vector<Ball> &balls, const Point &x, const Point &y, double larger) {
  struct Interval {
    double from, to;
  };
  std::vector<Interval> met;
  const Point way = y - x;
  const double length2 = dot(way, way);
  for (const Ball &b : balls) {
    const Point d = x - b.center;
    const double r = b.radius + larger, along = dot(d, way), under = along * along - length2 * (dot(d, d) - r * r);
    if (under > 0) met.push_back({(-along - std::sqrt(under)) / length2, (-along + std::sqrt(under)) / length2});
  }
  std::sort(met.begin(), met.end(), [](const Interval &a, const Interval &b) { return a.from < b.from; });
  double covered = 0;
  for (const Interval &m : met) {
    if (m.to <= covered) continue;
    if (m.from > covered) return m.from < 1 && m.from - covered >= static_cast<double>(kLeastGap);
    covered = m.to;
  }
  return false;
}

using Place = std::tuple<int, int, int>;

void check_marks(const Atoms &atoms, const qses_settings &s, size_t *opened, size_t *ties) {
  SCOPED_TRACE(testing::Message() << atoms.size() << " atoms, spacing " << s.spacing << ", surface " << s.surface);
  ExactRun run(atoms, s);
  const FeatureView features = run.features();
  const BrickSet bricks = find_bricks(run.executor, features, run.lattice);
  const std::vector<uint64_t> signs = run.signs(features, bricks);
  std::vector<uint64_t> marks(signs.size(), 0);
  run.executor.for_each_brick<ChannelScratch>(bricks.count,
                                              MarkThinChannels{features, bricks, signs.data(), marks.data()}, 8);

  std::vector<Ball> balls;
  const double h = static_cast<double>(s.spacing), inflation = static_cast<double>(run.parameters.probe);
  for (size_t i = 0; i < atoms.size(); ++i)
    balls.push_back({exact_reference::point(atoms.center(i)), static_cast<double>(atoms.radii[i]) + inflation});
  struct Inside {
    bool is_marked;
    Point position;
    std::vector<Ball> near;  // that reach the edges
    double depth;
  };
  std::map<Place, Inside> inside;
  for (uint32_t brick = 0; brick < bricks.count; ++brick) {
    const glm::ivec3 first = bricks.lattice.first_point(bricks.place(brick));
    for (int point = 0; point < kBrickPoints; ++point) {
      const size_t word = size_t(brick) * kLeavesPerBrick + static_cast<size_t>(point / 64);
      const bool is_marked = (marks[word] >> point % 64 & 1) != 0;
      if (!(signs[word] >> point % 64 & 1)) {
        ASSERT_FALSE(is_marked) << "an outside point is marked";
        continue;
      }
      const glm::ivec3 p = first + brick_point(point / 64, point % 64);
      Inside in{is_marked, run.to_caller(h * p.x, h * p.y, h * p.z), {}, 0};
      for (const Ball &b : balls)
        if (length(in.position - b.center) < b.radius + 1.01 * h) in.near.push_back(b);
      in.depth = deepest(in.near, in.position);
      inside[{p.x, p.y, p.z}] = in;
    }
  }
  size_t wrong = 0;
  for (const auto &[place, in] : inside) {
    if (in.near.size() > 48 || in.depth < 1e-3) continue;  // too many, or rounding decides
    bool must_be = false, may_be = false;
    for (int k = 0; k < 6; ++k) {
      const int step = k % 2 ? -1 : 1;
      const Place other_place{std::get<0>(place) + (k / 2 == 0 ? step : 0),
                              std::get<1>(place) + (k / 2 == 1 ? step : 0),
                              std::get<2>(place) + (k / 2 == 2 ? step : 0)};
      const auto other = inside.find(other_place);
      if (other == inside.end()) continue;
      constexpr double kRounding = 1e-4;  // Å
      const bool is_open = has_gap(in.near, in.position, other->second.position, kRounding),
                 may_be_open = has_gap(in.near, in.position, other->second.position, -kRounding);
      const double deeper = deepest(in.near, other->second.position) - in.depth;
      const bool is_tie = std::abs(deeper) < 5e-5;
      *ties += is_open && is_tie ? 1 : 0;
      must_be |= is_open && (deeper > 2e-4 || (is_tie && k % 2 == 0));
      may_be |= may_be_open && (deeper > 5e-5 || (deeper > -2e-4 && k % 2 == 0));
    }
    *opened += must_be ? 1 : 0;
    if ((must_be && !in.is_marked) || (in.is_marked && !may_be)) ++wrong;
  }
  EXPECT_EQ(wrong, 0u) << "of " << inside.size() << " points inside";
}

TEST(ThinChannels, AreFoundAndNothingElse) {
  size_t opened = 0, ties = 0;
  for (const qses_surface surface : {QSES_SURFACE_SAS, QSES_SURFACE_VDW})
    for (unsigned seed = 1; seed <= 3; ++seed) {
      check_marks(cluster(40, seed), settings(0.5, 1.4, surface), &opened, &ties);
      check_marks(surface_fixture::scaled(cluster(60, 20 + seed), 1.3), settings(0.8, 0.7, surface), &opened, &ties);
    }
  EXPECT_GT(opened, 300u);
}

// More balls near a brick than are listed for it.
TEST(ThinChannels, AreFoundWhereBricksHaveVeryManyBalls) {
  size_t opened = 0, ties = 0;
  check_marks(cluster(2500, 4), settings(2, 1.4, QSES_SURFACE_VDW), &opened, &ties);
  EXPECT_GT(opened, 300u);
}

// A leaf of a brick that lies in one ball, but for an edge from its corner, which is looked at nevertheless.
TEST(ThinChannels, AreFoundAtCornersOfCoveredLeaves) {
  constexpr double kSpacing = 0.5, kLarge = 7, kSmall = 5, kGap = 0.06;
  size_t opened = 0, ties = 0;
  for (int k = 0; k < 24; ++k) {
    // From the middle of the leaf to the end of the edge; the large ball ends between the corner and that.
    double way[3] = {1.5, 1.5, 1.5};
    way[k % 3] = 2.5;
    for (int d = 0; d < 3; ++d) way[d] *= (k / 3 >> d & 1 ? -1 : 1) / std::sqrt(10.75);
    const auto center = [&](double along) {
      std::array<double, 3> c{};
      for (size_t d = 0; d < 3; ++d) c[d] = 1.5 * kSpacing + way[d] * along;
      return c;
    };
    const double border = 2.75 * kSpacing;
    const auto large = center(border - kLarge), small = center(border + kGap + kSmall);
    Atoms atoms;
    atoms.add(large[0], large[1], large[2], kLarge).add(small[0], small[1], small[2], kSmall);
    check_marks(atoms, settings(kSpacing, 1.4, QSES_SURFACE_VDW), &opened, &ties);
  }
  EXPECT_GT(opened, 24u);
}

// A plane of symmetry halfway between lattice points: of both ends, which are as deep, the lower one is opened.
TEST(ThinChannels, OpenOneOfTwoPointsThatAreAsDeep) {
  size_t opened = 0, ties = 0;
  for (const int turn : {0, 1, 2}) {
    Atoms atoms;
    for (const double along : {0.25 - 1.9, 0.25 + 1.9})
      atoms.add(turn == 0 ? along : 0.1, turn == 1 ? along : 0.2, turn == 2 ? along : 0.05, 1.8);
    check_marks(atoms, settings(0.5, 1.4, QSES_SURFACE_VDW), &opened, &ties);
  }
  EXPECT_GT(ties, 10u);
}

}  // namespace
