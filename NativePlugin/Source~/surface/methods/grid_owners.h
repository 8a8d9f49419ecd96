// SPDX-License-Identifier: MIT
// Whose surface the vertices of the voxel method are on: a pass of its own, in which every thread has a vertex.
#pragma once

#include "surface/methods/grid_distance.h"

namespace quickses {

// Place in the grid of the atom whose van der Waals surface is nearest, among those whose inflated surface is at most
// `margin` away; of several, the one with the smallest number. met: which of them are looked at; best: the nearest of
// those before.
QSES_FN uint32_t nearest_grid_atom(const GridField &f, const Vec3<float> &x, float margin, MetItems met,
                                   uint32_t best) {
  const CellBox box = cells_within(f.atoms.cells, x, f.atoms.cells.radii.in_cells + margin);
  float depth = met.first > 0 ? ball_depth(f.atoms.items[best], x) : kNoDepth;
  f.atoms.for_each_run(box, [&](const ItemRun &whole) {
    const ItemRun run = met.cut(whole);
    for (uint32_t k = run.begin; k < run.end; ++k) {
      const float d = ball_depth(f.atoms.items[k], x);
      if (d > depth || (d == depth && f.atoms.order[k] < f.atoms.order[best])) {
        depth = d;
        best = k;
      }
    }
    return true;
  });
  return best;
}

struct FindGridOwners {
  GridField field;
  MeshView mesh;
  MetItems part;  // of the atoms around a vertex
  bool is_last;   // of the parts

  // The inner end of a vertex's edge is in an inflated ball, and at most a spacing away.
  QSES_FN static float margin(const GridParameters &g) { return 1.01f * g.spacing + 1e-4f; }

  QSES_HOST_DEVICE void operator()(size_t i) const {
    const auto vertex = static_cast<uint32_t>(i);
    const Vec3<float> p = load_vec3(mesh.position(vertex));
    const uint32_t before = part.first > 0 ? mesh.owner(vertex) : 0;
    const uint32_t atom = nearest_grid_atom(field, p, margin(field.parameters), part, before);
    mesh.owner(vertex) = is_last ? field.atoms.order[atom] : atom;
    if (!is_last) return;
    store_vec3(mesh.position(vertex), Vec3<float>(field.bricks.lattice.to_caller(p)));
    store_vec3(mesh.normal(vertex), sphere_normal(field.atoms.items[atom], p));
  }
};

// Owners of all vertices, and where they are in the caller's frame. The normals written are those of the owners'
// spheres: compute_normals (relaxation.h) replaces them where the triangles define one.
template <class Executor>
void find_grid_owners(Executor &executor, const GridField &field, const MeshView &mesh, size_t vertices) {
  constexpr uint64_t kMost = kThreadSteps - kPlainSteps;
  const auto steps_of = [&](uint64_t near) { return kPlainSteps + std::min(near, kMost); };
  uint64_t near = field.atoms.count;
  if constexpr (Executor::kIsCuda)
    near = most_atoms_near(
        executor, field.atoms, 2.f * (field.parameters.max_radius + FindGridOwners::margin(field.parameters)),
        [&](uint64_t items) { return executor.is_few_launches(vertices, executor.for_each_shape(steps_of(items))); });
  for_parts_of_met_items(near, Executor::kIsCuda ? kMost : near, [&](const MetItems &part, bool is_last) {
    executor.for_each(vertices, FindGridOwners{field, mesh, part, is_last}, steps_of(near));
  });
}

}  // namespace quickses
