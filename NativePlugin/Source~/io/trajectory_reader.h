// SPDX-License-Identifier: MIT
// What each format of trajectories implements behind the class Trajectory.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/box.h"
#include "io/byte_source.h"
#include "io/error.h"
#include "io/text.h"

namespace quickses::io {

class TrajectoryReader {
 public:
  virtual ~TrajectoryReader() = default;

  // Frames in range only; see Trajectory. Coordinates need not be checked here. Const members are free-threaded.
  virtual void read_frame(size_t frame, float *xyz) const = 0;
  virtual std::optional<Box> box(size_t frame) const = 0;
  virtual std::optional<double> time(size_t frame) const = 0;

  const std::string &name() const { return name_; }

  size_t frame_count = 0;
  size_t atom_count = 0;
  bool incomplete = false;
  std::vector<std::string> warnings;

 protected:
  explicit TrajectoryReader(const std::string &name) : name_(name) {}

  std::string quoted_name() const { return "'" + name_ + "'"; }

  [[noreturn]] void fail(const std::string &what) const { fail_input(quoted_name() + ": " + what); }

  [[noreturn]] void fail_frame(size_t frame, const std::string &what) const {
    fail("frame " + std::to_string(frame) + " " + what);
  }

  [[noreturn]] void fail_atom_count(size_t frame, uint64_t count) const {
    fail_frame(frame, "has " + counted(count, "atom") + ", but frame 0 has " + std::to_string(atom_count));
  }

  // Nothing can be read from `frame` on: an error for the first frame, a warning later.
  void end_at(size_t frame, const std::string &what) {
    if (frame == 0) fail_frame(0, what);
    incomplete = true;
    warnings.push_back(quoted_name() + ": frame " + std::to_string(frame) + " " + what + "; only the " +
                       (frame == 1 ? "frame" : std::to_string(frame) + " frames") + " before can be read");
  }

 private:
  std::string name_;
};

}  // namespace quickses::io
