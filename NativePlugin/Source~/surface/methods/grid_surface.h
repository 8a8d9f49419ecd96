// SPDX-License-Identifier: MIT
// The voxel method from the neighbour grid to the mesh, in the paper's order: bricks, classes, distance refinement,
// marching cubes, welded by numbering, Laplacian smoothing.
#pragma once

#include "surface/methods/closed_layout.h"
#include "surface/methods/grid_owners.h"
#include "surface/methods/grid_ses.h"
#include "surface/stages/relaxation.h"

namespace quickses {

template <class Work>
MeshMemoryView build_grid_surface(Work &work) {
  auto &executor = work.executor;
  work.memory.forget_spills();
  work.timer.begin("bricks");
  const GridParameters parameters =
      make_grid_parameters(work.parameters.probe, work.parameters.spacing, work.parameters.max_radius);
  BrickSet bricks =
      collect_ball_bricks(executor, work.atoms, parameters.max_radius, work.lattice, &work.facts->brick_visits);
  note_bricks(work, bricks);
  work.progress.report(0.1);

  // Slices take no memory here, but the caller can follow them.
  const auto slice_size = [&] { return asked_slice(work.settings, bricks.count, work.progress.wanted()); };
  GridField field{};
  MeshLayout layout{};
  const MeshCounts counts = lay_out_closed_mesh(work, &bricks, &layout, [&](const BrickSet &set, uint64_t *signs) {
    work.timer.begin("grid_ses");
    field = classify_grid_points(executor, work.atoms, parameters, set);
    work.report->slice_count = for_each_slice(work, set.count, slice_size(), 0.1, 0.5, [&](BrickRange slice) {
      evaluate_grid_signs(executor, field, slice, signs);
    });
  });
  MeshMemoryView mesh = begin_mesh(work, counts);
  const auto end_of_mesh = executor.arena().mark();
  work.timer.begin("marching_cubes");
  emit_all_triangles(work, bricks, layout, mesh);
  work.timer.begin("projection");
  for_each_slice(work, bricks.count, slice_size(), 0.5, 0.8,
                 [&](BrickRange slice) { emit_grid_vertices(executor, field, layout, slice, mesh.view); });
  find_grid_owners(executor, field, mesh.view, counts.vertices);
  work.progress.report(0.85);

  work.timer.begin("relaxation");
  Span<RingSum> sums = work.memory.template allocate_where_mesh_is<RingSum>(executor, mesh, counts.vertices);
  smooth_laplacian(executor, mesh.view, counts, work.parameters.spacing, work.settings.relaxation_steps, sums);
  compute_normals(executor, mesh.view, counts, work.parameters.spacing, sums);
  executor.arena().rewind(end_of_mesh);
  return mesh;
}

}  // namespace quickses
