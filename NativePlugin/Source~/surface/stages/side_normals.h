// SPDX-License-Identifier: MIT
// The normals of vertices where two sheets of the surface meet: one per side while a mesh is made, if someone asks for
// that, and one between them for a vertex that both sides share.
#pragma once

#include "surface/geometry/vec3.h"
#include "surface/mesh/mesh_view.h"

namespace quickses {

// Between two normals of unit length: their mean, or the first one where they are opposite.
QSES_FN Vec3<float> mean_normal(const Vec3<float> &a, const Vec3<float> &b) {
  if (a.x == b.x && a.y == b.y && a.z == b.z) return a;
  const Vec3<float> sum = a + b;
  const float length2 = length_squared(sum);
  return length2 > 1e-8f ? sum * reciprocal_root(length2) : a;
}

QSES_FN void store_normals(const MeshView &mesh, uint32_t vertex, const Vec3<float> &first, const Vec3<float> &second) {
  if (mesh.second_normals) {
    store_vec3(mesh.normal(vertex), first);
    store_vec3(mesh.second_normal(vertex), second);
  } else {
    store_vec3(mesh.normal(vertex), mean_normal(first, second));
  }
}

// The normal that both sides of a vertex share, whichever way it is kept.
QSES_FN Vec3<float> shared_normal(const MeshView &mesh, uint32_t vertex) {
  const Vec3<float> first = load_vec3(mesh.normal(vertex));
  return mesh.second_normals ? mean_normal(first, load_vec3(mesh.second_normal(vertex))) : first;
}

struct ShareNormals {
  MeshView mesh;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t vertex = static_cast<uint32_t>(i);
    store_vec3(mesh.normal(vertex), shared_normal(mesh, vertex));
  }
};

// One normal for each vertex of a finished mesh.
template <class Executor>
void share_normals(Executor &executor, const MeshView &mesh, size_t vertices) {
  if (mesh.second_normals) executor.for_each(vertices, ShareNormals{mesh});
}

}  // namespace quickses
