// SPDX-License-Identifier: MIT
// Choices among the vertices or triangles of a mesh, with the place of each among the chosen.
#pragma once

#include "parallel/executor.h"
#include "parallel/platform.h"

namespace quickses {

// A set of numbers as bits, with the count of those before each word: an eighth of the memory that a table of new
// numbers would take.
struct RankedSet {
  uint32_t *words;
  uint32_t *before;  // words + 1 of them

  QSES_FN bool has(uint32_t i) const { return words[i / 32] >> (i % 32) & 1; }
  QSES_FN uint32_t rank(uint32_t i) const {
    return before[i / 32] + static_cast<uint32_t>(popcount64(words[i / 32] & ((uint32_t(1) << i % 32) - 1)));
  }
};

struct CountWord {
  const uint32_t *words;
  QSES_HOST_DEVICE uint64_t operator()(size_t i) const { return static_cast<uint64_t>(popcount64(words[i])); }
};

template <class Executor>
RankedSet allocate_set(Executor &executor, size_t n) {
  const size_t words = (n + 31) / 32;
  Span<uint32_t> bits = executor.template allocate<uint32_t>(words);
  executor.fill(bits, 0);
  return {bits.data, executor.template allocate<uint32_t>(words + 1).data};
}

// Returns how many there are. Waits.
template <class Executor>
uint32_t rank_set(Executor &executor, const RankedSet &set, size_t n) {
  const size_t words = (n + 31) / 32;
  executor.exclusive_scan(words, CountWord{set.words}, Span<uint32_t>{set.before, words + 1});
  return executor.fetch(set.before + words);
}

}  // namespace quickses
