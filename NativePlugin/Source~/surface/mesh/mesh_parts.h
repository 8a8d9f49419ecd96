// SPDX-License-Identifier: MIT
// A mesh that grows: new vertices and triangles come in parts of their own, behind those that are there.
#pragma once

#include "surface/mesh/mesh_view.h"

namespace quickses {

// What vertices have besides while edges are split at creases.
struct CreaseMarks {
  uint32_t *second_owners;  // the caller's number of the atom of the other side; elsewhere that of the owner
  uint8_t *on_crease;       // 1 or 0: do the normals differ?
};

struct MeshParts {
  static constexpr int kMost = 3;
  MeshView part[kMost];  // first_vertex and first_triangle of what is not there yet: the largest number
  CreaseMarks marks[kMost];

  QSES_FN int part_with(uint32_t v) const {
    int k = kMost - 1;
    while (k > 0 && v < part[k].first_vertex) --k;
    return k;
  }
  QSES_FN const MeshView &with(uint32_t v) const { return part[part_with(v)]; }
  QSES_FN uint32_t *triangle(uint32_t t) const {
    int k = kMost - 1;
    while (k > 0 && t < part[k].first_triangle) --k;
    return part[k].triangle(t);
  }
  QSES_FN bool on_crease(uint32_t v) const {
    const int k = part_with(v);
    return marks[k].on_crease[part[k].place(v)] != 0;
  }
};

}  // namespace quickses
