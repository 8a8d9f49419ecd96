// SPDX-License-Identifier: MIT
// The atoms and arcs near one brick, gathered into columns so that a pack of them is tested at once. Only for the CPU
// kernels.
#pragma once

#include "parallel/wide_pack.h"
#include "surface/cpu/cpu_item_packs.h"
#include "surface/cpu/cpu_kernels.h"

namespace quickses {
namespace QSES_CPU_ISA {

// With more arcs near a brick its points may take long: they look for the stop on their own.
constexpr int kManyArcs = 1024;

// Columns of balls: centre and radius.
struct BallColumns {
  float *x, *y, *z, *radius;
};

struct BrickCandidates {
  BallColumns atoms, exposed, arcs;                 // all atoms; those with exposed parts; balls around arcs
  int32_t *atom_index, *exposed_index, *arc_index;  // places in the neighbour grids
  int32_t *near_list, *arc_list;                    // room for a choice of them
  int atom_count, exposed_count, arc_count;
  BrickNeeds needs;
};

QSES_FN BrickCandidates cut_columns(const BrickScratch &s) {
  BrickCandidates c{};
  const size_t atoms = static_cast<size_t>(s.atom_capacity) + 16, arcs = static_cast<size_t>(s.arc_capacity) + 16;
  float *p = s.atom_memory;
  c.atoms = {p, p + atoms, p + 2 * atoms, p + 3 * atoms};
  c.exposed = {p + 4 * atoms, p + 5 * atoms, p + 6 * atoms, p + 7 * atoms};
  c.atom_index = reinterpret_cast<int32_t *>(p + 8 * atoms);
  c.exposed_index = reinterpret_cast<int32_t *>(p + 9 * atoms);
  c.near_list = reinterpret_cast<int32_t *>(p + 10 * atoms);
  float *q = s.arc_memory;
  c.arcs = {q, q + arcs, q + 2 * arcs, q + 3 * arcs};
  c.arc_index = reinterpret_cast<int32_t *>(q + 4 * arcs);
  c.arc_list = reinterpret_cast<int32_t *>(q + 5 * arcs);
  return c;
}

QSES_FN Vec3<WidePack> packs_of(const Vec3<float> &v) { return {WidePack(v.x), WidePack(v.y), WidePack(v.z)}; }

// A box as centre and half extents, and squared distances to it.
struct PackBox {
  Vec3<WidePack> center, half;
  QSES_FN PackBox(const Vec3<float> &low, const Vec3<float> &high)
      : center(packs_of((low + high) * 0.5f)), half(packs_of((high - low) * 0.5f)) {}
  QSES_FN WidePack distance2(WidePack x, WidePack y, WidePack z) const {
    const WidePack zero(0.f);
    const WidePack dx = maximum(absolute(x - center.x) - half.x, zero),
                   dy = maximum(absolute(y - center.y) - half.y, zero),
                   dz = maximum(absolute(z - center.z) - half.z, zero);
    return dx * dx + dy * dy + dz * dz;
  }
};

// That around a pack of points, and a bit more.
QSES_FN PackBox box_around(const Vec3<WidePack> &p) {
  const Vec3<float> more(1e-4f, 1e-4f, 1e-4f);
  const Vec3<float> low(horizontal_minimum(p.x), horizontal_minimum(p.y), horizontal_minimum(p.z)),
      high(horizontal_maximum(p.x), horizontal_maximum(p.y), horizontal_maximum(p.z));
  return {low - more, high + more};
}

QSES_FN void store_balls(const BallColumns &c, int at, uint32_t set, WidePack x, WidePack y, WidePack z,
                         WidePack radius) {
  store_lanes(c.x + at, set, x);
  store_lanes(c.y + at, set, y);
  store_lanes(c.z + at, set, z);
  store_lanes(c.radius + at, set, radius);
}

// Behind the last ball stand others that nothing meets, so that whole packs can be read.
QSES_FN void end_balls(const BallColumns &c, int at) {
  for (float *column : {c.x, c.y, c.z}) store_pack(column + at, WidePack(kFarAway));
  store_pack(c.radius + at, WidePack(0.f));
}

// In Å, of coordinates in a brick whose first point that is.
QSES_FN float more_than_rounding(const Vec3<float> &low) {
  return 1e-3f + 1e-6f * maximum(maximum(absolute(low.x), absolute(low.y)), absolute(low.z));
}

// Gathers what can matter in a cube: atoms whose ball, grown by a reach, meets it.
QSES_FN BrickCandidates gather_atoms(const FeatureView &f, const Vec3<float> &low, float extent, float atom_reach,
                                     const BrickScratch &scratch) {
  BrickCandidates c = cut_columns(scratch);
  const Vec3<float> high(low.x + extent, low.y + extent, low.z + extent);
  const PackBox box(low, high);
  const CellBox cells = cells_within(f.atoms.cells, low, high, maximum(0.f, f.atoms.cells.radii.in_cells + atom_reach));
  for_item_packs(f.atoms, cells, [&](const ItemPack &p) {
    const WidePack reach = maximum(WidePack(0.f), p.radius + WidePack(atom_reach));
    const uint32_t near = p.lanes & lane_bits(box.distance2(p.x, p.y, p.z) < reach * reach);
    const int n = c.atom_count;
    if (n + kWideLanes <= scratch.atom_capacity) {
      store_balls(c.atoms, n, near, p.x, p.y, p.z, p.radius);
      store_wide_lanes(c.atom_index + n, near, p.places);
    }
    c.atom_count += popcount64(near);
  });
  if (c.atom_count + kWideLanes > scratch.atom_capacity) {
    c.needs.atoms = c.atom_count + kWideLanes;
    return c;
  }
  end_balls(c.atoms, c.atom_count);
  for (int q = 0; q < c.atom_count; q += kWideLanes) {
    const int last = c.atom_count - q < kWideLanes ? c.atom_count - q : kWideLanes;
    uint32_t exposed = 0;
    for (int l = 0; l < last; ++l) exposed |= static_cast<uint32_t>(f.exposed[c.atom_index[q + l]] != 0) << l;
    const int e = c.exposed_count;
    store_balls(c.exposed, e, exposed, load_wide(c.atoms.x + q), load_wide(c.atoms.y + q), load_wide(c.atoms.z + q),
                load_wide(c.atoms.radius + q));
    store_wide_lanes(c.exposed_index + e, exposed, c.atom_index + q);
    c.exposed_count += popcount64(exposed);
  }
  end_balls(c.exposed, c.exposed_count);
  return c;
}

// And arcs within a reach of it.
QSES_FN void gather_arcs(const FeatureView &f, const Vec3<float> &low, float extent, float arc_reach,
                         const BrickScratch &scratch, BrickCandidates *c) {
  const Vec3<float> high(low.x + extent, low.y + extent, low.z + extent);
  const PackBox box(low, high);
  if (f.arc_bounds.count > 0) {
    const CellBox cells = cells_within(f.arc_bounds.cells, low, high, arc_reach + f.max_arc_bound);
    for_item_packs(f.arc_bounds, cells, [&](const ItemPack &p) {
      const WidePack reach = p.radius + WidePack(arc_reach);
      const uint32_t near = p.lanes & lane_bits(box.distance2(p.x, p.y, p.z) < reach * reach);
      const int n = c->arc_count;
      if (n + kWideLanes <= scratch.arc_capacity) {
        store_balls(c->arcs, n, near, p.x, p.y, p.z, p.radius);
        store_wide_lanes(c->arc_index + n, near, p.places);
      }
      c->arc_count += popcount64(near);
    });
  }
  if (c->arc_count + kWideLanes > scratch.arc_capacity)
    c->needs.arcs = c->arc_count + kWideLanes;
  else
    end_balls(c->arcs, c->arc_count);
}

QSES_FN BrickCandidates gather_candidates(const FeatureView &f, const Vec3<float> &low, float extent, float atom_reach,
                                          float arc_reach, const BrickScratch &scratch) {
  BrickCandidates c = gather_atoms(f, low, extent, atom_reach, scratch);
  if (c.needs.atoms == 0) gather_arcs(f, low, extent, arc_reach, scratch, &c);
  return c;
}

// Numbers of the balls that, grown by `reach` (which may be negative), meet the box. Room for a pack more is needed.
QSES_FN int choose_balls(const BallColumns &c, int n, const PackBox &box, float reach, int32_t *out) {
  const WidePack grow(reach);
  int k = 0;
  for (int q = 0; q < n; q += kWideLanes) {
    const WidePack r = maximum(WidePack(0.f), load_wide(c.radius + q) + grow);
    const WidePack distance2 = box.distance2(load_wide(c.x + q), load_wide(c.y + q), load_wide(c.z + q));
    k += store_wide_numbers(out + k, lane_bits(distance2 < r * r), q);
  }
  return k;
}

QSES_FN Vec3<WidePack> load_points(const float *x, const float *y, const float *z) {
  return {load_wide(x), load_wide(y), load_wide(z)};
}

// The deepest of the chosen balls for each of a pack of points: its number in the columns (as a float; -1: none deeper
// than floor), and the depth.
struct Deepest {
  WidePack number, depth;
};
QSES_FN Deepest deepest_ball(const BallColumns &c, const int32_t *list, int n, const Vec3<WidePack> &p, float floor) {
  Deepest best{WidePack(-1.f), WidePack(floor)};
  for (int k = 0; k < n; ++k) {
    const int a = list[k];
    const WidePack dx = p.x - WidePack(c.x[a]), dy = p.y - WidePack(c.y[a]), dz = p.z - WidePack(c.z[a]);
    const WidePack depth = WidePack(c.radius[a]) - square_root(dx * dx + dy * dy + dz * dz);
    const WideMask deeper = depth > best.depth;
    best.depth = select(deeper, depth, best.depth);
    best.number = select(deeper, WidePack(static_cast<float>(a)), best.number);
  }
  return best;
}

// Which of a pack of points are in no ball of all atoms by more than `least`. reach: of the balls that are looked at,
// at least -least.
QSES_FN WideMask are_outside_balls(const BrickCandidates &c, const PackBox &box, const Vec3<WidePack> &p, float least,
                                   float reach) {
  const int near = choose_balls(c.atoms, c.atom_count, box, reach, c.near_list);
  return deepest_ball(c.atoms, c.near_list, near, p, least).number < WidePack(0.f);
}

// Of the points in `lanes`, all nearest to one atom: which have their radial projection on it exposed?
QSES_FN uint32_t exposed_lanes(const FeatureView &f, uint32_t atom, const Vec3<WidePack> &offset, WidePack length,
                               uint32_t lanes) {
  const CapRange range = f.cap_ranges[atom];
  const Cap *caps = f.caps + range.first;
  for (int32_t k = 0; k < range.count && lanes; ++k) lanes &= ~lane_bits(cap_covers(caps[k], offset, length));
  return lanes;
}

// A pack of points on the exposed balls that they are deepest in: use(ball, atom, exposed) is called for each such ball
// with its place in the grid, and those of the points in `lanes` whose radial projection on it is exposed.
template <class Use>
QSES_FN void for_exposed_projections(const FeatureView &f, const BrickCandidates &c, const Vec3<WidePack> &p,
                                     const Deepest &deepest, uint32_t lanes, const Use &use) {
  alignas(32) float number[kWideLanes];
  store_pack(number, deepest.number);
  for (uint32_t todo = lanes & lane_bits(WidePack(0.f) <= deepest.number); todo;) {
    const float a = number[lowest_bit32(todo)];
    const uint32_t same = todo & lane_bits(deepest.number == WidePack(a));
    todo &= ~same;
    const int k = static_cast<int>(a);
    const Sphere ball{glm::vec3(c.exposed.x[k], c.exposed.y[k], c.exposed.z[k]), c.exposed.radius[k]};
    const uint32_t atom = static_cast<uint32_t>(c.exposed_index[k]);
    const uint32_t exposed =
        exposed_lanes(f, atom, p - Vec3<WidePack>(ball.center), offset_length(ball, deepest.depth), same);
    if (exposed) use(ball, atom, exposed);
  }
}

}  // namespace QSES_CPU_ISA
}  // namespace quickses
