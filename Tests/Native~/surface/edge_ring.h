// SPDX-License-Identifier: MIT
// The ring around a lattice edge from the signs near it, for tests.
#pragma once

#include "surface/stages/marching_cubes.h"

// As edge_ring_of_cells. inside(along, second, third) is the sign at a point near the edge: along the edge 0 or 1, in
// the other two axes, lower axis first, -1 ... 1.
template <class Inside>
uint64_t edge_ring(const Inside &inside, int axis) {
  const int second = axis == 0 ? 1 : 0, third = axis == 2 ? 1 : 2;
  return quickses::edge_ring_of_cells(
      [&](int v, int w) {
        int code = 0;
        for (int corner = 0; corner < 8; ++corner)
          code |= (inside(corner >> axis & 1, v + (corner >> second & 1), w + (corner >> third & 1)) ? 1 : 0) << corner;
        return code;
      },
      axis, quickses::marching_cubes_table().ring);
}
