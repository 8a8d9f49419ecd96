// SPDX-License-Identifier: MIT
// Bytes read from any place of a file or of a buffer in memory.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace quickses::io {

// Several threads may read at a time: files are read by position (pread), without a place that would be shared.
class ByteSource {
 public:
  // Plain files stay on disk; gzip files and what has no size (pipes) are taken into memory. Throws Error (kInput).
  static std::unique_ptr<ByteSource> open_file(const std::string &path);
  // name: for messages.
  static std::unique_ptr<ByteSource> in_memory(std::string bytes, const std::string &name);

  virtual ~ByteSource() = default;
  ByteSource(const ByteSource &) = delete;
  ByteSource &operator=(const ByteSource &) = delete;

  const std::string &name() const { return name_; }
  uint64_t size() const { return size_; }

  // Throws Error (kInput) if the range is not there, also when the file has shrunk since it was opened.
  virtual void read(uint64_t offset, void *to, size_t count) const = 0;

  // As read; the bytes where they lie, or a copy of them in scratch. Nothing is allocated for a range that isn't there.
  virtual const unsigned char *view(uint64_t offset, size_t count, std::vector<unsigned char> &scratch) const = 0;

  // All the bytes; the source is of no use afterwards. Throws Error (kInput) as read_file_bytes: more than the limit.
  virtual std::string take_all() = 0;

 protected:
  ByteSource(const std::string &name, uint64_t size) : name_(name), size_(size) {}
  void check_range(uint64_t offset, uint64_t count) const;

 private:
  std::string name_;
  uint64_t size_;
};

}  // namespace quickses::io
