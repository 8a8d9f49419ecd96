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
  explicit MeshMemory(CpuKernelExecutor &) : mesh_(MeshPool::source<HostMemory>()) {}

  // One that was begun and given up.
  void forget_mesh() { mesh_.forget(); }
  uint64_t host_bytes() const { return mesh_.bytes(); }
  // Bytes of work that are not in the arena; those that are taken off a budget for it at first; and those that it would
  // have to leave as far as is known, where the pool of features is in the arena.
  uint64_t outside_arena(const CpuKernelExecutor &executor) const { return executor.scratch_bytes(); }
  uint64_t allowed_outside(const CpuKernelExecutor &executor) const { return executor.scratch_allowance(); }
  uint64_t needed_outside(CpuKernelExecutor &executor) const {
    const uint64_t pool = executor.scratches<FeaturePool>().front()->bytes();
    return std::max(allowed_outside(executor), outside_arena(executor) - pool);
  }

  // Of that, what is only kept from frame to frame: false if there is none.
  bool drop_kept_outside(CpuKernelExecutor &executor) { return executor.drop_grown_scratch(); }

  void forget_spills() {}

  MeshMemoryView allocate_mesh(CpuKernelExecutor &executor, size_t vertices, size_t triangles, const MeshShape &shape,
                               MeshPurpose purpose, bool in_pieces) {
    const MeshArrays arrays(vertices, triangles, shape);
    void *memory;
    if (mesh_is_in_arena(false, purpose, in_pieces)) {
      memory = executor.allocate<char>(arrays.bytes()).data;
    } else {
      check_free_memory(executor, arrays.bytes());
      memory = mesh_.reserve(arrays.bytes());
    }
    return describe_memory(arrays, vertices, triangles, shape, false, memory);
  }

  template <class T>
  Span<T> allocate_where_mesh_is(CpuKernelExecutor &executor, const MeshMemoryView &, size_t n) {
    return executor.allocate<T>(n);
  }

  void save(CpuKernelExecutor &, const MeshMemoryView &, const MeshView &, size_t, size_t) {}  // never in pieces

  void deliver_to(const qses_settings &) { forget_mesh(); }
  void note_triangles(CpuKernelExecutor &) {}
  void bring_triangles(const MeshMemoryView &, MeshPurpose, size_t) {}
  void bring_vertices(CpuKernelExecutor &, const MeshMemoryView &) {}
  // A mesh that is complete gets memory for all that goes out with it.
  void send(MeshMemoryView *built) { mesh_.own_numbers(built); }
  // Hands it out: all but the report.
  void finish(const MeshMemoryView &built, const qses_settings &settings, FinishedMesh *out) {
    MeshView arrays = built.view;
    if (leaves_owners(settings)) arrays.owners = nullptr;
    describe_mesh(built, settings.delivery == QSES_DELIVERY_NONE ? nullptr : &arrays, settings, &out->on_host);
    out->boxes = built.view.boxes;
    qses_device_mesh_init(&out->on_device);
    describe_mesh(built, nullptr, settings, &out->on_device.mesh);
    out->delivery = settings.delivery;
    out->shape = built.shape;
    out->memory = {mesh_.take(), {}, mesh_.share_pool()};
  }

  TableView upload_table(CpuKernelExecutor &, const MarchingCubesTable &table) {
    return {table.triangle_count, table.edges, table.ring};
  }

 private:
  // The machine gives what it does not have, and ends the program once that is written to. So a large mesh is refused
  // if there is no room for it beside what the arena has yet to write to.
  void check_free_memory(CpuKernelExecutor &executor, uint64_t bytes) {
    constexpr uint64_t kLarge = uint64_t(32) << 20;  // to ask takes some 20 microseconds
    const auto &arena = executor.arena();
    if (bytes < kLarge || arena.has_budget()) return;
    mesh_.forget();
    if (mesh_.pool().bytes_with(bytes) == mesh_.bytes()) return;  // there is one
    const uint64_t free = HostMemory::free_bytes();
    if (free == 0 || bytes + arena.untouched() <= free) return;
    mesh_.pool().drop_spares();
    const uint64_t now_free = HostMemory::free_bytes();
    if (bytes + arena.untouched() > now_free)
      throw MemoryRefused("the machine has " + describe_bytes(now_free) + " left, and the mesh takes " +
                          describe_bytes(bytes));
  }

  PooledMesh mesh_;
};

}  // namespace quickses
