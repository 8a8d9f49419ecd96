// SPDX-License-Identifier: MIT
// A mesh while its edges are split at creases. Whatever winding is wanted, its triangles are not reversed yet.
#pragma once

#include "surface/mesh/mesh_view.h"

namespace quickses {

struct CreasedMesh : MeshView {
  uint32_t *second_owners;  // the caller's number of the atom of the other side, of vertices on creases; or nullptr
  uint8_t *crease_marks;    // [vertex]: 1 or 0: do the normals differ?
  uint8_t *near_marks;      // [triangle]: 1 or 0: may it have to do with creases?

  QSES_FN bool on_crease(uint32_t vertex) const { return crease_marks[vertex] != 0; }
};

}  // namespace quickses
