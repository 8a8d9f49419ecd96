// SPDX-License-Identifier: MIT
// XTC: the compressed trajectories of GROMACS. A frame in XDR (big-endian, units of 4 bytes): magic, atoms, step, time
// (ps), box (9 numbers, nm), atoms again; then the positions, plain for up to 9 atoms, else packed (see xtc_coder.h).
#include "io/xtc_reader.h"

#include <cmath>

#include "io/big_endian.h"
#include "io/xtc_coder.h"

namespace quickses::io {
namespace {

constexpr int32_t kMagic = 1995;
constexpr int32_t kLargeMagic = 2023;  // the number of packed bytes has 64 bits: systems above 298 million atoms
constexpr int32_t kMaxPlainAtoms = 9;
constexpr size_t kHeadSize = 56;        // up to and with the second number of atoms
constexpr size_t kPackedHeadSize = 88;  // up to the number of packed bytes
constexpr size_t kMaxHeadSize = kPackedHeadSize + 8;

// What the head of a frame says about where things are.
struct Head {
  int32_t atom_count = 0;
  uint64_t data_at = 0;    // from the start of the frame
  uint64_t data_size = 0;  // without the bytes that fill the last unit
  uint64_t frame_size = 0;
};

class XtcReader : public TrajectoryReader {
 public:
  explicit XtcReader(std::unique_ptr<ByteSource> source)
      : TrajectoryReader(source->name()), source_(std::move(source)) {
    index_frames();
  }

  void read_frame(size_t frame, float *xyz) const override {
    unsigned char bytes[kMaxHeadSize];
    Head head;
    const uint64_t start = offsets_[frame];
    const char *problem = nullptr;
    // The file may have been written over since it was indexed.
    if (!read_head(start, bytes, head, problem) || head.frame_size > source_->size() - start ||
        static_cast<size_t>(head.atom_count) != atom_count)
      fail_frame(frame, "is damaged: its head has changed since the file was opened");
    std::vector<unsigned char> scratch;
    const unsigned char *data = source_->view(start + head.data_at, static_cast<size_t>(head.data_size), scratch);
    if (head.atom_count <= kMaxPlainAtoms) {
      for (size_t i = 0; i < 3 * atom_count; ++i) xyz[i] = static_cast<float>(10.0 * big_endian_f32(data + 4 * i));
      return;
    }
    XtcBlock block;
    block.precision = big_endian_f32(bytes + 56);
    for (int i = 0; i < 3; ++i) {
      block.min[i] = big_endian_i32(bytes + 60 + 4 * i);
      block.max[i] = big_endian_i32(bytes + 72 + 4 * i);
    }
    block.small_index = big_endian_i32(bytes + 84);
    problem = unpack_xtc(block, data, static_cast<size_t>(head.data_size), atom_count, xyz);
    if (problem != nullptr) fail_frame(frame, std::string("is damaged: ") + problem);
  }

  std::optional<Box> box(size_t frame) const override {
    unsigned char bytes[36];
    source_->read(offsets_[frame] + 16, bytes, sizeof bytes);
    std::array<std::array<double, 3>, 3> vectors;
    for (int i = 0; i < 9; ++i) vectors[i / 3][i % 3] = 10.0 * big_endian_f32(bytes + 4 * i);
    return box_from_vectors(vectors);
  }

  std::optional<double> time(size_t frame) const override {
    unsigned char bytes[4];
    source_->read(offsets_[frame] + 12, bytes, sizeof bytes);
    const float time = big_endian_f32(bytes);
    if (!std::isfinite(time)) return std::nullopt;
    return time;
  }

 private:
  // False if the head is not all there (problem is null) or makes no sense (problem says why).
  bool read_head(uint64_t start, unsigned char *bytes, Head &head, const char *&problem) const {
    problem = nullptr;
    const uint64_t left = source_->size() - start;
    const size_t count = static_cast<size_t>(left < kMaxHeadSize ? left : kMaxHeadSize);
    source_->read(start, bytes, count);
    if (count < 4) return false;
    const int32_t magic = big_endian_i32(bytes);
    if (magic != kMagic && magic != kLargeMagic) {
      problem = "does not start as frames of XTC files do";
      return false;
    }
    if (count < kHeadSize) return false;
    head.atom_count = big_endian_i32(bytes + 4);
    if (head.atom_count <= 0 || head.atom_count != big_endian_i32(bytes + 52)) {
      problem = "is damaged: its number of atoms makes no sense";
      return false;
    }
    if (head.atom_count <= kMaxPlainAtoms) {
      head.data_at = kHeadSize;
      head.data_size = 12 * static_cast<uint64_t>(head.atom_count);
    } else {
      const size_t size_bytes = magic == kLargeMagic ? 8 : 4;
      if (count < kPackedHeadSize + size_bytes) return false;
      head.data_at = kPackedHeadSize + size_bytes;
      head.data_size = big_endian_u32(bytes + kPackedHeadSize);
      if (magic == kLargeMagic) head.data_size = head.data_size << 32 | big_endian_u32(bytes + kPackedHeadSize + 4);
      // Also keeps callers from making room for atoms that can't be there.
      if (head.data_size > (uint64_t{1} << 48) || head.data_size < min_xtc_bytes(head.atom_count)) {
        problem = "is damaged: its number of bytes makes no sense";
        return false;
      }
    }
    head.frame_size = head.data_at + (head.data_size + 3) / 4 * 4;
    return true;
  }

  void index_frames() {
    uint64_t start = 0;
    while (start < source_->size()) {
      const size_t frame = offsets_.size();
      unsigned char bytes[kMaxHeadSize];
      Head head;
      const char *problem = nullptr;
      const bool has_head = read_head(start, bytes, head, problem);
      if (!has_head && problem != nullptr) {
        end_at(frame, problem);
        break;
      }
      if (has_head && frame != 0 && static_cast<size_t>(head.atom_count) != atom_count)
        fail_atom_count(frame, static_cast<uint64_t>(head.atom_count));
      if (!has_head || head.frame_size > source_->size() - start) {
        end_at(frame, "is cut off");
        break;
      }
      atom_count = static_cast<size_t>(head.atom_count);
      offsets_.push_back(start);
      start += head.frame_size;
    }
    frame_count = offsets_.size();
  }

  std::unique_ptr<ByteSource> source_;
  std::vector<uint64_t> offsets_;
};

}  // namespace

std::unique_ptr<TrajectoryReader> open_xtc(std::unique_ptr<ByteSource> source) {
  return std::make_unique<XtcReader>(std::move(source));
}

bool is_xtc(const unsigned char *head, size_t size) {
  return size >= 4 && (big_endian_i32(head) == kMagic || big_endian_i32(head) == kLargeMagic);
}

}  // namespace quickses::io
