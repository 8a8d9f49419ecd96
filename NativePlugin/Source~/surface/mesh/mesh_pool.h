// SPDX-License-Identifier: MIT
// Host memory for meshes that are handed out. Buffers go from hand to hand: the engine fills one, the job holds it
// until it is collected, a kept mesh may hold it for long, also when the engine has gone; who lets go of it gives it
// back.
#pragma once

#include "parallel/growing_buffer.h"
#include "parallel/host_memory.h"
#include "parallel/span.h"

#include <memory>
#include <mutex>
#include <vector>

namespace quickses {

// Meshes are made in numbered slots. With three of them one can be written while another one waits to be collected and
// the caller still reads the third.
constexpr int kMeshSlots = 3;

struct MeshBuffer {
  void *memory = nullptr;
  size_t size = 0;
  GrowingBuffer<HostMemory> components, atom_areas;
};

// All functions may be called from any thread.
class MeshPool {
 public:
  // Static functions of a source of Arena.
  struct Source {
    const char *name;
    void *(*acquire)(size_t);
    void (*release)(void *);
  };
  template <class AnySource>
  static Source source() {
    return {AnySource::kName, AnySource::acquire, AnySource::release};
  }

  explicit MeshPool(const Source &source);
  ~MeshPool() { close(); }
  MeshPool(const MeshPool &) = delete;
  MeshPool &operator=(const MeshPool &) = delete;

  // A spare buffer that fits, else a new one. Throws MemoryRefused.
  std::unique_ptr<MeshBuffer> take(size_t bytes);
  // Keeps it as a spare, or releases older ones.
  void give_back(std::unique_ptr<MeshBuffer> buffer) noexcept;
  // Nobody will take any more: spares are released, and what is given back from now on.
  void close() noexcept;

  uint64_t bytes() const;  // of spare buffers and of those that are out
  void count_numbers(int64_t bytes);

 private:
  using Spares = std::vector<std::unique_ptr<MeshBuffer>>;
  void release(MeshBuffer &buffer) noexcept;
  bool has_surplus() const;  // the mutex is held
  std::unique_ptr<MeshBuffer> take_spare(size_t bytes);
  std::unique_ptr<MeshBuffer> oldest_spare();  // out of the list; null if there is none

  const Source source_;
  mutable std::mutex mutex_;
  Spares spares_;  // least lately used first; room for one too many
  uint64_t bytes_ = 0;
  bool is_closed_ = false;
};

// A buffer, or none, that somebody holds.
class MeshLease {
 public:
  MeshLease() = default;
  MeshLease(std::shared_ptr<MeshPool> pool, size_t bytes);
  MeshLease(MeshLease &&other) noexcept = default;
  MeshLease &operator=(MeshLease &&other) noexcept;
  ~MeshLease() { give_back(); }

  void give_back() noexcept;
  bool is_empty() const { return !buffer_; }
  void *memory() const { return buffer_->memory; }
  size_t size() const { return buffer_ ? buffer_->size : 0; }
  // What there is to say about a mesh besides its arrays.
  enum Numbers { kComponents, kAtomAreas };
  // Copies it into memory of its own. Throws MemoryRefused.
  const void *add(Numbers which, const void *numbers, size_t bytes);

 private:
  std::shared_ptr<MeshPool> pool_;
  std::unique_ptr<MeshBuffer> buffer_;
};

}  // namespace quickses
