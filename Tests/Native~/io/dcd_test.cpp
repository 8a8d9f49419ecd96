// SPDX-License-Identifier: MIT
// DCD files of all flavours, written by the tests themselves.
#include "io/trajectory_fixture.h"

namespace quickses::io {
namespace {

Trajectory open_bytes(const std::string &bytes) {
  return Trajectory::from_memory(bytes, TrajectoryFormat::kDcd, "test.dcd");
}

std::string error_of_bytes(const std::string &bytes) {
  return error_of(ErrorKind::kInput, [&] { open_bytes(bytes); });
}

const std::vector<double> kCell = {30, 0, 40, 0, 0, 50};  // a right box, by cosines

struct Flavour {
  const char *name;
  bool big_endian;
  int32_t version;
  bool has_cell;
  bool has_fourth;
  bool has_fixed;
  bool has_wide_markers = false;
};

void PrintTo(const Flavour &flavour, std::ostream *stream) { *stream << flavour.name; }

class DcdFlavourTest : public ::testing::TestWithParam<Flavour> {
 protected:
  DcdFlavourTest() {
    const Flavour &flavour = GetParam();
    writer_.big_endian = flavour.big_endian;
    writer_.version = flavour.version;
    writer_.announces_cell = flavour.has_cell;
    writer_.has_fourth = flavour.has_fourth;
    writer_.has_wide_markers = flavour.has_wide_markers;
    if (flavour.has_fixed) writer_.free_atoms = {2, 5, 7};
    bytes_ = writer_.header(7);
    header_size_ = bytes_.size();
    for (uint32_t k = 0; k < 4; ++k) {
      Positions frame = random_positions(7, k);
      if (k != 0 && flavour.has_fixed)
        for (size_t i : {0, 2, 3, 5})
          for (size_t axis = 0; axis < 3; ++axis) frame[3 * i + axis] = frames_[0][3 * i + axis];
      frames_.push_back(frame);
      bytes_ += writer_.frame(frame, k == 0, flavour.has_cell ? kCell : std::vector<double>());
      ends_.push_back(bytes_.size());
    }
  }

  DcdWriter writer_;
  std::string bytes_;
  size_t header_size_ = 0;
  std::vector<size_t> ends_;
  std::vector<Positions> frames_;
};

TEST_P(DcdFlavourTest, Frames) {
  const Trajectory trajectory = open_bytes(bytes_);
  ASSERT_EQ(trajectory.frame_count(), 4u);
  ASSERT_EQ(trajectory.atom_count(), 7u);
  EXPECT_FALSE(trajectory.incomplete());
  EXPECT_TRUE(trajectory.warnings().empty());
  for (size_t k : {2, 0, 3, 1, 1}) {
    SCOPED_TRACE(k);
    EXPECT_EQ(frame_of(trajectory, k), frames_[k]);
    const std::optional<Box> box = trajectory.box(k);
    ASSERT_EQ(box.has_value(), GetParam().has_cell);
    if (!box) continue;
    EXPECT_EQ(box->vectors[0], (std::array<double, 3>{30, 0, 0}));
    EXPECT_EQ(box->vectors[1], (std::array<double, 3>{0, 40, 0}));
    EXPECT_EQ(box->vectors[2], (std::array<double, 3>{0, 0, 50}));
  }
}

TEST_P(DcdFlavourTest, CutAtEveryByte) {
  expect_whole_frames_of_cuts(bytes_, TrajectoryFormat::kDcd, ends_, frames_);
  EXPECT_HAS(error_of_bytes(bytes_.substr(0, header_size_)), "it has no frames");
}

TEST_P(DcdFlavourTest, MutantsAreSafe) { expect_mutants_are_safe({bytes_}, TrajectoryFormat::kDcd, 4000); }

INSTANTIATE_TEST_SUITE_P(
    All, DcdFlavourTest,
    ::testing::Values(
        Flavour{"charmm", false, 24, false, false, false}, Flavour{"charmm_big", true, 24, false, false, false},
        Flavour{"cell", false, 24, true, false, false}, Flavour{"cell_big", true, 41, true, false, false},
        Flavour{"fourth", false, 24, false, true, false}, Flavour{"cell_fourth_big", true, 24, true, true, false},
        Flavour{"fixed", false, 24, false, false, true}, Flavour{"fixed_cell_fourth", false, 24, true, true, true},
        Flavour{"fixed_cell_big", true, 24, true, false, true}, Flavour{"xplor", false, 0, false, false, false},
        Flavour{"xplor_big", true, 0, false, false, false}, Flavour{"xplor_fixed", false, 0, false, false, true},
        Flavour{"wide", false, 24, false, false, false, true}, Flavour{"wide_big", true, 24, false, false, false, true},
        Flavour{"wide_all", false, 24, true, true, true, true},
        Flavour{"wide_all_big", true, 41, true, true, true, true}),
    [](const auto &info) { return std::string(info.param.name); });

// ---- unit cells

std::optional<Box> box_of(const std::vector<double> &cell, int32_t version = 24) {
  DcdWriter writer;
  writer.version = version;
  writer.announces_cell = true;
  return open_bytes(writer.header(1) + writer.frame({1, 2, 3}, true, cell)).box(0);
}

double length(const std::array<double, 3> &v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

double angle(const std::array<double, 3> &u, const std::array<double, 3> &v) {
  const double dot = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  return std::acos(dot / length(u) / length(v)) * 180 / 3.14159265358979323846;
}

void expect_cell(const std::optional<Box> &box, double a, double b, double c, double alpha, double beta, double gamma) {
  ASSERT_TRUE(box);
  const auto &v = box->vectors;
  EXPECT_NEAR(length(v[0]), a, 1e-9);
  EXPECT_NEAR(length(v[1]), b, 1e-9);
  EXPECT_NEAR(length(v[2]), c, 1e-9);
  EXPECT_NEAR(angle(v[1], v[2]), alpha, 1e-9);
  EXPECT_NEAR(angle(v[0], v[2]), beta, 1e-9);
  EXPECT_NEAR(angle(v[0], v[1]), gamma, 1e-9);
}

TEST(DcdCellTest, Cosines) {
  const auto cosine = [](double degrees) { return std::cos(degrees * 3.14159265358979323846 / 180); };
  expect_cell(box_of({30, cosine(70), 40, cosine(100), cosine(80), 50}), 30, 40, 50, 80, 100, 70);
  const std::optional<Box> box = box_of({30, cosine(70), 40, cosine(100), cosine(80), 50});
  EXPECT_EQ(box->vectors[0][1], 0);  // a along x, b in the plane of x and y, as the positions are meant
  EXPECT_EQ(box->vectors[0][2], 0);
  EXPECT_EQ(box->vectors[1][2], 0);
  EXPECT_GT(box->vectors[1][1], 0);
  EXPECT_GT(box->vectors[2][2], 0);
}

TEST(DcdCellTest, Degrees) {
  expect_cell(box_of({30, 70, 40, 100, 80, 50}), 30, 40, 50, 80, 100, 70);
  expect_cell(box_of({30, 90, 40, 90, 90, 50}), 30, 40, 50, 90, 90, 90);
  expect_cell(box_of({300, 90, 400, 90, 90, 500}, 41), 300, 400, 500, 90, 90, 90);
  expect_cell(box_of({60, 60, 60, 90, 60, 60}, 41), 60, 60, 60, 60, 90, 60);
  expect_cell(box_of({150, 90, 150, 80, 100, 150}, 41), 150, 150, 150, 100, 80, 90);  // a matrix has no 90 by chance
}

// CHARMM's own: the symmetric matrix whose rows are the vectors.
TEST(DcdCellTest, SymmetricMatrix) {
  const std::array<std::array<double, 3>, 3> matrix = {{{57, -11.5, -11.5}, {-11.5, 57, -11.5}, {-11.5, -11.5, 57}}};
  for (int32_t version : {24, 41}) {  // negative angles are none, whatever the version
    const std::optional<Box> box = box_of({57, -11.5, 57, -11.5, -11.5, 57}, version);
    ASSERT_TRUE(box);
    EXPECT_EQ(box->vectors, matrix);
  }
  const std::optional<Box> dodecahedron = box_of({58, 14, 58, 14, 2, 58}, 41);
  ASSERT_TRUE(dodecahedron);
  EXPECT_EQ(dodecahedron->vectors[2], (std::array<double, 3>{14, 2, 58}));
}

TEST(DcdCellTest, ASlightlyTiltedMatrixIsNoneOfCosines) {
  const std::array<std::array<double, 3>, 3> matrix = {{{60, 0.5, 0}, {0.5, 60, 0}, {0, 0, 60}}};
  const std::optional<Box> box = box_of({60, 0.5, 60, 0, 0, 60}, 41);
  ASSERT_TRUE(box);
  EXPECT_EQ(box->vectors, matrix);
  expect_cell(box_of({60, 0.5, 60, 0, 0, 60}), 60, 60, 60, 90, 90, 60);  // of a program that is not CHARMM
  expect_cell(box_of({60, 0, 70, 0, 0, 80}, 41), 60, 70, 80, 90, 90, 90);
  expect_cell(box_of({0.4, 0.5, 0.4, 0, 0, 60}, 41), 0.4, 0.4, 60, 90, 90, 60);  // no matrix of a cell
}

TEST(DcdCellTest, NoBox) {
  EXPECT_FALSE(box_of({0, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(box_of({0, 90, 0, 90, 90, 0}));
  EXPECT_FALSE(box_of({NAN, 0, 40, 0, 0, 50}));
  EXPECT_FALSE(box_of({30, 1, 40, 0, 0, 50}));        // flat
  EXPECT_FALSE(box_of({30, 10, 40, 100, 80, 50}));    // angles that no cell has
  EXPECT_FALSE(box_of({30, 500, 40, 500, 500, 50}));  // neither angles nor a matrix
}

TEST(DcdCellTest, TheFileDecidesWhereTheHeaderIsWrong) {
  DcdWriter writer;
  const Positions first = random_positions(5, 1), second = random_positions(5, 2);
  writer.announces_cell = false;
  const Trajectory with =
      open_bytes(writer.header(5) + writer.frame(first, true, kCell) + writer.frame(second, false, kCell));
  EXPECT_EQ(frame_of(with, 1), second);
  EXPECT_TRUE(with.box(1));
  writer.announces_cell = true;
  const Trajectory without = open_bytes(writer.header(5) + writer.frame(first, true) + writer.frame(second, false));
  EXPECT_EQ(frame_of(without, 1), second);
  EXPECT_FALSE(without.box(1));
}

// As other programs read it: 1 and nothing else says that there is a fourth dimension.
TEST(DcdTest, FlagOfTheFourthDimension) {
  DcdWriter writer;
  const Positions frame = random_positions(5, 1);
  for (int32_t flag : {0, 1, 2, -1}) {
    writer.has_fourth = flag == 1;
    std::string bytes = writer.header(5) + writer.frame(frame, true) + writer.frame(frame, false);
    bytes.replace(8 + 4 * 11, 4, raw_bytes(flag, false));
    const Trajectory trajectory = open_bytes(bytes);
    EXPECT_EQ(trajectory.frame_count(), 2u) << flag;
    EXPECT_EQ(frame_of(trajectory, 1), frame) << flag;
  }
}

// The coordinates of twelve atoms are as long as a unit cell.
TEST(DcdCellTest, TwelveAtoms) {
  for (bool has_cell : {false, true}) {
    DcdWriter writer;
    writer.announces_cell = has_cell;
    const Positions frame = random_positions(12, 1);
    const Trajectory trajectory =
        open_bytes(writer.header(12) + writer.frame(frame, true, has_cell ? kCell : std::vector<double>()));
    ASSERT_EQ(trajectory.frame_count(), 1u);
    EXPECT_EQ(frame_of(trajectory, 0), frame);
    EXPECT_EQ(trajectory.box(0).has_value(), has_cell);
  }
}

TEST(DcdTest, MoreAtomsThanOneChunk) {
  DcdWriter writer;
  const Positions first = random_positions(9001, 1), second = random_positions(9001, 2);
  const Trajectory all = open_bytes(writer.header(9001) + writer.frame(first, true) + writer.frame(second, false));
  EXPECT_EQ(frame_of(all, 0), first);
  EXPECT_EQ(frame_of(all, 1), second);
  for (int32_t atom = 2; atom <= 9001; ++atom) writer.free_atoms.push_back(atom);
  const Trajectory free = open_bytes(writer.header(9001) + writer.frame(first, true) + writer.frame(second, false));
  Positions expected = second;
  std::copy_n(first.begin(), 3, expected.begin());
  EXPECT_EQ(frame_of(free, 1), expected);
}

// ---- times and counts

TEST(DcdTest, Time) {
  for (int32_t version : {0, 24}) {
    DcdWriter writer;
    writer.version = version;
    writer.start = 500;
    writer.interval = 250;
    writer.step = 0.04090965;  // 2 fs
    const Positions frame = {1, 2, 3};
    const Trajectory trajectory = open_bytes(writer.header(1) + writer.frame(frame, true) + writer.frame(frame, false));
    ASSERT_TRUE(trajectory.time(0) && trajectory.time(1));
    EXPECT_NEAR(*trajectory.time(0), 1.0, 1e-6);
    EXPECT_NEAR(*trajectory.time(1), 1.5, 1e-6);
  }
  const DcdWriter writer;
  EXPECT_FALSE(open_bytes(writer.header(1) + writer.frame({1, 2, 3}, true)).time(0));
}

TEST(DcdTest, AnnouncedFrames) {
  DcdWriter writer;
  const auto file = [&](int32_t announced) {
    writer.announced = announced;
    return writer.header(1) + writer.frame({1, 2, 3}, true) + writer.frame({4, 5, 6}, false);
  };
  for (int32_t announced : {-1, 0, 1, 2}) {
    const Trajectory trajectory = open_bytes(file(announced));
    EXPECT_EQ(trajectory.frame_count(), 2u);
    EXPECT_FALSE(trajectory.incomplete());
  }
  const Trajectory trajectory = open_bytes(file(3));
  EXPECT_EQ(trajectory.frame_count(), 2u);
  EXPECT_TRUE(trajectory.incomplete());
  ASSERT_EQ(trajectory.warnings().size(), 1u);
  EXPECT_HAS(trajectory.warnings()[0], "its header announces 3 frames, but it ends after 2");
}

// ---- what is refused

TEST(DcdTest, WideMarkersAreKnownByContent) {
  for (bool big_endian : {false, true}) {
    DcdWriter writer;
    writer.big_endian = big_endian;
    writer.has_wide_markers = true;
    const std::string bytes = writer.header(1) + writer.frame({1, 2, 3}, true);
    const Trajectory trajectory = Trajectory::from_memory(bytes, std::nullopt, "no_extension");
    EXPECT_EQ(trajectory.format(), TrajectoryFormat::kDcd);
    EXPECT_EQ(frame_of(trajectory, 0), (Positions{1, 2, 3}));
    writer.magic = "VELD";
    EXPECT_HAS(error_of_bytes(writer.header(1) + writer.frame({1, 2, 3}, true)), "velocities");
    // A length that is more than 64 bits can be added to.
    std::string damaged = bytes;
    damaged.replace(100, 8, raw_bytes(int64_t{-1}, big_endian));
    EXPECT_HAS(error_of_bytes(damaged), "it is cut off within its titles");
  }
}

TEST(DcdTest, RefusesWhatIsNoDcd) {
  EXPECT_HAS(error_of_bytes(std::string(500, 'x')), "'test.dcd': it is no DCD file");
  DcdWriter writer;
  writer.magic = "VELD";
  EXPECT_HAS(error_of_bytes(writer.header(1) + writer.frame({1, 2, 3}, true)), "velocities");
  writer.magic = "HDRD";
  EXPECT_HAS(error_of_bytes(writer.header(1) + writer.frame({1, 2, 3}, true)), "it is no DCD file");
}

TEST(DcdTest, RefusesAbsurdCounts) {
  DcdWriter writer;
  const std::string frame = writer.frame({1, 2, 3}, true);
  for (int32_t count : {0, -1, INT32_MIN, INT32_MAX, 1 << 29})
    EXPECT_HAS(error_of_bytes(writer.header(count) + frame), "its number of atoms, " + std::to_string(count));
  // As many as fit in a record, but not in the file: nothing is allocated for them.
  EXPECT_HAS(error_of_bytes(writer.header(0x7fffffff / 4) + frame), "frame 0");
  EXPECT_HAS(error_of_bytes(writer.header(2) + frame), "frame 0 has 1 atom, but the header says 2");

  writer.free_atoms = {1, 2, 3};
  const auto with_header_number = [&](size_t i, int32_t value) {
    std::string bytes = writer.header(5) + writer.frame(random_positions(5, 1), true);
    return bytes.replace(8 + 4 * i, 4, raw_bytes(value, false));
  };
  for (int32_t count : {-1, 5, 6, INT32_MAX})
    EXPECT_HAS(error_of_bytes(with_header_number(8, count)), "its number of fixed atoms, " + std::to_string(count));
  EXPECT_HAS(error_of_bytes(with_header_number(8, 3)), "its list of free atoms is damaged");
  for (int32_t atom : {0, -1, 6}) {
    writer.free_atoms = {1, 2, atom};
    EXPECT_HAS(error_of_bytes(writer.header(5) + writer.frame(random_positions(5, 1), true)),
               "names atom " + std::to_string(atom) + " of 5");
  }
}

TEST(DcdTest, RefusesDifferingAtomCounts) {
  const DcdWriter writer;
  const std::string bytes =
      writer.header(3) + writer.frame(random_positions(3, 1), true) + writer.frame(random_positions(4, 2), false);
  EXPECT_HAS(error_of_bytes(bytes), "frame 1 has 4 atoms, but frame 0 has 3");
  DcdWriter two_free, three_free;  // of five; those that are fixed count
  two_free.free_atoms = {1, 5};
  three_free.free_atoms = {1, 2, 5};
  EXPECT_HAS(error_of_bytes(two_free.header(5) + two_free.frame(random_positions(5, 1), true) +
                            three_free.frame(random_positions(5, 2), false)),
             "frame 1 has 6 atoms, but frame 0 has 5");
}

TEST(DcdTest, JoinedFilesAreReported) {
  for (size_t atom_count : {3u, 21u}) {  // the header of a file is as long as the coordinates of 21 atoms
    const DcdWriter writer;
    const std::string one =
        writer.header(static_cast<int32_t>(atom_count)) + writer.frame(random_positions(atom_count, 1), true);
    const Trajectory trajectory = open_bytes(one + one);
    EXPECT_EQ(trajectory.frame_count(), 1u);
    EXPECT_TRUE(trajectory.incomplete());
    ASSERT_EQ(trajectory.warnings().size(), 1u);
    EXPECT_HAS(trajectory.warnings()[0], "frame 1 is the header of another DCD file");
  }
}

TEST(DcdTest, DamageIsReported) {
  const DcdWriter writer;
  const std::string header = writer.header(3), frame = writer.frame(random_positions(3, 1), true);
  const std::string bytes = header + frame + frame + frame;
  const auto with = [&](size_t at, uint32_t value) {
    return std::string(bytes).replace(at, 4, raw_bytes(value, false));
  };

  const size_t second = header.size() + frame.size();
  const Trajectory head = open_bytes(with(second, 11));  // what frame 1 starts with
  EXPECT_EQ(head.frame_count(), 1u);
  EXPECT_TRUE(head.incomplete());

  for (size_t place : {16u, 20u, 36u, 40u, 56u}) {  // the other lengths in it
    const Trajectory trajectory = open_bytes(with(second + place, 11));
    ASSERT_EQ(trajectory.frame_count(), 3u);
    EXPECT_EQ(frame_of(trajectory, 0), frame_of(trajectory, 2));
    EXPECT_HAS(error_of(ErrorKind::kInput, [&] { frame_of(trajectory, 1); }), "frame 1 is damaged");
  }
  const std::string framed = header + writer.frame({1, 2, 3, 4, 5, 6, 7, 8, 9}, true, kCell);
  std::string open_cell = framed + framed.substr(header.size());
  open_cell.replace(framed.size() + 52, 4, raw_bytes(uint32_t{11}, false));  // the length behind a unit cell
  const Trajectory without_cell = open_bytes(open_cell);
  EXPECT_EQ(without_cell.frame_count(), 1u);
  ASSERT_EQ(without_cell.warnings().size(), 1u);
  EXPECT_HAS(without_cell.warnings()[0], "frame 1 is damaged: its unit cell is missing");

  EXPECT_HAS(error_of_bytes(with(88, 11)), "its header is damaged");
  EXPECT_HAS(error_of_bytes(with(header.size() - 4, 11)), "number of atoms is damaged");
}

}  // namespace
}  // namespace quickses::io
