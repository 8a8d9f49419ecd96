// SPDX-License-Identifier: MIT
// A mesh that grows: new vertices and triangles come in parts of their own, behind those that are there.
#pragma once

#include "surface/mesh/mesh_view.h"

namespace quickses {

constexpr int kMostParts = 3;

// What vertices have besides, while edges are split at creases.
struct CreaseMarks {
  float *second_normals;  // unit length, of the other side; only where on_crease says so
  uint8_t *on_crease;     // 1 or 0
};

struct MeshParts {
  MeshView part[kMostParts];  // first_vertex and first_triangle of what is not there yet: the largest number
  CreaseMarks marks[kMostParts];

  QSES_FN int part_of_vertex(uint32_t v) const {
    int k = kMostParts - 1;
    while (k > 0 && v < part[k].first_vertex) --k;
    return k;
  }
  QSES_FN const MeshView &with_vertex(uint32_t v) const { return part[part_of_vertex(v)]; }
  QSES_FN uint32_t *triangle(uint32_t t) const {
    int k = kMostParts - 1;
    while (k > 0 && t < part[k].first_triangle) --k;
    return part[k].triangle(t);
  }
  QSES_FN uint32_t owner(uint32_t v) const { return with_vertex(v).owner(v); }
  QSES_FN bool on_crease(uint32_t v) const {
    const int k = part_of_vertex(v);
    return marks[k].on_crease[part[k].place(v)] != 0;
  }
  QSES_FN float *second_normal(uint32_t v) const {
    const int k = part_of_vertex(v);
    return marks[k].second_normals + 3 * part[k].place(v);
  }
};

}  // namespace quickses
