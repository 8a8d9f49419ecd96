// SPDX-License-Identifier: MIT
// CPU driver of Gaussian densities: one thread per brick.
#pragma once

#include "surface/cpu/exact_ses_cpu.h"

namespace quickses {

inline void evaluate_density(CpuKernelExecutor &executor, const GaussianDensity &density, const BrickSet &bricks,
                             BrickRange slice, uint64_t *signs) {
  for_each_brick_with_columns(executor, slice, [&](uint32_t brick, const BrickScratch &scratch) {
    return executor.kernels().evaluate_brick_density(density, bricks, brick, scratch,
                                                     signs + size_t(brick) * kLeavesPerBrick);
  });
}

inline void emit_density_vertices(CpuKernelExecutor &executor, const GaussianDensity &density, const BrickSet &bricks,
                                  const MeshLayout &layout, const MeshView &mesh) {
  for_each_brick_with_columns(executor, BrickRange{0, bricks.count}, [&](uint32_t brick, const BrickScratch &scratch) {
    return executor.kernels().emit_brick_density_vertices(density, bricks, layout, brick, scratch, mesh);
  });
}

}  // namespace quickses
