// SPDX-License-Identifier: MIT
// Files that are compiled with different options may share the inline functions of the standard library, as do the
// kernels of each instruction set and all other files. (By GCC for Windows, without the option that CMakeLists.txt
// gives it, a caller's registers are overwritten.)
#include <gtest/gtest.h>

#include <random>
#include <vector>

std::vector<uint32_t> numbers_of_other_file(size_t count, uint32_t seed);

namespace {

TEST(MixedOptions, InlineFunctionsMayBeThoseOfAnotherFile) {
  const std::vector<uint32_t> numbers = numbers_of_other_file(2000, 7);
  ASSERT_EQ(numbers.size(), 2000u);
  std::mt19937 random(7);
  for (const uint32_t number : numbers) ASSERT_EQ(number, random());
}

}  // namespace
