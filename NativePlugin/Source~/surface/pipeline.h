// SPDX-License-Identifier: MIT
// The whole order on one page: atoms -> neighbour grid -> solvent features -> bricks -> field -> marching cubes ->
// projection -> relaxation -> measures. A template over the executor: cpu_engine.cpp and cuda_engine.cu make one of
// each.
#pragma once

#include "surface/atoms.h"
#include "surface/exact_surface.h"
#include "surface/grid_surface.h"
#include "surface/measure.h"
#include "surface/mesh_memory.h"

#include <algorithm>
#include <cstdio>

namespace quickses {

// Below this probe radius the solvent-excluded surface is the van der Waals surface within rounding.
constexpr float kSmallestProbe = 0.05f;

// Cells of the neighbour grid are at least this large, in Å, however small the atoms: their number must stay countable.
constexpr float kSmallestCell = 1.f;

template <class Executor, class Timer>
class SurfacePipeline : public SurfaceEngine {
 public:
  template <class... Arguments>
  explicit SurfacePipeline(uint64_t memory_budget, Arguments &&...arguments)
      : executor_(std::forward<Arguments>(arguments)...), timer_(executor_), memory_(executor_) {
    executor_.arena().set_budget(memory_budget);
  }

  std::shared_ptr<AtomSet> make_atoms(size_t count) override { return memory_.make_atoms(count); }

  void compute(const AtomSet &atoms, const qses_settings &settings, const std::vector<float> &spacings,
               LevelSink &sink) override {
    const typename Executor::CallScope scope(executor_);
    const typename Executor::StopScope stop(executor_, sink.stop_flag());
    executor_.arena().reset();
    progress_.restart(sink);
    progress_.enter(0.0, 0.0);
    double total = 0;
    for (float h : spacings) total += work_of(h);
    double begun = 0;
    auto start = std::chrono::steady_clock::now();
    timer_.reset();
    Prepared prepared;
    if (atoms.count > 0) prepared = prepare(atoms, settings, spacings);
    const auto mark = executor_.arena().mark();
    for (float h : spacings) {
      progress_.enter(begun / total, (begun + work_of(h)) / total);
      progress_.report(0.0);
      begun += work_of(h);
      qses_report report;
      qses_report_init(&report);
      memory_.use_slot(sink.slot());
      const MeshMemoryView built = atoms.count > 0 ? build(prepared, settings, h, &report) : MeshMemoryView{};
      timer_.begin("download");
      qses_mesh mesh;
      memory_.finish(built, settings, &mesh);
      timer_.end();
      mesh.spacing = h;
      const auto now = std::chrono::steady_clock::now();
      report.compute_ms = std::chrono::duration<double, std::milli>(now - start).count();
      start = now;
      complete(mesh, &report);
      timer_.reset();
      executor_.arena().rewind(mark);
      progress_.report(1.0);
      sink.finished(mesh, report);
    }
  }

  void enable_stage_times(bool enabled) override { timer_.enable(enabled); }
  void set_progress(std::function<void(double)> progress) override { progress_.set(std::move(progress)); }

 private:
  // What all levels of a frame share, in the arena.
  struct Prepared {
    SurfaceParameters parameters{};  // spacing is the level's
    Lattice frame{};                 // where the centred frame is
    glm::vec3 low{0.f}, high{0.f};   // of the atoms' centres, in it
    NeighborGridView grid{};
    FeatureView features{};
  };

  // The work of a level grows with the number of its lattice points at the surface.
  static double work_of(float spacing) { return 1.0 / (static_cast<double>(spacing) * static_cast<double>(spacing)); }

  // All levels have their lattices anchored to the global origin if their spacings are whole multiples of each other;
  // else only the finest has.
  static float frame_spacing(const std::vector<float> &spacings) {
    for (float h : spacings) {
      const float ratio = spacings.front() / h;
      if (std::fabs(ratio - std::round(ratio)) > 1e-6f * ratio) return spacings.back();
    }
    return spacings.front();
  }

  Run<Executor, Timer> run_of(const Prepared &p, const qses_settings &settings, qses_report *report) {
    return {executor_, timer_, memory_, progress_, table(),    settings, p.parameters,
            p.frame,   p.low,  p.high,  p.grid,    p.features, report};
  }

  Prepared prepare(const AtomSet &set, const qses_settings &settings, const std::vector<float> &spacings) {
    Prepared p;
    const bool vdw = settings.surface == QSES_SURFACE_VDW ||
                     (settings.surface == QSES_SURFACE_SES && settings.method == QSES_METHOD_EXACT &&
                      settings.probe_radius < kSmallestProbe);
    p.parameters.probe = vdw ? 0.f : settings.probe_radius;
    p.parameters.depth = settings.surface == QSES_SURFACE_SES && !vdw ? p.parameters.probe : 0.f;
    p.parameters.spacing = spacings.back();
    p.parameters.max_radius = set.bounds.max_radius + p.parameters.probe;

    timer_.begin("neighbor_grid");
    p.frame = center_lattice(set.bounds, frame_spacing(spacings));
    p.low = to_centered(p.frame, set.bounds.low);
    p.high = to_centered(p.frame, set.bounds.high);
    Span<Sphere> atoms = executor_.template allocate<Sphere>(set.count);
    {
      Span<Sphere> given = executor_.template allocate<Sphere>(set.count);
      executor_.upload(given.data, set.atoms, set.count);
      executor_.for_each(set.count, CenterAtoms{given.data, p.frame.center_x, p.frame.center_y, p.frame.center_z,
                                                p.parameters.probe, atoms.data});
    }
    p.grid = build_neighbor_grid(executor_, atoms,
                                 layout_cells(p.low, p.high, std::max(p.parameters.max_radius, kSmallestCell)));
    remove_swallowed_atoms(executor_, p.grid, p.parameters.max_radius);
    if (settings.method == QSES_METHOD_EXACT) {
      auto run = run_of(p, settings, nullptr);
      p.features = find_features(run);
    }
    return p;
  }

  MeshMemoryView build(Prepared p, const qses_settings &settings, float spacing, qses_report *report) {
    p.parameters.spacing = p.frame.spacing = spacing;
    p.features.parameters = p.parameters;
    p.frame = layout_lattice(p.frame, p.low, p.high, p.parameters.max_radius);
    auto run = run_of(p, settings, report);
    MeshMemoryView mesh = settings.method == QSES_METHOD_GRID ? build_grid_surface(run) : build_exact_surface(run);
    timer_.begin("measure");
    const MeshCounts counts{mesh.vertices, mesh.triangles};
    if (settings.measure) {
      const Measures m = measure(executor_, mesh.view, counts);
      report->area = m.area;
      report->volume = m.volume;
      mesh.bounds = m.bounds;
    } else {
      mesh.bounds = find_bounds(executor_, mesh.view, counts);
    }
    return mesh;
  }

  // Memory and times of the level that is just finished.
  void complete(const qses_mesh &mesh, qses_report *report) {
    report->work_bytes_peak = executor_.arena().peak();
    report->mesh_bytes = memory_.mesh_bytes(mesh);
    report->host_bytes_peak = memory_.host_bytes() + (Executor::kIsCuda ? 0 : executor_.arena().peak());
    for (const auto &stage : timer_.collect()) {
      if (report->stage_count == QSES_MAX_STAGES) break;
      qses_stage_time &out = report->stages[report->stage_count++];
      std::snprintf(out.name, sizeof out.name, "%s", stage.first.c_str());
      out.milliseconds = stage.second;
    }
  }

  // The tables of marching cubes, uploaded once.
  TableView table() {
    if (!table_.triangle_count) table_ = memory_.upload_table(executor_, marching_cubes_table());
    return table_;
  }

  Executor executor_;
  Timer timer_;
  MeshMemory<Executor> memory_;
  Progress progress_;
  TableView table_{};
};

}  // namespace quickses
