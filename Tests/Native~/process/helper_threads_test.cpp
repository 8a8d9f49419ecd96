// SPDX-License-Identifier: MIT
// Threads that help: who comes does all of its work before the call returns, and nobody waits for who does not.
#include "process/helper_threads.h"

#include "process/forked_child.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

namespace {

using quickses::HelperThreads;

constexpr size_t kWorkers = 8;

// Items shared out among the workers, as a pass does it.
struct Items {
  static constexpr int kCount = 200;
  std::atomic<int> next{0}, at_work{0};
  int done[kCount] = {};
  std::atomic<int> begun[kWorkers] = {};

  static void work(const void *of, size_t worker) {
    Items &items = *static_cast<Items *>(const_cast<void *>(of));
    ++items.at_work;
    ++items.begun[worker];
    for (int k; (k = items.next++) < kCount;) ++items.done[k];
    --items.at_work;
  }
};

void run_often(HelperThreads *threads, size_t workers, int trials = 500) {
  for (int trial = 0; trial < trials; ++trial) {
    Items items;
    threads->run(workers, &Items::work, &items);
    ASSERT_EQ(items.at_work, 0);
    for (int done : items.done) ASSERT_EQ(done, 1);
    ASSERT_EQ(items.begun[0], 1);
    for (size_t k = 1; k < kWorkers; ++k) ASSERT_LE(items.begun[k], k < workers ? 1 : 0);
  }
}

TEST(HelperThreads, AllWorkIsDoneOnce) {
  for (unsigned helpers : {0u, 1u, 3u, 7u, 20u}) {
    HelperThreads threads(helpers);
    EXPECT_EQ(threads.count(), helpers);
    for (size_t workers : {size_t(1), size_t(2), kWorkers}) run_often(&threads, workers);
  }
}

// Also if they sleep when they are called.
TEST(HelperThreads, ComeAfterARest) {
  HelperThreads threads(2);
  for (int trial = 0; trial < 20; ++trial) {
    std::atomic<int> here{0};
    // The caller waits for both helpers, which would never end if one did not come.
    threads.run(
        3,
        [](const void *of, size_t) {
          auto &all = *static_cast<std::atomic<int> *>(const_cast<void *>(of));
          ++all;
          while (all < 3) std::this_thread::yield();
        },
        &here);
    EXPECT_EQ(here, 3);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

TEST(HelperThreads, CallersDoNotWaitForEachOther) {
  std::vector<std::thread> callers;
  for (int k = 0; k < 4; ++k)
    callers.emplace_back([] {
      HelperThreads threads(3);
      run_often(&threads, 4);
    });
  for (std::thread &caller : callers) caller.join();
}

TEST(HelperThreads, EndAtOnceAndWithoutWork) {
  for (int trial = 0; trial < 200; ++trial) {
    HelperThreads threads(4);
    if (trial % 2) run_often(&threads, 3, 1);
  }
}

#if defined(QSES_TEST_FORKS)
[[noreturn]] void fork_while_they(bool sleep) {
  auto threads = std::make_unique<HelperThreads>(3);
  run_often(threads.get(), 4);
  if (sleep) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const bool child_ends = forked_child_ends([&threads] {
    if (threads->count() != 0) std::_Exit(1);
    run_often(threads.get(), 4);
    threads.reset();
  });
  run_often(threads.get(), 4);
  threads.reset();
  std::_Exit(child_ends && !testing::Test::HasFailure() ? 0 : 1);
}
TEST(HelperThreads, AreNotWaitedForInAForkedChild) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  for (const bool sleep : {true, false}) EXPECT_EXIT(fork_while_they(sleep), testing::ExitedWithCode(0), "") << sleep;
}
#endif

}  // namespace
