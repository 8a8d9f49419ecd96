// SPDX-License-Identifier: MIT
// The pipeline on the GPU.
#include "surface/cuda/exact_ses_cuda.cuh"
#include "surface/cuda/mesh_cuda.cuh"
#include "surface/cuda/solvent_features_cuda.cuh"

#include "parallel/cuda_stage_timer.cuh"
#include "surface/cuda/mesh_memory_cuda.cuh"
#include "surface/pipeline.h"

namespace quickses {

std::unique_ptr<SurfaceEngine> make_cuda_engine(int device, uint64_t memory_budget) {
  return std::make_unique<SurfacePipeline<CudaExecutor, CudaStageTimer>>(memory_budget, uint64_t(0), device);
}

}  // namespace quickses
