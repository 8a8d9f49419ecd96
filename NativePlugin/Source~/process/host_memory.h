// SPDX-License-Identifier: MIT
// Memory of the machine, as the arena takes it (arena.h), and as Thrust is given some of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

#if defined(_WIN32)
#include <malloc.h>
#endif

namespace quickses {

// Bytes of the machine, or of what a container or a batch system leaves to the program; 0: not known. free: what could
// still be given, file caches given back.
struct HostMemoryStatus {
  uint64_t total, free;
};
HostMemoryStatus describe_host_memory();

// Source for Arena.
struct HostMemory {
  static constexpr const char *kName = "the machine";
  static constexpr bool kTakenUntouched = false;  // pages of large blocks come when they are written to
  static void *acquire(size_t bytes) {
#if defined(_WIN32)
    return _aligned_malloc(bytes, 256);
#else
    return std::aligned_alloc(256, (bytes + 255) / 256 * 256);
#endif
  }
  static uint64_t free_bytes() { return describe_host_memory().free; }
  static void release(void *p) {
#if defined(_WIN32)
    _aligned_free(p);
#else
    std::free(p);
#endif
  }
};

// Hands out memory that the caller has set aside, to Thrust, which takes a few pieces and gives them back. Where that
// is not enough, the heap's.
class RoomAllocator {
 public:
  using value_type = char;
  static constexpr size_t kAlignment = 64;
  // Of a room, for one piece.
  static size_t room_for(size_t bytes) { return bytes / kAlignment * kAlignment + 2 * kAlignment; }

  RoomAllocator(char *room, size_t bytes) : room_(room), end_(room + bytes), next_(room) {}
  char *allocate(size_t bytes) {
    bytes = (bytes + kAlignment - 1) / kAlignment * kAlignment;
    if (static_cast<size_t>(end_ - next_) < bytes) return static_cast<char *>(::operator new(bytes));
    char *const piece = next_;
    next_ += bytes;
    return piece;
  }
  void deallocate(char *piece, size_t) {
    if (piece < room_ || piece >= end_) ::operator delete(piece);
  }

 private:
  char *room_, *end_, *next_;
};

}  // namespace quickses
