// SPDX-License-Identifier: MIT
// Numbers of files that are big-endian whatever the machine: XDR (XTC, TRR) and netCDF.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "io/byte_source.h"

namespace quickses::io {

inline uint32_t big_endian_u32(const unsigned char *p) {
  return static_cast<uint32_t>(p[0]) << 24 | static_cast<uint32_t>(p[1]) << 16 | static_cast<uint32_t>(p[2]) << 8 |
         p[3];
}

inline uint64_t big_endian_u64(const unsigned char *p) {
  return static_cast<uint64_t>(big_endian_u32(p)) << 32 | big_endian_u32(p + 4);
}

inline int32_t big_endian_i32(const unsigned char *p) { return static_cast<int32_t>(big_endian_u32(p)); }

inline float big_endian_f32(const unsigned char *p) {
  const uint32_t bits = big_endian_u32(p);
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

inline double big_endian_f64(const unsigned char *p) {
  const uint64_t bits = big_endian_u64(p);
  double value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

// Of 4 or 8 bytes.
inline double big_endian_float(const unsigned char *p, size_t size) {
  return size == 8 ? big_endian_f64(p) : static_cast<double>(big_endian_f32(p));
}

// Numbers of 4 or 8 bytes each, multiplied by a factor. Throws as ByteSource::read.
inline void read_big_endian(const ByteSource &source, uint64_t at, size_t number_size, double factor, float *numbers,
                            size_t count) {
  constexpr size_t kChunk = 4096;
  unsigned char bytes[8 * kChunk];
  for (size_t begin = 0; begin < count; begin += kChunk) {
    const size_t chunk = std::min(kChunk, count - begin);
    source.read(at + begin * number_size, bytes, chunk * number_size);
    for (size_t i = 0; i < chunk; ++i)
      numbers[begin + i] = static_cast<float>(factor * big_endian_float(bytes + i * number_size, number_size));
  }
}

}  // namespace quickses::io
