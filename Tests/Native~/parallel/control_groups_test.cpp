// SPDX-License-Identifier: MIT
// Limits of memory by control groups, as files say them.
#include "parallel/control_groups.h"

#include "io/own_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace {

namespace fs = std::filesystem;
using quickses::ControlGroupMemory;

constexpr uint64_t kNone = ~uint64_t(0);

class ControlGroups : public testing::Test {
 protected:
  void write(const std::string &path, const std::string &text) const {
    const fs::path place = folder_.path() / path;
    fs::create_directories(place.parent_path());
    std::ofstream(place) << text;
  }
  ControlGroupMemory read(const std::string &membership) const {
    write("membership", membership);
    return quickses::read_control_groups((folder_.path() / "membership").c_str(), (folder_.path() / "fs").c_str());
  }

 private:
  OwnFolder folder_;
};

TEST_F(ControlGroups, NoneLimitsNothing) {
  for (const char *membership : {"", "0::/\n", "0::/some/group\n", "4:memory:/\n", "no groups", "::", "0::"}) {
    const ControlGroupMemory memory = read(membership);
    EXPECT_EQ(memory.limit, kNone) << membership;
    EXPECT_EQ(memory.free, kNone) << membership;
  }
  EXPECT_EQ(quickses::read_control_groups("/no/such/file", "/no/such/folder").limit, kNone);
}

// The narrowest of a group and those around it; what caches hold can be given back.
TEST_F(ControlGroups, OfVersion2) {
  write("fs/job/memory.max", "4000\n");
  write("fs/job/memory.current", "1500\n");
  write("fs/job/memory.stat", "anon 1000\ninactive_file 300\nactive_file 200\n");
  write("fs/job/step/memory.max", "max\n");
  write("fs/job/step/memory.current", "900\n");
  const ControlGroupMemory memory = read("0::/job/step\n");
  EXPECT_EQ(memory.limit, 4000u);
  EXPECT_EQ(memory.free, 2800u);
  write("fs/job/step/memory.max", "1000\n");
  EXPECT_EQ(read("0::/job/step\n").limit, 1000u);
  EXPECT_EQ(read("0::/job/step\n").free, 100u);
  write("fs/job/step/memory.current", "1100\n");
  EXPECT_EQ(read("0::/job/step").free, 0u);
}

TEST_F(ControlGroups, OfVersion1) {
  write("fs/memory/slurm/memory.limit_in_bytes", "5000\n");
  write("fs/memory/slurm/memory.usage_in_bytes", "2000\n");
  write("fs/memory/slurm/memory.stat", "cache 1\ninactive_file 7\ntotal_inactive_file 500\n");
  write("fs/memory/memory.limit_in_bytes", "9223372036854771712\n");
  write("fs/memory/memory.usage_in_bytes", "8000\n");
  const ControlGroupMemory memory = read("9:name=systemd:/\n7:cpu,memory:/slurm/job\n3:memory_of_others:/\n");
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

}  // namespace
