// SPDX-License-Identifier: MIT
// Where a mesh is made and where it goes out. On the CPU the stages write straight into the memory the caller will
// read; with CUDA the mesh is made on the device and copied to page-locked memory (cuda/mesh_memory_cuda.cuh).
#pragma once

#include "surface/memory/counting_executor.h"
#include "surface/mesh/mesh_arrays.h"
#include "surface/mesh/mesh_pool.h"

namespace quickses {

struct Bounds {
  float min[3], max[3];  // Å, caller's coordinates; all 0 for an empty mesh
};

// Sums of parts of a mesh (MeshSums, stages/measure.h) that will be there on the host once it waits.
struct ComingSums {
  const void *parts = nullptr;
  size_t count = 0;
  bool are_measured = false;
};

// A mesh being made, in the memory of the back end.
struct MeshMemoryView {
  MeshView view{};
  MeshShape shape{};
  size_t vertices = 0, triangles = 0, bytes = 0;
  void *memory = nullptr;
  bool in_pieces = false;              // CUDA: it is in host memory and filled slice by slice
  bool is_brought = false;             // CUDA: its vertices are painted and on their way to the host, as its triangles
  const uint32_t *unplaced = nullptr;  // vertices without a feature, in the memory of the back end; nullptr: none
  Bounds bounds{};
  ComingSums coming{};                      // CUDA: of the bounds, and what else the report gets (settle_sums)
  Span<const qses_component> components{};  // in host memory
  Span<const double> atom_areas{};          // the same
};

// What a mesh is for: to be handed out, or to be made into another one.
enum class MeshPurpose { kDelivered, kWork };

// Whether a mesh takes memory that counts as work: of the arena, or of the device.
constexpr bool mesh_is_in_arena(bool is_cuda, MeshPurpose purpose, bool in_pieces) {
  return is_cuda ? !in_pieces : purpose == MeshPurpose::kWork;
}

inline MeshShape without_spare(MeshShape shape) {
  shape.spare_vertices = shape.spare_triangles = 0;
  return shape;
}

// So much of what was allocated is the mesh; the rest is spare.
inline void narrow_mesh(MeshMemoryView *mesh, size_t vertices, size_t triangles) {
  mesh->shape.spare_vertices += mesh->vertices - vertices;
  mesh->shape.spare_triangles += mesh->triangles - triangles;
  mesh->vertices = vertices;
  mesh->triangles = triangles;
  mesh->bytes = MeshArrays(vertices, triangles, without_spare(mesh->shape)).bytes();
}

inline MeshMemoryView describe_memory(const MeshArrays &arrays, size_t vertices, size_t triangles,
                                      const MeshShape &shape, bool in_pieces, void *memory) {
  MeshMemoryView mesh;
  mesh.shape = shape;
  mesh.vertices = vertices;
  mesh.triangles = triangles;
  mesh.bytes = arrays.bytes();
  mesh.in_pieces = in_pieces;
  mesh.memory = memory;
  mesh.view = arrays.view(memory);
  return mesh;
}

// As of qses_mesh.vertex_bytes.
inline uint32_t interleaved_bytes(const MeshView &arrays, const MeshShape &shape) {
  return shape.layout == QSES_VERTICES_SEPARATE ? 0 : arrays.vertex_bytes;
}

inline void point_at(const MeshView &arrays, const MeshShape &shape, qses_mesh *mesh) {
  mesh->positions = arrays.positions;
  mesh->normals = arrays.normals;
  mesh->colors = reinterpret_cast<const uint8_t *>(arrays.colors);
  mesh->texcoords = arrays.texcoords;
  mesh->vertex_bytes = interleaved_bytes(arrays, shape);
  mesh->owners = arrays.owners;
  mesh->patches = arrays.patches;
  mesh->indices = arrays.indices;
  mesh->repeated = arrays.repeated;
  mesh->repeated_count = shape.repeated;
  mesh->component_ids = arrays.component_ids;
}

// Points the caller's view at a finished mesh. arrays: where they are; nullptr: not here.
inline void describe_mesh(const MeshMemoryView &built, const MeshView *arrays, const qses_settings &settings,
                          qses_mesh *mesh) {
  qses_mesh_init(mesh);
  mesh->tag = settings.tag;
  mesh->vertex_count = static_cast<uint32_t>(built.vertices);
  mesh->triangle_count = static_cast<uint32_t>(built.triangles);
  mesh->component_count = static_cast<uint32_t>(built.components.size);
  mesh->components = built.components.data;
  mesh->atom_count = built.atom_areas.size;
  mesh->atom_areas = built.atom_areas.data;
  if (built.vertices == 0) return;
  for (int d = 0; d < 3; ++d) {
    mesh->bounds_min[d] = built.bounds.min[d];
    mesh->bounds_max[d] = built.bounds.max[d];
  }
  mesh->vertex_bytes = interleaved_bytes(built.view, built.shape);  // also where the arrays are not
  mesh->has_texcoords = built.shape.texcoords ? 1 : 0;
  if (arrays) point_at(*arrays, built.shape, mesh);
}

// Where a mesh that goes out has its memory.
struct MeshHold {
  MeshLease on_host, on_device;
  std::shared_ptr<MeshPool> host_pool;  // for a copy on the host, if it is only on the device
};

// A mesh as it goes out, with its memory: whoever has it may let go of it on any thread.
struct FinishedMesh {
  qses_mesh on_host;
  PickBoxes boxes;             // beside it
  qses_delivery delivery;      // where it was wanted
  qses_device_mesh on_device;  // empty arrays unless settings.delivery asks for it
  MeshShape shape;
  qses_report report;
  MeshHold memory;
};

// The memory of the mesh that is being made, of a pool of its own.
class PooledMesh {
 public:
  explicit PooledMesh(MeshPool::Source source) : pool_(std::make_shared<MeshPool>(std::move(source))) {}
  ~PooledMesh() { pool_->close(); }
  PooledMesh(const PooledMesh &) = delete;
  PooledMesh &operator=(const PooledMesh &) = delete;

  // What it had is given back.
  void *reserve(size_t bytes) {
    lease_.give_back();
    lease_ = MeshLease(pool_, bytes);
    return lease_.memory();
  }
  // What is in memory of whoever found it goes into that of the mesh, which is reserved by then, if it is to be.
  void own_numbers(MeshMemoryView *mesh) {
    mesh->components.data = own(MeshLease::kComponents, mesh->components);
    mesh->atom_areas.data = own(MeshLease::kAtomAreas, mesh->atom_areas);
  }
  // It won't be finished.
  void forget() { lease_.give_back(); }
  // Of the mesh that is finished.
  MeshLease take() { return std::move(lease_); }
  MeshLease &lease() { return lease_; }
  MeshPool &pool() { return *pool_; }
  std::shared_ptr<MeshPool> share_pool() const { return pool_; }
  uint64_t bytes() const { return pool_->bytes(); }

 private:
  template <class T>
  const T *own(MeshLease::Numbers which, Span<const T> numbers) {
    if (numbers.size == 0) return nullptr;
    if (lease_.is_empty()) lease_ = MeshLease(pool_, 0);
    return static_cast<const T *>(lease_.add(which, numbers.data, numbers.size * sizeof(T)));
  }

  std::shared_ptr<MeshPool> pool_;
  MeshLease lease_;
};

// Executor: whose memory the stages write to.
template <class Executor>
class MeshMemory;

// Only counted.
template <class Executor>
class MeshMemory<CountingExecutor<Executor>> {
 public:
  // keeps: whether a mesh that is handed out stays on the device, in memory of a pool.
  explicit MeshMemory(bool keeps = false) : keeps_(keeps) {}
  void forget_spills() {}
  MeshMemoryView allocate_mesh(CountingExecutor<Executor> &executor, size_t vertices, size_t triangles,
                               const MeshShape &shape, MeshPurpose purpose, bool in_pieces) {
    const MeshArrays arrays(vertices, triangles, shape);
    if (keeps_ && purpose == MeshPurpose::kDelivered)
      kept_ = std::max<uint64_t>(kept_, MeshPool::size_for(arrays.bytes()));
    else if (mesh_is_in_arena(Executor::kIsCuda, purpose, in_pieces))
      executor.template allocate<char>(arrays.bytes());
    return describe_memory(arrays, vertices, triangles, shape, Executor::kIsCuda && in_pieces, nullptr);
  }
  template <class T>
  Span<T> allocate_where_mesh_is(CountingExecutor<Executor> &executor, const MeshMemoryView &mesh, size_t n) {
    if (!mesh.in_pieces) executor.template allocate<T>(n);
    return {nullptr, n};
  }
  void save(CountingExecutor<Executor> &, const MeshMemoryView &, const MeshView &, size_t, size_t) {}
  void note_triangles(CountingExecutor<Executor> &) {}
  void bring_triangles(const MeshMemoryView &, MeshPurpose, size_t) {}
  void bring_vertices(CountingExecutor<Executor> &, const MeshMemoryView &) {}
  // Bytes of the mesh that stays. In the end they are kept free of work from the beginning.
  uint64_t kept() const { return kept_; }

 private:
  const bool keeps_;
  uint64_t kept_ = 0;
};

}  // namespace quickses
