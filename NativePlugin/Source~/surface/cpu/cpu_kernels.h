// SPDX-License-Identifier: MIT
// The CPU's inner loops, compiled once per instruction set and chosen at run time. A kernel works on one atom or one
// brick; the drivers (solvent_features_cpu.h, exact_ses_cpu.h) hand out the work and own all memory.
#pragma once

#include "parallel/span.h"
#include "parallel/working_thread.h"
#include "surface/stages/hot_stages.h"
#include "surface/stages/local_features.h"
#include "surface/stages/triangle_measures.h"

namespace quickses {

// Scratch of one thread for the features of one atom. The kernel cuts the memory into its columns.
struct AtomScratch {
  static constexpr int kColumns = 15;
  float *memory;  // kColumns * (capacity + 16) floats, 64-byte aligned
  int capacity;   // neighbours
};

struct AtomFeatures {
  int neighbors_needed;  // more than the scratch holds: nothing else is valid
  int cap_count;         // may exceed the room: then nothing was written, and the atom is to be asked again
  int64_t arc_count;     // the same
};

// What is near one brick, in columns: atoms and arcs of the neighbour grids, by their places there.
struct BrickScratch {
  static constexpr int kAtomColumns = 11, kArcColumns = 6;
  static constexpr size_t kVertexBytes = size_t(96) << 10;  // more than the stack of a caller may have
  float *atom_memory;  // kAtomColumns columns of atom_capacity + 16 four-byte values
  float *arc_memory;   // kArcColumns columns of arc_capacity + 16
  int atom_capacity, arc_capacity;
  void *vertex_memory;  // kVertexBytes for the vertices in the making, 64-byte aligned
};

// Numbers of candidates that did not fit; 0 when the kernel has done its work.
struct BrickNeeds {
  int atoms, arcs;
};

// The features near a place (stages/local_features.h), the arcs also in columns. A thread has one.
struct LocalColumns {
  static constexpr int kArcRoom = LocalReach::kMostArcs + 16, kArcColumns = 12;
  uint32_t atoms[LocalReach::kMostAtoms + 8], arcs[kArcRoom];
  float arc_columns[kArcColumns][kArcRoom];
  int atom_number, arc_number;
};

// Every kernel, as KERNEL(result, name, arguments...): the one list of them.
//   find_atom_features     caps and arcs of atom i, with room for cap_room caps and arc_room arcs; arc_atoms may be
//                          nullptr. Sets exposed[] for i and for the other atoms of its exposed arcs
//   evaluate_brick_signs   the eight leaf words of a brick
//   mark_brick_walls       ORs the lattice points into marks that thin walls of its edges need (thin_walls.h)
//   emit_brick_vertices    the vertices a brick owns
//   count_brick            what a brick owns, and its part of the layout
//   emit_brick_triangles   the triangles of a brick's cells
//   evaluate_brick_density the eight leaf words of a brick of a Gaussian surface
//   emit_brick_density_vertices  the vertices that a brick of it owns
//   measure_triangles      as in triangle_measures.h
//   gather_local_features  those near a place; false if it is too crowded
//   nearest_local_arc      of those that were gathered
#define QSES_CPU_KERNELS(KERNEL)                                                                                     \
  KERNEL(AtomFeatures, find_atom_features, const NeighborGridView &atoms, const SurfaceParameters &parameters,       \
         uint32_t i, const AtomScratch &scratch, Cap *caps, int cap_room, Arc *arcs, ArcAtoms *arc_atoms,            \
         int64_t arc_room, uint8_t *exposed)                                                                         \
  KERNEL(BrickNeeds, evaluate_brick_signs, const FeatureView &features, const BrickSet &bricks, uint32_t brick,      \
         const BrickScratch &scratch, uint64_t *words)                                                               \
  KERNEL(BrickNeeds, mark_brick_walls, const FeatureView &features, const BrickSet &bricks, uint32_t brick,          \
         const uint64_t *signs, const BrickScratch &scratch, uint64_t *marks)                                        \
  KERNEL(BrickNeeds, emit_brick_vertices, const FeatureView &features, const BrickSet &bricks,                       \
         const MeshLayout &layout, uint32_t brick, const VertexStarts &starts, const BrickScratch &scratch,          \
         const MeshView &mesh)                                                                                       \
  KERNEL(BrickTotals, count_brick, const BrickSet &bricks, const MeshLayout &layout, uint32_t brick,                 \
         const uint8_t *case_triangles)                                                                              \
  KERNEL(void, emit_brick_triangles, const BrickSet &bricks, const MeshLayout &layout, uint32_t brick,               \
         const TableView &table, const MeshView &mesh)                                                               \
  KERNEL(BrickNeeds, evaluate_brick_density, const GaussianDensity &density, const BrickSet &bricks, uint32_t brick, \
         const BrickScratch &scratch, uint64_t *words)                                                               \
  KERNEL(BrickNeeds, emit_brick_density_vertices, const GaussianDensity &density, const BrickSet &bricks,            \
         const MeshLayout &layout, uint32_t brick, const BrickScratch &scratch, const MeshView &mesh)                \
  KERNEL(void, measure_triangles, const MeasureTriangle &measure, size_t first, size_t count, TriangleSums *sums)    \
  KERNEL(bool, gather_local_features, const FeatureView &features, const Vec3<float> &x, float around,               \
         LocalColumns *out)                                                                                          \
  KERNEL(NearestArc, nearest_local_arc, const LocalColumns &local, const Vec3<float> &x)

struct CpuKernels {
  const char *name;
#define QSES_POINTER(result, kernel, ...) result (*kernel)(__VA_ARGS__);
  QSES_CPU_KERNELS(QSES_POINTER)
#undef QSES_POINTER
};

// Those of the instruction sets: files that are compiled with QSES_CPU_ISA defined as the name of one.
#define QSES_DECLARE(result, kernel, ...) result kernel(__VA_ARGS__);
namespace base {
QSES_CPU_KERNELS(QSES_DECLARE)
}  // namespace base
namespace v3 {
QSES_CPU_KERNELS(QSES_DECLARE)
}  // namespace v3
namespace v4 {
QSES_CPU_KERNELS(QSES_DECLARE)
}  // namespace v4
#undef QSES_DECLARE

// The sets that this processor runs, each better than those before it. All but the first give the same bytes.
Span<const CpuKernels *const> usable_cpu_kernels();

// The best of them.
const CpuKernels &cpu_kernels();

}  // namespace quickses
