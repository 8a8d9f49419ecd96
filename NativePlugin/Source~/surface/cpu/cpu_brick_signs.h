// SPDX-License-Identifier: MIT
// The signs of a brick's lattice points together with those around it, as rows along x. Only for the CPU kernels.
#pragma once

#include "surface/cpu/cpu_leaf_bits.h"
#include "surface/stages/marching_cubes.h"

#include <cstring>

namespace quickses {
namespace QSES_CPU_ISA {

// Leaf words of the bricks around one (numbered as in brick_border.h); nullptr where none is active.
struct NearWords {
  const uint64_t *at[kNeighborhood];
};
QSES_FN NearWords find_near_words(const BrickSet &bricks, const uint64_t *signs, uint32_t brick) {
  int found[kNeighborhood];
  find_neighborhood(bricks, bricks.place(brick), found);
  NearWords near;
  for (int k = 0; k < kNeighborhood; ++k)
    near.at[k] = found[k] < 0 ? nullptr : signs + static_cast<size_t>(found[k]) * kLeavesPerBrick;
  return near;
}

// A row of a brick along x: eight bits.
QSES_FN uint32_t row_of(const uint64_t *words, int y, int z) {
  const int leaf = (y >> 2) * 2 + (z >> 2) * 4, shift = 4 * (y & 3) + 16 * (z & 3);
  return static_cast<uint32_t>((words[leaf] >> shift & 15) | (words[leaf + 1] >> shift & 15) << 4);
}

// A plane of a brick: bit x + 8 y.
QSES_FN uint64_t plane_of(const uint64_t *words, int z) {
  const uint64_t *const w = words + (z >> 2) * 4;
  const int shift = 16 * (z & 3);
  const auto rows_of = [&](int leaf) {
    return spread_by_four((w[leaf] >> shift & 0xffff) | (w[leaf + 2] >> shift & 0xffff) << 16);
  };
  return rows_of(0) | rows_of(1) << 4;
}

// Signs of the lattice points of a brick and one more on every side: bit x + 1 of row_of(y, z).
struct SignRows {
  static constexpr int kSide = kBrickEdge + 2;
  uint16_t row[kSide * kSide];
  QSES_FN uint16_t *row_of(int y, int z) { return row + (z + 1) * kSide + (y + 1); }
};

// Where a brick is not active, no cell at it changes sign: its points are like the nearest ones here.
QSES_FN void read_sign_rows(const NearWords &near, SignRows *rows) {
  const uint64_t *const own = near.at[kOwnPlace];
  for (int z = -1; z <= kBrickEdge; ++z) {
    const int layer = z < 0 ? 0 : z < kBrickEdge ? 9 : 18, cz = z < 0 ? 0 : z < kBrickEdge ? z : kBrickEdge - 1;
    uint16_t *const out = rows->row_of(0, z);
    const uint64_t nearest = plane_of(own, cz);
    const auto plane_at = [&](int place, uint64_t instead) {
      return near.at[place] ? plane_of(near.at[place], z & 7) : instead;
    };
    const uint64_t middle = layer == 9 ? nearest : plane_at(layer + 4, nearest);
    const uint64_t left = plane_at(layer + 3, nearest << 7) >> 7, right = plane_at(layer + 5, nearest >> 7);
    const uint64_t ends[] = {left & 0x0101010101010101ull, middle, right & 0x0101010101010101ull};
    uint8_t bytes[3][kBrickEdge];
    std::memcpy(bytes, ends, sizeof bytes);
    for (int y = 0; y < kBrickEdge; ++y)
      out[y] = static_cast<uint16_t>(bytes[0][y] | bytes[1][y] << 1 | bytes[2][y] << 9);
    for (int side = 0; side < 2; ++side) {
      const int place = layer + 6 * side, y = side ? 0 : kBrickEdge - 1;
      const uint32_t instead = row_of(own, kBrickEdge - 1 - y, cz);
      const auto row_at = [&](int k, uint32_t other) { return near.at[k] ? row_of(near.at[k], y, z & 7) : other; };
      out[side ? kBrickEdge : -1] =
          static_cast<uint16_t>((row_at(place, instead << 7) >> 7 & 1) | row_at(place + 1, instead) << 1 |
                                (row_at(place + 2, instead >> 7) & 1) << 9);
    }
  }
}

// The cases of all cells with a corner in the brick, by the cell's lower corner: of points from -1 to 7 in each axis.
struct CellCases {
  static constexpr int kRow = 16, kLayer = kRow * (kBrickEdge + 1);
  alignas(8) uint8_t code[kLayer * (kBrickEdge + 1)];
  QSES_FN uint8_t *at(int x, int y, int z) { return code + (x + 1) + kRow * (y + 1) + kLayer * (z + 1); }
};
QSES_FN void read_cell_cases(const SignRows &rows, CellCases *cases) {
  constexpr int kCells = kBrickEdge + 1;
  // The two bits of a row that each cell has, in a byte per cell: of the first eight, and of the last one.
  struct RowPairs {
    uint64_t first;
    uint32_t last;
  };
  const auto pairs_of = [&](uint32_t row) {
    return RowPairs{spread_bits(row & 0xff) | spread_bits(row >> 1 & 0xff) << 1, row >> 8 & 3};
  };
  RowPairs below[SignRows::kSide], above[SignRows::kSide];
  for (int y = 0; y <= kCells; ++y) below[y] = pairs_of(rows.row[y]);
  for (int z = 0; z < kCells; ++z) {
    for (int y = 0; y <= kCells; ++y) above[y] = pairs_of(rows.row[(z + 1) * SignRows::kSide + y]);
    for (int y = 0; y < kCells; ++y) {
      uint8_t *const out = cases->code + CellCases::kLayer * z + CellCases::kRow * y;
      const uint64_t codes = below[y].first | below[y + 1].first << 2 | above[y].first << 4 | above[y + 1].first << 6;
      std::memcpy(out, &codes, sizeof codes);
      out[kBrickEdge] =
          static_cast<uint8_t>(below[y].last | below[y + 1].last << 2 | above[y].last << 4 | above[y + 1].last << 6);
    }
    std::memcpy(below, above, sizeof below);
  }
}

}  // namespace QSES_CPU_ISA
}  // namespace quickses
