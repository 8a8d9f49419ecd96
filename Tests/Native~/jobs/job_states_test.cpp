// SPDX-License-Identifier: MIT
// What jobs say of themselves, and what becomes of those that others follow, that are cancelled, or that fail.
#include "jobs/jobs_fixture.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

using namespace jobs_fixture;

namespace {

// Holds a job when so many of its levels are finished, and the job with another tag when it first tells how far it is.
// Lives longer than the context.
class TwoGates {
 public:
  explicit TwoGates(uint32_t levels) : levels_(levels) {}
  void place_in(qses_context *context) {
    context_ = context;
    expect_ok(qses_set_progress_callback(context, stop_at, this));
  }
  void wait_until_reached(uint32_t tag) const {
    while (reached_ != tag) std::this_thread::yield();
  }
  void open(uint32_t tag) { open_ = tag; }  // for the job with this tag

 private:
  static void stop_at(void *gates, double) {
    TwoGates &self = *static_cast<TwoGates *>(gates);
    const qses_progress p = poll(self.context_);
    if (p.tag == 1 && p.levels_finished < self.levels_) return;
    self.reached_ = p.tag;
    while (self.open_ < p.tag) std::this_thread::yield();
  }
  const uint32_t levels_;
  qses_context *context_ = nullptr;
  std::atomic<uint32_t> reached_{0}, open_{0};
};

// Of a job that another one follows, no more levels are made when one is there to be shown.
TEST(JobStates, ALevelUnderWayIsGivenUpForTheNextJob) {
  TwoGates gates(1);
  const Context context;
  set_atoms(context, block(20));
  gates.place_in(context);
  begin(context, settings(0.5), 1);
  gates.wait_until_reached(1);
  EXPECT_EQ(next_level(context).level, 0u);
  begin(context, settings(0.5), 2);
  gates.open(1);
  gates.wait_until_reached(2);
  qses_mesh m;
  qses_mesh_init(&m);
  EXPECT_EQ(qses_collect(context, &m), QSES_NOTHING_NEW);
  gates.open(2);
  wait_for_all(context);
  expect_ok(qses_collect(context, &m));
  EXPECT_EQ(m.tag, 2u);
}

// Else frames that come faster than levels would leave nothing to be shown.
TEST(JobStates, AJobThatIsFollowedMakesItsCoarsestLevelAndNoOther) {
  TwoGates gates(0);
  const Context context;
  set_atoms(context, block(10));
  gates.place_in(context);
  begin(context, settings(0.5), 1);
  gates.wait_until_reached(1);
  begin(context, settings(0.5), 2);
  gates.open(1);
  gates.wait_until_reached(2);
  const qses_mesh m = collected(context);
  EXPECT_EQ(m.tag, 1u);
  EXPECT_EQ(m.level, 0u);
  gates.open(2);
  wait_for_all(context);
}

// What is wrong with its arguments is said while a job runs.
TEST(JobStates, AnEstimateThatCanNotBeWrittenDoesNotWait) {
  Gate gate;
  const Context context;
  begin_held(gate, context, block(4), settings(0.5));
  qses_size_estimate unprepared{};
  EXPECT_EQ(qses_estimate(context, nullptr, &unprepared), QSES_INVALID_ARGUMENT);
  gate.open();
  wait_for_all(context);
}

TEST(JobStates, CancelTakesBackWhatWaits) {
  Gate gate;
  const Context context;
  begin_held(gate, context, block(20), settings(0.5), 1);
  begin(context, settings(0.5), 2);
  expect_ok(qses_cancel(context));
  gate.open();
  wait_for_all(context);
  const qses_progress p = poll(context);
  EXPECT_EQ(p.state, QSES_JOB_CANCELLED);
  EXPECT_EQ(p.tag, 1u);
  EXPECT_EQ(p.mesh_ready, 0);
}

// Also a compute that is cancelled while it waits for a job was asked for.
TEST(JobStates, AComputeThatNeverHasItsTurnWasRequested) {
  Gate gate;
  const Context context;
  begin_held(gate, context, block(20), settings(0.5), 1);
  std::atomic<bool> has_ended{false};
  std::thread other([&] {
    qses_settings s = settings(0.2);
    s.tag = 2;
    qses_compute(context, &s, nullptr);
    has_ended = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(5));  // it waits by then, mostly
  expect_ok(qses_cancel(context));
  gate.open();
  while (!has_ended) {
    expect_ok(qses_cancel(context));
    std::this_thread::yield();
  }
  other.join();
  EXPECT_EQ(poll(context).tag_requested, 2u);
}

TEST(JobStates, AComputeThatIsCancelledBeforeItsTurnComputesNothing) {
  Gate gate;
  const Context context;
  begin_held(gate, context, block(10), settings(0.5), 1);
  qses_status status = QSES_OK;
  std::thread other([&] {
    qses_settings s = settings(0.5);
    s.tag = 2;
    status = qses_compute(context, &s, nullptr);
  });
  while (poll(context).tag_requested != 2) std::this_thread::yield();  // it waits then
  expect_ok(qses_cancel(context));
  gate.open();
  other.join();
  EXPECT_EQ(status, QSES_CANCELLED);
  EXPECT_EQ(poll(context).tag, 1u);
}

// Whatever is computed, a job that is finished is all done.
TEST(JobStates, WhatIsFinishedIsWholeInAllForms) {
  std::vector<qses_settings> forms(5, settings(0.5));
  forms[1].delivery = QSES_DELIVERY_NONE;
  forms[2].surface = QSES_SURFACE_SAS;
  forms[2].delivery = QSES_DELIVERY_NONE;
  forms[3].surface = QSES_SURFACE_GAUSSIAN;
  forms[4].method = QSES_METHOD_GRID;
  const Context context;
  for (const Atoms &atoms : {Atoms(), cluster(50, 2)})
    for (const qses_settings &form : forms) {
      set_atoms(context, atoms);
      begin(context, form);
      wait_for_all(context);
      EXPECT_EQ(poll(context).state, QSES_JOB_FINISHED);
      EXPECT_EQ(poll(context).fraction, 1.f);
    }
}

TEST(JobStates, NothingIsLeftOfAFailure) {
  Gate gate;
  const Context context(2, 2 << 20);
  set_atoms(context, cluster(5000, 4));
  begin(context, settings(0.3));
  wait_for_all(context);
  ASSERT_EQ(poll(context).state, QSES_JOB_FAILED);
  begin_held(gate, context, cluster(50, 4), settings(1.0));
  const qses_progress next = poll(context);
  EXPECT_EQ(next.state, QSES_JOB_RUNNING);
  EXPECT_EQ(next.status, QSES_OK);
  EXPECT_EQ(std::string(next.message), "");
  gate.open();
  wait_for_all(context);
  EXPECT_EQ(poll(context).state, QSES_JOB_FINISHED);
}

// With a frame budget a level that there is no memory for is left, however fast it would be.
TEST(JobStates, ALevelThatFailsIsLeftForTheNextFrame) {
  const Context context(2, 4 << 20);
  set_atoms(context, crambin());
  qses_settings s = settings(0.1);
  s.level_count = 1;
  s.levels[0] = 2.f;
  s.frame_budget_ms = 60000;
  std::vector<bool> failed;
  for (uint32_t frame = 0; frame < 6; ++frame) {
    begin(context, s, frame);
    wait_for_all(context);
    failed.push_back(poll(context).state == QSES_JOB_FAILED);
    if (failed.back()) continue;
    qses_mesh m;
    qses_mesh_init(&m);
    expect_ok(qses_collect(context, &m));
    EXPECT_EQ(m.level, 0u);
  }
  EXPECT_EQ(failed, (std::vector<bool>{false, true, false, false, false, false}));
}

// A computation without a budget says nothing to those with one, and takes none of their levels.
TEST(JobStates, FramesWithinABudgetAndOthersAreApart) {
  const Context context(2, 16 << 20);
  set_atoms(context, crambin());
  qses_settings s = settings(1.0);
  s.level_count = 1;
  s.levels[0] = 2.f;
  const auto level_of_frame = [&] {
    s.frame_budget_ms = 60000;
    begin(context, s);
    wait_for_all(context);
    return collected(context).level;
  };
  EXPECT_EQ(level_of_frame(), 0u);
  EXPECT_EQ(level_of_frame(), 1u);
  s.frame_budget_ms = 0;
  begin(context, s);
  wait_for_all(context);
  EXPECT_EQ(poll(context).levels_finished, 2u);
  const qses_mesh m = collected(context);
  EXPECT_EQ(m.level, 1u);
  EXPECT_EQ(m.spacing, 1.f);
  const qses_settings too_fine = settings(0.05);
  EXPECT_EQ(qses_compute(context, &too_fine, nullptr), QSES_OUT_OF_MEMORY);
  EXPECT_EQ(level_of_frame(), 1u);
}

// Nothing that takes a minute to be shown fits, however fast it is made.
TEST(JobStates, ShowingCountsInABudget) {
  const Context context;
  set_atoms(context, cluster(300, 3));
  qses_settings s = settings(0.25);
  s.frame_budget_ms = 60000;
  s.show_ms_per_mb = 60000;
  const Surface finest = compute(context, cluster(300, 3), s);
  ASSERT_GT(finest.report.mesh_bytes, 1000000u);
  for (int frame = 0; frame < 3; ++frame) {
    begin(context, s);
    wait_for_all(context);
    EXPECT_LT(collected(context).level, 2u);
  }
}

}  // namespace
