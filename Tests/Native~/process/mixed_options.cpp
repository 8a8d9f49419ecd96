// SPDX-License-Identifier: MIT
// A part of mixed_options_test.cpp, compiled with other options.
#include <cstdint>
#include <random>
#include <vector>

std::vector<uint32_t> numbers_of_other_file(size_t count, uint32_t seed) {
  std::vector<uint32_t> numbers(count);
  std::mt19937 random(seed);
  for (uint32_t &number : numbers) number = static_cast<uint32_t>(random());
  return numbers;
}
