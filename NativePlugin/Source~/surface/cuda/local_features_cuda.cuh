// SPDX-License-Identifier: MIT
// GPU: a warp for each place around which features are gathered (stages/local_features.h): its lanes go the same way
// and have the same results. Fewer lanes per place would do with fewer instructions, but places go different ways, and
// then wait for each other.
#pragma once

#include "parallel/cuda_executor.cuh"
#include "surface/cuda/lane_candidates_cuda.cuh"
#include "surface/stages/local_features.h"

namespace quickses {
namespace gpu {

constexpr int kGatheringThreads = 128;
// The items that are met, then what is kept, for every point that is tried.
constexpr uint64_t kGatheringSteps = 4096;

struct LocalLists {
  uint32_t atoms[LocalReach::kMostAtoms], arcs[LocalReach::kMostArcs];
};

class GatheredFeatures : public LaneCandidates<kWarp> {
 public:
  explicit __device__ __forceinline__ GatheredFeatures(LocalLists &lists)
      : LaneCandidates<kWarp>{lists.atoms, lists.arcs, 0, 0}, lists_(lists) {}

  __device__ __forceinline__ bool gather(const FeatureView &f, const Vec3<float> &x, float around) {
    const LocalReach reach(f, x, around);
    __syncwarp();  // nobody looks at the lists any more
    const CellBox atom_box = reach.box(f.atoms, reach.atom_reach);
    float deepest = -kFarAway;
    uint32_t met = visit(f.atoms, atom_box, LocalReach::kMostMet, [&](uint32_t i, bool on) {
      if (on) deepest = maximum(deepest, ball_depth(load(f.atoms.items + i), x));
    });
    if (met > LocalReach::kMostMet) return false;
    const float least = warp_maximum(deepest) - reach.slack;
    atom_total = 0;
    visit(f.atoms, atom_box, met, [&](uint32_t i, bool on) {
      keep(i, on && ball_depth(load(f.atoms.items + i), x) >= least, lists_.atoms, LocalReach::kMostAtoms, &atom_total);
    });
    if (atom_total > LocalReach::kMostAtoms) return false;
    arc_total = 0;
    if (f.arc_bounds.count > 0) {
      const CellBox arc_box = reach.box(f.arc_bounds, reach.arc_reach);
      met += visit(f.arc_bounds, arc_box, LocalReach::kMostMet - met, [&](uint32_t i, bool on) {
        keep(i, on && reach.meets(load(f.arc_bounds.items + i), x) && reach.is_near(load(f.arcs + i)), lists_.arcs,
             LocalReach::kMostArcs, &arc_total);
      });
      if (met > LocalReach::kMostMet || arc_total > LocalReach::kMostArcs) return false;
    }
    __syncwarp();  // the lists are written
    return true;
  }

 private:
  // Returns how many are met, of which no more than so many are visited.
  template <class Visit>
  static __device__ __forceinline__ uint32_t visit(const NeighborGridView &grid, const CellBox &box, uint32_t most,
                                                   const Visit &visit) {
    return visit_runs(
        grid.runs(box), [&](int r) { return grid.run(box, r); }, visit, most);
  }
  // count: of those kept, which may be more than there is room for.
  static __device__ __forceinline__ void keep(uint32_t item, bool is_kept, uint32_t *out, int room, int *count) {
    const int place = append_place(is_kept, count);
    if (is_kept && place < room) out[place] = item;
  }

  LocalLists &lists_;
};

// Where the candidates are the class above, not one that it is derived from: overloads, not templates.
__device__ __forceinline__ DeepestAtom deepest_atom(const FeatureView &f, const GatheredFeatures &near_by,
                                                    const Vec3<float> &x) {
  return deepest_atom(f, static_cast<const LaneCandidates<kWarp> &>(near_by), x);
}
__device__ __forceinline__ NearestArc nearest_arc(const FeatureView &f, const GatheredFeatures &near_by,
                                                  const Vec3<float> &x) {
  return nearest_arc(f, static_cast<const LaneCandidates<kWarp> &>(near_by), x);
}

__device__ __forceinline__ bool is_on_contact(const FeatureView &f, const GatheredFeatures &near_by,
                                              const DeepestAtom &deepest, const Vec3<float> &x) {
  return is_on_contact(f, static_cast<const LaneCandidates<kWarp> &>(near_by), deepest, x);
}

// Seven blocks per multiprocessor: the work waits for memory, so more of it at a time is worth a few registers.
template <class F>
__global__ __launch_bounds__(kGatheringThreads, 7) void gathering_kernel(QueuedItems queued, F f) {
  const LaunchItems items = queued.in_turn();
  constexpr unsigned kTeams = kGatheringThreads / kWarp;
  __shared__ LocalLists lists[kTeams];
  const unsigned team = threadIdx.x / kWarp;
  const size_t i = items.first + static_cast<size_t>(blockIdx.x) * kTeams + team;
  if (i >= items.last) return;
  GatheredFeatures near_by(lists[team]);
  f(near_by, i);
}

}  // namespace gpu
}  // namespace quickses
