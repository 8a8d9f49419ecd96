// SPDX-License-Identifier: MIT
// CPU kernel: which lattice points of one brick lie inside the exact surface. Only signs are computed, never the
// distance itself: balls are filled in as bit rows, and the points that stay undecided are packed together.
#include "surface/cpu/cpu_candidates.h"
#include "surface/cpu/cpu_leaf_bits.h"

#include <algorithm>

namespace quickses {
namespace QSES_CPU_ISA {
namespace {

// A plane of the brick: bit x + 8 y. Its quarter as 16 bits x + 4 y.
QSES_FN uint64_t quarter(uint64_t plane, int half_x, int half_y) {
  uint64_t v = plane >> (4 * half_x + 32 * half_y) & 0x0f0f0f0full;
  v = (v | v >> 4) & 0x00ff00ffull;
  return (v | v >> 8) & 0xffffull;
}

// In-plane coordinates of the points of a plane, eight at a time: one row of x, and y.
struct PlaneRows {
  Pack x;
  float h;
  QSES_FN explicit PlaneRows(float spacing) : h(spacing) {
    alignas(32) float row[kPackSize];
    for (int k = 0; k < kPackSize; ++k) row[k] = static_cast<float>(k) * spacing;
    x = load_pack(row);
  }
};

// Sets the bits of the lattice points within a ball; the centre is relative to the brick's first point.
QSES_FN void fill_ball(uint64_t planes[8], const PlaneRows &rows, float cx, float cy, float cz, float radius2) {
  const float h = rows.h, side = 7.f * h;
  const float ox = maximum(0.f, maximum(-cx, cx - side)), oy = maximum(0.f, maximum(-cy, cy - side));
  const float nearest = ox * ox + oy * oy;
  if (nearest >= radius2) return;
  uint32_t open = 0;  // planes that the ball meets and that are not full
  for (int z = 0; z < 8; ++z) {
    const float dz = static_cast<float>(z) * h - cz;
    open |= static_cast<uint32_t>(radius2 - dz * dz > nearest && planes[z] != ~uint64_t(0)) << z;
  }
  if (!open) return;
  const Pack dx = rows.x - Pack(cx), dx2 = dx * dx;
  Pack row2[8];
  for (int y = 0; y < 8; ++y) {
    const float dy = static_cast<float>(y) * h - cy;
    row2[y] = dx2 + Pack(dy * dy);
  }
  for (; open; open &= open - 1) {
    const int z = lowest_bit32(open);
    const float dz = static_cast<float>(z) * h - cz;
    const Pack bound(radius2 - dz * dz);
    uint64_t plane = 0;
    for (int y = 0; y < 8; ++y) plane |= static_cast<uint64_t>(lane_bits(row2[y] < bound)) << (8 * y);
    planes[z] |= plane;
  }
}

// Points of a leaf that no arc and no exposed atom puts outside, out of those set in `open`. slack: how far rounding
// may have put a point into a ball; a point that is hardly outside an exposed ball is still projected on it.
uint64_t leaf_inside(const FeatureView &f, const BrickCandidates &c, const Lattice &lattice, const glm::ivec3 &first,
                     uint64_t open, float slack) {
  alignas(32) float px[64 + kPackSize], py[64 + kPackSize], pz[64 + kPackSize];
  open = to_blocks(open);
  const int n = list_points<BlockSteps>(lattice, first, open, px, py, pz);
  for (int k = n; k < n + kPackSize; ++k) px[k] = px[n - 1], py[k] = py[n - 1], pz[k] = pz[n - 1];
  const float depth = f.parameters.depth;
  const Pack depth2(depth * depth);
  uint64_t result = 0;
  for (int g = 0; g < n; g += kPackSize) {
    if (c.arc_count > kManyArcs) look_for_stop();
    const Vec3<Pack> p = load_points(px + g, py + g, pz + g);
    uint32_t lanes = n - g < kPackSize ? (1u << (n - g)) - 1 : kAllLanes;
    const PointBall ball = ball_around(p);
    const int arcs = choose_balls(c.arcs, c.arc_count, ball.center, depth + ball.radius, c.arc_list);
    for (int k = 0; k < arcs && lanes; ++k)
      lanes &= ~lane_bits(arc_distance2(f.arcs[c.arc_index[c.arc_list[k]]], p) <= depth2);
    if (lanes) {
      const int near = choose_balls(c.exposed, c.exposed_count, ball.center, ball.radius + slack, c.near_list);
      const Deepest deepest = deepest_ball(c.exposed, c.near_list, near, p, -slack);
      for_exposed_projections(f, c, p, deepest, lanes,
                              [&](const Sphere &, uint32_t, uint32_t exposed) { lanes &= ~exposed; });
    }
    result |= static_cast<uint64_t>(lanes) << g;
  }
  return from_blocks(deposit_bits(result, open));
}

}  // namespace

BrickNeeds evaluate_brick_signs(const FeatureView &f, const BrickSet &bricks, uint32_t brick,
                                const BrickScratch &scratch, uint64_t *words) {
  const Lattice &lattice = bricks.lattice;
  const float h = lattice.spacing, depth = f.parameters.depth;
  const glm::ivec3 first = lattice.first_point(lattice.brick_at(bricks.linear[brick]));
  const Vec3<float> low = lattice.position(first.x, first.y, first.z);
  // More than rounding.
  const float farthest = maximum(maximum(absolute(low.x), absolute(low.y)), absolute(low.z));
  const float slack = 1e-3f + 1e-6f * farthest;
  const BrickCandidates c = gather_candidates(f, low, 7.f * h, 1.1f * slack, depth + slack, scratch);
  if (c.needs.atoms || c.needs.arcs) return c.needs;

  const PlaneRows rows(h);
  uint64_t reached[8] = {}, core[8] = {};  // within an inflated ball; deeper than depth in one
  bool full = true;
  if (depth > 0.f) {
    for (int a = 0; a < c.atom_count; ++a) {
      const float r = c.atoms.radius[a] - depth;
      if (r > 0.f) fill_ball(core, rows, c.atoms.x[a] - low.x, c.atoms.y[a] - low.y, c.atoms.z[a] - low.z, r * r);
    }
    for (uint64_t plane : core) full &= plane == ~uint64_t(0);
  }
  if (depth == 0.f || !full) {
    std::copy_n(core, 8, reached);  // whoever is in the core needs no second look
    for (int a = 0; a < c.atom_count; ++a) {
      const float r = c.atoms.radius[a] - f.parameters.least_depth();
      fill_ball(reached, rows, c.atoms.x[a] - low.x, c.atoms.y[a] - low.y, c.atoms.z[a] - low.z, r * r);
    }
  }
  for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) {
    uint64_t in_core = 0, in_reach = 0;
    for (int z = 0; z < 4; ++z) {
      const int plane = (leaf & 4) + z;
      in_core |= quarter(core[plane], leaf & 1, leaf >> 1 & 1) << (16 * z);
      in_reach |= quarter(reached[plane], leaf & 1, leaf >> 1 & 1) << (16 * z);
    }
    if (depth == 0.f) {
      words[leaf] = in_reach;
      continue;
    }
    const uint64_t open = in_reach & ~in_core;
    words[leaf] = in_core;
    if (open) {
      words[leaf] |= leaf_inside(f, c, lattice, first + brick_point(leaf, 0), open, slack);
    }
  }
  return {0, 0};
}

}  // namespace QSES_CPU_ISA
}  // namespace quickses
