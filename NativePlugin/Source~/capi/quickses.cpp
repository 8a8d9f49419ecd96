// SPDX-License-Identifier: MIT
// The C API: handles and the exception barrier, nothing else.
#include "quickses/quickses.h"

#include "capi/atoms_in.h"
#include "capi/backends.h"
#include "capi/barrier.h"
#include "capi/context.h"
#include "capi/structs.h"
#include "process/stay_loaded.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using quickses::check_atom_count;
using quickses::check_choice;
using quickses::check_struct;
using quickses::guarded;
using quickses::invalid;
using quickses::number_text;
using quickses::read_struct;
using quickses::require;
using quickses::write_struct;

namespace {

// Names are made only where they are told: frames allocate nothing.
struct LevelName {
  uint32_t level;
  explicit operator std::string() const { return "settings.levels[" + std::to_string(level) + "]"; }
};

template <class Name>
void check_range(const Name &name, double value, double low, double high, const char *unit) {
  if (value >= low && value <= high) return;
  invalid(std::string(name) + " is " + number_text(value) + ": it must lie between " + number_text(low) + " and " +
          number_text(high) + unit);
}

void check_settings(const qses_settings &s) {
  check_choice("settings.surface", s.surface, QSES_SURFACE_GAUSSIAN);
  check_choice("settings.method", s.method, QSES_METHOD_GRID);
  check_choice("settings.winding", s.winding, QSES_WINDING_REVERSED);
  check_choice("settings.vertex_layout", s.vertex_layout, QSES_VERTICES_COMPACT);
  check_choice("settings.delivery", s.delivery, QSES_DELIVERY_NONE);
  check_range("settings.spacing", static_cast<double>(s.spacing), 0.001, 100, " Å");
  check_range("settings.probe_radius", static_cast<double>(s.probe_radius), 0, 100, " Å");
  check_range("settings.relaxation_steps", s.relaxation_steps, 0, 100, "");
  if (s.slice_size != 0) check_range("settings.slice_size", s.slice_size, 8, 4294967295.0, " lattice points, or 0");
  if (s.level_count > QSES_MAX_LEVELS)
    invalid("settings.level_count is " + std::to_string(s.level_count) + ": at most " +
            std::to_string(QSES_MAX_LEVELS));
  for (uint32_t k = 0; k < s.level_count; ++k) {
    const double level = static_cast<double>(s.levels[k]);
    check_range(LevelName{k}, level, 0.001, 100, " Å");
    if (k > 0 && !(s.levels[k] < s.levels[k - 1]))
      invalid(std::string(LevelName{k}) + " is " + number_text(level) + ": it must be below " +
              std::string(LevelName{k - 1}) + ", which is " + number_text(static_cast<double>(s.levels[k - 1])));
  }
  check_range("settings.frame_budget_ms", static_cast<double>(s.frame_budget_ms), 0, 60000, " ms");
  check_range("settings.show_ms_per_mb", static_cast<double>(s.show_ms_per_mb), 0, 60000, " ms");
  check_range("settings.gaussian_radius_scale", static_cast<double>(s.gaussian_radius_scale), 0.05f, 10, "");
  check_range("settings.gaussian_isovalue", static_cast<double>(s.gaussian_isovalue), 0.01f, 1000, "");
  if (s.surface == QSES_SURFACE_GAUSSIAN && (s.patch_types || s.creases || s.hard_edges))
    invalid("settings.patch_types, creases and hard_edges are not available with surface GAUSSIAN");
  if (s.method == QSES_METHOD_GRID && s.surface != QSES_SURFACE_SES)
    invalid("settings.method GRID makes the solvent-excluded surface only: use EXACT for the others");
  if (s.method == QSES_METHOD_GRID && s.patch_types) invalid("settings.patch_types is not available with method GRID");
  if (s.method == QSES_METHOD_GRID && s.creases) invalid("settings.creases is not available with method GRID");
  if (s.method == QSES_METHOD_GRID && s.atom_areas) invalid("settings.atom_areas is not available with method GRID");
}

void check_backend(const qses_backend &backend) { check_choice("backend", backend, QSES_BACKEND_CPU); }

// The back end to use for what was asked; fills the description and, for AUTO, why it is not CUDA.
qses_backend choose_backend(qses_backend asked, int device, qses_backend_description *description) {
  if (asked != QSES_BACKEND_CPU) {
    *description = quickses::describe_backend(QSES_BACKEND_CUDA, device);
    if (description->available || asked == QSES_BACKEND_CUDA) return QSES_BACKEND_CUDA;
  }
  const qses_backend_description cuda = *description;
  *description = quickses::describe_backend(QSES_BACKEND_CPU, 0);
  if (asked == QSES_BACKEND_AUTO) std::memcpy(description->reason, cuda.reason, sizeof cuda.reason);
  return QSES_BACKEND_CPU;
}

#if defined(QUICKSES_HAS_CUDA)
void begin_on_gpu(qses_context &context, const qses_context_options &options, const quickses::WorkerThreads &threads) {
  context.job = std::make_unique<quickses::SurfaceJob>(
      quickses::make_cuda_engine(options.device, threads, options.memory_budget), threads.in_background);
  context.copy_threads = std::make_unique<quickses::CpuThreads>(
      std::min(quickses::CpuThreads(threads).count(), quickses::kMostCopyThreads));
  // Another context may have been loading the kernels when this one looked.
  context.description.preparing = 0;
  context.description.reason[0] = 0;
}
#endif

// The engine and the threads of a context, whose back end is chosen.
void begin(qses_context &context, const qses_context_options &options) {
  const quickses::WorkerThreads threads(options.threads, options.background != 0);
#if defined(QUICKSES_HAS_CUDA)
  if (context.backend == QSES_BACKEND_CUDA) {
    try {
      return begin_on_gpu(context, options, threads);
    } catch (const quickses::Error &error) {  // others may have all of its memory
      if (options.backend != QSES_BACKEND_AUTO) throw;
      context.backend = choose_backend(QSES_BACKEND_CPU, 0, &context.description);
      std::snprintf(context.description.reason, sizeof context.description.reason, "%s", error.what());
    }
  }
#endif
  context.job = std::make_unique<quickses::SurfaceJob>(quickses::make_cpu_engine(threads, options.memory_budget),
                                                       threads.in_background);
  quickses::name_cpu(quickses::CpuThreads(threads).at_a_time(), &context.description);
}

// A new set of as many atoms, of the radii of the one before.
// copy_into(atoms) fills them in, and returns their box.
template <class CopyInto>
std::shared_ptr<quickses::AtomSet> next_frame(const qses_context &context, const CopyInto &copy_into) {
  const quickses::AtomSet &before = *context.atoms;
  std::shared_ptr<quickses::AtomSet> set = context.job->engine().make_atoms(before.count);
  set->bounds = copy_into(set->atoms);
  set->bounds.radii = before.bounds.radii;
  return set;
}

constexpr const char *kNothingComputed = "nothing has been computed yet, or it was kept (qses_keep)";

const quickses::FinishedMesh &held_mesh(const qses_context &context) {
  const quickses::FinishedMesh *const held = context.job->held();
  if (!held) throw quickses::Error(QSES_NO_RESULT, kNothingComputed);
  return *held;
}

// What to compute: one level for qses_compute, the ladder for qses_begin.
quickses::SurfaceRequest make_request(const qses_context &context, const qses_settings &settings, bool ladder,
                                      const char *function) {
  check_settings(settings);
  if (quickses::is_for_device(settings.delivery) && context.backend != QSES_BACKEND_CUDA)
    invalid("settings.delivery asks for a mesh on the device, but this context computes on the CPU");
  quickses::require_atoms(context, function);
  quickses::SurfaceRequest request;
  request.atoms = context.atoms;
  request.appearance = context.appearance;
  request.settings = settings;
  if (ladder) {
    request.ladder = quickses::levels_of(settings);
    request.frame_budget_ms = static_cast<double>(settings.frame_budget_ms);
  } else {
    request.ladder.add(settings.spacing);
  }
  return request;
}

}  // namespace

extern "C" {

const char *qses_version(void) { return QUICKSES_VERSION; }

uint32_t qses_abi_version(void) { return QSES_ABI_VERSION; }

const char *qses_last_error(void) { return quickses::last_error_message(); }

qses_status qses_backend_info(qses_backend backend, qses_backend_description *description) {
  return guarded([&] {
    require(description, "description");
    check_backend(backend);
    qses_backend_description d{};
    choose_backend(backend, 0, &d);
    write_struct(description, d, "qses_backend_description");
  });
}

qses_status qses_device_count(uint32_t *count) {
  return guarded([&] {
    require(count, "count");
    *count = quickses::count_devices();
  });
}

qses_status qses_context_create(const qses_context_options *options, qses_context **context) {
  if (context) *context = nullptr;
  return guarded([&] {
    require(context, "context");
    const qses_context_options o = read_struct(options, qses_context_options_init, "qses_context_options");
    check_backend(o.backend);
    if (o.threads > 4096) invalid("options.threads is " + std::to_string(o.threads) + ": at most 4096");
    quickses::stay_loaded();  // contexts leave threads behind
    auto made = std::make_unique<qses_context>();
    made->backend = choose_backend(o.backend, o.device, &made->description);
    if (!made->description.available)
      throw quickses::Error(QSES_BACKEND_UNAVAILABLE, std::string("CUDA can't be used: ") + made->description.reason);
    begin(*made, o);
    *context = made.release();
  });
}

void qses_context_destroy(qses_context *context) {
  guarded([&] { delete context; });
}

qses_status qses_context_info(const qses_context *context, qses_backend *backend,
                              qses_backend_description *description) {
  return guarded([&] {
    require(context, "context");
    if (backend) *backend = context->backend;
    if (description) write_struct(description, context->description, "qses_backend_description");
  });
}

qses_status qses_set_atoms(qses_context *context, const float *positions, size_t stride, const float *radii,
                           size_t count) {
  return guarded([&] {
    require(context, "context");
    quickses::check_layout(positions, stride, count);
    const std::shared_ptr<quickses::AtomSet> set = context->job->engine().make_atoms(count);
    const quickses::AtomRadii all_radii = quickses::check_radii(radii, count);
    std::vector<float> kept_radii(radii, radii + count);
    set->bounds = quickses::copy_atoms(positions, stride, radii, count, set->atoms, context->copy_threads.get());
    set->bounds.radii = all_radii;
    if (!context->atoms || context->atoms->count != count)
      context->appearance = std::make_shared<quickses::Appearance>();
    context->atoms = set;
    context->radii.swap(kept_radii);
  });
}

qses_status qses_set_positions(qses_context *context, const float *positions, size_t stride, size_t count) {
  return guarded([&] {
    require(context, "context");
    check_atom_count(*context, count, "qses_set_positions");
    quickses::check_layout(positions, stride, count);
    context->atoms = next_frame(*context, [&](quickses::Sphere *atoms) {
      return quickses::copy_atoms(positions, stride, context->radii.data(), count, atoms, context->copy_threads.get());
    });
  });
}

qses_status qses_set_positions_indexed(qses_context *context, const float *positions, size_t stride,
                                       size_t position_count, const uint32_t *indices, size_t count) {
  return guarded([&] {
    require(context, "context");
    check_atom_count(*context, count, "qses_set_positions_indexed");
    quickses::check_layout(positions, stride, position_count, "position_count");
    quickses::check_indices(indices, count, position_count);
    context->atoms = next_frame(*context, [&](quickses::Sphere *atoms) {
      return quickses::copy_indexed_atoms(positions, stride, indices, context->radii.data(), count, atoms,
                                          context->copy_threads.get());
    });
  });
}

qses_status qses_compute(qses_context *context, const qses_settings *settings, qses_mesh *mesh) {
  return guarded([&] {
    require(context, "context");
    if (mesh) check_struct(mesh, "qses_mesh");  // before the last mesh is replaced
    const qses_settings s = read_struct(settings, qses_settings_init, "qses_settings");
    context->job->compute(make_request(*context, s, false, "qses_compute"));
    if (mesh) write_struct(mesh, held_mesh(*context).on_host, "qses_mesh");
  });
}

qses_status qses_context_mesh(const qses_context *context, qses_mesh *mesh) {
  return guarded([&] {
    require(context, "context");
    require(mesh, "mesh");
    write_struct(mesh, held_mesh(*context).on_host, "qses_mesh");
  });
}

qses_status qses_context_report(const qses_context *context, qses_report *report) {
  return guarded([&] {
    require(context, "context");
    require(report, "report");
    write_struct(report, held_mesh(*context).report, "qses_report");
  });
}

qses_status qses_estimate(qses_context *context, const qses_settings *settings, qses_size_estimate *estimate) {
  return guarded([&] {
    require(context, "context");
    require(estimate, "estimate");
    check_struct(estimate, "qses_size_estimate");  // before it waits for a job
    const qses_settings s = read_struct(settings, qses_settings_init, "qses_settings");
    write_struct(estimate, context->job->estimate(make_request(*context, s, false, "qses_estimate")),
                 "qses_size_estimate");
  });
}

qses_status qses_begin(qses_context *context, const qses_settings *settings) {
  return guarded([&] {
    require(context, "context");
    const qses_settings s = read_struct(settings, qses_settings_init, "qses_settings");
    context->job->begin(make_request(*context, s, true, "qses_begin"));
  });
}

qses_status qses_poll(const qses_context *context, qses_progress *progress) {
  return guarded([&] {
    require(context, "context");
    require(progress, "progress");
    write_struct(progress, context->job->progress(), "qses_progress");
  });
}

qses_status qses_collect(qses_context *context, qses_mesh *mesh) {
  bool found = false;
  const qses_status status = guarded([&] {
    require(context, "context");
    require(mesh, "mesh");
    check_struct(mesh, "qses_mesh");
    found = context->job->collect();
    if (found) write_struct(mesh, held_mesh(*context).on_host, "qses_mesh");
  });
  // Callers ask in every frame: an exception would be too dear an answer.
  if (status == QSES_OK && !found)
    return quickses::fail(QSES_NOTHING_NEW, "no level has been finished since the last qses_collect");
  return status;
}

qses_status qses_collect_device(qses_context *context, qses_device_mesh *mesh) {
  return guarded([&] {
    require(context, "context");
    require(mesh, "mesh");
    check_struct(mesh, "qses_device_mesh");
    qses_device_mesh collected;
    if (!context->job->collect_on_device(&collected)) throw quickses::Error(QSES_NO_RESULT, kNothingComputed);
    quickses::write_device_mesh(mesh, collected);
  });
}

qses_status qses_cancel(qses_context *context) {
  return guarded([&] {
    require(context, "context");
    context->job->cancel();
  });
}

qses_status qses_wait(qses_context *context, double milliseconds, qses_bool *finished) {
  return guarded([&] {
    require(context, "context");
    if (std::isnan(milliseconds)) invalid("milliseconds is no number");
    const bool done = context->job->wait(milliseconds);
    if (finished) *finished = done ? 1 : 0;
  });
}

qses_status qses_set_stage_times(qses_context *context, qses_bool enabled) {
  return guarded([&] {
    require(context, "context");
    context->job->wait(-1.0);
    context->job->engine().enable_stage_times(enabled != 0);
  });
}

qses_status qses_set_progress_callback(qses_context *context, qses_progress_callback callback, void *user_data) {
  return guarded([&] {
    require(context, "context");
    context->job->wait(-1.0);
    if (callback)
      context->job->engine().set_progress([callback, user_data](double fraction) { callback(user_data, fraction); });
    else
      context->job->engine().set_progress({});
  });
}

}  // extern "C"
