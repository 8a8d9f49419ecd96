// SPDX-License-Identifier: MIT
// A finished mesh that is held on to, and what is asked of it: all on the host.
#pragma once

#include "quickses/quickses.h"
#include "surface/mesh/mesh_pool.h"
#include "surface/mesh/pick_boxes.h"

namespace quickses {

struct KeptMesh {
  qses_mesh mesh;  // like the boxes in memory of the lease
  PickBoxes boxes;
  qses_report report;
  size_t atom_count = 0;
  MeshLease memory;
  bool is_full = false;

  KeptMesh() { clear(); }
  void clear() noexcept;
};

// Which of the mesh's atoms are shown; nullptr: all of them.
using VisibleAtoms = const uint8_t *;

inline bool is_shown(const qses_mesh &mesh, uint32_t triangle, VisibleAtoms visible) {
  const uint32_t *const corner = mesh.indices + 3 * size_t(triangle);
  return visible[mesh.owners[corner[0]]] && visible[mesh.owners[corner[1]]] && visible[mesh.owners[corner[2]]];
}

// Values of so many bytes (4, 8, 12 or 16) of the atoms that own the vertices.
void paint(const qses_mesh &mesh, const void *per_atom, size_t value_bytes, uint32_t first, uint32_t count,
           void *per_vertex);

// The triangles of a run that are shown. Returns how many.
uint32_t filter(const qses_mesh &mesh, VisibleAtoms visible, uint32_t first, uint32_t count, uint32_t *indices);

// The first triangle that a ray meets. The numbers are finite, the direction has a length. Without boxes it looks at
// all triangles.
qses_hit pick(const qses_mesh &mesh, const PickBoxes &boxes, const float origin[3], const float direction[3],
              VisibleAtoms visible);

}  // namespace quickses
