// SPDX-License-Identifier: MIT
// The meshes of the CPU: made where the caller reads them.
#pragma once

#include "surface/cpu/cpu_kernel_executor.h"
#include "surface/memory/atom_set.h"
#include "surface/mesh/mesh_memory.h"
#include "surface/stages/components.h"

#include <cstring>

namespace quickses {

template <>
class MeshMemory<CpuKernelExecutor> {
 public:
  explicit MeshMemory(CpuKernelExecutor &) {}

  std::shared_ptr<AtomSet> make_atoms(size_t count) { return atoms_.make(count); }
  void use_slot(int slot) {
    slots_.use_slot(slot);
    components_.use_slot(slot);
  }
  uint64_t host_bytes() const { return atoms_.bytes() + slots_.bytes() + components_.bytes(); }
  // Bytes of work that are not in the arena, and those that are taken off a budget for it.
  uint64_t beside_arena(const CpuExecutor &executor) const { return executor.scratch_bytes(); }
  uint64_t allowed_beside(const CpuExecutor &executor) const { return executor.scratch_allowance(); }

  void forget_spills() {}

  MeshMemoryView allocate_mesh(CpuExecutor &executor, size_t vertices, size_t triangles, const MeshShape &shape,
                               MeshPurpose purpose, uint64_t /*reserve*/) {
    const MeshArrays arrays(vertices, triangles, shape);
    MeshMemoryView mesh;
    mesh.shape = shape;
    mesh.vertices = vertices;
    mesh.triangles = triangles;
    mesh.bytes = arrays.bytes();
    mesh.view = arrays.view(purpose == MeshPurpose::kDelivered ? slots_.reserve(arrays.bytes())
                                                               : executor.allocate<char>(arrays.bytes()).data);
    return mesh;
  }

  template <class T>
  Span<T> allocate_beside(CpuExecutor &executor, const MeshMemoryView &, size_t n) {
    return executor.allocate<T>(n);
  }

  void save(CpuExecutor &, const MeshMemoryView &mesh, const MeshView &part, size_t vertices, size_t triangles) {
    for_each_array(mesh.view, part, vertices, triangles,
                   [](void *to, const void *from, size_t bytes) { std::memcpy(to, from, bytes); });
  }

  void find_components(CpuExecutor &executor, float spacing, MeshPurpose, MeshMemoryView *mesh) {
    mesh->components = quickses::find_components(executor, mesh->view, MeshCounts{mesh->vertices, mesh->triangles},
                                                 spacing, components_);
  }

  void finish(const MeshMemoryView &built, const qses_settings &settings, qses_mesh *mesh) {
    describe_mesh(built, built.view, settings, mesh);
  }

  TableView upload_table(CpuExecutor &, const MarchingCubesTable &table) {
    return {table.triangle_count, table.edges, table.ring};
  }

 private:
  AtomPool<HostMemory> atoms_;
  MeshSlots<HostMemory> slots_;
  ComponentMemory components_;
};

}  // namespace quickses
