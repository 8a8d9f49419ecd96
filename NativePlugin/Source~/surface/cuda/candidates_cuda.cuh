// SPDX-License-Identifier: MIT
// GPU: the atoms and arcs that can matter in a brick or a leaf, kept as rows of numbers, as the stages of a slice share
// them.
#pragma once

#include "parallel/cuda_executor.cuh"
#include "parallel/cuda_warp.cuh"
#include "surface/stages/hot_stages.h"

namespace quickses {
namespace gpu {

// How far things can matter, from the spacing h and the depth d. A leaf's points are within 1.5 root(3) h of its
// centre.
struct CandidateReach {
  float depth, spacing;
  float overhang;     // of vertex starts around the points of a brick or leaf
  float grown;        // of vertices around them: a start moves by up to kStartReach when it is projected
  float leaf_radius;  // ball around the points of a leaf
  float start_reach;  // start_reach(), and some
  float sign_arcs2;   // squared: arcs this near to a leaf's centre can be within depth of one of its points
  float slack;
  float least_depth;  // of a point that may be inside

  static CandidateReach of(const SurfaceParameters &p) {
    const float h = p.spacing, d = p.depth;
    CandidateReach r;
    r.depth = d;
    r.spacing = h;
    r.slack = 1e-3f + 0.01f * h;
    r.least_depth = p.least_depth();
    r.overhang = kStartOverhang * h;
    r.grown = (kStartOverhang + kStartReach) * h;
    r.leaf_radius = 1.5f * kRoot3 * h;
    r.start_reach = quickses::start_reach(p) + r.slack;
    const float sign = d + r.leaf_radius + r.slack;
    r.sign_arcs2 = sign * sign;
    return r;
  }
};

// How many atoms or arcs a brick or leaf of so many points along an edge lists, as a rule: half of its surroundings
// filled as densely as a protein.
inline double listed_candidates(const SurfaceParameters &parameters, int points) {
  const CandidateReach reach = CandidateReach::of(parameters);
  const double wide =
      static_cast<double>(static_cast<float>(points) * reach.spacing + 2.f * reach.grown + 2.f * parameters.max_radius);
  return 16.0 + 0.03 * std::min(1e6, wide * wide * wide);
}

// Words of the list that a leaf with vertices has besides (vertex_candidates_cuda.cuh): with its volume, more can
// matter to it.
inline uint32_t leaf_list_words(const SurfaceParameters &parameters) {
  constexpr double kUsual = 64, kUsualSpacing = 0.6, kMost = 2048;
  const double scale = static_cast<double>(parameters.spacing) / kUsualSpacing;
  return static_cast<uint32_t>(std::min(kMost, kUsual * std::max(1.0, std::ceil(scale * scale * scale))));
}
// Room that small structures are given beyond what is usual.
constexpr size_t kSpareCandidates = 1024;

// Rows of a brick or a leaf: runs in the lists of atoms and arcs.
struct CandidateRow {
  unsigned long long first_atom, first_arc;
  uint32_t atom_count, arc_count;
};

// From such a spacing on, Å, a leaf is so wide that it has rows of its own, chosen from those of its brick: of two or
// three thousand atoms and arcs around a brick, a third is near a leaf.
constexpr float kSpacingOfLeafRows = 1.2f;

// Rows that are longer than this are told of.
constexpr uint32_t kUsualRow = 192;
struct CandidateCounters {
  unsigned long long atoms, arcs, leaves;
  uint32_t longest_row;  // of atoms or arcs; 0: none is longer than usual

  static CandidateCounters anticipated(const CandidateCounters &last, const CandidateCounters &most) {
    return {most.atoms, most.arcs, std::min(and_some_more(last.leaves), most.leaves),
            std::max(and_some_more(last.longest_row), kUsualRow)};
  }
  bool covers(const CandidateCounters &found) const {
    return found.atoms <= atoms && found.arcs <= arcs && found.leaves <= leaves && found.longest_row <= longest_row;
  }
};

// The lists for a slice of bricks, as kernels see them.
struct CandidateView {
  uint32_t first_brick, bricks;
  CandidateRow *rows;  // of the bricks of the slice, or of their leaves
  int row_shift;       // a leaf's is rows[slot >> row_shift], where slot is 8 * brick of the slice + leaf
  uint32_t *atoms;
  uint32_t *arcs;
  uint8_t *arc_leaves;    // per entry of arcs: bit set = can be within depth of a point of that leaf
  uint32_t *leaf_list;    // leaves between whose points the surface may pass: 8 * brick of the slice + leaf
  uint8_t *brick_leaves;  // the same per brick: a bit per leaf
  const CandidateCounters *counted;
  unsigned long long leaf_room;  // so many leaves are evaluated: if there are more, all will be done again
  uint32_t *deciders;  // by 64 * (8 * brick + leaf) + bit, of those leaves: what a sign is from; nullptr: not kept

  // brick: of the set; one of the slice.
  __device__ __forceinline__ uint32_t slot_of(uint32_t brick, int leaf) const {
    return (brick - first_brick) * kLeavesPerBrick + static_cast<uint32_t>(leaf);
  }
  __device__ __forceinline__ CandidateRow row_of(uint32_t slot) const { return rows[slot >> row_shift]; }
};
constexpr int kRowOfBrick = 3, kRowOfLeaf = 0;  // row_shift
static_assert(1 << kRowOfBrick == kLeavesPerBrick, "a brick's leaves share its row");

// What decides about a point that is outside, for thin walls, which ask for the nearest probe: the number of the
// nearest arc; that of the atom on whose exposed part the point is projected, with kOnContact; or one of the others.
constexpr uint32_t kOnContact = 0x80000000u, kOutsideBalls = 0xffffffffu, kNotLookedAt = 0xfffffffeu;

constexpr uint32_t kNoAtom = 0xffffffffu;

__device__ __forceinline__ Vec3<float> leaf_center(const Vec3<float> &low, int leaf, float h) {
  return {low.x + (static_cast<float>(4 * (leaf & 1)) + 1.5f) * h,
          low.y + (static_cast<float>(4 * (leaf >> 1 & 1)) + 1.5f) * h,
          low.z + (static_cast<float>(4 * (leaf >> 2)) + 1.5f) * h};
}

}  // namespace gpu

// What the stages of a slice share: rows of atoms and arcs, and its active leaves.
struct CudaCandidates {
  BrickRange slice{0, 0};  // the bricks they are for; empty: not gathered yet
  gpu::CandidateView view{};
  bool have_deciders = false;
  Span<uint32_t> decider_room{};  // for them; none: it is allocated
  Span<uint32_t> vertex_room{};   // for vertices (vertex_words); none: it is allocated
  size_t leaves = 0;
  uint32_t longest_row = 0;  // of atoms or arcs, at most
  // Words that placing vertices takes, of leaves that own some.
  static size_t vertex_words(const SurfaceParameters &parameters, size_t vertices, size_t leaves) {
    return 4 * vertices + leaves * gpu::leaf_list_words(parameters);
  }
  bool are_of(BrickRange r) const { return slice.first == r.first && slice.last == r.last; }
  // Steps of a thread that looks at all atoms and arcs of a row, and at an atom's caps.
  uint64_t look_steps(const FeatureView &features) const { return 64 + 2 * uint64_t(longest_row) + features.most_caps; }
};

}  // namespace quickses
