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
  levels.hand_out_others();
  levels.note_begun();
  levels.hand_out_all();
  EXPECT_EQ(maker.done, "e0e1h0h1e2h2");
}

TEST(LevelsUnderWay, MayBeNone) {
  Maker maker;
  UnderWay levels(maker);
  levels.hand_out_all();
  EXPECT_EQ(maker.done, "");
}

}  // namespace
