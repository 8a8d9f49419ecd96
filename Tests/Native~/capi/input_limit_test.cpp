// SPDX-License-Identifier: MIT
// Files, pipes and buffers are taken into memory up to a limit: what packs much into little, or has no end, is refused.
#include "io/file_bytes.h"

#include <memory>
#include <thread>

#include "io/io_fixture.h"
#include "io/structure.h"
#include "io/trajectory.h"
#include "quickses/quickses.h"

#if !defined(_WIN32)
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace quickses::io {
namespace {

constexpr size_t kMiB = 1 << 20;

// Atoms one behind the other in one model; a record has 81 bytes.
std::string pdb_text(size_t atoms) {
  std::string text;
  for (size_t i = 0; i < atoms; ++i)
    text += "ATOM      1  N   ALA A   1       1.000   2.000   3.000  1.00  0.00           N  \n";
  return text;
}

std::string gzipped(const std::string &text, const std::string &path) {
  gzFile file = gzopen(path.c_str(), "wb9");
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
  return slurp(path);
}

class InputLimitTest : public IoTest {
 protected:
  void TearDown() override {
    set_input_limit(0);
    IoTest::TearDown();
  }

  // 32 MiB of blanks, `times` times: about a thousandth of that. Gzip data may have many members.
  std::string write_bomb(const std::string &name, size_t times) const {
    static const std::string member = gzipped(std::string(32 * kMiB, ' '), path("member.gz"));
    std::string bomb;
    for (size_t i = 0; i < times; ++i) bomb += member;
    return write(name, bomb);
  }
};

TEST_F(InputLimitTest, GzipDataMayUnpackTo256MiBAndNoMoreIfItIsSmall) {
  EXPECT_EQ(read_file_bytes(write_bomb("a.pdb.gz", 8)).size(), 256 * kMiB);
  const std::string bomb = write_bomb("b.pdb.gz", 9);
  for (const auto &action : std::vector<std::function<void()>>{
           [&] { read_structure(bomb); }, [&] { Trajectory::from_memory(slurp(bomb), std::nullopt); }})
    EXPECT_HAS(error_of(ErrorKind::kInput, action), "256 MiB");
}

TEST_F(InputLimitTest, ALimitHoldsForAllAlike) {
  const std::string text = pdb_text(50), packed = gzipped(text, path("a.pdb.gz"));
  const std::string plain = write("a.pdb", text);
  const std::vector<std::function<void()>> actions = {
      [&] { read_structure(plain); },
      [&] { read_structure(path("a.pdb.gz")); },
      [&] { parse_structure(packed, StructureFormat::kPdb); },
      [&] { Trajectory::open(plain); },
      [&] { Trajectory::open(path("a.pdb.gz")); },
      [&] { Trajectory::from_memory(packed, TrajectoryFormat::kPdb); },
  };
  set_input_limit(text.size());
  for (const auto &action : actions) action();
  set_input_limit(text.size() - 1);
  for (const auto &action : actions) {
    const std::string message = error_of(ErrorKind::kInput, action);
    EXPECT_HAS(message, std::to_string(text.size() - 1) + " bytes");
    EXPECT_HAS(message, "--max-input");
    EXPECT_HAS(message, "qses_input_set_limit");
  }
  parse_structure(text, StructureFormat::kPdb);  // is in memory already
}

TEST_F(InputLimitTest, TheCApiHasIt) {
  const std::string plain = write("a.pdb", pdb_text(50));
  qses_structure *structure = nullptr;
  qses_input_set_limit(100);
  EXPECT_EQ(qses_structure_open(plain.c_str(), nullptr, &structure), QSES_FILE_ERROR);
  EXPECT_HAS(qses_last_error(), "a.pdb");
  EXPECT_EQ(structure, nullptr);
  qses_trajectory *trajectory = nullptr;
  EXPECT_EQ(qses_trajectory_open(plain.c_str(), QSES_TRAJECTORY_PDB, &trajectory), QSES_FILE_ERROR);
  EXPECT_EQ(trajectory, nullptr);
  qses_input_set_limit(0);
  EXPECT_EQ(qses_structure_open(plain.c_str(), nullptr, &structure), QSES_OK);
  qses_structure_close(structure);
}

#if !defined(_WIN32)
TEST_F(InputLimitTest, APipeIsReadToItsEndOrToTheLimit) {
  ASSERT_EQ(mkfifo(path("pipe.pdb").c_str(), 0600), 0);
  const std::string text = pdb_text(20000);
  const auto feed = [&] {
    std::FILE *file = std::fopen(path("pipe.pdb").c_str(), "wb");
    std::fwrite(text.data(), 1, text.size(), file);
    std::fclose(file);
  };
  for (uint64_t limit : {uint64_t{0}, uint64_t{text.size()}}) {
    set_input_limit(limit);
    std::thread feeder(feed);
    EXPECT_EQ(read_structure(path("pipe.pdb")).models.at(0).file_atom_count, 20000u);
    feeder.join();
  }
}

TEST_F(InputLimitTest, WhatHasNoEndIsRefusedAtTheLimit) {
  set_input_limit(10 * kMiB);
  for (const auto &action :
       std::vector<std::function<void()>>{[] { read_structure("/dev/zero"); }, [] { Trajectory::open("/dev/zero"); }})
    EXPECT_HAS(error_of(ErrorKind::kInput, action), "/dev/zero' has more than 10 MiB");
}

TEST_F(InputLimitTest, SizesThatAreOnlyClaimedTakeNoMemory) {
  write("sparse.pdb", "");
  ASSERT_EQ(truncate(path("sparse.pdb").c_str(), off_t{1} << 40), 0);
  for (const auto &action : std::vector<std::function<void()>>{[&] { read_structure(path("sparse.pdb")); },
                                                               [&] { Trajectory::open(path("sparse.pdb")); }})
    EXPECT_HAS(error_of(ErrorKind::kInput, action), "4096 MiB");
}
#endif

}  // namespace
}  // namespace quickses::io
