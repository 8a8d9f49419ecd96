// SPDX-License-Identifier: MIT
// Bytes that the work on a surface takes, from what is known of it: for estimates before the work, and for what to say
// when a budget does not suffice. The stages allocate what is counted here; memory_test.cpp compares the two.
#pragma once

#include "surface/methods/exact_surface.h"
#include "surface/methods/grid_ses.h"
#include "surface/memory/work_facts.h"

namespace quickses {

// What the plan depends on besides.
struct WorkKind {
  bool exact = true, masked = false, components = false;
  uint32_t relaxation_steps = 1;
  MeshShape shape{};
  SurfaceParameters parameters{};
};

template <class Executor>
class MemoryPlan {
 public:
  MemoryPlan(const WorkFacts &facts, const WorkKind &kind) : f_(facts), k_(kind) {}

  // All at once, as without a budget; prepared: bytes that the features keep, peak: most that they took.
  double whole(double prepared, double peak) const {
    double making = beside_mesh();
    if (Executor::kIsCuda && k_.exact)
      making +=
          f_.size.bricks * CandidatesOf<Executor>::emission_bytes(
                               k_.parameters, candidates(), f_.size.vertices / bricks(), f_.size.leaves / bricks()) +
          CandidatesOf<Executor>::kSpareBytes;
    double level =
        brick_bytes() + (k_.exact ? 0 : kGridBrickBytes * f_.size.bricks) + std::max(making, component_bytes());
    if (Executor::kIsCuda) level += mesh_bytes();
    return std::max(peak, prepared + level + mask_bytes());
  }

  // With as little as possible, in pieces.
  double least() const {
    const double atoms = static_cast<double>(f_.atoms), arcs = static_cast<double>(f_.arcs);
    const double atom_grid = 21 * atoms + 4 * static_cast<double>(f_.atom_cells) + (k_.shape.colors ? 4 * atoms : 0) +
                             (k_.shape.texcoords ? 8 * atoms : 0) + (k_.masked ? atoms : 0);
    double kept = atom_grid, most = atom_grid + 52 * atoms;
    if (k_.exact) {
      kept += 9 * atoms + 16 * static_cast<double>(f_.caps) + 48 * arcs;
      if (!Executor::kIsCuda) kept += (8 + kChunkBytes) * atoms;
      most = std::max(most, kept + (Executor::kIsCuda ? run_bytes() : 0.0));
      kept += 20 * arcs + 4 * static_cast<double>(f_.arc_cells);
      most = std::max(most, kept + 52 * arcs);
    } else {
      kept += kGridBrickBytes * f_.size.bricks;
    }
    double level = brick_bytes() + std::max(beside_mesh(), component_bytes()) + mask_bytes();
    if (Executor::kIsCuda)
      level = brick_bytes() + (k_.masked ? (f_.size.vertices + f_.size.triangles) / 4 : 0) + slice_bytes();
    return std::max(most, kept + level) * 1.02 + 32768;
  }

  double mesh_bytes() const {
    return static_cast<double>(
        MeshArrays(static_cast<size_t>(f_.size.vertices), static_cast<size_t>(f_.size.triangles), k_.shape).bytes());
  }

 private:
  static constexpr double kChunkBytes = 10;  // per atom, of chunks of four

  CandidateCounts candidates() const { return {static_cast<double>(f_.atoms), static_cast<double>(f_.arcs)}; }
  // The smallest run of atoms (solvent_features_cuda.cuh). Larger spheres have more neighbours: rows of those that have
  // more than shared memory holds.
  double run_bytes() const {
    const double wide = std::max(1.0, static_cast<double>(k_.parameters.max_radius) / 3.2);
    const double neighbors = std::min(static_cast<double>(f_.atoms), 60.0 * wide * wide * wide);
    const double caps = std::min(neighbors, 28.0 * wide * wide);
    return 128 * 3 * (30 * caps + 300) + (neighbors > 100 ? 128 * 24 * 1.5 * neighbors : 0.0) + 150000;
  }
  double bricks() const { return std::max(1.0, f_.size.bricks); }
  // Table, list, signs and layout.
  double brick_bytes() const {
    return 5 * static_cast<double>(f_.brick_entries) + (8 + 64 + 276 + 8 + 12) * f_.size.bricks;
  }
  // Sums and starts of the steps after the first; of the grid method, sums.
  double beside_mesh() const {
    if (!k_.exact) return sizeof(RingSum) * f_.size.vertices;
    return k_.relaxation_steps > 1 ? (sizeof(RingSum) + sizeof(glm::vec3)) * f_.size.vertices : 0.0;
  }
  // Where there is no room for them, the GPU leaves the components to the CPU.
  double component_bytes() const { return k_.components ? kComponentBytes * f_.size.vertices : 0.0; }
  // The mesh that is handed out besides the whole one; on the CPU it is the whole one that is work.
  double mask_bytes() const { return k_.masked ? mesh_bytes() + (f_.size.vertices + f_.size.triangles) / 4 : 0.0; }
  // The smallest slices, of bricks much fuller than the mean.
  double slice_bytes() const {
    if (!k_.exact) return 65536;
    const double vertices = 3 * f_.size.vertices / bricks(), triangles = 3 * f_.size.triangles / bricks();
    const double slab = vertices * (28 + (k_.shape.texcoords ? 8 : 0) + 5) + triangles * 12;
    return kLeastSlice *
               (CandidatesOf<Executor>::emission_bytes(k_.parameters, candidates(), vertices, kLeavesPerBrick) * 2 +
                slab) +
           32768;
  }

  WorkFacts f_;
  WorkKind k_;
};

}  // namespace quickses
