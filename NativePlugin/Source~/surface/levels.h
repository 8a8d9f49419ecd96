// SPDX-License-Identifier: MIT
// The levels that settings name. They are what the frame of reference of a computation depends on, besides the atoms.
#pragma once

#include "quickses/quickses.h"

#include <algorithm>
#include <cmath>

namespace quickses {

// The spacings of the levels of a job, Å, coarsest first.
struct Levels {
  static constexpr uint32_t kMax = QSES_MAX_LEVELS + 1;
  float spacings[kMax] = {};
  uint32_t count = 0;

  void add(float spacing) { spacings[count++] = spacing; }
  bool operator==(const Levels &other) const {
    return count == other.count && std::equal(spacings, spacings + count, other.spacings);
  }
};

// The levels coarser than settings.spacing, and that one.
inline Levels levels_of(const qses_settings &settings) {
  Levels ladder;
  for (uint32_t k = 0; k < settings.level_count; ++k)
    if (settings.levels[k] > settings.spacing) ladder.add(settings.levels[k]);
  ladder.add(settings.spacing);
  return ladder;
}

// The spacing whose brick corners the centred frame's origin is one of. All levels have their lattices anchored to the
// global origin if their spacings divide the coarsest one; else only the finest has. It is the same whichever of the
// levels are computed, so that their meshes are the same byte for byte.
inline float frame_spacing(const Levels &ladder) {
  const float coarsest = ladder.spacings[0];
  for (uint32_t k = 0; k < ladder.count; ++k) {
    const float ratio = coarsest / ladder.spacings[k];
    if (std::fabs(ratio - std::round(ratio)) > 1e-6f * ratio) return ladder.spacings[ladder.count - 1];
  }
  return coarsest;
}

}  // namespace quickses
