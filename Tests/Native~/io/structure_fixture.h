// SPDX-License-Identifier: MIT
// What tests of the readers of structures share.
#pragma once

#include <string>
#include <vector>

#include "io/io_fixture.h"
#include "io/structure.h"

namespace quickses::io {

inline std::string input_error(const std::string &path, const ReadOptions &options = ReadOptions()) {
  const std::string message = error_of(ErrorKind::kInput, [&] { read_structure(path, options); });
  EXPECT_NE(message.find(path), std::string::npos) << message;
  return message;
}

inline std::vector<std::string> names_of(const Structure &structure) {
  std::vector<std::string> names;
  for (const AtomInfo &atom : structure.atoms) names.push_back(atom.name);
  return names;
}

inline std::vector<uint32_t> indices_of(const Structure &structure) {
  std::vector<uint32_t> indices;
  for (const AtomInfo &atom : structure.atoms) indices.push_back(atom.file_index);
  return indices;
}

inline Structure only_model(const std::string &path, const ReadOptions &options = ReadOptions()) {
  StructureFile file = read_structure(path, options);
  EXPECT_EQ(file.models.size(), 1u);
  return file.models.front();
}

using Names = std::vector<std::string>;
using Indices = std::vector<uint32_t>;

}  // namespace quickses::io
