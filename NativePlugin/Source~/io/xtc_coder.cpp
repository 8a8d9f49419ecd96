// SPDX-License-Identifier: MIT
// The compressed coordinates of XTC files, after the description of the format by its author, Frans van Hoesel, in the
// manual of GROMACS. Positions are integers. A group is one position in full, followed by a run of up to ten small
// differences, each to the atom before; the first difference of a run is swapped with the full position, which pays
// for water, where oxygen comes first and lies in the middle. The size of small differences adapts between groups.
#include "io/xtc_coder.h"

#include <cmath>

namespace quickses::io {
namespace {

// Sizes of small differences: three numbers below kSizes[i] fit in i bits. Part of the format, oddities included.
constexpr uint32_t kSizes[] = {
    0,       0,       0,       0,       0,        0,        0,       0,       0,       8,       10,
    12,      16,      20,      25,      32,       40,       50,      64,      80,      101,     128,
    161,     203,     256,     322,     406,      512,      645,     812,     1024,    1290,    1625,
    2048,    2580,    3250,    4096,    5060,     6501,     8192,    10321,   13003,   16384,   20642,
    26007,   32768,   41285,   52015,   65536,    82570,    104031,  131072,  165140,  208063,  262144,
    330280,  416127,  524287,  660561,  832255,   1048576,  1321122, 1664510, 2097152, 2642245, 3329021,
    4194304, 5284491, 6658042, 8388607, 10568983, 13316085, 16777216};
constexpr int kFirstIndex = 9;
constexpr int kLastIndex = 72;
static_assert(sizeof kSizes / sizeof *kSizes == kLastIndex + 1);

constexpr uint32_t kMaxPackedSize = 0xffffff;  // ranges above are stored axis by axis

int bit_length(uint64_t value) {
  int bits = 0;
  for (; value != 0; value >>= 1) ++bits;
  return bits;
}

// Bits of size[0] * size[1] * size[2] (not of the largest number below it: so the format has it). Up to 72.
int bit_length_of_product(const uint64_t *size) {
  const uint64_t low = size[0] * size[1];  // below 2^48
  const uint64_t bottom = (low & kMaxPackedSize) * size[2];
  const uint64_t top = (low >> 24) * size[2] + (bottom >> 24);
  return top != 0 ? 24 + bit_length(top) : bit_length(bottom);
}

// Reads bits, the highest of each byte first. Past the end there are zeros, and failed() tells.
class BitReader {
 public:
  BitReader(const unsigned char *bytes, size_t size) : bytes_(bytes), size_(size) {}

  bool failed() const { return position_ > 8 * static_cast<uint64_t>(size_); }

  // 1 to 32 bits as a number.
  uint32_t take(int bits) {
    const uint64_t window = next_bits();
    position_ += bits;
    return static_cast<uint32_t>(window >> (64 - bits));
  }

  // Up to 56 bits as the format stores large numbers: byte by byte, the lowest first, the rest of the bits last.
  uint64_t take_bytes_reversed(int bits) {
    const uint64_t window = next_bits();
    position_ += bits;
    uint64_t value = 0;
    int done = 0;
    for (; done + 8 <= bits; done += 8) value |= (window >> (56 - done) & 0xff) << done;
    if (done < bits) value |= (window << done >> (64 - (bits - done))) << done;
    return value;
  }

 private:
  // The next 57 bits at least, from the top.
  uint64_t next_bits() const {
    const uint64_t first = position_ >> 3;
    uint64_t window = 0;
    if (first + 8 <= size_) {
      const unsigned char *p = bytes_ + first;  // one load: compilers know this form
      window = static_cast<uint64_t>(p[0]) << 56 | static_cast<uint64_t>(p[1]) << 48 |
               static_cast<uint64_t>(p[2]) << 40 | static_cast<uint64_t>(p[3]) << 32 |
               static_cast<uint64_t>(p[4]) << 24 | static_cast<uint64_t>(p[5]) << 16 |
               static_cast<uint64_t>(p[6]) << 8 | static_cast<uint64_t>(p[7]);
    } else {
      for (int i = 0; i < 8; ++i) window = window << 8 | (first + i < size_ ? bytes_[first + i] : 0);
    }
    return window << (position_ & 7);
  }

  const unsigned char *bytes_;
  uint64_t size_;
  uint64_t position_ = 0;  // in bits
};

// Three numbers that are stored as (n[0] * size1 + n[1]) * size2 + n[2]. Only n[0] can be out of range.
void take_triple(BitReader &reader, int bits, uint32_t size1, uint32_t size2, uint64_t *n) {
  if (bits <= 56) {
    uint64_t value = reader.take_bytes_reversed(bits);
    n[2] = value % size2;
    value /= size2;
    n[1] = value % size1;
    n[0] = value / size1;
    return;
  }
  unsigned char digits[9] = {};  // base 256, the lowest first
  int count = 0;
  for (; bits > 0; bits -= 8) digits[count++] = static_cast<unsigned char>(reader.take(bits < 8 ? bits : 8));
  const uint32_t sizes[3] = {0, size1, size2};
  for (int i = 2; i > 0; --i) {
    uint64_t rest = 0;
    for (int k = count - 1; k >= 0; --k) {
      rest = rest << 8 | digits[k];
      digits[k] = static_cast<unsigned char>(rest / sizes[i]);
      rest %= sizes[i];
    }
    n[i] = rest;
  }
  n[0] = 0;
  for (int k = 7; k >= 0; --k) n[0] = n[0] << 8 | digits[k];
}

class Unpacker {
 public:
  Unpacker(const XtcBlock &block, const unsigned char *bytes, size_t size)
      : block_(block), reader_(bytes, size), scale_(10 / block.precision), small_index_(block.small_index) {}

  const char *run(size_t atom_count, float *xyz) {
    if (const char *problem = check_header()) return problem;
    for (size_t done = 0; done < atom_count;) {
      int64_t full[3];
      if (!take_full(full)) return kOutside;
      const int change = take_run();
      if (reader_.failed()) return kTooShort;
      const size_t run_length = static_cast<size_t>(run_length_);
      if (run_length >= atom_count - done) return "it holds more atoms than it should";
      if (run_length != 0) {
        if (const char *problem = take_differences(full, xyz + 3 * done)) return problem;
      } else {
        write(full, xyz + 3 * done);
      }
      done += run_length + 1;
      small_index_ += change;
    }
    return nullptr;
  }

 private:
  static constexpr const char *kTooShort = "its coordinates end too early";
  static constexpr const char *kOutside = "a position is outside of the range that the frame names";

  const char *check_header() {
    if (!(std::isfinite(block_.precision) && block_.precision > 0)) return "its precision is no positive number";
    for (int i = 0; i < 3; ++i) {
      const int64_t size = static_cast<int64_t>(block_.max[i]) - block_.min[i] + 1;
      if (size < 1 || size > 0xffffffff) return "its range of coordinates makes no sense";
      size_[i] = static_cast<uint64_t>(size);
      if (size_[i] > kMaxPackedSize) is_packed_ = false;
    }
    if (is_packed_) packed_bits_ = bit_length_of_product(size_);
    return nullptr;
  }

  bool take_full(int64_t *position) {
    uint64_t n[3];
    if (is_packed_) {
      take_triple(reader_, packed_bits_, static_cast<uint32_t>(size_[1]), static_cast<uint32_t>(size_[2]), n);
    } else {
      for (int i = 0; i < 3; ++i) n[i] = reader_.take(bit_length(size_[i]));
    }
    for (int i = 0; i < 3; ++i) {
      if (n[i] >= size_[i]) return false;
      position[i] = block_.min[i] + static_cast<int64_t>(n[i]);
    }
    return true;
  }

  // How many differences follow; the same as last time unless a bit says otherwise. Gives the change of the size.
  int take_run() {
    if (reader_.take(1) == 0) return 0;
    const int code = static_cast<int>(reader_.take(5));
    run_length_ = code / 3;
    return code % 3 - 1;
  }

  const char *take_differences(int64_t *full, float *xyz) {
    if (small_index_ < kFirstIndex || small_index_ > kLastIndex) return "the size of its differences makes no sense";
    const uint32_t size = kSizes[small_index_];
    int64_t before[3] = {full[0], full[1], full[2]};
    for (int k = 0; k < run_length_; ++k) {
      uint64_t n[3];
      take_triple(reader_, static_cast<int>(small_index_), size, size, n);
      for (int i = 0; i < 3; ++i) {
        if (n[i] >= size) return kOutside;
        before[i] += static_cast<int64_t>(n[i]) - size / 2;
        if (before[i] < block_.min[i] || before[i] > block_.max[i]) return kOutside;
      }
      write(before, xyz + 3 * (k == 0 ? 0 : k + 1));
      if (k == 0) write(full, xyz + 3);
    }
    return reader_.failed() ? kTooShort : nullptr;
  }

  void write(const int64_t *position, float *xyz) const {
    for (int i = 0; i < 3; ++i) xyz[i] = static_cast<float>(static_cast<double>(position[i]) * scale_);
  }

  const XtcBlock &block_;
  BitReader reader_;
  double scale_;  // to Å
  uint64_t size_[3] = {};
  bool is_packed_ = true;
  int packed_bits_ = 0;
  int64_t small_index_;  // as the file says: only where there are differences must it be one
  int run_length_ = 0;
};

}  // namespace

const char *unpack_xtc(const XtcBlock &block, const unsigned char *bytes, size_t size, size_t atom_count, float *xyz) {
  return Unpacker(block, bytes, size).run(atom_count, xyz);
}

// A full position takes a bit at least, and one bit says that there is no new run; a difference takes more.
uint64_t min_xtc_bytes(uint64_t atom_count) { return (2 * atom_count + 7) / 8; }

}  // namespace quickses::io
