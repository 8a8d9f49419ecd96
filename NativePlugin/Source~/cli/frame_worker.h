// SPDX-License-Identifier: MIT
// The surface of one frame after the other, with a context of its own.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cli/engine.h"
#include "cli/frame_supply.h"
#include "cli/options.h"
#include "cli/output_pattern.h"
#include "io/trajectory.h"
#include "io/unwrap.h"

namespace quickses::cli {

// What the workers of a process share and only read.
struct FrameInputs {
  // Reads both files. Warnings go to standard error unless quiet.
  // Throws Failure, io::Error.
  FrameInputs(const Options &options, bool quiet);

  Options options;
  io::StructureFile file;  // with one model
  io::Trajectory trajectory;
  std::vector<uint32_t> file_indices;  // of the atoms of the structure
  std::optional<io::Unwrapper> unwrapper;
  std::optional<OutputPattern> pattern;

  const io::Structure &structure() const { return file.models.front(); }
};

class FrameWorker {
 public:
  // compute: the worker's share of threads and memory; shared_by: how many workers there are. inputs must outlive the
  // worker. Throws Failure.
  FrameWorker(const FrameInputs &inputs, const ComputeOptions &compute, unsigned shared_by);

  // Never fails: what goes wrong is part of the result.
  FrameResult run(const FrameTask &task);

 private:
  void fill(const FrameTask &task, FrameResult &result);
  qses_mesh compute();

  const FrameInputs &inputs_;
  Engine engine_;
  const unsigned shared_by_;
  std::vector<float> xyz_;
  qses_settings settings_;
};

// The first line of the table.
extern const char kCsvHeader[];

}  // namespace quickses::cli
