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

  Sphere *atoms(size_t count) {
    const DeviceGuard guard(executor_.device());
    return static_cast<Sphere *>(atoms_.reserve(count * sizeof(Sphere)));
  }
  const Sphere *given_atoms() const { return static_cast<const Sphere *>(atoms_.data()); }

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
    char *host = static_cast<char *>(mesh_[1 - current_].reserve(arrays.bytes));
    if (built.vertices > 0) {
      executor_.download(host, static_cast<const char *>(device_), arrays.bytes);
      executor_.wait();
    }
    current_ = 1 - current_;
    describe_mesh(built, arrays.view(host, wants_patches(settings), false), settings, mesh);
  }

  TableView upload_table(CudaExecutor &executor, const MarchingCubesTable &table) {
    table_ = DeviceMemory::acquire(sizeof table);
    if (!table_) throw Error(QSES_OUT_OF_MEMORY, "the GPU refused memory for the tables of marching cubes");
    auto *device = static_cast<MarchingCubesTable *>(table_);
    executor.upload(device, &table, 1);
    executor.wait();
    return {device->triangle_count, device->edges, device->ring};
  }

  uint64_t mesh_bytes(const qses_mesh &m) const {
    return MeshArrays(m.vertex_count, m.triangle_count, m.patches != nullptr).bytes;
  }
  uint64_t host_bytes() const { return atoms_.size() + mesh_[0].size() + mesh_[1].size(); }

 private:
  CudaExecutor &executor_;
  PinnedBuffer atoms_, mesh_[2];
  void *table_ = nullptr, *device_ = nullptr;
  int current_ = 0;
};

}  // namespace quickses
