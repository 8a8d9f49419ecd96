// SPDX-License-Identifier: MIT
// Channels of empty space thinner than the spacing, between balls: a lattice edge with both ends inside that passes
// through a gap gets one end, the shallower one, marked outside. The twin of thin walls (thin_walls.h), for the
// surfaces of balls themselves, where the gaps of an edge are known exactly.
#pragma once

#include "surface/stages/marching_cubes.h"
#include "surface/stages/near_balls.h"
#include "surface/stages/projection.h"

namespace quickses {

// A narrower gap, in spacings, is none.
constexpr float kLeastGap = 0.02f;

// The balls near a lattice point. Where more than so many atoms are met or near, nothing is done.
struct NearBalls {
  static constexpr int kMost = 48;
  static constexpr uint32_t kMostMet = 2048;
  uint32_t place[kMost];
  int count = 0;
  float depth = -kFarAway;  // of the point, in the deepest
};

// Those within `reach` of a point, as long as take(ball) of those that cover it says that more matter; else false.
template <class Take>
QSES_FN bool find_near_balls(const FeatureView &f, const Vec3<float> &x, float reach, NearBalls *near,
                             const Take &take) {
  return for_balls_near(f, x, x, reach, NearBalls::kMostMet, [&](uint32_t place, const Sphere &ball) {
    const float longest = ball.radius + reach;
    if (length_squared(x - Vec3<float>(ball.center)) > longest * longest) return true;
    const float depth = ball_depth(ball, x);
    near->depth = maximum(near->depth, depth);
    if (near->count == NearBalls::kMost || (depth > 0.f && !take(ball))) return false;
    near->place[near->count++] = place;
    return true;
  });
}

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
  const glm::ivec3 away(p.x >> 3, p.y >> 3, p.z >> 3);
  const int owner = (p.x | p.y | p.z) & ~7 ? bricks.find(bricks.lattice.brick_at(bricks.linear[brick]) + away)
                                           : static_cast<int>(brick);
  if (owner < 0) return missing;
  const int x = p.x & 7, y = p.y & 7, z = p.z & 7;
  const uint64_t word = signs[static_cast<size_t>(owner) * kLeavesPerBrick + static_cast<size_t>(leaf_of(x, y, z))];
  return (word >> leaf_bit(x & 3, y & 3, z & 3) & 1) != 0;
}

// Finds the lattice points that are to be outside: of an edge with a gap the end that is shallower, of two that are as
// deep but for rounding the lower one.
struct MarkThinChannels {
  FeatureView features;
  BrickSet bricks;
  const uint64_t *signs;
  uint64_t *marks;  // numbered like signs
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const size_t word = i / 64;
    const int bit = static_cast<int>(i % 64);
    if (!(signs[word] >> bit & 1)) return;
    const uint32_t brick = static_cast<uint32_t>(word / kLeavesPerBrick);
    const Lattice &lattice = bricks.lattice;
    const float h = lattice.spacing;
    const glm::ivec3 in_brick = brick_point(static_cast<int>(word % kLeavesPerBrick), bit);
    const glm::ivec3 p = lattice.first_point(lattice.brick_at(bricks.linear[brick])) + in_brick;
    const Vec3<float> x = lattice.position(p.x, p.y, p.z);
    // A ball with both ends covers an edge. Of most points one that is near has all of them.
    const float r = features.parameters.max_radius;
    const CellBox row = cells_around(features.atoms.cells, x - Vec3<float>(r, 0.f, 0.f), x + Vec3<float>(r, 0.f, 0.f));
    const ItemRun run = features.atoms.run(row.x0, row.x1, row.y0, row.z0);
    if (run.end - run.begin > NearBalls::kMostMet) return;
    for (uint32_t k = run.begin; k < run.end; ++k) {
      const Sphere ball = load(features.atoms.items + k);
      const float deep = ball.radius - h;
      if (deep > 0.f && length_squared(x - Vec3<float>(ball.center)) < deep * deep) return;
    }
    uint32_t open = 0;  // edges whose other end is inside, too
    for (int k = 0; k < 6; ++k) {
      const int s = k & 1 ? -1 : 1;
      const glm::ivec3 step(k >> 1 == 0 ? s : 0, k >> 1 == 1 ? s : 0, k >> 1 == 2 ? s : 0);
      open |= static_cast<uint32_t>(sign_at(bricks, brick, in_brick + step, signs, false)) << k;
    }
    const auto close = [&](const Sphere &ball) {
      for (int k = 0; k < 6; ++k)
        if (open >> k & 1 && length_squared(x + axis_way(k, h) - Vec3<float>(ball.center)) < ball.radius * ball.radius)
          open &= ~(1u << k);
      return open != 0;
    };
    for (uint32_t k = run.begin; k < run.end && open; ++k) {
      const Sphere ball = load(features.atoms.items + k);
      if (length_squared(x - Vec3<float>(ball.center)) < ball.radius * ball.radius) close(ball);
    }
    NearBalls near;
    if (!open || !find_near_balls(features, x, h, &near, close)) return;
    for (int k = 0; k < 6; ++k) {
      const Vec3<float> way = axis_way(k, h);
      if (!(open >> k & 1)) continue;
      const Gap gap = first_gap(features, near, x, way);
      if (!gap.is_open() || gap.end >= 1.f) continue;
      float other = -kFarAway;
      for (int j = 0; j < near.count; ++j)
        other = maximum(other, ball_depth(load(features.atoms.items + near.place[j]), x + way));
      constexpr float kAsDeep = 1e-4f;
      if (other < near.depth - kAsDeep || (k & 1 && other < near.depth + kAsDeep)) continue;
      atomic_or(marks + word, uint64_t(1) << bit);
      return;
    }
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
  if (!find_near_balls(f, x, h, &near, [](const Sphere &) { return true; })) return x;
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
