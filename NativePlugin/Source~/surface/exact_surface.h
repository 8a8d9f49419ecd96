// SPDX-License-Identifier: MIT
// The exact method from the neighbour grid to the mesh: features, bricks, signs, counts, vertices, triangles.
#pragma once

#include "surface/mesh_memory.h"
#include "surface/relaxation.h"
#include "surface/run.h"
#include "surface/size_check.h"

namespace quickses {

template <class Executor>
void remove_swallowed_atoms(Executor &executor, const NeighborGridView &atoms, float max_radius) {
  Span<uint8_t> swallowed = executor.template allocate<uint8_t>(atoms.count);
  executor.for_each(atoms.count, FindSwallowedAtoms{atoms, max_radius, swallowed.data});
  executor.for_each(atoms.count, RemoveSwallowedAtoms{swallowed.data, const_cast<Sphere *>(atoms.items)});
}

// Features of the atoms, with the arcs in a grid of their own. They serve every spacing.
template <class R>
FeatureView find_features(R &run) {
  auto &executor = run.executor;
  run.timer.begin("solvent_features");
  const SolventFeatures found = find_solvent_features(executor, run.atoms, run.parameters);
  run.timer.begin("arc_grid");
  FeatureView f{};
  f.atoms = run.atoms;
  f.cap_ranges = found.cap_ranges.data;
  f.caps = found.caps.data;
  f.exposed = found.exposed.data;
  f.parameters = run.parameters;
  f.max_arc_bound = kMaxArcBound + 1e-3f;
  const size_t n = found.arcs.size;
  if (n > 0) {
    Span<Sphere> bounds = executor.template allocate<Sphere>(n);
    executor.for_each(n, BoundArcs{found.arcs.data, bounds.data});
    const glm::vec3 reach(run.parameters.max_radius);
    f.arc_bounds = build_neighbor_grid(executor, bounds, layout_cells(run.low - reach, run.high + reach, kArcCellEdge));
    Span<Arc> sorted = executor.template allocate<Arc>(n);
    executor.for_each(n, GatherArcs{found.arcs.data, f.arc_bounds.order, sorted.data});
    f.arcs = sorted.data;
  }
  return f;
}

template <class R>
MeshMemoryView build_exact_surface(R &run) {
  auto &executor = run.executor;
  using Executor = std::remove_reference_t<decltype(executor)>;
  const FeatureView &features = run.features;
  refuse_hopeless_spacing(run, features, executor.arena().budget());

  run.timer.begin("bricks");
  const BrickSet bricks = find_bricks(executor, features, run.lattice);
  run.report->brick_count = bricks.count;
  run.progress.report(0.1);

  // Signs of all bricks first, slice by slice: numbers are global before anything is emitted.
  const uint32_t per_slice = std::min(CandidatesOf<Executor>::max_bricks(executor, bricks.count),
                                      bricks_per_slice(run.settings, bricks.count, run.progress.wanted()));
  const bool one_slice = per_slice >= bricks.count;
  run.report->slice_count = bricks.count ? (bricks.count + per_slice - 1) / per_slice : 0;
  run.timer.begin("exact_ses");
  Span<uint64_t> signs = executor.template allocate<uint64_t>(size_t(bricks.count) * kLeavesPerBrick);
  Candidates<Executor> shared{};
  for_each_slice(run, bricks.count, per_slice, 0.1, 0.45, [&](BrickRange slice) {
    Candidates<Executor> own{};
    evaluate_signs(executor, features, bricks, slice, one_slice ? shared : own, signs.data);
  });

  run.timer.begin("marching_cubes");
  MeshLayout layout{};
  const MeshCounts counts = lay_out_mesh(executor, bricks, signs.data, run.table.triangle_count, &layout);
  check_mesh_size(counts);

  // With several slices the candidates of a slice are gathered again.
  MeshMemoryView mesh = run.memory.allocate_mesh(executor, counts.vertices, counts.triangles, run.settings);
  VertexStarts starts{run.settings.relaxation_steps > 0, nullptr, run.table.ring};
  const auto emit = [&](double begin, double end) {
    for_each_slice(run, bricks.count, per_slice, begin, end, [&](BrickRange slice) {
      Candidates<Executor> own{};
      if (!one_slice && CandidatesOf<Executor>::kFromSigns)
        evaluate_signs(executor, features, bricks, slice, own, signs.data);
      emit_vertices(executor, features, bricks, layout, slice, one_slice ? shared : own, starts, mesh.view);
    });
  };
  run.timer.begin("projection");
  emit(0.45, 0.8);
  run.timer.begin("triangles");
  emit_triangles(executor, bricks, layout, BrickRange{0, bricks.count}, run.table, mesh.view);
  run.progress.report(0.85);

  // Steps 2 and on: tangential, each projected again.
  run.timer.begin("relaxation");
  for (uint32_t step = 1; step < run.settings.relaxation_steps; ++step) {
    const auto mark = executor.arena().mark();
    Span<glm::vec3> moved = executor.template allocate<glm::vec3>(mesh.vertices);
    tangential_starts(executor, bricks, layout, mesh.view, counts, moved.data);
    starts.moved = moved.data;
    const double share = 0.15 / run.settings.relaxation_steps;
    emit(0.85 + share * (step - 1), 0.85 + share * step);
    executor.arena().rewind(mark);
  }
  return mesh;
}

}  // namespace quickses
