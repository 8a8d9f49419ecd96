// SPDX-License-Identifier: MIT
// The C API: trajectories from files and from memory.
#include "capi/capi_fixture.h"
#include "io/netcdf_fixture.h"
#include "io/own_folder.h"

#include <atomic>
#include <thread>

namespace {

using namespace capi_fixture;
using quickses::io::DcdWriter;
using quickses::io::Positions;
using quickses::io::random_positions;

struct CloseTrajectory {
  void operator()(qses_trajectory *trajectory) const { qses_trajectory_close(trajectory); }
};
using TrajectoryPointer = std::unique_ptr<qses_trajectory, CloseTrajectory>;

TrajectoryPointer open_bytes(const std::string &bytes, qses_trajectory_format format = QSES_TRAJECTORY_DCD) {
  qses_trajectory *trajectory = nullptr;
  expect_ok(qses_trajectory_open_memory(bytes.data(), bytes.size(), format, &trajectory));
  return TrajectoryPointer(trajectory);
}

qses_trajectory_description info_of(const TrajectoryPointer &trajectory) {
  qses_trajectory_description info;
  qses_trajectory_description_init(&info);
  expect_ok(qses_trajectory_info(trajectory.get(), &info));
  return info;
}

Positions read_frame(const TrajectoryPointer &trajectory, uint64_t k, qses_frame *frame = nullptr) {
  Positions positions(3 * info_of(trajectory).atom_count, -1.f);
  expect_ok(qses_trajectory_read_frame(trajectory.get(), k, positions.data(), 0, positions.size() / 3, frame));
  return positions;
}

// A DCD file; edges a, b, c of an orthogonal box, which is 0 in frame `boxless`, or none.
std::string dcd(const std::vector<Positions> &frames, const std::vector<double> &edges = {}, size_t boxless = ~0u) {
  DcdWriter writer;
  writer.announced = static_cast<int32_t>(frames.size());
  writer.announces_cell = !edges.empty();
  std::vector<double> cell;
  if (!edges.empty()) cell = {edges[0], 90, edges[1], 90, 90, edges[2]};
  std::string bytes = writer.header(static_cast<int32_t>(frames[0].size() / 3));
  for (size_t k = 0; k < frames.size(); ++k)
    bytes += writer.frame(frames[k], k == 0, k == boxless ? std::vector<double>(6) : cell);
  return bytes;
}

std::vector<Positions> some_frames(size_t count, size_t atom_count = 5) {
  std::vector<Positions> frames;
  for (size_t k = 0; k < count; ++k) frames.push_back(random_positions(atom_count, static_cast<uint32_t>(k + 1)));
  return frames;
}

TEST(Trajectory, FramesInAnyOrder) {
  const std::vector<Positions> frames = some_frames(4);
  const TrajectoryPointer trajectory = open_bytes(dcd(frames));
  const qses_trajectory_description info = info_of(trajectory);
  EXPECT_EQ(info.format, QSES_TRAJECTORY_DCD);
  EXPECT_EQ(info.frame_count, 4u);
  EXPECT_EQ(info.atom_count, 5u);
  EXPECT_EQ(info.has_box, 0);
  EXPECT_EQ(info.incomplete, 0);
  EXPECT_EQ(info.warning_count, 0u);
  EXPECT_EQ(info.is_unwrapped, 0);
  for (uint64_t k : {3, 0, 2, 1, 3}) EXPECT_EQ(read_frame(trajectory, k), frames[k]);
}

TEST(Trajectory, StrideLeavesWhatLiesBetween) {
  const std::vector<Positions> frames = some_frames(2);
  const TrajectoryPointer trajectory = open_bytes(dcd(frames));
  for (size_t stride : {12, 16, 28}) {
    std::vector<float> wide(5 * stride / 4 + 1, -7.f);
    ASSERT_EQ(qses_trajectory_read_frame(trajectory.get(), 1, wide.data(), stride, 5, nullptr), QSES_OK);
    for (size_t i = 0; i + 1 < wide.size(); ++i) {
      const size_t atom = i / (stride / 4), place = i % (stride / 4);
      EXPECT_EQ(wide[i], place < 3 ? frames[1][3 * atom + place] : -7.f);
    }
    EXPECT_EQ(wide.back(), -7.f);
  }
}

TEST(Trajectory, WhatIsRefusedWritesNothing) {
  const TrajectoryPointer trajectory = open_bytes(dcd(some_frames(2)));
  std::vector<float> positions(15, -7.f);
  qses_frame frame;
  qses_frame_init(&frame);
  frame.struct_size = 3;
  expect_error(qses_trajectory_read_frame(trajectory.get(), 1, positions.data(), 0, 5, &frame), QSES_INVALID_ARGUMENT,
               {"qses_frame"});
  EXPECT_EQ(positions, std::vector<float>(15, -7.f));
}

TEST(Trajectory, TimeAndBox) {
  quickses::io::XtcWriter writer;
  writer.time = 12.5f;
  writer.box = {2, 0, 0, 0, 3, 0, 1, 0, 4};
  const TrajectoryPointer trajectory = open_bytes(writer.plain_frame({0.1f, 0.2f, 0.3f}), QSES_TRAJECTORY_XTC);
  EXPECT_EQ(info_of(trajectory).has_box, 1);
  qses_frame frame;
  qses_frame_init(&frame);
  EXPECT_EQ(read_frame(trajectory, 0, &frame).size(), 3u);
  EXPECT_EQ(frame.has_time, 1);
  EXPECT_EQ(frame.time, 12.5);
  ASSERT_EQ(frame.has_box, 1);
  const double expected[9] = {20, 0, 0, 0, 30, 0, 10, 0, 40};
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(frame.box[i], expected[i], 1e-5);
  EXPECT_EQ(frame.is_unwrapped, 0);
}

TEST(Trajectory, FormatsByNumberAndByContent) {
  const Positions positions = {1, 2, 3};
  const std::pair<qses_trajectory_format, std::string> files[] = {
      {QSES_TRAJECTORY_TRR, quickses::io::TrrWriter().frame(positions)},
      {QSES_TRAJECTORY_NETCDF, quickses::io::NetcdfWriter().file({positions})},
  };
  for (const auto &[format, bytes] : files)
    for (const qses_trajectory_format asked : {format, QSES_TRAJECTORY_AUTO}) {
      const TrajectoryPointer trajectory = open_bytes(bytes, asked);
      EXPECT_EQ(info_of(trajectory).format, format);
      const Positions read = read_frame(trajectory, 0);
      for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(read[i], positions[i], 1e-5);
    }
}

TEST(Trajectory, GzippedBuffersAndUnknownFormats) {
  const std::vector<Positions> frames = some_frames(3);
  const std::string plain = dcd(frames);
  const OwnFolder folder;
  const std::string path = folder.path("a.gz");
  gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, plain.data(), static_cast<unsigned>(plain.size()));
  gzclose(file);
  const std::string packed = quickses::io::slurp(path);
  ASSERT_NE(packed, plain);
  for (const std::string &bytes : {plain, packed})
    for (const auto format : {QSES_TRAJECTORY_DCD, QSES_TRAJECTORY_AUTO}) {
      const TrajectoryPointer trajectory = open_bytes(bytes, format);
      ASSERT_EQ(info_of(trajectory).frame_count, 3u);
      EXPECT_EQ(read_frame(trajectory, 2), frames[2]);
    }
}

TEST(Trajectory, ABufferIsCopied) {
  const std::vector<Positions> frames = some_frames(2);
  std::string bytes = dcd(frames);
  const TrajectoryPointer trajectory = open_bytes(bytes);
  bytes.assign(bytes.size(), 'x');
  EXPECT_EQ(read_frame(trajectory, 1), frames[1]);
}

TEST(Trajectory, WholeFramesOfAFileThatIsCutOff) {
  const std::vector<Positions> frames = some_frames(3);
  const std::string bytes = dcd(frames);
  const TrajectoryPointer trajectory = open_bytes(bytes.substr(0, bytes.size() - 1));
  const qses_trajectory_description info = info_of(trajectory);
  EXPECT_EQ(info.frame_count, 2u);
  EXPECT_EQ(info.incomplete, 1);
  ASSERT_EQ(info.warning_count, 1u);
  const char *sentence = nullptr;
  ASSERT_EQ(qses_trajectory_warning(trajectory.get(), 0, &sentence), QSES_OK);
  EXPECT_NE(std::string(sentence).find("frame 2"), std::string::npos) << sentence;
  expect_error(qses_trajectory_warning(trajectory.get(), 1, &sentence), QSES_INVALID_ARGUMENT,
               {"k is 1 but there is 1 warning"});
  EXPECT_EQ(read_frame(trajectory, 1), frames[1]);
}

TEST(Trajectory, ADamagedFrameDoesNotHideTheOthers) {
  std::vector<Positions> frames = some_frames(3);
  frames[0][4] = kNan;
  const TrajectoryPointer trajectory = open_bytes(dcd(frames));
  float xyz[15];
  expect_error(qses_trajectory_read_frame(trajectory.get(), 0, xyz, 0, 5, nullptr), QSES_FILE_ERROR,
               {"frame 0", "atom 2", "finite"});
  EXPECT_EQ(read_frame(trajectory, 1), frames[1]);
}

// Two molecules of two carbon atoms each; the second one is torn by the border at 10 Å.
const Positions kTorn = {2, 2, 2, 3.5f, 2, 2, 9.5f, 5, 5, 1, 5, 5};
const Positions kWhole = {2, 2, 2, 3.5f, 2, 2, 9.5f, 5, 5, 11, 5, 5};
const uint8_t kCarbons[4] = {6, 6, 6, 6};

TEST(Trajectory, UnwrappedFramesHaveWholeMolecules) {
  const TrajectoryPointer trajectory = open_bytes(dcd({kTorn, kTorn}, {10, 10, 10}));
  qses_frame frame;
  qses_frame_init(&frame);
  EXPECT_EQ(read_frame(trajectory, 1, &frame), kTorn);
  EXPECT_EQ(frame.is_unwrapped, 0);
  ASSERT_EQ(qses_trajectory_unwrap(trajectory.get(), kCarbons, 4), QSES_OK) << qses_last_error();
  EXPECT_EQ(info_of(trajectory).is_unwrapped, 1);
  EXPECT_EQ(read_frame(trajectory, 1, &frame), kWhole);
  EXPECT_EQ(frame.is_unwrapped, 1);
  std::vector<float> wide(16, -7.f);
  qses_frame of_wide;
  qses_frame_init(&of_wide);
  ASSERT_EQ(qses_trajectory_read_frame(trajectory.get(), 0, wide.data(), 16, 4, &of_wide), QSES_OK);
  EXPECT_EQ(of_wide.is_unwrapped, 1);
  EXPECT_EQ(wide[12], kWhole[9]);
  EXPECT_EQ(wide[15], -7.f);
}

TEST(Trajectory, UnwrappedFramesTellThatTheyHaveNoBox) {
  for (const size_t boxless : {0, 1}) {
    const TrajectoryPointer trajectory = open_bytes(dcd({kTorn, kTorn}, {10, 10, 10}, boxless));
    EXPECT_EQ(info_of(trajectory).has_box, boxless == 0 ? 0 : 1);
    ASSERT_EQ(qses_trajectory_unwrap(trajectory.get(), kCarbons, 4), QSES_OK) << qses_last_error();
    qses_frame frame;
    qses_frame_init(&frame);
    EXPECT_EQ(read_frame(trajectory, boxless, &frame), kTorn);
    EXPECT_EQ(frame.is_unwrapped, 0);
    EXPECT_EQ(read_frame(trajectory, 1 - boxless, &frame), kWhole);
    EXPECT_EQ(frame.is_unwrapped, 1);
  }
}

TEST(Trajectory, ADamagedFirstFrameDoesNotHideBonds) {
  Positions damaged = kTorn;
  damaged[4] = kNan;
  const TrajectoryPointer trajectory = open_bytes(dcd({damaged, kTorn}, {10, 10, 10}));
  ASSERT_EQ(qses_trajectory_unwrap(trajectory.get(), kCarbons, 4), QSES_OK) << qses_last_error();
  EXPECT_EQ(read_frame(trajectory, 1), kWhole);
  const TrajectoryPointer hopeless = open_bytes(dcd({damaged, damaged}, {10, 10, 10}));
  expect_error(qses_trajectory_unwrap(hopeless.get(), kCarbons, 4), QSES_FILE_ERROR, {"frame 0", "atom 2", "finite"});
  EXPECT_EQ(info_of(hopeless).is_unwrapped, 0);
}

// Whole molecules may end where no surface could be computed.
TEST(Trajectory, UnwrappedPositionsAreWithinBoundsToo) {
  const Positions torn = {999'999.5f, 0, 0, -999'998.f, 0, 0};
  const TrajectoryPointer trajectory = open_bytes(dcd({torn}, {1'999'999, 10, 10}));
  EXPECT_EQ(read_frame(trajectory, 0), torn);
  ASSERT_EQ(qses_trajectory_unwrap(trajectory.get(), kCarbons, 2), QSES_OK) << qses_last_error();
  Positions positions(6);
  expect_error(qses_trajectory_read_frame(trajectory.get(), 0, positions.data(), 0, 2, nullptr), QSES_FILE_ERROR,
               {"frame 0", "atom 2", "1,000,000"});
}

TEST(Trajectory, WithoutABoxThereIsNothingToUnwrap) {
  const TrajectoryPointer trajectory = open_bytes(dcd({kTorn}));
  expect_error(qses_trajectory_unwrap(trajectory.get(), kCarbons, 4), QSES_NO_BOX, {"box"});
  EXPECT_EQ(info_of(trajectory).is_unwrapped, 0);
  EXPECT_EQ(read_frame(trajectory, 0), kTorn);
}

// The way from a file to a surface: atoms that were kept are picked out of frames that have all of them.
TEST(Trajectory, FramesOfAStructureThatWasFiltered) {
  std::string pdb;
  for (int i = 0; i < 6; ++i) {
    char line[96];
    std::snprintf(line, sizeof line, "ATOM  %5d  O   %s A%4d    %8.3f%8.3f%8.3f  1.00  0.00           O\n", i + 1,
                  i % 2 ? "GLY" : "HOH", i + 1, 2.0 * i, 0.0, 0.0);
    pdb += line;
  }
  qses_structure_options options;
  qses_structure_options_init(&options);
  options.water = 0;
  qses_structure *structure = nullptr;
  ASSERT_EQ(qses_structure_open_memory(pdb.data(), pdb.size(), &options, &structure), QSES_OK) << qses_last_error();
  qses_structure_description info;
  qses_structure_description_init(&info);
  ASSERT_EQ(qses_structure_info(structure, &info), QSES_OK);
  ASSERT_EQ(info.atom_count, 3u);

  const std::vector<Positions> frames = some_frames(2, 6);
  const TrajectoryPointer trajectory = open_bytes(dcd(frames));
  ASSERT_EQ(info_of(trajectory).atom_count, info.file_atom_count);
  Context context, expected;
  ASSERT_EQ(qses_set_atoms(context, info.positions, 0, info.radii, info.atom_count), QSES_OK);
  const Positions frame = read_frame(trajectory, 1);
  ASSERT_EQ(qses_set_positions_indexed(context, frame.data(), 0, 6, info.file_indices, info.atom_count), QSES_OK);
  ASSERT_EQ(qses_compute(context, nullptr, nullptr), QSES_OK);
  Atoms kept;
  for (size_t i : {1, 3, 5}) kept.add(frame[3 * i], frame[3 * i + 1], frame[3 * i + 2], 1.52);
  set_atoms(expected, kept);
  ASSERT_EQ(qses_compute(expected, nullptr, nullptr), QSES_OK);
  EXPECT_EQ(copy_surface(context).mesh.positions, copy_surface(expected).mesh.positions);
  qses_structure_close(structure);
}

TEST(Trajectory, ManyThreadsReadAtATime) {
  const std::vector<Positions> frames = some_frames(20, 50);
  const TrajectoryPointer trajectory = open_bytes(dcd(frames));
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (uint64_t t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      Positions xyz(150);
      for (uint64_t k = 0; k < 200; ++k) {
        const uint64_t frame = (k * (2 * t + 1) + t) % 20;
        if (qses_trajectory_read_frame(trajectory.get(), frame, xyz.data(), 0, 50, nullptr) != QSES_OK ||
            xyz != frames[frame])
          ++wrong;
      }
    });
  for (std::thread &thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

TEST(Trajectory, OneIsSingular) {
  const TrajectoryPointer trajectory = open_bytes(dcd(some_frames(1, 1)));
  float xyz[6];
  EXPECT_EQ(qses_trajectory_read_frame(trajectory.get(), 1, xyz, 0, 1, nullptr), QSES_INVALID_ARGUMENT);
  EXPECT_STREQ(qses_last_error(), "index is 1 but the trajectory has 1 frame");
  EXPECT_EQ(qses_trajectory_read_frame(trajectory.get(), 0, xyz, 0, 2, nullptr), QSES_INVALID_ARGUMENT);
  EXPECT_STREQ(qses_last_error(), "count is 2 but the trajectory has 1 atom");
}

TEST(Trajectory, Errors) {
  const std::string bytes = dcd(some_frames(2));
  qses_trajectory *opened = reinterpret_cast<qses_trajectory *>(&opened);
  qses_trajectory *of_memory = opened;
  expect_error(qses_trajectory_open("/nowhere/t.xtc", QSES_TRAJECTORY_AUTO, &opened), QSES_FILE_ERROR,
               {"/nowhere/t.xtc", "no such file"});
  EXPECT_EQ(opened, nullptr);
  expect_error(qses_trajectory_open(nullptr, QSES_TRAJECTORY_AUTO, &opened), QSES_INVALID_ARGUMENT, {"path", "NULL"});
  expect_error(qses_trajectory_open("t.xtc", QSES_TRAJECTORY_AUTO, nullptr), QSES_INVALID_ARGUMENT, {"trajectory"});
  expect_error(qses_trajectory_open_memory(nullptr, 5, QSES_TRAJECTORY_AUTO, &opened), QSES_INVALID_ARGUMENT,
               {"bytes", "NULL"});
  expect_error(qses_trajectory_open_memory("what is this", 12, QSES_TRAJECTORY_AUTO, &opened), QSES_FILE_ERROR,
               {"format"});
  expect_error(qses_trajectory_open_memory(bytes.data(), 20, QSES_TRAJECTORY_DCD, &of_memory), QSES_FILE_ERROR,
               {"cut off"});
  EXPECT_EQ(of_memory, nullptr);
  expect_error(qses_trajectory_open_memory(bytes.data(), 0, QSES_TRAJECTORY_DCD, &opened), QSES_FILE_ERROR, {"empty"});
  // (Numbers that name no format: capi_c99_test.c.)

  const TrajectoryPointer trajectory = open_bytes(bytes);
  float xyz[15];
  const auto read = [&](uint64_t k, float *to, size_t stride, size_t count) {
    return qses_trajectory_read_frame(trajectory.get(), k, to, stride, count, nullptr);
  };
  expect_error(read(2, xyz, 0, 5), QSES_INVALID_ARGUMENT, {"index is 2", "2 frames"});
  expect_error(read(~uint64_t(0), xyz, 0, 5), QSES_INVALID_ARGUMENT, {"index"});
  expect_error(read(0, xyz, 0, 4), QSES_INVALID_ARGUMENT, {"count is 4", "5 atoms"});
  expect_error(read(0, xyz, 0, 0), QSES_INVALID_ARGUMENT, {"count is 0"});
  expect_error(read(0, xyz, 8, 5), QSES_INVALID_ARGUMENT, {"stride is 8"});
  expect_error(read(0, nullptr, 0, 5), QSES_INVALID_ARGUMENT, {"positions", "NULL"});
  expect_error(qses_trajectory_read_frame(nullptr, 0, xyz, 0, 5, nullptr), QSES_INVALID_ARGUMENT,
               {"trajectory", "NULL"});
  qses_frame frame;
  qses_frame_init(&frame);
  frame.struct_size = 1;
  expect_error(qses_trajectory_read_frame(trajectory.get(), 0, xyz, 0, 5, &frame), QSES_INVALID_ARGUMENT,
               {"struct_size"});
  expect_error(qses_trajectory_unwrap(trajectory.get(), nullptr, 5), QSES_INVALID_ARGUMENT, {"elements", "NULL"});
  expect_error(qses_trajectory_unwrap(trajectory.get(), kCarbons, 4), QSES_INVALID_ARGUMENT, {"count is 4"});
  expect_error(qses_trajectory_warning(trajectory.get(), 0, nullptr), QSES_INVALID_ARGUMENT, {"sentence", "NULL"});
  expect_error(qses_trajectory_info(trajectory.get(), nullptr), QSES_INVALID_ARGUMENT, {"description", "NULL"});
  qses_trajectory_close(nullptr);
  qses_trajectory_description_init(nullptr);
  qses_frame_init(nullptr);
}

}  // namespace
