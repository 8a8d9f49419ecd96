// SPDX-License-Identifier: MIT
// AMBER's netCDF files of all flavours, written by the tests themselves.
#include "io/netcdf_fixture.h"

namespace quickses::io {
namespace {

Trajectory open_bytes(const std::string &bytes) {
  return Trajectory::from_memory(bytes, TrajectoryFormat::kNetcdf, "test.nc");
}

std::string error_of_bytes(const std::string &bytes) {
  return error_of(ErrorKind::kInput, [&] { open_bytes(bytes); });
}

std::vector<Positions> some_frames(size_t count, size_t atom_count = 5) {
  std::vector<Positions> frames;
  for (size_t k = 0; k < count; ++k) frames.push_back(random_positions(atom_count, static_cast<uint32_t>(k + 1)));
  return frames;
}

struct Flavour {
  const char *name;
  char version;
  NetcdfWriter::Layout layout;
  bool is_double, has_box, has_time, has_odd;
};

void PrintTo(const Flavour &flavour, std::ostream *stream) { *stream << flavour.name; }

class NetcdfFlavourTest : public ::testing::TestWithParam<Flavour> {
 protected:
  NetcdfFlavourTest() {
    const Flavour &flavour = GetParam();
    writer_.version = flavour.version;
    writer_.layout = flavour.layout;
    writer_.is_double = flavour.is_double;
    writer_.has_box = flavour.has_box;
    writer_.has_time = flavour.has_time;
    writer_.has_odd = flavour.has_odd;
    frames_ = some_frames(flavour.layout == NetcdfWriter::kRestart ? 1 : 4);
  }

  NetcdfWriter writer_;
  std::vector<Positions> frames_;
};

TEST_P(NetcdfFlavourTest, Frames) {
  const Trajectory trajectory = open_bytes(writer_.file(frames_));
  ASSERT_EQ(trajectory.frame_count(), frames_.size());
  ASSERT_EQ(trajectory.atom_count(), 5u);
  EXPECT_FALSE(trajectory.incomplete());
  EXPECT_TRUE(trajectory.warnings().empty());
  for (size_t n : {2, 0, 3, 1, 1}) {
    const size_t k = n % frames_.size();
    SCOPED_TRACE(k);
    EXPECT_EQ(frame_of(trajectory, k), frames_[k]);
    const std::optional<Box> box = trajectory.box(k);
    ASSERT_EQ(box.has_value(), GetParam().has_box);
    if (box) {
      EXPECT_EQ(box->vectors[0], (std::array<double, 3>{30, 0, 0}));
      EXPECT_EQ(box->vectors[1], (std::array<double, 3>{0, 40, 0}));
      EXPECT_EQ(box->vectors[2], (std::array<double, 3>{0, 0, 50}));
    }
    ASSERT_EQ(trajectory.time(k).has_value(), GetParam().has_time);
    if (GetParam().has_time) {
      EXPECT_EQ(*trajectory.time(k), 2.5 * static_cast<double>(k));
    }
  }
}

// Where the header says how many frames there are, one that is missing as a whole is missed as well.
TEST_P(NetcdfFlavourTest, CutAtEveryByte) {
  const std::string bytes = writer_.file(frames_);
  size_t least = 0;  // frames that could be read so far
  for (size_t size = 1; size < bytes.size(); ++size) {
    SCOPED_TRACE("cut after " + std::to_string(size) + " bytes");
    try {
      const Trajectory trajectory = open_bytes(bytes.substr(0, size));
      EXPECT_GE(trajectory.frame_count(), std::max<size_t>(least, 1));
      least = trajectory.frame_count();
      for (size_t k = 0; k < least; ++k) ASSERT_EQ(frame_of(trajectory, k), frames_[k]);
      EXPECT_EQ(trajectory.incomplete(), least < frames_.size());
      if (least == frames_.size()) continue;  // what is not read is missing: the values that fill up the last unit
      ASSERT_EQ(trajectory.warnings().size(), 1u);
      EXPECT_HAS(trajectory.warnings()[0], "'test.nc': frame " + std::to_string(least) + " is cut off");
    } catch (const Error &error) {
      EXPECT_EQ(least, 0u);
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      EXPECT_HAS(std::string(error.what()), "cut off");
    }
  }
  if (writer_.layout != NetcdfWriter::kRestart) {
    EXPECT_GT(least, 1u);
  }
}

TEST_P(NetcdfFlavourTest, MutantsAreSafe) {
  expect_mutants_are_safe({writer_.file(frames_)}, TrajectoryFormat::kNetcdf, 4000);
}

constexpr NetcdfWriter::Layout kRecords = NetcdfWriter::kRecords, kFixed = NetcdfWriter::kFixed,
                               kRestart = NetcdfWriter::kRestart;

INSTANTIATE_TEST_SUITE_P(All, NetcdfFlavourTest,
                         ::testing::Values(Flavour{"cdf1", 1, kRecords, false, false, false, false},
                                           Flavour{"cdf1_all", 1, kRecords, false, true, true, true},
                                           Flavour{"cdf2", 2, kRecords, false, true, true, false},
                                           Flavour{"cdf2_odd", 2, kRecords, false, false, true, true},
                                           Flavour{"cdf2_double", 2, kRecords, true, true, true, true},
                                           Flavour{"cdf5", 5, kRecords, false, true, true, false},
                                           Flavour{"cdf5_double_odd", 5, kRecords, true, false, true, true},
                                           Flavour{"fixed", 1, kFixed, false, true, true, false},
                                           Flavour{"fixed_odd", 2, kFixed, true, true, true, true},
                                           Flavour{"fixed_cdf5", 5, kFixed, false, false, false, true},
                                           Flavour{"restart", 1, kRestart, true, true, true, false},
                                           Flavour{"restart_cdf5", 5, kRestart, false, true, true, true},
                                           Flavour{"restart_plain", 2, kRestart, true, false, false, false}),
                         [](const auto &info) { return std::string(info.param.name); });

// A writer that was stopped may have left the number of records open: then the size of the file tells.
TEST(NetcdfTest, NumberOfRecordsLeftOpen) {
  for (char version : {1, 2, 5}) {
    NetcdfWriter writer;
    writer.version = version;
    writer.is_open = true;
    writer.has_box = writer.has_time = writer.has_odd = true;
    const std::vector<Positions> frames = some_frames(3);
    const std::string bytes = writer.file(frames);
    const Trajectory trajectory = open_bytes(bytes);
    ASSERT_EQ(trajectory.frame_count(), 3u);
    EXPECT_FALSE(trajectory.incomplete());
    expect_whole_frames_of_cuts(bytes, TrajectoryFormat::kNetcdf, writer.ends, frames);
  }
}

// Nothing says that the time comes first: a frame whose time is missing is cut off.
TEST(NetcdfTest, TimeBehindCoordinates) {
  for (NetcdfWriter::Layout layout : {kRecords, kFixed}) {
    NetcdfWriter writer;
    writer.layout = layout;
    writer.has_time = writer.is_time_last = true;
    const std::string bytes = writer.file(some_frames(3));
    const Trajectory whole = open_bytes(bytes), cut = open_bytes(bytes.substr(0, bytes.size() - 1));
    EXPECT_EQ(whole.frame_count(), 3u);
    EXPECT_EQ(whole.time(2), 5.0);
    EXPECT_EQ(cut.frame_count(), 2u);
    EXPECT_TRUE(cut.incomplete());
    EXPECT_EQ(cut.time(1), 2.5);
  }
}

TEST(NetcdfTest, TimesAreInPicoseconds) {
  NetcdfWriter writer;
  writer.has_time = true;
  const auto time_in = [&](const std::string &unit) {
    writer.time_unit = unit;
    return open_bytes(writer.file(some_frames(2))).time(1);
  };
  for (const char *unit : {"picosecond", "picoseconds", "Picosecond", "ps", ""}) EXPECT_EQ(time_in(unit), 2.5) << unit;
  for (const char *unit : {"femtosecond", "s", "nanosecond"}) EXPECT_FALSE(time_in(unit)) << unit;
}

TEST(NetcdfTest, ScaleFactor) {
  NetcdfWriter writer;
  writer.scale = 0.25;
  const std::vector<Positions> frames = some_frames(2);
  EXPECT_EQ(frame_of(open_bytes(writer.file(frames)), 1), frames[1]);
  writer.scale_count = 9;  // which are no factor
  Positions as_stored = frames[1];
  for (float &x : as_stored) x *= 4;
  EXPECT_EQ(frame_of(open_bytes(writer.file(frames)), 1), as_stored);
}

TEST(NetcdfTest, SkewedBox) {
  NetcdfWriter writer;
  writer.has_box = true;
  writer.cell = {60, 60, 60, 60, 60, 90};  // a rhombic dodecahedron: c = (30, 30, 42.426)
  const std::optional<Box> box = open_bytes(writer.file(some_frames(1))).box(0);
  ASSERT_TRUE(box);
  EXPECT_NEAR(box->vectors[2][0], 30, 1e-9);
  EXPECT_NEAR(box->vectors[2][1], 30, 1e-9);
  EXPECT_NEAR(box->vectors[2][2], 60 / std::sqrt(2), 1e-9);
  writer.cell = {0, 0, 0, 0, 0, 0};  // as of a molecule in a vacuum
  EXPECT_FALSE(open_bytes(writer.file(some_frames(1))).box(0));
}

TEST(NetcdfTest, MoreAtomsThanOneChunk) {
  const std::vector<Positions> frames = some_frames(2, 5001);
  EXPECT_EQ(frame_of(open_bytes(NetcdfWriter().file(frames)), 1), frames[1]);
}

TEST(NetcdfTest, RefusesWhatIsNoTrajectory) {
  EXPECT_HAS(error_of_bytes(std::string(200, 'x')), "'test.nc': it is no netCDF file in the classic format");
  EXPECT_HAS(error_of_bytes("CDF\x03" + std::string(200, '\0')), "it is no netCDF file in the classic format");
  EXPECT_HAS(error_of_bytes("\x89HDF\r\n\x1a\n" + std::string(200, '\0')), "netCDF-4 file (HDF5)");
  EXPECT_HAS(error_of_bytes("CDF\x01" + std::string(28, '\0')), "it has no variable 'coordinates'");
  NetcdfWriter writer;
  writer.name = "velocities";
  EXPECT_HAS(error_of_bytes(writer.file(some_frames(1))), "it has no variable 'coordinates'");
  writer.name = "coordinates";
  writer.units = "nanometer";
  EXPECT_HAS(error_of_bytes(writer.file(some_frames(1))), "its coordinates are in 'nanometer', not in angstrom");
  writer.units = "";
  EXPECT_EQ(frame_of(open_bytes(writer.file(some_frames(1))), 0), some_frames(1)[0]);
}

// A file in which bytes of the header were changed.
std::string with(const NetcdfWriter &writer, const std::string &before, const std::string &from,
                 const std::string &to) {
  std::string bytes = writer.file(some_frames(2));
  const size_t at = bytes.find(before + from);
  EXPECT_NE(at, std::string::npos);
  return bytes.replace(at + before.size(), from.size(), to);
}

TEST(NetcdfTest, RefusesOtherShapes) {
  const NetcdfWriter writer;
  const std::string name = writer.size(11) + "coordinates" + std::string(1, '\0'), three = writer.size(3);
  const std::string ids = writer.size(0) + writer.size(2) + writer.size(1);  // frame, atom, spatial
  const std::string two = writer.size(2) + writer.size(0) + writer.size(2), any = writer.size(1);
  EXPECT_HAS(error_of_bytes(
                 with(writer, name + three + writer.size(0), writer.size(2) + any, writer.size(2) + writer.size(2))),
             "other dimensions than frame, atom and spatial (3)");
  EXPECT_HAS(error_of_bytes(with(writer, name + three, ids, writer.size(2) + writer.size(0) + writer.size(1))),
             "its header is damaged");  // the record dimension is always the first
  EXPECT_HAS(error_of_bytes(with(writer, name + three, ids, writer.size(0) + writer.size(2) + writer.size(9))),
             "its header is damaged");  // there is no such dimension
}

TEST(NetcdfTest, RefusesAbsurdCounts) {
  for (char version : {1, 2, 5}) {
    SCOPED_TRACE(static_cast<int>(version));
    NetcdfWriter writer;
    writer.version = version;
    const std::string atom = writer.size(4) + "atom", five = writer.size(5);
    // More atoms than there are bytes: refused before anyone makes room for them.
    EXPECT_HAS(error_of_bytes(with(writer, atom, five, writer.size(0x7fffffff))), "frame 0 is cut off");
    EXPECT_HAS(error_of_bytes(with(writer, atom, five, writer.size(0x80000000))), "its number of atoms, 2147483648,");
    EXPECT_HAS(error_of_bytes(with(writer, atom, five, writer.size(UINT64_MAX))),
               version == 5 ? "its header is damaged" : "number of atoms");
    EXPECT_HAS(error_of_bytes(with(writer, "", atom, writer.size(UINT32_MAX) + "atom")), "its header is damaged");
    const std::string list = std::string("\0\0\0\x0a", 4);
    EXPECT_HAS(error_of_bytes(with(writer, list, five, writer.size(UINT32_MAX))), "its header is damaged");
    EXPECT_HAS(error_of_bytes(with(writer, list, five, writer.size(0))), "its header is damaged");
  }
  // Numbers whose products are 2^64, which is 0 in 64 bits.
  NetcdfWriter wide;
  wide.version = 5;
  wide.scale = 0.25;
  const std::string one_double = raw_bytes(uint32_t{6}, true) + wide.size(1), quarter = raw_bytes(0.25, true);
  EXPECT_HAS(error_of_bytes(with(wide, "scale_factor", one_double + quarter,
                                 raw_bytes(uint32_t{6}, true) + wide.size(uint64_t{1} << 61))),
             "its header is damaged");
  wide.layout = kFixed;
  EXPECT_HAS(error_of_bytes(
                 with(wide, wide.size(5) + "frame" + std::string(3, '\0'), wide.size(2), wide.size(uint64_t{1} << 62))),
             "its header is damaged");

  // Variables beside the coordinates, each as large as one may be: together a record of 2^64 bytes and some.
  NetcdfWriter records;
  records.version = 5;
  const std::string angular = "cell_angular", last_dimension = records.size(4);
  std::string huge = with(records, angular, records.size(3), records.size(uint64_t{1} << 60)), more;
  for (int k = 0; k < 16; ++k)
    more += records.size(1) + "x" + std::string(3, '\0') + records.size(2) + records.size(0) + last_dimension +
            raw_bytes(uint32_t{0}, true) + records.size(0) + raw_bytes(uint32_t{2}, true) + records.size(0) +
            raw_bytes(uint64_t{4096}, true);
  const std::string variables = raw_bytes(uint32_t{11}, true);
  huge.replace(huge.find(variables + records.size(2)), 12, variables + records.size(18));
  huge.insert(huge.rfind(std::string("xyz\0", 4)), more);
  EXPECT_HAS(error_of_bytes(huge), "its header is damaged");

  // More records than the file has.
  const NetcdfWriter writer;
  std::string bytes = writer.file(some_frames(2));
  const Trajectory trajectory = open_bytes(bytes.replace(4, 4, writer.size(0xfffffffe)));
  EXPECT_EQ(trajectory.frame_count(), 2u);
  EXPECT_TRUE(trajectory.incomplete());
  EXPECT_HAS(error_of_bytes(bytes.replace(4, 4, writer.size(0))), "it has no frames");
}

TEST(NetcdfTest, PositionsThatAreNoneAreRefused) {
  const auto read_error = [](const Positions &positions) {
    const Trajectory trajectory = open_bytes(NetcdfWriter().file({positions}));
    return error_of(ErrorKind::kInput, [&] { frame_of(trajectory, 0); });
  };
  EXPECT_HAS(read_error({1, 2, 3, 4, NAN, 6}), "frame 0: atom 2 has no finite y coordinate");
  EXPECT_HAS(read_error({9.96921e36f, 2, 3}), "atom 1 is more than 1,000,000 Å");  // what netCDF fills with
}

}  // namespace
}  // namespace quickses::io
