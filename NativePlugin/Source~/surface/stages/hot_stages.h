// SPDX-License-Identifier: MIT
// The hot stages that have one driver per back end. Both drivers use the same functions of geometry; they differ in the
// shape of their loops: packs of eight and one thread per brick on the CPU, warps on the GPU.
#pragma once

#include "surface/memory/memory_plan.h"
#include "surface/stages/gaussian_density.h"
#include "surface/stages/marching_cubes.h"
#include "surface/stages/projection.h"
#include "surface/stages/side_normals.h"

namespace quickses {

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

// What stages of a slice of bricks work on. Candidates: what signs, walls and vertices may share; Rooms: how much room
// the last surface of so many atoms took, where that is not known beforehand.
template <class Rooms, class Candidates>
struct SliceWork {
  const FeatureView &features;
  const BrickSet &bricks;
  BrickRange slice;
  Rooms &rooms;
  Candidates &candidates;
};

// And its vertices. sizes: what the slice owns, or at most if it is all of the bricks.
struct VertexWork {
  const MeshLayout &layout;
  const SliceSizes &sizes;
  const VertexStarts &starts;
  const MeshView &mesh;
};

// What a back end must offer, as static functions. Where E stands, they also take a CountingExecutor of theirs, and
// then only ask for memory.
//
//   Candidates, LearntRooms, and Slice, which is SliceWork of both
//   find_solvent_features(E, atoms, parameters, plan, rooms, features)
//   gather_candidates(E, slice, signs)
//       for stages that share them, to be called first then; some signs may be known with that
//   evaluate_signs(E, slice, signs)
//       signs[8 * brick + leaf] for the bricks of the slice: bit set = farther than depth inside the boundary
//   mark_thin_walls(E, slice, signs, marks)
//       of the signs of all bricks: sets the bits in marks, which are numbered like signs, of the points that are to be
//       inside because of edges of the slice's bricks (thin_walls.h)
//   emit_vertices(E, slice, vertices)
//   emit_triangles(E, bricks, layout, slice, table, mesh)
//   emit_mesh(E, slice, vertices, table, triangles_made, emit_apart)
//       both, of a slice that is not empty: side by side where that is quicker, with triangles_made() once all is given
//       that makes the triangles; else these come first, by emit_apart()
//   evaluate_density(E, density, bricks, slices, signs)
//       signs of a Gaussian surface; slices(work_on) calls work_on(slice) for runs of bricks
//   emit_density_vertices(E, density, bricks, layout, mesh)
//       all of them
//   for_each_gathering(E, n, f)
//       f(near by, i), where near by gathers the features around a place, as LocalFeatures do (local_features.h)
template <class Executor>
struct Backend;
template <class Executor>
struct Backend<CountingExecutor<Executor>> : Backend<Executor> {};

template <class Executor>
using Candidates = typename Backend<Executor>::Candidates;
template <class Executor>
using LearntRooms = typename Backend<Executor>::LearntRooms;

}  // namespace quickses
