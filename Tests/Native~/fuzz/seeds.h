// SPDX-License-Identifier: MIT
// What fuzzing begins with: files, texts and atoms, each with the choices of its target behind it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace fuzz {

struct Target {
  const char *name;
  void (*run)(const uint8_t *data, size_t size);
  std::vector<std::string> seeds;
};
std::vector<Target> targets();

}  // namespace fuzz
