// SPDX-License-Identifier: MIT
// The components of a mesh in host memory, found by the CPU's threads.
#include "surface/stages/host_components.h"

#include "parallel/cpu_executor.h"
#include "surface/stages/components.h"

namespace quickses {

HostComponents::HostComponents(const WorkerThreads &threads) : threads_(threads) {}
HostComponents::~HostComponents() = default;

MeshComponents HostComponents::find(const MeshView &mesh, const MeshCounts &counts, float spacing, bool bent,
                                    ComponentMemory &memory, const std::atomic<bool> &stop) {
  if (!executor_) executor_ = std::make_unique<CpuExecutor>(threads_);
  const CpuExecutor::RunScope run_scope(*executor_, stop);
  executor_->arena().reset();
  return find_components(*executor_, mesh, counts, spacing, bent, memory);
}

uint64_t HostComponents::bytes() const { return executor_ ? executor_->arena().held() : 0; }

}  // namespace quickses
