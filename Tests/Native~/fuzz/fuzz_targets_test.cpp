// SPDX-License-Identifier: MIT
// The targets of fuzzing hold for what it begins with, and for that with some bytes changed.
#include "fuzz/seeds.h"

#include <gtest/gtest.h>

#include <random>

namespace {

void run(const fuzz::Target &target, const std::string &bytes) {
  target.run(reinterpret_cast<const uint8_t *>(bytes.data()), bytes.size());
}

std::string changed(std::string bytes, std::mt19937 *random) {
  for (uint32_t changes = 1 + (*random)() % 4; changes > 0 && !bytes.empty(); --changes) {
    const size_t at = (*random)() % bytes.size();
    switch ((*random)() % 4) {
      case 0:
        bytes[at] = static_cast<char>((*random)());
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ 1 << (*random)() % 8);
        break;
      case 2:
        bytes.erase(at, 1 + (*random)() % 9);
        break;
      default:
        bytes.insert(at, bytes.substr(at / 2, (*random)() % 9));
    }
  }
  return bytes;
}

class FuzzTargets : public testing::TestWithParam<int> {};

TEST_P(FuzzTargets, HoldForSeeds) {
  const fuzz::Target target = fuzz::targets()[static_cast<size_t>(GetParam())];
  run(target, "");
  for (const std::string &seed : target.seeds) run(target, seed);
}

TEST_P(FuzzTargets, HoldForChangedSeeds) {
  const fuzz::Target target = fuzz::targets()[static_cast<size_t>(GetParam())];
  const bool is_surface = std::string(target.name) == "surface";
  std::mt19937 random(1);
  for (int k = 0; k < (is_surface ? 300 : 10000); ++k)
    run(target, changed(target.seeds[random() % target.seeds.size()], &random));
}

INSTANTIATE_TEST_SUITE_P(All, FuzzTargets, testing::Range(0, 4), [](const testing::TestParamInfo<int> &info) {
  return std::string(fuzz::targets()[static_cast<size_t>(info.param)].name);
});

}  // namespace
