// SPDX-License-Identifier: MIT
// What the last frames tell of the next one: how long it will take, and whether memory is held as it will be.
#pragma once

#include "parallel/span.h"
#include "quickses/quickses.h"

#include <algorithm>
#include <cstring>

namespace quickses {

// Frames in a row that were made alike. With more steps, another method or a finer level, one may take a thousand times
// as long.
class FrameHistory {
 public:
  // One is about to be made, with these settings, at these spacings. Those that were made otherwise are forgotten.
  void begin(const qses_settings &settings, Span<const float> spacings) {
    static_assert(alignof(qses_settings) == 4, "members of four bytes leave no gaps");
    qses_settings untagged = settings;
    untagged.tag = 0;
    const float coarsest = spacings.size > 0 ? spacings[0] : 0.f;
    if (std::memcmp(&untagged, &settings_, sizeof untagged) != 0 || spacings.size != levels_ || coarsest != coarsest_)
      forget();
    settings_ = untagged;
    levels_ = spacings.size;
    coarsest_ = coarsest;
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
  qses_settings settings_{};
  size_t levels_ = 0;
  float coarsest_ = 0;
  int made_ = 0;  // at most 2
  double milliseconds_ = 0;
};

}  // namespace quickses
