// SPDX-License-Identifier: MIT
// Normals in four bytes, behind the positions of vertices. While a mesh is made its normals are floats, which further
// steps read: they are packed when it is finished, so that positions do not depend on the layout.
#pragma once

#include "surface/mesh/mesh_view.h"

namespace quickses {

// SNorm8: a component in [-1, 1] as a multiple of 1/127.
QSES_FN uint32_t pack_component(float c) {
  return static_cast<uint32_t>(static_cast<int>(floorf(c * 127.f + 0.5f))) & 0xffu;
}
QSES_FN float unpack_component(uint32_t byte) { return static_cast<float>(static_cast<int8_t>(byte & 0xffu)) / 127.f; }

QSES_FN uint32_t pack_normal(const float *n) {
  return pack_component(n[0]) | pack_component(n[1]) << 8 | pack_component(n[2]) << 16;
}

struct PackNormals {
  MeshView mesh;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t vertex = mesh.first_vertex + static_cast<uint32_t>(i);
    *mesh.packed_normal(vertex) = pack_normal(mesh.normal(vertex));
  }
};

template <class Executor>
void pack_normals(Executor &executor, const MeshView &mesh, size_t vertices) {
  if (mesh.packed_normals) executor.for_each(vertices, PackNormals{mesh});
}

}  // namespace quickses
