// SPDX-License-Identifier: MIT
// GPU: a few lanes of a warp for each place around which features are gathered (stages/local_features.h). They go the
// same way and have the same results.
#pragma once

#include "parallel/cuda_executor.cuh"
#include "surface/cuda/lane_candidates_cuda.cuh"
#include "surface/stages/local_features.h"

namespace quickses {
namespace gpu {

constexpr int kGatheringThreads = 128, kGatheringLanes = 8;
// The items that are met, then what is kept, for every point that is tried.
constexpr uint64_t kGatheringSteps = 8192;

struct LocalLists {
  uint32_t atoms[LocalReach::kMostAtoms], arcs[LocalReach::kMostArcs];
};

class GatheredFeatures : public LaneCandidates<kGatheringLanes> {
 public:
  explicit __device__ __forceinline__ GatheredFeatures(LocalLists &lists)
      : LaneCandidates<kGatheringLanes>{lists.atoms, lists.arcs, 0, 0}, lists_(lists) {}

  __device__ __forceinline__ bool gather(const FeatureView &f, const Vec3<float> &x, float around) {
    const LocalReach reach(f, x, around);
    __syncwarp(lanes());  // nobody looks at the lists any more
    const CellBox atom_box = reach.box(f.atoms, reach.atom_reach);
    uint32_t met = count_met(f.atoms, atom_box);
    if (met > LocalReach::kMostMet) return false;
    float deepest = -kFarAway;
    visit(f.atoms, atom_box, [&](uint32_t i, bool on) {
      if (on) deepest = maximum(deepest, ball_depth(load(f.atoms.items + i), x));
    });
    const float least = warp_maximum<kGatheringLanes>(deepest, lanes()) - reach.slack;
    atom_total = keep(f.atoms, atom_box, lists_.atoms, LocalReach::kMostAtoms,
                      [&](uint32_t i) { return ball_depth(load(f.atoms.items + i), x) >= least; });
    if (atom_total > LocalReach::kMostAtoms) return false;
    arc_total = 0;
    if (f.arc_bounds.count > 0) {
      const CellBox arc_box = reach.box(f.arc_bounds, reach.arc_reach);
      met += count_met(f.arc_bounds, arc_box);
      if (met > LocalReach::kMostMet) return false;
      arc_total = keep(f.arc_bounds, arc_box, lists_.arcs, LocalReach::kMostArcs, [&](uint32_t i) {
        return reach.meets(load(f.arc_bounds.items + i), x) && reach.is_near(load(f.arcs + i));
      });
      if (arc_total > LocalReach::kMostArcs) return false;
    }
    __syncwarp(lanes());  // the lists are written
    return true;
  }

 private:
  static __device__ __forceinline__ int rows(const CellBox &b) { return (b.y1 - b.y0 + 1) * (b.z1 - b.z0 + 1); }
  static __device__ __forceinline__ ItemRun run(const NeighborGridView &grid, const CellBox &b, int row) {
    const int width = b.y1 - b.y0 + 1;
    return grid.run(b.x0, b.x1, b.y0 + row % width, b.z0 + row / width);
  }
  static __device__ __forceinline__ uint32_t count_met(const NeighborGridView &grid, const CellBox &box) {
    uint32_t own = 0;
    for (int row = rank(); row < rows(box); row += kGatheringLanes) {
      const ItemRun r = run(grid, box, row);
      own += r.end - r.begin;
    }
    const uint32_t sum = warp_inclusive_sum<kGatheringLanes>(own, rank(), lanes());
    return __shfl_sync(lanes(), sum, kGatheringLanes - 1, kGatheringLanes);
  }
  template <class Visit>
  static __device__ __forceinline__ void visit(const NeighborGridView &grid, const CellBox &box, const Visit &visit) {
    visit_runs<kGatheringLanes>(
        rows(box), [&](int row) { return run(grid, box, row); }, visit, lanes());
  }
  // Returns how many are to be kept, which may be more than there is room for.
  template <class Keep>
  static __device__ __forceinline__ int keep(const NeighborGridView &grid, const CellBox &box, uint32_t *out, int room,
                                             const Keep &is_kept) {
    int n = 0;
    visit(grid, box, [&](uint32_t i, bool on) {
      const bool kept = on && is_kept(i);
      const int place = append_place(kept, &n, lanes());
      if (kept && place < room) out[place] = i;
    });
    return n;
  }

  LocalLists &lists_;
};

// Where the candidates are the class above, not one that it is derived from: overloads, not templates.
__device__ __forceinline__ DeepestAtom deepest_atom(const FeatureView &f, const GatheredFeatures &near_by,
                                                    const Vec3<float> &x) {
  return deepest_atom(f, static_cast<const LaneCandidates<kGatheringLanes> &>(near_by), x);
}
__device__ __forceinline__ NearestArc nearest_arc(const FeatureView &f, const GatheredFeatures &near_by,
                                                  const Vec3<float> &x) {
  return nearest_arc(f, static_cast<const LaneCandidates<kGatheringLanes> &>(near_by), x);
}

__device__ __forceinline__ bool is_on_contact(const FeatureView &f, const GatheredFeatures &near_by,
                                              const DeepestAtom &deepest, const Vec3<float> &x) {
  return is_on_contact(f, static_cast<const LaneCandidates<kGatheringLanes> &>(near_by), deepest, x);
}

// Seven blocks per multiprocessor: the work waits for memory, so more of it at a time is worth a few registers.
template <class F>
__global__ __launch_bounds__(kGatheringThreads, 7) void gathering_kernel(LaunchItems items, F f) {
  constexpr unsigned kTeams = kGatheringThreads / kGatheringLanes;
  __shared__ LocalLists lists[kTeams];
  const unsigned team = threadIdx.x / kGatheringLanes;
  const size_t i = items.first + static_cast<size_t>(blockIdx.x) * kTeams + team;
  if (i >= items.last) return;
  GatheredFeatures near_by(lists[team]);
  f(near_by, i);
}

}  // namespace gpu
}  // namespace quickses
