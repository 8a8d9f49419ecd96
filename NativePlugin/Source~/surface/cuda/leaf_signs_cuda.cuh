// SPDX-License-Identifier: MIT
// GPU: what is done alike for the signs of a leaf, whether a warp finds them or a block.
#pragma once

#include "parallel/cuda_async_copy.cuh"
#include "surface/cuda/covering_caps_cuda.cuh"
#include "surface/cuda/deepest_atoms_cuda.cuh"

namespace quickses {
namespace gpu {

constexpr int kLanePoints = 2;  // lattice points of a leaf for each lane of a warp

struct ListedArc {
  uint32_t number, leaves;
};

struct SignLeaf {
  uint32_t slot;
  CandidateRow row;
  const uint8_t *arc_leaves;  // of the row's arcs
  glm::ivec3 first;           // lattice point
  Vec3<float> center;

  __device__ __forceinline__ int number() const { return static_cast<int>(slot % kLeavesPerBrick); }
  // Can it be within depth of a point?
  __device__ __forceinline__ bool meets(const ListedArc &arc) const { return (arc.leaves >> number() & 1) != 0; }
  // That of each lane, from place k0 on.
  __device__ __forceinline__ ListedArc listed_arc(uint32_t k0) const {
    const uint32_t k = k0 + static_cast<uint32_t>(lane_id());
    return k < row.arc_count ? ListedArc{__ldg(row.arcs + k), __ldg(arc_leaves + k)} : ListedArc{0, 0};
  }
};

enum class LeafKind { kMixed, kInside, kOutside, kFarOutside };

// What is known of a lane's points.
struct LaneSigns {
  bool inside[kLanePoints];
  uint32_t decider[kLanePoints];

  __device__ __forceinline__ explicit LaneSigns(LeafKind kind) {
#pragma unroll
    for (int c = 0; c < kLanePoints; ++c) {
      inside[c] = kind == LeafKind::kInside;
      decider[c] = kind == LeafKind::kFarOutside ? kOutsideBalls : kNotLookedAt;
    }
  }

  // By the ball that a point is deepest in. Returns whether what covers that has to be looked at.
  __device__ __forceinline__ bool settle_by_ball(int c, const CandidateReach &reach, const DeepestAtom &deepest) {
    const bool may_be_inside = deepest.depth > reach.least_depth;
    inside[c] = deepest.depth > reach.depth;
    decider[c] = may_be_inside ? kOnContact | deepest.atom : kOutsideBalls;
    return may_be_inside && !inside[c];
  }
};

struct SignJob {
  FeatureView features;
  BrickSet bricks;
  CandidateReach reach;
  CandidateView view;
  uint64_t *signs;  // nullptr: known already

  __device__ __forceinline__ SignLeaf open(size_t place) const {
    SignLeaf leaf;
    leaf.slot = view.leaf_list[place];
    leaf.row = view.row_of(leaf.slot);
    leaf.arc_leaves = view.arc_leaves + (leaf.row.arcs - view.arcs);
    const Lattice &lattice = bricks.lattice;
    leaf.first = lattice.first_point(bricks.place(view.first_brick + leaf.slot / kLeavesPerBrick));
    leaf.center = leaf_center(lattice.position(leaf.first.x, leaf.first.y, leaf.first.z), leaf.number(), reach.spacing);
    leaf.first += brick_point(leaf.number(), 0);
    return leaf;
  }

  // Of `count` atoms, atom_at(k), those that can be deepest at one of its points: as choose_deepest_atoms() has it.
  template <class AtomAt, class Visit>
  __device__ __forceinline__ DeepestAtom choose_atoms(const SignLeaf &leaf, uint32_t count, const AtomAt &atom_at,
                                                      const Visit &visit) const {
    const float half = 1.5f * reach.spacing;
    return choose_deepest_atoms<kWarp>(features, count, atom_at, leaf.center, {half, half, half},
                                       -reach.leaf_radius - reach.slack, reach.slack, visit);
  }

  // depth: of the leaf's centre in the ball that it is deepest in.
  __device__ __forceinline__ LeafKind kind(float depth) const {
    const float far = -reach.leaf_radius - reach.slack;
    if (depth <= far) return LeafKind::kFarOutside;
    // Where points may be next to one that is inside, what decides about them is asked for.
    const bool is_asked = view.deciders && depth > reach.depth - kRoot3 * reach.spacing + far;
    if (depth <= reach.least_depth && reach.depth > -far && !is_asked) return LeafKind::kOutside;
    return depth + far > reach.depth ? LeafKind::kInside : LeafKind::kMixed;
  }

  __device__ __forceinline__ Vec3<float> point(const SignLeaf &leaf, int c) const {
    const int lane = lane_id();
    return bricks.lattice.position(leaf.first.x + (lane & 3), leaf.first.y + (lane >> 2 & 3),
                                   leaf.first.z + (lane >> 4) + 2 * c);
  }

  // By a warp.
  __device__ __forceinline__ void put(const SignLeaf &leaf, const LaneSigns &found) const {
    unsigned words[kLanePoints];
#pragma unroll
    for (int c = 0; c < kLanePoints; ++c) {
      if (view.deciders) view.deciders_of(leaf.slot)[c * kWarp + lane_id()] = found.decider[c];
      words[c] = __ballot_sync(kFullWarp, found.inside[c]);
    }
    if (lane_id() == 0 && signs)
      signs[static_cast<size_t>(view.first_brick) * kLeavesPerBrick + leaf.slot] =
          static_cast<uint64_t>(words[1]) << 32 | words[0];
  }
};

}  // namespace gpu
}  // namespace quickses
