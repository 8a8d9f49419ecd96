// SPDX-License-Identifier: MIT
// The surface of one frame after the other, with a context of its own.
#include "cli/frame_worker.h"

#include <cstdio>

#include "cli/clock.h"
#include "cli/exit_code.h"
#include "cli/mesh_output.h"
#include "cli/report.h"
#include "io/radii.h"

namespace quickses::cli {

const char kCsvHeader[] = "frame,area,volume,components,cavities,cavity_volume,time_ps,error\n";

namespace {

// A text as one field of a CSV file.
std::string csv_field(const std::string &text) {
  std::string field = "\"";
  for (char c : text) {
    if (c == '"') field += '"';
    field += c == '\n' || c == '\r' ? ' ' : c;
  }
  return field + '"';
}

std::string csv_row(uint64_t frame, std::optional<double> time, const qses_report &report, const qses_mesh &mesh) {
  uint32_t cavities = 0;
  double cavity_volume = 0;
  for (uint32_t k = 0; k < mesh.component_count; ++k)
    if (mesh.components[k].is_cavity) {
      ++cavities;
      cavity_volume -= mesh.components[k].volume;
    }
  char row[256];
  std::snprintf(row, sizeof row, "%llu,%.4f,%.4f,%u,%u,%.4f,", static_cast<unsigned long long>(frame), report.area,
                report.volume, mesh.component_count, cavities, cavity_volume);
  char time_text[32] = "";
  if (time) std::snprintf(time_text, sizeof time_text, "%.3f", *time);
  return std::string(row) + time_text + ",\n";
}

void check_atom_counts(const Options &options, const io::Structure &structure, const io::Trajectory &trajectory) {
  if (structure.file_atom_count == trajectory.atom_count()) return;
  throw Failure(kInputUnreadable, "'" + options.input + "' has " + std::to_string(structure.file_atom_count) +
                                      " atoms, but '" + options.trajectory + "' has " +
                                      std::to_string(trajectory.atom_count()) + ": they must be of the same atoms");
}

// Molecules as they are bonded in the first frame.
io::Unwrapper make_unwrapper(const io::Structure &structure, const io::Trajectory &trajectory) {
  std::vector<float> xyz(3 * trajectory.atom_count());
  trajectory.read_frame(0, xyz.data());
  return io::Unwrapper(structure.file_elements.data(), xyz.data(), trajectory.atom_count(), trajectory.box(0));
}

}  // namespace

FrameInputs::FrameInputs(const Options &given, bool quiet)
    : options(given),
      file(load(options.input, options.read, options.compute, quiet)),
      trajectory(io::Trajectory::open(options.trajectory)) {
  if (io::has_own_radii(file.format)) options.compute.radii = "file";
  check_atom_counts(options, structure(), trajectory);
  for (const io::AtomInfo &atom : structure().atoms) file_indices.push_back(atom.file_index);
  if (!options.output.empty()) pattern.emplace(options.output);
  if (!quiet)
    for (const std::string &warning : trajectory.warnings())
      std::fprintf(stderr, "quickses: warning: %s\n", warning.c_str());
  if (!options.unwrap) return;
  if (trajectory.box(0))
    unwrapper = make_unwrapper(structure(), trajectory);
  else if (!quiet)
    std::fprintf(stderr, "quickses: warning: --unwrap: '%s': %s\n", options.trajectory.c_str(),
                 io::unwrap_sentence(io::UnwrapStatus::kNoBox));
}

FrameWorker::FrameWorker(const FrameInputs &inputs, const ComputeOptions &compute, unsigned shared_by)
    : inputs_(inputs),
      engine_(compute),
      shared_by_(shared_by),
      xyz_(3 * inputs.trajectory.atom_count()),
      settings_(settings_of(compute)) {
  settings_.components = !inputs.options.csv.empty() || !inputs.options.json.empty();
  settings_.hard_edges = has_hard_edges(inputs.options);
  engine_.set_atoms(inputs.structure(), inputs.options.input);
  if (!inputs.options.json.empty()) qses_set_stage_times(engine_.context(), 1);
}

FrameResult FrameWorker::run(const FrameTask &task) {
  FrameResult result;
  result.place = task.place;
  result.frame = task.frame;
  try {
    fill(task, result);
  } catch (...) {
    const Options &options = inputs_.options;
    result.error = failure_of(std::current_exception()).what();
    result.csv = std::to_string(task.frame) + ",,,,,,," + csv_field(result.error) + "\n";
    if (!options.json.empty())
      result.json =
          dump(Json{{"frame", task.frame}, {"trajectory", options.trajectory}, {"error", result.error}}, true);
  }
  return result;
}

qses_mesh FrameWorker::compute() {
  try {
    return engine_.compute(settings_);
  } catch (const Failure &failure) {
    if (shared_by_ < 2 || inputs_.options.compute.memory == 0) throw;
    throw Failure(failure.code(), std::string(failure.what()) + " (--memory is shared by " +
                                      std::to_string(shared_by_) + " frames in flight: --workers 1 leaves all to one)");
  }
}

void FrameWorker::fill(const FrameTask &task, FrameResult &result) {
  const Options &options = inputs_.options;
  const io::Trajectory &trajectory = inputs_.trajectory;
  const auto read_start = Clock::now();
  trajectory.read_frame(task.frame, xyz_.data());
  const std::optional<double> time = trajectory.time(task.frame);
  if (inputs_.unwrapper) inputs_.unwrapper->apply(trajectory.box(task.frame), xyz_.data());
  Timings timings;
  timings.read = ms_since(read_start);

  engine_.set_frame(xyz_.data(), trajectory.atom_count(), inputs_.file_indices);
  const qses_mesh mesh = compute();
  const qses_report report = engine_.report();
  Options frame_options = options;
  if (inputs_.pattern) frame_options.output = inputs_.pattern->name(task.frame);
  const auto write_start = Clock::now();
  accept_surface(frame_options.output, mesh, inputs_.structure());
  timings.write = ms_since(write_start);
  if (options.csv.empty() && options.json.empty()) return;
  if (!options.csv.empty()) result.csv = csv_row(task.frame, time, report, mesh);
  if (options.json.empty()) return;
  Json json = {{"frame", task.frame}, {"trajectory", options.trajectory}};
  json["time_ps"] = time ? Json(*time) : Json();
  json.update(surface_json(frame_options, inputs_.structure(), engine_, mesh, report, timings, nullptr));
  result.json = dump(json, true);
}

}  // namespace quickses::cli
