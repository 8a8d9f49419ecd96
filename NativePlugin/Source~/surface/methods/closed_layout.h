// SPDX-License-Identifier: MIT
// Signs and layout of a mesh that is closed by construction: the set of bricks grows until no sign changes on its
// border. What comes out is all that emission needs, and all that it may rely on.
#pragma once

#include "surface/methods/level_work.h"

namespace quickses {

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
      work.report->brick_count = bricks->count;
      work.facts->brick_entries = bricks->table ? work.lattice.table_size() : 0;
      work.facts->size = {static_cast<double>(bricks->count), static_cast<double>(counts.vertices),
                          static_cast<double>(counts.triangles), static_cast<double>(layout->leaf_total)};
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
