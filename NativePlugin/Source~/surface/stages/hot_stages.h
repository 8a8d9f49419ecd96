// SPDX-License-Identifier: MIT
// The hot stages that have one driver per back end. Both drivers use the same functions of geometry; they differ
// in the shape of their loops: packs of eight and one thread per brick on the CPU, warps on the GPU. The pipeline calls
// them by overload on the executor:
//
//   void find_solvent_features(Executor &, const NeighborGridView &atoms, const SurfaceParameters &, bool frugal,
//                              SolventFeatures *)
//       frugal: with as little memory as possible, in more time. Throws MemoryRefused; the sizes of the features are
//       set if they were counted before
//   Candidates<Executor>   what the two stages below may share for a slice of bricks (CPU: nothing)
//   void evaluate_signs(Executor &, const FeatureView &, const BrickSet &, BrickRange, Candidates<Executor> &,
//                       uint64_t *signs)
//       signs[8 * brick + leaf] for the bricks of the slice: bit set = farther than depth inside the boundary
//   void emit_vertices(Executor &, const FeatureView &, const BrickSet &, const MeshLayout &, BrickRange,
//                      Candidates<Executor> &, const VertexStarts &, const MeshView &)
//   void emit_triangles(Executor &, const BrickSet &, const MeshLayout &, BrickRange, const TableView &,
//                       const MeshView &)
#pragma once

#include "surface/stages/marching_cubes.h"
#include "surface/stages/projection.h"

namespace quickses {

// A slice: a run of bricks in linear order.
struct BrickRange {
  uint32_t first, last;
  QSES_FN uint32_t size() const { return last - first; }
};

// Where vertices start before they are projected.
struct VertexStarts {
  bool relax;                          // move by the ring table first (relaxation step 1)
  const glm::vec3 *moved;              // if not null: [vertex], centred frame: starts of a further relaxation step
  const uint64_t (*ring)[kCellEdges];  // MarchingCubesTable::ring in the memory of the back end
  uint32_t *unplaced;                  // counts the vertices for which no feature is found
};

// The table in the memory of the back end.
struct TableView {
  const uint8_t *triangle_count;       // [256]
  const uint8_t (*edges)[16];          // [256]
  const uint64_t (*ring)[kCellEdges];  // [256]
};

// CandidatesOf<E>::type, and bytes of arena that a brick takes, roughly: sign_bytes(parameters) while signs are
// evaluated, emission_bytes(parameters, vertices and leaves with vertices of the brick) while vertices are emitted,
// whole_bytes(parameters) for all until the mesh is done, if all bricks are worked on at once; kSpareBytes besides.
template <class Executor>
struct CandidatesOf;
template <class Executor>
using Candidates = typename CandidatesOf<Executor>::type;

}  // namespace quickses
