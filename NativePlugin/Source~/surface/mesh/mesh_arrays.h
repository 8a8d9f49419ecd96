// SPDX-License-Identifier: MIT
// How the arrays of a mesh lie in one piece of memory.
#pragma once

#include "quickses/quickses.h"
#include "surface/mesh/mesh_view.h"

namespace quickses {

// Which attributes vertices have, and how they lie.
struct MeshShape {
  qses_vertex_layout layout = QSES_VERTICES_SEPARATE;
  bool colors = false, texcoords = false, patches = false, reversed = false, boxes = false, component_ids = false;
  bool owners = true;                              // as every mesh has while it is made
  size_t repeated = 0;                             // vertices that stand for others (methods/hard_edges.h)
  size_t spare_vertices = 0, spare_triangles = 0;  // that there is room for behind the last
};

// Whether the surface is made of the features of balls: not on the paper's grid, nor out of a density.
inline bool is_exact(const qses_settings &s) {
  return s.method == QSES_METHOD_EXACT && s.surface != QSES_SURFACE_GAUSSIAN;
}

inline bool is_for_host(qses_delivery d) { return d == QSES_DELIVERY_HOST || d == QSES_DELIVERY_BOTH; }
inline bool is_for_device(qses_delivery d) { return d == QSES_DELIVERY_DEVICE || d == QSES_DELIVERY_BOTH; }

// Whether owners stay behind where the mesh is made.
inline bool leaves_owners(const qses_settings &s) { return s.without_owners && s.delivery == QSES_DELIVERY_HOST; }

inline MeshShape shape_of(const qses_settings &s, bool has_colors) {
  MeshShape shape;
  if (s.delivery == QSES_DELIVERY_NONE) return shape;  // nobody will look at it
  shape.layout = s.vertex_layout;
  shape.colors = has_colors;
  shape.texcoords = s.texcoords != 0 || s.occlusion != 0;
  shape.patches = s.patch_types != 0 && is_exact(s);
  shape.reversed = s.winding == QSES_WINDING_REVERSED;
  shape.component_ids = s.component_ids != 0;
  shape.boxes = s.pickable != 0;
  return shape;
}

// Places of the arrays: behind each other without a gap but for what is spare, so that one copy moves the mesh. All
// values have four bytes but the patches, which come last.
class MeshArrays {
 public:
  MeshArrays(size_t vertices, size_t triangles, const MeshShape &shape) : shape_(shape) {
    vertices += shape.spare_vertices;
    triangles += shape.spare_triangles;
    const bool is_separate = shape.layout == QSES_VERTICES_SEPARATE;
    vertex_bytes_ = is_separate ? 12 : shape.layout == QSES_VERTICES_INTERLEAVED ? 24 : 16;
    positions_ = next(vertices * vertex_bytes_);
    normals_ = is_separate ? next(vertices * 12) : positions_ + 12;
    if (shape.colors) colors_ = next(vertices * 4);
    if (shape.texcoords) texcoords_ = next(vertices * 8);
    if (shape.owners) owners_ = next(vertices * 4);
    if (shape.component_ids) component_ids_ = next(vertices * 4);
    indices_ = next(triangles * 12);
    repeated_ = next(shape.repeated * 4);
    if (shape.boxes) {
      runs_ = next(PickBoxes::run_count(triangles) * sizeof(Box));
      groups_ = next(PickBoxes::group_count(triangles) * sizeof(Box));
    }
    if (shape.patches) patches_ = next(vertices);
  }

  size_t bytes() const { return bytes_; }

  MeshView view(void *memory) const {
    char *const base = static_cast<char *>(memory);
    MeshView v;
    v.positions = reinterpret_cast<float *>(base + positions_);
    v.vertex_bytes = vertex_bytes_;
    v.packed_normals = shape_.layout == QSES_VERTICES_COMPACT;
    if (!v.packed_normals) v.normals = reinterpret_cast<float *>(base + normals_);
    v.normal_bytes = shape_.layout == QSES_VERTICES_INTERLEAVED ? vertex_bytes_ : 12;
    if (shape_.colors) v.colors = reinterpret_cast<uint32_t *>(base + colors_);
    if (shape_.texcoords) v.texcoords = reinterpret_cast<float *>(base + texcoords_);
    if (shape_.component_ids) v.component_ids = reinterpret_cast<uint32_t *>(base + component_ids_);
    if (shape_.owners) v.owners = reinterpret_cast<uint32_t *>(base + owners_);
    if (shape_.patches) v.patches = reinterpret_cast<uint8_t *>(base + patches_);
    v.indices = reinterpret_cast<uint32_t *>(base + indices_);
    if (shape_.repeated) v.repeated = reinterpret_cast<uint32_t *>(base + repeated_);
    if (shape_.boxes) v.boxes = {reinterpret_cast<Box *>(base + runs_), reinterpret_cast<Box *>(base + groups_)};
    v.reversed = shape_.reversed;
    return v;
  }

 private:
  size_t next(size_t n) {
    const size_t here = bytes_;
    bytes_ += n;
    return here;
  }

  MeshShape shape_;
  uint32_t vertex_bytes_;
  size_t positions_ = 0, normals_ = 0, colors_ = 0, texcoords_ = 0, owners_ = 0, component_ids_ = 0, patches_ = 0,
         indices_ = 0, repeated_ = 0, runs_ = 0, groups_ = 0, bytes_ = 0;
};

// Calls copy(to, from, bytes) for each array of a run of `vertices` vertices and `triangles` triangles that both views
// have, but what whole meshes only have; with triangles 0 for those of the vertices only. `from` begins with the run,
// `to` has it somewhere.
template <class Copy>
void for_each_array(const MeshView &to, const MeshView &from, size_t vertices, size_t triangles, const Copy &copy) {
  const uint32_t v = from.first_vertex;
  if (vertices > 0) {
    copy(to.position(v), from.positions, vertices * from.vertex_bytes);
    if (from.normals && to.normals && from.normal_bytes == 12) copy(to.normal(v), from.normals, vertices * 12);
    if (from.second_normals && to.second_normals) copy(to.second_normal(v), from.second_normals, vertices * 12);
    if (from.colors) copy(to.color(v), from.colors, vertices * 4);
    if (from.texcoords) copy(to.texcoord(v), from.texcoords, vertices * 8);
    if (to.owners) copy(&to.owner(v), from.owners, vertices * 4);
    if (from.patches) copy(&to.patch(v), from.patches, vertices);
  }
  if (triangles > 0) copy(to.triangle(from.first_triangle), from.indices, triangles * 12);
}

}  // namespace quickses
