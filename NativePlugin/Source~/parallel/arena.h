// SPDX-License-Identifier: MIT
// Work memory of one context: a bump allocator over a few large blocks that are kept from surface to surface. After a
// reset the blocks are merged into one, so a trajectory soon runs without any allocation. The budget is enforced here.
#pragma once

#include "parallel/error.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace quickses {

inline std::string describe_bytes(uint64_t bytes) {
  char text[32];
  const double value = static_cast<double>(bytes);
  if (value >= 1024.0 * 1024.0 * 1024.0)
    std::snprintf(text, sizeof text, "%.2f GiB", value / (1024.0 * 1024.0 * 1024.0));
  else if (value >= 1024.0 * 1024.0)
    std::snprintf(text, sizeof text, "%.1f MiB", value / (1024.0 * 1024.0));
  else
    std::snprintf(text, sizeof text, "%.1f KiB", value / 1024.0);
  return text;
}

// Source: two static functions, void *acquire(size_t) (nullptr when refused) and void release(void *).
template <class Source>
class Arena {
 public:
  static constexpr size_t kAlignment = 256;

  Arena() = default;
  Arena(const Arena &) = delete;
  Arena &operator=(const Arena &) = delete;
  ~Arena() { release(); }

  // Bytes that may be held in all; 0 means no bound but the machine's.
  void set_budget(uint64_t bytes) { budget_ = bytes; }
  uint64_t budget() const { return budget_; }

  void *allocate(size_t bytes) {
    bytes = (bytes + kAlignment - 1) / kAlignment * kAlignment;
    if (bytes == 0) bytes = kAlignment;
    while (current_ < blocks_.size() && blocks_[current_].size - offset_ < bytes) {
      ++current_;
      offset_ = 0;
    }
    if (current_ == blocks_.size()) add_block(bytes);
    void *p = static_cast<char *>(blocks_[current_].memory) + offset_;
    offset_ += bytes;
    used_ += bytes;
    if (used_ > peak_) peak_ = used_;
    return p;
  }

  // Everything allocated so far is given up; the blocks stay.
  void reset() {
    if (blocks_.size() > 1) {
      uint64_t merged = peak_ + peak_ / 16;
      if (budget_ && merged > budget_) merged = peak_;
      release();
      try {
        add_block(static_cast<size_t>(merged));
      } catch (const Error &) {  // not in one piece: it comes in pieces again
      }
    }
    current_ = 0;
    offset_ = 0;
    used_ = 0;
    peak_ = 0;
  }

  // What is allocated after a mark is given up by rewinding to it.
  struct Mark {
    size_t block, offset;
    uint64_t used;
  };
  Mark mark() const { return {current_, offset_, used_}; }
  void rewind(const Mark &m) {
    current_ = m.block;
    offset_ = m.offset;
    used_ = m.used;
  }

  uint64_t peak() const { return peak_; }  // most bytes in use since the last reset
  uint64_t held() const { return held_; }  // bytes of all blocks

  void release() {
    for (const Block &b : blocks_) Source::release(b.memory);
    blocks_.clear();
    held_ = 0;
    current_ = 0;
    offset_ = 0;
  }

 private:
  struct Block {
    void *memory;
    size_t size;
  };

  void add_block(size_t bytes) {
    constexpr size_t kSmallestBlock = size_t(1) << 20;
    size_t wanted = bytes > kSmallestBlock ? bytes : kSmallestBlock;
    // Grow by half of what is held: few blocks, little waste.
    if (wanted < held_ / 2) wanted = static_cast<size_t>(held_ / 2);
    if (budget_ && held_ + wanted > budget_) wanted = bytes;
    if (budget_ && held_ + wanted > budget_)
      throw Error(QSES_OUT_OF_MEMORY, "the work needs at least " + describe_bytes(held_ + wanted) +
                                          " but the memory budget is " + describe_bytes(budget_) +
                                          ": use a larger spacing or a larger budget");
    void *memory = Source::acquire(wanted);
    if (!memory && wanted > bytes) {
      wanted = bytes;
      memory = Source::acquire(wanted);
    }
    if (!memory)
      throw Error(QSES_OUT_OF_MEMORY, std::string(Source::kName) + " refused " + describe_bytes(wanted) +
                                          " on top of " + describe_bytes(held_) + ": use a larger spacing");
    blocks_.push_back({memory, wanted});
    held_ += wanted;
  }

  std::vector<Block> blocks_;
  size_t current_ = 0, offset_ = 0;
  uint64_t used_ = 0, peak_ = 0, held_ = 0, budget_ = 0;
};

}  // namespace quickses
