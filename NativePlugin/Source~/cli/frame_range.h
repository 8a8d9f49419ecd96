// SPDX-License-Identifier: MIT
// Which frames of a trajectory: A:B:STEP as slices of Python are written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace quickses::cli {

// The frames first, first + step, ..., count of them.
struct FrameSelection {
  size_t first = 0;
  size_t step = 1;
  size_t count = 0;

  size_t frame(size_t place) const { return first + place * step; }
};

class FrameRange {
 public:
  FrameRange() = default;  // all frames

  // "A:B:STEP", each part may be missing, or "A" for one frame. Frames count from 0; negative A and B from the end, so
  // that -1 is the last frame; B itself is left out. Throws Failure (kUsage) naming --frames.
  explicit FrameRange(const std::string &text);

  // The frames of a trajectory, at least one. As in Python, A and B may lie beyond the ends; a single frame must exist.
  // Throws Failure (kUsage) naming --frames and the trajectory, which is given in quotes.
  FrameSelection select(size_t frame_count, const std::string &quoted_trajectory) const;

 private:
  std::string text_;
  std::optional<int64_t> begin_, end_;
  size_t step_ = 1;
  bool is_single_ = false;
};

}  // namespace quickses::cli
