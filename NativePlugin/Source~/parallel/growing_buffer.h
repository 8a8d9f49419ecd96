// SPDX-License-Identifier: MIT
// Memory that only grows, without initialisation: what is in it is lost when it does.
#pragma once

#include "parallel/arena.h"

namespace quickses {

// Source as of Arena. Not for use by several threads.
template <class Source>
class GrowingBuffer {
 public:
  GrowingBuffer() = default;
  GrowingBuffer(const GrowingBuffer &) = delete;
  GrowingBuffer &operator=(const GrowingBuffer &) = delete;
  ~GrowingBuffer() { release(); }

  // What is taken for so many bytes: a little more, so that a trajectory soon stops growing.
  static size_t size_for(size_t bytes) { return bytes + bytes / 8 + 4096; }

  // At least this many bytes. Throws MemoryRefused; the buffer is empty then. Nothing may be in flight from or to the
  // old memory.
  void *reserve(size_t bytes) {
    if (!try_reserve(bytes))
      throw MemoryRefused(std::string(Source::kName) + " refused " + describe_bytes(bytes) + " of memory for the mesh");
    return memory_;
  }
  // False where it is refused.
  bool try_reserve(size_t bytes) {
    if (bytes <= size_) return true;
    release();
    size_t size = size_for(bytes);
    memory_ = Source::acquire(size);  // which may throw: a size without memory must not stay behind
    if (!memory_) memory_ = Source::acquire(size = bytes);
    if (memory_) size_ = size;
    return memory_ != nullptr;
  }
  void release() {
    if (memory_) Source::release(memory_);
    memory_ = nullptr;
    size_ = 0;
  }
  void *data() const { return memory_; }
  size_t size() const { return size_; }

 private:
  void *memory_ = nullptr;
  size_t size_ = 0;
};

}  // namespace quickses
