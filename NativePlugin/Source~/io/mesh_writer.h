// SPDX-License-Identifier: MIT
// Triangle meshes to files: OBJ, binary PLY, binary STL.
#pragma once

#include <cstdint>
#include <string>

namespace quickses::io {

enum class MeshFormat { kObj, kPly, kStl };

// A mesh in the caller's memory.
struct MeshView {
  uint32_t vertex_count = 0;
  uint32_t triangle_count = 0;
  const float *positions = nullptr;         // vertex_count x 3, Å
  const float *normals = nullptr;           // vertex_count x 3
  const uint32_t *owners = nullptr;         // vertex_count, or null
  const uint8_t *patches = nullptr;         // vertex_count, or null
  const uint32_t *component_ids = nullptr;  // vertex_count, or null
  const uint32_t *indices = nullptr;        // triangle_count x 3
  // Of the last repeated_count vertices: which one each stands for with a normal of its own, at the same place.
  const uint32_t *repeated = nullptr;
  uint32_t repeated_count = 0;
};

// The format that the extension of a file name stands for. Throws Error (kUsage) that lists the known ones.
MeshFormat mesh_format_of(const std::string &path);

// Writes a mesh. The file appears under its name when it is complete; after an error what was there before is
// unchanged. Throws Error (kOutput).
//   OBJ  v, vn, f a//b; every number in the fewest digits from which the float32 can be read back; no owners. A place
//        is written once, so that the mesh is closed by its numbers also where vertices are repeated
//   PLY  binary little-endian; float x y z nx ny nz, int owner, int component, uchar patch where there are
//        any; uchar/uint vertex_indices
//   STL  binary; the plane's normal per triangle; vertices are repeated, no owners
void write_mesh(const std::string &path, const MeshView &mesh, MeshFormat format);

}  // namespace quickses::io
