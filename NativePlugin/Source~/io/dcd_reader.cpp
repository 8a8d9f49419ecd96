// SPDX-License-Identifier: MIT
// DCD: the trajectories of CHARMM, NAMD and X-PLOR, and of many programs after them. Records of Fortran: a length
// of 32 bits, of some compilers 64, before and behind each, in the byte order of the machine that wrote them. A header,
// titles, the number of atoms, the free atoms if others are fixed; then per frame: unit cell (if there is one), x, y,
// z, fourth dimension.
#include "io/dcd_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "io/big_endian.h"

namespace quickses::io {
namespace {

constexpr uint32_t kHeaderLength = 84;
constexpr uint32_t kCellLength = 48;
constexpr uint32_t kMaxAtoms = 0x7fffffff / 4;        // more would not fit in the length of a record of 32 bits
constexpr double kAkmaPicoseconds = 0.0488882129084;  // CHARMM's unit of time

uint32_t swap_bytes(uint32_t v) { return v >> 24 | (v >> 8 & 0xff00) | (v << 8 & 0xff0000) | v << 24; }

double dot(const std::array<double, 3> &u, const std::array<double, 3> &v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

bool is_positive_definite(const std::array<std::array<double, 3>, 3> &m) {  // symmetric
  const std::array<double, 3> cross = {m[1][1] * m[2][2] - m[1][2] * m[2][1], m[1][2] * m[2][0] - m[1][0] * m[2][2],
                                       m[1][0] * m[2][1] - m[1][1] * m[2][0]};
  return m[0][0] > 0 && m[0][0] * m[1][1] > m[0][1] * m[1][0] && dot(m[0], cross) > 0;
}

// The six numbers of a unit cell, which writers fill in three ways:
//   A, cos gamma, B, cos beta, cos alpha, C    NAMD, VMD and others; all cosines within -1 and 1
//   A, gamma, B, beta, alpha, C                in degrees, old CHARMM and others
//   a11, a21, a22, a31, a32, a33               CHARMM since version 22: the symmetric matrix of the cell, lower half
// Nothing tells the last from the others for certain. CHARMM itself gives its version in the header, all others say 24:
// of a later one, small numbers off the diagonal are of a cell that is tilted a little, not cosines.
std::optional<Box> box_of_cell(const double *cell, int32_t version) {
  if (!std::all_of(cell, cell + 6, [](double x) { return std::isfinite(x); })) return std::nullopt;
  const double angles[3] = {cell[4], cell[3], cell[1]};  // alpha, beta, gamma
  const auto all = [&](auto &&holds) { return std::all_of(angles, angles + 3, holds); };
  const std::array<std::array<double, 3>, 3> matrix = {
      {{cell[0], cell[1], cell[3]}, {cell[1], cell[2], cell[4]}, {cell[3], cell[4], cell[5]}}};
  const bool may_be_matrix = is_positive_definite(matrix);

  if (all([](double x) { return std::abs(x) <= 1; })) {
    if (version > 24 && may_be_matrix) return box_from_vectors(matrix);  // of a right box it is the same
    double degrees[3];
    for (int i = 0; i < 3; ++i) degrees[i] = angles[i] == 0 ? 90 : std::acos(angles[i]) * 57.29577951308232;
    return box_from_edges(cell[0], cell[2], cell[5], degrees[0], degrees[1], degrees[2]);
  }
  const std::optional<Box> of_angles = box_from_edges(cell[0], cell[2], cell[5], angles[0], angles[1], angles[2]);
  const bool has_right_angle = !all([](double x) { return x != 90; });
  if (of_angles && (version <= 24 || has_right_angle || !may_be_matrix)) return of_angles;
  return may_be_matrix ? box_from_vectors(matrix) : std::nullopt;
}

class DcdReader : public TrajectoryReader {
 public:
  explicit DcdReader(std::unique_ptr<ByteSource> source)
      : TrajectoryReader(source->name()), source_(std::move(source)) {
    const uint64_t after_titles = read_header();
    first_frame_ = read_atom_counts(after_titles);
    find_cell();
    index_frames();
    if (free_count_ != atom_count) {
      fixed_positions_.resize(3 * atom_count);
      read_axes(0, fixed_positions_.data());
    }
  }

  void read_frame(size_t frame, float *xyz) const override {
    if (free_count_ != atom_count && frame != 0)
      std::copy(fixed_positions_.begin(), fixed_positions_.end(), xyz);  // the free atoms are overwritten
    read_axes(frame, xyz);
  }

  std::optional<Box> box(size_t frame) const override {
    if (!has_cell_) return std::nullopt;
    const uint64_t at = frame_offset(frame);
    if (!is_record(at, kCellLength)) fail_markers(frame);
    double cell[6];
    for (int i = 0; i < 6; ++i) cell[i] = get_f64(at + marker_ + 8 * i);
    return box_of_cell(cell, version_);
  }

  std::optional<double> time(size_t frame) const override {
    if (!(std::isfinite(step_) && step_ > 0 && interval_ > 0)) return std::nullopt;
    return (start_ + static_cast<double>(frame) * interval_) * step_ * kAkmaPicoseconds;
  }

 private:
  uint32_t get_u32(uint64_t at) const {
    unsigned char bytes[4];
    source_->read(at, bytes, 4);
    const uint32_t value = big_endian_u32(bytes);
    return is_big_endian_ ? value : swap_bytes(value);
  }

  int32_t get_i32(uint64_t at) const { return static_cast<int32_t>(get_u32(at)); }

  float get_f32(uint64_t at) const {
    const uint32_t bits = get_u32(at);
    float value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }

  double get_f64(uint64_t at) const {
    const uint64_t first = get_u32(at), second = get_u32(at + 4);
    const uint64_t bits = is_big_endian_ ? first << 32 | second : second << 32 | first;
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }

  // The length that is told before or behind a record.
  uint64_t get_length(uint64_t at) const {
    if (marker_ == 4) return get_u32(at);
    const uint64_t first = get_u32(at), second = get_u32(at + 4);
    return is_big_endian_ ? first << 32 | second : second << 32 | first;
  }

  // Whether both lengths of a record, which must be there, are this one.
  bool is_record(uint64_t at, uint64_t length) const {
    return get_length(at) == length && get_length(at + marker_ + length) == length;
  }

  // Of the two lengths around a record.
  uint64_t markers() const { return 2 * marker_; }

  // Whether a record of a length that the file tells is there as a whole.
  bool has_record(uint64_t at, uint64_t length) const {
    return length <= source_->size() && is_there(at, length + markers());
  }

  bool is_there(uint64_t at, uint64_t count) const { return at <= source_->size() && count <= source_->size() - at; }

  [[noreturn]] void fail_markers(size_t frame) const {
    fail_frame(frame, "is damaged: its records do not fit together");
  }

  // Gives where the record after the titles starts.
  uint64_t read_header() {
    unsigned char head[12];
    if (!is_there(0, sizeof head)) fail("it is cut off within its header");
    source_->read(0, head, sizeof head);
    const uint32_t first = big_endian_u32(head), second = big_endian_u32(head + 4);
    const uint32_t little_endian = swap_bytes(kHeaderLength);
    if ((first == little_endian && second == 0) || (first == 0 && second == kHeaderLength)) marker_ = 8;
    is_big_endian_ = first != little_endian;
    if (is_big_endian_ && marker_ == 4 && first != kHeaderLength) fail("it is no DCD file");
    if (std::memcmp(head + marker_, "VELD", 4) == 0) fail("this DCD file holds velocities, not positions");
    if (std::memcmp(head + marker_, "CORD", 4) != 0) fail("it is no DCD file");
    if (!is_there(0, kHeaderLength + markers() + marker_)) fail("it is cut off within its header");
    if (!is_record(0, kHeaderLength)) fail("its header is damaged");

    const auto control = [this](int i) {
      return marker_ + 4 + 4 * static_cast<uint64_t>(i);
    };  // where the 20 numbers of the header are
    announced_ = get_i32(control(0));
    start_ = get_i32(control(1));
    interval_ = get_i32(control(2));
    fixed_count_ = get_i32(control(8));
    version_ = get_i32(control(19));
    if (version_ != 0) {  // CHARMM and what follows it
      step_ = get_f32(control(9));
      has_cell_ = get_i32(control(10)) != 0;
      has_fourth_ = get_i32(control(11)) == 1;
    } else {  // X-PLOR
      step_ = get_f64(control(9));
    }

    const uint64_t titles = kHeaderLength + markers();
    const uint64_t length = get_length(titles);
    if (!has_record(titles, length)) fail("it is cut off within its titles");
    if (!is_record(titles, length)) fail("its titles are damaged");
    return titles + length + markers();
  }

  // Gives where the first frame starts.
  uint64_t read_atom_counts(uint64_t at) {
    if (!has_record(at, 4)) fail("it is cut off before its number of atoms");
    if (!is_record(at, 4)) fail("the record of its number of atoms is damaged");
    const int32_t count = get_i32(at + marker_);
    if (count <= 0 || static_cast<uint32_t>(count) > kMaxAtoms)
      fail("its number of atoms, " + std::to_string(count) + ", makes no sense");
    if (fixed_count_ < 0 || fixed_count_ >= count)
      fail("its number of fixed atoms, " + std::to_string(fixed_count_) + " of " + std::to_string(count) +
           ", makes no sense");
    at += 4 + markers();
    atom_count = static_cast<size_t>(count);
    free_count_ = static_cast<size_t>(count - fixed_count_);
    if (fixed_count_ == 0) return at;

    const uint64_t length = 4 * static_cast<uint64_t>(free_count_);
    if (!has_record(at, length)) fail("it is cut off within its list of free atoms");
    if (!is_record(at, length)) fail("its list of free atoms is damaged");
    free_.resize(free_count_);
    for (size_t i = 0; i < free_count_; ++i) {
      const uint32_t number = get_u32(at + marker_ + 4 * i);
      if (number < 1 || number > atom_count)
        fail("its list of free atoms names atom " + std::to_string(static_cast<int32_t>(number)) + " of " +
             std::to_string(atom_count));
      free_[i] = number - 1;
    }
    return at + length + markers();
  }

  // Some writers forget to announce the unit cell, or announce one that is not there: the first record decides, unless
  // coordinates are as long.
  void find_cell() {
    if (4 * atom_count == kCellLength || !is_there(first_frame_, marker_)) return;
    const uint64_t length = get_length(first_frame_);
    if (length == kCellLength) has_cell_ = true;
    if (length == 4 * atom_count) has_cell_ = false;
  }

  uint64_t cell_size() const { return has_cell_ ? kCellLength + markers() : 0; }

  uint64_t frame_size(size_t frame) const {
    const uint64_t atoms = frame == 0 ? atom_count : free_count_;
    return cell_size() + (has_fourth_ ? 4 : 3) * (4 * atoms + markers());
  }

  uint64_t frame_offset(size_t frame) const {
    return frame == 0 ? first_frame_ : first_frame_ + frame_size(0) + (frame - 1) * frame_size(1);
  }

  // All frames but the first are of one size, so no list of offsets is needed; but each must look like one.
  void index_frames() {
    for (;; ++frame_count) {
      const uint64_t at = frame_offset(frame_count);
      if (at == source_->size()) break;
      if (!check_head(at)) return;
      if (!is_there(at, frame_size(frame_count))) {
        end_at(frame_count, "is cut off");
        return;
      }
    }
    if (frame_count == 0) fail("it has no frames");
    if (announced_ > 0 && static_cast<uint64_t>(announced_) > frame_count) {
      incomplete = true;
      warnings.push_back(quoted_name() + ": its header announces " +
                         counted(static_cast<uint64_t>(announced_), "frame") + ", but it ends after " +
                         std::to_string(frame_count));
    }
  }

  // The markers that the frame starts with, as far as they are there.
  bool check_head(uint64_t at) {
    const size_t frame = frame_count;
    if (is_there(at, marker_ + 4) && get_length(at) == kHeaderLength) {
      unsigned char magic[4];
      source_->read(at + marker_, magic, 4);
      if (frame != 0 && std::memcmp(magic, "CORD", 4) == 0) {
        end_at(frame, "is the header of another DCD file");
        return false;
      }
    }
    if (has_cell_ && is_there(at, marker_) &&
        (get_length(at) != kCellLength || (is_there(at, cell_size()) && !is_record(at, kCellLength)))) {
      end_at(frame, "is damaged: its unit cell is missing");
      return false;
    }
    const uint64_t axis = at + cell_size();
    if (!is_there(axis, marker_)) return true;
    const uint64_t length = get_length(axis), expected = 4 * (frame == 0 ? atom_count : free_count_);
    if (length == expected) return true;
    if (length != 0 && length % 4 == 0 && has_record(axis, length) && is_record(axis, length)) {
      if (frame == 0)
        fail("frame 0 has " + counted(length / 4, "atom") + ", but the header says " + std::to_string(atom_count));
      fail_atom_count(frame, length / 4 + (atom_count - free_count_));
    }
    end_at(frame, "is damaged: its coordinates do not start where they should");
    return false;
  }

  // The atoms that the frame holds: all, or the free ones to where they belong.
  void read_axes(size_t frame, float *xyz) const {
    constexpr size_t kChunk = 4096;
    unsigned char bytes[4 * kChunk];
    const bool only_free = frame != 0 && free_count_ != atom_count;
    const size_t count = only_free ? free_count_ : atom_count;
    uint64_t at = frame_offset(frame) + cell_size();
    for (int axis = 0; axis < 3; ++axis) {
      if (!is_record(at, 4 * count)) fail_markers(frame);
      for (size_t begin = 0; begin < count; begin += kChunk) {
        const size_t size = std::min(kChunk, count - begin);
        source_->read(at + marker_ + 4 * begin, bytes, 4 * size);
        for (size_t i = 0; i < size; ++i) {
          uint32_t bits = big_endian_u32(bytes + 4 * i);
          if (!is_big_endian_) bits = swap_bytes(bits);
          std::memcpy(&xyz[3 * (only_free ? free_[begin + i] : begin + i) + axis], &bits, 4);
        }
      }
      at += 4 * count + markers();
    }
  }

  std::unique_ptr<ByteSource> source_;
  bool is_big_endian_ = false;
  uint64_t marker_ = 4;    // bytes of the length before or behind a record
  int32_t announced_ = 0;  // frames, as the header says; often 0 or wrong
  int32_t start_ = 0;      // number of the first step
  int32_t interval_ = 0;   // steps between frames
  double step_ = 0;        // length of a step, AKMA units
  int32_t version_ = 0;    // of CHARMM; 0 = X-PLOR
  int32_t fixed_count_ = 0;
  bool has_cell_ = false;
  bool has_fourth_ = false;
  size_t free_count_ = 0;
  std::vector<uint32_t> free_;          // 0-based
  std::vector<float> fixed_positions_;  // frame 0, if some atoms are fixed
  uint64_t first_frame_ = 0;
};

}  // namespace

std::unique_ptr<TrajectoryReader> open_dcd(std::unique_ptr<ByteSource> source) {
  return std::make_unique<DcdReader>(std::move(source));
}

bool is_dcd(const unsigned char *head, size_t size) {
  return size >= 12 && (std::memcmp(head + 4, "CORD", 4) == 0 || std::memcmp(head + 4, "VELD", 4) == 0 ||
                        std::memcmp(head + 8, "CORD", 4) == 0 || std::memcmp(head + 8, "VELD", 4) == 0);
}

}  // namespace quickses::io
