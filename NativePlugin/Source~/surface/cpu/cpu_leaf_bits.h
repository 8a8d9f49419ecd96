// SPDX-License-Identifier: MIT
// The points of a leaf that some bits choose, in an order in which neighbours in the order are neighbours in space: the
// fewer balls meet a pack of them. Only for the CPU kernels.
#pragma once

#include "parallel/pack.h"
#include "surface/cpu/cpu_kernels.h"

#if defined(__BMI2__)
#include <immintrin.h>
#endif

namespace quickses {
namespace QSES_CPU_ISA {

// The lowest bits of `bits`, spread over the set positions of mask; and back.
QSES_FN uint64_t deposit_bits(uint64_t bits, uint64_t mask) {
#if defined(__BMI2__)
  return _pdep_u64(bits, mask);
#else
  uint64_t result = 0;
  for (; mask; mask &= mask - 1, bits >>= 1)
    if (bits & 1) result |= mask & (~mask + 1);
  return result;
#endif
}
QSES_FN uint64_t extract_bits(uint64_t bits, uint64_t mask) {
#if defined(__BMI2__)
  return _pext_u64(bits, mask);
#else
  uint64_t result = 0;
  for (int k = 0; mask; mask &= mask - 1, ++k)
    if (bits & mask & (~mask + 1)) result |= uint64_t(1) << k;
  return result;
#endif
}

// Four bits to the lower half of each byte, and one bit to each byte.
QSES_FN uint64_t spread_by_four(uint64_t v) {
#if defined(__BMI2__)
  return _pdep_u64(v, 0x0f0f0f0f0f0f0f0full);
#else
  v = (v | v << 16) & 0x0000ffff0000ffffull;
  v = (v | v << 8) & 0x00ff00ff00ff00ffull;
  return (v | v << 4) & 0x0f0f0f0f0f0f0f0full;
#endif
}
QSES_FN uint64_t spread_bits(uint32_t bits) {
#if defined(__BMI2__)
  return _pdep_u64(bits, 0x0101010101010101ull);
#else
  const uint64_t v = bits;
  return ((v & 0x7f) * 0x0002040810204081ull & 0x0101010101010101ull) | (v & 0x80) << 49;
#endif
}

// Exchanges two bits of the numbers of a word's bits. first_only: the numbers with the first bit but not the second.
template <int kFirst, int kSecond>
QSES_FN uint64_t exchange_number_bits(uint64_t w, uint64_t first_only) {
  constexpr int kShift = (1 << kSecond) - (1 << kFirst);
  const uint64_t differs = (w ^ w >> kShift) & first_only;
  return w ^ differs ^ differs << kShift;
}
// A leaf word as blocks of 2 x 2 x 2 points: bit x + 2 y + 4 z of byte x + 2 y + 4 z. And back.
QSES_FN uint64_t to_blocks(uint64_t w) {
  w = exchange_number_bits<1, 2>(w, 0x0c0c0c0c0c0c0c0cull);
  w = exchange_number_bits<2, 4>(w, 0x0000f0f00000f0f0ull);
  return exchange_number_bits<3, 4>(w, 0x0000ff000000ff00ull);
}
QSES_FN uint64_t from_blocks(uint64_t w) {
  w = exchange_number_bits<3, 4>(w, 0x0000ff000000ff00ull);
  w = exchange_number_bits<2, 4>(w, 0x0000f0f00000f0f0ull);
  return exchange_number_bits<1, 2>(w, 0x0c0c0c0c0c0c0c0cull);
}
// The point of a bit of the blocks, counted from the leaf's first.
QSES_FN glm::ivec3 block_point(int bit) {
  const int block = bit >> 3;
  return glm::ivec3((bit & 1) + 2 * (block & 1), (bit >> 1 & 1) + (block & 2), (bit >> 2 & 1) + (block >> 1 & 2));
}

// What the bits of a byte add to the point of its first bit: in a word in blocks, and in a leaf word.
struct BlockSteps {
  static constexpr float kSteps[3][kPackSize] = {
      {0, 1, 0, 1, 0, 1, 0, 1}, {0, 0, 1, 1, 0, 0, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}};
  QSES_FN static glm::ivec3 first_of(int byte) { return block_point(8 * byte); }
};
struct LeafSteps {
  static constexpr float kSteps[3][kPackSize] = {
      {0, 1, 2, 3, 0, 1, 2, 3}, {0, 0, 0, 0, 1, 1, 1, 1}, {0, 0, 0, 0, 0, 0, 0, 0}};
  QSES_FN static glm::ivec3 first_of(int byte) { return glm::ivec3(0, 2 * (byte & 1), byte >> 1); }
};

// Places of a brick's points in an array with rows of kRow points and layers of kLayer: by leaf, and by bit in it.
template <int kRow, int kLayer>
struct PointPlaces {
  int16_t of_bit[64];
  static constexpr int of(int x, int y, int z) { return x + kRow * y + kLayer * z; }
  static constexpr int of_leaf(int leaf) { return kLeafEdge * of(leaf & 1, leaf >> 1 & 1, leaf >> 2); }
  constexpr PointPlaces() : of_bit() {
    for (int bit = 0; bit < 64; ++bit) of_bit[bit] = static_cast<int16_t>(of(bit & 3, bit >> 2 & 3, bit >> 4));
  }
};

// Where the points of a word lie, in its order, as Lattice::position() has it; `first` is the leaf's first point.
// Returns how many there are; room for eight more is needed.
template <class Steps>
QSES_FN int list_points(const Lattice &lattice, const glm::ivec3 &first, uint64_t word, float *x, float *y, float *z) {
  const Pack step_x = load_pack(Steps::kSteps[0]), step_y = load_pack(Steps::kSteps[1]),
             step_z = load_pack(Steps::kSteps[2]);
  const Pack spacing(lattice.spacing);
  int n = 0;
  for (int byte = 0; byte < 8; ++byte) {
    const uint32_t bits = static_cast<uint32_t>(word >> 8 * byte & 0xff);
    const glm::ivec3 at = first + Steps::first_of(byte);
    store_lanes(x + n, bits, (Pack(static_cast<float>(at.x)) + step_x) * spacing);
    store_lanes(y + n, bits, (Pack(static_cast<float>(at.y)) + step_y) * spacing);
    store_lanes(z + n, bits, (Pack(static_cast<float>(at.z)) + step_z) * spacing);
    n += popcount64(bits);
  }
  return n;
}

}  // namespace QSES_CPU_ISA
}  // namespace quickses
