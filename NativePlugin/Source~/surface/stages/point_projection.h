// SPDX-License-Identifier: MIT
// Any point near the surface onto it, by the rule of projection.h.
#pragma once

#include "surface/stages/projection.h"

namespace quickses {

// placed: whether there is a place on the surface near the point that can be trusted.
template <class Candidates>
QSES_FN SurfacePoint project_point(const FeatureView &f, const Candidates &candidates, const Vec3<float> &x) {
  const DeepestAtom deepest = deepest_atom(f, candidates, x);
  Projection v = is_on_contact(f, candidates, deepest, x)
                     ? project_on_atom(f.parameters, load(f.atoms.items + deepest.atom), deepest.depth, x)
                     : project_on_arc(f, nearest_arc(f, candidates, x), x);
  while (v.state == ProjectionState::kReproject)
    v = reproject(f, candidates, nearest_arc(f, candidates, v.point.position), v);
  v.point.placed = v.state == ProjectionState::kPlaced;
  return v.point;
}

}  // namespace quickses
