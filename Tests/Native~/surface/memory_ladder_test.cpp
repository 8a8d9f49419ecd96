// SPDX-License-Identifier: MIT
// The ladder of memory plans through the C API: what was learnt stays learnt, a refusal leaves nothing behind, and the
// limit is that of the moment.
#include "surface/surface_fixture.h"

#include "parallel/arena.h"
#include "process/host_memory.h"
#include "surface/methods/size_estimate.h"

#include <gtest/gtest.h>

#include <cstring>

using namespace surface_fixture;

namespace {

Atoms row_of_crambins(int count) {
  const Atoms one = crambin();
  Atoms all;
  for (int k = 0; k < count; ++k) {
    const Atoms copy = shifted(k % 2 ? turned(one) : one, 24.0 * (k % 5), 22.0 * (k / 5 % 5), 31.0 * (k / 25));
    for (size_t i = 0; i < copy.size(); ++i) {
      const auto c = copy.center(i);
      all.add(c[0], c[1], c[2], static_cast<double>(copy.radii[i]));
    }
  }
  return all;
}

// A wide probe at a coarse spacing touches many of them from each brick: the threads' scratch grows.
Atoms long_row() {
  Atoms row;
  for (int k = 0; k < 60; ++k) row.add(3.4 * k, 0, 0, 1.7);
  return row;
}

std::vector<qses_settings> many_settings() {
  std::vector<qses_settings> all = {settings(0.5), settings(0.3), settings(0.5, 5.0),
                                    settings(0.5, 1.4, QSES_SURFACE_SAS)};
  qses_settings s = settings(0.5);
  s.relaxation_steps = 3;
  s.components = 1;
  all.push_back(s);
  s = settings(0.6);
  s.method = QSES_METHOD_GRID;
  all.push_back(s);
  return all;
}

uint64_t smallest_budget(qses_context *context, const qses_settings &s) {
  const qses_size_estimate e = estimate_of(context, s);
  return e.smallest_budget;
}

// Made with several attempts at first, if at all; then always at the first one, sliced as before, and the same.
TEST(MemoryLadder, TheSecondFrameDoesNoWorkTwice) {
  const Atoms atoms = row_of_crambins(8);
  const Context unbounded;
  set_atoms(unbounded, atoms);
  uint64_t most_attempts = 0;
  for (const qses_settings &s : many_settings()) {
    const uint64_t smallest = smallest_budget(unbounded, s);
    const qses_mesh expected = compute_view(unbounded, s);
    for (const uint64_t budget : {smallest, smallest + smallest / 8, smallest + smallest / 2, 2 * smallest}) {
      const Context context(2, budget);
      set_atoms(context, atoms);
      uint64_t slices = 0;
      for (int frame = 0; frame < 4; ++frame) {
        expect_ok(qses_set_positions(context, atoms.positions.data(), 0, atoms.size()));
        const qses_mesh mesh = compute_view(context, s);
        const qses_report report = report_of(context);
        if (frame == 0) {
          most_attempts = std::max(most_attempts, report.attempts);
          slices = report.slice_count;
        } else {
          EXPECT_EQ(report.attempts, 1u) << "frame " << frame << ", " << budget << " bytes";
          EXPECT_EQ(report.slice_count, slices);
        }
        ASSERT_EQ(mesh.vertex_count, expected.vertex_count);
        EXPECT_EQ(std::memcmp(mesh.positions, expected.positions, 12 * size_t(mesh.vertex_count)), 0);
        EXPECT_EQ(std::memcmp(mesh.indices, expected.indices, 12 * size_t(mesh.triangle_count)), 0);
      }
    }
  }
  EXPECT_GT(most_attempts, 1u) << "no case was too large for its first plan: nothing was tested";
}

// The same atoms with other settings begin the ladder anew where they need less, and other atoms always.
TEST(MemoryLadder, OtherAtomsBeginAtTheTop) {
  const Atoms many = row_of_crambins(8), one = crambin();
  const Context unbounded;
  set_atoms(unbounded, many);
  const uint64_t budget = smallest_budget(unbounded, settings(0.4));
  const Context context(2, budget);
  const Context fresh(2, budget);
  set_atoms(context, many);
  compute_view(context, settings(0.4));
  set_atoms(context, one);
  set_atoms(fresh, one);
  compute_view(context, settings(0.5));
  compute_view(fresh, settings(0.5));
  // The plans further down take less.
  EXPECT_GE(report_of(context).work_bytes_peak, report_of(fresh).work_bytes_peak);
  EXPECT_EQ(report_of(context).attempts, 1u);
}

// A refusal while the atoms are still brought over: the sentence is about these atoms, nothing of the last frame is
// touched, and the context goes on.
TEST(MemoryLadder, RefusedBeforeAnythingWasMade) {
  const Context context(2, 8u << 20);
  const Atoms one = crambin();
  set_atoms(context, one);
  const qses_mesh before = compute_view(context, settings(0.5));
  const std::vector<float> positions(before.positions, before.positions + 3 * size_t(before.vertex_count));
  Atoms huge;
  for (int k = 0; k < 2000000; ++k) huge.add(3.0 * (k % 128), 3.0 * (k / 128 % 128), 3.0 * (k / 16384), 1.5);
  set_atoms(context, huge);
  const std::vector<uint8_t> mask(huge.size(), 1), rgba(4 * huge.size(), 77);
  expect_ok(qses_set_visible(context, mask.data(), mask.size()));
  expect_ok(qses_set_colors(context, rgba.data(), huge.size()));
  ASSERT_EQ(qses_compute(context, nullptr, nullptr), QSES_OUT_OF_MEMORY);
  const std::string message = qses_last_error();
  double gib = 0;
  const size_t about = message.find("about ");
  ASSERT_NE(about, std::string::npos) << message;
  ASSERT_EQ(std::sscanf(message.c_str() + about, "about %lf GiB", &gib), 1) << message;
  EXPECT_GT(gib, 0.3) << message;  // 2 million atoms; crambin would do with less than a megabyte
  EXPECT_LT(gib, 30.0) << message;
  set_atoms(context, one);
  const qses_mesh after = compute_view(context, settings(0.5));
  ASSERT_EQ(after.vertex_count * size_t(3), positions.size());
  EXPECT_EQ(std::memcmp(after.positions, positions.data(), 4 * positions.size()), 0);
}

// Areas from the atoms need no mesh: that they could be had at a spacing says nothing of meshes.
TEST(MemoryLadder, HopelessSpacingsAreRefusedAfterFramesWithoutAMesh) {
  const Context context(2);
  set_atoms(context, crambin());
  qses_settings numbers = settings(0.001, 1.4, QSES_SURFACE_SAS);
  numbers.delivery = QSES_DELIVERY_NONE;
  expect_ok(qses_compute(context, &numbers, nullptr));
  const qses_settings mesh = settings(0.001);
  EXPECT_EQ(qses_compute(context, &mesh, nullptr), QSES_TOO_FINE);
  EXPECT_NE(std::string(qses_last_error()).find("Å would do"), std::string::npos) << qses_last_error();
}

// Nor does it that a coarser level could, which is all that a frame budget leaves time for.
TEST(MemoryLadder, HopelessSpacingsAreRefusedAfterCoarserLevels) {
  const Context context(2);
  set_atoms(context, crambin());
  qses_settings s = settings(0.001);
  s.levels[0] = 2.f;
  s.frame_budget_ms = 60000;
  expect_ok(qses_begin(context, &s));
  expect_ok(qses_wait(context, -1, nullptr));
  qses_mesh coarse;
  qses_mesh_init(&coarse);
  expect_ok(qses_collect(context, &coarse));
  EXPECT_EQ(coarse.spacing, 2.f);
  EXPECT_EQ(qses_compute(context, &s, nullptr), QSES_TOO_FINE);
  EXPECT_NE(std::string(qses_last_error()).find("Å would do"), std::string::npos) << qses_last_error();
}

// A spacing that is named in a refusal is not refused in turn, whatever there is least of.
TEST(HopelessSpacing, AnotherIsNamedThatWouldDo) {
  const auto refusal = [](double spacing, double available) {
    quickses::SurfaceSize size{};
    size.triangles = 1e4 / (spacing * spacing);
    try {
      quickses::refuse_hopeless_spacing(spacing, size, 250 * size.triangles, available);
    } catch (const quickses::Error &error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const double available : {0.0, 2e10, 1e15})
    for (const double spacing : {0.0001, 0.001}) {
      const std::string said = refusal(spacing, available);
      const size_t about = said.rfind("about ");
      ASSERT_NE(about, std::string::npos) << said;
      const double named = std::stod(said.substr(about + 6));
      EXPECT_GT(named, spacing);
      EXPECT_EQ(refusal(named, available), "") << said;
    }
}

// Two coarser meshes give a finer one exactly where the laws hold by which they are extrapolated.
TEST(SizeEstimate, ExtrapolatesWhatItSaysItDoes) {
  const auto size_at = [](double h) {
    const double cells = 1 / (h * h);
    return quickses::SurfaceSize{cells * (30 + 7 / h), cells * (900 - 80 * h), cells * (1800 + 50 * h),
                                 cells * (90 + 20 * h)};
  };
  const quickses::SurfaceSize got = quickses::extrapolate(size_at(0.8), 0.8, size_at(1.6), 1.6, 0.1),
                              expected = size_at(0.1);
  EXPECT_NEAR(got.bricks / expected.bricks, 1, 1e-12);
  EXPECT_NEAR(got.vertices / expected.vertices, 1, 1e-12);
  EXPECT_NEAR(got.triangles / expected.triangles, 1, 1e-12);
  EXPECT_NEAR(got.leaves / expected.leaves, 1, 1e-12);
  // What falls so steeply that nothing would be left is nothing, not less.
  EXPECT_EQ(quickses::extrapolate({0, 0, 0, 0}, 0.8, {0, 9, 9, 9}, 1.6, 0.1).vertices, 0.0);
}

// What is known stays; what is not gets a number, for few large balls none that they can't have.
TEST(SizeEstimate, GuessesOnlyWhatIsNotKnown) {
  quickses::SurfaceParameters parameters{};
  parameters.probe = parameters.depth = 1.4f;
  parameters.spacing = 0.5f;
  parameters.max_radius = 3.2f;
  quickses::WorkFacts known;
  known.atoms = 1000;
  known.caps = 11;
  known.arcs = 12;
  known.knows_arcs = true;
  known.arc_length = 13;
  known.spindle_turns = 14;
  known.size = {15, 16, 17, 18};
  quickses::WorkFacts facts = known;
  quickses::guess_unknown(parameters, true, 1e6, &facts);
  EXPECT_EQ(facts.caps, 11u);
  EXPECT_EQ(facts.arcs, 12u);
  EXPECT_EQ(facts.arc_length, 13);
  EXPECT_EQ(facts.spindle_turns, 14);
  EXPECT_EQ(facts.size.bricks, 15);
  EXPECT_EQ(facts.size.vertices, 16);
  EXPECT_EQ(facts.size.triangles, 17);
  EXPECT_EQ(facts.size.leaves, 18);
  facts.arcs = 0;  // there are none, and that is known
  facts.arc_length = 0;
  quickses::guess_unknown(parameters, true, 1e6, &facts);
  EXPECT_EQ(facts.arcs, 0u);

  for (const float radius : {3.2f, 30.f, 300.f})
    for (const bool exact : {false, true}) {
      parameters.max_radius = radius;
      facts = {};
      facts.atoms = 20;
      quickses::guess_unknown(parameters, exact, 1e5, &facts);
      EXPECT_GT(facts.arcs, 0u);
      EXPECT_GT(facts.arc_length, 0);
      EXPECT_GT(facts.size.bricks, 0);
      EXPECT_LE(facts.size.bricks, 1e5) << "there are no more in the table";
      EXPECT_GT(facts.size.vertices, 0);
      EXPECT_EQ(facts.size.triangles, 2 * facts.size.vertices);
      EXPECT_GT(facts.size.leaves, 0);
      EXPECT_GE(facts.caps, 18u * 20u);
      EXPECT_LE(facts.caps, 20u * (18u + 20u)) << "no atom has more neighbours than there are";
    }
}

// Estimates before anything was computed say what the computation then takes: the one is the other, only counted.
TEST(MemoryLadder, ForecastsAreWhatIsTaken) {
  if (tested_backend() != QSES_BACKEND_CPU) GTEST_SKIP() << "the GPU's rooms are guesses at first";
  const Atoms atoms = row_of_crambins(4);
  for (const qses_settings &s : many_settings())
    for (const uint64_t budget : {uint64_t(0), uint64_t(1) << 30}) {
      const Context context(1, budget);
      set_atoms(context, atoms);
      compute_view(context, s);  // the threads' scratch is there from now on
      const qses_size_estimate e = estimate_of(context, s);
      compute_view(context, s);
      const double taken = static_cast<double>(report_of(context).work_bytes_peak);
      EXPECT_NEAR(static_cast<double>(e.work_bytes) / taken, 1.0, 0.001)
          << e.work_bytes << " " << taken << " spacing " << s.spacing << " probe " << s.probe_radius;
    }
}

// The threads' scratch grows where bricks are crowded: with the budget that the estimate names, and with somewhat more,
// the surface is made, and no more than that is used.
TEST(MemoryLadder, BudgetsHoldWhereScratchGrows) {
  struct Case {
    Atoms atoms;
    qses_settings settings;
    unsigned threads;
  };
  const Atoms row = long_row();
  Atoms one;
  one.add(0.1, -0.2, 0.3, 1.7);
  for (const Case &c : {Case{row, settings(10, 100), 1}, Case{one, settings(0.083), 2}, Case{one, settings(0.083), 8},
                        Case{cluster(600, 3), settings(1.0, 10), 8}, Case{crambin(), settings(0.4, 12), 16}}) {
    const Context unbounded(c.threads);
    set_atoms(unbounded, c.atoms);
    compute_view(unbounded, c.settings);
    const uint64_t smallest = smallest_budget(unbounded, c.settings);
    for (const uint64_t budget : {smallest, smallest + smallest / 10, smallest + smallest / 2, 3 * smallest}) {
      const Context context(c.threads, budget);
      set_atoms(context, c.atoms);
      for (int frame = 0; frame < 2; ++frame) {
        ASSERT_EQ(qses_compute(context, &c.settings, nullptr), QSES_OK) << qses_last_error() << ", " << budget;
        EXPECT_LE(report_of(context).work_bytes_peak, budget)
            << c.threads << " threads, " << c.atoms.size() << " atoms";
      }
    }
  }
}

// A frame that is too crowded for the budget is refused, and leaves it to those that come after.
TEST(MemoryLadder, ACrowdedFrameTakesNothingFromOthers) {
  if (tested_backend() != QSES_BACKEND_CPU) GTEST_SKIP() << "the scratch is that of the CPU's threads";
  const Context context(64, 64'000'000);
  const Atoms crowd = cluster(8000, 5);
  for (int round = 0; round < 2; ++round) {
    set_atoms(context, crambin());
    const qses_settings usual = settings(0.5);
    ASSERT_EQ(qses_compute(context, &usual, nullptr), QSES_OK) << qses_last_error();
    EXPECT_LE(report_of(context).work_bytes_peak, uint64_t(64'000'000));
    set_atoms(context, crowd);
    const qses_settings wide = settings(4, 100);
    EXPECT_EQ(qses_compute(context, &wide, nullptr), QSES_OUT_OF_MEMORY);
  }
}

// Where there is plenty, scratch that grows comes out of it: no work is done twice, on however many threads.
TEST(MemoryLadder, ScratchThatGrowsInPlentyStopsNobody) {
  if (tested_backend() != QSES_BACKEND_CPU) GTEST_SKIP() << "the scratch is that of the CPU's threads";
  const Atoms atoms = long_row();
  const qses_settings s = settings(10, 100);
  for (const unsigned threads : {1u, 2u, 8u, 64u}) {
    SCOPED_TRACE(testing::Message() << threads << " threads");
    const Context unbounded(threads);
    set_atoms(unbounded, atoms);
    const qses_mesh expected = compute_view(unbounded, s);
    const uint64_t budget = 4 * report_of(unbounded).work_bytes_peak;
    const Context context(threads, budget);
    set_atoms(context, atoms);
    for (int frame = 0; frame < 3; ++frame) {
      const qses_mesh mesh = compute_view(context, s);
      EXPECT_EQ(report_of(context).attempts, 1u) << "frame " << frame;
      EXPECT_LE(report_of(context).work_bytes_peak, budget);
      ASSERT_EQ(mesh.vertex_count, expected.vertex_count);
      EXPECT_EQ(std::memcmp(mesh.positions, expected.positions, 12 * size_t(mesh.vertex_count)), 0);
      EXPECT_EQ(std::memcmp(mesh.indices, expected.indices, 12 * size_t(mesh.triangle_count)), 0);
    }
  }
}

struct ChangingMemory {
  static constexpr const char *kName = "the test";
  static inline uint64_t free = 0;
  static inline int questions = 0;
  static uint64_t free_bytes() {
    ++questions;
    return free;
  }
  static void *acquire(size_t bytes) { return quickses::HostMemory::acquire(bytes); }
  static void release(void *memory) { quickses::HostMemory::release(memory); }
};

TEST(ArenaLimit, IsWhatIsFreeWhenAComputationStarts) {
  constexpr uint64_t kMiB = 1 << 20;
  quickses::Arena<ChangingMemory> arena;
  ChangingMemory::free = 2 * kMiB;
  EXPECT_THROW(arena.allocate(3 * kMiB), quickses::MemoryRefused);
  arena.reset();
  ChangingMemory::free = 10 * kMiB;  // others gave some back
  EXPECT_NO_THROW(arena.allocate(3 * kMiB));
  EXPECT_EQ(arena.limit(), 10 * kMiB);
  const uint64_t held = arena.held();
  arena.reset();
  ChangingMemory::free = kMiB;  // and took some again
  EXPECT_EQ(arena.limit(), held + kMiB);
  EXPECT_THROW(arena.allocate(held + 2 * kMiB), quickses::MemoryRefused);
  EXPECT_NO_THROW(arena.allocate(held));
}

// What is left to others is not taken off what was had before.
TEST(ArenaLimit, WhatWasGivenUpMayBeHadAgain) {
  constexpr uint64_t kMiB = 1 << 20;
  quickses::Arena<ChangingMemory> arena;
  ChangingMemory::free = 8 * kMiB;
  arena.allocate(4 * kMiB);
  const uint64_t held = arena.held();
  ChangingMemory::free = 1;
  arena.release();
  arena.reset();
  EXPECT_EQ(arena.limit(), held);
  EXPECT_THROW(arena.allocate(held + kMiB), quickses::MemoryRefused);
  EXPECT_NO_THROW(arena.allocate(held));
}

TEST(ArenaLimit, NobodyAsksWhereNothingGrows) {
  quickses::Arena<ChangingMemory> arena;
  ChangingMemory::free = uint64_t(1) << 30;
  arena.allocate(1 << 20);
  const int before = ChangingMemory::questions;
  for (int k = 0; k < 10; ++k) {
    arena.reset();
    arena.allocate(1 << 20);
  }
  EXPECT_EQ(ChangingMemory::questions, before);
}

// As the GPU's.
struct MemoryTakenAtOnce : ChangingMemory {
  static constexpr bool kTakenUntouched = true;
};

TEST(ArenaBudget, OthersTakeWhatWasNeverWrittenTo) {
  constexpr uint64_t kMiB = 1 << 20;
  quickses::Arena<quickses::HostMemory> arena;
  arena.set_budget(10 * kMiB);
  const auto mark = arena.mark();
  arena.allocate(4 * kMiB);
  EXPECT_NO_THROW(arena.set_taken(6 * kMiB));
  EXPECT_THROW(arena.allocate(1), quickses::MemoryRefused) << "nothing is left";
  arena.rewind(mark);
  EXPECT_THROW(arena.set_taken(7 * kMiB), quickses::MemoryRefused) << "4 MiB were written to";
  arena.reset();
  arena.allocate(kMiB);
  EXPECT_EQ(arena.held(), 3 * kMiB);
  EXPECT_NO_THROW(arena.set_taken(8 * kMiB)) << "these pages are new";

  quickses::Arena<MemoryTakenAtOnce> taken_at_once;
  taken_at_once.set_budget(10 * kMiB);
  taken_at_once.allocate(4 * kMiB);
  EXPECT_THROW(taken_at_once.set_taken(kMiB), quickses::MemoryRefused);
}

}  // namespace
