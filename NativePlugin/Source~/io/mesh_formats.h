// SPDX-License-Identifier: MIT
// The writers of each format of meshes; see mesh_writer.h. The file is not committed by them. Throw Error (kOutput).
#pragma once

#include "io/atomic_file.h"
#include "io/mesh_writer.h"

namespace quickses::io {

void write_obj(AtomicFile &file, const MeshView &mesh);
void write_ply(AtomicFile &file, const MeshView &mesh);
void write_ply_text(AtomicFile &file, const MeshView &mesh);
void write_stl(AtomicFile &file, const MeshView &mesh);
void write_glb(AtomicFile &file, const MeshView &mesh);
void write_off(AtomicFile &file, const MeshView &mesh);
void write_msms_vertices(AtomicFile &file, const MeshView &mesh);
void write_msms_faces(AtomicFile &file, const MeshView &mesh);

// Whether a colour is not opaque.
bool has_alpha(const MeshView &mesh);

// The vertices that are places of their own, and the one of them that has the place of a vertex.
inline uint32_t place_count(const MeshView &mesh) { return mesh.vertex_count - mesh.repeated_count; }
inline uint32_t place_of(const MeshView &mesh, uint32_t vertex) {
  return vertex < place_count(mesh) ? vertex : mesh.repeated[vertex - place_count(mesh)];
}

}  // namespace quickses::io
