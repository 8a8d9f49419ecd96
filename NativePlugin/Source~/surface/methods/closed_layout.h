// SPDX-License-Identifier: MIT
// Signs and layout of a mesh that is closed by construction: the set of bricks grows until no sign changes on its
// border. What comes out is all that emission needs, and all that it may rely on.
#pragma once

#include "surface/methods/expected_splits.h"

namespace quickses {

// The bricks before anything is known of the mesh.
template <class Work>
void note_bricks(Work &work, const BrickSet &bricks) {
  work.facts->size = {};
  work.facts->size.bricks = static_cast<double>(bricks.count);
  work.facts->brick_entries = bricks.table_entries();
}

// How large the mesh is of which these bricks are.
template <class Work>
void note_size(Work &work, uint64_t bricks, const MeshCounts &counts, uint64_t leaves) {
  work.report->brick_count = bricks;
  work.facts->size = {static_cast<double>(bricks), static_cast<double>(counts.vertices),
                      static_cast<double>(counts.triangles), static_cast<double>(leaves)};
}

// evaluate(bricks, signs) finds the signs of all lattice points of a set. Throws if the mesh would be too large.
template <class Work, class Evaluate>
MeshCounts lay_out_closed_mesh(Work &work, BrickSet *bricks, MeshLayout *layout, const Evaluate &evaluate) {
  auto &executor = work.executor;
  for (;;) {
    Span<uint64_t> signs = executor.template allocate<uint64_t>(size_t(bricks->count) * kLeavesPerBrick);
    evaluate(*bricks, signs.data);
    work.timer.begin("marching_cubes");
    const MeshCounts counts = lay_out_mesh(executor, *bricks, signs.data, work.table.triangle_count, layout);
    if (layout->border_changes == 0) {
      work.facts->brick_entries = bricks->table_entries();
      note_size(work, bricks->count, counts, layout->leaf_total);
      check_mesh_size(counts);
      return counts;
    }
    const BrickSet grown = grow_bricks(executor, *bricks, layout->border);
    work.report->border_bricks += grown.count - bricks->count;
    *bricks = grown;
    work.progress.report(0.0);  // looks whether to go on
  }
}

// Memory for the mesh that was laid out, with the normals that later stages read.
template <class Work>
MeshMemoryView begin_mesh(Work &work, const MeshCounts &counts) {
  MeshMemoryView mesh = work.memory.allocate_mesh(work.executor, with_spare_room(work, counts.vertices),
                                                  with_spare_room(work, counts.triangles), work.made_shape,
                                                  work.purpose, work.plan.mesh_in_pieces);
  add_normals(work, &mesh);
  mesh.vertices = counts.vertices;
  mesh.triangles = counts.triangles;
  return mesh;
}

// How large a mesh of which that was anticipated is, and where it goes. Waits for it.
template <class Work>
void settle_mesh(Work &work, MeshMemoryView *mesh) {
  auto &executor = work.executor;
  if (!work.untold.totals) return;
  size_t right = ~size_t(0);  // of the triangles that are out
  if (executor.verify_counts()) {
    const MeshTotals found = executor.verified(work.untold.totals);
    narrow_mesh(mesh, found.vertices, found.triangles);
    note_size(work, work.untold.bricks ? executor.verified(work.untold.bricks).count : work.untold.most_bricks,
              {found.vertices, found.triangles}, found.leaves);
    right = found.early_triangles;
  }
  work.untold = {};
  if (!mesh->in_pieces) work.memory.bring_triangles(*mesh, work.purpose, right);
}
// The same in the midst of making it.
template <class Work>
void wait_for_size(Work &work, MeshMemoryView *mesh) {
  work.executor.hand_over();  // so that it goes on meanwhile
  work.hand_out_others();
  settle_mesh(work, mesh);
}

// Of all bricks at once, by methods of which counts are settled.
template <class Work>
void emit_all_triangles(Work &work, const BrickSet &bricks, const MeshLayout &layout, MeshMemoryView &mesh) {
  auto &executor = work.executor;
  Backend<std::remove_reference_t<decltype(executor)>>::emit_triangles(
      executor, bricks, layout, BrickRange{0, bricks.count}, work.table, mesh.view);
  if (mesh.in_pieces) return;
  work.memory.note_triangles(executor);
  work.memory.bring_triangles(mesh, work.purpose, 0);  // they go out while the vertices are made
}

}  // namespace quickses
