// SPDX-License-Identifier: MIT
// The surface of one frame after the other, with a context of its own.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cli/area_tables.h"
#include "cli/engine.h"
#include "cli/frame_supply.h"
#include "cli/input.h"
#include "cli/options.h"
#include "cli/output_pattern.h"
#include "cli/report.h"
#include "io/trajectory.h"
#include "io/unwrap.h"

namespace quickses::cli {

// What the workers of a process share and only read.
struct FrameInputs : Input {
  // Reads both files. Warnings go to standard error unless quiet.
  // Throws Failure, io::Error.
  FrameInputs(const Options &options, bool quiet);

  io::Trajectory trajectory;
  std::vector<uint32_t> file_indices;  // of the atoms of the structure
  std::optional<io::Unwrapper> unwrapper;
  std::optional<OutputPattern> pattern;

  // The only one.
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
  void fill_mesh(const FrameTask &task, std::optional<double> time, Timings timings, FrameResult &result);
  void fill_measurement(const FrameTask &task, std::optional<double> time, const Timings &timings, FrameResult &result);
  Json frame_json(const FrameTask &task, std::optional<double> time) const;
  void add_areas(const std::vector<AtomAreas> &areas, FrameResult &result) const;
  template <class Action>
  auto explain_share(const Action &action);

  const FrameInputs &inputs_;
  Engine engine_;
  const unsigned shared_by_;
  std::vector<float> xyz_;
  qses_settings settings_;
};

// The first line of the table.
std::string csv_header(const Options &options);

}  // namespace quickses::cli
