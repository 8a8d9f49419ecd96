// SPDX-License-Identifier: MIT
// Work memory of one context: a bump allocator over a few large blocks that are kept from surface to surface. After a
// reset the blocks are merged into one, so a trajectory soon runs without any allocation. With a budget all of it is
// taken in one block, so that what is free can be used to the last byte.
#pragma once

#include "parallel/error.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace quickses {

inline std::string describe_bytes(uint64_t bytes) {
  if (bytes < 1024) return std::to_string(bytes) + (bytes == 1 ? " byte" : " bytes");
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

// What an allocation takes of an arena: whole units, and one at least.
constexpr uint64_t kArenaUnit = 256;
constexpr uint64_t arena_bytes(uint64_t bytes) {
  return bytes == 0 ? kArenaUnit : (bytes + kArenaUnit - 1) / kArenaUnit * kArenaUnit;
}

// Source: three static functions: void *acquire(size_t) (nullptr when refused), void release(void *), and uint64_t
// free_bytes(), what could be acquired now, or 0 if that is not known. And, where set_taken is called, kTakenUntouched:
// whether memory takes room before anything is written to it.
template <class Source>
class Arena {
 public:
  Arena() = default;
  Arena(const Arena &) = delete;
  Arena &operator=(const Arena &) = delete;
  ~Arena() { release(); }

  // Bytes that may be held in all; 0: no budget.
  void set_budget(uint64_t bytes) { budget_ = bytes / kArenaUnit * kArenaUnit; }
  // True if work should be cut into pieces that fit.
  bool has_budget() const { return budget_ > 0; }
  // Bytes beyond which everything is refused: the budget; or what is held and what is free besides, as it was when it
  // was first asked for since the last reset. What was held before it was given up may be had again, even if little is
  // free besides.
  uint64_t limit() {
    constexpr uint64_t kNoLimit = ~uint64_t(0) >> 1;
    if (budget_) return budget_;
    if (limit_ == 0) {
      const uint64_t free = Source::free_bytes();
      limit_ = free ? std::max(held_ + free, given_up_) : kNoLimit;
    }
    return limit_;
  }
  // Bytes of the budget that others have taken, or are about to; they count as used. Throws if what is held, as far as
  // it takes room, does not leave so much. What is held beyond that is given up by the next reset.
  void set_taken(uint64_t bytes) {
    if (!budget_) return;
    const bool more = bytes > taken_;
    taken_ = bytes;
    if (more && (Source::kTakenUntouched ? held_ : touched()) > own_budget())
      throw MemoryRefused("the work beside the arena needs " + describe_bytes(bytes) + " of the memory budget of " +
                              describe_bytes(budget_),
                          bytes < budget_);
  }
  // Of the limit, what others have not taken.
  uint64_t share() { return limit() - std::min(limit(), taken_); }
  // Bytes that can still be allocated, as far as is known.
  uint64_t available() { return limit() - std::min(limit(), used_ + taken_); }

  void *allocate(size_t bytes) {
    bytes = arena_bytes(bytes);
    if (taken_ > 0 && bytes > available()) refuse(used_ + taken_ + bytes);
    size_t block = current_, offset = offset_;
    while (block < blocks_.size() && blocks_[block].size - offset < bytes) {
      ++block;
      offset = 0;
    }
    if (block == blocks_.size()) add_block(bytes);
    void *p = static_cast<char *>(blocks_[block].memory) + offset;
    current_ = block;
    offset_ = offset + bytes;
    blocks_[block].touched = std::max(blocks_[block].touched, offset_);
    used_ += bytes;
    if (used_ > peak_) peak_ = used_;
    return p;
  }

  // What a first computation will take is taken at once, if it is little of what there is: it would wait for block
  // after block, and the next one until they were given back.
  void expect(uint64_t bytes) {
    if (held_ == 0 && !budget_ && bytes <= limit() / 8) take_block(static_cast<size_t>(bytes));
  }

  // Everything allocated so far is given up; the blocks stay.
  void reset() {
    if (budget_ && held_ > own_budget()) release();
    if (blocks_.size() > 1) {
      const uint64_t merged = peak_ + peak_ / 8;  // the next surface may be a little larger
      release();
      take_block(static_cast<size_t>(merged));  // where it is refused it comes in pieces again
    }
    current_ = 0;
    offset_ = 0;
    used_ = 0;
    peak_ = 0;
    limit_ = 0;
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

  uint64_t used() const { return used_; }
  uint64_t peak() const { return peak_; }                   // most bytes in use since the last reset
  uint64_t held() const { return held_; }                   // bytes of all blocks
  uint64_t untouched() const { return held_ - touched(); }  // of these, what was never allocated

  void release() {
    for (const Block &b : blocks_) Source::release(b.memory);
    given_up_ = std::max(given_up_, held_);
    blocks_.clear();
    held_ = 0;
    current_ = 0;
    offset_ = 0;
    limit_ = 0;
  }

 private:
  struct Block {
    void *memory;
    size_t size, touched;  // touched: so many of its first bytes were ever allocated
  };

  uint64_t touched() const {
    uint64_t sum = 0;
    for (const Block &b : blocks_) sum += b.touched;
    return sum;
  }
  uint64_t own_budget() const { return budget_ - std::min(budget_, taken_); }

  [[noreturn]] void refuse(uint64_t needed) {
    const std::string needs = "the work needs at least " + describe_bytes(needed) + " of memory but ",
                      most = describe_bytes(limit());
    throw MemoryRefused(budget_ ? needs + "the budget is " + most + ": use a larger spacing or a larger budget"
                                : needs + Source::kName + " had " + most + " free: use a larger spacing");
  }

  void add_block(size_t bytes) {
    if (held_ + bytes > limit()) refuse(held_ + bytes);
    if (!take_block(bytes))
      throw MemoryRefused(std::string(Source::kName) + " refused " + describe_bytes(bytes) + " of memory on top of " +
                          describe_bytes(held_) + ": use a larger spacing");
  }

  // A block of at least so many bytes; false if there is none to be had.
  bool take_block(size_t bytes) {
    constexpr size_t kSmallestBlock = size_t(1) << 20;
    if (held_ + bytes > limit()) return false;
    size_t wanted = bytes > kSmallestBlock ? bytes : kSmallestBlock;
    // Grow by half of what is held: few blocks, little waste.
    if (wanted < held_ / 2) wanted = static_cast<size_t>(held_ / 2);
    if (budget_ && held_ == 0) wanted = std::max(bytes, static_cast<size_t>(own_budget()));
    wanted = static_cast<size_t>(std::min<uint64_t>(wanted, limit() - held_));
    blocks_.reserve(blocks_.size() + 1);  // what is taken below is noted without fail
    void *memory = Source::acquire(wanted);
    while (!memory && wanted > bytes) {
      wanted = std::max(bytes, wanted / 2);
      memory = Source::acquire(wanted);
    }
    if (!memory) return false;
    blocks_.push_back({memory, wanted, 0});
    held_ += wanted;
    given_up_ = 0;
    return true;
  }

  std::vector<Block> blocks_;
  size_t current_ = 0, offset_ = 0;
  uint64_t used_ = 0, peak_ = 0, held_ = 0, budget_ = 0, limit_ = 0, taken_ = 0;
  uint64_t given_up_ = 0;  // by the last releases, since something was taken
};

}  // namespace quickses
