// SPDX-License-Identifier: MIT
// An RGBA image and its PNG file.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

namespace render {

struct Image {
  int width, height;
  std::vector<uint8_t> rgba;
};

namespace png {

inline void put_number(std::string &out, uint32_t v) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<char>(v >> shift & 255));
}

inline void put_chunk(std::string &out, const std::string &name, const std::string &data) {
  put_number(out, static_cast<uint32_t>(data.size()));
  const std::string body = name + data;
  out += body;
  put_number(out, static_cast<uint32_t>(
                      crc32(0, reinterpret_cast<const Bytef *>(body.data()), static_cast<uInt>(body.size()))));
}

// The row filtered in one of PNG's five ways.
inline std::vector<uint8_t> filter_row(const uint8_t *row, const uint8_t *above, size_t size, int kind) {
  std::vector<uint8_t> out(size);
  for (size_t i = 0; i < size; ++i) {
    const int a = i < 4 ? 0 : row[i - 4], b = above ? above[i] : 0, c = above && i >= 4 ? above[i - 4] : 0;
    const int p = a + b - c, pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
    const int guess[5] = {0, a, b, (a + b) / 2, pa <= pb && pa <= pc ? a : pb <= pc ? b : c};
    out[i] = static_cast<uint8_t>(row[i] - guess[kind]);
  }
  return out;
}

}  // namespace png

inline void write_png(const std::string &path, const Image &image) {
  const size_t row_size = 4 * static_cast<size_t>(image.width);
  std::string raw;
  for (int y = 0; y < image.height; ++y) {
    const uint8_t *row = image.rgba.data() + row_size * static_cast<size_t>(y), *above = y ? row - row_size : nullptr;
    std::vector<uint8_t> best;
    long best_sum = -1;
    int best_kind = 0;
    for (int kind = 0; kind < 5; ++kind) {  // the filter that leaves the smallest numbers
      std::vector<uint8_t> filtered = png::filter_row(row, above, row_size, kind);
      long sum = 0;
      for (uint8_t v : filtered) sum += v < 128 ? v : 256 - v;
      if (best_sum < 0 || sum < best_sum) best_sum = sum, best_kind = kind, best = std::move(filtered);
    }
    raw.push_back(static_cast<char>(best_kind));
    raw.append(best.begin(), best.end());
  }
  uLongf packed_size = compressBound(static_cast<uLong>(raw.size()));
  std::string packed(packed_size, '\0');
  if (compress2(reinterpret_cast<Bytef *>(packed.data()), &packed_size, reinterpret_cast<const Bytef *>(raw.data()),
                static_cast<uLong>(raw.size()), 9) != Z_OK)
    throw std::runtime_error("zlib can't compress the image");
  packed.resize(packed_size);
  std::string header;
  png::put_number(header, static_cast<uint32_t>(image.width));
  png::put_number(header, static_cast<uint32_t>(image.height));
  header += std::string("\x08\x06\x00\x00\x00", 5);  // 8 bits, RGBA
  std::string out("\x89PNG\r\n\x1a\n", 8);
  png::put_chunk(out, "IHDR", header);
  png::put_chunk(out, "sRGB", std::string(1, '\0'));
  png::put_chunk(out, "IDAT", packed);
  png::put_chunk(out, "IEND", "");
  std::FILE *file = std::fopen(path.c_str(), "wb");
  if (!file) throw std::runtime_error("can't write '" + path + "'");
  const bool written = std::fwrite(out.data(), 1, out.size(), file) == out.size();
  if (std::fclose(file) != 0 || !written) throw std::runtime_error("can't write '" + path + "'");
}

}  // namespace render
