// SPDX-License-Identifier: MIT
// The Gaussian surface from the neighbour grid to the mesh: bricks, signs of the density, marching cubes, vertices
// where it has the isovalue.
#pragma once

#include "surface/methods/closed_layout.h"
#include "surface/stages/ball_points.h"
#include "surface/stages/gaussian_density.h"

namespace quickses {

// The part of the radius where an atom's density ends within which it alone has the isovalue.
inline float inner_part(float isovalue) { return isovalue < 1.f ? std::sqrt(-std::log(isovalue) / kHalfReach2) : 0.f; }

template <class Work>
GaussianDensity density_of(const Work &work) {
  return {work.atoms, work.parameters.max_radius, work.settings.gaussian_isovalue,
          1.f / (kGaussianReach * work.settings.gaussian_radius_scale)};
}

// Rounds of the loops of a thread that looks at the atoms around a place so many times. Waits, maybe.
template <class Executor>
uint64_t density_steps(Executor &executor, const GaussianDensity &density, size_t items, uint64_t looks, float extent) {
  if constexpr (!Executor::kIsCuda) {
    return kThreadSteps;
  } else {
    const auto steps_of = [&](uint64_t near) { return kPlainSteps + looks * near; };
    const uint64_t near = most_items_near(
        executor, "fullest cell of atoms", density.atoms, 2.f * density.max_radius + extent, [&](uint64_t n) {
          return steps_of(n) <= kThreadSteps && executor.is_few_launches(items, executor.for_each_shape(steps_of(n)));
        });
    if (steps_of(near) > kThreadSteps)
      throw Error(QSES_TOO_FINE,
                  "the Gaussians of " + std::to_string(near) +
                      " atoms may reach one place, which is more than a GPU is given at a time: use a smaller "
                      "gaussian_radius_scale, or the CPU");
    return steps_of(near);
  }
}

template <class Work>
BrickSet find_density_bricks(Work &work, WorkFacts *facts) {
  return collect_ball_bricks(work.executor, work.atoms, work.parameters.max_radius, work.lattice, &facts->brick_visits);
}

// The signs of all points. for_slices(work_on): calls work_on(slice) for runs of bricks.
template <class Work, class ForSlices>
void evaluate_density_signs(Work &work, const BrickSet &bricks, const ForSlices &for_slices, uint64_t *signs) {
  auto &executor = work.executor;
  const GaussianDensity density = density_of(work);
  const auto mark = executor.arena().mark();
  Span<uint64_t> outside = executor.template allocate<uint64_t>(size_t(bricks.count) * kLeavesPerBrick);
  // Less by what rounding may add.
  const Balls alone{work.atoms, work.parameters.max_radius, 1e-3f, inner_part(density.isovalue)};
  find_outside_points(executor, alone, bricks, outside.data);
  const uint64_t steps = density_steps(executor, density, bricks.count, 2, 8.f * work.parameters.spacing);
  for_slices([&](BrickRange slice) {
    executor.template for_each_brick<DensityScratch>(
        slice.size(), EvaluateDensity{density, bricks, outside.data, slice.first, signs}, 8, steps);
  });
  executor.arena().rewind(mark);
}

template <class Work>
MeshMemoryView build_gaussian_surface(Work &work) {
  auto &executor = work.executor;
  work.memory.forget_spills();
  work.timer.begin("bricks");
  BrickSet bricks = find_density_bricks(work, work.facts);
  note_bricks(work, bricks);
  work.progress.report(0.1);

  // Slices take no memory here, but the caller can follow them.
  MeshLayout layout{};
  const MeshCounts counts = lay_out_closed_mesh(work, &bricks, &layout, [&](const BrickSet &set, uint64_t *signs) {
    work.timer.begin("gaussian_density");
    const auto for_slices = [&](const auto &work_on) {
      work.report->slice_count = for_each_slice(
          work, set.count, asked_slice(work.settings, set.count, work.progress.wanted()), 0.1, 0.6, work_on);
    };
    evaluate_density_signs(work, set, for_slices, signs);
  });
  MeshMemoryView mesh = begin_mesh(work, counts);
  const auto end_of_mesh = executor.arena().mark();
  work.timer.begin("marching_cubes");
  emit_all_triangles(work, bricks, layout, mesh);
  work.timer.begin("projection");
  const GaussianDensity density = density_of(work);
  executor.for_each(counts.vertices, PlaceDensityVertices{density, bricks, layout, mesh.view},
                    density_steps(executor, density, counts.vertices, PlaceDensityVertices::kMostSteps + 1, 0.f));
  work.progress.report(0.9);
  executor.arena().rewind(end_of_mesh);
  return mesh;
}

}  // namespace quickses
