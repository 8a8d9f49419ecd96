// SPDX-License-Identifier: MIT
// Fills the boxes of a mesh that is finished (mesh/pick_boxes.h).
#pragma once

#include "surface/mesh/mesh_view.h"

namespace quickses {

struct BoxRun {
  MeshView mesh;
  size_t triangles;
  QSES_HOST_DEVICE void operator()(size_t run) const {
    const size_t begin = 3 * run * kRunTriangles, all = 3 * triangles;
    const size_t end = begin + 3 * kRunTriangles < all ? begin + 3 * kRunTriangles : all;
    const float *const first = mesh.position(mesh.indices[begin]);
    Box box = {{first[0], first[1], first[2]}, {first[0], first[1], first[2]}};
    for (size_t k = begin + 1; k < end; ++k) {
      const float *const p = mesh.position(mesh.indices[k]);
      for (int d = 0; d < 3; ++d) {
        box.low[d] = p[d] < box.low[d] ? p[d] : box.low[d];
        box.high[d] = box.high[d] < p[d] ? p[d] : box.high[d];
      }
    }
    mesh.boxes.runs[run] = box;
  }
};

struct BoxGroup {
  PickBoxes boxes;
  size_t runs;
  QSES_HOST_DEVICE void operator()(size_t group) const {
    const size_t begin = group * kGroupRuns, end = begin + kGroupRuns < runs ? begin + kGroupRuns : runs;
    Box box = boxes.runs[begin];
    for (size_t run = begin + 1; run < end; ++run)
      for (int d = 0; d < 3; ++d) {
        const Box &other = boxes.runs[run];
        box.low[d] = other.low[d] < box.low[d] ? other.low[d] : box.low[d];
        box.high[d] = box.high[d] < other.high[d] ? other.high[d] : box.high[d];
      }
    boxes.groups[group] = box;
  }
};

template <class Executor>
void fill_pick_boxes(Executor &executor, const MeshView &mesh, size_t triangles) {
  executor.for_each(PickBoxes::run_count(triangles), BoxRun{mesh, triangles}, 3 * kRunTriangles);
  executor.for_each(PickBoxes::group_count(triangles), BoxGroup{mesh.boxes, PickBoxes::run_count(triangles)},
                    kGroupRuns);
}

}  // namespace quickses
