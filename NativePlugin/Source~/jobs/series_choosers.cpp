// SPDX-License-Identifier: MIT
#include "jobs/series_choosers.h"

#include <algorithm>

namespace quickses {

void SeriesChoosers::reserve() {
  uses_.reserve(QSES_REMEMBERED_SERIES);
  choosers_.reserve(QSES_REMEMBERED_SERIES);
}

LevelChooser &SeriesChoosers::of(uint32_t series) noexcept {
  auto use = std::find_if(uses_.begin(), uses_.end(), [&](const Use &u) { return u.series == series; });
  if (use == uses_.end() && uses_.size() < QSES_REMEMBERED_SERIES) {
    use = uses_.insert(use, {series, 0});
    choosers_.emplace_back();
  } else if (use == uses_.end()) {
    use = std::min_element(uses_.begin(), uses_.end(), [](const Use &a, const Use &b) { return a.last < b.last; });
    use->series = series;
    choosers_[static_cast<size_t>(use - uses_.begin())] = LevelChooser();
  }
  use->last = ++calls_;
  return choosers_[static_cast<size_t>(use - uses_.begin())];
}

}  // namespace quickses
