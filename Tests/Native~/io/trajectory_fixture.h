// SPDX-License-Identifier: MIT
// Small trajectories that the tests write themselves, by code that shares nothing with the readers.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "io/changed_bytes.h"
#include "io/io_fixture.h"
#include "io/trajectory.h"

namespace quickses::io {

using Positions = std::vector<float>;  // Å, three per atom

// Coordinates within -limit and limit.
inline Positions random_positions(size_t atom_count, uint32_t seed, float limit = 50) {
  std::mt19937 random(seed);
  Positions positions(3 * atom_count);
  for (float &x : positions) x = limit * (static_cast<float>(random() % 200001) / 100000 - 1);
  return positions;
}

inline Positions frame_of(const Trajectory &trajectory, size_t frame) {
  Positions positions(3 * trajectory.atom_count(), -12345.0f);
  trajectory.read_frame(frame, positions.data());
  return positions;
}

template <typename T>
std::string raw_bytes(T value, bool big_endian) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(&bytes[0], &value, sizeof value);
  const uint16_t probe = 1;
  const bool host_is_big = *reinterpret_cast<const unsigned char *>(&probe) == 0;
  return host_is_big == big_endian ? bytes : std::string(bytes.rbegin(), bytes.rend());
}

// ---- DCD

struct DcdWriter {
  bool big_endian = false;
  int32_t version = 24;  // 0: X-PLOR
  bool announces_cell = false;
  bool has_fourth = false;
  std::vector<int32_t> free_atoms;  // 1-based; empty: all are free
  int32_t announced = 0;
  int32_t start = 0, interval = 0;
  double step = 0;
  std::string magic = "CORD";
  bool has_wide_markers = false;  // 64 bits

  template <typename T>
  std::string number(T value) const {
    return raw_bytes(value, big_endian);
  }

  std::string record(const std::string &content) const {
    const auto size = static_cast<int32_t>(content.size());
    const std::string marker = has_wide_markers ? number(int64_t{size}) : number(size);
    return marker + content + marker;
  }

  std::string header(int32_t atom_count) const {
    std::string content = magic;
    for (int32_t i = 0; i < 20; ++i) {
      int32_t value = 0;
      if (i == 0) value = announced;
      if (i == 1) value = start;
      if (i == 2) value = interval;
      if (i == 8 && !free_atoms.empty()) value = atom_count - static_cast<int32_t>(free_atoms.size());
      if (i == 10 && version != 0) value = announces_cell;
      if (i == 11 && version != 0) value = has_fourth;
      if (i == 19) value = version;
      if (i == 9 && version != 0) {
        content += number(static_cast<float>(step));
      } else if (i == 9) {
        content += number(step);  // takes the place of i = 10 too
        ++i;
      } else {
        content += number(value);
      }
    }
    std::string bytes =
        record(content) + record(number(int32_t{2}) + std::string(160, '*')) + record(number(atom_count));
    if (free_atoms.empty()) return bytes;
    std::string list;
    for (int32_t atom : free_atoms) list += number(atom);
    return bytes + record(list);
  }

  // cell: empty or 6 numbers. Of a frame after the first, only the free atoms are written.
  std::string frame(const Positions &positions, bool is_first, const std::vector<double> &cell = {}) const {
    std::string bytes;
    if (!cell.empty()) {
      std::string content;
      for (double x : cell) content += number(x);
      bytes += record(content);
    }
    for (size_t axis = 0; axis < (has_fourth ? 4u : 3u); ++axis) {
      std::string content;
      if (is_first || free_atoms.empty()) {
        for (size_t i = 0; i < positions.size() / 3; ++i)
          content += number(axis == 3 ? 99.0f : positions[3 * i + axis]);
      } else {
        for (int32_t atom : free_atoms) content += number(axis == 3 ? 99.0f : positions[3 * (atom - 1) + axis]);
      }
      bytes += record(content);
    }
    return bytes;
  }
};

// ---- XTC

// Size of small differences at an index: three numbers below it fit in so many bits, with three entries that the
// authors of the format got wrong.
inline int64_t xtc_size(int index) {
  if (index == 37) return 5060;
  if (index == 57) return 524287;
  if (index == 69) return 8388607;
  return static_cast<int64_t>(std::floor(std::cbrt(std::ldexp(1.0L, index)) + 1e-9L));
}

class XtcBits {
 public:
  void put(uint64_t value, int bits) {
    for (int i = bits - 1; i >= 0; --i) {
      if (count_ % 8 == 0) bytes_ += '\0';
      if (value >> i & 1) bytes_.back() = static_cast<char>(bytes_.back() | 1 << (7 - count_ % 8));
      ++count_;
    }
  }

  // (n[0] * size1 + n[1]) * size2 + n[2], the lowest byte first.
  void put_triple(const int64_t *n, int64_t size1, int64_t size2, int bits) {
    std::vector<unsigned> digits(16, 0);
    const int64_t factors[3] = {1, size1, size2};
    for (int i = 0; i < 3; ++i) {
      uint64_t carry = static_cast<uint64_t>(n[i]);
      for (unsigned &digit : digits) {
        carry += digit * static_cast<uint64_t>(factors[i]);
        digit = carry & 0xff;
        carry >>= 8;
      }
    }
    size_t k = 0;
    for (; bits > 8; bits -= 8) put(digits[k++], 8);
    put(digits[k], bits);
  }

  const std::string &bytes() const { return bytes_; }

 private:
  std::string bytes_;
  size_t count_ = 0;
};

// A full position and `run` small differences: run + 1 atoms. Then the size of differences changes by -1, 0 or 1.
struct XtcGroup {
  int run = 0;
  int change = 0;
};

struct XtcWriter {
  int32_t magic = 1995;
  float precision = 1000;
  float time = 0;
  std::vector<float> box = std::vector<float>(9, 0.0f);  // nm
  int small_index = 9;
  std::vector<XtcGroup> groups;  // empty: every atom in full

  template <typename T>
  static std::string number(T value) {
    return raw_bytes(value, true);
  }

  std::string head(int32_t atom_count, int32_t step = 0) const {
    std::string bytes = number(magic) + number(atom_count) + number(step) + number(time);
    for (float x : box) bytes += number(x);
    return bytes + number(atom_count);
  }

  std::string plain_frame(const std::vector<float> &nm) const {
    std::string bytes = head(static_cast<int32_t>(nm.size() / 3));
    for (float x : nm) bytes += number(x);
    return bytes;
  }

  // Positions in units of 1 / precision.
  std::string packed_frame(const std::vector<int32_t> &positions) const {
    int64_t low[3], size[3];
    for (int axis = 0; axis < 3; ++axis) {
      int64_t high = low[axis] = positions[axis];
      for (size_t i = axis; i < positions.size(); i += 3) {
        low[axis] = std::min<int64_t>(low[axis], positions[i]);
        high = std::max<int64_t>(high, positions[i]);
      }
      size[axis] = high - low[axis] + 1;
    }
    std::string bytes = head(static_cast<int32_t>(positions.size() / 3)) + number(precision);
    for (int64_t x : low) bytes += number(static_cast<int32_t>(x));
    for (int axis = 0; axis < 3; ++axis) bytes += number(static_cast<int32_t>(low[axis] + size[axis] - 1));
    bytes += number(static_cast<int32_t>(small_index));

    std::string data = pack(positions, low, size);
    bytes += magic == 2023 ? number(static_cast<int64_t>(data.size())) : number(static_cast<int32_t>(data.size()));
    data.resize((data.size() + 3) / 4 * 4, '\0');
    return bytes + data;
  }

 private:
  static int bits_for(long double number) {  // of the binary number
    int bits = 0;
    for (; number >= 1; number /= 2) ++bits;
    return bits;
  }

  void put_full(XtcBits &bits, const int32_t *position, const int64_t *low, const int64_t *size) const {
    int64_t n[3];
    for (int axis = 0; axis < 3; ++axis) n[axis] = position[axis] - low[axis];
    if (size[0] > 0xffffff || size[1] > 0xffffff || size[2] > 0xffffff) {
      for (int axis = 0; axis < 3; ++axis) bits.put(static_cast<uint64_t>(n[axis]), bits_for(size[axis]));
    } else {
      // Only the length of the product counts; rounding would change it just below a power of two, and only there.
      bits.put_triple(n, size[1], size[2], bits_for(static_cast<long double>(size[0]) * size[1] * size[2]));
    }
  }

  std::string pack(const std::vector<int32_t> &positions, const int64_t *low, const int64_t *size) const {
    XtcBits bits;
    int index = small_index, run_before = 0;
    size_t at = 0;
    for (size_t g = 0; at < positions.size() / 3; ++g) {
      const XtcGroup group = groups.empty() ? XtcGroup{} : groups.at(g);
      const int32_t *first = &positions[3 * at];
      put_full(bits, group.run == 0 ? first : first + 3, low, size);
      if (group.run != run_before || group.change != 0) {
        bits.put(1, 1);
        bits.put(static_cast<uint64_t>(3 * group.run + group.change + 1), 5);
      } else {
        bits.put(0, 1);
      }
      const int64_t small = group.run == 0 ? 0 : xtc_size(index);
      for (int k = 0; k < group.run; ++k) {
        // The first two atoms are swapped: full is the second; the first follows; the third is relative to the first.
        const int32_t *atom = first + 3 * (k == 0 ? 0 : k + 1);
        const int32_t *before = k == 0 ? first + 3 : k == 1 ? first : atom - 3;
        int64_t n[3];
        for (int axis = 0; axis < 3; ++axis) {
          n[axis] = int64_t{atom[axis]} - before[axis] + small / 2;
          EXPECT_TRUE(n[axis] >= 0 && n[axis] < small) << "the test asks for a difference that does not fit";
        }
        bits.put_triple(n, small, small, index);
      }
      at += static_cast<size_t>(group.run) + 1;
      run_before = group.run;
      index += group.change;
    }
    return bits.bytes();
  }
};

// ---- TRR

struct TrrWriter {
  bool is_double = false;
  double time = 0;
  std::vector<double> box;  // nm; empty: none
  bool has_pressure = false, has_velocities = false, has_forces = false;

  template <typename T>
  static std::string number(T value) {
    return raw_bytes(value, true);
  }
  std::string real(double x) const { return is_double ? number(x) : number(static_cast<float>(x)); }
  std::string reals(const std::vector<double> &values) const {
    std::string bytes;
    for (double x : values) bytes += real(x);
    return bytes;
  }

  // nm: empty for a frame without positions.
  std::string frame(int32_t atom_count, const std::vector<double> &nm) const {
    const std::string others = reals(std::vector<double>(3 * static_cast<size_t>(atom_count), 7.5)), none;
    const std::string pressure = has_pressure ? reals(std::vector<double>(9, 1.25)) : none;
    const std::string blocks[10] = {none,
                                    none,
                                    reals(box),
                                    pressure,
                                    pressure,
                                    none,
                                    none,
                                    reals(nm),
                                    has_velocities ? others : none,
                                    has_forces ? others : none};
    std::string bytes = number(int32_t{1993}) + number(int32_t{13}) + number(int32_t{12}) + "GMX_trn_file", body;
    for (const std::string &block : blocks) {
      bytes += number(static_cast<int32_t>(block.size()));
      body += block;
    }
    return bytes + number(atom_count) + number(int32_t{100}) + number(int32_t{0}) + real(time) + real(0.5) + body;
  }

  std::string frame(const Positions &angstrom) const {
    std::vector<double> nm;
    for (float x : angstrom) nm.push_back(static_cast<double>(x) / 10);
    return frame(static_cast<int32_t>(nm.size() / 3), nm);
  }
};

// ---- what holds for all formats

// Cuts a file at every byte; frame k ends at ends[k]. Whole frames must be given, with their positions, and a cut
// anywhere else must be reported. name: in messages.
inline void expect_whole_frames_of_cuts(const std::string &bytes, TrajectoryFormat format,
                                        const std::vector<size_t> &ends, const std::vector<Positions> &frames,
                                        size_t begin = 0) {
  for (size_t size = begin; size < bytes.size(); ++size) {
    SCOPED_TRACE("cut after " + std::to_string(size) + " bytes");
    size_t whole = 0;
    while (whole < ends.size() && ends[whole] <= size) ++whole;
    if (whole == 0) {
      const std::string message =
          error_of(ErrorKind::kInput, [&] { Trajectory::from_memory(bytes.substr(0, size), format, "cut.trj"); });
      EXPECT_HAS(message, "cut.trj");
      continue;
    }
    const Trajectory trajectory = Trajectory::from_memory(bytes.substr(0, size), format, "cut.trj");
    ASSERT_EQ(trajectory.frame_count(), whole);
    const bool is_cut = ends[whole - 1] != size;
    EXPECT_EQ(trajectory.incomplete(), is_cut);
    EXPECT_EQ(trajectory.warnings().size(), is_cut ? 1u : 0u);
    if (is_cut) {
      EXPECT_HAS(trajectory.warnings().at(0), "'cut.trj': frame " + std::to_string(whole) + " is cut off");
    }
    for (size_t k = 0; k < whole; ++k) EXPECT_EQ(frame_of(trajectory, k), frames[k]);
  }
}

// Changes bytes at random: every file must be refused by an Error or be read, then only with finite positions.
inline void expect_mutants_are_safe(const std::vector<std::string> &files, TrajectoryFormat format, int count,
                                    uint32_t seed = 1) {
  std::mt19937 random(seed);
  int read = 0;
  for (int n = 0; n < count; ++n) {
    try {
      const Trajectory trajectory =
          Trajectory::from_memory(changed_bytes(files[random() % files.size()], &random), format);
      ASSERT_GE(trajectory.frame_count(), 1u);
      ASSERT_GE(trajectory.atom_count(), 1u);
      Positions positions(3 * trajectory.atom_count());
      for (size_t k = 0; k < trajectory.frame_count(); ++k) {
        try {
          trajectory.box(k);
          trajectory.time(k);
          trajectory.read_frame(k, positions.data());
          for (float x : positions) ASSERT_TRUE(std::abs(x) <= 1e6f);
          ++read;
        } catch (const Error &error) {
          ASSERT_EQ(error.kind(), ErrorKind::kInput) << error.what();
        }
      }
    } catch (const Error &error) {
      ASSERT_EQ(error.kind(), ErrorKind::kInput) << error.what();
    }
  }
  EXPECT_GT(read, count / 20) << "hardly anything was read: the test is blind";
}

}  // namespace quickses::io
