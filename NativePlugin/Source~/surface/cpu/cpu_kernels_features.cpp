// SPDX-License-Identifier: MIT
// CPU kernel: caps and exposed arcs of one atom, a pack of neighbours or of cutting balls at a time.
#include "parallel/atomics.h"
#include "parallel/pack.h"
#include "surface/cpu/cpu_covered_sphere.h"
#include "surface/cpu/cpu_item_packs.h"
#include "surface/cpu/cpu_kernels.h"
#include "surface/geometry/close_cut.h"

namespace quickses {
namespace QSES_CPU_ISA {
namespace {

// The columns of AtomScratch.
struct Columns {
  float *x, *y, *z, *cosine, *sine;   // neighbours: direction and cap
  float *sx, *sy, *sz, *scos, *ssin;  // the same, sorted by cosine, then without contained caps
  int32_t *index, *sorted_index;      // places of the neighbours in the grid
  Interval *intervals;                // two columns
  uint64_t *taken;
};

QSES_FN Columns cut_columns(const AtomScratch &s) {
  const size_t stride = static_cast<size_t>(s.capacity) + 16;
  float *p = s.memory;
  auto next = [&] {
    float *column = p;
    p += stride;
    return column;
  };
  Columns c;
  c.intervals = reinterpret_cast<Interval *>(p);
  p += 2 * stride;
  c.taken = reinterpret_cast<uint64_t *>(next());
  c.x = next(), c.y = next(), c.z = next(), c.cosine = next(), c.sine = next();
  c.sx = next(), c.sy = next(), c.sz = next(), c.scos = next(), c.ssin = next();
  c.index = reinterpret_cast<int32_t *>(next());
  c.sorted_index = reinterpret_cast<int32_t *>(next());
  return c;
}

// Offsets and radii of the atoms whose balls meet the ball of atom i: x, y, z, cosine (radius so far), index.
int gather_neighbors(const NeighborGridView &atoms, uint32_t i, const Columns &c, int capacity) {
  const Sphere self = atoms.items[i];
  const Vec3<float> center(self.center);
  const float reach = self.radius + atoms.cells.radii.in_cells;
  const CellBox box = cells_within(atoms.cells, center, reach);
  const WidePack x0(center.x), y0(center.y), z0(center.z), r0(self.radius);
  int n = 0;
  for_item_packs(atoms, box, [&](const ItemPack &p) {
    const WidePack x = p.x - x0, y = p.y - y0, z = p.z - z0, sum = p.radius + r0;
    const uint32_t near =
        p.lanes & lane_bits(x * x + y * y + z * z < sum * sum) & ~wide_lanes_of(p.places, static_cast<int32_t>(i));
    if (n + kWideLanes <= capacity) {
      store_lanes(c.x + n, near, x);
      store_lanes(c.y + n, near, y);
      store_lanes(c.z + n, near, z);
      store_lanes(c.cosine + n, near, p.radius);
      store_wide_lanes(c.index + n, near, p.places);
    }
    n += popcount64(near);
  });
  return n;
}

// Turns offsets and radii into unit directions and caps, with a pack of caps behind them that are none; leaves out
// neighbours that only touch. slopes: of CoveredSphere.
int make_caps(float radius, const Columns &c, float *slopes, int n) {
  int kept = 0;
  for (int q = 0; q < n; q += kWideLanes) {
    const Vec3<WidePack> d(load_wide(c.x + q), load_wide(c.y + q), load_wide(c.z + q));
    const WidePack distance2 = maximum(length_squared(d), WidePack(1e-20f));
    const WidePack inverse = reciprocal_root(distance2);
    const WidePack other = load_wide(c.cosine + q), cosine = cap_cosine(WidePack(radius), other, distance2, inverse);
    uint32_t keep = lane_bits(overlap(WidePack(radius), other, distance2));
    keep &= first_wide_lanes(static_cast<uint32_t>(n - q));
    int32_t index[kWideLanes];
    for (int l = 0; l < kWideLanes; ++l) index[l] = c.index[q + l];
    store_lanes(c.x + kept, keep, d.x * inverse);
    store_lanes(c.y + kept, keep, d.y * inverse);
    store_lanes(c.z + kept, keep, d.z * inverse);
    const WidePack sine = square_root(maximum(WidePack(0.f), WidePack(1.f) - cosine * cosine));
    store_lanes(c.cosine + kept, keep, cosine);
    store_lanes(c.sine + kept, keep, sine);
    store_lanes(slopes + kept, keep, quotient(WidePack(radius) * sine * distance2 * inverse, other));
    for (uint32_t k = keep; k; k &= k - 1) c.index[kept++] = index[lowest_bit32(k)];
  }
  for (int k = kept; k < kept + kWideLanes; ++k)
    c.x[k] = c.y[k] = c.z[k] = c.sine[k] = slopes[k] = 0.f, c.cosine[k] = 2.f;
  return kept;
}

// Largest cap first; of equal ones the earlier atom.
void sort_caps(const Columns &c, int n) {
  for (int w = 0; w <= n / 64; ++w) c.taken[w] = 0;
  for (int j = 0; j < n; ++j) {
    if (j % 64 == 0) look_for_stop();
    const WidePack own(c.cosine[j]);
    int rank = 0;
    for (int q = 0; q < n; q += kWideLanes) rank += popcount64(lane_bits(load_wide(c.cosine + q) < own));
    while (c.taken[rank >> 6] >> (rank & 63) & 1) ++rank;
    c.taken[rank >> 6] |= uint64_t(1) << (rank & 63);
    c.sx[rank] = c.x[j], c.sy[rank] = c.y[j], c.sz[rank] = c.z[j], c.scos[rank] = c.cosine[j];
    c.sorted_index[rank] = c.index[j];
  }
  for (int k = n; k < n + kWideLanes; ++k) c.sx[k] = c.sy[k] = c.sz[k] = 0.f, c.scos[k] = 2.f;
  for (int q = 0; q < n; q += kWideLanes) {
    const WidePack cosine = load_wide(c.scos + q);
    store_pack(c.ssin + q, square_root(maximum(WidePack(0.f), WidePack(1.f) - cosine * cosine)));
  }
}

// Drops caps that lie within a larger one; what is left goes to x, y, z, cosine, sine, index.
int drop_contained_caps(const Columns &c, int n) {
  int kept = 0;
  for (int q = 0; q < n; q += kWideLanes) {
    if (q % 64 == 0) look_for_stop();
    const Vec3<WidePack> axis(load_wide(c.sx + q), load_wide(c.sy + q), load_wide(c.sz + q));
    const WidePack cosine = load_wide(c.scos + q), sine = load_wide(c.ssin + q);
    uint32_t keep = first_wide_lanes(static_cast<uint32_t>(n - q));
    const int last = q + kWideLanes < n ? q + kWideLanes : n;  // only larger caps contain: those sorted before
    for (int k = 0; k < last && keep; ++k) {
      const WidePack between = dot(axis, Vec3<WidePack>(WidePack(c.sx[k]), WidePack(c.sy[k]), WidePack(c.sz[k])));
      keep &= ~lane_bits(cap_contains(WidePack(c.scos[k]), WidePack(c.ssin[k]), cosine, sine, between));
    }
    store_lanes(c.x + kept, keep, axis.x);
    store_lanes(c.y + kept, keep, axis.y);
    store_lanes(c.z + kept, keep, axis.z);
    store_lanes(c.cosine + kept, keep, cosine);
    store_lanes(c.sine + kept, keep, sine);
    for (; keep; keep &= keep - 1) c.index[kept++] = c.sorted_index[q + lowest_bit32(keep)];
  }
  return kept;
}

using Intervals = ExposedIntervals<Interval *>;

// What those of a pack of caps cover of circle j of atom i that single precision can't tell; false if it is hidden.
bool cut_exactly(const Circle &circle, const Sphere *atoms, uint32_t i, const int32_t *caps, int j, uint32_t lanes,
                 Intervals *intervals) {
  for (; lanes; lanes &= lanes - 1) {
    const CircleCut cut = cut_exactly(circle, atoms[i], atoms[j], atoms[caps[lowest_bit32(lanes)]]);
    if (cut.kind == CutKind::kPart) intervals->cover(cut.begin, cut.end);
    if (cut.kind == CutKind::kAll || intervals->empty()) return false;
  }
  return true;
}

// What caps that follow each other cover of a circle.
struct Stretches {
  static constexpr int kMost = 16, kPacks = kMost / kWideLanes;
  alignas(64) float begin[kMost] = {}, end[kMost] = {};  // pseudo-angles
  uint32_t set = 0;                                      // a bit for each that is one
};

// Finds those of the caps from `first` on; false if they hide circle j of the n caps of atom i. exactly: what is
// unclear is decided as if nothing were rounded, and covered already.
bool find_stretches(const Circle &circle, const Columns &c, int n, int j, const Sphere *atoms, uint32_t i, bool exactly,
                    int first, Stretches *stretches, Intervals *intervals) {
  for (int p = 0; p < Stretches::kMost && first + p < n; p += kWideLanes) {
    const int q = first + p;
    const Vec3<WidePack> axis(load_wide(c.x + q), load_wide(c.y + q), load_wide(c.z + q));
    const HalfPlane<WidePack> h = cut_circle(circle, axis, load_wide(c.cosine + q));
    uint32_t lanes = first_wide_lanes(static_cast<uint32_t>(n - q));
    if (j >= q && j < q + kWideLanes) lanes &= ~(1u << (j - q));
    if (const uint32_t unclear = lane_bits(is_unclear(circle, h)) & lanes) {
      if (exactly && !cut_exactly(circle, atoms, i, c.index + q, c.index[j], unclear, intervals)) return false;
      lanes &= ~(exactly ? unclear : lane_bits(same_circle(circle, h)));
    }
    if (lane_bits(covers_circle(h)) & lanes) return false;
    lanes &= ~lane_bits(misses_circle(h));
    if (!lanes) continue;
    WidePack begin, end;
    covered_stretch(h, &begin, &end);
    const uint32_t points = lane_bits(begin == end) & lanes;
    if (points) {
      if (lane_bits(h.c < WidePack(0.f)) & points) return false;
      lanes &= ~points;
    }
    store_pack(stretches->begin + p, begin);
    store_pack(stretches->end + p, end);
    stretches->set |= lanes << p;
  }
  return true;
}

// Of a circle that was exposed so far: an exposed interval begins where a stretch ends that lies in no other, and
// reaches to where the next begins. As ExposedIntervals has it, one after the other.
void cover_at_once(const Stretches &s, Intervals *intervals) {
  const auto of_pack = [&](int p, uint32_t lanes) { return lanes >> p * kWideLanes & kAllWideLanes; };
  WideMask covered[Stretches::kPacks];
  for (WideMask &mask : covered) mask = wide_mask(0);
  for (uint32_t rest = s.set; rest; rest &= rest - 1) {
    const int l = lowest_bit32(rest);
    const WidePack begin(s.begin[l]), end(s.end[l]);
    for (int p = 0; p < Stretches::kPacks; ++p)
      covered[p] = covered[p] | comes_before(begin, load_wide(s.end + p * kWideLanes), end);
  }
  uint32_t left = s.set;
  for (int p = 0; p < Stretches::kPacks; ++p) left &= ~(lane_bits(covered[p]) << p * kWideLanes);
  intervals->whole = false;
  while (left) {
    const float from = s.end[lowest_bit32(left)];
    left &= left - 1;  // and all that end there
    // The first one ahead, or of all.
    float ahead = kFarAway, first = kFarAway;
    for (int p = 0; p < Stretches::kPacks; ++p) {
      const WidePack none(kFarAway), begin = load_wide(s.begin + p * kWideLanes);
      const WideMask set = wide_mask(of_pack(p, s.set));
      first = minimum(first, horizontal_minimum(select(set, begin, none)));
      ahead = minimum(ahead, horizontal_minimum(select(set & (begin >= WidePack(from)), begin, none)));
      left &= ~((lane_bits(load_wide(s.end + p * kWideLanes) == WidePack(from)) & of_pack(p, s.set)) << p * kWideLanes);
    }
    intervals->interval[intervals->count++] = {from, ahead < kFarAway ? ahead : first};
  }
}

// The exposed intervals of circle j of the n caps of atom i; false if it is hidden. exactly: as if nothing were
// rounded.
bool cut_by_neighbors(const Circle &circle, const Columns &c, int n, int j, const Sphere *atoms, uint32_t i,
                      bool exactly, Intervals *intervals) {
  // The largest caps come first: most hidden circles are found to be so before the others are looked at.
  for (int first = 0; first < n; first += Stretches::kMost) {
    if (first % 64 == 0) look_for_stop();
    Stretches stretches;
    if (!find_stretches(circle, c, n, j, atoms, i, exactly, first, &stretches, intervals)) return false;
    if (!stretches.set) continue;
    if (intervals->whole)
      cover_at_once(stretches, intervals);
    else
      for (uint32_t rest = stretches.set; rest && !intervals->empty(); rest &= rest - 1)
        intervals->cover(stretches.begin[lowest_bit32(rest)], stretches.end[lowest_bit32(rest)]);
    if (intervals->empty()) return false;
  }
  intervals->settle();
  return !intervals->empty();
}

}  // namespace

AtomFeatures find_atom_features(const NeighborGridView &atoms, const SurfaceParameters &parameters, uint32_t i,
                                const AtomScratch &scratch, Cap *caps, int cap_room, Arc *arcs, ArcAtoms *arc_atoms,
                                int64_t arc_room, uint8_t *exposed) {
  const Sphere self = atoms.items[i];
  if (is_removed(self)) return {0, 0, 0};  // another atom contains it
  const Columns c = cut_columns(scratch);
  const int near = gather_neighbors(atoms, i, c, scratch.capacity);
  if (near + kWideLanes > scratch.capacity) return {near + kWideLanes, 0, 0};
  float *const slopes = c.ssin, *const bounds[] = {c.sx, c.sy, c.sz, c.scos};  // not in use yet
  int n = make_caps(self.radius, c, slopes, near);
  if (n == 0) {
    atomic_set(&exposed[i]);
    return {0, 0, 0};
  }
  // Far from the surface most atoms are: none of their circles needs to be looked at.
  const float least_depth = least_covered_depth(parameters.max_radius);
  if (CoveredSphere({c.x, c.y, c.z}, c.cosine, c.sine, slopes, n, least_depth, bounds).is_covered()) return {0, 0, 0};
  sort_caps(c, n);
  n = drop_contained_caps(c, n);
  if (n > cap_room) return {0, n, 0};
  for (int k = 0; k < n; ++k)
    caps[k] = {glm::vec3(c.x[k], c.y[k], c.z[k]), stored_cap_cosine(c.cosine[k], self.radius)};

  const bool exactly = parameters.is_of_balls();
  int64_t arc_count = 0;
  for (int j = 0; j < n; ++j) {
    if (j % 16 == 0) look_for_stop();
    if (static_cast<uint32_t>(c.index[j]) < i) continue;  // the circle belongs to the other atom
    const Circle circle = make_circle(glm::vec3(c.x[j], c.y[j], c.z[j]), c.cosine[j], self.radius);
    Intervals intervals{c.intervals, scratch.capacity};
    if (!cut_by_neighbors(circle, c, n, j, atoms.items, i, exactly, &intervals)) continue;
    atomic_set(&exposed[i]);
    atomic_set(&exposed[c.index[j]]);
    const float radius = self.radius * circle.sine;
    for (int k = 0; k < (intervals.whole ? 1 : intervals.count); ++k) {
      const ExposedArc arc =
          exposed_arc(intervals.whole ? nullptr : &intervals.interval[k], radius, parameters.max_arc_bound(), exactly);
      const int pieces = 1 << arc.halvings;
      if (arc_count + pieces <= arc_room) {
        write_arc_pieces(circle, self, arc, arcs + arc_count);
        for (int p = 0; arc_atoms && p < pieces; ++p) arc_atoms[arc_count + p] = {i, static_cast<uint32_t>(c.index[j])};
      }
      arc_count += pieces;
    }
  }
  return {0, n, arc_count};
}

}  // namespace QSES_CPU_ISA
}  // namespace quickses
