// SPDX-License-Identifier: MIT
// Distance refinement of the voxel method where its cube is narrow, as it is at usual spacings: a row of lattice points
// along x, with those of the cube on both sides, is one word, and its points outside are bits. The integers are those
// of grid_distance.h, which does the same for cubes of any width.
#pragma once

#include "surface/methods/grid_distance.h"

namespace quickses {

// 9 points and so many on both sides fit a word.
constexpr int kMostRowReach = 11;
inline bool has_near_rows(const GridField &f) { return f.parameters.reach <= kMostRowReach; }

// Around the first points of a brick: 8 along each axis for its own, 9 for the corners of its cells too.
struct NearRows {
  static constexpr int kMostWidth = kBrickEdge + 1 + 2 * kMostRowReach, kMostBricks = 5;
  int32_t brick[kMostBricks * kMostBricks * kMostBricks];  // -1: not active
  uint32_t outside[kMostWidth * kMostWidth];               // by y, then z; bit 0 is the first point of the cube
  uint32_t inside[kBrickEdge * kBrickEdge];                // rows of the brick's own points, for signs
};

// How far the cube reaches around so many points.
struct NearCube {
  int points, reach;
  QSES_FN int width() const { return points + 2 * reach; }
  QSES_FN int bricks_back() const { return (reach + kBrickEdge - 1) / kBrickEdge; }
  QSES_FN int bricks() const { return bricks_back() + (points - 1 + reach) / kBrickEdge + 1; }
  uint64_t rows_of_point() const { return static_cast<uint64_t>(2 * reach + 1) * static_cast<uint64_t>(2 * reach + 1); }
  // The row through a point of the brick.
  QSES_FN int row(int y, int z) const { return y + reach + width() * (z + reach); }
};

// Fills brick and outside. All of the team must call it; it ends with a sync.
template <class Team>
QSES_HOST_DEVICE inline void find_near_rows(const GridField &f, uint32_t brick, const NearCube &cube, const Team &team,
                                            NearRows &near) {
  const int width = cube.width(), back = cube.bricks_back(), bricks = cube.bricks();
  const glm::ivec3 place = f.bricks.place(brick) - glm::ivec3(back);
  for (int k = team.rank(); k < bricks * bricks * bricks; k += team.size())
    near.brick[k] = f.bricks.find(place + glm::ivec3(k % bricks, k / bricks % bricks, k / (bricks * bricks)));
  team.sync();
  const int before = kBrickEdge * back - cube.reach;  // points of the first brick that are not in the cube
  for (int r = team.rank(); r < width * width; r += team.size()) {
    const int y = before + r % width, z = before + r / width;
    const int32_t *const row = near.brick + bricks * ((y >> 3) + bricks * (z >> 3));
    uint64_t bits = 0;
    for (int b = 0; b < bricks; ++b) bits |= uint64_t(outside_row(f, row[b], y & 7, z & 7)) << (kBrickEdge * b);
    near.outside[r] = static_cast<uint32_t>(bits >> before) & ((1u << width) - 1u);
  }
  team.sync();
}

// Sets the bits up to so many places beside a set one.
QSES_FN uint32_t widened(uint32_t bits, int by) {
  for (int run = 1; by > 0;) {
    const int step = by < run ? by : run;
    bits |= bits << step | bits >> step;
    by -= step;
    run += 2 * step;
  }
  return bits;
}

// The points of a row of the brick that have no outside point within reach of the surface, as bits.
QSES_FN uint32_t inside_of_row(const NearRows &near, const NearCube &cube, int32_t max_outside, int y, int z) {
  const int width = cube.width(), reach = cube.reach;
  uint32_t outside = 0;
  for (int dz = -reach; dz <= reach; ++dz)
    for (int dy = -reach; dy <= reach; ++dy) {
      const int left = max_outside - squared(dy) - squared(dz);
      if (left < 0) continue;
      // Of so small numbers, the root's own rounding is far less than what is added.
      const int along = static_cast<int>(square_root(static_cast<float>(left)) + 1e-3f);
      outside |= widened(near.outside[cube.row(y, z) + dy + width * dz], along < reach ? along : reach);
    }
  return ~(outside >> reach) & 0xffu;
}

// Squared distance, in lattice steps, to the nearest outside point of the cube around a point; kNoneInReach if it is
// above the limit.
QSES_FN int32_t nearest_outside(const NearRows &near, const NearCube &cube, const glm::ivec3 &p, int32_t limit) {
  const int width = cube.width(), reach = cube.reach, row = cube.row(p.y, p.z), x = p.x + reach;
  int32_t nearest = limit + 1;
  for (int k = 0; k <= 2 * reach; ++k) {
    const int dz = alternating(k);
    if (squared(dz) >= nearest) break;
    for (int l = 0; l <= 2 * reach; ++l) {
      const int dy = alternating(l);
      const int32_t across = squared(dy) + squared(dz);
      if (across >= nearest) break;
      const uint32_t bits = near.outside[row + dy + width * dz], after = bits >> x, before = bits << (31 - x);
      int along = reach + 1;
      if (after) along = lowest_bit32(after);
      if (before && 31 - highest_bit32(before) < along) along = 31 - highest_bit32(before);
      if (along <= reach && across + squared(along) < nearest) nearest = across + squared(along);
    }
  }
  return nearest <= limit ? nearest : kNoneInReach;
}

}  // namespace quickses
