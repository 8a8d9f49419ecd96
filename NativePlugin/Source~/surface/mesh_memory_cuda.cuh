// SPDX-License-Identifier: MIT
// Atoms and mesh with CUDA: both pass through page-locked memory; the mesh is made on the device, behind each other in
// one piece so that one copy brings it over.
#pragma once

#include "parallel/cuda_executor.cuh"
#include "surface/mesh_memory.h"

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

  void use_slot(int slot) { slot_ = slot; }

  MeshMemoryView allocate_mesh(CudaExecutor &executor, size_t vertices, size_t triangles,
                               const qses_settings &settings) {
    const MeshArrays arrays(vertices, triangles, wants_patches(settings));
    MeshMemoryView mesh;
    mesh.vertices = vertices;
    mesh.triangles = triangles;
    device_ = executor.template allocate<char>(arrays.bytes).data;
    mesh.view = arrays.view(device_, wants_patches(settings), settings.winding == QSES_WINDING_REVERSED);
    return mesh;
  }

  void finish(const MeshMemoryView &built, const qses_settings &settings, qses_mesh *mesh) {
    const MeshArrays arrays(built.vertices, built.triangles, wants_patches(settings));
    char *host = static_cast<char *>(mesh_[slot_].reserve(arrays.bytes));
    if (built.vertices > 0) {
      executor_.download(host, static_cast<const char *>(device_), arrays.bytes);
      executor_.wait();
    }
    describe_mesh(built, arrays.view(host, wants_patches(settings), false), settings, mesh);
  }

  TableView upload_table(CudaExecutor &executor, const MarchingCubesTable &table) {
    if (!table_) table_ = DeviceMemory::acquire(sizeof table);
    if (!table_) throw Error(QSES_OUT_OF_MEMORY, "the GPU refused memory for the tables of marching cubes");
    auto *device = static_cast<MarchingCubesTable *>(table_);
    executor.upload(device, &table, 1);
    executor.wait();
    return {device->triangle_count, device->edges, device->ring};
  }

  uint64_t mesh_bytes(const qses_mesh &m) const {
    return MeshArrays(m.vertex_count, m.triangle_count, m.patches != nullptr).bytes;
  }
  uint64_t host_bytes() const {
    uint64_t sum = atoms_.bytes();
    for (const auto &slot : mesh_) sum += slot.size();
    return sum;
  }

 private:
  CudaExecutor &executor_;
  AtomPool<BufferedAtoms<PinnedBuffer>> atoms_;
  PinnedBuffer mesh_[kMeshSlots];
  void *table_ = nullptr, *device_ = nullptr;
  int slot_ = 0;
};

}  // namespace quickses
