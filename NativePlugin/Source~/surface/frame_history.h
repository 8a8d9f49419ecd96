// SPDX-License-Identifier: MIT
// What the last frames tell of the next one: how long it will take, and whether memory is held as it will be.
#pragma once

#include "parallel/span.h"
#include "quickses/quickses.h"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace quickses {

// Frames in a row that were made alike. With more steps, another method or a finer level, one may take a thousand times
// as long; coarser levels beside the finest one do not matter that much.
class FrameHistory {
 public:
  // One is about to be made, with these settings, at these spacings. Those that were made otherwise are forgotten.
  void begin(const qses_settings &settings, Span<const float> spacings) {
    static_assert(alignof(qses_settings) == 4, "members of four bytes leave no gaps");
    qses_settings like = settings;
    like.spacing = spacings.size > 0 ? spacings[spacings.size - 1] : 0.f;
    like.tag = like.series = like.level_count = 0;
    like.frame_budget_ms = like.show_ms_per_mb = 0.f;
    std::fill(std::begin(like.levels), std::end(like.levels), 0.f);
    if (std::memcmp(&like, &like_, sizeof like) != 0) forget();
    like_ = like;
  }
  // It was made.
  void end(double milliseconds) {
    milliseconds_ = milliseconds;
    made_ = std::min(made_ + 1, 2);
  }
  void forget() { made_ = 0; }
  // Memory will not be held as it was.
  void unsettle() { made_ = std::min(made_, 1); }

  bool takes_less_than(double milliseconds) const { return made_ > 0 && milliseconds_ < milliseconds; }
  bool takes_more_than(double milliseconds) const { return made_ > 0 && milliseconds_ > milliseconds; }
  // Two were made, the second in what the first had taken.
  bool is_settled() const { return made_ > 1; }

 private:
  qses_settings like_{};  // as far as it matters, at the finest of the spacings
  int made_ = 0;          // at most 2
  double milliseconds_ = 0;
};

}  // namespace quickses
