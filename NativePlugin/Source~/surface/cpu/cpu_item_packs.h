// SPDX-License-Identifier: MIT
// The items of a neighbour grid in a box of cells, a pack at a time. Only for the CPU kernels.
#pragma once

#include "parallel/wide_pack.h"
#include "surface/stages/neighbor_grid.h"

#include <cstring>

namespace quickses {
namespace QSES_CPU_ISA {

// A pack of balls, their places in the grid, and the lanes that have one.
struct ItemPack {
  WidePack x, y, z, radius;
  const int32_t *places;
  uint32_t lanes;
};

// Calls use(ItemPack) for all items in the box, in their order. A row of cells holds few: those of several rows are put
// together first, since a pack takes as long whether it is full or not.
template <class Use>
QSES_FN void for_item_packs(const NeighborGridView &grid, const CellBox &box, const Use &use) {
  constexpr uint32_t kStep = kBehindItems, kRoom = 256;  // items copied at once, whether a row has as many or not
  static_assert(kStep == 8 && kRoom % kWideLanes == 0, "whole packs, and what may be read behind the last item");
  alignas(64) float balls[(kRoom + kWideLanes) * 4];
  int32_t places[kRoom + kWideLanes];
  // Behind the last layer comes the run of large items, if there are some.
  int y = box.y0, z = box.z0;
  const int last = box.z1 + (grid.cells.radii.large > 0 ? 1 : 0);
  ItemRun run = grid.run(box.x0, box.x1, y, z);
  while (z <= last) {
    uint32_t n = 0;
    while (n <= kRoom - kStep && z <= last) {
      const uint32_t left = run.end - run.begin;
      std::memcpy(balls + 4 * n, grid.items + run.begin, kStep * sizeof(Sphere));
      store_lane_numbers(places + n, kAllLanes, static_cast<int32_t>(run.begin));
      n += left < kStep ? left : kStep;
      run.begin += kStep;
      if (left > kStep) continue;
      if (z > box.z1 || ++y > box.y1) y = box.y0, ++z;
      if (z <= last) run = z <= box.z1 ? grid.run(box.x0, box.x1, y, z) : grid.large_items();
    }
    for (uint32_t k = 0; k < n; k += kWideLanes) {
      ItemPack pack;
      load_wide_rows(balls + 4 * k, n - k, &pack.x, &pack.y, &pack.z, &pack.radius);
      pack.places = places + k;
      pack.lanes = first_wide_lanes(n - k);
      use(pack);
    }
  }
}

}  // namespace QSES_CPU_ISA
}  // namespace quickses
