// SPDX-License-Identifier: MIT
// What is anticipated is what was counted and some more; too little of it never goes unnoticed.
#include "parallel/anticipation.h"

#include "surface/stages/neighbor_grid.h"

#include <gtest/gtest.h>

namespace quickses {
namespace {

using Bricks = Tally<uint64_t>;

constexpr Bricks kPlenty{1000000};

struct Counted {
  alignas(8) unsigned char bytes[2 * Anticipation::kMostBytes] = {};
  explicit Counted(uint64_t first, uint64_t second = 0) {
    std::memcpy(bytes, &first, sizeof first);
    std::memcpy(bytes + Anticipation::kMostBytes, &second, sizeof second);
  }
};

TEST(Anticipation, KnowsNothingAtFirst) {
  Anticipation a;
  Bricks expected;
  a.open(7);
  EXPECT_FALSE(a.anticipate("bricks", 0, kPlenty, &expected));
  EXPECT_FALSE(a.relies_on_something());
}

TEST(Anticipation, ExpectsWhatWasCountedAndSomeMore) {
  Anticipation a;
  Bricks expected{};
  a.open(7);
  a.note("bricks", Bricks{1600});
  a.open(7);
  ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
  EXPECT_GT(expected.count, 1600u);
  EXPECT_LT(expected.count, 2 * 1600u);
  EXPECT_GT(Bricks::anticipated({3}, kPlenty).count, 3u) << "also of few";
  a.open(7);
  ASSERT_TRUE(a.anticipate("bricks", 0, Bricks{1610}, &expected));
  EXPECT_EQ(expected.count, 1610u) << "no more than there is room for";
}

// Counted with too little room, it is counted anew.
TEST(Anticipation, AFrameDoesNotGoOnWithWhatItCountedItself) {
  Anticipation a;
  Bricks expected{};
  a.open(7);
  a.note("bricks", Bricks{1600});
  EXPECT_FALSE(a.anticipate("bricks", 0, kPlenty, &expected));
  a.note("bricks", Bricks{2500});
  EXPECT_FALSE(a.anticipate("bricks", 0, kPlenty, &expected));
  EXPECT_FALSE(a.has_anticipated());
  a.open(7);
  ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
  EXPECT_GE(expected.count, 2500u);
}

TEST(Anticipation, FollowsWhatIsFound) {
  Anticipation a;
  Bricks expected{};
  a.open(7);
  a.note("bricks", Bricks{1600});
  for (uint64_t found : {1650u, 1500u, 1580u}) {
    a.open(7);
    ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
    a.note_counting();
    ASSERT_NO_THROW(a.verify(Counted(found).bytes));
    EXPECT_FALSE(a.relies_on_something());
    a.open(7);
    ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
    EXPECT_EQ(expected.count, Bricks::anticipated(Bricks{found}, kPlenty).count);
  }
}

TEST(Anticipation, NoticesTooLittleAndForgets) {
  for (const bool is_first : {true, false}) {
    Anticipation a;
    Bricks bricks{}, vertices{};
    a.open(7);
    a.note("bricks", Bricks{1600});
    a.note("vertices", Bricks{10});
    a.open(7);
    ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &bricks));
    ASSERT_TRUE(a.anticipate("vertices", Anticipation::kMostBytes, kPlenty, &vertices));
    a.note_counting();
    const Counted found = is_first ? Counted(bricks.count + 1, 10) : Counted(1600, vertices.count + 1);
    EXPECT_THROW(a.verify(found.bytes), AnticipatedTooLittle);
    EXPECT_FALSE(a.knows_frames());
    a.open(7);
    EXPECT_FALSE(a.anticipate("bricks", 0, kPlenty, &bricks));
    EXPECT_FALSE(a.anticipate("vertices", 0, kPlenty, &vertices));
  }
}

TEST(Anticipation, AFrameThatWasGivenUpLeavesNothingBehind) {
  Anticipation a;
  Bricks expected{};
  a.open(7);
  a.note("bricks", Bricks{1600});
  a.open(7);
  ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
  a.turn_to(2, 3);
  a.open(7);
  EXPECT_FALSE(a.relies_on_something());
  ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected)) << "of what levels share";
  a.note_counting();
  a.open(7);
  ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
  EXPECT_TRUE(a.relies_on_something());
  EXPECT_NO_THROW(a.verify(Counted(expected.count + 1).bytes)) << "nothing is being counted yet";
}

TEST(Anticipation, ForgetsFramesWhenTold) {
  Anticipation a;
  Bricks expected{};
  a.open(7);
  EXPECT_FALSE(a.knows_frames());
  a.note("bricks", Bricks{1600});
  EXPECT_TRUE(a.knows_frames());
  a.forget_frames();
  EXPECT_FALSE(a.knows_frames());
  a.open(7);
  EXPECT_FALSE(a.anticipate("bricks", 0, kPlenty, &expected));
}

TEST(Anticipation, WaitsLongerForFramesThatAreUnlikeEachOther) {
  Anticipation a;
  Bricks expected{};
  int failures = 0, frames = 0, waiting = 0;
  for (; frames < 2000; ++frames) {
    a.open(7);
    if (!a.anticipate("bricks", 0, kPlenty, &expected)) {
      a.note("bricks", Bricks{100});
      ASSERT_LT(++waiting, 100) << "it is never given up";
      continue;
    }
    waiting = 0;
    a.note_counting();
    EXPECT_THROW(a.verify(Counted(5000).bytes), AnticipatedTooLittle);
    ++failures;
  }
  EXPECT_GT(failures, 1) << "it tries again";
  EXPECT_LT(failures, frames / 10) << "but seldom";
}

TEST(Anticipation, IsOfOneKindOfFrames) {
  Anticipation a;
  Bricks expected{};
  a.open(7);
  a.note("bricks", Bricks{1600});
  a.open(8);
  EXPECT_FALSE(a.anticipate("bricks", 0, kPlenty, &expected));
  a.open(7);
  EXPECT_FALSE(a.anticipate("bricks", 0, kPlenty, &expected));
}

TEST(Anticipation, IsOfOnePage) {
  Anticipation a;
  Bricks expected{};
  a.open(7);
  a.turn_to(1);
  a.note("bricks", Bricks{1600});
  a.turn_to(2);
  EXPECT_FALSE(a.anticipate("bricks", 0, kPlenty, &expected));
  a.note("bricks", Bricks{160});
  a.open(7);
  a.turn_to(1, 5);
  EXPECT_FALSE(a.anticipate("bricks", 0, kPlenty, &expected));
  a.turn_to(1);
  ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
  EXPECT_GE(expected.count, 1600u);
  // What is found goes to the page that it was anticipated of.
  a.turn_to(2);
  ASSERT_TRUE(a.anticipate("bricks", Anticipation::kMostBytes, kPlenty, &expected));
  a.turn_to(3);
  a.note_counting();
  ASSERT_NO_THROW(a.verify(Counted(1500, 150).bytes));
  a.open(7);
  for (const auto &[level, found] : {std::pair(1.f, 1500u), std::pair(2.f, 150u)}) {
    a.turn_to(level);
    ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
    EXPECT_EQ(expected.count, Bricks::anticipated({found}, kPlenty).count);
  }
}

// Counts below a threshold are told as 0, so 0 must leave room up to the threshold.
TEST(Anticipation, OfCountsThatAreToldFromSoManyOn) {
  using quickses::CrowdTally;
  const CrowdTally most{5000}, few = CrowdTally::anticipated({0}, most);
  EXPECT_TRUE(few.covers({0}));
  EXPECT_TRUE(few.covers({quickses::kFewInCell}));
  EXPECT_TRUE(CrowdTally::anticipated({400}, most).covers({401}));
  EXPECT_EQ(CrowdTally::anticipated({0}, {100}).count, 100u);
}

// A slider goes through thousands of spacings.
TEST(Anticipation, ForgetsPagesOfLongAgo) {
  Anticipation a;
  a.open(1);
  Bricks expected{};
  for (int level = 1; level <= 3000; ++level) {
    for (const int noted : {0, level}) {  // what levels share, too
      a.turn_to(static_cast<float>(noted));
      a.note("bricks", Bricks{100});
    }
    a.open(1);
    ASSERT_TRUE(a.foresee("bricks", kPlenty, &expected)) << level;
  }
  const auto is_known = [&](int level) {
    a.turn_to(static_cast<float>(level));
    return a.foresee("bricks", kPlenty, &expected);
  };
  EXPECT_TRUE(is_known(0));
  EXPECT_TRUE(is_known(3000));
  EXPECT_TRUE(is_known(2100));
  EXPECT_FALSE(is_known(1));
}

TEST(Anticipation, ForeseesWithoutRelyingOnIt) {
  Anticipation a;
  Bricks expected{}, foreseen{};
  EXPECT_FALSE(a.foresee("bricks", kPlenty, &foreseen));
  a.open(7);
  a.note("bricks", Bricks{1600});
  EXPECT_FALSE(a.foresee("bricks", kPlenty, &foreseen)) << "of this frame itself";
  a.open(7);
  ASSERT_TRUE(a.foresee("bricks", kPlenty, &foreseen));
  EXPECT_FALSE(a.relies_on_something());
  EXPECT_FALSE(a.has_anticipated());
  ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
  EXPECT_EQ(foreseen.count, expected.count);
  EXPECT_TRUE(a.relies_on_something());
  EXPECT_TRUE(a.has_anticipated());
  a.note_counting();
  EXPECT_THROW(a.verify(Counted(expected.count + 1).bytes), AnticipatedTooLittle);
  EXPECT_TRUE(a.has_anticipated()) << "in this frame, even if it failed";
  a.open(7);
  EXPECT_FALSE(a.has_anticipated());
  a.note("bricks", Bricks{1600});
  EXPECT_FALSE(a.foresee("bricks", kPlenty, &foreseen)) << "while frames wait";
}

TEST(Anticipation, WaitsForWhatIsCountedAside) {
  Anticipation a;
  Bricks inner{}, aside{};
  a.open(7);
  a.note("inner", Bricks{160});
  a.note("aside", Bricks{1600});
  a.open(7);
  a.turn_aside(true);
  ASSERT_TRUE(a.anticipate("aside", 0, kPlenty, &aside));
  a.turn_aside(false);
  ASSERT_TRUE(a.anticipate("inner", 0, kPlenty, &inner));
  a.note_counting();
  EXPECT_NO_THROW(a.verify(Counted(inner.count).bytes)) << "the other may still grow";
  EXPECT_TRUE(a.relies_on_something());
  a.join();
  a.note_counting();
  EXPECT_THROW(a.verify(Counted(aside.count + 1).bytes), AnticipatedTooLittle);
}

TEST(Anticipation, WhatIsNoLongerCountedAsideIsLookedAt) {
  Anticipation a;
  Bricks expected{};
  a.open(7);
  a.note("bricks", Bricks{1600});
  a.open(7);
  a.turn_aside(true);
  a.turn_aside(false);
  ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
  a.note_counting();
  EXPECT_FALSE(a.relies_on_something());
  EXPECT_THROW(a.verify(Counted(expected.count + 1).bytes), AnticipatedTooLittle);
}

TEST(Anticipation, ForgivesWhatWasLongAgo) {
  Anticipation a;
  Bricks expected{};
  int waiting = 0;
  for (int jump = 0; jump < 8; ++jump) {
    waiting = 0;
    for (int frame = 0; frame < 100; ++frame) {
      a.open(7);
      if (!a.anticipate("bricks", 0, kPlenty, &expected)) {
        a.note("bricks", Bricks{100});
        ++waiting;
        continue;
      }
      a.note_counting();
      if (frame == 50)
        EXPECT_THROW(a.verify(Counted(5000).bytes), AnticipatedTooLittle);
      else
        EXPECT_NO_THROW(a.verify(Counted(100).bytes));
    }
  }
  EXPECT_LE(waiting, 2) << "one jump in a hundred frames";
}

// A frame that is looked at several times, and was not enough at last, forgives nothing.
TEST(Anticipation, FramesThatFailLateAreMadeAnewSeldom) {
  Anticipation a;
  Bricks expected{};
  int failed = 0;
  for (int frame = 0; frame < 200; ++frame) {
    a.open(7);
    if (!a.anticipate("bricks", 0, kPlenty, &expected)) {
      a.note("bricks", Bricks{100});
      continue;
    }
    a.note_counting();
    EXPECT_NO_THROW(a.verify(Counted(100).bytes));
    ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
    a.note_counting();
    EXPECT_THROW(a.verify(Counted(5000).bytes), AnticipatedTooLittle);
    ++failed;
  }
  EXPECT_LE(failed, 8);
}

TEST(Anticipation, FramesThatAreGivenUpForgiveNothing) {
  Anticipation a;
  Bricks expected{};
  const auto go_to_one_that_anticipates = [&] {
    int waiting = 0;
    for (a.open(7); !a.anticipate("bricks", 0, kPlenty, &expected); a.open(7), ++waiting) a.note("bricks", Bricks{100});
    a.note_counting();
    return waiting;
  };
  for (int k = 0; k < 8; ++k) {
    go_to_one_that_anticipates();
    EXPECT_THROW(a.verify(Counted(5000).bytes), AnticipatedTooLittle);
  }
  const int waiting = go_to_one_that_anticipates();
  EXPECT_NO_THROW(a.verify(Counted(100).bytes));
  for (int k = 0; k < 20; ++k) EXPECT_EQ(go_to_one_that_anticipates(), 0);
  EXPECT_THROW(a.verify(Counted(5000).bytes), AnticipatedTooLittle);
  EXPECT_GT(go_to_one_that_anticipates(), waiting / 2);
}

// What is counted later than the counts were sent is looked at the next time.
TEST(Anticipation, VerifiesWhatWasBeingCounted) {
  Anticipation a;
  Bricks expected{};
  a.open(7);
  a.note("bricks", Bricks{1600});
  a.note("left", Bricks{10});
  a.open(7);
  ASSERT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected));
  a.note_counting();
  EXPECT_FALSE(a.relies_on_something());
  ASSERT_TRUE(a.anticipate("left", Anticipation::kMostBytes, kPlenty, &expected));
  EXPECT_NO_THROW(a.verify(Counted(1600, 99999).bytes));
  EXPECT_TRUE(a.relies_on_something());
  a.note_counting();
  EXPECT_THROW(a.verify(Counted(1600, 99999).bytes), AnticipatedTooLittle);
}

TEST(Anticipation, WithoutAKindDoesNothing) {
  Anticipation a;
  Bricks expected{};
  a.open(7);
  a.note("bricks", Bricks{1600});
  a.open(7);
  a.open(0);
  EXPECT_FALSE(a.is_open());
  EXPECT_FALSE(a.anticipate("bricks", 0, kPlenty, &expected));
  a.open(7);
  EXPECT_TRUE(a.anticipate("bricks", 0, kPlenty, &expected)) << "frames between others change nothing";
}

}  // namespace
}  // namespace quickses
