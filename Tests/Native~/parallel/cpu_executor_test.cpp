// SPDX-License-Identifier: MIT
// The CPU's sort, which is put together from Thrust's parts, its scan, and passes in two steps.
#include "parallel/cpu_executor.h"
#include "parallel/two_step_pass.h"

#include <gtest/gtest.h>

#if defined(__linux__)
#include <sched.h>
#endif

#include <algorithm>
#include <atomic>
#include <numeric>
#include <random>
#include <thread>
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
  executor.sort_by_key(sorted, values);
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

// A number that counts how often the last place of a result is written.
struct WatchedSum {
  static inline const WatchedSum *watched = nullptr;
  static inline std::atomic<int> written{0};
  uint64_t value;
  WatchedSum(uint64_t v = 0) : value(v) {}
  WatchedSum(const WatchedSum &) = default;
  WatchedSum &operator=(const WatchedSum &other) {
    if (this == watched) ++written;
    value = other.value;
    return *this;
  }
  WatchedSum operator+(const WatchedSum &other) const { return value + other.value; }
};

struct LoadNumber {
  uint64_t operator()(size_t i) const { return i % 7; }
};

// Also where there are more chunks than there is work for, so that the last ones are empty.
TEST(CpuExecutor, ScansAndWritesTheTotalOnce) {
  for (unsigned threads : {1u, 2u, 3u, 68u}) {
    CpuExecutor executor(threads);
    for (size_t n : {0, 1, 2, 100, 65535, 65536, 65560, 65800, 300001}) {
      SCOPED_TRACE(testing::Message() << threads << " threads, " << n << " items");
      executor.arena().reset();
      const Span<WatchedSum> out = executor.allocate<WatchedSum>(n + 1);
      WatchedSum::written = 0;
      WatchedSum::watched = out.data + n;
      executor.exclusive_scan(n, LoadNumber{}, out);
      EXPECT_EQ(WatchedSum::written, 1);
      uint64_t sum = 0;
      for (size_t i = 0; i < n; sum += LoadNumber{}(i), ++i) ASSERT_EQ(out[i].value, sum) << i;
      EXPECT_EQ(out[n].value, sum);
    }
  }
}

TEST(CpuExecutor, StepsInTurn) {
  for (unsigned threads : {1u, 3u}) {
    CpuExecutor executor(threads);
    for (size_t n : {0, 1, 1000, 100003}) {
      executor.arena().reset();
      const Span<uint64_t> numbers = executor.allocate<uint64_t>(n), sums = executor.allocate<uint64_t>(n + 1),
                           reversed = executor.allocate<uint64_t>(n + 1);
      do_in_turn(executor, ForEach{n, [=](size_t i) { numbers.data[i] = i % 5; }},
                 Scan{n, LoadCount<uint64_t>{numbers.data}, sums},
                 ForEach{n + 1, [=](size_t i) { reversed.data[i] = sums.data[n - i]; }});
      uint64_t sum = 0;
      for (size_t i = 0; i <= n; sum += i % 5, ++i) ASSERT_EQ(reversed[n - i], sum) << n << ", " << i;
    }
  }
}

// Counts looks at each item; every third is left for the second step.
struct EveryThird {
  uint32_t *looks, *second;
  bool is_done_at_a_glance(size_t i) const {
    ++looks[i];
    return i % 3 != 0;
  }
  void finish(size_t i) const { ++second[i]; }
};

TEST(CpuExecutor, FinishesInASecondStepWhatIsLeft) {
  for (unsigned threads : {1u, 3u}) {
    CpuExecutor executor(threads);
    for (size_t n : {0, 1, 127, 128, 129, 10007}) {
      std::vector<uint32_t> looks(n, 0), second(n, 0);
      for_each_in_two_steps(executor, n, EveryThird{looks.data(), second.data()});
      for (size_t i = 0; i < n; ++i) {
        ASSERT_EQ(looks[i], 1u);
        ASSERT_EQ(second[i], i % 3 == 0 ? 1u : 0u);
      }
    }
  }
}

#if defined(__linux__)
// As a batch system or taskset says it, whatever the machine has.
TEST(CpuExecutor, StartsNoMoreThreadsThanItMayHaveProcessors) {
  std::thread([] {
    cpu_set_t all, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
    CPU_ZERO(&one);
    for (int cpu = 0; CPU_COUNT(&one) == 0; ++cpu)
      if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    CpuExecutor executor(8);
    const std::thread::id caller = std::this_thread::get_id();
    std::atomic<int> done{0}, by_others{0};
    for (int pass = 0; pass < 100; ++pass)
      executor.for_each(100000, [&](size_t) {
        ++done;
        if (std::this_thread::get_id() != caller) ++by_others;
      });
    EXPECT_EQ(done, 100 * 100000);
    EXPECT_EQ(by_others, 0);
  }).join();
}
#endif

}  // namespace
