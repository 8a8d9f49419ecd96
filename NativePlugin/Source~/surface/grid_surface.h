// SPDX-License-Identifier: MIT
// The voxel method from the neighbour grid to the mesh, in the paper's order: bricks, classes, distance refinement,
// marching cubes, welded by numbering, Laplacian smoothing.
#pragma once

#include "surface/grid_ses.h"
#include "surface/mesh_memory.h"
#include "surface/relaxation.h"
#include "surface/run.h"

namespace quickses {

template <class R>
MeshMemoryView build_grid_surface(R &run) {
  auto &executor = run.executor;
  run.memory.forget_spills();
  run.timer.begin("bricks");
  const GridParameters parameters =
      make_grid_parameters(run.parameters.probe, run.parameters.spacing, run.parameters.max_radius);
  const BrickSet bricks = find_grid_bricks(executor, run.atoms, parameters, run.lattice);
  run.report->brick_count = bricks.count;
  run.progress.report(0.1);

  run.timer.begin("grid_ses");
  const GridField field = classify_grid_points(executor, run.atoms, parameters, bricks);
  const Slicing per_slice{false, bricks_per_slice(run.settings, bricks.count, run.progress.wanted())};
  Span<uint64_t> signs = executor.template allocate<uint64_t>(size_t(bricks.count) * kLeavesPerBrick);
  run.report->slice_count = for_each_slice(run, bricks.count, per_slice, 0.1, 0.5, [&](BrickRange slice) {
    evaluate_grid_signs(executor, field, slice, signs.data);
  });

  run.timer.begin("marching_cubes");
  MeshLayout layout{};
  const MeshCounts counts = lay_out_mesh(executor, bricks, signs.data, run.table.triangle_count, &layout);
  check_mesh_size(counts);
  run.facts->brick_entries = bricks.table ? run.lattice.table_size() : 0;
  run.facts->size = {static_cast<double>(bricks.count), static_cast<double>(counts.vertices),
                     static_cast<double>(counts.triangles), static_cast<double>(layout.leaf_total)};
  const MeshMemoryView mesh =
      run.memory.allocate_mesh(executor, counts.vertices, counts.triangles, run.shape, run.purpose,
                               counts.vertices * sizeof(RingSum) + executor.arena().available() / 64);
  const auto end_of_mesh = executor.arena().mark();
  run.timer.begin("projection");
  for_each_slice(run, bricks.count, per_slice, 0.5, 0.8,
                 [&](BrickRange slice) { emit_grid_vertices(executor, field, layout, slice, mesh.view); });
  run.timer.begin("triangles");
  emit_triangles(executor, bricks, layout, BrickRange{0, bricks.count}, run.table, mesh.view);
  run.progress.report(0.85);

  run.timer.begin("relaxation");
  Span<RingSum> sums = run.memory.template allocate_beside<RingSum>(executor, mesh, counts.vertices);
  smooth_laplacian(executor, mesh.view, counts, run.parameters.spacing, run.settings.relaxation_steps, sums);
  compute_normals(executor, mesh.view, counts, run.parameters.spacing, sums);
  paint_vertices(executor, run.appearance, mesh.view, mesh.vertices);
  executor.arena().rewind(end_of_mesh);
  return mesh;
}

}  // namespace quickses
