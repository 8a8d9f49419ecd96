// SPDX-License-Identifier: MIT
// The C API for the program: handles that free themselves, statuses as exceptions.
#include "cli/engine.h"

#include "cli/exit_code.h"
#include "cli/shown_output.h"
#include "cli/tell.h"

namespace quickses::cli {
namespace {

void check(qses_status status) {
  if (status != QSES_OK) throw Failure(exit_code_of(status), qses_last_error());
}

}  // namespace

KeptMesh::KeptMesh() : kept_(nullptr, &qses_kept_mesh_destroy) {
  qses_kept_mesh *kept = nullptr;
  check(qses_kept_mesh_create(&kept));
  kept_.reset(kept);
}

qses_mesh KeptMesh::view() const {
  qses_mesh mesh;
  qses_mesh_init(&mesh);
  check(qses_kept_mesh_view(handle(), &mesh));
  return mesh;
}

Engine::Engine(const ComputeOptions &options, int device) : context_(nullptr, &qses_context_destroy) {
  qses_context_options context_options;
  qses_context_options_init(&context_options);
  context_options.backend = options.backend;
  context_options.device = device;
  context_options.threads = options.threads;
  context_options.memory_budget = options.memory;
  qses_context *context = nullptr;
  const qses_status status = qses_context_create(&context_options, &context);
  if (status != QSES_OK)
    throw Failure(exit_code_of(status),
                  std::string("--backend ") + name_of(options.backend) + ": " + qses_last_error());
  context_.reset(context);
  qses_backend_description_init(&description_);
  check(qses_context_info(context, &backend_, &description_));
}

void Engine::set_atoms(const io::Structure &structure, const std::string &path) {
  const qses_status status =
      qses_set_atoms(context(), structure.positions.data(), 0, structure.radii.data(), structure.atoms.size());
  if (status == QSES_INVALID_ARGUMENT)  // what is wrong came from the file
    throw Failure(kInputUnreadable, "'" + path + "': " + qses_last_error());
  check(status);
}

void Engine::set_frame(const float *xyz, size_t position_count, const std::vector<uint32_t> &indices) {
  check(qses_set_positions_indexed(context(), xyz, 0, position_count, indices.data(), indices.size()));
}

void Engine::set_positions(const io::Structure &structure) {
  check(qses_set_positions(context(), structure.positions.data(), 0, structure.atoms.size()));
}

qses_mesh Engine::compute(const qses_settings &settings) {
  qses_mesh mesh;
  qses_mesh_init(&mesh);
  check(qses_compute(context(), &settings, &mesh));
  return mesh;
}

qses_device_mesh Engine::collect_device() {
  qses_device_mesh mesh;
  qses_device_mesh_init(&mesh);
  check(qses_collect_device(context(), &mesh));
  return mesh;
}

qses_report Engine::report() const {
  qses_report report;
  qses_report_init(&report);
  check(qses_context_report(context(), &report));
  return report;
}

void Engine::keep(KeptMesh &kept) { check(qses_keep(context(), kept.handle())); }

void Engine::find_component_atoms(const qses_mesh &mesh, std::vector<uint32_t> *starts,
                                  std::vector<uint32_t> *atoms) const {
  starts->resize(size_t(mesh.component_count) + 1);
  check(qses_component_atoms(&mesh, starts->data(), nullptr, 0));
  atoms->resize(starts->back());
  if (!atoms->empty()) check(qses_component_atoms(&mesh, starts->data(), atoms->data(), atoms->size()));
}

qses_settings settings_of(const ComputeOptions &options) {
  qses_settings settings;
  qses_settings_init(&settings);
  settings.surface = options.surface;
  settings.method = options.method;
  settings.probe_radius = static_cast<float>(options.probe);
  settings.spacing = static_cast<float>(options.spacing);
  settings.gaussian_radius_scale = static_cast<float>(options.radius_scale);
  settings.gaussian_isovalue = static_cast<float>(options.isovalue);
  settings.relaxation_steps = options.steps;
  settings.slice_size = options.slice;
  settings.creases = options.creases == Switch::kOn;
  settings.occlusion = options.occlusion == Switch::kOn;
  return settings;
}

qses_settings mesh_settings_of(const Options &options) {
  qses_settings settings = settings_of(options.compute);
  settings.components = !options.csv.empty() || !options.json.empty();
  settings.component_ids = options.mesh.component_ids || options.mesh.colors == MeshColors::kComponent;
  settings.patch_types = needs_patches(options);
  settings.outer_only = has_outer_only(options);
  settings.hard_edges = has_hard_edges(options);
  settings.atom_areas = options.wants_areas();
  return settings;
}

std::vector<int> chosen_devices(const ComputeOptions &options, unsigned nth) {
  uint32_t count = 0;
  if (options.devices.is_given() || nth > 0) qses_device_count(&count);  // none where it fails
  return options.devices.select(count, nth);
}

Engine start_engine(const ComputeOptions &options, bool quiet) {
  return start_engine(options, chosen_devices(options, 0).front(), quiet);
}

Engine start_engine(const ComputeOptions &options, int device, bool quiet) {
  Engine engine(options, device);
#if defined(QUICKSES_HAS_CUDA)  // else there is nothing to explain
  constexpr bool has_cuda = true;
#else
  constexpr bool has_cuda = false;
#endif
  if (has_cuda && !quiet && options.backend == QSES_BACKEND_AUTO && engine.backend() == QSES_BACKEND_CPU)
    tell("the CPU computes: " + engine.why_not_cuda());
  return engine;
}

}  // namespace quickses::cli
