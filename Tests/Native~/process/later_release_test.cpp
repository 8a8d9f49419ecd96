// SPDX-License-Identifier: MIT
// Memory that nobody waits for is given back all the same, once, and not by whoever hands it over; also while the
// process ends, or a child of it.
#include "process/later_release.h"

#include "process/forked_child.h"

#include <gtest/gtest.h>

#if !defined(_WIN32)
#include <sys/wait.h>
#endif

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>
#include <vector>

namespace quickses {
namespace {

struct Item {
  std::atomic<int> releases{0};
  std::atomic<std::thread::id> thread{};
};
void release_item(void *memory) {
  Item &item = *static_cast<Item *>(memory);
  item.thread = std::this_thread::get_id();
  ++item.releases;
}

std::atomic<bool> is_open{false};
void release_behind_gate(void *memory) {
  while (!is_open) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  release_item(memory);
}

void wait_for(const Item &item) {
  while (item.releases == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(LaterRelease, ReleasesOnceOnAnotherThread) {
  std::vector<Item> items(100);
  for (Item &item : items) release_later(release_item, &item);
  for (const Item &item : items) wait_for(item);
  for (const Item &item : items) {
    EXPECT_EQ(item.releases, 1);
    EXPECT_NE(item.thread.load(), std::this_thread::get_id());
  }
}

// Were it released here, the gate would never open.
TEST(LaterRelease, DoesNotWait) {
  Item slow, next;
  release_later(release_behind_gate, &slow);
  release_later(release_item, &next);
  EXPECT_EQ(slow.releases, 0);
  is_open = true;
  wait_for(slow);
  wait_for(next);
}

TEST(LaterRelease, HasNothingToDoForNull) {
  release_later([](void *) { ADD_FAILURE() << "there is no memory"; }, nullptr);
}

TEST(LaterRelease, TakesItemsFromAllThreads) {
  std::vector<Item> items(64);
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t)
    threads.emplace_back([&items, t] {
      for (int k = 0; k < 8; ++k) release_later(release_item, &items[static_cast<size_t>(8 * t + k)]);
    });
  for (std::thread &thread : threads) thread.join();
  for (const Item &item : items) wait_for(item);
  for (const Item &item : items) EXPECT_EQ(item.releases, 1);
}

#if !defined(_WIN32)  // which ends all threads first
std::atomic<bool> has_begun{false}, is_ending{false};
std::atomic<int> slowness_ms{0};  // from then on
void release_slowly(void *memory) {
  has_begun = true;
  while (!is_ending) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(slowness_ms));
  release_item(memory);
}
void wait_until_begun() {
  while (!has_begun) std::this_thread::yield();
}

class LaterReleaseAtTheEnd : public testing::Test {
 protected:
  // Each is a fresh process: threads do not survive a fork.
  void SetUp() override { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
};

enum Outcome { kNextIsNotBegun, kNotWaitedFor, kNextIsReleased, kNotEnded };
[[noreturn]] void end_while_one_is_released(int ms) {
  static Item begun, next;
  std::atexit([] {
    std::_Exit(begun.releases == 0 ? kNotWaitedFor : next.releases == 0 ? kNextIsNotBegun : kNextIsReleased);
  });
  slowness_ms = ms;
  release_later(release_slowly, &begun);
  wait_until_begun();
  release_later(release_item, &next);
  std::atexit([] { is_ending = true; });  // just before the library waits
  std::exit(kNotEnded);
}
// The next one may be released as long as the library has not heard of the end, which is late where the machine stands
// still for longer than the release takes.
TEST_F(LaterReleaseAtTheEnd, IsWaitedForOnceBegun) {
  int outcome = kNextIsReleased;
  const auto is_waited_for = [&outcome](int status) {
    outcome = WEXITSTATUS(status);
    return WIFEXITED(status) && (outcome == kNextIsNotBegun || outcome == kNextIsReleased);
  };
  for (int ms = 100; ms <= 12800 && outcome == kNextIsReleased; ms *= 2)
    EXPECT_EXIT(end_while_one_is_released(ms), is_waited_for, "");
  EXPECT_EQ(outcome, kNextIsNotBegun);
}

#if defined(QSES_TEST_FORKS)
[[noreturn]] void fork_while_one_is_released() {
  static Item item;
  release_later(release_slowly, &item);
  wait_until_begun();
  std::_Exit(forked_child_ends([] { is_ending = true; }) ? 0 : 1);
}
TEST_F(LaterReleaseAtTheEnd, IsNotWaitedForInAForkedChild) {
  EXPECT_EXIT(fork_while_one_is_released(), testing::ExitedWithCode(0), "");
}
#endif
#endif

}  // namespace
}  // namespace quickses
