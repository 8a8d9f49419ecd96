// SPDX-License-Identifier: MIT
// The hot stages on the CPU (stages/hot_stages.h).
#pragma once

#include "surface/cpu/exact_ses_cpu.h"
#include "surface/cpu/gaussian_density_cpu.h"
#include "surface/cpu/local_features_cpu.h"
#include "surface/cpu/mesh_memory_cpu.h"
#include "surface/cpu/solvent_features_cpu.h"

namespace quickses {

template <>
struct Backend<CpuKernelExecutor> {
  // A thread gathers the candidates of a brick when it comes to it, and its scratch remembers how much room they took.
  struct Candidates {};
  struct LearntRooms {
    void forget() {}
  };
  using Slice = SliceWork<LearntRooms, Candidates>;

  template <class E>
  static void find_solvent_features(E &executor, const NeighborGridView &atoms, const SurfaceParameters &parameters,
                                    const MemoryPlan &plan, LearntRooms &, SolventFeatures *features) {
    quickses::find_solvent_features(executor, atoms, parameters, plan.low_memory, features);
  }
  template <class E>
  static void gather_candidates(E &, const Slice &, uint64_t *) {}
  template <class E>
  static void evaluate_signs(E &executor, const Slice &s, uint64_t *signs) {
    if constexpr (!E::kCounts) quickses::evaluate_signs(executor, s.features, s.bricks, s.slice, signs);
  }
  template <class E>
  static void mark_thin_walls(E &executor, const Slice &s, const uint64_t *signs, uint64_t *marks) {
    if constexpr (!E::kCounts) quickses::mark_thin_walls(executor, s.features, s.bricks, s.slice, signs, marks);
  }
  template <class E>
  static void emit_vertices(E &executor, const Slice &s, const VertexWork &v) {
    if constexpr (!E::kCounts)
      quickses::emit_vertices(executor, s.features, s.bricks, v.layout, s.slice, v.starts, v.mesh);
  }
  template <class E>
  static void emit_triangles(E &executor, const BrickSet &bricks, const MeshLayout &layout, BrickRange slice,
                             const TableView &table, const MeshView &mesh) {
    if constexpr (!E::kCounts) quickses::emit_triangles(executor, bricks, layout, slice, table, mesh);
  }
  template <class E, class TrianglesMade, class EmitApart>
  static void emit_mesh(E &executor, const Slice &s, const VertexWork &v, const TableView &, const TrianglesMade &,
                        const EmitApart &emit_apart) {
    emit_apart();
    emit_vertices(executor, s, v);
  }
  template <class E, class Slices>
  static void evaluate_density(E &executor, const GaussianDensity &density, const BrickSet &bricks,
                               const Slices &slices, uint64_t *signs) {
    slices([&](BrickRange slice) {
      if constexpr (!E::kCounts) quickses::evaluate_density(executor, density, bricks, slice, signs);
    });
  }
  template <class E>
  static void emit_density_vertices(E &executor, const GaussianDensity &density, const BrickSet &bricks,
                                    const MeshLayout &layout, const MeshView &mesh) {
    if constexpr (!E::kCounts) quickses::emit_density_vertices(executor, density, bricks, layout, mesh);
  }
  template <class E, class F>
  static void for_each_gathering(E &executor, size_t n, const F &f) {
    const CpuKernels *kernels = nullptr;
    if constexpr (!E::kCounts) kernels = &executor.kernels();
    executor.template for_each_brick<LocalColumns>(
        n,
        [f, kernels](SoloTeam, LocalColumns &columns, size_t i) {
          GatheredFeatures near_by{columns, *kernels};
          f(near_by, i);
        },
        64);
  }
};

}  // namespace quickses
