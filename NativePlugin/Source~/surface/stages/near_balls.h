// SPDX-License-Identifier: MIT
// The balls that may come near a place, one after the other.
#pragma once

#include "surface/stages/solvent_features.h"

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

}  // namespace quickses
