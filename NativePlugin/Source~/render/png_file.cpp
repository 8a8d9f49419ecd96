// SPDX-License-Identifier: MIT
// Pictures as PNG files, by stb_image_write. Its own packing is weak, so zlib does that, which is linked anyway.
#include <zlib.h>

#include <cstdlib>
#include <new>
#include <string>

#include "io/atomic_file.h"
#include "io/error.h"
#include "render/picture.h"

namespace {

constexpr int kLevel = 6;  // higher ones take several times as long, for some percent

// As stb_image_write wants it: memory of malloc, or null.
unsigned char *pack_by_zlib(unsigned char *data, int size, int *packed_size, int) {
  uLongf packed = compressBound(static_cast<uLong>(size));
  auto *memory = static_cast<unsigned char *>(std::malloc(packed));
  if (memory && compress2(memory, &packed, data, static_cast<uLong>(size), kLevel) != Z_OK) {
    std::free(memory);
    memory = nullptr;
  }
  *packed_size = static_cast<int>(packed);
  return memory;
}

}  // namespace

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#define STBIW_ZLIB_COMPRESS pack_by_zlib
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb/stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace quickses::render {

void write_png(const std::string &path, const Image &image) {
  bool is_opaque = true;
  for (size_t k = 3; k < image.rgba.size(); k += 4) is_opaque = is_opaque && image.rgba[k] == 255;
  std::vector<uint8_t> rgb;
  if (is_opaque) rgb.reserve(image.rgba.size() / 4 * 3);
  if (is_opaque)
    for (size_t k = 0; k < image.rgba.size(); ++k)
      if (k % 4 != 3) rgb.push_back(image.rgba[k]);
  io::AtomicFile file(path);
  const auto write = [](void *context, void *data, int size) {
    static_cast<std::string *>(context)->append(static_cast<const char *>(data), static_cast<size_t>(size));
  };
  std::string bytes;
  const int channels = is_opaque ? 3 : 4;
  if (!stbi_write_png_to_func(write, &bytes, image.width, image.height, channels,
                              is_opaque ? rgb.data() : image.rgba.data(), channels * image.width))
    throw std::bad_alloc();
  file.write(bytes);
  file.commit();
}

}  // namespace quickses::render
