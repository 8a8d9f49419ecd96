// SPDX-License-Identifier: MIT
// The meshes of the GPU: made on the device, and their arrays brought to page-locked memory. In pieces: the mesh is in
// page-locked memory from the beginning, which kernels reach as well, slowly; what makes most of it goes through parts
// on the device. A mesh that is wanted on the device has memory of a pool there.
#pragma once

#include "parallel/cuda_executor.cuh"
#include "process/later_release.h"
#include "surface/mesh/mesh_memory.h"
#include "surface/stages/hot_stages.h"
#include "surface/stages/measure.h"

#include <deque>
#include <new>

namespace quickses {

// Memory of a device, for a pool: whoever gives it back last may be on any thread, that which draws among them, and the
// driver gives memory back behind all that the device has to do.
struct DeviceMeshMemory {
  int device;
  void *memory;
  std::shared_ptr<const StreamMark> readers;

  void release() const {
    if (readers) readers->wait();
    try {
      const DeviceGuard guard(device);
      DeviceMemory::release(memory);
    } catch (...) {  // the device is lost, and its memory with it
    }
  }
};
inline MeshPool::Source device_meshes_of(int device) {
  MeshPool::Source source;
  source.name = DeviceMemory::kName;
  source.acquire = [device](size_t bytes) {
    const DeviceGuard guard(device);
    return DeviceMemory::acquire(bytes);
  };
  source.release = [device](MeshBuffer &buffer) {
    DeviceMeshMemory{device, buffer.memory, std::move(buffer.readers)}.release();
  };
  source.release_later = [device, now = source.release](MeshBuffer &buffer) {
    auto *const later = new (std::nothrow) DeviceMeshMemory{device, buffer.memory, buffer.readers};
    if (!later) return now(buffer);
    release_later(
        [](void *mesh) {
          static_cast<DeviceMeshMemory *>(mesh)->release();
          delete static_cast<DeviceMeshMemory *>(mesh);
        },
        later);
  };
  source.most_of_the_largest = 2;
  return source;
}

// Page-locked memory, for a pool. To unlock its pages takes milliseconds.
inline MeshPool::Source page_locked_meshes() {
  MeshPool::Source source = MeshPool::source<PinnedMemory>();
  source.release = [](MeshBuffer &buffer) { release_later(PinnedMemory::release, buffer.memory); };
  return source;
}

template <>
class MeshMemory<CudaExecutor> {
 public:
  explicit MeshMemory(CudaExecutor &executor) : MeshMemory(executor, executor.stream_handle()) {}
  // told: the stream that callers are told of.
  MeshMemory(CudaExecutor &executor, cudaStream_t told)
      : executor_(executor),
        told_stream_(told),
        host_mesh_(page_locked_meshes()),
        device_mesh_(device_meshes_of(executor.device())) {}
  ~MeshMemory() {
    try {
      const DeviceGuard guard(executor_.device());
      if (!may_hand_back()) return;
      for (cudaEvent_t event : {triangles_made_, vertices_made_})
        if (event) cudaEventDestroy(event);
      cudaStreamSynchronize(executor_.stream_handle());  // kernels bring little meshes to memory that is ours
      if (copies_) {
        cudaStreamSynchronize(copies_);
        cudaStreamDestroy(copies_);
      }
      DeviceMemory::release(table_);
      cudaGetLastError();
    } catch (...) {  // the device is lost, and its memory with it
    }
  }

  // One that was begun and given up, once nothing of it is on its way to the host any more.
  void forget_mesh() {
    wait_for_copies();
    // The executor's stream writes there as well, and others may be given the memory.
    if (!host_mesh_.lease().is_empty())
      check_cuda(cudaStreamSynchronize(executor_.stream_handle()), "cudaStreamSynchronize");
    host_mesh_.forget();
    device_mesh_.forget();
  }
  // Where meshes that are handed out are wanted. What was given back since the last computation is the arena's again,
  // within a budget.
  void deliver_to(const qses_settings &settings) {
    forget_mesh();
    keep_ = is_for_device(settings.delivery);
    to_host_ = is_for_host(settings.delivery);
    leaves_owners_ = leaves_owners(settings);
    if (!executor_.arena().has_budget()) return;
    if (!keep_) device_mesh_.pool().drop_spares();
    executor_.arena().set_taken(device_mesh_.bytes());
  }
  // What was allocated beside a mesh in pieces, or as one to be made into another, is given up.
  void forget_spills() { spilled_ = 0; }
  uint64_t host_bytes() const {
    uint64_t sum = host_mesh_.bytes();
    for (const PinnedBuffer &spill : spill_) sum += spill.size();
    return sum;
  }

  // Bytes of the device that are not in the arena.
  uint64_t outside_arena(const CudaExecutor &executor) const {
    return allowed_outside(executor) + device_mesh_.bytes();
  }
  uint64_t allowed_outside(const CudaExecutor &) const {
    return sizeof(MarchingCubesTable) + CudaExecutor::kFixedBytes;
  }
  uint64_t needed_outside(const CudaExecutor &executor) const { return outside_arena(executor); }
  static bool drop_kept_outside(const CudaExecutor &) { return false; }

  MeshMemoryView allocate_mesh(CudaExecutor &executor, size_t vertices, size_t triangles, const MeshShape &shape,
                               MeshPurpose purpose, bool in_pieces) {
    const MeshArrays arrays(vertices, triangles, shape);
    const bool delivered = purpose == MeshPurpose::kDelivered;
    void *const memory = delivered && keep_                           ? keep(executor, arrays)
                         : mesh_is_in_arena(true, purpose, in_pieces) ? executor.allocate<char>(arrays.bytes()).data
                         : delivered                                  ? host_mesh_.reserve(arrays.bytes())
                                                                      : spill(arrays.bytes());
    return describe_memory(arrays, vertices, triangles, shape, in_pieces, memory);
  }

  // Room for something as large as the mesh, where the mesh is.
  template <class T>
  Span<T> allocate_where_mesh_is(CudaExecutor &executor, const MeshMemoryView &mesh, size_t n) {
    if (!mesh.in_pieces) return executor.allocate<T>(n);
    return {static_cast<T *>(spill(n * sizeof(T))), n};
  }

  // Copies a part from the device to its place in a mesh in pieces.
  void save(CudaExecutor &executor, const MeshMemoryView &mesh, const MeshView &part, size_t vertices,
            size_t triangles) {
    for_each_array(mesh.view, part, vertices, triangles, [&](void *to, const void *from, size_t bytes) {
      executor.download(static_cast<char *>(to), static_cast<const char *>(from), bytes);
    });
  }

  // A mesh that is handed out on the host may go there part by part: triangles that are final, and vertices that are so
  // when what the executor has been given is done.
  bool goes_to_host() const { return to_host_; }
  void begin_to_send(const MeshMemoryView &mesh) {
    make_room_for(mesh, mesh.shape);
    sends_vertices_ = true;
  }
  void send_triangles(const MeshView &part, size_t triangles) {
    if (triangles > 0) copy_beside(brought_.triangle(part.first_triangle), part.indices, triangles * 12);
  }
  void send_vertices(CudaExecutor &executor, const MeshView &part, size_t vertices) {
    note(executor, &vertices_made_);
    for_each_array(brought_, part, vertices, 0,
                   [&](void *to, const void *from, size_t bytes) { bring_after(vertices_made_, to, from, bytes); });
  }

  // What the executor has been given so far makes the triangles of a mesh.
  void note_triangles(CudaExecutor &executor) { note(executor, &triangles_made_); }
  // Whether triangles of a mesh go to the host while the rest of it is made: if it is handed out there as it is, and
  // large. Of one whose size is anticipated, there may be fewer.
  bool may_send_triangles(const MeshMemoryView &mesh, MeshPurpose purpose) const {
    constexpr size_t kWorthAStream = size_t(1) << 13;  // triangles: 98 KB
    return to_host_ && purpose == MeshPurpose::kDelivered && mesh.triangles >= kWorthAStream;
  }
  // The first of them, about as many as what the executor has been given so far makes: of those behind, which are not
  // there yet, it does not matter what is brought.
  void bring_early_triangles(CudaExecutor &executor, const MeshMemoryView &mesh, size_t count) {
    make_room_for(mesh, mesh.shape);
    note_triangles(executor);
    bring_after(triangles_made_, brought_.indices, mesh.view.indices, count * 12);
    early_ = count;
  }
  // All the others; of those that were brought early, so many are right.
  void bring_triangles(const MeshMemoryView &mesh, MeshPurpose purpose, size_t right) {
    if (!sends_triangles_) {
      if (!may_send_triangles(mesh, purpose)) return;
      make_room_for(mesh, without_spare(mesh.shape));
    }
    const size_t first = std::min(early_, right);
    bring_after(triangles_made_, brought_.triangle(first), mesh.view.triangle(first), (mesh.triangles - first) * 12);
  }
  // Then its vertices as well, once they are as they are handed out, while the mesh is measured.
  void bring_vertices(CudaExecutor &executor, const MeshMemoryView &mesh) {
    if (!sends_triangles_ || is_little(mesh, mesh.vertices, 0)) return;
    sends_vertices_ = true;
    send_vertices(executor, mesh.view, mesh.vertices);
  }

  // A mesh that is complete gets memory for all that goes out with it; and goes to the host, if it is wanted there, as
  // far as it is not on its way.
  void send(MeshMemoryView *built) {
    if (built->vertices == 0 || !to_host_ || built->in_pieces) {
      brought_ = built->view;
      if (leaves_owners_) brought_.owners = nullptr;
    } else {
      bring(*built);
      if (leaves_owners_) built->bytes -= built->vertices * sizeof *built->view.owners;
    }
    host_mesh_.own_numbers(built);
  }
  // Whether nobody would wait for it.
  bool is_done() const {
    return cudaStreamQuery(executor_.stream_handle()) == cudaSuccess &&
           (!sends_triangles_ || cudaStreamQuery(copies_) == cudaSuccess);
  }
  // Then hands it out, without the report but for sums that come along. Waits.
  void finish(MeshMemoryView built, const qses_settings &settings, FinishedMesh *out) {
    executor_.wait();
    wait_for_copies();
    settle_sums(built.coming, &built.bounds, &out->report);
    describe_mesh(built, to_host_ ? &brought_ : nullptr, settings, &out->on_host);
    out->boxes = brought_.boxes;
    qses_device_mesh_init(&out->on_device);
    out->on_device.device = executor_.device();
    out->on_device.stream = told_stream_;
    describe_mesh(built, keep_ ? &built.view : nullptr, settings, &out->on_device.mesh);
    out->delivery = settings.delivery;
    out->shape = built.shape;
    out->memory = {host_mesh_.take(), device_mesh_.take(), host_mesh_.share_pool()};
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
  // Of a mesh, so many: a kernel brings them to the host, which is asked for in less time than copies of each array. It
  // copies words.
  static bool is_little(const MeshMemoryView &mesh, size_t vertices, size_t triangles) {
    constexpr size_t kLittle = size_t(1) << 20;
    return !mesh.shape.patches && MeshArrays(vertices, triangles, without_spare(mesh.shape)).bytes() <= kLittle;
  }
  void wait_for_copies() {
    if (sends_triangles_) check_cuda(cudaStreamSynchronize(copies_), "cudaStreamSynchronize");
    sends_triangles_ = sends_vertices_ = false;
    early_ = 0;
  }
  // Room for a mesh that stays on the device, as those in pieces don't. A budget covers it.
  void *keep(CudaExecutor &executor, const MeshArrays &arrays) {
    device_mesh_.lease().give_back();
    MeshPool &pool = device_mesh_.pool();
    // Within a budget nothing is held ready that does not fit.
    if (executor.arena().has_budget() && pool.bytes_with(arrays.bytes()) > pool.bytes()) pool.drop_spares();
    executor.arena().set_taken(pool.bytes_with(arrays.bytes()));
    void *const memory = device_mesh_.reserve(arrays.bytes());
    executor.hand_over();  // may throw, so before the readers are taken
    if (const std::shared_ptr<const StreamMark> readers = device_mesh_.lease().take_readers())
      readers->hold_back(executor.stream());
    return memory;
  }

  static void note(CudaExecutor &executor, cudaEvent_t *made) {
    if (!*made) check_cuda(cudaEventCreateWithFlags(made, cudaEventDisableTiming), "cudaEventCreateWithFlags");
    check_cuda(cudaEventRecord(*made, executor.stream()), "cudaEventRecord");
  }
  void copy_beside(void *to, const void *from, size_t bytes) {
    check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, copies_), "cudaMemcpyAsync");
  }
  void bring_after(cudaEvent_t made, void *to, const void *from, size_t bytes) {
    check_cuda(cudaStreamWaitEvent(copies_, made, 0), "cudaStreamWaitEvent");
    copy_beside(to, from, bytes);
  }
  // Where it is brought to.
  void reserve_on_host(const MeshMemoryView &mesh, MeshShape shape) {
    shape.owners = !leaves_owners_;
    const MeshArrays arrays(mesh.vertices, mesh.triangles, shape);
    brought_ = arrays.view(host_mesh_.reserve(arrays.bytes()));
  }
  // Room on the host, and a stream.
  void make_room_for(const MeshMemoryView &mesh, const MeshShape &shape) {
    reserve_on_host(mesh, shape);
    if (!copies_) check_cuda(cudaStreamCreateWithFlags(&copies_, cudaStreamNonBlocking), "cudaStreamCreateWithFlags");
    sends_triangles_ = true;
  }

  // The arrays of a whole mesh, without what is spare; triangles and vertices may be on their way already.
  void bring(const MeshMemoryView &mesh) {
    if (!sends_triangles_) reserve_on_host(mesh, without_spare(mesh.shape));
    const auto copy = [&](void *to, const void *from, size_t bytes) {
      executor_.download(static_cast<char *>(to), static_cast<const char *>(from), bytes);
    };
    const size_t vertices = sends_vertices_ ? 0 : mesh.vertices, triangles = sends_triangles_ ? 0 : mesh.triangles;
    if (is_little(mesh, vertices, triangles)) {
      gpu::CopyRuns runs;
      for_each_array(brought_, mesh.view, vertices, triangles,
                     [&](void *to, const void *from, size_t bytes) { runs.add(to, from, bytes); });
      executor_.for_each(runs.words(), runs);
    } else {
      for_each_array(brought_, mesh.view, vertices, triangles, copy);
    }
    if (mesh.shape.component_ids) copy(brought_.component_ids, mesh.view.component_ids, mesh.vertices * 4);
    if (mesh.shape.repeated > 0) copy(brought_.repeated, mesh.view.repeated, mesh.shape.repeated * 4);
    if (mesh.shape.boxes) {
      executor_.download(brought_.boxes.runs, mesh.view.boxes.runs, PickBoxes::run_count(mesh.triangles));
      executor_.download(brought_.boxes.groups, mesh.view.boxes.groups, PickBoxes::group_count(mesh.triangles));
    }
  }

  // At most a mesh to be made into another one, its normals and those of the other one, sums and starts at a time.
  void *spill(size_t bytes) {
    if (spilled_ == spill_.size()) spill_.emplace_back();
    return spill_[spilled_++].reserve(bytes);
  }

  CudaExecutor &executor_;
  const cudaStream_t told_stream_;
  PooledMesh host_mesh_, device_mesh_;
  bool keep_ = false, to_host_ = false, leaves_owners_ = false;
  cudaEvent_t triangles_made_ = nullptr, vertices_made_ = nullptr;
  size_t early_ = 0;  // triangles that were brought early
  cudaStream_t copies_ = nullptr;
  bool sends_triangles_ = false, sends_vertices_ = false;  // they are on their way, to here:
  MeshView brought_{};
  std::deque<PinnedBuffer> spill_;
  size_t spilled_ = 0;
  void *table_ = nullptr;
};

}  // namespace quickses
