// SPDX-License-Identifier: MIT
// Rows of numbers, as text and as bytes, into the buffer of a file: what the writers of meshes share.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "io/atomic_file.h"

namespace quickses::io {

// What to_chars needs at most for a float (-1.17549435e-38) or a 32-bit number, with room for a separator.
constexpr size_t kMaxNumber = 24;

inline char *put_text(char *out, float value) { return std::to_chars(out, out + kMaxNumber, value).ptr; }
inline char *put_text(char *out, uint32_t value) { return std::to_chars(out, out + kMaxNumber, value).ptr; }

// Little-endian bytes on any machine; compilers make one store of it.
inline char *put_binary(char *out, uint32_t value) {
  for (int i = 0; i < 4; ++i) *out++ = static_cast<char>(value >> (8 * i));
  return out;
}

inline char *put_binary(char *out, float value) {
  uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return put_binary(out, bits);
}

inline char *put_binary(char *out, const float *vector) {
  for (int axis = 0; axis < 3; ++axis) out = put_binary(out, vector[axis]);
  return out;
}

// Writes count 32-bit numbers, in blocks that compilers copy as a whole.
template <class Number>
void put_numbers(AtomicFile &file, const Number *numbers, size_t count) {
  constexpr size_t kMost = 4096;
  for (size_t done = 0; done < count;) {
    const size_t size = count - done < kMost ? count - done : kMost;
    char *const out = file.reserve(4 * size);
    for (size_t i = 0; i < size; ++i) put_binary(out + 4 * i, numbers[done + i]);
    file.advance(4 * size);
    done += size;
  }
}

// Writes count rows of at most most_bytes each: put(out, i) writes row i at out, and gives its end.
template <class Put>
void put_rows(AtomicFile &file, size_t count, size_t most_bytes, const Put &put) {
  for (size_t i = 0; i < count; ++i) {
    char *const begin = file.reserve(most_bytes);
    file.advance(put(begin, i) - begin);
  }
}

}  // namespace quickses::io
