// SPDX-License-Identifier: MIT
// Signs and layout of a mesh that is closed by construction: the set of bricks grows until no sign changes on its
// border. What comes out is all that emission needs, and all that it may rely on.
#pragma once

#include "surface/methods/level_work.h"

namespace quickses {

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
      work.facts->brick_entries = bricks->table ? work.lattice.table_size() : 0;
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

}  // namespace quickses
