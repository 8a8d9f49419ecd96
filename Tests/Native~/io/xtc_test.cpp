// SPDX-License-Identifier: MIT
// XTC files, written by the tests' own encoder.
#include <algorithm>

#include "io/trajectory_fixture.h"

namespace quickses::io {
namespace {

using Integers = std::vector<int32_t>;

Trajectory open_bytes(const std::string &bytes) {
  return Trajectory::from_memory(bytes, TrajectoryFormat::kXtc, "test.xtc");
}

std::string error_of_bytes(const std::string &bytes) {
  return error_of(ErrorKind::kInput, [&] { open_bytes(bytes); });
}

std::string read_error(const std::string &bytes, size_t frame = 0) {
  const Trajectory trajectory = open_bytes(bytes);
  return error_of(ErrorKind::kInput, [&] { frame_of(trajectory, frame); });
}

// What stored integers mean.
Positions to_angstrom(const Integers &integers, double precision) {
  Positions positions;
  for (int32_t n : integers) positions.push_back(static_cast<float>(n * 10.0 / precision));
  return positions;
}

Integers random_integers(size_t atom_count, uint32_t seed, const int64_t (&low)[3], const int64_t (&size)[3]) {
  std::mt19937_64 random(seed);
  Integers integers(3 * atom_count);
  for (size_t i = 0; i < integers.size(); ++i)
    integers[i] =
        static_cast<int32_t>(low[i % 3] + static_cast<int64_t>(random() % static_cast<uint64_t>(size[i % 3])));
  for (size_t axis = 0; axis < 3; ++axis) {  // the whole range is used
    integers[axis] = static_cast<int32_t>(low[axis]);
    integers[3 + axis] = static_cast<int32_t>(low[axis] + size[axis] - 1);
  }
  return integers;
}

// Atoms in a chain whose steps fit the differences of that index.
Integers random_chain(size_t atom_count, uint32_t seed, int index) {
  std::mt19937_64 random(seed);
  const int64_t half = xtc_size(index) / 2;
  Integers integers(3 * atom_count);
  for (size_t i = 3; i < integers.size(); ++i)  // any two atoms are less than half a size apart
    integers[i] = static_cast<int32_t>(static_cast<int64_t>(random() % static_cast<uint64_t>(half)) - half / 2);
  return integers;
}

void expect_integers(const XtcWriter &writer, const Integers &integers) {
  const Trajectory trajectory = open_bytes(writer.packed_frame(integers));
  ASSERT_EQ(trajectory.frame_count(), 1u);
  ASSERT_EQ(trajectory.atom_count(), integers.size() / 3);
  EXPECT_FALSE(trajectory.incomplete());
  EXPECT_EQ(frame_of(trajectory, 0), to_angstrom(integers, writer.precision));
}

TEST(XtcTest, PlainFrames) {
  for (size_t atom_count = 1; atom_count <= 9; ++atom_count) {
    XtcWriter writer;
    writer.time = 2.5f;
    writer.box = {3, 0, 0, 0, 4, 0, 1, -1, 5};
    std::vector<float> nm(3 * atom_count);
    for (size_t i = 0; i < nm.size(); ++i) nm[i] = 0.125f * static_cast<float>(i) - 1;
    const Trajectory trajectory = open_bytes(writer.plain_frame(nm) + writer.plain_frame(nm));
    ASSERT_EQ(trajectory.frame_count(), 2u);
    ASSERT_EQ(trajectory.atom_count(), atom_count);
    for (size_t k = 0; k < 2; ++k) {
      const Positions positions = frame_of(trajectory, k);
      for (size_t i = 0; i < nm.size(); ++i) EXPECT_FLOAT_EQ(positions[i], 10 * nm[i]);
    }
    EXPECT_EQ(trajectory.time(1), 2.5);
    const std::optional<Box> box = trajectory.box(1);
    ASSERT_TRUE(box);
    EXPECT_EQ(box->vectors[0], (std::array<double, 3>{30, 0, 0}));
    EXPECT_EQ(box->vectors[1], (std::array<double, 3>{0, 40, 0}));
    EXPECT_EQ(box->vectors[2], (std::array<double, 3>{10, -10, 50}));
  }
}

TEST(XtcTest, NoBox) {
  const Trajectory trajectory = open_bytes(XtcWriter().plain_frame({1, 2, 3}));
  EXPECT_FALSE(trajectory.box(0));
}

TEST(XtcTest, PositionsInFull) {
  const int64_t kSizes[][3] = {
      {1, 1, 2},  // next to nothing
      {1, 1, 1000},
      {1000, 1, 1},                        // one axis only
      {100, 200, 300},                     // usual
      {256, 256, 256},                     // product is a power of two
      {0x10000, 0x10000, 0x10000},         // 49 bits
      {0x7ffff, 0x7ffff, 0x3ffff},         // 56 bits
      {0x7ffff, 0x7ffff, 0x7ffff},         // 57 bits
      {0xfffff, 0x3fffff, 0x3fffff},       // 64 bits
      {0xffffff, 0xffffff, 0xffffff},      // 72 bits, the most that is packed
      {0x1000000, 5, 1},                   // axis by axis from here on
      {0x1000000, 0x2345678, 0x1000001},   //
      {0x7fffffff, 0x7ffffffe, 3},         // 31 bits
      {0xffffffff, 0x80000000, 0x1000000}  // 32 bits
  };
  uint32_t seed = 1;
  for (const auto &size : kSizes) {
    SCOPED_TRACE(std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]));
    XtcWriter writer;
    writer.precision = 1e6f;  // keeps the largest within what positions may be
    for (int64_t shift : {0, 1}) {
      int64_t low[3];
      for (int axis = 0; axis < 3; ++axis) low[axis] = -size[axis] / 2 - (size[axis] < 1000 ? 77 * shift : 0);
      expect_integers(writer, random_integers(50, ++seed, low, size));
    }
  }
}

TEST(XtcTest, Precision) {
  for (float precision : {1.0f, 100.0f, 1000.0f, 1234.5f, 1e6f}) {
    XtcWriter writer;
    writer.precision = precision;
    expect_integers(writer, random_integers(10, 5, {-100, 0, 7}, {1000, 1000, 1000}));
  }
}

// Every size of differences and every length of runs.
TEST(XtcTest, SmallDifferences) {
  for (int index = 9; index <= 72; ++index) {
    SCOPED_TRACE("index " + std::to_string(index));
    XtcWriter writer;
    writer.precision = 1e6f;
    writer.small_index = index;
    size_t atom_count = 0;
    for (int run = 0; run <= 10; ++run)
      for (int repeat = 0; repeat < 3; ++repeat) {  // the second and third time no new run is announced
        writer.groups.push_back({run, 0});
        atom_count += static_cast<size_t>(run) + 1;
      }
    expect_integers(writer, random_chain(atom_count, static_cast<uint32_t>(index), index));
  }
}

// The largest differences there are, to either side.
TEST(XtcTest, ExtremeDifferences) {
  for (int index = 9; index <= 72; ++index) {
    SCOPED_TRACE("index " + std::to_string(index));
    const int32_t size = static_cast<int32_t>(xtc_size(index)), half = size / 2;
    XtcWriter writer;
    writer.precision = 1e6f;
    writer.small_index = index;
    writer.groups = {{3, 0}, {3, 0}, {3, 0}};
    Integers integers;
    for (int group = 0; group < 3; ++group) {
      const int32_t up = size - 1 - half;
      const Integers four = {-half, up, -half, 0, 0, 0, 0, 0, 0, up, -half, up};
      integers.insert(integers.end(), four.begin(), four.end());
      // third atom relative to the first: back to zero must fit as well
      for (int axis = 0; axis < 3; ++axis) {
        int32_t &third = integers[integers.size() - 6 + axis];
        const int32_t first = integers[integers.size() - 12 + axis];
        third = std::min(std::max(0, first - half), first + up);
        integers[integers.size() - 3 + axis] = third + (axis == 1 ? -half : up);
      }
    }
    expect_integers(writer, integers);
  }
}

TEST(XtcTest, SizeOfDifferencesAdapts) {
  XtcWriter writer;
  writer.small_index = 30;
  std::mt19937 random(4);
  size_t atom_count = 0;
  int index = 30, lowest = 30;
  for (int g = 0; g < 200; ++g) {
    int change = static_cast<int>(random() % 3) - 1;
    if (index + change < 20 || index + change > 40) change = 0;
    writer.groups.push_back({static_cast<int>(random() % 9), change});
    atom_count += static_cast<size_t>(writer.groups.back().run) + 1;
    index += change;
    lowest = std::min(lowest, index);
  }
  ASSERT_LT(lowest, 30);
  expect_integers(writer, random_chain(atom_count, 8, lowest));
}

// An index that leaves the table harms no one as long as no difference is read with it.
TEST(XtcTest, UnusedSizeOfDifferences) {
  XtcWriter writer;
  writer.small_index = 73;
  const Integers integers = random_integers(12, 3, {0, 0, 0}, {50, 60, 70});
  expect_integers(writer, integers);
  writer.small_index = 9;
  writer.groups.assign(12, {0, -1});
  expect_integers(writer, integers);
}

TEST(XtcTest, LargeFormat) {
  XtcWriter writer;
  writer.magic = 2023;
  const Integers integers = random_integers(30, 3, {0, 0, 0}, {500, 600, 700});
  expect_integers(writer, integers);
  const Trajectory trajectory = open_bytes(writer.packed_frame(integers) + XtcWriter().packed_frame(integers));
  EXPECT_EQ(trajectory.frame_count(), 2u);
  EXPECT_EQ(frame_of(trajectory, 1), to_angstrom(integers, 1000));
  const Trajectory plain = open_bytes(writer.plain_frame({1, 2, 3}));
  EXPECT_EQ(frame_of(plain, 0), (Positions{10, 20, 30}));
}

TEST(XtcTest, CutAtEveryByte) {
  std::string bytes, plain;
  std::vector<size_t> ends, plain_ends;
  std::vector<Positions> frames, plain_frames;
  for (uint32_t k = 0; k < 3; ++k) {
    XtcWriter writer;
    writer.magic = k == 1 ? 2023 : 1995;
    writer.groups = {{3, 0}, {0, 0}, {2, 1}, {4, 0}};
    writer.small_index = 20;
    const Integers integers = random_chain(13, k + 1, 20);
    bytes += writer.packed_frame(integers);
    ends.push_back(bytes.size());
    frames.push_back(to_angstrom(integers, 1000));
    plain += writer.plain_frame({1, 2, static_cast<float>(k)});
    plain_ends.push_back(plain.size());
    plain_frames.push_back({10, 20, 10 * static_cast<float>(k)});
  }
  expect_whole_frames_of_cuts(bytes, TrajectoryFormat::kXtc, ends, frames);
  expect_whole_frames_of_cuts(plain, TrajectoryFormat::kXtc, plain_ends, plain_frames);
}

TEST(XtcTest, RefusesWhatIsNoXtc) {
  EXPECT_HAS(error_of_bytes(std::string(200, 'x')), "frame 0 does not start as frames of XTC files do");
  std::string little = XtcWriter().plain_frame({1, 2, 3});
  std::reverse(little.begin(), little.begin() + 4);
  EXPECT_HAS(error_of_bytes(little), "'test.xtc'");
}

TEST(XtcTest, RefusesDifferingAtomCounts) {
  const XtcWriter writer;
  const std::string message = error_of_bytes(writer.plain_frame({1, 2, 3}) + writer.plain_frame({1, 2, 3, 4, 5, 6}));
  EXPECT_HAS(message, "frame 1 has 2 atoms, but frame 0 has 1");
}

TEST(XtcTest, RefusesAbsurdCounts) {
  const XtcWriter writer;
  const std::string rest(100, '\0');
  for (int32_t count : {0, -1, INT32_MIN}) EXPECT_HAS(error_of_bytes(writer.head(count) + rest), "number of atoms");
  // More atoms than the bytes can hold: refused before anyone makes room for them.
  const std::string head = writer.head(INT32_MAX) + XtcWriter::number(1000.0f) + std::string(28, '\0');
  EXPECT_HAS(error_of_bytes(head + XtcWriter::number(int32_t{64}) + std::string(64, '\0')), "number of bytes");
  EXPECT_HAS(error_of_bytes(head + XtcWriter::number(int32_t{-1}) + std::string(64, '\0')), "frame 0 is cut off");
  XtcWriter large;
  large.magic = 2023;
  const std::string large_head = large.head(INT32_MAX) + XtcWriter::number(1000.0f) + std::string(28, '\0');
  for (int64_t size : {int64_t{-1}, int64_t{-2}, INT64_MAX, INT64_MIN})  // rounded up, the first ones are nothing
    EXPECT_HAS(error_of_bytes(large_head + XtcWriter::number(size) + std::string(64, '\0')), "number of bytes");
}

TEST(XtcTest, Time) {
  XtcWriter writer;
  writer.time = 12.5f;
  EXPECT_EQ(open_bytes(writer.plain_frame({1, 2, 3})).time(0), 12.5);
  for (float none : {NAN, INFINITY}) {
    writer.time = none;
    EXPECT_FALSE(open_bytes(writer.plain_frame({1, 2, 3})).time(0));
  }
}

TEST(XtcTest, GarbageAfterFramesIsReported) {
  const std::string frame = XtcWriter().plain_frame({1, 2, 3});
  const Trajectory trajectory = open_bytes(frame + frame + std::string(100, '\0'));
  EXPECT_EQ(trajectory.frame_count(), 2u);
  EXPECT_TRUE(trajectory.incomplete());
  ASSERT_EQ(trajectory.warnings().size(), 1u);
  EXPECT_HAS(trajectory.warnings()[0], "frame 2 does not start as frames of XTC files do; only the 2 frames before");
}

TEST(XtcTest, DamageInsideOfAFrameIsReported) {
  XtcWriter writer;
  writer.groups.assign(5, {1, 0});
  const std::string good = writer.packed_frame(random_chain(10, 1, 9));
  const auto with = [&](size_t at, const std::string &bytes) {
    return std::string(good).replace(at, bytes.size(), bytes);
  };
  const auto integer = [](int32_t value) { return XtcWriter::number(value); };
  ASSERT_EQ(frame_of(open_bytes(good), 0).size(), 30u);

  EXPECT_HAS(read_error(with(56, XtcWriter::number(0.0f))), "frame 0 is damaged: its precision");
  EXPECT_HAS(read_error(with(56, XtcWriter::number(NAN))), "precision");
  EXPECT_HAS(read_error(with(60, integer(100000))), "its range of coordinates");  // above the largest
  EXPECT_HAS(read_error(with(84, integer(8))), "the size of its differences");    // before the table starts
  EXPECT_HAS(read_error(with(84, integer(73))), "the size of its differences");   // after its end
  EXPECT_HAS(read_error(with(84, integer(INT32_MIN))), "the size of its differences");
  EXPECT_HAS(read_error(with(72, integer(INT32_MAX))), "frame 0 is damaged");  // other sizes of everything
  for (size_t axis = 0; axis < 3; ++axis) {  // of which there is one more than 32 bits can count
    std::string all = with(60 + 4 * axis, integer(INT32_MIN));
    EXPECT_HAS(read_error(all.replace(72 + 4 * axis, 4, integer(INT32_MAX))), "its range of coordinates");
  }

  XtcWriter pairs;  // of each atom in full, at 0, and one that a difference leads to, at 6
  pairs.small_index = 12;
  pairs.groups.assign(5, {1, 0});
  Integers ten(30, 0);
  for (size_t atom = 0; atom < 10; atom += 2) ten[3 * atom] = 6;
  const std::string within = pairs.packed_frame(ten);
  ASSERT_EQ(frame_of(open_bytes(within), 0), to_angstrom(ten, 1000));
  EXPECT_HAS(read_error(std::string(within).replace(72, 4, integer(5))), "a position is outside of the range");

  Integers wide(30, 0);  // any difference stays within the range
  for (size_t i = 0; i < 6; ++i) wide[i] = i < 3 ? 18 : 20, wide[6 + i] = i < 3 ? -18 : -20;
  XtcWriter last;
  last.groups.assign(5, {1, 0});
  const std::string whole = last.packed_frame(wide);
  ASSERT_EQ(whole.substr(88, 4), integer(18));
  ASSERT_EQ(frame_of(open_bytes(whole), 0), to_angstrom(wide, 1000));
  for (int32_t size : {17, 16})  // which is the end of the last difference
    EXPECT_HAS(read_error(std::string(whole).replace(88, 4, integer(size))), "its coordinates end too early");

  XtcWriter longer;  // the last run goes on after the last atom
  longer.groups = {{0, 0}, {9, 0}};
  std::string overrun = longer.packed_frame(random_chain(11, 1, 9));
  overrun.replace(4, 4, integer(10)).replace(52, 4, integer(10));
  EXPECT_HAS(read_error(overrun), "it holds more atoms than it should");

  std::string underrun = XtcWriter().packed_frame(random_chain(20, 1, 20));
  underrun.replace(4, 4, integer(24)).replace(52, 4, integer(24));
  EXPECT_HAS(read_error(underrun), "its coordinates end too early");
}

TEST(XtcTest, PositionsThatAreNoneAreRefused) {
  const XtcWriter writer;
  EXPECT_HAS(read_error(writer.plain_frame({1, 2, 3, 4, NAN, 6})), "frame 0: atom 2 has no finite y coordinate");
  EXPECT_HAS(read_error(writer.plain_frame({2e5f, 2, 3})), "atom 1 is more than 1,000,000 Å from the origin");
}

TEST(XtcTest, MutantsAreSafe) {
  std::vector<std::string> files;
  XtcWriter writer;
  files.push_back(writer.plain_frame({1, 2, 3}) + writer.plain_frame({4, 5, 6}));
  writer.small_index = 15;
  writer.groups = {{8, 0}, {0, 1}, {3, -1}, {3, 0}, {1, 0}};
  files.push_back(writer.packed_frame(random_chain(20, 1, 15)) + writer.packed_frame(random_chain(20, 2, 15)));
  writer.magic = 2023;
  files.push_back(writer.packed_frame(random_chain(20, 3, 15)));
  writer.groups.clear();
  files.push_back(writer.packed_frame(random_integers(12, 4, {0, 0, 0}, {0xffffff, 0xffffff, 0xffffff})));
  files.push_back(writer.packed_frame(random_integers(12, 5, {0, 0, 0}, {0x7fffffff, 0x1000000, 1})));
  expect_mutants_are_safe(files, TrajectoryFormat::kXtc, 20000);
}

}  // namespace
}  // namespace quickses::io
