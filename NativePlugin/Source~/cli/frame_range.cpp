// SPDX-License-Identifier: MIT
// Which frames of a trajectory.
#include "cli/frame_range.h"

#include <algorithm>
#include <vector>

#include "cli/exit_code.h"
#include "io/text.h"

namespace quickses::cli {
namespace {

int64_t parse_part(const std::string &part, const std::string &text) {
  int64_t value = 0;
  if (part != io::trim(part) || !io::parse_integer(part, value))
    throw Failure(kUsage, "--frames: '" + text + "' is no range of frames such as 10, 0:100, 0:100:5 or -20:");
  return value;
}

}  // namespace

FrameRange::FrameRange(const std::string &text) : text_(text) {
  const std::vector<std::string> parts = io::split(text, ':');
  if (parts.size() > 3) throw Failure(kUsage, "--frames: '" + text + "' has more than the three parts A:B:STEP");
  is_single_ = parts.size() == 1;
  if (is_single_ || !parts[0].empty()) begin_ = parse_part(parts[0], text);
  if (parts.size() > 1 && !parts[1].empty()) end_ = parse_part(parts[1], text);
  if (parts.size() > 2 && !parts[2].empty()) {
    const int64_t step = parse_part(parts[2], text);
    if (step < 1) throw Failure(kUsage, "--frames: the step of '" + text + "' must be 1 or more");
    step_ = static_cast<size_t>(step);
  }
}

FrameSelection FrameRange::select(size_t frame_count, const std::string &quoted_trajectory) const {
  const int64_t count = static_cast<int64_t>(frame_count);
  const std::string frames = io::counted(frame_count, "frame");
  const auto from_start = [count](int64_t frame) { return frame < 0 ? frame + count : frame; };
  if (is_single_) {
    const int64_t frame = from_start(*begin_);
    if (frame < 0 || frame >= count)
      throw Failure(kUsage, "--frames: " + quoted_trajectory + " has no frame " + text_ + ": only " + frames +
                                ", 0 to " + std::to_string(count - 1));
    return {static_cast<size_t>(frame), 1, 1};
  }
  const auto place = [&](int64_t frame) { return std::clamp<int64_t>(from_start(frame), 0, count); };
  const int64_t begin = begin_ ? place(*begin_) : 0, end = end_ ? place(*end_) : count;
  if (begin >= end)
    throw Failure(kUsage, "--frames: " + text_ + " selects none of the " + frames + " of " + quoted_trajectory);
  const size_t span = static_cast<size_t>(end - begin);
  return {static_cast<size_t>(begin), step_, (span - 1) / step_ + 1};
}

}  // namespace quickses::cli
