// SPDX-License-Identifier: MIT
// Atoms and mesh with CUDA: both pass through page-locked memory. The mesh is made on the device, its arrays behind
// each other so that one copy brings them over. Where it does not fit there, its place is page-locked memory, which
// kernels reach as well, slowly: what makes most of it goes through slabs on the device.
#pragma once

#include "parallel/cuda_executor.cuh"
#include "surface/memory/atom_set.h"
#include "surface/mesh/mesh_memory.h"
#include "surface/stages/components.h"
#include "surface/stages/host_components.h"

namespace quickses {

template <>
class MeshMemory<CudaExecutor> {
 public:
  explicit MeshMemory(CudaExecutor &executor) : executor_(executor) {}
  ~MeshMemory() { DeviceMemory::release(table_); }

  std::shared_ptr<AtomSet> make_atoms(size_t count) {
    const DeviceGuard guard(executor_.device());
    return atoms_.make(count);
  }
  void use_slot(int slot) {
    slots_.use_slot(slot);
    components_.use_slot(slot);
  }
  // What was allocated beside a mesh on the host, or as one to be made into another, is given up.
  void forget_spills() { spilled_ = 0; }
  uint64_t host_bytes() const {
    uint64_t sum = atoms_.bytes() + slots_.bytes() + components_.bytes() + host_components_.bytes();
    for (const PinnedBuffer &spill : spill_) sum += spill.size();
    return sum;
  }

  // Bytes of the device that are not in the arena.
  uint64_t beside_arena(const CudaExecutor &) const { return sizeof(MarchingCubesTable); }
  uint64_t allowed_beside(const CudaExecutor &executor) const { return beside_arena(executor); }

  MeshMemoryView allocate_mesh(CudaExecutor &executor, size_t vertices, size_t triangles, const MeshShape &shape,
                               MeshPurpose purpose, uint64_t reserve) {
    const MeshArrays arrays(vertices, triangles, shape);
    MeshMemoryView mesh;
    mesh.shape = shape;
    mesh.vertices = vertices;
    mesh.triangles = triangles;
    mesh.bytes = arrays.bytes();
    mesh.on_host = executor.arena().available() < arrays.bytes() + reserve;
    if (!mesh.on_host) {
      const auto mark = executor.arena().mark();
      try {
        mesh.memory = executor.template allocate<char>(arrays.bytes()).data;
      } catch (const MemoryRefused &) {
        executor.arena().rewind(mark);
        mesh.on_host = true;
      }
    }
    if (mesh.on_host) mesh.memory = reserve_on_host(arrays.bytes(), purpose);
    mesh.view = arrays.view(mesh.memory);
    return mesh;
  }

  // Room for something as large as the mesh, where the mesh is.
  template <class T>
  Span<T> allocate_beside(CudaExecutor &executor, const MeshMemoryView &mesh, size_t n) {
    if (!mesh.on_host) return executor.template allocate<T>(n);
    return {static_cast<T *>(spill(n * sizeof(T))), n};
  }

  // Copies a part from the device to its place in a mesh on the host.
  void save(CudaExecutor &executor, const MeshMemoryView &mesh, const MeshView &part, size_t vertices,
            size_t triangles) {
    for_each_array(mesh.view, part, vertices, triangles, [&](void *to, const void *from, size_t bytes) {
      executor.download(static_cast<char *>(to), static_cast<const char *>(from), bytes);
    });
  }

  // On the device; where its memory does not suffice, by the CPU on the host, where the mesh then stays. The numbers
  // are the same.
  void find_components(CudaExecutor &executor, float spacing, MeshPurpose purpose, MeshMemoryView *mesh) {
    const MeshCounts counts{mesh->vertices, mesh->triangles};
    if (!mesh->on_host) {
      const auto mark = executor.arena().mark();
      try {
        mesh->components = quickses::find_components(executor, mesh->view, counts, spacing, components_);
        return;
      } catch (const MemoryRefused &) {
        executor.arena().rewind(mark);
      }
      move_to_host(executor, purpose, mesh);
    }
    executor.wait();
    mesh->components = host_components_.find(mesh->view, counts, spacing, components_);
  }

  void finish(const MeshMemoryView &built, const qses_settings &settings, qses_mesh *mesh) {
    const MeshArrays arrays(built.vertices, built.triangles, built.shape);
    MeshView host = built.view;
    if (built.vertices > 0) {
      if (!built.on_host) {
        char *const memory = static_cast<char *>(slots_.reserve(arrays.bytes()));
        executor_.download(memory, static_cast<const char *>(built.memory), arrays.bytes());
        host = arrays.view(memory);
      }
      executor_.wait();
    }
    describe_mesh(built, host, settings, mesh);
  }

  TableView upload_table(CudaExecutor &executor, const MarchingCubesTable &table) {
    if (!table_) table_ = DeviceMemory::acquire(sizeof table);
    if (!table_) throw MemoryRefused("the GPU refused memory for the tables of marching cubes");
    auto *device = static_cast<MarchingCubesTable *>(table_);
    executor.upload(device, &table, 1);
    executor.wait();
    return {device->triangle_count, device->edges, device->ring};
  }

 private:
  void *reserve_on_host(size_t bytes, MeshPurpose purpose) {
    return purpose == MeshPurpose::kDelivered ? slots_.reserve(bytes) : spill(bytes);
  }

  // The values are there after the next wait.
  void move_to_host(CudaExecutor &executor, MeshPurpose purpose, MeshMemoryView *mesh) {
    const MeshArrays arrays(mesh->vertices, mesh->triangles, mesh->shape);
    void *const memory = reserve_on_host(arrays.bytes(), purpose);
    executor.download(static_cast<char *>(memory), static_cast<const char *>(mesh->memory), arrays.bytes());
    mesh->memory = memory;
    mesh->view = arrays.view(memory);
    mesh->on_host = true;
  }

  // At most the unmasked mesh, sums and starts at a time.
  void *spill(size_t bytes) {
    constexpr size_t kSpills = sizeof spill_ / sizeof spill_[0];
    if (spilled_ == kSpills) throw Error(QSES_INTERNAL_ERROR, "too many arrays beside a mesh");
    return spill_[spilled_++].reserve(bytes);
  }

  CudaExecutor &executor_;
  AtomPool<PinnedMemory> atoms_;
  MeshSlots<PinnedMemory> slots_;
  ComponentMemory components_;
  PinnedBuffer spill_[4];
  size_t spilled_ = 0;
  HostComponents host_components_;
  void *table_ = nullptr;
};

}  // namespace quickses
