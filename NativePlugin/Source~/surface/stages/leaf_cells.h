// SPDX-License-Identifier: MIT
// The cells of a leaf in words of 64 bits: the signs of their corners, put together from the words of the leaf and its
// neighbours, and the cases of marching cubes that they make.
#pragma once

#include "surface/stages/brick_set.h"

namespace quickses {

// Leaf words around a leaf: itself and its neighbours towards larger x, y, z (bit 0, 1, 2 of the place).
struct LeafWords {
  uint64_t at[8];
};

// Of a leaf with this word in an active brick. get(place, word) leaves the word as it is where the neighbour's brick is
// not active: no cell there has a sign change, so it repeats the nearest point of the leaf itself.
template <class Get>
QSES_FN LeafWords leaf_words(uint64_t own, const Get &get) {
  LeafWords w;
  w.at[0] = own;
#if defined(__CUDA_ARCH__)
#pragma unroll
#endif
  for (int d = 1; d < 8; ++d) {
    const int bit = leaf_bit(d & 1 ? 3 : 0, d & 2 ? 3 : 0, d & 4 ? 3 : 0);
    uint64_t word = own >> bit & 1 ? ~uint64_t(0) : 0;
    get(d, &word);
    w.at[d] = word;
  }
  return w;
}
// The bricks towards larger x, y, z. Itself at 0.
struct UpperBricks {
  int at[8];
};
QSES_FN UpperBricks upper_bricks(const BrickSet &bricks, uint32_t brick) {
  const glm::ivec3 place = bricks.place(brick);
  UpperBricks upper;
  bricks.find_each<8>([&](int k) { return place + glm::ivec3(k & 1, k >> 1 & 1, k >> 2); }, upper.at);
  upper.at[0] = static_cast<int>(brick);  // one that stands for none is not found
  return upper;
}
QSES_FN LeafWords leaf_words(const UpperBricks &upper, const uint64_t *signs, int leaf) {
  const auto words_of = [&](int k) { return signs + static_cast<size_t>(upper.at[k]) * kLeavesPerBrick; };
  return leaf_words(words_of(0)[leaf], [&](int d, uint64_t *word) {
    const int k = leaf & d;
    if (upper.at[k] >= 0) *word = words_of(k)[leaf ^ d];
  });
}
// use(leaf, words) for the leaves of a brick. Unrolled, so that which neighbours they have needs no branches.
template <class Use>
QSES_FN void for_leaf_words(const UpperBricks &upper, const uint64_t *signs, const Use &use) {
  LeafWords words[kLeavesPerBrick];
#if !defined(__CUDACC__)
#pragma GCC unroll 8
#endif
  for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) words[leaf] = leaf_words(upper, signs, leaf);
  for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) use(leaf, words[leaf]);
}

// The eight corner words: bit b of corner word c is the sign of corner c of the cell at point b.
QSES_FN LeafWords cell_corners(const LeafWords &w) {
  const uint64_t x0 = shift_x(w.at[0], w.at[1]), x2 = shift_x(w.at[2], w.at[3]);
  const uint64_t x4 = shift_x(w.at[4], w.at[5]), x6 = shift_x(w.at[6], w.at[7]);
  LeafWords c;
  c.at[0] = w.at[0];
  c.at[1] = x0;
  c.at[2] = shift_y(w.at[0], w.at[2]);
  c.at[3] = shift_y(x0, x2);
  c.at[4] = shift_z(w.at[0], w.at[4]);
  c.at[5] = shift_z(x0, x4);
  c.at[6] = shift_z(c.at[2], shift_y(w.at[4], w.at[6]));
  c.at[7] = shift_z(c.at[3], shift_y(x4, x6));
  return c;
}

// Cells whose corners have both signs.
QSES_FN uint64_t mixed_cells(const LeafWords &c) {
  uint64_t any = c.at[0], all = c.at[0];
  for (int d = 1; d < 8; ++d) {
    any |= c.at[d];
    all &= c.at[d];
  }
  return any & ~all;
}

// Case of a cell: bit c = corner c is inside, corner = x + 2 y + 4 z. From corner words, by the cell's bit; or from
// rows of signs along x, by the row and the bit of its lower corner.
QSES_FN int cell_case(const LeafWords &c, int bit) {
  int code = 0;
  for (int d = 0; d < 8; ++d) code |= static_cast<int>(c.at[d] >> bit & 1) << d;
  return code;
}
// Those of eight cells that follow each other, a byte each: the corners' bits as a matrix, transposed (H. S. Warren,
// Hacker's Delight, 2nd edition, section 7-3).
QSES_FN uint64_t cell_cases(const LeafWords &c, int first) {
  uint64_t m = 0;
  for (int d = 0; d < 8; ++d) m |= (c.at[d] >> first & 0xff) << (8 * d);
  const auto swap_blocks = [&](int shift, uint64_t mask) {
    const uint64_t t = (m ^ m >> shift) & mask;
    m ^= t ^ t << shift;
  };
  swap_blocks(7, 0x00aa00aa00aa00aaull);
  swap_blocks(14, 0x0000cccc0000ccccull);
  swap_blocks(28, 0x00000000f0f0f0f0ull);
  return m;
}
template <class Row>
QSES_FN int cell_case(const Row *row, int rows_per_layer, int x) {
  const Row *const above = row + rows_per_layer;
  return (row[0] >> x & 3) | (row[1] >> x & 3) << 2 | (above[0] >> x & 3) << 4 | (above[1] >> x & 3) << 6;
}

}  // namespace quickses
