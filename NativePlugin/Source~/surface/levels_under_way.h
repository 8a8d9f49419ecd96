// SPDX-License-Identifier: MIT
// The levels of a ladder that are under way, in their order. A level is begun, ended, which asks the back end for the
// rest of it, and handed out, which waits for it. Those that are made beside each other are all ended before the host
// waits for the one in front, so that they go out together; unless the last of them attends to the others now and then.
#pragma once

#include "surface/levels.h"

#include <cstddef>
#include <optional>
#include <utility>

namespace quickses {

// Maker: has end(Level &), hand_out(Level &), is_done(const Level &), which is whether nobody would wait for one that
// ended, verify_prepared(), for what all rest on, and go_on_with(const Level &) after others. Nothing is allocated.
template <class Level, class Maker>
class LevelsUnderWay {
 public:
  explicit LevelsUnderWay(Maker &maker) : maker_(maker) {}
  LevelsUnderWay(const LevelsUnderWay &) = delete;
  LevelsUnderWay &operator=(const LevelsUnderWay &) = delete;

  // The next one, which is about to begin. Those before it have begun.
  template <class... Arguments>
  Level &add(Arguments &&...arguments) {
    return levels_[last_++].emplace(std::forward<Arguments>(arguments)...);
  }
  void note_begun() { begun_ = last_; }

  // The last one is about to wait for the back end: the others go out first.
  void hand_out_others() {
    maker_.verify_prepared();
    end_begun();
    while (first_ + 1 < last_) hand_out_first();
    maker_.go_on_with(*levels_[last_ - 1]);
  }
  void hand_out_all() {
    end_begun();
    while (first_ < last_) hand_out_first();
  }
  // The last one has given the back end work enough for a while. The very first level is waited for; of the others, the
  // one in front goes out if it is done.
  void attend_to_others() {
    if (first_ + 1 >= last_) return;
    if (first_ == ended_) maker_.end(*levels_[ended_++]);
    if (first_ == 0 || maker_.is_done(*levels_[first_])) hand_out_first();
    maker_.go_on_with(*levels_[last_ - 1]);
  }

 private:
  void end_begun() {
    while (ended_ < begun_) maker_.end(*levels_[ended_++]);
  }
  void hand_out_first() {
    maker_.hand_out(*levels_[first_]);
    levels_[first_++].reset();
  }

  Maker &maker_;
  std::optional<Level> levels_[Levels::kMax];
  size_t first_ = 0, ended_ = 0, begun_ = 0, last_ = 0;  // those before them are handed out, ended, begun, there
};

}  // namespace quickses
