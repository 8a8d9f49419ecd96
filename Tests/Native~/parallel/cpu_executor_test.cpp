// SPDX-License-Identifier: MIT
// The CPU's sort, which is put together from Thrust's parts.
#include "parallel/cpu_executor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

using namespace quickses;

namespace {

// Keys below `different`, each with its place as the value: sorted like std::stable_sort would.
void check_sort(CpuExecutor &executor, size_t n, uint64_t different) {
  std::mt19937_64 random(n + different);
  std::vector<uint64_t> keys(n);
  for (uint64_t &k : keys) k = random() % different;
  std::vector<uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return keys[a] < keys[b]; });

  executor.arena().reset();
  const Span<uint64_t> sorted = executor.allocate<uint64_t>(n);
  const Span<uint32_t> values = executor.allocate<uint32_t>(n);
  for (size_t i = 0; i < n; ++i) {
    sorted[i] = keys[i];
    values[i] = static_cast<uint32_t>(i);
  }
  executor.sort_by_key(sorted, values, 64);
  for (size_t i = 0; i < n; ++i) {
    ASSERT_EQ(values[i], order[i]) << n << " items, place " << i;
    ASSERT_EQ(sorted[i], keys[order[i]]);
  }
}

TEST(CpuExecutor, SortsStably) {
  for (unsigned threads : {1u, 2u, 3u}) {
    CpuExecutor executor(threads);
    for (size_t n : {0, 1, 2, 3, 100, 32768, 32769, 131072, 131073, 300001})
      for (uint64_t different : {uint64_t(1), uint64_t(50), ~uint64_t(0)}) check_sort(executor, n, different);
  }
}

}  // namespace
