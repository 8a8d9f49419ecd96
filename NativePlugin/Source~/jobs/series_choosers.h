// SPDX-License-Identifier: MIT
// What was learnt about levels, for each series of frames apart.
#pragma once

#include "jobs/level_chooser.h"

#include <vector>

namespace quickses {

class SeriesChoosers {
 public:
  // Takes the memory for all series there can be, unless it is there. Throws std::bad_alloc.
  void reserve();

  // The chooser of a series, once memory is reserved: a new one if the series is not among the QSES_REMEMBERED_SERIES
  // that were asked for last. Valid until the next call.
  LevelChooser &of(uint32_t series) noexcept;

 private:
  struct Use {
    uint32_t series;
    uint64_t last;  // when, in calls
  };

  std::vector<Use> uses_;
  std::vector<LevelChooser> choosers_;  // as many, in the same order
  uint64_t calls_ = 0;
};

}  // namespace quickses
