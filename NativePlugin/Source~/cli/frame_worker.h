// SPDX-License-Identifier: MIT
// From a frame of a trajectory to its result, for a thread that does one after the other.
#pragma once

#include <optional>
#include <vector>

#include "cli/area_tables.h"
#include "cli/engine_pool.h"
#include "cli/frame_supply.h"
#include "cli/input.h"
#include "cli/mesh_output.h"
#include "cli/options.h"
#include "cli/output_pattern.h"
#include "cli/report.h"
#include "io/trajectory.h"

namespace quickses::cli {

// What the workers of a process share and only read.
struct FrameInputs : Input {
  // Reads all files. Warnings go to standard error unless quiet.
  // Throws Failure, io::Error.
  FrameInputs(const Options &options, bool quiet);

  io::Trajectory trajectory;
  std::vector<uint32_t> file_indices;  // of the atoms of the structure
  std::optional<OutputPattern> pattern;
  MeshOutput mesh_output;

  // Of the structure's atoms in a frame.
  std::vector<float> centers(const std::vector<float> &xyz) const;

  // The only one.
  const io::Structure &structure() const { return file.models.front(); }
};

// An engine as it must be before workers borrow it: with the atoms of the structure. Throws Failure.
void prepare_engine(Engine &engine, const FrameInputs &inputs);

// Reads, computes, writes. It has an engine only while it computes, so that others compute while it reads or writes.
class FrameWorker {
 public:
  // engines: prepared, all of the back end. shared_by: how many of them share the memory of the options. inputs and
  // engines must outlive the worker. Throws Failure.
  FrameWorker(const FrameInputs &inputs, EnginePool &engines, qses_backend backend, unsigned shared_by);

  // From where all frames are seen if this one fills the picture. Throws Failure, io::Error.
  render::Camera camera(const FrameTask &task);

  // Never fails: what goes wrong is part of the result.
  FrameResult run(const FrameTask &task);

 private:
  struct Read {
    std::optional<double> time;  // ps
    Timings timings;
  };

  Read read(const FrameTask &task);
  void fill_mesh(const FrameTask &task, Read read, FrameResult &result);
  void fill_measurement(const FrameTask &task, const Read &read, FrameResult &result);
  const std::string &file_of(const FrameTask &task) const;
  Json frame_json(const FrameTask &task, std::optional<double> time) const;
  void add_areas(const std::vector<AtomAreas> &areas, FrameResult &result) const;
  void set_frame(Engine &engine) const;
  std::vector<float> centers() const;  // of the atoms in the frame, if they are needed
  template <class Action>
  auto explain_share(const Action &action);

  const FrameInputs &inputs_;
  EnginePool &engines_;
  const unsigned shared_by_;
  const bool needs_mesh_;
  const qses_settings settings_;
  std::vector<float> xyz_;  // of the frame
  KeptMesh mesh_;           // of the frame, if it is needed
};

// The first line of the table.
std::string csv_header(const Options &options);

}  // namespace quickses::cli
