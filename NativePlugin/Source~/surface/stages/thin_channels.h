// SPDX-License-Identifier: MIT
// Channels of empty space thinner than the spacing, between balls: a lattice edge with both ends inside that passes
// through a gap gets one end, the shallower one, marked outside. The twin of thin walls (thin_walls.h), for the
// surfaces of balls themselves, where the gaps of an edge are known exactly.
#pragma once

#include "parallel/atomics.h"
#include "surface/stages/marching_cubes.h"
#include "surface/stages/near_balls.h"

namespace quickses {

// A narrower gap, in spacings, is none.
constexpr float kLeastGap = 0.02f;

// Where the line a + t way is in a ball: from t = entry to exit. False if it passes by.
QSES_FN bool meet_ball(const Sphere &ball, const Vec3<float> &a, const Vec3<float> &way, float *entry, float *exit) {
  const Vec3<float> d = a - Vec3<float>(ball.center);
  const float length2 = length_squared(way), b = dot(d, way);
  const float discriminant = b * b - length2 * (length_squared(d) - ball.radius * ball.radius);
  if (!(discriminant > 0.f)) return false;
  const float root = square_root(discriminant), inverse = quotient(1.f, length2);
  *entry = (-b - root) * inverse;
  *exit = (-b + root) * inverse;
  return true;
}

// The first gap between balls on the way from a point inside, in parts of the way; without one it begins at 1.
struct Gap {
  float begin, end;
  QSES_FN bool is_open() const { return end - begin >= kLeastGap; }
};
QSES_FN Gap first_gap(const FeatureView &f, const NearBalls &near, const Vec3<float> &x, const Vec3<float> &way) {
  float entry[NearBalls::kMost], exit[NearBalls::kMost];
  int n = 0;
  for (int k = 0; k < near.count; ++k)
    if (meet_ball(load(f.atoms.items + near.place[k]), x, way, entry + n, exit + n) && exit[n] > 0.f && entry[n] < 1.f)
      ++n;
  float begin = 0.f;
  for (bool goes_on = true; goes_on && begin < 1.f;) {
    goes_on = false;
    for (int k = 0; k < n; ++k)
      if (entry[k] <= begin && exit[k] > begin) begin = exit[k], goes_on = true;
  }
  if (!(begin < 1.f)) return {1.f, 1.f};
  float end = 1.f;
  for (int k = 0; k < n; ++k)
    if (exit[k] > begin) end = minimum(end, entry[k]);
  return {begin, end};
}

// The six ways along the axes, of the length h.
QSES_FN Vec3<float> axis_way(int k, float h) {
  const float s = k & 1 ? -h : h;
  return {k >> 1 == 0 ? s : 0.f, k >> 1 == 1 ? s : 0.f, k >> 1 == 2 ? s : 0.f};
}

// The sign of a point counted from the first one of a brick; `missing` where there is no brick.
QSES_FN bool sign_at(const BrickSet &bricks, uint32_t brick, const glm::ivec3 &p, const uint64_t *signs, bool missing) {
  const LocatedPoint at = bricks.locate(brick, p);
  return at.brick < 0 ? missing : (signs[at.word()] >> at.bit & 1) != 0;
}

// The balls that come near the lattice points of a brick, in any order.
struct BrickBalls {
  static constexpr uint32_t kRoom = 512, kMostMet = 4096;
  uint32_t met, count;  // where they are too many, each point looks for its own
  uint32_t place[kRoom];
  Sphere ball[kRoom];

  QSES_FN bool are_listed() const { return met <= kMostMet && count <= kRoom; }
  // A team together.
  template <class Team>
  QSES_FN void list(const Team &team, const FeatureView &f, const Vec3<float> &low, const Vec3<float> &high,
                    float reach) {
    if (team.rank() == 0) met = count = 0;
    team.sync();
    const CellBox box = cells_within(f.atoms.cells, low, high, f.atoms.cells.radii.in_cells + reach);
    const int rows = f.atoms.runs(box);
    const int share = team.size() % 8 == 0 ? 8 : 1, own = team.rank() % share;  // so many take turns in a row
    for (int row = team.rank() / share; row < rows; row += team.size() / share) {
      const ItemRun run = f.atoms.run(box, row);
      if (run.end == run.begin || (own == 0 && atomic_add(&met, run.end - run.begin) > kMostMet)) continue;
      for (uint32_t k = run.begin + static_cast<uint32_t>(own); k < run.end && k - run.begin <= kMostMet;
           k += static_cast<uint32_t>(share)) {
        const Sphere b = load(f.atoms.items + k);
        const float longest = b.radius + reach;
        if (distance_to_box_squared(Vec3<float>(b.center), low, high) > longest * longest) continue;
        const uint32_t at = atomic_add(&count, uint32_t(1));
        if (at >= kRoom) break;
        place[at] = k;
        ball[at] = b;
      }
    }
    team.sync();
  }
  // Begins with the one that ended the last search: of points that are next to each other it is often the same.
  template <class Use>
  QSES_FN bool for_each(uint32_t *last, const Use &use) const {
    for (uint32_t n = 0, k = *last; n < count; ++n, ++k) {
      if (k >= count) k = 0;
      if (use(place[k], ball[k])) continue;
      *last = k;
      return false;
    }
    return true;
  }
};

// What is looked at for a brick: the balls near it, and its points that have edges which no single ball covers.
struct ChannelScratch {
  BrickBalls balls;
  uint32_t covered;  // leaves of which a single ball covers all points and edges: a bit for each
  uint32_t count;
  uint16_t points[kBrickPoints];  // 64 * leaf + bit, and behind them the edges: a bit for each
};

// Finds the lattice points of each brick that are to be outside: of an edge with a gap the end that is shallower, of
// two that are as deep but for rounding the lower one.
struct MarkThinChannels {
  FeatureView features;
  BrickSet bricks;
  const uint64_t *signs;
  uint64_t *marks;  // numbered like signs

  template <class Team>
  QSES_FN void operator()(const Team &team, ChannelScratch &scratch, size_t number) const {
    const uint32_t brick = static_cast<uint32_t>(number);
    const uint64_t *const words = signs + number * kLeavesPerBrick;
    uint64_t inside = 0;
    for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) inside |= words[leaf];
    if (inside == 0) return;
    const Lattice &lattice = bricks.lattice;
    const glm::ivec3 first = lattice.first_point(bricks.place(brick));
    const auto position = [&](int point) {
      const glm::ivec3 p = first + brick_point(point / 64, point % 64);
      return lattice.position(p.x, p.y, p.z);
    };
    if (team.rank() == 0) scratch.count = scratch.covered = 0;
    scratch.balls.list(team, features, position(0), position(kBrickPoints - 1), lattice.spacing);
    if (scratch.balls.are_listed()) find_covered(team, position(0), scratch);
    team.sync();
    uint32_t last = 0;
    for (int i = team.rank(); i < kBrickPoints; i += team.size()) {
      if (!(words[i / 64] >> i % 64 & 1) || scratch.covered >> i / 64 & 1) continue;
      const Vec3<float> x = position(i);
      uint32_t edges = 0;
      for_balls(scratch.balls, x, &last, [&](const auto &for_each) { edges = uncovered_edges(x, for_each); });
      if (edges) edges &= inner_edges(brick, brick_point(i / 64, i % 64));
      if (!edges) continue;
      scratch.points[atomic_add(&scratch.count, uint32_t(1))] = static_cast<uint16_t>(i | edges << 9);
    }
    team.sync();
    for (uint32_t q = static_cast<uint32_t>(team.rank()); q < scratch.count; q += static_cast<uint32_t>(team.size())) {
      const int i = scratch.points[q] & (kBrickPoints - 1);
      const Vec3<float> x = position(i);
      bool marked = false;
      for_balls(scratch.balls, x, &last,
                [&](const auto &for_each) { marked = is_at_gap(x, scratch.points[q] >> 9, for_each); });
      if (marked) atomic_or(marks + number * kLeavesPerBrick + i / 64, uint64_t(1) << i % 64);
    }
  }

 private:
  template <class Team>
  QSES_FN void find_covered(const Team &team, const Vec3<float> &low, ChannelScratch &scratch) const {
    const float h = bricks.lattice.spacing,
                radius = (1.5f * kRoot3 + 1.f) * h + 1e-3f;  // of leaves and edges from them
    for (uint32_t k = static_cast<uint32_t>(team.rank()); k < scratch.balls.count;
         k += static_cast<uint32_t>(team.size())) {
      const Sphere ball = scratch.balls.ball[k];
      const float least = ball.radius - radius;
      if (!(least > 0.f)) continue;
      uint32_t leaves = 0;
      for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) {
        const glm::ivec3 first = brick_point(leaf, 0);
        const Vec3<float> middle =
            low + Vec3<float>(static_cast<float>(first.x) + 1.5f, static_cast<float>(first.y) + 1.5f,
                              static_cast<float>(first.z) + 1.5f) *
                      h;
        leaves |= static_cast<uint32_t>(length_squared(middle - Vec3<float>(ball.center)) < least * least) << leaf;
      }
      if (leaves) atomic_or(&scratch.covered, leaves);
    }
  }

  // Calls use(for_each), where for_each(use) goes through the balls near a point.
  template <class Use>
  QSES_FN void for_balls(const BrickBalls &balls, const Vec3<float> &x, uint32_t *last, const Use &use) const {
    if (balls.are_listed())
      use([&](const auto &each) { return balls.for_each(last, each); });
    else
      use([&](const auto &each) {
        return for_balls_near(features, x, x, bricks.lattice.spacing, NearBalls::kMostMet, each);
      });
  }

  // Edges from a point that no ball has both ends of: bits in the order of axis_way(). Where atoms crowd, none.
  template <class ForEach>
  QSES_FN uint32_t uncovered_edges(const Vec3<float> &x, const ForEach &for_each) const {
    constexpr uint32_t kAll = 63;
    const float h = bricks.lattice.spacing;
    uint32_t covered = 0;
    const bool all_met = for_each([&](uint32_t, const Sphere &ball) {
      const float r2 = ball.radius * ball.radius;
      const Vec3<float> d = x - Vec3<float>(ball.center);
      if (!(length_squared(d) < r2)) return true;
      for (int k = 0; k < 6; ++k)
        covered |= static_cast<uint32_t>(length_squared(x + axis_way(k, h) - Vec3<float>(ball.center)) < r2) << k;
      return covered != kAll;
    });
    return all_met ? kAll & ~covered : 0;
  }

  // Those whose other end is inside, too.
  QSES_FN uint32_t inner_edges(uint32_t brick, const glm::ivec3 &in_brick) const {
    uint32_t edges = 0;
    for (int k = 0; k < 6; ++k) {
      const int s = k & 1 ? -1 : 1;
      const glm::ivec3 step(k >> 1 == 0 ? s : 0, k >> 1 == 1 ? s : 0, k >> 1 == 2 ? s : 0);
      edges |= static_cast<uint32_t>(sign_at(bricks, brick, in_brick + step, signs, false)) << k;
    }
    return edges;
  }

  template <class ForEach>
  QSES_FN bool is_at_gap(const Vec3<float> &x, uint32_t edges, const ForEach &for_each) const {
    const float h = bricks.lattice.spacing;
    NearBalls near;
    if (!find_near_balls(for_each, x, h, &near)) return false;
    for (int k = 0; k < 6; ++k) {
      if (!(edges >> k & 1)) continue;
      const Vec3<float> way = axis_way(k, h);
      const Gap gap = first_gap(features, near, x, way);
      if (!gap.is_open() || gap.end >= 1.f) continue;
      float other = -kFarAway;
      for (int j = 0; j < near.count; ++j)
        other = maximum(other, ball_depth(load(features.atoms.items + near.place[j]), x + way));
      constexpr float kAsDeep = 1e-4f;
      if (other < near.depth - kAsDeep || (k & 1 && other < near.depth + kAsDeep)) continue;
      return true;
    }
    return false;
  }
};

struct RemoveMarks {
  const uint64_t *marks;
  uint64_t *signs;
  QSES_HOST_DEVICE void operator()(size_t i) const { signs[i] &= ~marks[i]; }
};

// A place in the gap that a marked lattice point stands for: in the nearest one along the axes; the point itself if
// none is found, which rounding may do.
QSES_FN Vec3<float> find_gap(const FeatureView &f, const Vec3<float> &x, float h) {
  NearBalls near;
  const auto for_each = [&](const auto &use) { return for_balls_near(f, x, x, h, NearBalls::kMostMet, use); };
  if (!find_near_balls(for_each, x, h, &near)) return x;
  float nearest = 1.f;
  Vec3<float> found = x;
  for (int k = 0; k < 6; ++k) {
    const Vec3<float> way = axis_way(k, h);
    const Gap gap = first_gap(f, near, x, way);
    if (!gap.is_open() || gap.begin >= nearest) continue;
    nearest = gap.begin;
    found = x + way * (0.5f * (gap.begin + gap.end));
  }
  return found;
}

}  // namespace quickses
