// SPDX-License-Identifier: MIT
// Where the coarser levels of a ladder are made beside the finest one: each has streams and memory of its own, so that
// a GPU which one of them leaves idle works on the others. A GPU goes through few vertices one dependent step after
// the other: at 2 Å a small protein takes as long as at .5 Å.
#pragma once

#include "surface/mesh/mesh_memory.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace quickses {

template <class Executor>
struct LevelLane {
  explicit LevelLane(const Executor &main) : executor(main.device(), true), memory(executor, main.stream_handle()) {}
  Executor executor;
  MeshMemory<Executor> memory;
  std::optional<typename Executor::RunScope> run;  // of the frame
};

// On a CPU there are none. Use from one thread at a time.
template <class Executor>
class CoarseLanes {
 public:
  // Ends with a frame: main goes on behind whatever lanes were given in it.
  class Scope {
   public:
    Scope(CoarseLanes &lanes, Executor &main) : lanes_(lanes), main_(main) {}
    ~Scope() { lanes_.close(main_); }
    Scope(const Scope &) = delete;
    Scope &operator=(const Scope &) = delete;

   private:
    CoarseLanes &lanes_;
    Executor &main_;
  };

  // For all but the last of the levels, of frames of that kind (open_counts).
  void open(Executor &main, Span<const float> spacings, uint64_t kind, const qses_settings &settings,
            const std::atomic<bool> &stop) {
    if constexpr (Executor::kIsCuda)
      while (open_ + 1 < spacings.size) {
        const float of_finest = spacings[spacings.size - 1] / spacings[open_];
        if (open_ == lanes_.size()) lanes_.push_back(std::make_unique<LevelLane<Executor>>(main));
        LevelLane<Executor> &lane = *lanes_[open_++];
        lane.run.emplace(lane.executor, stop);
        lane.memory.deliver_to(settings);
        lane.executor.arena().reset();
        // What a frame takes, by the spacing, which is more than a level needs; but all of it if that is little.
        const uint64_t whole = main.arena().held();
        lane.executor.arena().expect(
            std::max(static_cast<uint64_t>(of_finest * static_cast<float>(whole)), std::min(whole, kLittle)));
        lane.executor.open_counts(kind, true);
      }
  }
  size_t count() const { return open_; }
  LevelLane<Executor> &lane(size_t level) { return *lanes_[level]; }
  // They go on behind what main has been given.
  void go_behind(Executor &main) {
    if constexpr (Executor::kIsCuda)
      for (size_t k = 0; k < open_; ++k) lanes_[k]->executor.go_behind(main);
  }
  // Whether all have counted in a frame like this one.
  bool know_frames() const {
    if constexpr (Executor::kIsCuda)
      for (size_t k = 0; k < open_; ++k)
        if (!lanes_[k]->executor.knows_frames()) return false;
    return true;
  }
  void forget_frames() {
    if constexpr (Executor::kIsCuda)
      for (const auto &lane : lanes_) lane->executor.forget_frames();
  }
  // Their memory is needed elsewhere. False: there are none.
  bool drop() {
    const bool were_there = !lanes_.empty();
    lanes_.clear();
    return were_there;
  }

  // Of those in use, at most; and of meshes, whichever made them.
  uint64_t work_bytes() const {
    uint64_t sum = 0;
    for (const auto &lane : lanes_) sum += lane->memory.outside_arena(lane->executor);
    for (size_t k = 0; k < open_; ++k) sum += lanes_[k]->executor.arena().peak();
    return sum;
  }
  uint64_t host_bytes() const {
    uint64_t sum = 0;
    for (const auto &lane : lanes_) sum += lane->memory.host_bytes();
    return sum;
  }

 private:
  static constexpr uint64_t kLittle = uint64_t(1) << 24;

  void close(Executor &main) noexcept {
    if constexpr (Executor::kIsCuda)
      for (size_t k = 0; k < open_; ++k) {
        main.follow_end_of(lanes_[k]->executor);
        lanes_[k]->run.reset();
      }
    open_ = 0;
  }

  std::vector<std::unique_ptr<LevelLane<Executor>>> lanes_;
  size_t open_ = 0;
};

}  // namespace quickses
