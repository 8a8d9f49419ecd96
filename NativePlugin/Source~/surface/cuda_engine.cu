// SPDX-License-Identifier: MIT
// The engine on the GPU.
#include "surface/cuda/cuda_backend.cuh"

#include "parallel/cuda_stage_timer.cuh"
#include "surface/memory_ladder.h"

namespace quickses {
namespace {

// Asking for one kernel of this file loads them all.
__global__ void engine_kernel() {}

}  // namespace

std::unique_ptr<SurfaceEngine> make_cuda_engine(int device, const WorkerThreads &threads, uint64_t memory_budget) {
  load_cuda_kernels(device, reinterpret_cast<const void *>(&engine_kernel));
  return std::make_unique<LadderEngine<CudaExecutor, CudaStageTimer>>(memory_budget, threads, device);
}

}  // namespace quickses
