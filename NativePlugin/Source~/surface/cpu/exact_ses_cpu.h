// SPDX-License-Identifier: MIT
// CPU driver of the exact field and of the mesh: one thread per brick.
#pragma once

#include "parallel/growing_buffer.h"
#include "surface/cpu/cpu_kernel_executor.h"

namespace quickses {

// Memory of one thread for a brick: columns for what is near it, and its vertices. Grows when a brick needs more; kept
// between surfaces.
struct BrickColumns {
  static constexpr int kMostColumns = 1 << 24;  // kernels have their numbers as floats
  alignas(64) unsigned char vertex_memory[BrickScratch::kVertexBytes];
  GrowingBuffer<HostMemory> atom_memory, arc_memory;
  int atom_capacity = 512, arc_capacity = 1024;

  // What is refused is not asked for again by bricks that need less.
  void grow_atoms(int n) {
    atom_memory.reserve(BrickScratch::kAtomColumns * (static_cast<size_t>(n) + 16) * sizeof(float));
    atom_capacity = n;
  }
  void grow_arcs(int n) {
    arc_memory.reserve(BrickScratch::kArcColumns * (static_cast<size_t>(n) + 16) * sizeof(float));
    arc_capacity = n;
  }
  BrickScratch scratch() {
    grow_atoms(atom_capacity);
    grow_arcs(arc_capacity);
    return {static_cast<float *>(atom_memory.data()), static_cast<float *>(arc_memory.data()), atom_capacity,
            arc_capacity, vertex_memory};
  }
  uint64_t bytes() const { return atom_memory.size() + arc_memory.size(); }
  // True if the brick must be done again.
  bool grow(const BrickNeeds &needs) {
    if (std::max(needs.atoms, needs.arcs) > kMostColumns)
      invalid("settings.spacing is too wide for so many atoms: more than " + std::to_string(kMostColumns) +
              " are near each other beside it");
    if (needs.atoms > 0) grow_atoms(needs.atoms + needs.atoms / 2);
    if (needs.arcs > 0) grow_arcs(needs.arcs + needs.arcs / 2);
    return needs.atoms > 0 || needs.arcs > 0;
  }
  // As much room as another thread needed: who meets the most crowded brick differs from surface to surface.
  void match(const BrickColumns &other) {
    grow_atoms(std::max(atom_capacity, other.atom_capacity));
    grow_arcs(std::max(arc_capacity, other.arc_capacity));
  }
};

// kernel(brick, scratch) for the bricks of a slice, again with more room while it returns needs.
template <class Kernel>
void for_each_brick_with_columns(CpuKernelExecutor &executor, BrickRange slice, const Kernel &kernel) {
  executor.for_each_brick<BrickColumns>(slice.size(), [&kernel, slice](SoloTeam, BrickColumns &columns, size_t i) {
    const uint32_t brick = slice.first + static_cast<uint32_t>(i);
    while (columns.grow(kernel(brick, columns.scratch()))) {
    }
  });
  executor.match_scratches<BrickColumns>();
}

inline void evaluate_signs(CpuKernelExecutor &executor, const FeatureView &features, const BrickSet &bricks,
                           BrickRange slice, uint64_t *signs) {
  for_each_brick_with_columns(executor, slice, [&](uint32_t brick, const BrickScratch &scratch) {
    return executor.kernels().evaluate_brick_signs(features, bricks, brick, scratch,
                                                   signs + size_t(brick) * kLeavesPerBrick);
  });
}

inline void mark_thin_walls(CpuKernelExecutor &executor, const FeatureView &features, const BrickSet &bricks,
                            BrickRange slice, const uint64_t *signs, uint64_t *marks) {
  for_each_brick_with_columns(executor, slice, [&](uint32_t brick, const BrickScratch &scratch) {
    return executor.kernels().mark_brick_walls(features, bricks, brick, signs, scratch, marks);
  });
}

inline void emit_vertices(CpuKernelExecutor &executor, const FeatureView &features, const BrickSet &bricks,
                          const MeshLayout &layout, BrickRange slice, const VertexStarts &starts,
                          const MeshView &mesh) {
  for_each_brick_with_columns(executor, slice, [&](uint32_t brick, const BrickScratch &scratch) {
    return executor.kernels().emit_brick_vertices(features, bricks, layout, brick, starts, scratch, mesh);
  });
}

inline void emit_triangles(CpuKernelExecutor &executor, const BrickSet &bricks, const MeshLayout &layout,
                           BrickRange slice, const TableView &table, const MeshView &mesh) {
  executor.for_each_brick<NoScratch>(slice.size(), [&](SoloTeam, NoScratch &, size_t i) {
    executor.kernels().emit_brick_triangles(bricks, layout, slice.first + static_cast<uint32_t>(i), table, mesh);
  });
}

}  // namespace quickses
