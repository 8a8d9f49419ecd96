// SPDX-License-Identifier: MIT
// Files whose names have letters of all kinds are found by their names in UTF-8, on every system. Names are made from
// UTF-16 here, so that the system, and not the code under test, decides what they are.
#include "io/file_path.h"

#if !defined(_WIN32)
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#endif

#include <atomic>
#include <chrono>
#include <fstream>
#include <thread>

#include "io/atomic_file.h"
#include "io/byte_source.h"
#include "io/io_fixture.h"
#include "io/radii.h"
#include "io/structure.h"
#include "io/trajectory.h"

namespace quickses::io {
namespace {

constexpr const char16_t *kFolder = u"Molek\u00fcle \u5206\u5b50";
constexpr const char16_t *kFile = u"\u00c5ngstr\u00f6m \U0001f9ec.pdb";
constexpr const char *kUtf8 = u8"Molek\u00fcle \u5206\u5b50/\u00c5ngstr\u00f6m \U0001f9ec.pdb";
constexpr const char *kAtom = "ATOM      1  N   ALA A   1       1.000   2.000   3.000  1.00  0.00           N\n";

class FilePathTest : public IoTest {
 protected:
  void SetUp() override {
    IoTest::SetUp();
    folder_ /= std::filesystem::path(kFolder);
    std::filesystem::create_directories(folder_);
    file_ = folder_ / std::filesystem::path(kFile);
    name_ = utf8_of(folder_.parent_path()) + "/" + kUtf8;
  }
  void write_atom() const { std::ofstream(file_, std::ios::binary) << "MODEL        1\n" << kAtom << "ENDMDL\n"; }

  std::filesystem::path file_;  // by UTF-16
  std::string name_;            // by UTF-8
};

TEST_F(FilePathTest, StringsArePathsAndBack) {
  EXPECT_EQ(path_of(kUtf8), std::filesystem::path(kFolder) / std::filesystem::path(kFile));
  EXPECT_EQ(utf8_of(std::filesystem::path(kFile)), std::string(kUtf8).substr(std::string(kUtf8).find('/') + 1));
}

TEST_F(FilePathTest, Extensions) {
  EXPECT_EQ(lower_extension(path_of("a.PDB.Gz")), ".gz");
  EXPECT_EQ(lower_extension_of_content(path_of("a.PDB.Gz")), ".pdb");
  EXPECT_EQ(lower_extension_of_content(path_of("a.pdb")), ".pdb");
  EXPECT_EQ(lower_extension(path_of("pdb")), "");
}

TEST_F(FilePathTest, StructuresAndTrajectoriesAreFound) {
  write_atom();
  EXPECT_EQ(read_structure(name_, ReadOptions()).models.at(0).atoms.size(), 1u);
  EXPECT_EQ(Trajectory::open(name_).atom_count(), 1u);
}

TEST_F(FilePathTest, RadiiAreFound) {
  std::ofstream(file_) << "N 1.23\n";
  EXPECT_FLOAT_EQ(find_radii(name_).by_element[7], 1.23f);
}

TEST_F(FilePathTest, FilesAreWrittenUnderTheirName) {
  AtomicFile file(name_);
  file.write(kAtom);
  EXPECT_FALSE(std::filesystem::exists(file_));
  file.commit();
  EXPECT_TRUE(std::filesystem::exists(file_));
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(FilePathTest, ErrorsNameTheFileAsItWasGiven) {
  const std::string message = error_of(ErrorKind::kInput, [&] { read_structure(name_, ReadOptions()); });
  EXPECT_EQ(message, "'" + name_ + "': no such file");
}

// As by version control, or by another program that writes it anew.
TEST_F(FilePathTest, OpenTrajectoriesMayBeReplacedAndRemoved) {
  write_atom();
  const Trajectory open = Trajectory::open(name_);
  AtomicFile other(name_);
  other.write("other");
  other.commit();
  std::vector<float> xyz(3 * open.atom_count());
  open.read_frame(0, xyz.data());
  EXPECT_EQ(xyz, (std::vector<float>{1, 2, 3}));
  EXPECT_TRUE(std::filesystem::remove(file_));
  open.read_frame(0, xyz.data());
  EXPECT_EQ(xyz, (std::vector<float>{1, 2, 3}));
}

#if defined(_WIN32)
TEST_F(FilePathTest, WhatIsNotUtf8IsRefused) {
  EXPECT_EQ(error_of(ErrorKind::kInput, [] { read_structure("\xff.pdb", ReadOptions()); }),
            "'\xff.pdb' is no path: it is not UTF-8");
}
#endif

#if !defined(_WIN32)
// Whoever waits for a pipe goes on waiting after a signal.
TEST_F(FilePathTest, PipesAreReadThroughSignals) {
  const std::string pipe = utf8_of(folder_) + "/pipe.pdb";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  using Action = struct sigaction;
  Action interrupts = {}, before = {};
  interrupts.sa_handler = [](int) {};  // without SA_RESTART
  ASSERT_EQ(sigaction(SIGUSR1, &interrupts, &before), 0);
  const auto handles_broken_pipe = signal(SIGPIPE, SIG_IGN);  // of a reader that gave up
  std::atomic<bool> ends{false};
  std::thread signals([&, reader = pthread_self()] {
    for (; !ends; std::this_thread::sleep_for(std::chrono::milliseconds(1))) pthread_kill(reader, SIGUSR1);
  });
  std::thread writer([&] {
    const auto rest = [] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); };
    rest();  // the reader waits for this end
    std::ofstream out(pipe, std::ios::binary);
    for (int k = 0; k < 5; ++k, rest()) out << kAtom << std::flush;
  });
  size_t atoms = 0;
  EXPECT_NO_THROW(atoms = read_structure(pipe, ReadOptions()).models.at(0).atoms.size());
  ends = true;
  signals.join();
  writer.join();
  signal(SIGPIPE, handles_broken_pipe);
  sigaction(SIGUSR1, &before, nullptr);
  EXPECT_EQ(atoms, 5u);
}
#endif

}  // namespace
}  // namespace quickses::io
