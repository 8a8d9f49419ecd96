// SPDX-License-Identifier: MIT
// A folder for the files of one test, which no other test, program or build has as well. It goes with its content.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <system_error>

class OwnFolder {
 public:
  // The first number that nobody has: only one can make a folder. Where it is there, but gone by the time it is looked
  // at, that is told as an error.
  OwnFolder() {
    const std::filesystem::path all = testing::TempDir();
    std::error_code error;
    for (unsigned k = 1;
         !std::filesystem::create_directory(path_ = all / ("quickses_test_" + std::to_string(k)), error); ++k)
      if (error && error != std::errc::file_exists) throw std::filesystem::filesystem_error("no folder", path_, error);
  }
  ~OwnFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
    EXPECT_FALSE(error) << path_ << ": " << error.message();  // as where a file is still open, on some systems
  }
  OwnFolder(const OwnFolder &) = delete;
  OwnFolder &operator=(const OwnFolder &) = delete;

  const std::filesystem::path &path() const { return path_; }
  std::string path(const std::string &name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};
