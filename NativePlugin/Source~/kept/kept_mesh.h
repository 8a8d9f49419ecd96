// SPDX-License-Identifier: MIT
// A finished mesh that is held on to, and what is asked of it on the host.
#pragma once

#include "kept/device_mesh.h"
#include "surface/stages/appearance.h"

#include <memory>

namespace quickses {

struct KeptMesh {
  qses_mesh mesh;  // on the host, like the boxes
  PickBoxes boxes;
  qses_report report;
  size_t atom_count = 0;
  MeshLease memory;
  std::shared_ptr<const DeviceMesh> on_device;  // null: it is not there
  std::shared_ptr<MeshPool> host_pool;
  bool is_full = false;

  KeptMesh() { clear(); }
  void clear() noexcept;
  // Whether there is a mesh without a copy on the host.
  bool is_elsewhere() const { return mesh.vertex_count > 0 && !mesh.positions; }
  // Copies it from the device, if it is only there. Throws Error; it is as it was then.
  void download();

 private:
  MeshLease downloaded_;
};

inline bool is_shown(const qses_mesh &mesh, uint32_t triangle, VisibleAtoms visible) {
  return is_shown(mesh.indices + 3 * size_t(triangle), mesh.owners, visible);
}

// Values of so many bytes (4, 8, 12 or 16) of the atoms that own the vertices.
void paint(const qses_mesh &mesh, const void *per_atom, size_t value_bytes, uint32_t first, uint32_t count,
           void *per_vertex);

// The triangles of a run that are shown. Returns how many.
uint32_t filter(const qses_mesh &mesh, VisibleAtoms visible, uint32_t first, uint32_t count, uint32_t *indices);

// The first triangle that a ray meets. The numbers are finite, the direction has a length. Without boxes it looks at
// all triangles.
qses_hit pick(const qses_mesh &mesh, const PickBoxes &boxes, const float origin[3], const float direction[3],
              VisibleAtoms visible);

}  // namespace quickses
