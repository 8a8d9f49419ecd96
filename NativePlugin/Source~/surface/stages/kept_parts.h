// SPDX-License-Identifier: MIT
// Makes a mesh of some of the vertices and triangles of another one, which may have the other winding. What stays keeps
// its order.
#pragma once

#include "surface/mesh/mesh_view.h"
#include "surface/stages/ranked_set.h"

#include <algorithm>

namespace quickses {

struct KeptParts {
  RankedSet vertices, triangles;  // no triangle without its vertices
};

struct KeepMesh {
  MeshView from, to;
  KeptParts kept;
  size_t vertices, triangles;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t number = static_cast<uint32_t>(i);
    if (i < vertices && kept.vertices.has(number)) copy_vertex(from, number, to, kept.vertices.rank(number));
    if (i >= triangles || !kept.triangles.has(number)) return;
    const uint32_t *const t = from.triangle(number);
    uint32_t *const out = to.triangle(kept.triangles.rank(number));
    const bool turned = from.reversed != to.reversed;
    out[0] = kept.vertices.rank(t[0]);
    out[turned ? 2 : 1] = kept.vertices.rank(t[1]);
    out[turned ? 1 : 2] = kept.vertices.rank(t[2]);
  }
};

// from: of so many vertices and triangles. to: has room for those that are kept.
template <class Executor>
void keep_parts(Executor &executor, const MeshView &from, size_t vertices, size_t triangles, const KeptParts &kept,
                const MeshView &to) {
  executor.for_each(std::max(vertices, triangles), KeepMesh{from, to, kept, vertices, triangles});
}

}  // namespace quickses
