// SPDX-License-Identifier: MIT
// In which order levels are ended and handed out.
#include "surface/levels_under_way.h"

#include <gtest/gtest.h>

#include <string>

namespace {

struct Level {
  explicit Level(int given) : number(given) {}
  Level(const Level &) = delete;
  int number;
};
struct Maker {
  std::string done;
  bool is_ready = true, is_verified = false;
  int at = -1;  // the level that it goes on with
  void verify_prepared() { is_verified = true; }
  bool is_done(const Level &) const { return is_ready; }
  void go_on_with(const Level &level) { at = level.number; }
  void end(Level &level) { done += "e" + std::to_string(level.number); }
  void hand_out(Level &level) { done += "h" + std::to_string(level.number); }
};
using UnderWay = quickses::LevelsUnderWay<Level, Maker>;

void begin(UnderWay &levels, int number) {
  levels.add(number);
  levels.note_begun();
}

TEST(LevelsUnderWay, GoOutOneByOne) {
  Maker maker;
  UnderWay levels(maker);
  for (int k = 0; k < 3; ++k) {
    begin(levels, k);
    levels.hand_out_all();
  }
  EXPECT_EQ(maker.done, "e0h0e1h1e2h2");
}

TEST(LevelsUnderWay, AreEndedBeforeTheFirstIsWaitedFor) {
  Maker maker;
  UnderWay levels(maker);
  for (int k = 0; k < 3; ++k) begin(levels, k);
  levels.hand_out_all();
  EXPECT_EQ(maker.done, "e0e1e2h0h1h2");
}

TEST(LevelsUnderWay, LeaveOneThatHasNotBegun) {
  Maker maker;
  UnderWay levels(maker);
  begin(levels, 0);
  begin(levels, 1);
  levels.add(2);
  levels.hand_out_others();
  EXPECT_EQ(maker.done, "e0e1h0h1");
  EXPECT_TRUE(maker.is_verified);
  EXPECT_EQ(maker.at, 2);
  levels.hand_out_others();
  levels.note_begun();
  levels.hand_out_all();
  EXPECT_EQ(maker.done, "e0e1h0h1e2h2");
}

TEST(LevelsUnderWay, AreAttendedToOneByOne) {
  Maker maker;
  UnderWay levels(maker);
  begin(levels, 0);
  begin(levels, 1);
  levels.add(2);
  maker.is_ready = false;
  levels.attend_to_others();  // the very first is waited for
  EXPECT_EQ(maker.done, "e0h0");
  EXPECT_EQ(maker.at, 2);
  for (int k = 0; k < 2; ++k) levels.attend_to_others();
  EXPECT_EQ(maker.done, "e0h0e1");
  maker.is_ready = true;
  for (int k = 0; k < 2; ++k) levels.attend_to_others();
  EXPECT_EQ(maker.done, "e0h0e1h1");
  levels.note_begun();
  levels.hand_out_all();
  EXPECT_EQ(maker.done, "e0h0e1h1e2h2");
}

TEST(LevelsUnderWay, AreHandedOutThoughNotAllWereAttendedTo) {
  Maker maker;
  UnderWay levels(maker);
  for (int k = 0; k < 3; ++k) begin(levels, k);
  levels.attend_to_others();
  levels.hand_out_all();
  EXPECT_EQ(maker.done, "e0h0e1e2h1h2");
}

TEST(LevelsUnderWay, MayBeNone) {
  Maker maker;
  UnderWay levels(maker);
  levels.hand_out_all();
  EXPECT_EQ(maker.done, "");
}

}  // namespace
