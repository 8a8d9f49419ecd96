// SPDX-License-Identifier: MIT
// What is anticipated is what was counted and some more; too little of it never goes unnoticed.
#include "parallel/anticipation.h"

#include <gtest/gtest.h>

namespace quickses {
namespace {

constexpr Tally kPlenty{1000000};

struct Counted {
  alignas(8) unsigned char bytes[2 * Anticipation::kMostBytes] = {};
  explicit Counted(uint64_t first, uint64_t second = 0) {
    std::memcpy(bytes, &first, sizeof first);
    std::memcpy(bytes + Anticipation::kMostBytes, &second, sizeof second);
  }
};

TEST(Anticipation, KnowsNothingAtFirst) {
  Anticipation a;
  Tally expected;
  a.open(7);
  EXPECT_FALSE(a.anticipate("bricks", 0, kPlenty, &expected));
  EXPECT_FALSE(a.relies_on_something());
}

TEST(Anticipation, ExpectsWhatWasCountedAndSomeMore) {
  Anticipation a;
  Tally expected{};
  a.open(7);
  a.note("bricks", Tally{1600});
  a.open(7);
  ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
  EXPECT_GT(expected.count, 1600u);
  EXPECT_LT(expected.count, 2 * 1600u);
  a.open(7);
  ASSERT_TRUE(a.anticipate("bricks", 0, Tally{1610}, &expected));
  EXPECT_EQ(expected.count, 1610u) << "no more than there is room for";
}

TEST(Anticipation, FollowsWhatIsFound) {
  Anticipation a;
  Tally expected{};
  a.open(7);
  a.note("bricks", Tally{1600});
  for (uint64_t found : {1650u, 1500u, 1580u}) {
    a.open(7);
    ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
    a.note_counting();
    ASSERT_NO_THROW(a.verify(Counted(found).bytes));
    a.open(7);
    ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
    EXPECT_EQ(expected.count, Tally::anticipated(Tally{found}, kPlenty).count);
  }
}

TEST(Anticipation, NoticesTooLittleAndForgets) {
  Anticipation a;
  Tally expected{};
  a.open(7);
  a.note("bricks", Tally{1600});
  a.note("vertices", Tally{10});
  a.open(7);
  ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
  ASSERT_TRUE(a.anticipate("vertices", Anticipation::kMostBytes, kPlenty, &expected));
  a.note_counting();
  EXPECT_THROW(a.verify(Counted(1600, expected.count + 1).bytes), AnticipatedTooLittle);
  a.open(7);
  EXPECT_FALSE(a.anticipate("bricks", 0, kPlenty, &expected));
  EXPECT_FALSE(a.anticipate("vertices", 0, kPlenty, &expected));
}

TEST(Anticipation, WaitsLongerForFramesThatAreUnlikeEachOther) {
  Anticipation a;
  Tally expected{};
  int failures = 0, frames = 0;
  for (; frames < 200; ++frames) {
    a.open(7);
    if (!a.anticipate("bricks", 0, kPlenty, &expected)) {
      a.note("bricks", Tally{100});
      continue;
    }
    a.note_counting();
    EXPECT_THROW(a.verify(Counted(5000).bytes), AnticipatedTooLittle);
    ++failures;
  }
  EXPECT_GT(failures, 1) << "it tries again";
  EXPECT_LT(failures, frames / 10) << "but seldom";
}

TEST(Anticipation, IsOfOneKindOfFrames) {
  Anticipation a;
  Tally expected{};
  a.open(7);
  a.note("bricks", Tally{1600});
  a.open(8);
  EXPECT_FALSE(a.anticipate("bricks", 0, kPlenty, &expected));
  a.open(7);
  EXPECT_FALSE(a.anticipate("bricks", 0, kPlenty, &expected));
}

TEST(Anticipation, IsOfOnePage) {
  Anticipation a;
  Tally expected{};
  a.open(7);
  a.turn_to(1);
  a.note("bricks", Tally{1600});
  a.turn_to(2);
  EXPECT_FALSE(a.anticipate("bricks", 0, kPlenty, &expected));
  a.note("bricks", Tally{160});
  a.turn_to(1);
  ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
  EXPECT_GE(expected.count, 1600u);
}

// What is counted later than the counts were sent is looked at the next time.
TEST(Anticipation, VerifiesWhatWasBeingCounted) {
  Anticipation a;
  Tally expected{};
  a.open(7);
  a.note("bricks", Tally{1600});
  a.note("left", Tally{10});
  a.open(7);
  ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
  a.note_counting();
  ASSERT_TRUE(a.anticipate("left", Anticipation::kMostBytes, kPlenty, &expected));
  EXPECT_NO_THROW(a.verify(Counted(1600, 99999).bytes));
  EXPECT_TRUE(a.relies_on_something());
  a.note_counting();
  EXPECT_THROW(a.verify(Counted(1600, 99999).bytes), AnticipatedTooLittle);
}

TEST(Anticipation, WithoutAKindDoesNothing) {
  Anticipation a;
  a.open(0);
  EXPECT_FALSE(a.is_open());
}

}  // namespace
}  // namespace quickses
