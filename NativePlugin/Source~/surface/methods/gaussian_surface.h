// SPDX-License-Identifier: MIT
// The Gaussian surface from the neighbour grid to the mesh: bricks, signs of the density, marching cubes, vertices
// where it has the isovalue.
#pragma once

#include "surface/methods/closed_layout.h"
#include "surface/stages/ball_points.h"

namespace quickses {

// The signs of all points. slices(work_on): calls work_on(slice) for runs of bricks.
template <class Work, class Slices>
void evaluate_density_signs(Work &work, const BrickSet &bricks, const Slices &slices, uint64_t *signs) {
  using Executor = std::remove_reference_t<decltype(work.executor)>;
  Backend<Executor>::evaluate_density(work.executor, density_of(work), bricks, slices, signs);
}

template <class Work>
MeshMemoryView build_gaussian_surface(Work &work) {
  auto &executor = work.executor;
  using Executor = std::remove_reference_t<decltype(executor)>;
  work.memory.forget_spills();
  work.timer.begin("bricks");
  BrickSet bricks =
      collect_ball_bricks(executor, work.atoms, work.parameters.max_radius, work.lattice, &work.facts->brick_visits);
  note_bricks(work, bricks);
  work.progress.report(0.1);

  // Slices take no memory here, but the caller can follow them.
  MeshLayout layout{};
  const MeshCounts counts = lay_out_closed_mesh(work, &bricks, &layout, [&](const BrickSet &set, uint64_t *signs) {
    work.timer.begin("gaussian_density");
    const auto slices = [&](const auto &work_on) {
      work.report->slice_count = for_each_slice(
          work, set.count, asked_slice(work.settings, set.count, work.progress.wanted()), 0.1, 0.6, work_on);
    };
    evaluate_density_signs(work, set, slices, signs);
  });
  MeshMemoryView mesh = begin_mesh(work, counts);
  const auto end_of_mesh = executor.arena().mark();
  work.timer.begin("marching_cubes");
  emit_all_triangles(work, bricks, layout, mesh);
  work.timer.begin("projection");
  Backend<Executor>::emit_density_vertices(executor, density_of(work), bricks, layout, mesh.view);
  work.progress.report(0.9);
  executor.arena().rewind(end_of_mesh);
  return mesh;
}

}  // namespace quickses
