// SPDX-License-Identifier: MIT
// CPU kernel: which lattice points of one brick lie inside the exact surface. Only signs are computed, never the
// distance itself: balls are filled in as bit rows, and the points that stay undecided are packed together.
#include "surface/cpu/cpu_candidates.h"
#include "surface/cpu/cpu_leaf_bits.h"

namespace quickses {
namespace QSES_CPU_ISA {
namespace {

// Bits of the points of a brick, plane by plane: 16 for each quarter of a plane, as leaf words have them.
struct BrickPlanes {
  uint64_t at[kBrickEdge];
  uint32_t full;  // planes with all bits set
  QSES_FN void add(int z, uint64_t bits) {
    at[z] |= bits;
    full |= static_cast<uint32_t>(at[z] == ~uint64_t(0)) << z;
  }
  QSES_FN bool are_full() const { return full == kAllLanes; }
  QSES_FN uint64_t leaf(int number) const {
    const int shift = 16 * (number & 3);
    const uint64_t *const p = at + (number & 4);
    return (p[0] >> shift & 0xffff) | (p[1] >> shift & 0xffff) << 16 | (p[2] >> shift & 0xffff) << 32 |
           (p[3] >> shift & 0xffff) << 48;
  }
};

// Along each axis: 0 to 7, and these times the spacing.
struct BrickSteps {
  Pack number, along;
  float h;
  QSES_FN explicit BrickSteps(float spacing) : h(spacing) {
    alignas(32) static constexpr float kNumbers[kPackSize] = {0, 1, 2, 3, 4, 5, 6, 7};
    number = load_pack(kNumbers);
    along = number * Pack(spacing);
  }
};

// How far the points of a plane are from the middle of a ball, seen along z: squared, from the offsets in x and the
// squared ones in y of a row and a column.
struct PlaneDistances {
#if defined(__AVX512F__)
  WidePack quarter[4];
  QSES_FN PlaneDistances(Pack dx, Pack dy2) {
    const __m512i x = _mm512_setr_epi32(0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3),
                  y = _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
    for (int k = 0; k < 4; ++k) {
      const WidePack dx_k = spread_lanes(dx, _mm512_add_epi32(x, _mm512_set1_epi32(4 * (k & 1))));
      quarter[k] = multiply_add(dx_k, dx_k, spread_lanes(dy2, _mm512_add_epi32(y, _mm512_set1_epi32(2 * (k & 2)))));
    }
  }
  // Which of them are less, in the order of BrickPlanes.
  QSES_FN uint64_t less_than(float bound) const {
    const WidePack b(bound);
    return join_lanes(quarter[0] < b, quarter[1] < b, quarter[2] < b, quarter[3] < b);
  }
#else
  Pack row[kBrickEdge];
  QSES_FN PlaneDistances(Pack dx, Pack dy2) {
    alignas(32) float dy2_of[kPackSize];
    store_pack(dy2_of, dy2);
    for (int y = 0; y < kBrickEdge; ++y) row[y] = multiply_add(dx, dx, Pack(dy2_of[y]));
  }
  QSES_FN uint64_t less_than(float bound) const {
    const Pack b(bound);
    const auto half = [&](int y) {
      return static_cast<uint64_t>(half_rows(row[y] < b, row[y + 1] < b, row[y + 2] < b, row[y + 3] < b));
    };
    return half(0) | half(4) << 32;
  }
#endif
};

// Sets the bits of the lattice points within a ball; the centre is relative to the brick's first point.
QSES_FN void fill_ball(BrickPlanes *planes, const BrickSteps &steps, float cx, float cy, float cz, float radius2) {
  const float h = steps.h;
  // In packs, since compilers make branches of maxima of single floats.
  const Pack none(0.f), side(7.f * h), x(cx), y(cy);
  const Pack ox = maximum(none, maximum(-x, x - side)), oy = maximum(none, maximum(-y, y - side));
  const Pack dz = multiply_add(steps.number, Pack(h), Pack(-cz)), left = Pack(radius2) - dz * dz;
  // Planes that the ball meets and that are not full.
  uint32_t open = lane_bits(left > ox * ox + oy * oy) & ~planes->full;
  if (!open) return;
  alignas(32) float bounds[kPackSize];
  store_pack(bounds, left);
  const Pack dy = multiply_add(steps.number, Pack(h), Pack(-cy));
  const PlaneDistances distances(steps.along - x, rounded_product(dy, dy));
  for (; open; open &= open - 1) {
    const int z = lowest_bit32(open);
    planes->add(z, distances.less_than(bounds[z]));
  }
}

// Points of a leaf that no arc and no exposed atom puts outside, out of those set in `open`. slack: how far rounding
// may have put a point into a ball; a point that is hardly outside an exposed ball is still projected on it.
uint64_t leaf_inside(const FeatureView &f, const BrickCandidates &c, const Lattice &lattice, const glm::ivec3 &first,
                     uint64_t open, float slack, int *latest_arc) {
  alignas(32) float px[64 + kWideLanes], py[64 + kWideLanes], pz[64 + kWideLanes];
  open = to_blocks(open);
  const int n = list_points<BlockSteps>(lattice, first, open, px, py, pz);
  for (int k = n; k < n + kWideLanes; ++k) px[k] = px[n - 1], py[k] = py[n - 1], pz[k] = pz[n - 1];
  const float depth = f.parameters.depth;
  const WidePack depth2(depth * depth);
  uint64_t result = 0;
  for (int g = 0; g < n; g += kWideLanes) {
    if (c.arc_count > kManyArcs) look_for_stop();
    const Vec3<WidePack> p = load_points(px + g, py + g, pz + g);
    uint32_t lanes = first_wide_lanes(static_cast<uint32_t>(n - g));
    const auto leave_out_near = [&](int arc) {
      lanes &= ~lane_bits(arc_distance2(f.arcs[c.arc_index[arc]], p) <= depth2);
    };
    // What put the last points outside often does so with these.
    if (c.arc_count > 0) leave_out_near(*latest_arc);
    if (!lanes) continue;
    const PackBox box = box_around(p);
    const int arcs = choose_balls(c.arcs, c.arc_count, box, depth, c.arc_list);
    for (int k = 0; k < arcs && lanes; ++k) leave_out_near(*latest_arc = c.arc_list[k]);
    if (lanes) {
      const int near = choose_balls(c.exposed, c.exposed_count, box, slack, c.near_list);
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
  const glm::ivec3 first = lattice.first_point(bricks.place(brick));
  const Vec3<float> low = lattice.position(first.x, first.y, first.z);
  const float slack = more_than_rounding(low);
  BrickCandidates c = gather_atoms(f, low, 7.f * h, 1.1f * slack, scratch);
  if (c.needs.atoms) return c.needs;

  const BrickSteps steps(h);
  const auto fill = [&](BrickPlanes *planes, int a, float radius) {
    fill_ball(planes, steps, c.atoms.x[a] - low.x, c.atoms.y[a] - low.y, c.atoms.z[a] - low.z, radius * radius);
  };
  BrickPlanes core{};  // deeper than depth in an inflated ball
  if (depth > 0.f)
    for (int a = 0; a < c.atom_count; ++a) {
      const float radius = c.atoms.radius[a] - depth;
      if (radius > 0.f) fill(&core, a, radius);
    }
  BrickPlanes reached = core;  // within one: whoever is in the core needs no second look
  if (!core.are_full())
    for (int a = 0; a < c.atom_count; ++a) fill(&reached, a, c.atoms.radius[a] - f.parameters.least_depth());
  uint64_t open[kLeavesPerBrick], any = 0;
  for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) {
    words[leaf] = depth > 0.f ? core.leaf(leaf) : reached.leaf(leaf);
    open[leaf] = reached.leaf(leaf) & ~words[leaf];
    any |= open[leaf];
  }
  if (any == 0) return {0, 0};
  gather_arcs(f, low, 7.f * h, depth + slack, scratch, &c);
  if (c.needs.arcs) return c.needs;
  int latest_arc = 0;
  for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf)
    if (open[leaf])
      words[leaf] |= leaf_inside(f, c, lattice, first + brick_point(leaf, 0), open[leaf], slack, &latest_arc);
  return {0, 0};
}

}  // namespace QSES_CPU_ISA
}  // namespace quickses
