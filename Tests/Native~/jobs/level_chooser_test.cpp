// SPDX-License-Identifier: MIT
// Which level a frame budget gets, with made-up costs.
#include "jobs/series_choosers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

using quickses::LevelChooser;
using quickses::Levels;
using quickses::SeriesChoosers;

namespace {

LevelChooser::Subject subject(std::initializer_list<float> spacings = {2.f, 1.f, 0.5f, 0.25f}) {
  LevelChooser::Subject s;
  s.atoms = 1000;
  s.probe_radius = 1.4f;
  for (float h : spacings) s.ladder.add(h);
  return s;
}

struct Cost {
  double whole, shared;
};

// Runs frames whose cost depends on level and frame; returns the level of each.
std::vector<uint32_t> run(LevelChooser &chooser, const LevelChooser::Subject &s, double budget, int frames,
                          const std::function<Cost(uint32_t level, int frame)> &cost) {
  std::vector<uint32_t> levels;
  for (int k = 0; k < frames; ++k) {
    levels.push_back(chooser.choose(s, budget));
    const Cost c = cost(levels.back(), k);
    chooser.record(c.whole, c.shared);
  }
  return levels;
}

// As the exact method's: so much for all levels alike, the rest by the number of lattice points at the surface.
std::function<Cost(uint32_t, int)> costs_of(const LevelChooser::Subject &s, double shared, double at_one_angstrom) {
  return [=](uint32_t level, int) {
    const double h = static_cast<double>(s.ladder.spacings[level]);
    return Cost{shared + at_one_angstrom / (h * h), shared};
  };
}

int changes(const std::vector<uint32_t> &levels, size_t from = 0) {
  int n = 0;
  for (size_t k = from + 1; k < levels.size(); ++k) n += levels[k] != levels[k - 1] ? 1 : 0;
  return n;
}

TEST(LevelChooser, StartsWithTheCoarsestThenTakesTheFinestThatFits) {
  const auto s = subject();
  // 1.25, 2, 5, 17 ms
  for (const auto &expected : {std::pair<double, uint32_t>{0.5, 0}, {1.3, 0}, {2.6, 1}, {7, 2}, {16.5, 2}, {22, 3}}) {
    LevelChooser chooser;
    const auto levels = run(chooser, s, expected.first, 20, costs_of(s, 1, 1));
    EXPECT_EQ(levels.front(), 0u);
    EXPECT_EQ(levels.back(), expected.second) << "budget " << expected.first;
  }
}

// What all levels share does not grow, the rest does as the method's work.
TEST(LevelChooser, FinerLevelsAreExpectedToCostWhatTheLawSays) {
  const auto two = subject({2.f, 1.f});
  const auto second_level = [&](qses_method method, double budget, const Cost &coarse) {
    auto s = two;
    s.method = method;
    LevelChooser chooser;
    return run(chooser, s, budget, 2, [&](uint32_t, int) { return coarse; }).back();
  };
  EXPECT_EQ(second_level(QSES_METHOD_EXACT, 20.5, {10, 8}), 1u);  // 8 + 4 * 2, with a fifth of the budget to spare
  EXPECT_EQ(second_level(QSES_METHOD_EXACT, 19.5, {10, 8}), 0u);
  EXPECT_EQ(second_level(QSES_METHOD_EXACT, 5.5, {1, 0}), 1u);
  EXPECT_EQ(second_level(QSES_METHOD_GRID, 5.5, {1, 0}), 0u);
  EXPECT_EQ(second_level(QSES_METHOD_GRID, 20.5, {1, 0}), 1u);
}

// No room to spare is needed to stay.
TEST(LevelChooser, AFinerLevelNeedsRoomToSpare) {
  const auto s = subject({1.f, 0.8f});
  const auto costs = costs_of(s, 0, 1);  // 1, 1.5625
  LevelChooser chooser;
  EXPECT_EQ(run(chooser, s, 1.7, 100, costs), std::vector<uint32_t>(100, 0));
  EXPECT_EQ(run(chooser, s, 1.99, 1, costs).back(), 1u);
  EXPECT_EQ(run(chooser, s, 1.7, 100, costs), std::vector<uint32_t>(100, 1));
}

TEST(LevelChooser, TheBudgetIsExceededInTriesOnly) {
  const auto s = subject();
  const auto cost = costs_of(s, 0, 1);  // 0.25, 1, 4, 16
  for (double budget : {0.3, 0.9, 1.3, 3.9, 5.5, 15.0, 21.0}) {
    LevelChooser chooser;
    int over = 0;
    for (uint32_t level : run(chooser, s, budget, 1000, cost)) over += cost(level, 0).whole > budget ? 1 : 0;
    // After 8, 16, 32, ... frames, where half of the budget is left; the law is exact here, so else never.
    const bool half_left = budget == 0.9 || budget == 3.9 || budget == 15.0;
    EXPECT_LE(over, half_left ? 8 : 0) << "budget " << budget;
  }
}

TEST(LevelChooser, TriesWhereCoarseLevelsCostAsMuchAsFineOnes) {
  const auto s = subject();
  LevelChooser chooser;
  // As on a GPU: by the law, 1 ms at 2 Å would mean 64 ms at 0.25 Å.
  const auto levels = run(chooser, s, 2.5, 30, [](uint32_t level, int) { return Cost{1 + 0.05 * level, 0}; });
  EXPECT_EQ(levels.back(), 3u);
  for (size_t k = 1; k < levels.size(); ++k) EXPECT_LE(levels[k], levels[k - 1] + 1);  // one step at a time
}

TEST(LevelChooser, ALevelThatIsTooExpensiveIsTriedLessAndLess) {
  const auto s = subject({1.f, 0.5f});
  LevelChooser chooser;
  const auto levels = run(chooser, s, 10, 4000, [](uint32_t level, int) { return Cost{level == 0 ? 4. : 12., 0}; });
  std::vector<size_t> tries;
  for (size_t k = 0; k < levels.size(); ++k)
    if (levels[k] == 1) tries.push_back(k);
  ASSERT_GE(tries.size(), 3u);
  EXPECT_LE(tries.size(), 14u);
  const auto later = run(chooser, s, 10, 4000, [](uint32_t level, int) { return Cost{level == 0 ? 4. : 12., 0}; });
  size_t last = 0, longest = 0;  // it is never given up
  for (size_t k = 0; k < later.size(); ++k)
    if (later[k] == 1) longest = std::max(longest, k - last), last = k;
  EXPECT_LE(std::max(longest, later.size() - last), 1100u);
  for (size_t k = 2; k < tries.size(); ++k) EXPECT_GE(tries[k] - tries[k - 1], tries[k - 1] - tries[k - 2]);
}

// While it waits it is come back to only where there is far more room.
TEST(LevelChooser, ALevelThatWasTooExpensiveIsComeBackToEarlyWithMuchRoom) {
  const auto s = subject({1.f, 0.5f});
  const auto levels_after_the_failure = [&](double later) {
    LevelChooser chooser;
    const auto levels = run(chooser, s, 10, 14, [&](uint32_t level, int frame) {
      const double factor = frame < 6 ? 1 : later;
      return Cost{factor * (level == 0 ? 4 : 12), 0};
    });
    EXPECT_EQ(levels[2], 1u);  // tried
    return std::vector<uint32_t>(levels.begin() + 3, levels.end());
  };
  // Two frames tell that all has become cheaper: 7.2 ms, which would be room enough for another level, or 4.8 ms.
  EXPECT_EQ(levels_after_the_failure(0.6), (std::vector<uint32_t>{0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1}));
  EXPECT_EQ(levels_after_the_failure(0.4), (std::vector<uint32_t>{0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1}));
}

// Failures are forgotten when a level has fitted for long: after the next one it is tried again soon.
TEST(LevelChooser, ALevelThatHasFittedForLongIsTrusted) {
  const auto s = subject({1.f, 0.5f});
  const auto costs = [](double fine) {
    return [fine](uint32_t level, int) { return Cost{level == 0 ? 4. : fine, 0}; };
  };
  LevelChooser chooser;
  run(chooser, s, 10, 1500, costs(12));  // fails again and again
  const auto fitting = run(chooser, s, 10, 1500, costs(7));
  ASSERT_EQ(fitting.back(), 1u);
  ASSERT_EQ(changes(fitting, 1400), 0);
  run(chooser, s, 10, 2, costs(30));  // of three costs, the one in the middle counts
  const auto after = run(chooser, s, 10, 20, costs(7));
  EXPECT_EQ(after.front(), 0u);
  EXPECT_EQ(after.back(), 1u);
}

// What a level cost when it was left does not hide what it costs now.
TEST(LevelChooser, ALevelThatIsComeBackToIsJudgedByItsFirstFrame) {
  const auto s = subject({1.f, 0.5f});
  LevelChooser chooser;
  const auto cheap = [](uint32_t level, int) { return Cost{level == 0 ? 2. : 8., 0}; };
  ASSERT_EQ(run(chooser, s, 10, 20, cheap).back(), 1u);
  ASSERT_EQ(run(chooser, s, 5, 20, cheap).back(), 0u);
  const auto levels = run(chooser, s, 10, 5, [](uint32_t level, int) { return Cost{level == 0 ? 2. : 30., 0}; });
  EXPECT_EQ(levels, (std::vector<uint32_t>{1, 0, 0, 0, 0}));
}

TEST(LevelChooser, NothingHopelessIsTried) {
  const auto s = subject({1.f, 0.5f});
  LevelChooser chooser;
  const auto levels = run(chooser, s, 10, 4000, [](uint32_t level, int) { return Cost{level == 0 ? 6. : 24., 0}; });
  for (uint32_t level : levels) EXPECT_EQ(level, 0u);
}

TEST(LevelChooser, OneSlowFrameChangesNothing) {
  const auto s = subject();
  LevelChooser chooser;
  const auto usual = costs_of(s, 1, 1);
  const auto levels = run(chooser, s, 7, 200, [&](uint32_t level, int frame) {
    Cost c = usual(level, frame);
    if (frame > 20 && frame % 10 == 0) c.whole *= 5;
    return c;
  });
  EXPECT_EQ(changes(levels, 20), 0);
  EXPECT_EQ(levels.back(), 2u);
}

TEST(LevelChooser, ASlowSecondFrameChangesNothing) {
  const auto s = subject({2.f, 1.f});
  LevelChooser chooser;
  const auto levels = run(chooser, s, 10, 6, [](uint32_t level, int frame) {
    return Cost{frame == 2 ? 50. : level == 0 ? 1.5 : 6., 0};
  });
  EXPECT_EQ(levels, (std::vector<uint32_t>{0, 1, 1, 1, 1, 1}));
}

// Also if it was what all levels share that took long.
TEST(LevelChooser, OneFrameThatIsPreparedSlowlyChangesNothing) {
  const auto s = subject({1.f, 0.5f});
  LevelChooser chooser;
  const auto usual = costs_of(s, 1, 5);  // 6, 21
  const auto levels = run(chooser, s, 10, 60, [&](uint32_t level, int frame) {
    const Cost c = usual(level, frame);
    const double more = frame % 10 == 5 ? 50 : 0;
    return Cost{c.whole + more, c.shared + more};
  });
  EXPECT_EQ(levels, std::vector<uint32_t>(60, 0));
}

TEST(LevelChooser, NoiseDoesNotMakeItOscillate) {
  const auto s = subject();
  const auto usual = costs_of(s, 1, 1);
  for (double budget : {4.6, 5.0, 5.4, 6.0, 17.0}) {  // around the 5 and the 17 ms of two levels
    LevelChooser chooser;
    unsigned state = 1;
    const auto levels = run(chooser, s, budget, 2000, [&](uint32_t level, int frame) {
      state = state * 1664525u + 1013904223u;
      Cost c = usual(level, frame);
      c.whole *= 0.9 + 0.2 * static_cast<double>(state >> 8) / (1 << 24);
      return c;
    });
    EXPECT_LE(changes(levels, 20), 2000 / 20) << "budget " << budget;
  }
}

TEST(LevelChooser, FollowsCostsDownAndUp) {
  const auto s = subject();
  LevelChooser chooser;
  const auto usual = costs_of(s, 1, 1);
  const auto levels = run(chooser, s, 7, 300, [&](uint32_t level, int frame) {
    Cost c = usual(level, frame);
    const double factor = frame < 100 ? 1 : frame < 200 ? 3 : 1;  // 2 and 5 ms, then 6 and 15
    return Cost{c.whole * factor, c.shared * factor};
  });
  EXPECT_EQ(levels[99], 2u);
  for (size_t k = 105; k < 200; ++k) EXPECT_LE(levels[k], 1u);
  for (size_t k = 230; k < 300; ++k) EXPECT_EQ(levels[k], 2u);
}

TEST(LevelChooser, GoesOverLevelsAtOnceWhereCostsFall) {
  const auto s = subject();
  LevelChooser chooser;
  const auto usual = costs_of(s, 1, 1);
  const auto levels = run(chooser, s, 7, 20, [&](uint32_t level, int frame) {
    const double factor = frame < 10 ? 50 : 1;
    return Cost{usual(level, frame).whole * factor, usual(level, frame).shared * factor};
  });
  EXPECT_EQ(changes(levels), 1);
  EXPECT_EQ(levels.back(), 2u);
}

// What a level not in use shares with others becomes cheaper, too: else finer ones would seem to cost nothing.
TEST(LevelChooser, WhatIsSharedFollowsCosts) {
  const auto s = subject({2.f, 1.f, 0.5f});
  LevelChooser chooser;
  const auto usual = costs_of(s, 8, 8);  // 10, 16, 40
  ASSERT_EQ(run(chooser, s, 20, 10, usual).back(), 1u);
  ASSERT_EQ(run(chooser, s, 12, 10, usual).back(), 0u);
  const auto levels = run(chooser, s, 12, 10, [&](uint32_t level, int frame) {
    return Cost{usual(level, frame).whole / 4, usual(level, frame).shared / 4};
  });
  EXPECT_EQ(*std::find_if(levels.begin(), levels.end(), [](uint32_t level) { return level > 0; }), 1u);
}

// A cost that rises, but still fits, is taken for what it is.
TEST(LevelChooser, ALevelThatStillFitsIsKept) {
  const auto s = subject({1.f, 0.5f});
  LevelChooser chooser;
  const auto levels = run(chooser, s, 9, 40, [](uint32_t level, int frame) {
    return Cost{(level == 0 ? 1.3 : 5.2) * (frame < 20 ? 1 : 1.6), 0};
  });
  EXPECT_EQ(changes(levels, 1), 0);
  EXPECT_EQ(levels.back(), 1u);
}

// The first frames of a stay at a level say what it costs, not that others have changed.
TEST(LevelChooser, ALevelThatHasBecomeCheaperMeanwhileSaysNothingAboutOthers) {
  const auto s = subject({2.f, 1.f, 0.5f});
  LevelChooser chooser;
  const auto costs = [](double finest) {
    return [finest](uint32_t level, int) { return Cost{level == 0 ? 2. : level == 1 ? 4. : finest, 0}; };
  };
  ASSERT_EQ(run(chooser, s, 10, 10, costs(12)).back(), 1u);
  ASSERT_EQ(run(chooser, s, 15.5, 2, costs(7)).back(), 2u);
  EXPECT_EQ(run(chooser, s, 3, 1, costs(7)).back(), 0u) << "level 1 still costs 4";
}

TEST(LevelChooser, ForgetsWhenTheSubjectChanges) {
  const auto s = subject();
  const std::vector<std::function<void(LevelChooser::Subject &)>> all = {
      [](LevelChooser::Subject &c) { c.atoms = 1001; },
      [](LevelChooser::Subject &c) { c.surface = QSES_SURFACE_SAS; },
      [](LevelChooser::Subject &c) { c.method = QSES_METHOD_GRID; },
      [](LevelChooser::Subject &c) { c.probe_radius = 1.5f; },
      [](LevelChooser::Subject &c) { c.relaxation_steps = 3; },
      [](LevelChooser::Subject &c) { c.slice_size = 64; },
      [](LevelChooser::Subject &c) { c.creases = 1; },
      [](LevelChooser::Subject &c) { c.hard_edges = 1; },
      [](LevelChooser::Subject &c) { c.occlusion = 1; },
      [](LevelChooser::Subject &c) { c.gaussian_radius_scale = 1.5f; },
      [](LevelChooser::Subject &c) { c.gaussian_isovalue = 1; },
      [](LevelChooser::Subject &c) { c.ladder.spacings[1] = 1.1f; },
      [](LevelChooser::Subject &c) { c.ladder.add(0.1f); }};
  for (const auto &change : all) {
    LevelChooser chooser;
    ASSERT_EQ(run(chooser, s, 1000, 5, costs_of(s, 1, 1)).back(), 3u);
    LevelChooser::Subject changed = s;
    change(changed);
    EXPECT_EQ(chooser.choose(changed, 1000), 0u);
  }
}

TEST(LevelChooser, ALevelThatFailsIsLeft) {
  const auto s = subject({1.f, 0.5f});
  LevelChooser chooser;
  int failures = 0;
  for (int k = 0; k < 500; ++k) {
    const uint32_t level = chooser.choose(s, 10);
    if (level == 0) {
      chooser.record(1, 0);
    } else {
      ++failures;
      chooser.record_failure();
    }
  }
  EXPECT_GE(failures, 1);
  EXPECT_LE(failures, 10);
}

TEST(LevelChooser, AFailedFrameOfTheCoarsestLevelSaysNothingAboutOthers) {
  const auto s = subject({1.f, 0.5f});
  LevelChooser chooser;
  EXPECT_EQ(chooser.choose(s, 10), 0u);
  chooser.record_failure();
  for (uint32_t level : run(chooser, s, 10, 100, [](uint32_t l, int) { return Cost{l == 0 ? 6. : 24., 0}; }))
    EXPECT_EQ(level, 0u);
}

TEST(LevelChooser, AFailedFrameOfALevelInUseSaysNothingAboutOthers) {
  const auto s = subject({1.f, 0.5f});
  LevelChooser chooser;
  const auto costs = [](uint32_t level, int) { return Cost{level == 0 ? 6. : 24., 0}; };
  ASSERT_EQ(run(chooser, s, 31, 5, costs).back(), 1u);
  ASSERT_EQ(run(chooser, s, 10, 5, costs).back(), 0u);
  EXPECT_EQ(chooser.choose(s, 10), 0u);
  chooser.record_failure();
  EXPECT_EQ(run(chooser, s, 10, 100, costs), std::vector<uint32_t>(100, 0));
}

// Where meshes have no bytes, too.
TEST(LevelChooser, ALevelThatFitsAgainIsComeBackToAtOnce) {
  const auto s = subject({1.f, 0.8f});
  const auto costs = costs_of(s, 0, 1);  // 1, 1.5625
  LevelChooser chooser;
  ASSERT_EQ(run(chooser, s, 2, 10, costs).back(), 1u);
  ASSERT_EQ(run(chooser, s, 1.2, 10, costs).back(), 0u);
  EXPECT_EQ(run(chooser, s, 1.98, 1, costs).back(), 1u);
}

TEST(LevelChooser, ABudgetThatGrowsIsUsed) {
  const auto s = subject();
  LevelChooser chooser;
  EXPECT_EQ(run(chooser, s, 2.6, 10, costs_of(s, 1, 1)).back(), 1u);
  EXPECT_EQ(run(chooser, s, 30, 10, costs_of(s, 1, 1)).back(), 3u);
  EXPECT_EQ(run(chooser, s, 2.6, 10, costs_of(s, 1, 1)).back(), 1u);
  // With another budget, what failed with the old one is no failure.
  const auto two = subject({1.f, 0.5f});
  const auto costs = [](uint32_t level, int) { return Cost{level == 0 ? 4. : 12., 0}; };
  LevelChooser often_too_dear;
  ASSERT_EQ(run(often_too_dear, two, 10, 500, costs).back(), 0u);
  EXPECT_EQ(run(often_too_dear, two, 16, 1, costs).back(), 1u);
  ASSERT_EQ(run(often_too_dear, two, 10, 500, costs).back(), 0u);
  const auto other = run(often_too_dear, two, 11, 20, costs);  // too dear again, for the first time
  EXPECT_EQ(std::count(other.begin(), other.end(), 1u), 2);
}

// ---- what it costs to show a mesh

constexpr double kBytesAtOneAngstrom = 1e6;

// Frames with meshes of so many bytes as the spacing makes them.
std::vector<uint32_t> run_and_show(LevelChooser &chooser, const LevelChooser::Subject &s, double budget,
                                   const std::function<double(int frame)> &show_ms_per_mb, int frames,
                                   double size = kBytesAtOneAngstrom) {
  const auto cost = costs_of(s, 1, 1);
  std::vector<uint32_t> levels;
  for (int k = 0; k < frames; ++k) {
    levels.push_back(chooser.choose(s, budget, show_ms_per_mb(k)));
    const double h = static_cast<double>(s.ladder.spacings[levels.back()]);
    const Cost c = cost(levels.back(), k);
    chooser.record(c.whole, c.shared, size / (h * h));
  }
  return levels;
}

TEST(LevelChooser, ShowingCountsInTheBudget) {
  const auto s = subject();
  // 1.25, 2, 5, 17 ms to compute; 0.25, 1, 4, 16 MB to show.
  struct Case {
    double budget, show_ms_per_mb;
    uint32_t level;
  };
  for (const Case &c : {Case{22, 0, 3}, {22, 1, 2}, {22, 4, 2}, {22, 10, 1}, {22, 60, 0}, {45, 1, 3}, {1, 1000, 0}}) {
    LevelChooser chooser;
    const auto levels = run_and_show(
        chooser, s, c.budget, [&](int) { return c.show_ms_per_mb; }, 20);
    EXPECT_EQ(levels.front(), 0u);
    EXPECT_EQ(levels.back(), c.level) << c.budget << " ms with " << c.show_ms_per_mb << " ms per MB";
  }
}

TEST(LevelChooser, ShowingIsForeseen) {
  const auto s = subject();
  // The law is exact here and no level leaves half of the budget unused: none is tried that can't be shown in time.
  LevelChooser chooser;
  const auto levels = run_and_show(
      chooser, s, 9.5, [](int) { return 1.0; }, 1000);
  for (uint32_t level : levels) EXPECT_LE(level, 2u);
  EXPECT_EQ(levels[1], 1u) << "the next one takes 5 ms to compute and 4 to show, which leaves no room to spare";
}

TEST(LevelChooser, ALevelThatTakesLongToShowIsTriedLessAndLess) {
  const auto s = subject({1.f, 0.5f});
  LevelChooser chooser;
  int tries = 0;
  for (int frame = 0; frame < 4000; ++frame) {
    const uint32_t level = chooser.choose(s, 10, 1);
    chooser.record(1, 0, level == 0 ? 3e6 : 11e6);
    tries += level == 1 ? 1 : 0;
  }
  EXPECT_GE(tries, 3);
  EXPECT_LE(tries, 14);
}

// Those of levels that are not in use grow with those of the one that is.
TEST(LevelChooser, LargerMeshesOfFinerLevelsAreForeseen) {
  const auto s = subject();
  LevelChooser chooser;
  const auto rate = [](int) { return 4.0; };
  ASSERT_EQ(run_and_show(chooser, s, 40, rate, 20, 0.2 * kBytesAtOneAngstrom).back(), 3u);  // 17 and 12.8 ms
  ASSERT_EQ(run_and_show(chooser, s, 25, rate, 9, 0.2 * kBytesAtOneAngstrom).back(), 2u);
  ASSERT_EQ(run_and_show(chooser, s, 25, rate, 20).back(), 2u);  // 5 and 16 ms; the finest takes 17 and 64
  EXPECT_EQ(run_and_show(chooser, s, 40, rate, 50), std::vector<uint32_t>(50, 2));
}

TEST(LevelChooser, FollowsWhatShowingTurnsOutToCost) {
  const auto s = subject();
  LevelChooser chooser;
  const auto levels = run_and_show(
      chooser, s, 22, [](int frame) { return frame < 50    ? 0.0
                                             : frame < 100 ? 3.0
                                                           : 0.1; }, 300);
  EXPECT_EQ(levels[49], 3u);
  for (size_t k = 51; k < 100; ++k) EXPECT_EQ(levels[k], 2u);
  EXPECT_EQ(levels.back(), 3u);
}

TEST(LevelChooser, LargerMeshesMakeAllLevelsDearer) {
  const auto s = subject();
  LevelChooser chooser;
  const auto rate = [](int) { return 1.0; };
  EXPECT_EQ(run_and_show(chooser, s, 45, rate, 20).back(), 3u);
  EXPECT_EQ(run_and_show(chooser, s, 45, rate, 20, 5 * kBytesAtOneAngstrom).back(), 2u);
  EXPECT_EQ(run_and_show(chooser, s, 45, rate, 200).back(), 3u);
}

// ---- series

// A chooser that has found out that everything fits.
void teach(LevelChooser &chooser) {
  const auto s = subject();
  ASSERT_EQ(run(chooser, s, 1000, 2, costs_of(s, 1, 1)).back(), 3u);
}

// Whether the chooser still knows.
bool knows(LevelChooser &chooser) { return chooser.choose(subject(), 1000) == 3; }

TEST(SeriesChoosers, EachSeriesLearnsForItself) {
  SeriesChoosers choosers;
  choosers.reserve();
  const auto small = subject();
  auto large = small;
  large.atoms = 50000;
  for (int frame = 0; frame < 50; ++frame) {
    const auto first = run(choosers.of(7), small, 30, 1, costs_of(small, 1, 1));   // 17 ms at the finest
    const auto second = run(choosers.of(8), large, 30, 1, costs_of(large, 2, 5));  // 22 ms at the third of four
    if (frame == 0) continue;
    EXPECT_EQ(first[0], 3u) << frame;
    EXPECT_EQ(second[0], 2u) << frame;
  }
  // Other atoms in a series say nothing about the others.
  EXPECT_EQ(choosers.of(7).choose(large, 30), 0u);
  EXPECT_EQ(choosers.of(8).choose(large, 30), 2u);
}

TEST(SeriesChoosers, RemembersTheLastSeriesThatWereUsed) {
  SeriesChoosers choosers;
  choosers.reserve();
  const LevelChooser *const first = &choosers.of(0);
  for (uint32_t k = 0; k < QSES_REMEMBERED_SERIES; ++k) teach(choosers.of(1000003u * k));
  EXPECT_EQ(&choosers.of(0), first) << "the memory is fixed";  // and 0 is the newest now
  teach(choosers.of(5));                                       // one too many: 1000003 is the oldest
  EXPECT_TRUE(knows(choosers.of(0)));
  for (uint32_t k = 2; k < QSES_REMEMBERED_SERIES; ++k) EXPECT_TRUE(knows(choosers.of(1000003u * k))) << k;
  EXPECT_TRUE(knows(choosers.of(5)));
  EXPECT_FALSE(knows(choosers.of(1000003)));
}

}  // namespace
