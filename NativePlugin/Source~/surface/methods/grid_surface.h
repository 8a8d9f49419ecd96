// SPDX-License-Identifier: MIT
// The voxel method from the neighbour grid to the mesh, in the paper's order: bricks, classes, distance refinement,
// marching cubes, welded by numbering, Laplacian smoothing.
#pragma once

#include "surface/methods/closed_layout.h"
#include "surface/methods/grid_ses.h"
#include "surface/memory/mesh_memory.h"
#include "surface/stages/relaxation.h"
#include "surface/methods/level_work.h"

namespace quickses {

template <class R>
MeshMemoryView build_grid_surface(R &run) {
  auto &executor = run.executor;
  run.memory.forget_spills();
  run.timer.begin("bricks");
  const GridParameters parameters =
      make_grid_parameters(run.parameters.probe, run.parameters.spacing, run.parameters.max_radius);
  BrickSet bricks = find_grid_bricks(executor, run.atoms, parameters, run.lattice);
  run.progress.report(0.1);

  const auto per_slice = [&] {
    return Slicing{false, bricks_per_slice(run.settings, bricks.count, run.progress.wanted())};
  };
  GridField field{};
  MeshLayout layout{};
  const MeshCounts counts = lay_out_closed_mesh(run, &bricks, &layout, [&](const BrickSet &set, uint64_t *signs) {
    run.timer.begin("grid_ses");
    field = classify_grid_points(executor, run.atoms, parameters, set);
    run.report->slice_count = for_each_slice(run, set.count, per_slice(), 0.1, 0.5, [&](BrickRange slice) {
      evaluate_grid_signs(executor, field, slice, signs);
    });
  });
  const MeshMemoryView mesh =
      run.memory.allocate_mesh(executor, counts.vertices, counts.triangles, run.shape, run.purpose,
                               counts.vertices * sizeof(RingSum) + executor.arena().available() / 64);
  const auto end_of_mesh = executor.arena().mark();
  run.timer.begin("projection");
  for_each_slice(run, bricks.count, per_slice(), 0.5, 0.8,
                 [&](BrickRange slice) { emit_grid_vertices(executor, field, layout, slice, mesh.view); });
  run.timer.begin("marching_cubes");
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
