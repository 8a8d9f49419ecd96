// SPDX-License-Identifier: MIT
// Where the atoms come in and the mesh goes out. On the CPU the stages write straight into the memory the caller will
// read; with CUDA the mesh is made on the device and copied to page-locked memory (mesh_memory_cuda.cuh).
#pragma once

#include "parallel/cpu_executor.h"
#include "surface/run.h"

#include <memory>
#include <mutex>
#include <vector>

namespace quickses {

// Host memory that only grows, without initialisation.
template <class Source>
class GrowingBuffer {
 public:
  GrowingBuffer() = default;
  GrowingBuffer(const GrowingBuffer &) = delete;
  GrowingBuffer &operator=(const GrowingBuffer &) = delete;
  ~GrowingBuffer() { Source::release(memory_); }

  // At least this many bytes; what was in it is lost if it has to grow.
  void *reserve(size_t bytes) {
    if (bytes > size_) {
      const size_t wanted = bytes + bytes / 8;
      void *memory = Source::acquire(wanted);
      if (!memory)
        throw Error(QSES_OUT_OF_MEMORY,
                    std::string(Source::kName) + " refused " + describe_bytes(wanted) + " for the mesh");
      Source::release(memory_);
      memory_ = memory;
      size_ = wanted;
    }
    return memory_;
  }
  void *data() const { return memory_; }
  size_t size() const { return size_; }

 private:
  void *memory_ = nullptr;
  size_t size_ = 0;
};

// The arrays of one mesh behind each other in one buffer, each on a 256-byte boundary.
struct MeshArrays {
  size_t positions, normals, owners, patches, indices, bytes;
  MeshArrays(size_t vertices, size_t triangles, bool with_patches) {
    size_t at = 0;
    const auto next = [&](size_t n) {
      const size_t here = at;
      at += (n + 255) / 256 * 256;
      return here;
    };
    positions = next(vertices * 12);
    normals = next(vertices * 12);
    owners = next(vertices * 4);
    patches = with_patches ? next(vertices) : 0;
    indices = next(triangles * 12);
    bytes = at;
  }
  MeshView view(void *memory, bool with_patches, bool reversed) const {
    char *base = static_cast<char *>(memory);
    return {reinterpret_cast<float *>(base + positions),
            reinterpret_cast<float *>(base + normals),
            reinterpret_cast<uint32_t *>(base + owners),
            with_patches ? reinterpret_cast<uint8_t *>(base + patches) : nullptr,
            reinterpret_cast<uint32_t *>(base + indices),
            reversed};
  }
};

inline bool wants_patches(const qses_settings &s) { return s.patch_types != 0 && s.method == QSES_METHOD_EXACT; }

// Points the caller's view at a finished mesh.
inline void describe_mesh(const MeshMemoryView &built, const MeshView &host, const qses_settings &settings,
                          qses_mesh *mesh) {
  qses_mesh_init(mesh);
  mesh->frame = settings.frame;
  mesh->vertex_count = static_cast<uint32_t>(built.vertices);
  mesh->triangle_count = static_cast<uint32_t>(built.triangles);
  if (built.vertices == 0) return;
  mesh->positions = host.positions;
  mesh->normals = host.normals;
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
      if (set.use_count() == 1) {
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
    atoms = static_cast<Sphere *>(memory.reserve(n * sizeof(Sphere)));
    count = n;
  }
};

template <>
class MeshMemory<CpuExecutor> {
 public:
  explicit MeshMemory(CpuExecutor &) {}

  std::shared_ptr<AtomSet> make_atoms(size_t count) { return atoms_.make(count); }

  void use_slot(int slot) { slot_ = slot; }

  MeshMemoryView allocate_mesh(CpuExecutor &, size_t vertices, size_t triangles, const qses_settings &settings) {
    const MeshArrays arrays(vertices, triangles, wants_patches(settings));
    MeshMemoryView mesh;
    mesh.vertices = vertices;
    mesh.triangles = triangles;
    mesh.view = arrays.view(mesh_[slot_].reserve(arrays.bytes), wants_patches(settings),
                            settings.winding == QSES_WINDING_REVERSED);
    return mesh;
  }

  void finish(const MeshMemoryView &built, const qses_settings &settings, qses_mesh *mesh) {
    describe_mesh(built, built.view, settings, mesh);
  }

  TableView upload_table(CpuExecutor &, const MarchingCubesTable &table) {
    return {table.triangle_count, table.edges, table.ring};
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
  AtomPool<BufferedAtoms<GrowingBuffer<HostMemory>>> atoms_;
  GrowingBuffer<HostMemory> mesh_[kMeshSlots];
  int slot_ = 0;
};

}  // namespace quickses
