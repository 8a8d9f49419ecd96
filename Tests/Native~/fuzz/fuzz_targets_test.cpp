// SPDX-License-Identifier: MIT
// The targets of fuzzing hold for what it begins with, and for that with some bytes changed.
#include "fuzz/seeds.h"
#include "io/changed_bytes.h"

#include <gtest/gtest.h>

#include <random>

namespace {

void run(const fuzz::Target &target, const std::string &bytes) {
  target.run(reinterpret_cast<const uint8_t *>(bytes.data()), bytes.size());
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
    run(target, changed_bytes(target.seeds[random() % target.seeds.size()], &random));
}

INSTANTIATE_TEST_SUITE_P(All, FuzzTargets, testing::Range(0, 4), [](const testing::TestParamInfo<int> &info) {
  return std::string(fuzz::targets()[static_cast<size_t>(info.param)].name);
});

}  // namespace
