// SPDX-License-Identifier: MIT
// Whole files in memory, gunzipped where they are compressed.
#include "io/file_bytes.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

#include "io/error.h"
#include "io/file_path.h"

namespace quickses::io {
namespace {

namespace fs = std::filesystem;

std::string read_raw_bytes(const std::string &path) {
  std::error_code error;
  const fs::path place = path_of(path);
  const fs::file_status status = fs::status(place, error);
  if (status.type() == fs::file_type::not_found) fail_input("'" + path + "': no such file");
  if (status.type() == fs::file_type::directory) fail_input("'" + path + "' is a directory, not a file");
  std::unique_ptr<std::FILE, int (*)(std::FILE *)> file(open_stdio(place, "rb"), &std::fclose);
  if (!file) fail_input("'" + path + "' can't be opened: " + std::strerror(errno));

  std::string bytes;
  const auto size = fs::file_size(place, error);
  constexpr size_t kPiece = size_t(1) << 16;
  if (!error) bytes.reserve(static_cast<size_t>(size) + kPiece);
  // Read to the end rather than trust the size: pipes and devices have none.
  for (size_t count = kPiece, read = 0; count > 0;) {
    bytes.resize(read + kPiece);
    count = std::fread(&bytes[read], 1, kPiece, file.get());
    bytes.resize(read += count);
  }
  if (std::ferror(file.get())) fail_input("'" + path + "' can't be read: " + std::strerror(errno));
  if (bytes.empty()) fail_input("'" + path + "' is empty");
  return bytes;
}

bool has_gzip_magic(const char *bytes, size_t size) { return size >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b'; }

// Inflates all members of a gzip file. Only the end status of zlib tells a whole member from one that was cut off.
std::string gunzip(const std::string &packed, const std::string &path) {
  z_stream stream = {};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) throw std::bad_alloc();
  std::unique_ptr<z_stream, int (*)(z_stream *)> guard(&stream, &inflateEnd);

  std::string text;
  text.reserve(packed.size() * 4);
  std::string buffer(1 << 18, '\0');
  size_t position = 0;  // zlib counts input in 32 bits: feed it in pieces
  for (;;) {
    if (stream.avail_in == 0 && position < packed.size()) {
      const size_t piece = std::min<size_t>(packed.size() - position, 1u << 30);
      stream.next_in = reinterpret_cast<Bytef *>(const_cast<char *>(packed.data() + position));
      stream.avail_in = static_cast<uInt>(piece);
      position += piece;
    }
    stream.next_out = reinterpret_cast<Bytef *>(&buffer[0]);
    stream.avail_out = static_cast<uInt>(buffer.size());
    const int status = inflate(&stream, Z_NO_FLUSH);
    text.append(buffer.data(), buffer.size() - stream.avail_out);
    if (status == Z_STREAM_END) {
      const char *rest = packed.data() + (position - stream.avail_in);
      const size_t rest_size = packed.size() - (position - stream.avail_in);
      if (std::all_of(rest, rest + rest_size, [](char c) { return c == '\0'; })) return text;  // padding of tapes
      if (!has_gzip_magic(rest, rest_size)) fail_input("'" + path + "' has something else after its gzip data");
      inflateReset(&stream);
    } else if (status == Z_MEM_ERROR) {
      throw std::bad_alloc();
    } else if (status != Z_OK && status != Z_BUF_ERROR) {
      fail_input("'" + path + "' has damaged gzip data" + (stream.msg ? std::string(": ") + stream.msg : ""));
    } else if (stream.avail_in == 0 && position == packed.size() && stream.avail_out != 0) {
      fail_input("'" + path + "' is cut off: its gzip data ends early");
    }
  }
}

}  // namespace

std::string unpack_gzip(std::string bytes, const std::string &name) {
  if (bytes.empty()) fail_input("'" + name + "' is empty");
  if (bytes.size() == 1 && bytes[0] == '\x1f') fail_input("'" + name + "' is cut off: its gzip data ends early");
  if (!has_gzip_magic(bytes.data(), bytes.size())) return bytes;
  std::string text = gunzip(bytes, name);
  if (text.empty()) fail_input("'" + name + "' is empty");
  return text;
}

std::string read_file_bytes(const std::string &path) {
  std::string bytes = read_raw_bytes(path);
  if (lower_extension(path_of(path)) == ".gz" && bytes.size() >= 2 && !has_gzip_magic(bytes.data(), bytes.size()))
    fail_input("'" + path + "' is named .gz but is no gzip file");
  return unpack_gzip(std::move(bytes), path);
}

}  // namespace quickses::io
