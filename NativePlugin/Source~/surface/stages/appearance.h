// SPDX-License-Identifier: MIT
// What vertices take from the atoms that own them: colours and texture coordinates.
#pragma once

#include "surface/mesh/mesh_view.h"

#include <vector>

namespace quickses {

// Per atom, in the caller's order, on the host. Empty: not set.
struct Appearance {
  std::vector<uint8_t> visible;
  std::vector<uint32_t> colors;  // bytes red, green, blue, alpha
  std::vector<glm::vec2> texcoords;
};

// The same in the memory of a back end; nullptr: not set.
struct AppearanceView {
  const uint8_t *visible;
  const uint32_t *colors;
  const glm::vec2 *texcoords;
  size_t atoms;  // so many, of what is set
};

// Which of a mesh's atoms are shown; nullptr: all of them.
using VisibleAtoms = const uint8_t *;

// corners: vertex numbers of a triangle of a whole mesh, whose vertices have these owners.
QSES_FN bool is_shown(const uint32_t *corners, const uint32_t *owners, VisibleAtoms visible) {
  return visible[owners[corners[0]]] && visible[owners[corners[1]]] && visible[owners[corners[2]]];
}

// Writes colours and texture coordinates of a run of vertices, whose owners are known: but where there are more than
// was anticipated, and they will be made again.
struct PaintVertices {
  AppearanceView appearance;
  MeshView mesh;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t vertex = mesh.first_vertex + static_cast<uint32_t>(i), atom = mesh.owner(vertex);
    const bool is_known = atom < appearance.atoms;
    if (mesh.colors && is_known) *mesh.color(vertex) = appearance.colors[atom];
    if (mesh.texcoords) {
      const glm::vec2 uv = appearance.texcoords && is_known ? appearance.texcoords[atom] : glm::vec2(1.f, 0.f);
      float *const out = mesh.texcoord(vertex);
      out[0] = uv.x;
      out[1] = uv.y;
    }
  }
};

template <class Executor>
void paint_vertices(Executor &executor, const AppearanceView &appearance, const MeshView &mesh, size_t vertices) {
  if (mesh.colors || mesh.texcoords) executor.for_each(vertices, PaintVertices{appearance, mesh});
}

}  // namespace quickses
