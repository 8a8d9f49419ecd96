// SPDX-License-Identifier: MIT
// The engine on the GPU.
#include "surface/cuda/cuda_backend.cuh"

#include "parallel/cuda_stage_timer.cuh"
#include "surface/memory_ladder.h"

namespace quickses {

std::unique_ptr<SurfaceEngine> make_cuda_engine(int device, unsigned threads, uint64_t memory_budget) {
  return std::make_unique<LadderEngine<CudaExecutor, CudaStageTimer>>(memory_budget, threads, device);
}

}  // namespace quickses
