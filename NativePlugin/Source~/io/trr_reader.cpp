// SPDX-License-Identifier: MIT
// TRR: the trajectories of GROMACS in full precision, single or double. A frame in XDR (big-endian, units of 4 bytes):
// magic, the name of the format, the sizes of ten blocks in bytes, atoms, step, a count that is not used, time (ps),
// lambda; then the blocks, those of size 0 left out. Positions, velocities and forces are blocks of their own, and
// frames without positions are usual where velocities are written more often.
#include "io/trr_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "io/big_endian.h"

namespace quickses::io {
namespace {

constexpr int32_t kMagic = 1993;
constexpr char kName[] = "GMX_trn_file";
constexpr size_t kNameSize = sizeof kName - 1;
constexpr size_t kSizesAt = 12 + kNameSize;  // behind magic, the name's size with and without its end, and the name
// In the order in which they lie: parameters, energies, box, virial, pressure, topology, symbols, positions,
// velocities, forces. The first two and topology and symbols were never written.
enum Block { kBox = 2, kPositions = 7, kVelocities = 8, kForces = 9, kBlockCount = 10 };
constexpr size_t kCountsAt = kSizesAt + 4 * kBlockCount;  // atoms, step, count
constexpr size_t kTimeAt = kCountsAt + 12;
constexpr size_t kMaxHeadSize = kTimeAt + 16;

// What the head of a frame says about where things are.
struct Head {
  int32_t atom_count = 0;
  size_t number_size = 0;  // bytes: 4 or 8
  double time = 0;         // ps
  uint64_t box_at = 0;     // from the start of the frame; 0: there is none
  uint64_t positions_at = 0;
  uint64_t frame_size = 0;
};

class TrrReader : public TrajectoryReader {
 public:
  explicit TrrReader(std::unique_ptr<ByteSource> source)
      : TrajectoryReader(source->name()), source_(std::move(source)) {
    index_frames();
  }

  void read_frame(size_t frame, float *xyz) const override {
    const Head head = head_of(frame);
    read_big_endian(*source_, offsets_[frame] + head.positions_at, head.number_size, 10, xyz, 3 * atom_count);
  }

  std::optional<Box> box(size_t frame) const override {
    const Head head = head_of(frame);
    if (head.box_at == 0) return std::nullopt;
    unsigned char bytes[72];
    source_->read(offsets_[frame] + head.box_at, bytes, 9 * head.number_size);
    std::array<std::array<double, 3>, 3> vectors;
    for (size_t i = 0; i < 9; ++i)
      vectors[i / 3][i % 3] = 10 * big_endian_float(bytes + i * head.number_size, head.number_size);
    return box_from_vectors(vectors);
  }

  std::optional<double> time(size_t frame) const override {
    const double time = head_of(frame).time;
    if (!std::isfinite(time)) return std::nullopt;
    return time;
  }

 private:
  // Of a frame that was indexed.
  Head head_of(size_t frame) const {
    Head head;
    const char *problem = nullptr;
    const uint64_t start = offsets_[frame];
    // The file may have been written over since.
    if (!read_head(start, head, problem) || head.frame_size > source_->size() - start || head.positions_at == 0 ||
        static_cast<size_t>(head.atom_count) != atom_count)
      fail_frame(frame, "is damaged: its head has changed since the file was opened");
    return head;
  }

  // False if the head is not all there (problem is null) or makes no sense (problem says why).
  bool read_head(uint64_t start, Head &head, const char *&problem) const {
    unsigned char bytes[kMaxHeadSize];
    problem = nullptr;
    const uint64_t left = source_->size() - start;
    const size_t count = static_cast<size_t>(std::min<uint64_t>(left, kMaxHeadSize));
    source_->read(start, bytes, count);
    if (count < 4) return false;
    if (big_endian_i32(bytes) != kMagic ||
        (count >= kSizesAt && (big_endian_u32(bytes + 4) != kNameSize + 1 || big_endian_u32(bytes + 8) != kNameSize ||
                               std::memcmp(bytes + 12, kName, kNameSize) != 0))) {
      problem = "does not start as frames of TRR files do";
      return false;
    }
    if (count < kTimeAt) return false;
    int32_t sizes[kBlockCount];
    for (int i = 0; i < kBlockCount; ++i) sizes[i] = big_endian_i32(bytes + kSizesAt + 4 * i);
    head.atom_count = big_endian_i32(bytes + kCountsAt);
    problem = find_number_size(sizes, head);
    if (problem != nullptr) return false;
    const size_t head_size = kTimeAt + 2 * head.number_size;
    if (count < head_size) return false;
    head.time = big_endian_float(bytes + kTimeAt, head.number_size);
    head.frame_size = head_size;
    for (int i = 0; i < kBlockCount; ++i) {
      if (i == kBox && sizes[i] != 0) head.box_at = head.frame_size;
      if (i == kPositions && sizes[i] != 0) head.positions_at = head.frame_size;
      head.frame_size += static_cast<uint64_t>(sizes[i]);
    }
    return true;
  }

  // The sizes of blocks tell the precision. Gives what is wrong with them, if anything.
  static const char *find_number_size(const int32_t *sizes, Head &head) {
    if (head.atom_count <= 0) return "is damaged: its number of atoms makes no sense";
    const uint64_t numbers = 3 * static_cast<uint64_t>(head.atom_count);
    for (int i = 0; i < kBlockCount; ++i) {
      if (sizes[i] < 0 || sizes[i] % 4 != 0) return "is damaged: the sizes of its blocks make no sense";
      if (sizes[i] == 0 || !(i == kBox || i >= kPositions)) continue;
      const uint64_t expected = i == kBox ? 9 : numbers, size = static_cast<uint64_t>(sizes[i]);
      if (head.number_size == 0) head.number_size = static_cast<size_t>(size / expected);
      if (size != expected * head.number_size || (head.number_size != 4 && head.number_size != 8))
        return "is damaged: the sizes of its blocks do not fit its number of atoms";
    }
    return head.number_size == 0 ? "is damaged: it has nothing that tells its precision" : nullptr;
  }

  void index_frames() {
    uint64_t start = 0;
    size_t without_positions = 0;
    while (start < source_->size()) {
      const size_t frame = offsets_.size();
      Head head;
      const char *problem = nullptr;
      const bool has_head = read_head(start, head, problem);
      if (!has_head && problem != nullptr) {
        end_at(frame, problem);
        break;
      }
      if (!has_head || head.frame_size > source_->size() - start) {
        end_at(frame, "is cut off");
        break;
      }
      if (head.positions_at != 0) {
        if (frame != 0 && static_cast<size_t>(head.atom_count) != atom_count)
          fail_atom_count(frame, static_cast<uint64_t>(head.atom_count));
        atom_count = static_cast<size_t>(head.atom_count);
        offsets_.push_back(start);
      } else {
        ++without_positions;
      }
      start += head.frame_size;
    }
    frame_count = offsets_.size();
    if (frame_count == 0) fail("none of its frames has positions, only velocities or forces");
    if (without_positions != 0)
      warnings.push_back(quoted_name() + ": " + std::to_string(without_positions) + " of " +
                         std::to_string(without_positions + frame_count) +
                         " frames have no positions and are left out; the others are numbered without them");
  }

  std::unique_ptr<ByteSource> source_;
  std::vector<uint64_t> offsets_;  // of the frames with positions
};

}  // namespace

std::unique_ptr<TrajectoryReader> open_trr(std::unique_ptr<ByteSource> source) {
  return std::make_unique<TrrReader>(std::move(source));
}

bool is_trr(const unsigned char *head, size_t size) {
  return size >= kSizesAt && big_endian_i32(head) == kMagic && std::memcmp(head + 12, kName, kNameSize) == 0;
}

}  // namespace quickses::io
