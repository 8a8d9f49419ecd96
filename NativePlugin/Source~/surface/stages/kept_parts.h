// SPDX-License-Identifier: MIT
// Makes a mesh of some of the vertices and triangles of another one. What stays keeps its order.
#pragma once

#include "surface/mesh/mesh_view.h"
#include "surface/stages/ranked_set.h"

namespace quickses {

struct KeptParts {
  RankedSet vertices, triangles;  // no triangle without its vertices
};

struct KeepVertex {
  MeshView from, to;
  KeptParts kept;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t vertex = static_cast<uint32_t>(i);
    if (kept.vertices.has(vertex)) copy_vertex(from, vertex, to, kept.vertices.rank(vertex));
  }
};

struct KeepTriangle {
  MeshView from, to;
  KeptParts kept;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t triangle = static_cast<uint32_t>(i);
    if (!kept.triangles.has(triangle)) return;
    const uint32_t *const t = from.triangle(triangle);
    uint32_t *const out = to.triangle(kept.triangles.rank(triangle));
    for (int corner = 0; corner < 3; ++corner) out[corner] = kept.vertices.rank(t[corner]);
  }
};

}  // namespace quickses
