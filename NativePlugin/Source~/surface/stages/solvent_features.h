// SPDX-License-Identifier: MIT
// The exact boundary of the solvent-accessible surface: per atom the caps its neighbours cover, and per circle of two
// atoms the arcs that no third atom covers. Totrov & Abagyan 1996 (contour buildup) and Krone et al. 2011 compute the
// same set; here an arc carries its ends (the exposed vertices), so nothing else is needed to measure distances.
#pragma once

#include "surface/geometry/arc.h"
#include "surface/geometry/circle.h"
#include "surface/stages/neighbor_grid.h"

namespace quickses {

// What is measured: everything below is the surface at `depth` inside the boundary of the union of balls of radius
// r + probe. SES: depth = probe. SAS: depth = 0. VDW: probe = depth = 0.
struct SurfaceParameters {
  float probe;
  float depth;
  float spacing;
  float max_radius;   // largest inflated radius
  float scale = 1.f;  // of atoms' radii, before the probe inflates them

  // A point that is no deeper than this in any ball is outside. Where a surface is looked for further inside, a point
  // on the boundary within rounding is outside only if a feature says so: else it would be a hole of its own.
  QSES_FN float least_depth() const { return depth > 0.f ? -kExposureTolerance : 0.f; }

  // Arcs are split where their enclosing balls would be larger, since near arcs are found by those. The fewer there are
  // the better, while the balls are small beside the reach of the probe: with 1.4 Å, 1.5 to 3 Å are alike, and 1 Å
  // makes surfaces take 4 % longer. Rows of candidates have the usual room for balls of 2 Å at most; other estimates
  // count on pieces of 1 Å at least.
  QSES_FN float max_arc_bound() const { return maximum(1.f, minimum(2.f, 1.5f * depth)); }

  // Only what a probe rolls on can have walls between two probes (thin_walls.h).
  QSES_FN bool has_thin_walls() const { return depth > 0.f; }
  // Whether the surface is the boundary of the balls itself: then its arcs and caps measure it (atom_measures.h).
  QSES_FN bool is_of_balls() const { return depth == 0.f; }
};

// Output of the stage, in the memory of the back end. Arcs are ordered by atom (in grid order), then by cap, then by
// interval: the same on every run.
struct SolventFeatures {
  Span<CapRange> cap_ranges;  // per atom, in grid order
  Span<Cap> caps;             // cosine with the exposure tolerance, largest cap first
  Span<Arc> arcs;
  Span<ArcAtoms> arc_atoms;  // of each arc, if the surface is that of the balls; else none
  Span<uint8_t> exposed;     // CPU only: per atom 1 or 0
  uint32_t most_caps = 0;    // of an atom; GPU only
  // Where the number of arcs is, if there may be fewer; nullptr: it is exact.
  const unsigned long long *arc_count = nullptr;
};

// The features as the later stages see them: arcs sorted into a neighbour grid by their enclosing balls.
struct FeatureView {
  NeighborGridView atoms;  // inflated spheres; atoms that own no surface are far away
  const CapRange *cap_ranges;
  const Cap *caps;
  const uint8_t *exposed;       // per atom 1 or 0; only the CPU's kernels look at it
  NeighborGridView arc_bounds;  // enclosing ball of each arc
  const Arc *arcs;              // in the order of arc_bounds.items
  float max_arc_bound;
  uint32_t most_caps;  // as in SolventFeatures
  SurfaceParameters parameters;
};

// ---- passes around the stage, the same on both back ends -------------------------------------------------------

// Which atoms lie within another one, of those in reach.
struct FindContainedAtoms {
  NeighborGridView atoms;
  uint8_t *contained;    // zeros at first
  uint32_t threads = 1;  // of an atom
  MetItems part{};
  QSES_HOST_DEVICE void operator()(size_t thread) const {
    const auto [i, rank] = thread_of_item(thread, threads);
    const Sphere self = atoms.items[i];
    const float reach = maximum(0.f, containing_reach(self.radius, atoms.cells.radii.in_cells));
    const CellBox box = cells_within(atoms.cells, Vec3<float>(self.center), reach);
    MetItems met = part;
    const bool is_free = atoms.for_each_run(box, [&, i = i, rank = rank](const ItemRun &whole) {
      const ItemRun run = met.cut(whole);
      for (uint32_t k = run.begin + rank; k < run.end; k += threads)
        if (k != i && contains(atoms.items[k], atoms.order[k], self, atoms.order[i])) return false;
      return true;
    });
    if (!is_free) atomic_set(&contained[i]);
  }
};

struct RemoveContainedAtoms {
  const uint8_t *contained;
  Sphere *atoms;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    if (contained[i]) atoms[i] = removed_atom();
  }
};

// What is found of the atoms serves every spacing.
template <class Executor>
void remove_contained_atoms(Executor &executor, const NeighborGridView &atoms, float max_radius) {
  const auto mark = executor.arena().mark();
  Span<uint8_t> contained = executor.template allocate_zeros<uint8_t>(atoms.count);
  uint64_t near = atoms.count;
  if constexpr (Executor::kIsCuda)
    near = most_atoms_near(executor, atoms, 4.f * max_radius + 1.f, [&](uint64_t items) {
      return items <= kThreadSteps && executor.is_few_launches(atoms.count, executor.for_each_shape(items));
    });
  const ForEach remove{atoms.count, RemoveContainedAtoms{contained.data, const_cast<Sphere *>(atoms.items)}};
  for_parts_of_met_items(near, Executor::kIsCuda ? kThreadSteps : near, [&](const MetItems &part, bool is_last) {
    const uint32_t threads = Executor::kIsCuda && atoms.count < kManyItems ? 4 : 1;
    const ForEach find{atoms.count * size_t(threads), FindContainedAtoms{atoms, contained.data, threads, part},
                       std::max(kPlainSteps, std::min(near, kThreadSteps))};
    if (is_last)
      do_in_turn(executor, find, remove);
    else
      do_in_turn(executor, find);
  });
  executor.arena().rewind(mark);
}

struct ArcBoundAt {
  const Arc *arcs;
  const unsigned long long *count;  // nullptr: of as many as there are
  QSES_HOST_DEVICE Sphere operator()(size_t i) const {
    if (count && i >= *count) return no_item();
    Sphere bound = arc_bound(arcs[i]);
    bound.radius += 1e-4f;
    return bound;
  }
};

// To where their bounds go.
struct BringArc {
  const Arc *arcs;
  Arc *sorted;  // nullptr: later
  QSES_HOST_DEVICE void operator()(size_t place, size_t i) const {
    if (sorted) sorted[place] = load(arcs + i);
  }
};
struct GatherArcs {
  BringArc bring;
  const unsigned long long *count;
  const uint32_t *order;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    if (!count || i < *count) bring(i, order[i]);  // those that are not there come last
  }
};

struct CopyArcs {
  const Arc *from;
  Arc *to;
  QSES_HOST_DEVICE void operator()(size_t i) const { to[i] = from[i]; }
};

// Edge of the grid of arcs: arcs are looked for in boxes of about a brick, whatever the atoms' radii.
constexpr float kArcCellEdge = 4.f;

}  // namespace quickses
