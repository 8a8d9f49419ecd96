// SPDX-License-Identifier: MIT
// The features that decide about points near a place: gathered once for the few points that are tried there.
#pragma once

#include "surface/stages/projection.h"

namespace quickses {

// Which features count for points within `around` of x: a rule that knows no order.
struct LocalReach {
  // Where more are met, or are near, it is too crowded to tell.
  static constexpr uint32_t kMostMet = 1 << 13;
  static constexpr int kMostAtoms = 64, kMostArcs = 96;
  Vec3<float> x;
  float atom_reach, arc_reach;  // of the boxes in which they are looked for
  float slack;                  // what is deepest anywhere near lies no deeper than this below the deepest at x
  float far;                    // arcs up to here

  QSES_FN LocalReach(const FeatureView &f, const Vec3<float> &place, float around)
      : x(place),
        atom_reach(f.atoms.cells.radii.in_cells + around),
        slack(2.f * around + 1e-3f),
        far(f.parameters.depth + around + 1e-2f) {
    arc_reach = far + f.max_arc_bound;
  }
  QSES_FN CellBox box(const NeighborGridView &grid, float reach) const { return cells_within(grid.cells, x, reach); }
  // May the arc in such a ball be near?
  template <class Ball, class T>
  QSES_FN auto meets(const Ball &bound, const Vec3<T> &at) const -> decltype(at.x <= at.x) {
    const T near = bound.radius + T(far);
    return length_squared(Vec3<T>(bound.center) - at) <= near * near;
  }
  QSES_FN bool is_near(const Arc &arc) const { return arc_distance2(arc, x) <= far * far; }
};

}  // namespace quickses
