// SPDX-License-Identifier: MIT
// Where the stages write a mesh: separate arrays, or position and normal of a vertex behind each other as a graphics
// API wants them. Only the distances between the vertices differ, so that no kernel knows which it is.
#pragma once

#include "surface/geometry/types.h"
#include "surface/mesh/pick_boxes.h"

namespace quickses {

// Of a triangle's corner, the next one.
QSES_FN int next_corner(int k) { return k == 2 ? 0 : k + 1; }

// A run of a mesh's vertices and triangles in memory of the back end. Vertices and triangles are named by their numbers
// in the whole mesh.
struct MeshView {
  float *positions = nullptr;   // caller's coordinates
  float *normals = nullptr;     // unit length; nullptr: there are none but packed ones
  uint32_t *owners = nullptr;   // caller's atom numbers
  uint8_t *patches = nullptr;   // or nullptr
  uint32_t *indices = nullptr;  // three per triangle
  bool reversed = false;        // winding
  uint32_t *colors = nullptr;   // bytes red, green, blue, alpha; or nullptr
  float *texcoords = nullptr;   // two numbers, or nullptr
  uint32_t vertex_bytes = 12;   // from one position to the next
  uint32_t normal_bytes = 12;   // from one normal to the next
  bool packed_normals = false;  // behind each position is the normal in four bytes (stages/packed_normals.h)
  uint32_t first_vertex = 0;    // what the arrays begin with
  uint32_t first_triangle = 0;
  uint32_t *repeated = nullptr;  // of the last vertices, for which others they stand; or nullptr
  // While a mesh is made, where someone asks for them: of the other sheet at vertices where two meet, elsewhere equal
  // to the normal. Of unit length, behind each other.
  float *second_normals = nullptr;
  PickBoxes boxes{};                  // of whole meshes only
  uint32_t *component_ids = nullptr;  // of whole meshes only, or nullptr

  QSES_FN size_t place(uint32_t vertex) const { return vertex - first_vertex; }
  QSES_FN float *position(uint32_t vertex) const { return attribute(positions, vertex_bytes, vertex); }
  QSES_FN float *normal(uint32_t vertex) const { return attribute(normals, normal_bytes, vertex); }
  QSES_FN float *second_normal(uint32_t vertex) const { return second_normals + 3 * place(vertex); }
  QSES_FN uint32_t *packed_normal(uint32_t vertex) const { return reinterpret_cast<uint32_t *>(position(vertex) + 3); }
  QSES_FN uint32_t *color(uint32_t vertex) const { return colors + place(vertex); }
  QSES_FN float *texcoord(uint32_t vertex) const { return texcoords + 2 * place(vertex); }
  QSES_FN uint32_t &owner(uint32_t vertex) const { return owners[place(vertex)]; }
  QSES_FN uint8_t &patch(uint32_t vertex) const { return patches[place(vertex)]; }
  QSES_FN uint32_t &component_id(uint32_t vertex) const { return component_ids[place(vertex)]; }
  QSES_FN uint32_t *triangle(size_t number) const { return indices + 3 * (number - first_triangle); }

 private:
  QSES_FN float *attribute(float *first, uint32_t stride, uint32_t vertex) const {
    return reinterpret_cast<float *>(reinterpret_cast<char *>(first) + size_t(stride) * place(vertex));
  }
};

// The same arrays from a vertex and a triangle on.
inline MeshView view_from(MeshView mesh, uint32_t vertex, uint32_t triangle) {
  mesh.positions = mesh.position(vertex);
  if (mesh.normals) mesh.normals = mesh.normal(vertex);
  if (mesh.second_normals) mesh.second_normals = mesh.second_normal(vertex);
  mesh.owners = &mesh.owner(vertex);
  if (mesh.patches) mesh.patches = &mesh.patch(vertex);
  if (mesh.colors) mesh.colors = mesh.color(vertex);
  if (mesh.texcoords) mesh.texcoords = mesh.texcoord(vertex);
  if (mesh.component_ids) mesh.component_ids = &mesh.component_id(vertex);
  mesh.indices = mesh.triangle(triangle);
  mesh.first_vertex = vertex;
  mesh.first_triangle = triangle;
  return mesh;
}

// One vertex of a mesh that is being made into another one, where colours and packed normals come last.
QSES_FN void copy_vertex(const MeshView &from, uint32_t vertex, const MeshView &to, uint32_t place) {
  const auto copy3 = [](float *out, const float *in) {
    for (int d = 0; d < 3; ++d) out[d] = in[d];
  };
  copy3(to.position(place), from.position(vertex));
  copy3(to.normal(place), from.normal(vertex));
  if (from.second_normals && to.second_normals) copy3(to.second_normal(place), from.second_normal(vertex));
  to.owner(place) = from.owner(vertex);
  if (from.component_ids && to.component_ids) to.component_id(place) = from.component_id(vertex);
  if (from.patches) to.patch(place) = from.patch(vertex);
}

}  // namespace quickses
