// SPDX-License-Identifier: MIT
// The edges of a brick that may pass through thin walls (thin_walls.h), as words of its leaves: which they are by
// signs, from where their probes are looked for, and which of them these probes leave. Only for the CPU kernels.
#pragma once

#include "parallel/wide_pack.h"
#include "parallel/word_pack.h"
#include "surface/cpu/cpu_brick_signs.h"
#include "surface/cpu/cpu_leaf_bits.h"
#include "surface/stages/thin_walls.h"

namespace quickses {
namespace QSES_CPU_ISA {

// The words of the lower and the upper leaves of a brick. What is beyond the brick counts as 0.
struct BrickWords {
  WordPack half[2];
  QSES_FN static BrickWords load(const uint64_t *p) { return {{load_words(p), load_words(p + kPackWords)}}; }
  QSES_FN void store(uint64_t *p) const { store_words(p, half[0]), store_words(p + kPackWords, half[1]); }
};
QSES_FN BrickWords operator&(const BrickWords &a, const BrickWords &b) {
  return {{a.half[0] & b.half[0], a.half[1] & b.half[1]}};
}
QSES_FN BrickWords operator|(const BrickWords &a, const BrickWords &b) {
  return {{a.half[0] | b.half[0], a.half[1] | b.half[1]}};
}
QSES_FN BrickWords operator~(const BrickWords &a) { return {{~a.half[0], ~a.half[1]}}; }

// A step along an axis, or back.
struct Way {
  int axis;
  bool back;
  QSES_FN Way operator-() const { return {axis, !back}; }
};

// What is a step away comes here.
QSES_FN BrickWords seen(const BrickWords &w, Way way) {
  const WordPack &l = w.half[0], &h = w.half[1], none(0);
  if (way.back) {
    if (way.axis == 0) return {{shift_x_back(l, words_before(l)), shift_x_back(h, words_before(h))}};
    if (way.axis == 1) return {{shift_y_back(l, pairs_before(l)), shift_y_back(h, pairs_before(h))}};
    return {{shift_z_back(l, none), shift_z_back(h, l)}};
  }
  if (way.axis == 0) return {{shift_x(l, next_words(l)), shift_x(h, next_words(h))}};
  if (way.axis == 1) return {{shift_y(l, next_pairs(l)), shift_y(h, next_pairs(h))}};
  return {{shift_z(l, h), shift_z(h, none)}};
}

// Points whose probes are looked for: those of a leaf are numbered in the order of its bits, from first[leaf] on.
struct BrickStarts {
  uint64_t words[kLeavesPerBrick];
  int first[kLeavesPerBrick], count;
};

// What is known of starts, a bit for each: which points around them their probes cover, by the step there, or
// kWallSteps and the step from there; and whether there is no probe.
struct CoveredNeighbors {
  static constexpr int kSteps = 2 * kWallSteps, kBytes = kBrickPoints / 8 + 8;
  uint8_t by_step[kSteps][kBytes], solid[kBytes];
  QSES_FN static void set(uint8_t *bits, int first, WideMask mask) {
    for (int byte = 0; byte < kWideLanes / 8; ++byte)
      bits[first / 8 + byte] = static_cast<uint8_t>(lane_bits(mask) >> 8 * byte);
  }
  // Bits of so many: those behind are read with the last ones, and left out.
  QSES_FN void end(int count) {
    const auto clear = [&](uint8_t *bits) { std::memset(bits + (count + 7) / 8, 0, sizeof(uint64_t)); };
    for (uint8_t(&bits)[kBytes] : by_step) clear(bits);
    clear(solid);
  }
};

struct BrickEdges {
  alignas(32) uint64_t words[kWallSteps][kLeavesPerBrick];  // by the bits of their first ends

  // Those that signs leave, if there are any.
  QSES_FN bool find_candidates(const BrickSet &bricks, const uint64_t *signs, uint32_t brick) {
    const uint64_t *const own = signs + static_cast<size_t>(brick) * kLeavesPerBrick;
    if (!has_bits(~(load_words(own) & load_words(own + kPackWords)))) return false;
    alignas(32) static constexpr uint64_t kNoWords[kLeavesPerBrick] = {};  // no wall is where no brick is
    const NearWords near = find_near_words(bricks, signs, brick);
    alignas(32) uint64_t around[4][4][4];  // words of the leaves of the brick and next to it
    uint64_t any = 0;
    for (int z = 0; z < 4; ++z)
      for (int y = 0; y < 4; ++y) {
        const uint64_t *const *const at = near.at + 9 * ((z + 1) >> 1) + 3 * ((y + 1) >> 1);
        const int leaf = 2 * ((y + 1) & 1) + 4 * ((z + 1) & 1);
        const uint64_t *const left = (at[0] ? at[0] : kNoWords) + leaf,
                              *const middle = (at[1] ? at[1] : kNoWords) + leaf,
                              *const right = (at[2] ? at[2] : kNoWords) + leaf;
        uint64_t *const row = around[z][y];
        row[0] = left[1], row[1] = middle[0], row[2] = middle[1], row[3] = right[0];
        any |= row[0] | row[1] | row[2] | row[3];
      }
    if (any == 0) return false;
    WordPack left(0);
    for (int half = 0; half < 2; ++half) {
      WordNeighborhood<WordPack> leaves;
      WordPack *at = leaves.at;
      for (int z = half; z < half + 3; ++z)
        for (int y = 0; y < 3; ++y)
          for (int x = 0; x < 3; ++x) *at++ = load_word_pairs(&around[z][y][x], &around[z][y + 1][x]);
      WordPack found[kWallSteps];
      list_wall_candidates(leaves, found);
      for (int k = 0; k < kWallSteps; ++k) {
        left = left | found[k];
        store_words(words[k] + half * kPackWords, found[k]);
      }
    }
    return has_bits(left);
  }

  // use(step, leaf, bit of the first end). Most words have no bit, so that those that have are found first.
  template <class Use>
  QSES_FN void for_each(const Use &use) const {
    static_assert(kLeavesPerBrick == 8, "the words of eight steps are found at once");
    for (int first = 0; first < kWallSteps; first += 8) {
      uint64_t some = 0;
      for (int k = first; k < kWallSteps && k < first + 8; ++k)
        for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf)
          some |= static_cast<uint64_t>(words[k][leaf] != 0) << (8 * (k - first) + leaf);
      for (; some; some &= some - 1) {
        const int k = first + (lowest_bit64(some) >> 3), leaf = lowest_bit64(some) & 7;
        for (uint64_t rest = words[k][leaf]; rest; rest &= rest - 1) use(k, leaf, lowest_bit64(rest));
      }
    }
  }

  // Of points with even sums of coordinates, as every other one is, each edge along an axis has one as an end, and of
  // the diagonals half have two. Those of edges that leave the brick to such an end start at the other one.
  QSES_FN BrickStarts choose_starts() const {
    const WordPack even_words(0x5a5aa5a55a5aa5a5ull);
    const BrickWords even{{even_words, even_words}};
    BrickWords all = edges_of(0), starts{{WordPack(0), WordPack(0)}};
    for (int k = 1; k < kWallSteps; ++k) all = all | edges_of(k);
    for (int axis = 0; axis < kAxes; ++axis) {
      const BrickWords odd = edges_of(axis) & ~even;
      starts = starts | seen(odd, {axis, true}) | (odd & last_points(axis));
    }
    starts = starts | (all & even);
    BrickStarts chosen;
    starts.store(chosen.words);
    chosen.count = 0;
    for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) {
      chosen.first[leaf] = chosen.count;
      chosen.count += popcount64(chosen.words[leaf]);
    }
    return chosen;
  }

  // An edge is open if one probe covers both its ends: that of one of them, or of a point that both are steps away
  // from; or if an end is in the solid, since then its sign is a matter of rounding.
  QSES_FN void leave_out_covered(const BrickStarts &starts, const CoveredNeighbors &covered) {
    BrickWords to[CoveredNeighbors::kSteps];
    for (int k = 0; k < CoveredNeighbors::kSteps; ++k) to[k] = of_starts(starts, covered.by_step[k]);
    const BrickWords solid = of_starts(starts, covered.solid);
    // What covers the point a step along one axis, or two, away.
    const auto at = [&](Way u) -> const BrickWords & { return to[u.axis + (u.back ? kWallSteps : 0)]; };
    const auto at_both = [&](Way u, Way v) -> const BrickWords & {
      const Way first = u.axis < v.axis ? u : v;
      return to[kAxes + 2 * (u.axis + v.axis - 1) + (u.back != v.back) + (first.back ? kWallSteps : 0)];
    };
#pragma GCC unroll 3
    for (int axis = 0; axis < kAxes; ++axis) {
      const Way s{axis, false};
      BrickWords open = at(s) | solid, at_second = at(-s) | solid;
#pragma GCC unroll 4
      for (int side = 0; side < 4; ++side) {
        const Way u{(axis + 1 + side / 2) % kAxes, side % 2 != 0};
        open = open | seen(at(-u) & at_both(s, -u), u);
        at_second = at_second | seen(at(-u) & at_both(-s, -u), u);
      }
      leave_out(axis, open | seen(at_second, s));
    }
#pragma GCC unroll 6
    for (int k = kAxes; k < kWallSteps; ++k) {
      const int pair = (k - kAxes) / 2, third = 2 - pair;
      const Way s{pair / 2, false}, t{1 + (pair + 1) / 2, k % 2 == 0};  // the step is s + t
      BrickWords beyond_s = at(-s) & at(t), beyond_t = at(-t) & at(s);
#pragma GCC unroll 2
      for (int side = 0; side < 2; ++side) {
        const Way u{third, side != 0};
        beyond_s = beyond_s | seen(at_both(-s, -u) & at_both(t, -u), u);
        beyond_t = beyond_t | seen(at_both(-t, -u) & at_both(s, -u), u);
      }
      beyond_s = beyond_s | seen(at_both(-s, -t) | solid, t);
      leave_out(k, at_both(s, t) | solid | seen(beyond_s, s) | seen(beyond_t, t));
    }
  }

 private:
  QSES_FN BrickWords edges_of(int k) const { return BrickWords::load(words[k]); }
  QSES_FN void leave_out(int k, const BrickWords &open) { (edges_of(k) & ~open).store(words[k]); }
  QSES_FN static BrickWords last_points(int axis) {
    alignas(32) static constexpr uint64_t kLast[kAxes][kLeavesPerBrick] = {
        {0, 0x8888888888888888ull, 0, 0x8888888888888888ull, 0, 0x8888888888888888ull, 0, 0x8888888888888888ull},
        {0, 0, 0xf000f000f000f000ull, 0xf000f000f000f000ull, 0, 0, 0xf000f000f000f000ull, 0xf000f000f000f000ull},
        {0, 0, 0, 0, 0xffff000000000000ull, 0xffff000000000000ull, 0xffff000000000000ull, 0xffff000000000000ull}};
    return BrickWords::load(kLast[axis]);
  }
  // Bits of starts in their order, brought to their places. A leaf has no more than 32 even starts, and 19 others.
  QSES_FN static BrickWords of_starts(const BrickStarts &starts, const uint8_t *bits) {
    const auto placed = [&](int leaf) {
      uint64_t in_order;
      std::memcpy(&in_order, bits + starts.first[leaf] / 8, sizeof in_order);
      return deposit_bits(in_order >> starts.first[leaf] % 8, starts.words[leaf]);
    };
    return {
        {WordPack(placed(0), placed(1), placed(2), placed(3)), WordPack(placed(4), placed(5), placed(6), placed(7))}};
  }
};

}  // namespace QSES_CPU_ISA
}  // namespace quickses
