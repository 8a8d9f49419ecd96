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

template <class Executor, class Timer>
class SurfacePipeline : public SurfaceEngine {
 public:
  template <class... Arguments>
  explicit SurfacePipeline(uint64_t memory_budget, Arguments &&...arguments)
      : executor_(std::forward<Arguments>(arguments)...), timer_(executor_), memory_(executor_) {
    executor_.arena().set_budget(memory_budget);
    qses_mesh_init(&mesh_);
    qses_report_init(&report_);
  }

  Sphere *atom_buffer(size_t count) override { return memory_.atoms(count); }

  void set_atoms(size_t count, const AtomBounds &bounds) override {
    atom_count_ = count;
    bounds_ = bounds;
  }

  void compute(const qses_settings &settings) override {
    const typename Executor::CallScope scope(executor_);
    const auto start = std::chrono::steady_clock::now();
    executor_.arena().reset();
    timer_.reset();
    progress_.restart();
    qses_report report;
    qses_report_init(&report);
    MeshMemoryView built = atom_count_ > 0 ? build(settings, &report) : MeshMemoryView{};
    timer_.begin("download");
    memory_.finish(built, settings, &mesh_);
    timer_.end();
    report.compute_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    report.work_bytes_peak = executor_.arena().peak();
    report.mesh_bytes = memory_.mesh_bytes(mesh_);
    report.host_bytes_peak = memory_.host_bytes() + (Executor::kIsCuda ? 0 : executor_.arena().peak());
    for (const auto &stage : timer_.collect()) {
      if (report.stage_count == QSES_MAX_STAGES) break;
      qses_stage_time &out = report.stages[report.stage_count++];
      std::snprintf(out.name, sizeof out.name, "%s", stage.first.c_str());
      out.milliseconds = stage.second;
    }
    report_ = report;
    progress_.report(1.0);
  }

  const qses_mesh &mesh() const override { return mesh_; }
  const qses_report &report() const override { return report_; }
  void enable_stage_times(bool enabled) override { timer_.enable(enabled); }
  void set_progress(std::function<void(double)> progress) override { progress_.set(std::move(progress)); }

 private:
  MeshMemoryView build(const qses_settings &settings, qses_report *report) {
    SurfaceParameters parameters{};
    const bool vdw = settings.surface == QSES_SURFACE_VDW ||
                     (settings.surface == QSES_SURFACE_SES && settings.method == QSES_METHOD_EXACT &&
                      settings.probe_radius < kSmallestProbe);
    parameters.probe = vdw ? 0.f : settings.probe_radius;
    parameters.depth = settings.surface == QSES_SURFACE_SES && !vdw ? parameters.probe : 0.f;
    parameters.spacing = settings.spacing;
    parameters.max_radius = bounds_.max_radius + parameters.probe;

    timer_.begin("neighbor_grid");
    Lattice lattice = center_lattice(bounds_, settings.spacing);
    const glm::vec3 low = to_centered(lattice, bounds_.low), high = to_centered(lattice, bounds_.high);
    lattice = layout_lattice(lattice, low, high, parameters.max_radius);
    Span<Sphere> atoms = executor_.template allocate<Sphere>(atom_count_);
    {
      Span<Sphere> given = executor_.template allocate<Sphere>(atom_count_);
      executor_.upload(given.data, memory_.given_atoms(), atom_count_);
      executor_.for_each(atom_count_, CenterAtoms{given.data, lattice.center_x, lattice.center_y, lattice.center_z,
                                                  parameters.probe, atoms.data});
    }
    const NeighborGridView grid = build_neighbor_grid(executor_, atoms, layout_cells(low, high, parameters.max_radius));
    remove_swallowed_atoms(executor_, grid, parameters.max_radius);

    Run<Executor, Timer> run{executor_,  timer_,  memory_, progress_, table(), settings,
                             parameters, lattice, low,     high,      grid,    report};
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
  size_t atom_count_ = 0;
  AtomBounds bounds_{};
  qses_mesh mesh_;
  qses_report report_;
};

}  // namespace quickses
