// SPDX-License-Identifier: MIT
// The hot stages on the GPU (stages/hot_stages.h).
#pragma once

#include "parallel/second_stream.cuh"
#include "surface/cuda/gather_candidates_cuda.cuh"
#include "surface/cuda/gaussian_density_cuda.cuh"
#include "surface/cuda/local_features_cuda.cuh"
#include "surface/cuda/mesh_cuda.cuh"
#include "surface/cuda/mesh_memory_cuda.cuh"
#include "surface/cuda/sign_leaves_cuda.cuh"
#include "surface/cuda/solvent_features_cuda.cuh"
#include "surface/cuda/thin_walls_cuda.cuh"

namespace quickses {

template <>
struct Backend<CudaExecutor> {
  using Candidates = CudaCandidates;
  using LearntRooms = CudaRooms;
  using Slice = CudaSlice;
  using SecondStream = quickses::SecondStream;

  template <class E>
  static void find_solvent_features(E &executor, const NeighborGridView &atoms, const SurfaceParameters &parameters,
                                    const MemoryPlan &plan, LearntRooms &rooms, SolventFeatures *features) {
    if (E::kCounts) expect_features(executor, features);
    gpu::find_solvent_features(executor, atoms, parameters, plan, rooms, features);
    if (E::kCounts) expect_features(executor, features);
  }
  // The candidates live in the executor's arena: they are there until it is rewound.
  template <class E>
  static void gather_candidates(E &executor, const Slice &s, uint64_t *signs) {
    if (s.slice.size() > 0) gpu::gather_candidates(executor, s, signs);
  }
  template <class E>
  static void evaluate_signs(E &executor, const Slice &s, uint64_t *signs) {
    if (s.slice.size() == 0) return;
    const bool are_shared = s.candidates.are_of(s.slice);
    if (!are_shared) gpu::gather_candidates(executor, s, signs);
    gpu::evaluate_leaves(executor, s, are_shared && s.features.parameters.has_thin_walls(), signs);
  }
  template <class E>
  static void mark_thin_walls(E &executor, const Slice &s, const uint64_t *signs, uint64_t *marks) {
    if (s.slice.size() > 0) gpu::mark_thin_walls(executor, s, signs, marks);
  }
  template <class E>
  static void emit_vertices(E &executor, const Slice &s, const VertexWork &v) {
    if (s.slice.size() > 0) gpu::emit_vertices(executor, s, v);
  }
  template <class E>
  static void emit_triangles(E &executor, const BrickSet &bricks, const MeshLayout &layout, BrickRange slice,
                             const TableView &table, const MeshView &mesh) {
    gpu::emit_triangles(executor, bricks, layout, slice, table, mesh);
  }
  template <class E, class TrianglesMade, class EmitApart>
  static void emit_mesh(E &executor, const Slice &s, const VertexWork &v, const TableView &table,
                        const TrianglesMade &triangles_made, const EmitApart &emit_apart) {
    gpu::emit_mesh(executor, s, v, table, triangles_made, emit_apart);
  }
  template <class E, class Slices>
  static void evaluate_density(E &executor, const GaussianDensity &density, const BrickSet &bricks,
                               const Slices &slices, uint64_t *signs) {
    gpu::evaluate_density(executor, density, bricks, slices, signs);
  }
  template <class E>
  static void emit_density_vertices(E &executor, const GaussianDensity &density, const BrickSet &bricks,
                                    const MeshLayout &layout, const MeshView &mesh) {
    gpu::emit_density_vertices(executor, density, bricks, layout, mesh);
  }
  template <class E, class F>
  static void for_each_gathering(E &executor, size_t n, const F &f) {
    constexpr int kThreads = gpu::kGatheringThreads, kItems = kThreads / gpu::kWarp;
    executor.launch("gather", gpu::gathering_kernel<F>, n, LaunchShape{kThreads, kItems, gpu::kGatheringSteps}, f);
  }

 private:
  static void expect_features(CudaExecutor &, SolventFeatures *) {}
  static void expect_features(CountingExecutor<CudaExecutor> &executor, SolventFeatures *features) {
    features->caps.size = static_cast<size_t>(executor.facts().caps);
    features->arcs.size = static_cast<size_t>(executor.facts().arcs);
  }
};

}  // namespace quickses
