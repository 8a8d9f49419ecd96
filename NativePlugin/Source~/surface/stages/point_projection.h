// SPDX-License-Identifier: MIT
// Any point near the surface onto it, by the rule of projection.h.
#pragma once

#include "surface/stages/projection.h"

namespace quickses {

// All features, found by their grids: candidates for points anywhere. Those of a brick are quicker where there are any.
struct GridCandidates {};

QSES_FN DeepestAtom deepest_atom(const FeatureView &f, const GridCandidates &, const Vec3<float> &x) {
  DeepestAtom best{0, -2.f * kFarAway};
  const float reach = f.parameters.max_radius + 1e-2f;
  const Vec3<float> r(reach, reach, reach);
  const CellBox box = cells_around(f.atoms.cells, x - r, x + r);
  for (int z = box.z0; z <= box.z1; ++z)
    for (int y = box.y0; y <= box.y1; ++y) {
      const ItemRun run = f.atoms.run(box.x0, box.x1, y, z);
      for (uint32_t i = run.begin; i < run.end; ++i) {
        const float d = ball_depth(load(f.atoms.items + i), x);
        if (d > best.depth) best = {i, d};
      }
    }
  return best;
}

// Of those that can matter: a point is hardly farther than depth and kStartReach from the boundary.
QSES_FN NearestArc nearest_arc(const FeatureView &f, const GridCandidates &, const Vec3<float> &x) {
  NearestArc best;
  if (f.arc_bounds.count == 0) return best;
  const float reach = f.parameters.depth + kStartReach * f.parameters.spacing, grown = reach + f.max_arc_bound;
  const Vec3<float> r(grown, grown, grown);
  const CellBox box = cells_around(f.arc_bounds.cells, x - r, x + r);
  for (int z = box.z0; z <= box.z1; ++z)
    for (int y = box.y0; y <= box.y1; ++y) {
      const ItemRun run = f.arc_bounds.run(box.x0, box.x1, y, z);
      for (uint32_t i = run.begin; i < run.end; ++i) {
        const Sphere bound = load(f.arc_bounds.items + i);
        const float near = bound.radius + minimum(reach, square_root(best.second2));
        if (length_squared(Vec3<float>(bound.center) - x) <= near * near)
          best.offer(static_cast<int>(i), arc_distance2(load(f.arcs + i), x));
      }
    }
  return best;
}

// placed: whether there is a place on the surface near the point that can be trusted.
template <class Candidates>
QSES_FN SurfacePoint project_point(const FeatureView &f, const Candidates &candidates, const Vec3<float> &x) {
  const DeepestAtom deepest = deepest_atom(f, candidates, x);
  Projection v = is_on_contact(f, deepest, x)
                     ? project_on_atom(f.parameters, load(f.atoms.items + deepest.atom), deepest.depth, x)
                     : project_on_arc(f, nearest_arc(f, candidates, x), x);
  while (v.state == ProjectionState::kReproject)
    v = reproject(f, candidates, nearest_arc(f, candidates, v.point.position), v);
  v.point.placed = v.state == ProjectionState::kPlaced;
  return v.point;
}

}  // namespace quickses
