// SPDX-License-Identifier: MIT
// A mesh that is given sharp creases, with the room it has.
#pragma once

#include "surface/mesh/creased_mesh.h"
#include "surface/methods/exact_surface.h"

namespace quickses {

struct GrowingMesh {
  MeshMemoryView whole;
  CreasedMesh view;
  size_t vertex_room, triangle_room;
};

// Room for work on the mesh: where the mesh is, since most of it is as large.
template <class T, class Work>
Span<T> mesh_room(Work &work, const GrowingMesh &mesh, size_t n) {
  return work.memory.template allocate_where_mesh_is<T>(work.executor, mesh.whole, n);
}

}  // namespace quickses
