// SPDX-License-Identifier: MIT
// Where the atoms come in and the mesh goes out. On the CPU the stages write straight into the memory the caller will
// read; with CUDA the mesh is made on the device and copied to page-locked memory (mesh_memory_cuda.cuh).
#pragma once

#include "parallel/cpu_executor.h"
#include "parallel/growing_buffer.h"
#include "parallel/sole_holder.h"
#include "surface/stages/components.h"
#include "surface/mesh/mesh_arrays.h"
#include "surface/methods/level_work.h"

#include <memory>
#include <mutex>
#include <vector>

namespace quickses {

// Points the caller's view at a finished mesh. host: the same arrays in host memory.
inline void describe_mesh(const MeshMemoryView &built, const MeshView &host, const qses_settings &settings,
                          qses_mesh *mesh) {
  qses_mesh_init(mesh);
  mesh->tag = settings.tag;
  mesh->vertex_count = static_cast<uint32_t>(built.vertices);
  mesh->triangle_count = static_cast<uint32_t>(built.triangles);
  mesh->component_count = static_cast<uint32_t>(built.components.size);
  mesh->components = built.components.data;
  if (built.vertices == 0) return;
  mesh->positions = host.positions;
  mesh->normals = host.normals;
  mesh->colors = reinterpret_cast<const uint8_t *>(host.colors);
  mesh->texcoords = host.texcoords;
  mesh->vertex_bytes = host.vertex_bytes;
  mesh->owners = host.owners;
  mesh->patches = host.patches;
  mesh->indices = host.indices;
  for (int d = 0; d < 3; ++d) {
    mesh->bounds_min[d] = built.bounds.min[d];
    mesh->bounds_max[d] = built.bounds.max[d];
  }
}

// Sets of atoms that are used again when nobody holds them any more. Set: an AtomSet with resize(count).
template <class Set>
class AtomPool {
 public:
  std::shared_ptr<AtomSet> make(size_t count) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const std::shared_ptr<Set> &set : sets_)
      if (is_sole_holder(set)) {
        set->resize(count);
        return set;
      }
    auto made = std::make_shared<Set>();
    made->resize(count);
    sets_.push_back(made);
    return made;
  }
  uint64_t bytes() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    uint64_t sum = 0;
    for (const std::shared_ptr<Set> &set : sets_) sum += set->memory.size();
    return sum;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<Set>> sets_;
};

template <class Buffer>
struct BufferedAtoms : AtomSet {
  Buffer memory;
  void resize(size_t n) {
    count = 0;
    atoms = static_cast<Sphere *>(memory.reserve(n * sizeof(Sphere)));
    count = n;
  }
};

// The host memory of both back ends.
template <class Source>
class HostSide {
 public:
  std::shared_ptr<AtomSet> make_atoms(size_t count) { return atoms_.make(count); }
  void use_slot(int slot) {
    slot_ = slot;
    components_.use_slot(slot);
  }
  // Room for the mesh that is handed out: as much as for any before, since which slot gets the finest level differs
  // from frame to frame.
  void *reserve_mesh(size_t bytes) {
    largest_ = std::max(largest_, bytes);
    try {
      return mesh_[slot_].reserve(largest_);
    } catch (const MemoryRefused &) {
      return mesh_[slot_].reserve(largest_ = bytes);
    }
  }
  ComponentMemory &components() { return components_; }
  // Bytes of all.
  uint64_t bytes() const {
    uint64_t sum = atoms_.bytes() + components_.bytes();
    for (const auto &slot : mesh_) sum += slot.size();
    return sum;
  }

 private:
  AtomPool<BufferedAtoms<GrowingBuffer<Source>>> atoms_;
  GrowingBuffer<Source> mesh_[kMeshSlots];
  ComponentMemory components_;
  size_t largest_ = 0;  // bytes of a mesh
  int slot_ = 0;
};

template <>
class MeshMemory<CpuExecutor> {
 public:
  explicit MeshMemory(CpuExecutor &) {}

  std::shared_ptr<AtomSet> make_atoms(size_t count) { return host_.make_atoms(count); }
  void use_slot(int slot) { host_.use_slot(slot); }
  uint64_t host_bytes() const { return host_.bytes(); }
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
    mesh.view = arrays.view(purpose == MeshPurpose::kDelivered ? host_.reserve_mesh(arrays.bytes())
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
                                                 spacing, host_.components());
  }

  void finish(const MeshMemoryView &built, const qses_settings &settings, qses_mesh *mesh) {
    describe_mesh(built, built.view, settings, mesh);
  }

  TableView upload_table(CpuExecutor &, const MarchingCubesTable &table) {
    return {table.triangle_count, table.edges, table.ring};
  }

 private:
  HostSide<HostMemory> host_;
};

}  // namespace quickses
