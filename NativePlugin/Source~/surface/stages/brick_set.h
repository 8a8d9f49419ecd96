// SPDX-License-Identifier: MIT
// The bricks of a lattice that are active, as kernels see them, and the box that they lie in.
#pragma once

#include "parallel/anticipation.h"
#include "parallel/error.h"
#include "surface/geometry/lattice.h"
#include "surface/stages/neighbor_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace quickses {

// Bricks are numbered by signed 32-bit integers.
constexpr uint64_t kMaxBricks = 0x7fffffff;

// Where the words of bricks have a lattice point.
struct LocatedPoint {
  int brick;  // -1: in none that is active
  int leaf, bit;
  QSES_FN size_t word() const { return static_cast<size_t>(brick) * kLeavesPerBrick + static_cast<size_t>(leaf); }
};

// Active bricks as kernels see them.
struct BrickSet {
  Lattice lattice;
  const uint64_t *places;  // of each active brick, packed, in rising order
  const int32_t *table;    // by linear index: number of the active brick, -1 if inactive; nullptr if the set is sparse
  uint32_t count;
  const Tally<uint64_t> *found =
      nullptr;  // where their number is, if there may be fewer: the last ones then stand for none

  uint64_t table_entries() const { return table ? lattice.table_size() : 0; }
  QSES_FN glm::ivec3 place(size_t brick) const { return unpack_place(places[brick]); }
  // A table has fewer entries than 2^32.
  QSES_FN uint32_t place_in_table(const glm::ivec3 &b) const { return static_cast<uint32_t>(lattice.linear(b)); }
  // Number of the active brick at a place; -1 if there is none.
  QSES_FN int find(const glm::ivec3 &b) const {
    if (!lattice.has(b)) return -1;
    if (table) return table[place_in_table(b)];
    const uint64_t key = pack_place(b);
    const uint32_t k = lower_bound(places, count, key);
    return k < count && places[k] == key ? static_cast<int>(k) : -1;
  }
  // Of a point that is counted from the first one of an active brick.
  QSES_FN LocatedPoint locate(uint32_t brick, const glm::ivec3 &p) const {
    const bool is_own = ((p.x | p.y | p.z) & ~7) == 0;
    const int x = p.x & 7, y = p.y & 7, z = p.z & 7;
    return {is_own ? static_cast<int>(brick) : find(place(brick) + glm::ivec3(p.x >> 3, p.y >> 3, p.z >> 3)),
            leaf_of(x, y, z), leaf_bit(x & 3, y & 3, z & 3)};
  }
  // As find() for several at once: found[k] of place_of(k). With a table nothing depends on what was found before, so
  // that a GPU waits for all of them together.
  template <int kCount, class PlaceOf>
  QSES_FN void find_each(const PlaceOf &place_of, int *found) const {
    if (table) {
#if defined(__CUDA_ARCH__)
#pragma unroll
#elif !defined(__CUDACC__)
#pragma GCC unroll 27
#endif
      for (int k = 0; k < kCount; ++k) {
        const glm::ivec3 b = place_of(k);
        const bool is_within = lattice.has(b);
        const int number = table[is_within ? place_in_table(b) : 0];
        found[k] = is_within ? number : -1;
      }
    } else {
      for (int k = 0; k < kCount; ++k) found[k] = find(place_of(k));
    }
  }
};

// A run of bricks in linear order; a slice is one.
struct BrickRange {
  uint32_t first, last;
  QSES_FN uint32_t size() const { return last - first; }
};

// Atoms may lie this many spacings from the middle of them all: a float32 coordinate then still tells eight places
// between two lattice points, and all numbers of bricks are far from overflowing.
constexpr double kMaxLatticeReach = 2097152;  // 2^21

// low and high bound the atoms' centres in the centred frame.
inline Lattice layout_lattice(Lattice lattice, const glm::vec3 &low, const glm::vec3 &high, float max_radius) {
  const double size = static_cast<double>(lattice.spacing) * kBrickEdge;
  double farthest = 0;
  for (int d = 0; d < 3; ++d)
    farthest = std::max({farthest, std::fabs(static_cast<double>(low[d])), std::fabs(static_cast<double>(high[d]))});
  if (farthest > kMaxLatticeReach * static_cast<double>(lattice.spacing)) {
    char text[200];
    std::snprintf(
        text, sizeof text,
        "spacing %g Å is too fine for atoms that lie %.3g Å from the middle of them all: float32 tells places "
        "apart there for spacings from %.2g Å",
        static_cast<double>(lattice.spacing), farthest, farthest / kMaxLatticeReach);
    throw Error(QSES_TOO_FINE, text);
  }
  for (int d = 0; d < 3; ++d) {
    const double reach = static_cast<double>(max_radius) + 2.0 * lattice.spacing;
    const double first = std::floor((low[d] - reach) / size) - 1.0, last = std::floor((high[d] + reach) / size) + 1.0;
    lattice.first_brick[d] = static_cast<int>(first);
    if (last - first >= double(1 << kPlaceBits) - 1)
      throw Error(QSES_TOO_FINE, "the SES grid would be too large: use a larger spacing");
    lattice.brick_count[d] = static_cast<int>(last - first) + 1;
  }
  return lattice;
}

}  // namespace quickses
