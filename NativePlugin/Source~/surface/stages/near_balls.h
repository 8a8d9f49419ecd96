// SPDX-License-Identifier: MIT
// The balls that may come near a place, one after the other, or those that do.
#pragma once

#include "surface/stages/projection.h"

namespace quickses {

// Calls use(place, ball) for the atoms whose balls may come within `reach` of the segment from a to b; false if more
// than most_met are met, or once use() says so.
template <class Use>
QSES_FN bool for_balls_near(const FeatureView &f, const Vec3<float> &a, const Vec3<float> &b, float reach,
                            uint32_t most_met, const Use &use) {
  const Vec3<float> low(minimum(a.x, b.x), minimum(a.y, b.y), minimum(a.z, b.z)),
      high(maximum(a.x, b.x), maximum(a.y, b.y), maximum(a.z, b.z));
  const CellBox box = cells_within(f.atoms.cells, low, high, f.atoms.cells.radii.in_cells + reach);
  uint32_t met = 0;
  return f.atoms.for_each_run(box, [&](const ItemRun &run) {
    met += run.end - run.begin;
    if (met > most_met) return false;
    for (uint32_t k = run.begin; k < run.end; ++k)
      if (!use(k, load(f.atoms.items + k))) return false;
    return true;
  });
}

// The balls near a lattice point. Where more than so many atoms are met or near, nothing is done.
struct NearBalls {
  static constexpr int kMost = 48;
  static constexpr uint32_t kMostMet = 2048;
  uint32_t place[kMost];
  int count = 0;
  float depth = -kFarAway;  // of the point, in the deepest
};

// Of what for_each(use) goes through, the balls within `reach` of a point; false if they are too many.
template <class ForEach>
QSES_FN bool find_near_balls(const ForEach &for_each, const Vec3<float> &x, float reach, NearBalls *near) {
  return for_each([&](uint32_t place, const Sphere &ball) {
    const float longest = ball.radius + reach;
    if (length_squared(x - Vec3<float>(ball.center)) > longest * longest) return true;
    if (near->count == NearBalls::kMost) return false;
    near->depth = maximum(near->depth, ball_depth(ball, x));
    near->place[near->count++] = place;
    return true;
  });
}

}  // namespace quickses
