// SPDX-License-Identifier: MIT
// Where workers get their frames from and bring their results to.
#pragma once

#include <cstdint>
#include <exception>
#include <optional>
#include <string>

namespace quickses::cli {

struct FrameTask {
  uint64_t place = 0;  // among the frames that were asked for
  uint64_t frame = 0;  // in the trajectory
};

struct FrameResult {
  uint64_t place = 0, frame = 0;      // of its task
  std::string csv;                    // its row, with the end of the line
  std::string json;                   // its line, or empty
  std::string page;                   // its mesh, if they go to a page, or empty
  std::string per_atom, per_residue;  // lines of those tables, or empty
  std::string error;                  // why it failed; empty if it did not
};

// All members may be called from several threads at a time.
class FrameSupply {
 public:
  virtual ~FrameSupply() = default;

  // Nothing: there are no more. Waits while results are too far ahead of the oldest one that is missing.
  virtual std::optional<FrameTask> next() = 0;

  virtual void deliver(FrameResult result) = 0;

  // A worker can't go on.
  virtual void give_up(std::exception_ptr why) = 0;
};

}  // namespace quickses::cli
