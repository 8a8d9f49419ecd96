// SPDX-License-Identifier: MIT
// Meshes of the C API to files.
#include "cli/mesh_output.h"

#include <vector>

#include "io/mesh_writer.h"

namespace quickses::cli {

void write_surface(const std::string &path, const qses_mesh &mesh, const io::Structure &structure) {
  std::vector<uint32_t> owners(mesh.vertex_count);  // in the file, not among the atoms that were kept
  for (uint32_t i = 0; i < mesh.vertex_count; ++i) owners[i] = structure.atoms[mesh.owners[i]].file_index;
  io::MeshView view;
  view.vertex_count = mesh.vertex_count;
  view.triangle_count = mesh.triangle_count;
  view.positions = mesh.positions;
  view.normals = mesh.normals;
  view.owners = owners.data();
  view.indices = mesh.indices;
  io::write_mesh(path, view, io::mesh_format_of(path));
}

}  // namespace quickses::cli
