// SPDX-License-Identifier: MIT
// Fuzzing: each target takes any bytes, and ends the process where something is not as it must be. libFuzzer looks for
// such bytes (libfuzzer.cpp); fuzz_targets_test.cpp tries some with every build.
#pragma once

#include "quickses/quickses.h"

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace fuzz {

// Any bytes as a file of a structure, read with any options; as a trajectory; any text as a selection of the atoms of a
// small structure; any few atoms, with any settings.
void try_structure(const uint8_t *data, size_t size);
void try_trajectory(const uint8_t *data, size_t size);
void try_selection(const uint8_t *data, size_t size);
void try_surface(const uint8_t *data, size_t size);

// Of what a few gzipped bytes may become.
constexpr uint64_t kInputLimit = 16u << 20;

void require(bool holds, const char *what);
// Whether a call succeeded; if it failed, then with one of these, and with a message.
bool succeeds(qses_status status, std::initializer_list<qses_status> may_fail);
bool is_position(float x);

// Choices are bytes from the end on, so that what is before them may be a file. Where no byte is left, it is 0.
class Choices {
 public:
  Choices(const uint8_t *data, size_t size) : data_(data), size_(size) {}
  size_t left() const { return size_; }
  // What no choice was made of; in memory of its own, so that to read beyond it is seen.
  std::vector<uint8_t> rest() const { return {data_, data_ + size_}; }

  uint8_t byte() { return size_ > 0 ? data_[--size_] : 0; }
  int below(int count) { return byte() % count; }
  bool yes() { return (byte() & 1) != 0; }
  template <class T>
  T among(std::initializer_list<T> all) {
    return all.begin()[below(static_cast<int>(all.size()))];
  }
  float between(float low, float high) {
    const int high_byte = byte();
    return low + (high - low) * (static_cast<float>(256 * high_byte + byte()) / 65535.f);
  }

 private:
  const uint8_t *data_;
  size_t size_;
};

}  // namespace fuzz
