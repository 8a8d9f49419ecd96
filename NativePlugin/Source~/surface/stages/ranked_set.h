// SPDX-License-Identifier: MIT
// Choices among the vertices or triangles of a mesh, with the place of each among the chosen.
#pragma once

#include "parallel/atomics.h"
#include "parallel/executor.h"
#include "parallel/platform.h"

namespace quickses {

// A set of numbers as bits, with the count of those before each word: a sixteenth of the memory that a table of
// new numbers would take.
struct RankedSet {
  uint32_t *words = nullptr;   // or nullptr: all
  uint32_t *before = nullptr;  // words + 1 of them

  QSES_FN bool has(uint32_t i) const { return !words || (words[i / 32] >> (i % 32) & 1); }
  QSES_FN uint32_t rank(uint32_t i) const {
    if (!words) return i;
    const uint32_t lower = (uint32_t(1) << i % 32) - 1, chosen = words[i / 32] & lower;
    // Mostly all of a word are: counting bits is slow where processors have no instruction for it.
    return before[i / 32] + (chosen == lower ? i % 32 : static_cast<uint32_t>(popcount64(chosen)));
  }
  QSES_FN void drop(uint32_t i) const { atomic_and(words + i / 32, ~(uint32_t(1) << i % 32)); }
};

struct CountWord {
  const uint32_t *words;
  QSES_HOST_DEVICE uint64_t operator()(size_t i) const { return static_cast<uint64_t>(popcount64(words[i])); }
};

struct FillWord {
  uint32_t *words;
  size_t n;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    words[i] = n - 32 * i >= 32 ? ~uint32_t(0) : (uint32_t(1) << (n - 32 * i)) - 1;
  }
};

// Without members.
template <class Executor>
RankedSet allocate_set(Executor &executor, size_t n) {
  const size_t words = (n + 31) / 32;
  Span<uint32_t> bits = executor.template allocate_zeros<uint32_t>(words);
  return {bits.data, executor.template allocate<uint32_t>(words + 1).data};
}
template <class Executor>
RankedSet allocate_full_set(Executor &executor, size_t n) {
  const size_t words = (n + 31) / 32;
  const RankedSet set{executor.template allocate<uint32_t>(words).data,
                      executor.template allocate<uint32_t>(words + 1).data};
  executor.for_each(words, FillWord{set.words, n});
  return set;
}

// Counts those before each word.
template <class Executor>
void count_before(Executor &executor, const RankedSet &set, size_t n) {
  const size_t words = (n + 31) / 32;
  executor.exclusive_scan(words, CountWord{set.words}, Span<uint32_t>{set.before, words + 1});
}
// Returns how many there are, too. Waits.
template <class Executor>
uint32_t rank_set(Executor &executor, const RankedSet &set, size_t n) {
  count_before(executor, set, n);
  return executor.fetch(set.before + (n + 31) / 32);
}

}  // namespace quickses
