// SPDX-License-Identifier: MIT
// Limits of memory and of time on processors by control groups, as files say them.
#include "process/control_groups.h"

#include "io/own_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace {

namespace fs = std::filesystem;
using quickses::GroupMemory;

constexpr uint64_t kNone = ~uint64_t(0);

class ControlGroups : public testing::Test {
 protected:
  void write(const std::string &path, const std::string &text) const {
    const fs::path place = folder_.path() / path;
    fs::create_directories(place.parent_path());
    std::ofstream(place) << text;
  }
  GroupMemory read(const std::string &membership) const {
    write("membership", membership);
    return quickses::read_group_memory((folder_.path() / "membership").c_str(), (folder_.path() / "fs").c_str());
  }
  double read_processors(const std::string &membership) const {
    write("membership", membership);
    return quickses::read_group_processors((folder_.path() / "membership").c_str(), (folder_.path() / "fs").c_str());
  }

 private:
  OwnFolder folder_;
};

TEST_F(ControlGroups, NoneLimitsNothing) {
  for (const char *membership : {"", "0::/\n", "0::/some/group\n", "4:memory:/\n", "no groups", "::", "0::"}) {
    const GroupMemory memory = read(membership);
    EXPECT_EQ(memory.limit, kNone) << membership;
    EXPECT_EQ(memory.free, kNone) << membership;
    EXPECT_EQ(read_processors(membership), 0) << membership;
  }
  EXPECT_EQ(quickses::read_group_memory("/no/such/file", "/no/such/folder").limit, kNone);
  EXPECT_EQ(quickses::read_group_processors("/no/such/file", "/no/such/folder"), 0);
}

// The narrowest of a group and those around it; what caches hold can be given back.
TEST_F(ControlGroups, OfVersion2) {
  write("fs/job/memory.max", "4000\n");
  write("fs/job/memory.current", "1500\n");
  write("fs/job/memory.stat", "anon 1000\ninactive_file 300\nactive_file 200\n");
  write("fs/job/step/memory.max", "max\n");
  write("fs/job/step/memory.current", "900\n");
  const GroupMemory memory = read("0::/job/step\n");
  EXPECT_EQ(memory.limit, 4000u);
  EXPECT_EQ(memory.free, 2800u);
  write("fs/job/step/memory.max", "1000\n");
  EXPECT_EQ(read("0::/job/step\n").limit, 1000u);
  EXPECT_EQ(read("0::/job/step\n").free, 100u);
  write("fs/job/step/memory.current", "1100\n");
  EXPECT_EQ(read("0::/job/step").free, 0u);
}

// Pages may be counted at two moments.
TEST_F(ControlGroups, CachesMayBeMoreThanAllThatIsUsed) {
  write("fs/memory.max", "4000\n");
  write("fs/memory.current", "100\n");
  write("fs/memory.stat", "anon 1\ninactive_file 300\n");
  EXPECT_EQ(read("0::/\n").free, 4000u);
}

// They are left out, and so is nothing else.
TEST_F(ControlGroups, LinesAsLongAsNobodyWritesThem) {
  write("fs/memory/memory.limit_in_bytes", "5000\n");
  write("fs/memory/memory.usage_in_bytes", "2000\n");
  std::string path, kinds = "cpu";
  for (int k = 0; k < 300; ++k) path += "/folder", kinds += ",cpu";
  EXPECT_EQ(read("4:memory:" + path + "\n").limit, kNone);
  EXPECT_EQ(read("0::" + path + "\n").limit, kNone);
  EXPECT_EQ(read("5:" + kinds + ",memory:/\n").limit, kNone);
  EXPECT_EQ(read("0::" + path + "\n4:memory:/\n").limit, 5000u);
  EXPECT_EQ(read("5:" + kinds + ":/\n4:memory:/\n").limit, 5000u);
}

TEST_F(ControlGroups, OfVersion1) {
  write("fs/memory/slurm/memory.limit_in_bytes", "5000\n");
  write("fs/memory/slurm/memory.usage_in_bytes", "2000\n");
  write("fs/memory/slurm/memory.stat", "cache 1\ninactive_file 7\ntotal_inactive_file 500\n");
  write("fs/memory/memory.limit_in_bytes", "9223372036854771712\n");
  write("fs/memory/memory.usage_in_bytes", "8000\n");
  const GroupMemory memory = read("9:name=systemd:/\n7:cpu,memory:/slurm/job\n3:memory_of_others:/\n");
  EXPECT_EQ(memory.limit, 5000u);
  EXPECT_EQ(memory.free, 3500u);
}

// The path of a container's group is often one that only the host has: its own group is where they are mounted.
TEST_F(ControlGroups, InAContainer) {
  write("fs/memory.max", "6000\n");
  write("fs/memory.current", "1000\n");
  for (const char *membership : {"0::/\n", "0::/system.slice/docker-0123.scope\n", "0::/../../other\n"})
    EXPECT_EQ(read(membership).free, 5000u) << membership;
}

TEST_F(ControlGroups, TimeOnProcessorsOfVersion2) {
  write("fs/job/cpu.max", "250000 100000\n");
  write("fs/job/step/cpu.max", "max 100000\n");
  EXPECT_EQ(read_processors("0::/job/step\n"), 2.5);
  write("fs/job/step/cpu.max", "20000 50000\n");
  EXPECT_EQ(read_processors("0::/job/step\n"), 0.4);
  EXPECT_EQ(read_processors("0::/job\n"), 2.5);
  for (const char *nonsense : {"", "\n", "max", "100000", "100000 0", "-1 100000", "0 100000", "x y"}) {
    write("fs/job/cpu.max", nonsense);
    EXPECT_EQ(read_processors("0::/job\n"), 0) << nonsense;
  }
}

TEST_F(ControlGroups, TimeOnProcessorsOfVersion1) {
  write("fs/cpu/slurm/cpu.cfs_quota_us", "400000\n");
  write("fs/cpu/slurm/cpu.cfs_period_us", "100000\n");
  write("fs/cpu/cpu.cfs_quota_us", "-1\n");
  write("fs/cpu/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(read_processors("7:cpu,cpuacct:/slurm\n4:memory:/\n"), 4);
  EXPECT_EQ(read_processors("7:cpuacct,cpu:/slurm/job\n"), 4);
  EXPECT_EQ(read_processors("7:cpuset,cpuacct:/slurm\n"), 0);
  EXPECT_EQ(read_processors("7:cpu,cpuacct:/\n"), 0);
}

}  // namespace
