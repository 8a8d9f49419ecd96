// SPDX-License-Identifier: MIT
// The whole order on one page: atoms -> neighbour grid -> solvent features -> bricks -> field -> marching cubes ->
// projection -> relaxation -> measures and components. A template over the executor: cpu_engine.cpp and cuda_engine.cu
// make one of each.
#pragma once

#include "surface/stages/atoms.h"
#include "surface/methods/exact_surface.h"
#include "surface/methods/grid_surface.h"
#include "surface/levels.h"
#include "surface/stages/measure.h"
#include "surface/memory/memory_plan.h"
#include "surface/memory/mesh_memory.h"
#include "surface/memory/size_check.h"
#include "surface/memory/size_estimate.h"
#include "surface/stages/visible_mask.h"

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
  SurfacePipeline(uint64_t memory_budget, uint64_t memory_limit, Arguments &&...arguments)
      : executor_(std::forward<Arguments>(arguments)...),
        timer_(executor_),
        memory_(executor_),
        budget_(memory_budget),
        limit_(memory_limit) {
    // What is held outside of the arena is taken off; the least budget is one that is surely too small.
    const uint64_t beside = memory_.allowed_beside(executor_);
    if (memory_budget > 0) executor_.arena().set_budget(memory_budget > beside + 4096 ? memory_budget - beside : 4096);
  }

  std::shared_ptr<AtomSet> make_atoms(size_t count) override { return memory_.make_atoms(count); }

  void compute(const AtomSet &atoms, const Appearance &appearance, const qses_settings &settings,
               Span<const float> spacings, LevelSink &sink) override {
    const typename Executor::CallScope scope(executor_);
    const typename Executor::StopScope stop(executor_, sink.stop_flag());
    executor_.arena().reset();
    executor_.arena().set_limit(limit_);
    progress_.restart(sink);
    progress_.enter(0.0, 0.0);
    timer_.reset();
    facts_ = {};
    try {
      compute_levels(atoms, appearance, settings, spacings, sink);
    } catch (const MemoryRefused &) {
      name_smallest_budget(settings);
      throw;
    }
  }

  qses_size_estimate estimate(const AtomSet &atoms, const Appearance &appearance, const qses_settings &settings,
                              const std::atomic<bool> &stop) override {
    const typename Executor::CallScope scope(executor_);
    const typename Executor::StopScope stop_scope(executor_, stop);
    progress_.rest();
    executor_.arena().set_limit(limit_);
    qses_size_estimate out;
    qses_size_estimate_init(&out);
    out.fits = 1;
    if (atoms.count == 0) return out;
    for (;;) {
      executor_.arena().reset();
      timer_.reset();
      facts_ = {};
      try {
        estimate_with(atoms, appearance, settings, &out);
        break;
      } catch (const MemoryRefused &) {
        if (!become_frugal(atoms, settings)) {
          name_smallest_budget(settings);
          throw;
        }
      }
    }
    executor_.arena().reset();
    return out;
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
    AppearanceView appearance{};
    MeshShape shape{};
  };

  void estimate_with(const AtomSet &atoms, const Appearance &appearance, const qses_settings &settings,
                     qses_size_estimate *out) {
    const auto &arena = executor_.arena();
    Prepared p = prepare(atoms, appearance, settings, Span<const float>{&settings.spacing, 1});
    const double kept = static_cast<double>(arena.used()), peak = static_cast<double>(arena.peak());
    p = at_spacing(p, settings.spacing);
    auto run = run_of(p, settings, nullptr);
    facts_.size = estimate_size(run);
    if (settings.method == QSES_METHOD_EXACT) facts_.caps = count_kept_caps(run);
    const MemoryPlan<Executor> plan(facts_, kind_of(p, settings));
    const double whole = plan.whole(kept, peak), least = plan.least(), room = static_cast<double>(arena.budget());
    out->vertices = static_cast<uint64_t>(facts_.size.vertices);
    out->triangles = static_cast<uint64_t>(facts_.size.triangles);
    out->mesh_bytes = static_cast<uint64_t>(plan.mesh_bytes());
    out->work_bytes = work_bytes(static_cast<uint64_t>(room > 0 && whole > room ? std::max(least, room) : whole));
    out->smallest_budget = smallest_budget(least);
    out->fits = budget_ == 0 || out->smallest_budget <= budget_ ? 1 : 0;
  }

  // The arena's least bytes, and what is allowed beside it.
  uint64_t smallest_budget(double least) const {
    return static_cast<uint64_t>(least) + memory_.allowed_beside(executor_);
  }

  // Memory was refused: whether it can be tried again with less for the features. Later computations know.
  bool become_frugal(const AtomSet &atoms, const qses_settings &settings) {
    if (frugal(atoms.count) || settings.method == QSES_METHOD_GRID) return false;
    frugal_from_ = atoms.count;
    return true;
  }

  void compute_levels(const AtomSet &atoms, const Appearance &appearance, const qses_settings &settings,
                      Span<const float> spacings, LevelSink &sink) {
    double total = 0, begun = 0;
    for (float h : spacings) total += work_of(h);
    auto start = std::chrono::steady_clock::now();
    Prepared prepared;
    const auto start_mark = executor_.arena().mark();
    if (atoms.count > 0) prepared = prepare_again(atoms, appearance, settings, spacings);
    sink.prepared(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    auto mark = executor_.arena().mark();
    for (float h : spacings) {
      progress_.enter(begun / total, (begun + work_of(h)) / total);
      progress_.report(0.0);
      begun += work_of(h);
      qses_report report;
      qses_report_init(&report);
      memory_.use_slot(sink.slot());
      MeshMemoryView built{};
      if (atoms.count > 0) {
        try {
          built = build(prepared, settings, h, &report);
        } catch (const MemoryRefused &) {
          // The features may have taken more than they must.
          if (!become_frugal(atoms, settings)) throw;
          executor_.arena().rewind(start_mark);
          prepared = prepare(atoms, appearance, settings, spacings);
          mark = executor_.arena().mark();
          built = build(prepared, settings, h, &report);
        }
      }
      timer_.begin("mesh_memory");
      qses_mesh mesh;
      memory_.finish(built, settings, &mesh);
      timer_.end();
      mesh.spacing = h;
      const auto now = std::chrono::steady_clock::now();
      report.compute_ms = std::chrono::duration<double, std::milli>(now - start).count();
      start = now;
      complete(built, &report);
      timer_.reset();
      executor_.arena().rewind(mark);
      progress_.report(1.0);
      sink.finished(mesh, report);
    }
  }

  // The work of a level grows with the number of its lattice points at the surface.
  static double work_of(float spacing) { return 1.0 / (static_cast<double>(spacing) * static_cast<double>(spacing)); }

  Run<Executor, Timer> run_of(const Prepared &p, const qses_settings &settings, qses_report *report) {
    return {executor_,
            timer_,
            memory_,
            progress_,
            table(),
            settings,
            p.parameters,
            p.frame,
            p.low,
            p.high,
            p.grid,
            p.features,
            p.appearance,
            p.shape,
            p.appearance.visible ? MeshPurpose::kWork : MeshPurpose::kDelivered,
            frugal(p.grid.count),
            report,
            &facts_};
  }

  // Something the host has per atom, where the back end reads it.
  template <class T>
  const T *bring(const T *host, size_t n) {
    if (n == 0 || !Executor::kIsCuda) return n ? host : nullptr;
    Span<T> copy = executor_.template allocate<T>(n);
    executor_.upload(copy.data, host, n);
    return copy.data;
  }

  Prepared prepare(const AtomSet &set, const Appearance &appearance, const qses_settings &settings,
                   Span<const float> spacings) {
    Prepared p;
    p.shape = shape_of(settings, !appearance.colors.empty());
    const bool vdw = settings.surface == QSES_SURFACE_VDW ||
                     (settings.surface == QSES_SURFACE_SES && settings.method == QSES_METHOD_EXACT &&
                      settings.probe_radius < kSmallestProbe);
    p.parameters.probe = vdw ? 0.f : settings.probe_radius;
    p.parameters.depth = settings.surface == QSES_SURFACE_SES && !vdw ? p.parameters.probe : 0.f;
    p.parameters.spacing = spacings[spacings.size - 1];
    p.parameters.max_radius = set.bounds.max_radius + p.parameters.probe;

    timer_.begin("neighbor_grid");
    p.frame = center_lattice(set.bounds, frame_spacing(levels_of(settings)));
    p.low = to_centered(p.frame, set.bounds.low);
    p.high = to_centered(p.frame, set.bounds.high);
    p.appearance = {bring(appearance.visible.data(), appearance.visible.size()),
                    bring(appearance.colors.data(), appearance.colors.size()),
                    bring(appearance.texcoords.data(), appearance.texcoords.size())};
    const CellLayout cells = layout_cells(p.low, p.high, std::max(p.parameters.max_radius, kSmallestCell));
    facts_.atoms = set.count;
    facts_.atom_cells = dense_table_pays(cells.cells(), set.count) ? cells.cells() : 0;
    prepared_ = p;
    is_prepared_ = false;
    p.grid = build_neighbor_grid(executor_, set.count, cells, [&] {
      Span<Sphere> atoms = executor_.template allocate<Sphere>(set.count);
      const Sphere *const given = bring(set.atoms, set.count);
      executor_.for_each(set.count, CenterAtoms{given, p.frame.center_x, p.frame.center_y, p.frame.center_z,
                                                p.parameters.probe, atoms.data});
      return atoms;
    });
    remove_swallowed_atoms(executor_, p.grid, p.parameters.max_radius);
    if (settings.method == QSES_METHOD_EXACT) {
      auto run = run_of(p, settings, nullptr);
      p.features = find_features(run);
    }
    prepared_ = p;
    is_prepared_ = true;
    prepared_mark_ = executor_.arena().mark();
    return p;
  }

  // The same; once more with less memory if that was refused.
  Prepared prepare_again(const AtomSet &set, const Appearance &appearance, const qses_settings &settings,
                         Span<const float> spacings) {
    const auto start = executor_.arena().mark();
    try {
      return prepare(set, appearance, settings, spacings);
    } catch (const MemoryRefused &) {
      if (!become_frugal(set, settings)) throw;
    }
    executor_.arena().rewind(start);
    return prepare(set, appearance, settings, spacings);
  }

  // With so many atoms memory was too short for the fast way before.
  bool frugal(size_t atoms) const { return atoms >= frugal_from_; }

  static Prepared at_spacing(Prepared p, float spacing) {
    p.parameters.spacing = p.frame.spacing = spacing;
    p.features.parameters = p.parameters;
    p.frame = layout_lattice(p.frame, p.low, p.high, p.parameters.max_radius);
    return p;
  }

  static WorkKind kind_of(const Prepared &p, const qses_settings &settings) {
    WorkKind kind;
    kind.exact = settings.method == QSES_METHOD_EXACT;
    kind.masked = p.appearance.visible != nullptr;
    kind.components = settings.components != 0;
    kind.relaxation_steps = settings.relaxation_steps;
    kind.shape = p.shape;
    kind.parameters = p.parameters;
    return kind;
  }

  // Before time is spent on a spacing that is hopelessly fine.
  void check_spacing(const Prepared &p, Run<Executor, Timer> &run) {
    if (run.parameters.spacing >= kCheckedSpacing || run.settings.method == QSES_METHOD_GRID) return;
    const SurfaceSize predicted = predict_size(run);
    WorkFacts facts = facts_;
    facts.size = predicted;
    const MemoryPlan<Executor> plan(facts, kind_of(p, run.settings));
    const auto &arena = executor_.arena();
    if (arena.has_budget() && plan.least() > kMemoryCertainty * static_cast<double>(arena.budget()))
      throw MemoryRefused("the spacing is too fine for the memory budget");
    refuse_hopeless_spacing(static_cast<double>(run.parameters.spacing), predicted,
                            plan.whole(0, 0) + (Executor::kIsCuda ? 0 : plan.mesh_bytes()),
                            arena.has_budget() ? 0.0 : static_cast<double>(arena.limit()));
  }

  // Memory was refused. With a budget the user is told which one would do, as far as that is known by now.
  void name_smallest_budget(const qses_settings &settings) {
    if (budget_ == 0) return;
    if (is_prepared_ && facts_.size.vertices == 0) {
      executor_.arena().rewind(prepared_mark_);
      try {
        auto run = run_of(at_spacing(prepared_, prepared_.parameters.spacing), settings, nullptr);
        facts_.size = estimate_size(run);
        if (settings.method == QSES_METHOD_EXACT) facts_.caps = count_kept_caps(run);
      } catch (const MemoryRefused &) {  // then it is guessed
      }
    }
    const uint64_t budget = smallest_budget(least_of_unfinished<Executor>(
        facts_, kind_of(prepared_, settings),
        prepared_.parameters.spacing > 0.f
            ? static_cast<double>(at_spacing(prepared_, prepared_.parameters.spacing).frame.table_size())
            : 0.0));
    throw Error(QSES_OUT_OF_MEMORY,
                "the memory budget of " + describe_bytes(budget_) + " does not suffice for this surface: about " +
                    describe_bytes(std::max(budget, budget_ + budget_ / 8)) + " would do, or a larger spacing");
  }

  MeshMemoryView build(const Prepared &prepared, const qses_settings &settings, float spacing, qses_report *report) {
    const Prepared p = prepared_ = at_spacing(prepared, spacing);
    auto run = run_of(p, settings, report);
    check_spacing(p, run);
    MeshMemoryView mesh = settings.method == QSES_METHOD_GRID ? build_grid_surface(run) : build_exact_surface(run);
    timer_.begin("measure");
    const MeshCounts counts{mesh.vertices, mesh.triangles};
    if (settings.measure) {
      const Measures m = measure(executor_, mesh.view, counts, mesh.unplaced, &report->unplaced_vertices);
      report->area = m.area;
      report->volume = m.volume;
      mesh.bounds = m.bounds;
    } else {
      mesh.bounds = find_bounds(executor_, mesh.view, counts, mesh.unplaced, &report->unplaced_vertices);
    }
    if (settings.components) {
      timer_.begin("components");
      memory_.find_components(executor_, spacing, run.purpose, &mesh);
    }
    if (!p.appearance.visible || mesh.vertices == 0) return mesh;
    timer_.begin("visible_mask");
    const Span<const qses_component> components = mesh.components;
    mesh = drop_hidden(run, mesh);
    mesh.components = components;
    mesh.bounds = find_bounds(executor_, mesh.view, MeshCounts{mesh.vertices, mesh.triangles});
    return mesh;
  }

  // Memory and times of the level that is just finished.
  void complete(const MeshMemoryView &mesh, qses_report *report) {
    report->work_bytes_peak = work_bytes(executor_.arena().peak());
    report->mesh_bytes = mesh.bytes;
    report->host_bytes_peak = memory_.host_bytes() + (Executor::kIsCuda ? 0 : report->work_bytes_peak);
    for (const auto &stage : timer_.collect()) {
      if (report->stage_count == QSES_MAX_STAGES) break;
      qses_stage_time &out = report->stages[report->stage_count++];
      std::snprintf(out.name, sizeof out.name, "%s", stage.first);
      out.milliseconds = stage.second;
    }
  }

  // The tables of marching cubes, uploaded once.
  TableView table() {
    if (!table_.triangle_count) table_ = memory_.upload_table(executor_, marching_cubes_table());
    return table_;
  }

  // Bytes of the arena and of the work that lies beside it.
  uint64_t work_bytes(uint64_t arena) const { return arena + memory_.beside_arena(executor_); }

  Executor executor_;
  Timer timer_;
  MeshMemory<Executor> memory_;
  uint64_t budget_, limit_;
  WorkFacts facts_{};
  size_t frugal_from_ = ~size_t(0);
  // Of the computation that runs, for messages.
  Prepared prepared_{};
  bool is_prepared_ = false;
  typename std::decay_t<decltype(std::declval<Executor &>().arena())>::Mark prepared_mark_{};
  Progress progress_;
  TableView table_{};
};

}  // namespace quickses
