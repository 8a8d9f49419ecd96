// SPDX-License-Identifier: MIT
// PDB files with several models, as trajectories. What starts and ends a model is the same as for structures
// (pdb_reader.cpp): MODEL starts one, ENDMDL and END end one, atoms outside start one.
#include "io/pdb_frames.h"

#include <algorithm>
#include <string_view>

#include "io/pdb_lines.h"
#include "io/text.h"

namespace quickses::io {
namespace {

std::optional<Box> parse_cryst1(std::string_view line) {
  static constexpr size_t kColumns[6][2] = {{6, 9}, {15, 9}, {24, 9}, {33, 7}, {40, 7}, {47, 7}};
  double values[6];
  for (int i = 0; i < 6; ++i)
    if (line.size() < kColumns[i][0] || !parse_number(line.substr(kColumns[i][0], kColumns[i][1]), values[i]))
      return std::nullopt;
  if (values[0] == 1 && values[1] == 1 && values[2] == 1) return std::nullopt;  // how entries say that there is none
  return box_from_edges(values[0], values[1], values[2], values[3], values[4], values[5]);
}

struct Frame {
  size_t begin = 0;  // in the text
  size_t end = 0;
  size_t first_line = 0;  // number of the line at begin, from 1
  size_t atom_count = 0;
  bool closed = false;  // by ENDMDL or END
  std::optional<Box> box;
};

class PdbFrames : public TrajectoryReader {
 public:
  explicit PdbFrames(std::unique_ptr<ByteSource> source) : TrajectoryReader(source->name()) {
    text_ = source->take_all();
    unify_text(text_);
    index_frames();
    drop_cut_off_frame();
    if (frames_.empty()) fail("it has no atoms");
    atom_count = frames_.front().atom_count;
    for (size_t k = 0; k < frames_.size(); ++k)
      if (frames_[k].atom_count != atom_count) fail_atom_count(k, frames_[k].atom_count);
    if (atom_count == 0) fail_frame(0, "has no atoms");
    frame_count = frames_.size();
  }

  void read_frame(size_t frame, float *xyz) const override {
    const Frame &place = frames_[frame];
    std::string_view rest = std::string_view(text_).substr(place.begin, place.end - place.begin);
    std::string_view line;
    for (size_t number = place.first_line; next_line(rest, line); ++number) {
      if (!is_atom(pdb_record_of(line))) continue;
      double position[3];
      read_pdb_position(line, name(), number, position);
      xyz = std::copy_n(position, 3, xyz);
    }
  }

  std::optional<Box> box(size_t frame) const override { return frames_[frame].box; }
  std::optional<double> time(size_t) const override { return std::nullopt; }

 private:
  void index_frames() {
    std::string_view rest = text_, line;
    std::optional<Box> box;
    bool is_open = false;
    for (size_t number = 1, at = 0; next_line(rest, line); ++number, at = text_.size() - rest.size()) {
      const auto begin_frame = [&] {
        frames_.emplace_back();
        frames_.back().begin = at;
        frames_.back().first_line = number;
        is_open = true;
      };
      const PdbRecord record = pdb_record_of(line);
      if (is_atom(record)) {
        if (!is_open) begin_frame();
        Frame &frame = frames_.back();
        const bool is_last_line = rest.empty() && text_.back() != '\n';
        if (is_last_line && line.size() < kPdbPositionEnd) {
          ends_in_atom_ = true;
          return;
        }
        check_pdb_position(line, name(), number);
        if (frame.atom_count++ == 0) frame.box = box;
        frame.end = text_.size() - rest.size();
      } else if (record == PdbRecord::kModel) {
        begin_frame();
      } else if (record == PdbRecord::kEnd) {
        if (is_open) frames_.back().closed = true;
        is_open = false;
      } else if (record == PdbRecord::kCell) {
        box = parse_cryst1(line);
      }
    }
  }

  // A last model that nothing ends and that has fewer atoms than the first was not written to its end.
  void drop_cut_off_frame() {
    if (frames_.empty() || frames_.back().closed) return;
    const bool is_whole =
        !ends_in_atom_ && frames_.back().atom_count != 0 && frames_.back().atom_count >= frames_.front().atom_count;
    if (is_whole) return;
    end_at(frames_.size() - 1, "is cut off");
    frames_.pop_back();
  }

  std::string text_;
  std::vector<Frame> frames_;
  bool ends_in_atom_ = false;
};

}  // namespace

std::unique_ptr<TrajectoryReader> open_pdb_frames(std::unique_ptr<ByteSource> source) {
  return std::make_unique<PdbFrames>(std::move(source));
}

bool is_pdb(const unsigned char *head, size_t size) {
  std::string_view text(reinterpret_cast<const char *>(head), size), line;
  if (has_byte_order_mark(text)) text.remove_prefix(3);
  while (next_line(text, line)) {
    if (trim(line).empty()) continue;
    return begins_pdb(line);
  }
  return false;
}

}  // namespace quickses::io
