// SPDX-License-Identifier: MIT
// Memory for meshes that are handed out, on the host or on a device. Buffers go from hand to hand: the engine fills
// one, the job holds it until it is collected, a kept mesh may hold it for long, also when the engine has gone; who
// lets go of it gives it back.
#pragma once

#include "parallel/growing_buffer.h"
#include "process/host_memory.h"

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace quickses {

class StreamMark;

struct MeshBuffer {
  void *memory = nullptr;
  size_t size = 0;
  uint64_t last_take = 0;  // of those of the pool: when somebody had it last
  GrowingBuffer<HostMemory> components, atom_areas;
  std::shared_ptr<const StreamMark> readers;  // on a device: streams read it until then; null: none does
};

// All functions may be called from any thread.
class MeshPool {
 public:
  using Release = std::function<void(MeshBuffer &)>;  // of its memory; must not throw
  struct Source {
    const char *name;
    std::function<void *(size_t)> acquire;
    Release release;
    size_t most_of_the_largest;  // spares together, as a multiple of the largest of them
    // The same, where whoever gives a mesh back should not wait; empty: release.
    Release release_later = {};
  };
  // Of a source of Arena, on the host.
  template <class AnySource>
  static Source source() {
    // While one is shown and one is on its way to where it is shown, two are made in turn.
    return {AnySource::kName, AnySource::acquire, [](MeshBuffer &buffer) { AnySource::release(buffer.memory); }, 4};
  }

  explicit MeshPool(Source source);
  ~MeshPool() { close(); }
  MeshPool(const MeshPool &) = delete;
  MeshPool &operator=(const MeshPool &) = delete;

  // A spare buffer that fits, else a new one. Throws MemoryRefused.
  std::unique_ptr<MeshBuffer> take(size_t bytes);
  // Keeps it as a spare, or releases older ones.
  void give_back(std::unique_ptr<MeshBuffer> buffer) noexcept;
  // Nobody will take any more: spares are released, and what is given back from now on.
  void close() noexcept;

  // What a mesh of so many bytes takes: with head room, so that a trajectory soon stops growing.
  static size_t size_for(size_t bytes) { return GrowingBuffer<HostMemory>::size_for(bytes); }
  uint64_t bytes() const;                   // of spare buffers and of those that are out
  uint64_t bytes_with(size_t bytes) const;  // once there is room for such a mesh as well
  void count_numbers(int64_t bytes);
  void drop_spares() noexcept;

 private:
  using Spares = std::vector<std::unique_ptr<MeshBuffer>>;
  void release(MeshBuffer &buffer, const Release &release_memory) noexcept;
  bool has_surplus() const;                               // the mutex is held, for the next two too
  Spares::const_iterator best_spare(size_t bytes) const;  // end: none fits
  std::unique_ptr<MeshBuffer> take_spare(size_t bytes);
  std::unique_ptr<MeshBuffer> oldest_spare();  // out of the list; null if there is none

  const Source source_;
  mutable std::mutex mutex_;
  Spares spares_;  // least lately used first; room for one too many
  uint64_t bytes_ = 0, takes_ = 0;
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
  // On a device: streams read the memory until the mark. One thread at a time.
  void note_readers(std::shared_ptr<const StreamMark> readers) const { buffer_->readers = std::move(readers); }
  // Who writes there has to be held back until then; null: by nobody. The lease forgets them.
  std::shared_ptr<const StreamMark> take_readers() { return std::move(buffer_->readers); }
  // What there is to say about a mesh besides its arrays.
  enum Numbers { kComponents, kAtomAreas };
  // Copies it into memory of its own. Throws MemoryRefused.
  const void *add(Numbers which, const void *numbers, size_t bytes);

 private:
  std::shared_ptr<MeshPool> pool_;
  std::unique_ptr<MeshBuffer> buffer_;
};

}  // namespace quickses
