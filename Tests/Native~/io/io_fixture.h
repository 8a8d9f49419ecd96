// SPDX-License-Identifier: MIT
// What the tests of readers and writers share: a folder of their own, and errors caught.
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "io/error.h"
#include "io/own_folder.h"

namespace quickses::io {

class IoTest : public ::testing::Test {
 protected:
  std::string path(const std::string &name) const { return (folder_ / name).string(); }

  std::string write(const std::string &name, const std::string &content) const {
    std::ofstream(path(name), std::ios::binary) << content;
    return path(name);
  }

  std::string write_gz(const std::string &name, const std::string &content, bool append = false) const {
    gzFile file = gzopen(path(name).c_str(), append ? "ab" : "wb");
    gzwrite(file, content.data(), static_cast<unsigned>(content.size()));
    gzclose(file);
    return path(name);
  }

  size_t file_count() const {
    return std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator());
  }

  const OwnFolder own_;
  std::filesystem::path folder_ = own_.path();
};

inline std::string slurp(const std::string &path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Runs something that must throw an Error of this kind; gives its message.
inline std::string error_of(ErrorKind kind, const std::function<void()> &action) {
  try {
    action();
  } catch (const Error &error) {
    EXPECT_EQ(static_cast<int>(error.kind()), static_cast<int>(kind)) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

inline ::testing::AssertionResult contains(const char *, const char *, const std::string &text,
                                           const std::string &part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "\"" << text << "\" does not contain \"" << part << '"';
}
#define EXPECT_HAS(text, part) EXPECT_PRED_FORMAT2(contains, text, part)

}  // namespace quickses::io
