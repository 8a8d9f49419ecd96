// SPDX-License-Identifier: MIT
// The pipeline on the CPU.
#include "surface/cpu/exact_ses_cpu.h"
#include "surface/cpu/mesh_memory_cpu.h"
#include "surface/cpu/solvent_features_cpu.h"

#include "parallel/cpu_stage_timer.h"
#include "surface/pipeline.h"

namespace quickses {

std::unique_ptr<SurfaceEngine> make_cpu_engine(unsigned threads, uint64_t memory_budget, uint64_t memory_limit) {
  return std::make_unique<SurfacePipeline<CpuKernelExecutor, CpuStageTimer>>(memory_budget, memory_limit, threads);
}

}  // namespace quickses
