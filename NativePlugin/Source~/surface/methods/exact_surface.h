// SPDX-License-Identifier: MIT
// The exact method from the neighbour grid to the mesh: features, bricks, signs, counts, vertices, triangles.
#pragma once

#include "surface/methods/closed_layout.h"
#include "surface/memory/mesh_memory.h"
#include "surface/stages/relaxation.h"
#include "surface/methods/level_work.h"

namespace quickses {

template <class Executor>
void remove_swallowed_atoms(Executor &executor, const NeighborGridView &atoms, float max_radius) {
  const auto mark = executor.arena().mark();
  Span<uint8_t> swallowed = executor.template allocate<uint8_t>(atoms.count);
  executor.for_each(atoms.count, FindSwallowedAtoms{atoms, max_radius, swallowed.data});
  executor.for_each(atoms.count, RemoveSwallowedAtoms{swallowed.data, const_cast<Sphere *>(atoms.items)});
  executor.arena().rewind(mark);
}

// Features of the atoms, with the arcs in a grid of their own. They serve every spacing.
template <class R>
FeatureView find_features(R &run) {
  auto &executor = run.executor;
  run.timer.begin("solvent_features");
  SolventFeatures found;
  const auto note = [&] {
    run.facts->caps = found.caps.size;
    run.facts->arcs = found.arcs.size;
  };
  try {
    find_solvent_features(executor, run.atoms, run.parameters, run.frugal, &found);
  } catch (const MemoryRefused &) {
    note();
    throw;
  }
  note();
  FeatureView f{};
  f.atoms = run.atoms;
  f.cap_ranges = found.cap_ranges.data;
  f.caps = found.caps.data;
  f.exposed = found.exposed.data;
  f.parameters = run.parameters;
  f.max_arc_bound = kMaxArcBound + 1e-3f;
  const size_t n = found.arcs.size;
  if (n > 0) {
    const glm::vec3 reach(run.parameters.max_radius);
    const CellLayout cells = layout_cells(run.low - reach, run.high + reach, kArcCellEdge);
    run.facts->arc_cells = dense_table_pays(cells.cells(), n) ? cells.cells() : 0;
    f.arc_bounds = build_neighbor_grid(executor, n, cells, [&] {
      Span<Sphere> bounds = executor.template allocate<Sphere>(n);
      executor.for_each(n, BoundArcs{found.arcs.data, bounds.data});
      return bounds;
    });
    const auto mark = executor.arena().mark();
    Span<Arc> sorted = executor.template allocate<Arc>(n);
    executor.for_each(n, GatherArcs{found.arcs.data, f.arc_bounds.order, sorted.data});
    if (run.frugal || executor.arena().has_budget()) {
      executor.for_each(n, CopyArcs{sorted.data, found.arcs.data});
      executor.arena().rewind(mark);
      f.arcs = found.arcs.data;
    } else {
      f.arcs = sorted.data;
    }
  }
  return f;
}

template <class R>
CandidateCounts candidate_counts(const R &run) {
  return {static_cast<double>(run.features.atoms.count), static_cast<double>(run.features.arc_bounds.count)};
}

// Bytes of work per brick while vertices are emitted: candidates, rows, and per vertex the lists of the kernels and,
// where the mesh is not on the device, its slab.
template <class R>
uint64_t emission_bytes_per_brick(const R &run, const SurfaceSize &size, bool slabs) {
  using Executor = std::remove_reference_t<decltype(run.executor)>;
  const double n = std::max(1.0, size.bricks), vertices = size.vertices / n, triangles = size.triangles / n;
  const double vertex_bytes = static_cast<double>(MeshArrays(4096, 0, run.shape).bytes()) / 4096.0;
  return static_cast<uint64_t>(
             CandidatesOf<Executor>::emission_bytes(run.parameters, candidate_counts(run), vertices, size.leaves / n) +
             (slabs ? vertex_bytes * vertices + 12.0 * triangles : 0.0)) +
         1;
}

// Bricks whose work fits into what is left, a bit being kept back: bricks differ.
template <class R>
uint32_t bricks_that_fit(const R &run, uint32_t brick_count, uint64_t bytes_per_brick) {
  const uint64_t fitting = run.executor.arena().available() / 8 * 7 / std::max<uint64_t>(1, bytes_per_brick);
  return static_cast<uint32_t>(std::min<uint64_t>(brick_count, std::max<uint64_t>(kLeastSlice, fitting)));
}

// The part of a mesh that a slice of bricks owns.
struct MeshPart {
  MeshView view;
  size_t vertices, triangles;
};

// A slab on the device for a mesh that is on the host. Waits.
template <class R>
MeshPart open_slab(R &run, const MeshLayout &layout, BrickRange slice) {
  const uint32_t *const sources[4] = {layout.vertex_base + slice.first, layout.vertex_base + slice.last,
                                      layout.triangle_base + slice.first, layout.triangle_base + slice.last};
  uint32_t base[4];
  run.executor.fetch_each(sources, base, 4);
  MeshPart part{{}, size_t(base[1] - base[0]), size_t(base[3] - base[2])};
  const MeshArrays arrays(part.vertices, part.triangles, run.shape);
  part.view = arrays.view(run.executor.template allocate<char>(arrays.bytes()).data);
  part.view.first_vertex = base[0];
  part.view.first_triangle = base[2];
  return part;
}

// Signs of all bricks first, slice by slice: numbers are global before anything is emitted. `together`: all bricks at
// once, and what signs and vertices share is kept.
template <class R>
MeshMemoryView make_exact_mesh(R &run, BrickSet bricks, bool together) {
  auto &executor = run.executor;
  using Executor = std::remove_reference_t<decltype(executor)>;
  const FeatureView &features = run.features;
  run.memory.forget_spills();
  const auto per_slice = [&](uint64_t bytes_per_brick) {
    const uint32_t asked = bricks_per_slice(run.settings, bricks.count, run.progress.wanted());
    return Slicing{together, std::min(asked, bricks_that_fit(run, bricks.count, bytes_per_brick))};
  };
  Candidates<Executor> shared{};
  MeshLayout layout{};
  const MeshCounts counts = lay_out_closed_mesh(run, &bricks, &layout, [&](const BrickSet &set, uint64_t *signs) {
    run.timer.begin("exact_ses");
    shared = {};
    for_each_slice(run, set.count, per_slice(CandidatesOf<Executor>::sign_bytes(run.parameters, candidate_counts(run))),
                   0.1, 0.45, [&](BrickRange slice) {
                     Candidates<Executor> own{};
                     evaluate_signs(executor, features, set, slice, together ? shared : own, signs);
                   });
  });

  const uint64_t work = emission_bytes_per_brick(run, run.facts->size, false);
  MeshMemoryView mesh =
      run.memory.allocate_mesh(executor, counts.vertices, counts.triangles, run.shape, run.purpose,
                               work * (together ? bricks.count : std::min(bricks.count, kRoomySlice)));
  if (mesh.on_host && together && bricks.count > 0) throw MemoryRefused("the mesh does not fit beside the work");
  const auto end_of_mesh = executor.arena().mark();
  VertexStarts starts{run.settings.relaxation_steps > 0, nullptr, run.table.ring, &layout.totals->unplaced};
  const auto emit = [&](double begin, double end, bool with_triangles) {
    const Slicing slicing = per_slice(mesh.on_host ? emission_bytes_per_brick(run, run.facts->size, true) : work);
    run.report->slice_count = for_each_slice(run, bricks.count, slicing, begin, end, [&](BrickRange slice) {
      Candidates<Executor> own{};  // gathered again if there are several slices
      MeshPart part{mesh.view, 0, 0};
      if (mesh.on_host) part = open_slab(run, layout, slice);
      emit_vertices(executor, features, bricks, layout, slice, together ? shared : own, starts, part.view);
      if (!mesh.on_host) return;
      paint_vertices(executor, run.appearance, part.view, part.vertices);
      if (with_triangles) emit_triangles(executor, bricks, layout, slice, run.table, part.view);
      run.memory.save(executor, mesh, part.view, part.vertices, with_triangles ? part.triangles : 0);
    });
  };
  run.timer.begin("projection");
  emit(0.45, 0.8, true);
  if (!mesh.on_host) {
    run.timer.begin("marching_cubes");
    emit_triangles(executor, bricks, layout, BrickRange{0, bricks.count}, run.table, mesh.view);
  }
  run.progress.report(0.85);

  // Steps 2 and on: tangential, each projected again.
  run.timer.begin("relaxation");
  if (run.settings.relaxation_steps > 1) {
    Span<RingSum> sums = run.memory.template allocate_beside<RingSum>(executor, mesh, counts.vertices);
    Span<glm::vec3> moved = run.memory.template allocate_beside<glm::vec3>(executor, mesh, counts.vertices);
    for (uint32_t step = 1; step < run.settings.relaxation_steps; ++step) {
      tangential_starts(executor, bricks, layout, mesh.view, counts, sums, moved.data);
      starts.moved = moved.data;
      executor.fill(Span<uint32_t>{starts.unplaced, 1}, 0);
      const double share = 0.15 / run.settings.relaxation_steps;
      emit(0.85 + share * (step - 1), 0.85 + share * step, false);
    }
  }
  if (!mesh.on_host) paint_vertices(executor, run.appearance, mesh.view, mesh.vertices);
  executor.arena().rewind(end_of_mesh);
  mesh.unplaced = starts.unplaced;
  return mesh;
}

template <class R>
MeshMemoryView build_exact_surface(R &run) {
  auto &executor = run.executor;
  using Executor = std::remove_reference_t<decltype(executor)>;
  run.timer.begin("bricks");
  const BrickSet bricks = find_bricks(executor, run.features, run.lattice);
  run.facts->size = {};
  run.facts->size.bricks = static_cast<double>(bricks.count);
  run.facts->brick_entries = bricks.table ? run.lattice.table_size() : 0;
  run.progress.report(0.1);

  // All at once is faster. If that turns out to need more memory than there is, it is done again in slices.
  const bool together =
      bricks_per_slice(run.settings, bricks.count, run.progress.wanted()) >= bricks.count &&
      bricks_that_fit(run, bricks.count, CandidatesOf<Executor>::whole_bytes(run.parameters, candidate_counts(run))) >=
          bricks.count;
  if (!together) return make_exact_mesh(run, bricks, false);
  const auto mark = executor.arena().mark();
  try {
    return make_exact_mesh(run, bricks, true);
  } catch (const MemoryRefused &) {
    if (!Executor::kIsCuda) throw;
  }
  executor.arena().rewind(mark);
  if (!executor.arena().has_budget()) executor.bound_arena();
  return make_exact_mesh(run, bricks, false);
}

}  // namespace quickses
