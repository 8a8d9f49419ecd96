// SPDX-License-Identifier: MIT
// Whole files in memory, gunzipped where they are compressed.
#include "io/file_bytes.h"

#include <zlib.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>
#include <string_view>
#include <system_error>

#if defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#endif

#include "io/error.h"
#include "io/file_path.h"
#include "io/text.h"

namespace quickses::io {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMiB = 1 << 20;
constexpr uint64_t kDefaultLimit = 4096 * kMiB;
constexpr uint64_t kUnpackedToPacked = 100;       // deflate gets to 1032; files of atoms to 20 or so
constexpr uint64_t kAlwaysUnpacked = 256 * kMiB;  // what repeats itself packs better, but does little harm up to here

std::atomic<uint64_t> chosen_limit{0};  // 0: the default

uint64_t unpacking_limit(size_t packed_size) {
  const uint64_t chosen = chosen_limit;
  if (chosen != 0) return chosen;
  return std::min(kDefaultLimit, std::max(kAlwaysUnpacked, kUnpackedToPacked * packed_size));
}

// False, and nothing done, beyond the limit. Room for more doubles as long as that stays within it.
bool append_within(uint64_t limit, const char *data, size_t count, std::string &bytes) {
  if (count > limit - bytes.size()) return false;
  const size_t needed = bytes.size() + count;
  if (needed > bytes.capacity())
    bytes.reserve(std::max(needed, static_cast<size_t>(std::min<uint64_t>(2 * uint64_t{bytes.capacity()}, limit))));
  bytes.append(data, count);
  return true;
}

[[noreturn]] void fail_above_limit(const std::string &name, const char *verb, uint64_t limit) {
  char large[32];
  std::snprintf(large, sizeof large, "%.6g MiB", static_cast<double>(limit) / kMiB);
  fail_input("'" + name + "' " + verb + " more than " + (limit < kMiB ? counted(limit, "byte") : large) +
             ", the most that is taken into memory; --max-input (in the library qses_input_set_limit) allows more");
}

constexpr size_t kPiece = size_t(1) << 16;

// Reads to the end rather than trust the size: pipes and devices have none.
std::string read_to_end(std::FILE *file, size_t size, const std::string &name) {
  const uint64_t limit = input_limit();
  std::string bytes;
  bytes.reserve(size + kPiece);
  for (size_t read = 0;;) {
    bytes.resize(read + kPiece);
    errno = 0;
    const size_t count = std::fread(&bytes[read], 1, kPiece, file);
    const bool is_interrupted = std::ferror(file) && errno == EINTR;  // by a signal, while it waited for a pipe
    if (is_interrupted) std::clearerr(file);
    bytes.resize(read += count);
    if (read > limit) fail_too_large(name, limit);
    if (count == 0 && !is_interrupted) break;
  }
  if (std::ferror(file) && errno == EBADF) fail_input("'" + name + "' is closed: there is nothing to read from");
  if (std::ferror(file)) fail_input("'" + name + "' can't be read: " + std::strerror(errno));
  if (bytes.empty()) fail_input("'" + name + "' is empty");
  return bytes;
}

std::string read_raw_bytes(const std::string &path) {
  std::error_code error;
  const fs::path place = path_of(path);
  const fs::file_status status = fs::status(place, error);
  if (status.type() == fs::file_type::not_found) fail_input("'" + path + "': no such file");
  if (status.type() == fs::file_type::directory) fail_input("'" + path + "' is a directory, not a file");
  const FilePointer file = open_input(path);
  const uint64_t limit = input_limit();
  const auto size = fs::file_size(place, error);
  if (!error && size > limit) fail_too_large(path, limit);
  return read_to_end(file.get(), error ? 0 : static_cast<size_t>(size), path);
}

// Inflates all members of a gzip file. Only the end status of zlib tells a whole member from one that was cut off.
std::string gunzip(const std::string &packed, const std::string &path) {
  z_stream stream = {};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) throw std::bad_alloc();
  std::unique_ptr<z_stream, int (*)(z_stream *)> guard(&stream, &inflateEnd);

  const uint64_t limit = unpacking_limit(packed.size());
  std::string text;
  text.reserve(static_cast<size_t>(std::min<uint64_t>(limit, uint64_t{packed.size()} * 4)));
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
    if (!append_within(limit, buffer.data(), buffer.size() - stream.avail_out, text))
      fail_above_limit(path, "unpacks to", limit);
    if (status == Z_STREAM_END) {
      const char *rest = packed.data() + (position - stream.avail_in);
      const size_t rest_size = packed.size() - (position - stream.avail_in);
      if (std::all_of(rest, rest + rest_size, [](char c) { return c == '\0'; })) return text;  // padding of tapes
      if (!has_gzip_magic({rest, rest_size})) fail_input("'" + path + "' has something else after its gzip data");
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

void set_input_limit(uint64_t bytes) { chosen_limit = bytes; }

uint64_t input_limit() {
  const uint64_t chosen = chosen_limit;
  return chosen != 0 ? chosen : kDefaultLimit;
}

FilePointer open_input(const std::string &path) {
  FilePointer file(open_stdio(path_of(path), "rb"));
  if (file) return file;
  if (errno == ENOMEM) throw std::bad_alloc();
  fail_input("'" + path + "' can't be opened: " + std::strerror(errno));
}

void fail_too_large(const std::string &name, uint64_t limit) { fail_above_limit(name, "has", limit); }

std::string unpack_gzip(std::string bytes, const std::string &name) {
  if (bytes.empty()) fail_input("'" + name + "' is empty");
  if (bytes.size() == 1 && bytes[0] == '\x1f') fail_input("'" + name + "' is cut off: its gzip data ends early");
  if (!has_gzip_magic(bytes)) return bytes;
  std::string text = gunzip(bytes, name);
  if (text.empty()) fail_input("'" + name + "' is empty");
  if (has_gzip_magic(text)) fail_input("'" + name + "' is gzip data that was packed twice: it has to be unpacked once");
  return text;
}

const char kStandardInput[] = "standard input";

std::string read_standard_input() {
#if defined(_WIN32)
  _setmode(_fileno(stdin), _O_BINARY);
#endif
  return unpack_gzip(read_to_end(stdin, 0, kStandardInput), kStandardInput);
}

std::string read_file_bytes(const std::string &path) {
  std::string bytes = read_raw_bytes(path);
  if (lower_extension(path_of(path)) == ".gz" && bytes.size() >= 2 && !has_gzip_magic(bytes))
    fail_input("'" + path + "' is named .gz but is no gzip file");
  return unpack_gzip(std::move(bytes), path);
}

}  // namespace quickses::io
