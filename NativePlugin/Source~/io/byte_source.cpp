// SPDX-License-Identifier: MIT
// Bytes read from any place of a file or of a buffer in memory.
#include "io/byte_source.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "io/error.h"
#include "io/file_bytes.h"
#include "io/file_path.h"

#ifdef _WIN32
#include <io.h>
#include <windows.h>
#else
#include <unistd.h>
#endif

namespace quickses::io {
namespace {

namespace fs = std::filesystem;

// Reads at most count bytes at an offset; 0 at the end, negative on errors, with their sentence.
int64_t read_at(std::FILE *file, uint64_t offset, void *to, size_t count, std::string &error) {
  count = std::min<size_t>(count, 1u << 30);
#ifdef _WIN32
  OVERLAPPED place = {};
  place.Offset = static_cast<DWORD>(offset);
  place.OffsetHigh = static_cast<DWORD>(offset >> 32);
  DWORD got = 0;
  const HANDLE handle = reinterpret_cast<HANDLE>(_get_osfhandle(_fileno(file)));
  if (ReadFile(handle, to, static_cast<DWORD>(count), &got, &place)) return got;
  const DWORD code = GetLastError();
  if (code == ERROR_HANDLE_EOF) return 0;
  error = "error " + std::to_string(code);
  return -1;
#else
  for (;;) {
    const ssize_t got = ::pread(::fileno(file), to, count, static_cast<off_t>(offset));
    if (got >= 0) return got;
    if (errno == EINTR) continue;
    error = std::strerror(errno);
    return -1;
  }
#endif
}

class FileSource : public ByteSource {
 public:
  FileSource(const std::string &path, FilePointer file, uint64_t size)
      : ByteSource(path, size), file_(std::move(file)) {}

  void read(uint64_t offset, void *to, size_t count) const override {
    check_range(offset, count);
    for (char *place = static_cast<char *>(to); count != 0;) {
      std::string error;
      const int64_t got = read_at(file_.get(), offset, place, count, error);
      if (got < 0) fail_input("'" + name() + "' can't be read: " + error);
      if (got == 0) fail_input("'" + name() + "' has become shorter since it was opened");
      place += got;
      offset += static_cast<uint64_t>(got);
      count -= static_cast<size_t>(got);
    }
  }

  const unsigned char *view(uint64_t offset, size_t count, std::vector<unsigned char> &scratch) const override {
    check_range(offset, count);
    scratch.resize(count);
    read(offset, scratch.data(), count);
    return scratch.data();
  }

  std::string take_all() override {
    const uint64_t limit = input_limit();
    if (size() > limit) fail_too_large(name(), limit);
    std::string bytes(static_cast<size_t>(size()), '\0');
    read(0, &bytes[0], bytes.size());
    return bytes;
  }

 private:
  FilePointer file_;
};

class MemorySource : public ByteSource {
 public:
  MemorySource(std::string bytes, const std::string &name) : ByteSource(name, bytes.size()), bytes_(std::move(bytes)) {}

  void read(uint64_t offset, void *to, size_t count) const override {
    check_range(offset, count);
    std::memcpy(to, bytes_.data() + offset, count);
  }

  const unsigned char *view(uint64_t offset, size_t count, std::vector<unsigned char> &) const override {
    check_range(offset, count);
    return reinterpret_cast<const unsigned char *>(bytes_.data()) + offset;
  }

  std::string take_all() override { return std::move(bytes_); }

 private:
  std::string bytes_;
};

}  // namespace

void ByteSource::check_range(uint64_t offset, uint64_t count) const {
  if (offset > size_ || count > size_ - offset) fail_input("'" + name_ + "' is cut off");
}

std::unique_ptr<ByteSource> ByteSource::open_file(const std::string &path) {
  std::error_code error;
  const fs::path place = path_of(path);
  const bool is_named_gzip = lower_extension(place) == ".gz";
  if (!is_named_gzip && fs::status(place, error).type() == fs::file_type::regular) {
    const uint64_t size = fs::file_size(place, error);
    FilePointer file = open_input(path);
    if (!error && size >= 2) {
      auto source = std::make_unique<FileSource>(path, std::move(file), size);
      char magic[2];
      source->read(0, magic, 2);
      if (!has_gzip_magic({magic, 2})) return source;
    }
  }
  return in_memory(read_file_bytes(path), path);  // also says what is wrong with what is no file
}

std::unique_ptr<ByteSource> ByteSource::in_memory(std::string bytes, const std::string &name) {
  if (bytes.empty()) fail_input("'" + name + "' is empty");
  if (has_gzip_magic(bytes)) fail_input("'" + name + "' is gzip data: it has to be unpacked first");
  return std::make_unique<MemorySource>(std::move(bytes), name);
}

}  // namespace quickses::io
