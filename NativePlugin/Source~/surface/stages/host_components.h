// SPDX-License-Identifier: MIT
// The components of a mesh in host memory, found by the CPU's threads: for meshes that did not fit on the GPU.
#pragma once

#include "process/worker_threads.h"
#include "surface/mesh/mesh_view.h"

#include "quickses/quickses.h"

#include <atomic>
#include <memory>

namespace quickses {

class ComponentMemory;
class CpuExecutor;
struct MeshComponents;
struct MeshCounts;

class HostComponents {
 public:
  explicit HostComponents(const WorkerThreads &threads);
  ~HostComponents();

  // As find_components; gives up where it is told to stop, and throws Cancelled. Its threads and its work memory stay
  // for the next call.
  MeshComponents find(const MeshView &mesh, const MeshCounts &counts, float spacing, bool bent, ComponentMemory &memory,
                      const std::atomic<bool> &stop);
  uint64_t bytes() const;  // of work memory

 private:
  WorkerThreads threads_;
  std::unique_ptr<CpuExecutor> executor_;
};

}  // namespace quickses
