// SPDX-License-Identifier: MIT
// The helpers of Windows' thread pool: who comes does all of its work before the call returns, and nobody waits for who
// does not.
#include "parallel/windows_threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

namespace {

using quickses::WindowsThreads;

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

void run_often(WindowsThreads *threads, size_t workers) {
  for (int trial = 0; trial < 500; ++trial) {
    Items items;
    threads->run(workers, &Items::work, &items);
    ASSERT_EQ(items.at_work, 0);
    for (int done : items.done) ASSERT_EQ(done, 1);
    ASSERT_EQ(items.begun[0], 1);
    for (size_t k = 1; k < kWorkers; ++k) ASSERT_LE(items.begun[k], k < workers ? 1 : 0);
  }
}

TEST(WindowsThreads, AllWorkIsDoneOnce) {
  for (unsigned helpers : {1u, 3u, 7u, 64u}) {
    WindowsThreads threads(helpers);
    ASSERT_TRUE(threads.is_open());
    for (size_t workers : {size_t(1), size_t(2), kWorkers}) run_often(&threads, workers);
  }
}

TEST(WindowsThreads, PoolsDoNotWaitForEachOther) {
  std::vector<std::thread> callers;
  for (int k = 0; k < 4; ++k)
    callers.emplace_back([] {
      WindowsThreads threads(3);
      run_often(&threads, 4);
    });
  for (std::thread &caller : callers) caller.join();
}

TEST(WindowsThreads, HelpersCome) {
  WindowsThreads threads(1);
  std::atomic<bool> has_come{false};
  // The caller waits for the helper, which would never end if none came.
  threads.run(
      2,
      [](const void *of, size_t worker) {
        auto &come = *static_cast<std::atomic<bool> *>(const_cast<void *>(of));
        if (worker > 0) come = true;
        while (!come) std::this_thread::yield();
      },
      &has_come);
  EXPECT_TRUE(has_come);
}

}  // namespace
