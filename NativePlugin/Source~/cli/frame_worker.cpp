// SPDX-License-Identifier: MIT
// From a frame of a trajectory to its result.
#include "cli/frame_worker.h"

#include <algorithm>

#include "cli/clock.h"
#include "cli/csv.h"
#include "cli/exit_code.h"
#include "cli/measuring.h"
#include "cli/report.h"
#include "cli/shown_output.h"
#include "cli/tell.h"
#include "io/error.h"
#include "io/text.h"

namespace quickses::cli {

namespace {

std::string csv_row(uint64_t frame, std::optional<double> time, const qses_report &report, const qses_mesh &mesh) {
  uint32_t cavities = 0;
  double cavity_volume = 0;
  for (uint32_t k = 0; k < mesh.component_count; ++k)
    if (mesh.components[k].is_cavity) {
      ++cavities;
      cavity_volume -= mesh.components[k].volume;
    }
  return std::to_string(frame) + "," + csv_number(report.area, 4) + "," + csv_number(report.volume, 4) + "," +
         std::to_string(mesh.component_count) + "," + std::to_string(cavities) + "," + csv_number(cavity_volume, 4) +
         "," + (time ? csv_number(*time, 3) : "") + ",\n";
}

// "frame 7, 14.00 ps", in a page
std::string label_of(uint64_t frame, std::optional<double> time) {
  return "frame " + std::to_string(frame) + (time ? ", " + csv_number(*time, 2) + " ps" : "");
}

void check_atom_counts(const Options &options, const io::Structure &structure, const io::Trajectory &trajectory) {
  if (structure.file_atom_count == trajectory.atom_count()) return;
  throw Failure(kInputUnreadable, "'" + options.input + "' has " + io::counted(structure.file_atom_count, "atom") +
                                      ", but '" + options.trajectories.front() + "' has " +
                                      std::to_string(trajectory.atom_count()) + ": they must be of the same atoms");
}

void unwrap(const Options &options, const io::Structure &structure, bool quiet, io::Trajectory &trajectory) {
  try {
    if (!trajectory.unwrap(structure.file_elements.data()) && !quiet)
      tell("warning: --unwrap: no frame of " + options.quoted_trajectories() +
           " has a periodic box: all stay as they are");
  } catch (const io::Error &error) {
    throw io::Error(error.kind(), std::string("--unwrap: ") + error.what());
  }
}

// For tables the numbers do. With CUDA nothing then leaves the device but these; on the CPU the mesh lies where it can
// be looked at anyway.
bool needs_mesh(const Options &options, qses_backend backend) {
  return backend == QSES_BACKEND_CPU || !options.output.empty() || !options.json.empty();
}

qses_settings frame_settings(const Options &options, bool needs_mesh) {
  qses_settings settings = mesh_settings_of(options);
  if (!needs_mesh) settings.delivery = QSES_DELIVERY_NONE;
  return settings;
}

}  // namespace

std::string csv_header(const Options &options) {
  if (options.command == Options::Command::kMeasure) return measurement_csv_header(options.measured);
  return "frame,area,volume,components,cavities,cavity_volume,time_ps,error\n";
}

FrameInputs::FrameInputs(const Options &given, bool quiet)
    : Input(given, quiet),
      trajectory(io::Trajectory::open_all(options.trajectories)),
      mesh_output(options, structure()) {
  check_atom_counts(options, structure(), trajectory);
  for (const io::AtomInfo &atom : structure().atoms) file_indices.push_back(atom.file_index);
  if (!options.output.empty() && !makes_page(options)) pattern.emplace(options.output);
  if (!quiet)
    for (const std::string &warning : trajectory.warnings()) tell("warning: " + warning);
  if (options.unwrap) unwrap(options, structure(), quiet, trajectory);
}

std::vector<float> FrameInputs::centers(const std::vector<float> &xyz) const {
  std::vector<float> centers;
  for (const uint32_t index : file_indices)
    for (size_t axis = 0; axis < 3; ++axis) centers.push_back(xyz[3 * size_t(index) + axis]);
  return centers;
}

void prepare_engine(Engine &engine, const FrameInputs &inputs) {
  engine.set_atoms(inputs.structure(), inputs.options.input);
  if (!inputs.options.json.empty()) qses_set_stage_times(engine.context(), 1);
}

FrameWorker::FrameWorker(const FrameInputs &inputs, EnginePool &engines, qses_backend backend, unsigned shared_by)
    : inputs_(inputs),
      engines_(engines),
      shared_by_(shared_by),
      needs_mesh_(needs_mesh(inputs.options, backend)),
      settings_(frame_settings(inputs.options, needs_mesh_)),
      xyz_(3 * inputs.trajectory.atom_count()) {}

render::Camera FrameWorker::camera(const FrameTask &task) {
  read(task);
  render::Camera camera;
  if (!inputs_.mesh_output.camera_needs_mesh()) return inputs_.mesh_output.camera_for(centers().data(), nullptr);
  engines_.run([&](Engine &engine) {
    set_frame(engine);
    const qses_mesh mesh = engine.compute(settings_);
    camera = inputs_.mesh_output.camera_for(centers().data(), &mesh);
  });
  return camera;
}

FrameResult FrameWorker::run(const FrameTask &task) {
  FrameResult result;
  result.place = task.place;
  result.frame = task.frame;
  try {
    const Read frame = read(task);
    if (inputs_.options.command == Options::Command::kMeasure)
      fill_measurement(task, frame, result);
    else
      fill_mesh(task, frame, result);
  } catch (...) {
    const Options &options = inputs_.options;
    result.error = failure_of(std::current_exception()).what();
    const std::string header = csv_header(options);
    const auto commas = static_cast<size_t>(std::count(header.begin(), header.end(), ','));
    result.csv = std::to_string(task.frame) + std::string(commas, ',') + csv_field(result.error) + "\n";
    result.per_atom = result.per_residue = result.page = "";
    if (!options.json.empty())
      result.json = dump(
          Json{
              {"schema", kReportSchema}, {"frame", task.frame}, {"trajectory", file_of(task)}, {"error", result.error}},
          true);
  }
  mesh_.clear();
  return result;
}

// Runs something that computes.
template <class Action>
auto FrameWorker::explain_share(const Action &action) {
  try {
    return action();
  } catch (const Failure &failure) {
    if (shared_by_ < 2 || inputs_.options.compute.memory == 0) throw;
    throw Failure(failure.code(), std::string(failure.what()) + " (--memory is shared by " +
                                      std::to_string(shared_by_) + " frames in flight: --workers 1 leaves all to one)");
  }
}

FrameWorker::Read FrameWorker::read(const FrameTask &task) {
  const io::Trajectory &trajectory = inputs_.trajectory;
  Read read;
  const auto start = Clock::now();
  if (!trajectory.read_frame(task.frame, xyz_.data()) && trajectory.is_unwrapped())
    throw io::Error(io::ErrorKind::kInput, "--unwrap: '" + file_of(task) + "': this frame has no periodic box");
  read.time = trajectory.time(task.frame);
  read.timings.read = ms_since(start);
  return read;
}

const std::string &FrameWorker::file_of(const FrameTask &task) const { return inputs_.trajectory.file_of(task.frame); }

void FrameWorker::set_frame(Engine &engine) const {
  engine.set_frame(xyz_.data(), inputs_.trajectory.atom_count(), inputs_.file_indices);
}

std::vector<float> FrameWorker::centers() const {
  return inputs_.mesh_output.needs_centers() ? inputs_.centers(xyz_) : std::vector<float>();
}

Json FrameWorker::frame_json(const FrameTask &task, std::optional<double> time) const {
  Json json = {{"schema", kReportSchema}, {"frame", task.frame}, {"trajectory", file_of(task)}};
  json["time_ps"] = time ? Json(*time) : Json();
  return json;
}

void FrameWorker::add_areas(const std::vector<AtomAreas> &areas, FrameResult &result) const {
  AreaRows rows = make_area_rows(inputs_.options, std::to_string(result.frame), inputs_.structure(), areas);
  result.per_atom = std::move(rows.per_atom);
  result.per_residue = std::move(rows.per_residue);
}

void FrameWorker::fill_measurement(const FrameTask &task, const Read &read, FrameResult &result) {
  const Options &options = inputs_.options;
  Measurement found;
  const Engine *measured_by = nullptr;
  engines_.run([&](Engine &engine) {
    set_frame(engine);
    found = explain_share([&] { return measure_surfaces(engine, options); });
    measured_by = &engine;
  });
  if (!options.csv.empty()) result.csv = measurement_csv_row(task.frame, read.time, found);
  add_areas(found.areas, result);
  if (options.json.empty()) return;
  Json json = frame_json(task, read.time);
  json.update(measurement_json(options, inputs_.structure(), *measured_by, found, read.timings));
  result.json = dump(json, true);
}

void FrameWorker::fill_mesh(const FrameTask &task, Read read, FrameResult &result) {
  const Options &options = inputs_.options;
  qses_mesh mesh;
  qses_report report;
  std::vector<AtomAreas> areas;
  const Engine *computed_by = nullptr;
  engines_.run([&](Engine &engine) {
    set_frame(engine);
    mesh = explain_share([&] { return engine.compute(settings_); });
    report = engine.report();
    if (!options.csv.empty()) result.csv = csv_row(task.frame, read.time, report, mesh);
    areas = areas_of(options.compute.surface, mesh);
    if (needs_mesh_) engine.keep(mesh_);
    computed_by = &engine;
  });
  add_areas(areas, result);
  if (!needs_mesh_) return;
  mesh = mesh_.view();
  Options frame_options = options;
  if (inputs_.pattern) frame_options.output = inputs_.pattern->name(task.frame);
  const auto write_start = Clock::now();
  const MeshOutput &output = inputs_.mesh_output;
  const MeshSize written = makes_page(options)
                               ? output.page_mesh(mesh, centers().data(), label_of(task.frame, read.time), &result.page)
                               : output.accept(frame_options.output, mesh, centers().data());
  read.timings.write = ms_since(write_start);
  if (options.json.empty()) return;
  Json json = frame_json(task, read.time);
  json.update(surface_json(frame_options, inputs_.structure(), *computed_by, mesh, written, report, read.timings));
  result.json = dump(json, true);
}

}  // namespace quickses::cli
