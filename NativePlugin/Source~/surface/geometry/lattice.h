// SPDX-License-Identifier: MIT
// The SES grid: a lattice of spacing h anchored to the global origin, cut into bricks of 8x8x8 points and leaves of
// 4x4x4 (eight to a brick). The centred frame has its origin at a brick corner near the middle of the molecule, so that
// float32 is at its best there and the lattice does not swim from frame to frame.
#pragma once

#include "surface/geometry/types.h"

namespace quickses {

constexpr int kBrickEdge = 8;       // lattice points
constexpr int kLeafEdge = 4;        // lattice points
constexpr int kLeavesPerBrick = 8;  // leaf = x half + 2 * y half + 4 * z half
constexpr int kBrickPoints = kBrickEdge * kBrickEdge * kBrickEdge;
constexpr int kAxes = 3;

constexpr float kRoot3 = 1.7320508f;

struct Lattice {
  float spacing;                        // h
  double center_x, center_y, center_z;  // where the centred frame's origin is in the caller's coordinates
  glm::ivec3 first_brick;               // of the table of bricks, in the centred frame
  glm::ivec3 brick_count;               // size of the table of bricks

  QSES_FN float brick_size() const { return spacing * static_cast<float>(kBrickEdge); }
  QSES_FN uint64_t table_size() const {
    return static_cast<uint64_t>(brick_count.x) * static_cast<uint64_t>(brick_count.y) *
           static_cast<uint64_t>(brick_count.z);
  }
  QSES_FN bool has(const glm::ivec3 &brick) const {
    return brick.x >= 0 && brick.y >= 0 && brick.z >= 0 && brick.x < brick_count.x && brick.y < brick_count.y &&
           brick.z < brick_count.z;
  }
  // Linear brick index: x fastest. For tables.
  QSES_FN uint64_t linear(const glm::ivec3 &brick) const {
    return static_cast<uint64_t>(brick.x) +
           static_cast<uint64_t>(brick_count.x) *
               (static_cast<uint64_t>(brick.y) + static_cast<uint64_t>(brick_count.y) * static_cast<uint64_t>(brick.z));
  }
  QSES_FN glm::ivec3 brick_at(uint64_t linear) const {
    const uint64_t nx = static_cast<uint64_t>(brick_count.x), ny = static_cast<uint64_t>(brick_count.y);
    const uint64_t row = linear / nx;
    return glm::ivec3(static_cast<int>(linear - row * nx), static_cast<int>(row % ny), static_cast<int>(row / ny));
  }
  // Number, in the centred frame, of a brick's first lattice point along each axis.
  QSES_FN glm::ivec3 first_point(const glm::ivec3 &brick) const {
    return glm::ivec3((brick.x + first_brick.x) * kBrickEdge, (brick.y + first_brick.y) * kBrickEdge,
                      (brick.z + first_brick.z) * kBrickEdge);
  }
  // One rounding only, and the same on both back ends.
  QSES_FN Vec3<float> position(int x, int y, int z) const {
    return {static_cast<float>(x) * spacing, static_cast<float>(y) * spacing, static_cast<float>(z) * spacing};
  }
  QSES_FN Vec3<float> from_caller(const float *p) const {
    return {static_cast<float>(static_cast<double>(p[0]) - center_x),
            static_cast<float>(static_cast<double>(p[1]) - center_y),
            static_cast<float>(static_cast<double>(p[2]) - center_z)};
  }
  QSES_FN glm::vec3 to_caller(const Vec3<float> &p) const {
    return glm::vec3(static_cast<float>(static_cast<double>(p.x) + center_x),
                     static_cast<float>(static_cast<double>(p.y) + center_y),
                     static_cast<float>(static_cast<double>(p.z) + center_z));
  }
};

// The place of a brick in one word. Words are ordered as linear indices are, and so is the output; to take one apart
// needs no division.
constexpr int kPlaceBits = 21;  // of each coordinate
QSES_FN uint64_t pack_place(const glm::ivec3 &b) {
  return static_cast<uint64_t>(b.x) | static_cast<uint64_t>(b.y) << kPlaceBits |
         static_cast<uint64_t>(b.z) << (2 * kPlaceBits);
}
QSES_FN glm::ivec3 unpack_place(uint64_t word) {
  constexpr uint64_t kMask = (uint64_t(1) << kPlaceBits) - 1;
  return glm::ivec3(static_cast<int>(word & kMask), static_cast<int>(word >> kPlaceBits & kMask),
                    static_cast<int>(word >> (2 * kPlaceBits)));
}

// An edge of the lattice, or what is left of it, that the surface crosses.
struct CutEdge {
  Vec3<float> inside, outside;
  QSES_FN Vec3<float> middle() const { return (inside + outside) * 0.5f; }
};

// Bits of a leaf word: lattice point (x, y, z) of the leaf is bit x + 4 y + 16 z. Bits of a set mean "inside".
QSES_FN int leaf_bit(int x, int y, int z) { return x + 4 * y + 16 * z; }
QSES_FN int leaf_of(int x, int y, int z) { return (x >> 2) + 2 * (y >> 2) + 4 * (z >> 2); }

// The point of a leaf's bit, counted from the brick's first point.
QSES_FN glm::ivec3 brick_point(int leaf, int bit) {
  return glm::ivec3(4 * (leaf & 1) + (bit & 3), 4 * (leaf >> 1 & 1) + (bit >> 2 & 3), 4 * (leaf >> 2) + (bit >> 4));
}

// The leaf word seen one lattice point further along an axis: w is the leaf, next its neighbour on that side. Word: of
// one leaf, or several side by side.
template <class Word>
QSES_FN Word shift_x(Word w, Word next) {
  return (w >> 1 & 0x7777777777777777ull) | (next & 0x1111111111111111ull) << 3;
}
template <class Word>
QSES_FN Word shift_y(Word w, Word next) {
  return (w >> 4 & 0x0fff0fff0fff0fffull) | (next & 0x000f000f000f000full) << 12;
}
template <class Word>
QSES_FN Word shift_z(Word w, Word next) {
  return w >> 16 | next << 48;
}
// The same one point back.
template <class Word>
QSES_FN Word shift_x_back(Word w, Word before) {
  return (w & 0x7777777777777777ull) << 1 | (before >> 3 & 0x1111111111111111ull);
}
template <class Word>
QSES_FN Word shift_y_back(Word w, Word before) {
  return (w & 0x0fff0fff0fff0fffull) << 4 | (before >> 12 & 0x000f000f000f000full);
}
template <class Word>
QSES_FN Word shift_z_back(Word w, Word before) {
  return w << 16 | before >> 48;
}

}  // namespace quickses
