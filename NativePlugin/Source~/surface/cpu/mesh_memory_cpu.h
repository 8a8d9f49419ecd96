// SPDX-License-Identifier: MIT
// The meshes of the CPU: made where the caller reads them.
#pragma once

#include "surface/cpu/cpu_kernel_executor.h"
#include "surface/cpu/solvent_features_cpu.h"
#include "surface/mesh/mesh_memory.h"
#include "surface/stages/hot_stages.h"

namespace quickses {

template <>
class MeshMemory<CpuKernelExecutor> {
 public:
  explicit MeshMemory(CpuKernelExecutor &) : meshes_(MeshPool::source<HostMemory>()) {}

  void wait_for_copies() {}
  void use_slot(int slot) { meshes_.use_slot(slot); }
  MeshHold keep(int slot) { return {meshes_.keep(slot), {}, meshes_.share_pool()}; }
  uint64_t host_bytes() const { return meshes_.bytes(); }
  // Bytes of work that are not in the arena; those that are taken off a budget for it at first; and those that it would
  // have to leave as far as is known, where the pool of features is in the arena.
  uint64_t outside_arena(const CpuKernelExecutor &executor) const { return executor.scratch_bytes(); }
  uint64_t allowed_outside(const CpuKernelExecutor &executor) const { return executor.scratch_allowance(); }
  uint64_t needed_outside(CpuKernelExecutor &executor) const {
    const uint64_t pool = executor.scratches<FeaturePool>().front()->bytes();
    return std::max(allowed_outside(executor), outside_arena(executor) - pool);
  }

  void forget_spills() {}

  MeshMemoryView allocate_mesh(CpuKernelExecutor &executor, size_t vertices, size_t triangles, const MeshShape &shape,
                               MeshPurpose purpose, bool in_pieces) {
    const MeshArrays arrays(vertices, triangles, shape);
    void *const memory = mesh_is_in_arena(false, purpose, in_pieces) ? executor.allocate<char>(arrays.bytes()).data
                                                                     : meshes_.reserve(arrays.bytes());
    return describe_memory(arrays, vertices, triangles, shape, false, memory);
  }

  template <class T>
  Span<T> allocate_where_mesh_is(CpuKernelExecutor &executor, const MeshMemoryView &, size_t n) {
    return executor.allocate<T>(n);
  }

  void save(CpuKernelExecutor &, const MeshMemoryView &, const MeshView &, size_t, size_t) {}  // never in pieces

  void deliver_to(const qses_settings &) {}
  void note_triangles(CpuKernelExecutor &) {}
  void bring_triangles(const MeshMemoryView &, MeshPurpose) {}
  void bring_vertices(CpuKernelExecutor &, const MeshMemoryView &) {}
  // Fills in both meshes and the boxes.
  void finish(const MeshMemoryView &built, const qses_settings &settings, qses_mesh *mesh, PickBoxes *boxes,
              qses_device_mesh *on_device) {
    describe_mesh(built, settings.delivery == QSES_DELIVERY_NONE ? nullptr : &built.view, settings, mesh);
    *boxes = built.view.boxes;
    qses_device_mesh_init(on_device);
    describe_mesh(built, nullptr, settings, &on_device->mesh);
    meshes_.own_numbers(mesh, &on_device->mesh);
  }

  TableView upload_table(CpuKernelExecutor &, const MarchingCubesTable &table) {
    return {table.triangle_count, table.edges, table.ring};
  }

 private:
  MeshLeases meshes_;
};

}  // namespace quickses
