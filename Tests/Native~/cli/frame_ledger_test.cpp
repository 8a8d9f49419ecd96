// SPDX-License-Identifier: MIT
// How the program deals out the frames of a trajectory: every frame once, results in order, and never too many at a
// time.
#include "cli/frame_ledger.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <random>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace quickses::cli {
namespace {

FrameResult result_of(const FrameTask &task, const std::string &error = "") {
  FrameResult result;
  result.place = task.place;
  result.frame = task.frame;
  result.error = error;
  return result;
}

TEST(FrameLedger, DealsOutTheFramesThatWereSelected) {
  FrameLedger ledger({5, 3, 4}, 100, [](const FrameResult &) {});
  for (uint64_t place = 0; place < 4; ++place) {
    const std::optional<FrameTask> task = ledger.next();
    ASSERT_TRUE(task);
    EXPECT_EQ(task->place, place);
    EXPECT_EQ(task->frame, 5 + 3 * place);
  }
  EXPECT_FALSE(ledger.next());
}

TEST(FrameLedger, PassesResultsOnInOrder) {
  std::vector<uint64_t> places;
  FrameLedger ledger({0, 1, 50}, 50, [&](const FrameResult &result) { places.push_back(result.place); });
  std::vector<FrameTask> tasks;
  while (const auto task = ledger.next()) tasks.push_back(*task);
  std::shuffle(tasks.begin(), tasks.end(), std::mt19937(7));
  std::set<uint64_t> delivered;
  for (const FrameTask &task : tasks) {
    ledger.deliver(result_of(task, task.place % 10 == 3 ? "broken" : ""));
    delivered.insert(task.place);
    uint64_t first_missing = 0;
    while (delivered.count(first_missing)) ++first_missing;
    EXPECT_EQ(places.size(), first_missing);  // all that can be passed on is
  }
  for (size_t i = 0; i < 50; ++i) EXPECT_EQ(places.at(i), i);
  EXPECT_EQ(ledger.failed_count(), 5u);
  EXPECT_NO_THROW(ledger.finish());
}

TEST(FrameLedger, HoldsFramesBackWhileAnOldOneIsMissing) {
  FrameLedger ledger({0, 1, 10}, 3, [](const FrameResult &) {});
  std::vector<FrameTask> tasks(3);
  for (FrameTask &task : tasks) ASSERT_EQ(ledger.try_next(task), FrameLedger::Answer::kTask);
  FrameTask task;
  EXPECT_EQ(ledger.try_next(task), FrameLedger::Answer::kLater);
  ledger.deliver(result_of(tasks[2]));
  ledger.deliver(result_of(tasks[1]));
  EXPECT_EQ(ledger.try_next(task), FrameLedger::Answer::kLater);
  ledger.deliver(result_of(tasks[0]));
  for (uint64_t place = 3; place < 6; ++place) {
    ASSERT_EQ(ledger.try_next(task), FrameLedger::Answer::kTask);
    EXPECT_EQ(task.place, place);
  }
  EXPECT_EQ(ledger.try_next(task), FrameLedger::Answer::kLater);
}

TEST(FrameLedger, HoldsFramesBackWhileLargeResultsWait) {
  FrameLedger ledger(
      {0, 1, 10}, 10, [](const FrameResult &) {}, 100);
  std::vector<FrameTask> tasks(3);
  for (FrameTask &task : tasks) ASSERT_EQ(ledger.try_next(task), FrameLedger::Answer::kTask);
  FrameResult large = result_of(tasks[2]);
  large.per_atom = std::string(60, 'a');
  large.page = std::string(60, 'p');
  ledger.deliver(large);
  FrameTask task;
  EXPECT_EQ(ledger.try_next(task), FrameLedger::Answer::kLater);
  ledger.deliver(result_of(tasks[0]));
  EXPECT_EQ(ledger.try_next(task), FrameLedger::Answer::kLater);
  ledger.deliver(result_of(tasks[1]));
  EXPECT_EQ(ledger.try_next(task), FrameLedger::Answer::kTask);
  EXPECT_EQ(task.place, 3u);
}

TEST(FrameLedger, AllThatAResultHoldsCounts) {
  for (std::string FrameResult::*part : {&FrameResult::csv, &FrameResult::json, &FrameResult::page,
                                         &FrameResult::per_atom, &FrameResult::per_residue, &FrameResult::error}) {
    FrameLedger ledger(
        {0, 1, 10}, 10, [](const FrameResult &) {}, 100);
    const FrameTask first = *ledger.next(), second = *ledger.next();
    FrameResult large = result_of(second);
    large.*part = std::string(101, 'x');
    ledger.deliver(large);
    FrameTask task;
    EXPECT_EQ(ledger.try_next(task), FrameLedger::Answer::kLater);
    ledger.deliver(result_of(first));
    EXPECT_EQ(ledger.try_next(task), FrameLedger::Answer::kTask);
  }
}

TEST(FrameLedger, ManyWorkers) {
  constexpr size_t kFrames = 2000;
  constexpr size_t kWindow = 6;
  std::vector<uint64_t> places;  // only the sink writes, and never two at a time
  std::atomic<uint64_t> passed_on{0};
  FrameLedger ledger({0, 1, kFrames}, kWindow, [&](const FrameResult &result) {
    places.push_back(result.place);
    passed_on = places.size();
  });
  std::atomic<int> too_far{0};
  std::vector<std::thread> workers;
  for (int k = 0; k < 5; ++k)
    workers.emplace_back([&] {
      while (const std::optional<FrameTask> task = ledger.next()) {
        if (task->place > passed_on + kWindow) ++too_far;
        ledger.deliver(result_of(*task));
      }
    });
  for (std::thread &worker : workers) worker.join();
  ledger.finish();
  EXPECT_EQ(too_far, 0);
  ASSERT_EQ(places.size(), kFrames);
  for (size_t i = 0; i < kFrames; ++i) ASSERT_EQ(places[i], i);
}

TEST(FrameLedger, ASlowSinkHoldsUpNobody) {
  std::promise<void> begun, may_end;
  std::vector<uint64_t> places;
  FrameLedger ledger({0, 1, 4}, 10, [&](const FrameResult &result) {
    if (result.place == 0) {
      begun.set_value();
      may_end.get_future().wait();
    }
    places.push_back(result.place);
  });
  const FrameTask first = *ledger.next(), second = *ledger.next();
  std::thread slow([&] { ledger.deliver(result_of(first)); });
  begun.get_future().wait();
  ledger.deliver(result_of(second));  // would wait for ever, as would the next
  EXPECT_EQ(ledger.next()->place, 2u);
  EXPECT_TRUE(places.empty());
  may_end.set_value();
  slow.join();
  EXPECT_EQ(places, (std::vector<uint64_t>{0, 1}));
  EXPECT_NO_THROW(ledger.finish());
}

TEST(FrameLedger, ASinkThatFailsEndsTheRun) {
  FrameLedger ledger({0, 1, 100}, 10, [](const FrameResult &result) {
    if (result.place == 2) throw std::runtime_error("the disk is full");
  });
  for (int k = 0; k < 3; ++k) ledger.deliver(result_of(*ledger.next()));
  EXPECT_FALSE(ledger.next());
  EXPECT_THROW(ledger.finish(), std::runtime_error);
}

TEST(FrameLedger, AWorkerThatGivesUpWakesThoseThatWait) {
  FrameLedger ledger({0, 1, 100}, 1, [](const FrameResult &) {});
  ASSERT_TRUE(ledger.next());
  std::thread waiting([&] { EXPECT_FALSE(ledger.next()); });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));  // by then it waits, as a rule
  ledger.give_up(std::make_exception_ptr(std::runtime_error("no memory")));
  waiting.join();
  EXPECT_THROW(ledger.finish(), std::runtime_error);
}

}  // namespace
}  // namespace quickses::cli
