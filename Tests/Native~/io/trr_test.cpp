// SPDX-License-Identifier: MIT
// TRR files, written by the tests themselves.
#include <algorithm>

#include "io/trajectory_fixture.h"

namespace quickses::io {
namespace {

Trajectory open_bytes(const std::string &bytes) {
  return Trajectory::from_memory(bytes, TrajectoryFormat::kTrr, "test.trr");
}

std::string error_of_bytes(const std::string &bytes) {
  return error_of(ErrorKind::kInput, [&] { open_bytes(bytes); });
}

struct Flavour {
  const char *name;
  bool is_double, has_box, has_pressure, has_velocities, has_forces;
};

void PrintTo(const Flavour &flavour, std::ostream *stream) { *stream << flavour.name; }

class TrrFlavourTest : public ::testing::TestWithParam<Flavour> {
 protected:
  TrrFlavourTest() {
    const Flavour &flavour = GetParam();
    for (uint32_t k = 0; k < 3; ++k) {
      TrrWriter writer;
      writer.is_double = flavour.is_double;
      if (flavour.has_box) writer.box = {3, 0, 0, 0, 4, 0, 1, -1, 5};
      writer.has_pressure = flavour.has_pressure;
      writer.has_velocities = flavour.has_velocities;
      writer.has_forces = flavour.has_forces;
      writer.time = 2.5 * k;
      Positions frame(21);
      for (size_t i = 0; i < frame.size(); ++i)  // exact in nm too
        frame[i] = 10 * (0.125f * static_cast<float>(i) - static_cast<float>(k));
      frames_.push_back(frame);
      bytes_ += writer.frame(frame);
      ends_.push_back(bytes_.size());
    }
  }

  std::string bytes_;
  std::vector<size_t> ends_;
  std::vector<Positions> frames_;
};

TEST_P(TrrFlavourTest, Frames) {
  const Trajectory trajectory = open_bytes(bytes_);
  ASSERT_EQ(trajectory.frame_count(), 3u);
  ASSERT_EQ(trajectory.atom_count(), 7u);
  EXPECT_FALSE(trajectory.incomplete());
  EXPECT_TRUE(trajectory.warnings().empty());
  for (size_t k : {2, 0, 1, 1}) {
    SCOPED_TRACE(k);
    EXPECT_EQ(frame_of(trajectory, k), frames_[k]);
    EXPECT_EQ(trajectory.time(k), 2.5 * static_cast<double>(k));
    const std::optional<Box> box = trajectory.box(k);
    ASSERT_EQ(box.has_value(), GetParam().has_box);
    if (!box) continue;
    EXPECT_EQ(box->vectors[0], (std::array<double, 3>{30, 0, 0}));
    EXPECT_EQ(box->vectors[1], (std::array<double, 3>{0, 40, 0}));
    EXPECT_EQ(box->vectors[2], (std::array<double, 3>{10, -10, 50}));
  }
}

TEST_P(TrrFlavourTest, CutAtEveryByte) { expect_whole_frames_of_cuts(bytes_, TrajectoryFormat::kTrr, ends_, frames_); }

TEST_P(TrrFlavourTest, MutantsAreSafe) { expect_mutants_are_safe({bytes_}, TrajectoryFormat::kTrr, 4000); }

INSTANTIATE_TEST_SUITE_P(All, TrrFlavourTest,
                         ::testing::Values(Flavour{"positions", false, false, false, false, false},
                                           Flavour{"positions_double", true, false, false, false, false},
                                           Flavour{"box", false, true, false, false, false},
                                           Flavour{"velocities", false, true, false, true, false},
                                           Flavour{"forces", false, true, false, false, true},
                                           Flavour{"all", false, true, true, true, true},
                                           Flavour{"all_double", true, true, true, true, true}),
                         [](const auto &info) { return std::string(info.param.name); });

// Values that no float holds: a double of nm becomes the nearest float of Å.
TEST(TrrTest, DoublesAreRoundedOnce) {
  TrrWriter writer;
  writer.is_double = true;
  const std::vector<double> nm = {0.1234567890123, -7.6543210987654, 1e-9};
  const Positions frame = frame_of(open_bytes(writer.frame(1, nm)), 0);
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(frame[i], static_cast<float>(10 * nm[i]));
}

TEST(TrrTest, MoreAtomsThanOneChunk) {
  TrrWriter writer;
  writer.has_velocities = true;
  const Positions first = random_positions(5001, 1), second = random_positions(5001, 2);
  const Trajectory trajectory = open_bytes(writer.frame(first) + writer.frame(second));
  const Positions frame = frame_of(trajectory, 1);
  for (size_t i = 0; i < frame.size(); ++i) ASSERT_NEAR(frame[i], second[i], 1e-5);
}

// Velocities are often written more often than positions.
TEST(TrrTest, FramesWithoutPositionsAreLeftOut) {
  TrrWriter writer, moving;
  moving.has_velocities = true;
  const std::string empty = moving.frame(1, {});
  writer.time = 8;
  const std::string bytes =
      empty + TrrWriter().frame(Positions{1, 2, 3}) + empty + empty + writer.frame(Positions{4, 5, 6}) + empty;
  const Trajectory trajectory = open_bytes(bytes);
  ASSERT_EQ(trajectory.frame_count(), 2u);
  EXPECT_EQ(frame_of(trajectory, 0), (Positions{1, 2, 3}));
  EXPECT_EQ(frame_of(trajectory, 1), (Positions{4, 5, 6}));
  EXPECT_EQ(trajectory.time(1), 8.0);
  EXPECT_FALSE(trajectory.incomplete());
  ASSERT_EQ(trajectory.warnings().size(), 1u);
  EXPECT_HAS(trajectory.warnings()[0], "'test.trr': 4 of 6 frames have no positions and are left out");

  EXPECT_HAS(error_of_bytes(empty + empty), "none of its frames has positions");
}

TEST(TrrTest, TimesThatAreNone) {
  for (double none : {double{NAN}, double{INFINITY}})
    for (bool is_double : {false, true}) {
      TrrWriter writer;
      writer.is_double = is_double;
      writer.time = none;
      EXPECT_FALSE(open_bytes(writer.frame(Positions{1, 2, 3})).time(0));
    }
}

TEST(TrrTest, RefusesWhatIsNoTrr) {
  EXPECT_HAS(error_of_bytes(std::string(200, 'x')), "frame 0 does not start as frames of TRR files do");
  const std::string good = TrrWriter().frame(Positions{1, 2, 3});
  for (size_t place : {4, 8, 15}) {
    std::string bytes = good;
    bytes[place] = '\x55';
    EXPECT_HAS(error_of_bytes(bytes), "does not start as frames of TRR files do");
  }
  std::string little = good;
  std::reverse(little.begin(), little.begin() + 4);
  EXPECT_HAS(error_of_bytes(little), "'test.trr'");
}

TEST(TrrTest, RefusesDifferingAtomCounts) {
  const TrrWriter writer;
  EXPECT_HAS(error_of_bytes(writer.frame(Positions{1, 2, 3}) + writer.frame(Positions{1, 2, 3, 4, 5, 6})),
             "frame 1 has 2 atoms, but frame 0 has 1");
}

TEST(TrrTest, RefusesAbsurdSizes) {
  TrrWriter writer;
  writer.box = std::vector<double>(9, 1.0);
  const std::string good = writer.frame(Positions{1, 2, 3, 4, 5, 6});
  const auto with = [&](size_t number, int32_t value) {  // of the eleven numbers behind the name
    return std::string(good).replace(24 + 4 * number, 4, TrrWriter::number(value));
  };
  for (int32_t count : {0, -1, INT32_MIN})
    EXPECT_HAS(error_of_bytes(with(10, count)), "number of atoms makes no sense");
  for (int32_t count : {1, 3, 4, INT32_MAX})
    EXPECT_HAS(error_of_bytes(with(10, count)), "do not fit its number of atoms");
  for (int32_t size : {-4, INT32_MIN, 13})
    EXPECT_HAS(error_of_bytes(with(7, size)), "sizes of its blocks make no sense");
  for (int32_t size : {4, 12, 20, 48}) EXPECT_HAS(error_of_bytes(with(7, size)), "do not fit its number of atoms");
  EXPECT_HAS(error_of_bytes(with(2, 72)), "do not fit its number of atoms");  // a double box, float positions
  EXPECT_HAS(error_of_bytes(with(0, INT32_MAX - 3)), "frame 0 is cut off");
  std::string nothing = TrrWriter().frame(2, {});
  EXPECT_HAS(error_of_bytes(nothing), "nothing that tells its precision");
  // As many atoms as the sizes can say, which are not there: nothing is allocated for them.
  std::string many = with(10, 178956970);
  many.replace(24 + 4 * 7, 4, TrrWriter::number(int32_t{12 * 178956970}));
  EXPECT_HAS(error_of_bytes(many), "frame 0 is cut off");
}

TEST(TrrTest, GarbageAfterFramesIsReported) {
  const std::string frame = TrrWriter().frame(Positions{1, 2, 3});
  const Trajectory trajectory = open_bytes(frame + frame + std::string(100, '\0'));
  EXPECT_EQ(trajectory.frame_count(), 2u);
  EXPECT_TRUE(trajectory.incomplete());
  ASSERT_EQ(trajectory.warnings().size(), 1u);
  EXPECT_HAS(trajectory.warnings()[0], "frame 2 does not start as frames of TRR files do; only the 2 frames before");
}

TEST(TrrTest, PositionsThatAreNoneAreRefused) {
  const auto read_error = [](const Positions &positions) {
    const Trajectory trajectory = open_bytes(TrrWriter().frame(positions));
    return error_of(ErrorKind::kInput, [&] { frame_of(trajectory, 0); });
  };
  EXPECT_HAS(read_error({1, 2, 3, 4, NAN, 6}), "frame 0: atom 2 has no finite y coordinate");
  EXPECT_HAS(read_error({2e6f, 2, 3}), "atom 1 is more than 1,000,000 Å from the origin");
}

}  // namespace
}  // namespace quickses::io
