// SPDX-License-Identifier: MIT
// What is expected of a frame rests on frames that were made alike.
#include "surface/frame_history.h"

#include <gtest/gtest.h>

namespace {

using quickses::FrameHistory;

const float kSpacings[] = {2.f, 1.f, 0.5f};

struct FrameHistories : testing::Test {
  FrameHistories() { qses_settings_init(&settings); }
  void begin(size_t first_level = 0) { history.begin(settings, {kSpacings + first_level, 3 - first_level}); }
  void make(double milliseconds) {
    begin();
    history.end(milliseconds);
  }
  bool is_known() const { return history.takes_less_than(1e9); }

  FrameHistory history;
  qses_settings settings;
};

TEST_F(FrameHistories, KnowNothingAtFirst) {
  begin();
  EXPECT_FALSE(is_known());
  EXPECT_FALSE(history.takes_more_than(0));
  EXPECT_FALSE(history.is_settled());
}

TEST_F(FrameHistories, ExpectWhatTheLastOneTook) {
  make(7);
  settings.tag = 8;
  make(3);
  settings.tag = 9;
  begin();
  EXPECT_TRUE(history.takes_less_than(4));
  EXPECT_FALSE(history.takes_less_than(3));
  EXPECT_TRUE(history.takes_more_than(2));
  EXPECT_TRUE(history.is_settled());
}

TEST_F(FrameHistories, AreSettledByTwo) {
  make(1);
  EXPECT_FALSE(history.is_settled());
  make(1);
  EXPECT_TRUE(history.is_settled());
  history.unsettle();
  EXPECT_FALSE(history.is_settled());
  EXPECT_TRUE(is_known());
  make(1);
  EXPECT_TRUE(history.is_settled());
  history.forget();
  EXPECT_FALSE(is_known());
}

TEST_F(FrameHistories, ExpectNothingOfOtherSettings) {
  make(1);
  make(1);
  settings.method = QSES_METHOD_GRID;
  begin();
  EXPECT_FALSE(is_known());
  EXPECT_FALSE(history.is_settled());
  history.end(500);
  settings.method = QSES_METHOD_EXACT;
  begin();
  EXPECT_FALSE(is_known());  // not of the last one, nor of those before it
}

// As where a budget of time decides about the level.
TEST_F(FrameHistories, ExpectNothingOfAFinerLevel) {
  history.begin(settings, {kSpacings, 1});
  history.end(1);
  begin();
  EXPECT_FALSE(is_known());
  history.end(100);
  history.begin(settings, {kSpacings, 2});
  EXPECT_FALSE(is_known());
}

// Which are made by turns where some frames are refined and others are not.
TEST_F(FrameHistories, ExpectTheSameWithAndWithoutCoarseLevels) {
  make(1);
  begin(2);
  EXPECT_TRUE(is_known());
  history.end(1);
  settings.level_count = 0;
  settings.frame_budget_ms = 5;
  settings.series = 3;
  begin(2);
  EXPECT_TRUE(history.is_settled());
}

// One that is refused or cancelled was not made.
TEST_F(FrameHistories, LearnNothingOfOneThatEndsEarly) {
  make(1);
  begin();
  begin();
  EXPECT_TRUE(is_known());
  EXPECT_FALSE(history.is_settled());
}

}  // namespace
