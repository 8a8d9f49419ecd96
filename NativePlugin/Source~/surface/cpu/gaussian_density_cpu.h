// SPDX-License-Identifier: MIT
// CPU driver of Gaussian densities: one thread per brick.
#pragma once

#include "surface/cpu/exact_ses_cpu.h"

namespace quickses {

struct EvaluateBrickDensity {
  const CpuKernels *kernels;
  const GaussianDensity *density;
  const BrickSet *bricks;
  uint32_t first;
  uint64_t *signs;
  void operator()(SoloTeam, BrickColumns &columns, size_t i) const {
    const uint32_t brick = first + static_cast<uint32_t>(i);
    while (columns.grow(kernels->evaluate_brick_density(*density, *bricks, brick, columns.scratch(),
                                                        signs + size_t(brick) * kLeavesPerBrick))) {
    }
  }
};

inline void evaluate_density(CpuKernelExecutor &executor, const GaussianDensity &density, const BrickSet &bricks,
                             BrickRange slice, uint64_t *signs) {
  executor.for_each_brick<BrickColumns>(
      slice.size(), EvaluateBrickDensity{&executor.kernels(), &density, &bricks, slice.first, signs});
  executor.match_scratches<BrickColumns>();
}

struct EmitBrickDensityVertices {
  const CpuKernels *kernels;
  const GaussianDensity *density;
  const BrickSet *bricks;
  const MeshLayout *layout;
  const MeshView *mesh;
  void operator()(SoloTeam, BrickColumns &columns, size_t i) const {
    while (columns.grow(kernels->emit_brick_density_vertices(*density, *bricks, *layout, static_cast<uint32_t>(i),
                                                             columns.scratch(), *mesh))) {
    }
  }
};

inline void emit_density_vertices(CpuKernelExecutor &executor, const GaussianDensity &density, const BrickSet &bricks,
                                  const MeshLayout &layout, const MeshView &mesh) {
  executor.for_each_brick<BrickColumns>(
      bricks.count, EmitBrickDensityVertices{&executor.kernels(), &density, &bricks, &layout, &mesh});
  executor.match_scratches<BrickColumns>();
}

}  // namespace quickses
