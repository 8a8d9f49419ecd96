// SPDX-License-Identifier: MIT
// Meshes of the C API to files.
#include "cli/mesh_output.h"

#include <vector>

#include "cli/exit_code.h"
#include "cli/mesh_check.h"
#include "io/mesh_writer.h"

namespace quickses::cli {

void accept_surface(const std::string &path, const qses_mesh &mesh, const io::Structure &structure) {
  if (!is_closed(mesh))
    throw Failure(kComputingFailed,
                  "the surface that was computed is not closed, so it is not used: a fault of this program; please "
                  "report it with the input and the settings (another --spacing may help meanwhile)");
  if (path.empty()) return;
  std::vector<uint32_t> owners(mesh.vertex_count);  // in the file, not among the atoms that were kept
  for (uint32_t i = 0; i < mesh.vertex_count; ++i) owners[i] = structure.atoms[mesh.owners[i]].file_index;
  io::MeshView view;
  view.vertex_count = mesh.vertex_count;
  view.triangle_count = mesh.triangle_count;
  view.positions = mesh.positions;
  view.normals = mesh.normals;
  view.owners = owners.data();
  view.component_ids = mesh.component_ids;
  view.indices = mesh.indices;
  view.repeated = mesh.repeated;
  view.repeated_count = static_cast<uint32_t>(mesh.repeated_count);
  io::write_mesh(path, view, io::mesh_format_of(path));
}

}  // namespace quickses::cli
