// SPDX-License-Identifier: MIT
// Why every mesh is closed, whatever rounding did to the features: no sign may change on the border of the brick set.
// Marching cubes only sees cells of active bricks. If all lattice points that an inactive brick's active neighbours
// have next to it are of one sign, then no cell that reaches into it is cut, and every cut cell finds all its corners,
// hence all its vertices, in active bricks. Where signs differ, the surface goes on behind the border: that brick is
// added, and so on until there is none. Where the features are right, only channels that are opened may need one.
#pragma once

#include "surface/stages/bricks.h"

namespace quickses {

// Neighbours of a brick are numbered (x + 1) + 3 (y + 1) + 9 (z + 1), with steps of -1, 0 and 1.
constexpr int kNeighborhood = 27, kOwnPlace = 13;
QSES_FN glm::ivec3 neighbor_step(int place) { return glm::ivec3(place % 3 - 1, place / 3 % 3 - 1, place / 9 - 1); }

// The numbers of the bricks around a place, and of the one there; -1 where none is active.
QSES_FN void find_neighborhood(const BrickSet &bricks, const glm::ivec3 &place, int *found) {
#if !defined(__CUDA_ARCH__)
  const Lattice &lattice = bricks.lattice;
  if (bricks.table && lattice.has(place - glm::ivec3(1)) && lattice.has(place + glm::ivec3(1))) {
    const int32_t *const own = bricks.table + lattice.linear(place);
    const ptrdiff_t row = lattice.brick_count.x, layer = row * lattice.brick_count.y;
    for (int z = -1, k = 0; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x, ++k) found[k] = own[x + row * y + layer * z];
    return;
  }
#endif
  bricks.find_each<kNeighborhood>([&](int k) { return place + neighbor_step(k); }, found);
}

// Which signs the points of a brick next to each neighbour have: the points of a face, an edge or a corner.
struct alignas(8) BorderSigns {
  uint32_t inside, outside;  // a bit per neighbour
};

// Points of a leaf that lie at its low (step -1) or high (1) end along an axis; all for 0.
QSES_FN uint64_t leaf_end(int axis, int step) {
  if (step == 0) return ~uint64_t(0);
  const uint64_t low = axis == 0 ? 0x1111111111111111ull : axis == 1 ? 0x000f000f000f000full : 0xffffull;
  return step < 0 ? low : low << (axis == 0 ? 3 : axis == 1 ? 12 : 48);
}

// words: the eight leaves of the brick.
QSES_FN BorderSigns border_signs(const uint64_t *words) {
  uint64_t any = 0, all = ~uint64_t(0);
  for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) {
    any |= words[leaf];
    all &= words[leaf];
  }
  constexpr uint32_t kEvery = (1u << kNeighborhood) - 1;
  if (any == 0) return {0, kEvery};
  if (all == ~uint64_t(0)) return {kEvery, 0};
  BorderSigns signs{0, 0};
  for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf)
    for (int towards = 0; towards < 8; ++towards) {
      // Neighbours that this leaf touches: on its own side along the axes in `towards`, level with the brick else.
      uint64_t mask = ~uint64_t(0);
      int place = kOwnPlace;
      for (int axis = 0, stride = 1; axis < kAxes; ++axis, stride *= 3) {
        if (!(towards >> axis & 1)) continue;
        const int step = leaf >> axis & 1 ? 1 : -1;
        mask &= leaf_end(axis, step);
        place += step * stride;
      }
      signs.inside |= static_cast<uint32_t>((words[leaf] & mask) != 0) << place;
      signs.outside |= static_cast<uint32_t>((words[leaf] & mask) != mask) << place;
    }
  return signs;
}

// Bits per neighbour of another brick, which is at `step` from here, as bits per neighbour of this one: of the places
// that are next to both.
QSES_FN uint32_t shared_neighbors(uint32_t bits, const glm::ivec3 &step) {
  constexpr uint32_t kLowX = 0x1249249, kLowY = 0x1c0e07, kLowZ = 0x1ff;  // places with a step of -1
  if (step.x != 0) bits &= ~(step.x > 0 ? kLowX << 2 : kLowX);
  if (step.y != 0) bits &= ~(step.y > 0 ? kLowY << 6 : kLowY);
  if (step.z != 0) bits &= ~(step.z > 0 ? kLowZ << 18 : kLowZ);
  const int shift = step.x + 3 * step.y + 9 * step.z;
  return shift >= 0 ? bits << shift : bits >> -shift;
}

// The inactive neighbours of a brick next to which signs differ, among its own points and those of its neighbours.
// Signs of the first `known` bricks are there; what others have is left out. near: how far the number of an active one
// is behind its own, at most.
QSES_FN uint32_t border_changes(const BrickSet &bricks, const BorderSigns *signs, size_t brick, size_t known,
                                uint32_t *near_number = nullptr) {
  int other[kNeighborhood];
  find_neighborhood(bricks, bricks.place(brick), other);
  other[kOwnPlace] = static_cast<int>(brick);  // one that stands for none is not found
  BorderSigns near{0, 0};
  uint32_t inactive = 0;
#if defined(__CUDA_ARCH__)
#pragma unroll
#elif !defined(__CUDACC__)
#pragma GCC unroll 27
#endif
  for (int k = 0; k < kNeighborhood; ++k) {
    const bool is_known = static_cast<uint32_t>(other[k]) < known;  // and there
    const BorderSigns there = signs[is_known ? static_cast<size_t>(other[k]) : brick];
    const uint32_t mask = is_known ? ~0u : 0u;
    inactive |= static_cast<uint32_t>(other[k] < 0) << k;
    near.inside |= shared_neighbors(there.inside & mask, neighbor_step(k));
    near.outside |= shared_neighbors(there.outside & mask, neighbor_step(k));
  }
  if (near_number) {
    int last = static_cast<int>(brick);
    for (int k = kOwnPlace + 1; k < kNeighborhood; ++k) last = last < other[k] ? other[k] : last;
    *near_number = static_cast<uint32_t>(last) - static_cast<uint32_t>(brick);
  }
  return inactive & near.inside & near.outside;
}

// A set of bricks and what lies behind its border where signs change.
struct GrownBricks {
  BrickSet bricks;
  const BorderSigns *signs;
  QSES_FN size_t size() const { return bricks.count; }
  QSES_FN double fewest(size_t) const { return 1; }
  uint64_t most_across() const { return 1; }  // they are few: always all
  template <class Visit>
  QSES_FN void visit(size_t i, const RowRange &, const Visit &visit_brick) const {
    const glm::ivec3 place = bricks.place(i);
    visit_brick(bricks.lattice.linear(place), uint64_t(1));
    for (uint32_t rest = border_changes(bricks, signs, i, bricks.count); rest; rest &= rest - 1) {
      const glm::ivec3 p = place + neighbor_step(lowest_bit32(rest));
      if (bricks.lattice.has(p)) visit_brick(bricks.lattice.linear(p), uint64_t(1));
    }
  }
};

template <class Executor>
BrickSet grow_bricks(Executor &executor, const BrickSet &bricks, const BorderSigns *signs) {
  const BrickSet grown = collect_bricks(executor, GrownBricks{bricks, signs}, bricks.lattice, "grown bricks");
  // The box of bricks is wider than any atom reaches, and outside of them all points are outside.
  if (grown.count == bricks.count) throw Error(QSES_INTERNAL_ERROR, "the surface leaves the box of the SES grid");
  return grown;
}

}  // namespace quickses
