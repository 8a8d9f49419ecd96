// SPDX-License-Identifier: MIT
// CPU driver of the exact field and of the mesh: one thread per brick.
#pragma once

#include "parallel/growing_buffer.h"
#include "surface/cpu/cpu_kernel_executor.h"

namespace quickses {

// Memory of one thread for a brick: columns for what is near it, and its vertices. Grows when a brick needs more; kept
// between surfaces.
struct BrickColumns {
  alignas(64) unsigned char vertex_memory[BrickScratch::kVertexBytes];
  GrowingBuffer<HostMemory> atom_memory, arc_memory;
  int atom_capacity = 512, arc_capacity = 1024;

  BrickScratch scratch() {
    const size_t atoms = BrickScratch::kAtomColumns * (static_cast<size_t>(atom_capacity) + 16);
    const size_t arcs = BrickScratch::kArcColumns * (static_cast<size_t>(arc_capacity) + 16);
    return {static_cast<float *>(atom_memory.reserve(atoms * sizeof(float))),
            static_cast<float *>(arc_memory.reserve(arcs * sizeof(float))), atom_capacity, arc_capacity, vertex_memory};
  }
  uint64_t bytes() const { return atom_memory.size() + arc_memory.size(); }
  // True if the brick must be done again.
  bool grow(const BrickNeeds &needs) {
    if (needs.atoms > 0) atom_capacity = needs.atoms + needs.atoms / 2;
    if (needs.arcs > 0) arc_capacity = needs.arcs + needs.arcs / 2;
    return needs.atoms > 0 || needs.arcs > 0;
  }
  // As much room as another thread needed: who meets the most crowded brick differs from surface to surface.
  void match(const BrickColumns &other) {
    atom_capacity = std::max(atom_capacity, other.atom_capacity);
    arc_capacity = std::max(arc_capacity, other.arc_capacity);
    scratch();
  }
};

struct EvaluateBrick {
  const CpuKernels *kernels;
  const FeatureView *features;
  const BrickSet *bricks;
  uint32_t first;
  uint64_t *signs;
  void operator()(SoloTeam, BrickColumns &columns, size_t i) const {
    const uint32_t brick = first + static_cast<uint32_t>(i);
    while (columns.grow(kernels->evaluate_brick_signs(*features, *bricks, brick, columns.scratch(),
                                                      signs + size_t(brick) * kLeavesPerBrick))) {
    }
  }
};

inline void evaluate_signs(CpuKernelExecutor &executor, const FeatureView &features, const BrickSet &bricks,
                           BrickRange slice, uint64_t *signs) {
  executor.for_each_brick<BrickColumns>(slice.size(),
                                        EvaluateBrick{&executor.kernels(), &features, &bricks, slice.first, signs});
  executor.match_scratches<BrickColumns>();
}

struct MarkBrickWalls {
  const CpuKernels *kernels;
  const FeatureView *features;
  const BrickSet *bricks;
  uint32_t first;
  const uint64_t *signs;
  uint64_t *marks;
  void operator()(SoloTeam, BrickColumns &columns, size_t i) const {
    while (columns.grow(kernels->mark_brick_walls(*features, *bricks, first + static_cast<uint32_t>(i), signs,
                                                  columns.scratch(), marks))) {
    }
  }
};

inline void mark_thin_walls(CpuKernelExecutor &executor, const FeatureView &features, const BrickSet &bricks,
                            BrickRange slice, const uint64_t *signs, uint64_t *marks) {
  executor.for_each_brick<BrickColumns>(
      slice.size(), MarkBrickWalls{&executor.kernels(), &features, &bricks, slice.first, signs, marks});
  executor.match_scratches<BrickColumns>();
}

struct EmitBrickVertices {
  const CpuKernels *kernels;
  const FeatureView *features;
  const BrickSet *bricks;
  const MeshLayout *layout;
  const VertexStarts *starts;
  const MeshView *mesh;
  uint32_t first;
  void operator()(SoloTeam, BrickColumns &columns, size_t i) const {
    while (columns.grow(kernels->emit_brick_vertices(*features, *bricks, *layout, first + static_cast<uint32_t>(i),
                                                     *starts, columns.scratch(), *mesh))) {
    }
  }
};

inline void emit_vertices(CpuKernelExecutor &executor, const FeatureView &features, const BrickSet &bricks,
                          const MeshLayout &layout, BrickRange slice, const VertexStarts &starts,
                          const MeshView &mesh) {
  executor.for_each_brick<BrickColumns>(
      slice.size(), EmitBrickVertices{&executor.kernels(), &features, &bricks, &layout, &starts, &mesh, slice.first});
  executor.match_scratches<BrickColumns>();
}

struct EmitBrickTriangles {
  const CpuKernels *kernels;
  const BrickSet *bricks;
  const MeshLayout *layout;
  const TableView *table;
  const MeshView *mesh;
  uint32_t first;
  void operator()(SoloTeam, char &, size_t i) const {
    kernels->emit_brick_triangles(*bricks, *layout, first + static_cast<uint32_t>(i), *table, *mesh);
  }
};

inline void emit_triangles(CpuKernelExecutor &executor, const BrickSet &bricks, const MeshLayout &layout,
                           BrickRange slice, const TableView &table, const MeshView &mesh) {
  executor.for_each_brick<char>(slice.size(),
                                EmitBrickTriangles{&executor.kernels(), &bricks, &layout, &table, &mesh, slice.first});
}

}  // namespace quickses
