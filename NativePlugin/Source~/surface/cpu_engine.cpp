// SPDX-License-Identifier: MIT
// The engine on the CPU.
#include "surface/cpu/cpu_backend.h"

#include "parallel/cpu_stage_timer.h"
#include "surface/memory_ladder.h"

namespace quickses {

std::unique_ptr<SurfaceEngine> make_cpu_engine(const WorkerThreads &threads, uint64_t memory_budget) {
  return std::make_unique<LadderEngine<CpuKernelExecutor, CpuStageTimer>>(memory_budget, threads, threads);
}

}  // namespace quickses
