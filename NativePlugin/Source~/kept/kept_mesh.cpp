// SPDX-License-Identifier: MIT
#include "kept/kept_mesh.h"

#if defined(QUICKSES_HAS_CUDA)
#include "parallel/cuda_memory.h"
#endif

#include <cstring>

namespace quickses {
namespace {

template <size_t kWords>
void paint_words(const qses_mesh &mesh, const void *per_atom, uint32_t first, uint32_t count, void *per_vertex) {
  struct Value {
    unsigned char bytes[4 * kWords];
  };
  const Value *const from = static_cast<const Value *>(per_atom);
  Value *const to = static_cast<Value *>(per_vertex);
  const uint32_t *const owners = mesh.owners + first;
  for (uint32_t k = 0; k < count; ++k) to[k] = from[owners[k]];
}

}  // namespace

void KeptMesh::clear() noexcept {
  qses_mesh_init(&mesh);
  qses_report_init(&report);
  boxes = {};
  atom_count = 0;
  is_full = false;
  memory.give_back();
  downloaded_.give_back();
  on_device.reset();
  host_pool.reset();
}

void KeptMesh::download() {
  if (!on_device || !is_elsewhere()) return;
#if defined(QUICKSES_HAS_CUDA)
  const qses_device_mesh &device = on_device->view;
  const DeviceGuard guard(device.device);
  const MeshArrays arrays(mesh.vertex_count, mesh.triangle_count, on_device->shape);
  MeshLease host(host_pool, arrays.bytes());
  copy_to_host(device.device, host.memory(), on_device->memory.memory(), arrays.bytes());
  downloaded_ = std::move(host);
  const MeshView view = arrays.view(downloaded_.memory());
  point_at(view, on_device->shape, &mesh);
  boxes = view.boxes;
#endif
}

void paint(const qses_mesh &mesh, const void *per_atom, size_t value_bytes, uint32_t first, uint32_t count,
           void *per_vertex) {
  if (count == 0) return;
  switch (value_bytes / 4) {
    case 1:
      return paint_words<1>(mesh, per_atom, first, count, per_vertex);
    case 2:
      return paint_words<2>(mesh, per_atom, first, count, per_vertex);
    case 3:
      return paint_words<3>(mesh, per_atom, first, count, per_vertex);
    default:
      return paint_words<4>(mesh, per_atom, first, count, per_vertex);
  }
}

uint32_t filter(const qses_mesh &mesh, VisibleAtoms visible, uint32_t first, uint32_t count, uint32_t *indices) {
  uint32_t kept = 0;
  for (uint32_t triangle = first; triangle < first + count; ++triangle) {
    // Written either way: which triangles stay is hard to foresee.
    std::memcpy(indices + 3 * size_t(kept), mesh.indices + 3 * size_t(triangle), 3 * sizeof(uint32_t));
    kept += is_shown(mesh, triangle, visible) ? 1 : 0;
  }
  return kept;
}

}  // namespace quickses
