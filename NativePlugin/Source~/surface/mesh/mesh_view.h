// SPDX-License-Identifier: MIT
// Where the stages write a mesh: separate arrays, or vertices as a graphics API wants them, all attributes of one
// behind each other. Only the distances between the vertices differ, so that no kernel knows which it is.
#pragma once

#include "surface/geometry/types.h"

namespace quickses {

// A run of a mesh's vertices and triangles in memory of the back end. Vertices and triangles are named by their numbers
// in the whole mesh.
struct MeshView {
  float *positions = nullptr;   // caller's coordinates
  float *normals = nullptr;     // unit length
  uint32_t *owners = nullptr;   // caller's atom numbers
  uint8_t *patches = nullptr;   // or nullptr
  uint32_t *indices = nullptr;  // three per triangle
  bool reversed = false;        // winding
  uint32_t *colors = nullptr;   // bytes red, green, blue, alpha; or nullptr
  float *texcoords = nullptr;   // two numbers, or nullptr
  uint32_t vertex_bytes = 0;    // from one vertex to the next in all attributes; 0: each array is tightly packed
  uint32_t first_vertex = 0;    // what the arrays begin with
  uint32_t first_triangle = 0;

  QSES_FN size_t place(uint32_t vertex) const { return vertex - first_vertex; }
  QSES_FN float *position(uint32_t vertex) const { return attribute(positions, 12, vertex); }
  QSES_FN float *normal(uint32_t vertex) const { return attribute(normals, 12, vertex); }
  QSES_FN uint32_t *color(uint32_t vertex) const { return attribute(colors, 4, vertex); }
  QSES_FN float *texcoord(uint32_t vertex) const { return attribute(texcoords, 8, vertex); }
  QSES_FN uint32_t &owner(uint32_t vertex) const { return owners[place(vertex)]; }
  QSES_FN uint8_t &patch(uint32_t vertex) const { return patches[place(vertex)]; }
  QSES_FN uint32_t *triangle(size_t number) const { return indices + 3 * (number - first_triangle); }

 private:
  template <class T>
  QSES_FN T *attribute(T *first, uint32_t size, uint32_t vertex) const {
    const size_t stride = vertex_bytes ? vertex_bytes : size;
    return reinterpret_cast<T *>(reinterpret_cast<char *>(first) + stride * place(vertex));
  }
};

}  // namespace quickses
