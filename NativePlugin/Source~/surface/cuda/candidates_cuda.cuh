// SPDX-License-Identifier: MIT
// GPU: the atoms and arcs that can matter in a brick or a leaf, kept as rows of numbers, as the stages of a slice share
// them.
#pragma once

#include "parallel/cuda_executor.cuh"
#include "parallel/cuda_warp.cuh"
#include "surface/stages/hot_stages.h"

#include <algorithm>

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
  const uint32_t *atoms, *arcs;
  uint32_t atom_count, arc_count;
};

// From such a spacing on, Å, a leaf is so wide that it has rows of its own, chosen from those of its brick: of two or
// three thousand atoms and arcs around a brick, a third is near a leaf.
inline bool have_leaf_rows(const SurfaceParameters &parameters) { return parameters.spacing >= 1.2f; }

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

// The lists for a run of bricks, as kernels see them. It may be gathered part by part: rows and bits are those of all
// parts, the lists those of the last one.
struct CandidateView {
  uint32_t first_brick, bricks;
  CandidateRow *rows;     // of the bricks, or of their leaves
  int row_shift;          // a leaf's is rows[slot >> row_shift], where slot is 8 * brick of the run + leaf
  uint8_t *brick_leaves;  // per brick, a bit per leaf: the surface may pass between its points
  uint32_t *atoms;
  uint32_t *arcs;
  uint8_t *arc_leaves;  // per entry of arcs: bit set = can be within depth of a point of that leaf
  uint32_t *leaf_list;  // slots of the leaves between whose points the surface may pass
  const CandidateCounters *counted;
  // What the signs of points are from, in leaves between whose points the surface may pass; nullptr: not kept. Of the
  // bricks decided, which may be fewer than were gathered: later ones take the place of the first.
  uint32_t *deciders;
  uint32_t decider_mask;
  BrickRange decided;

  // brick: of the set; one of the run.
  __device__ __forceinline__ uint32_t slot_of(uint32_t brick, int leaf) const {
    return (brick - first_brick) * kLeavesPerBrick + static_cast<uint32_t>(leaf);
  }
  __device__ __forceinline__ CandidateRow row_of(uint32_t slot) const { return rows[slot >> row_shift]; }
  __device__ __forceinline__ uint32_t *deciders_of(uint32_t slot) const {
    return deciders + size_t(slot & decider_mask) * 64;
  }
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
  BrickRange part{0, 0};  // gathered last, whose leaves are listed; with all bricks of the view before it
  gpu::CandidateView view{};
  gpu::CandidateRow *brick_rows = nullptr, *leaf_rows = nullptr;
  Span<uint32_t> decider_room{};  // of view.deciders: so many bricks are decided at a time; none: it is allocated
  Span<uint32_t> vertex_room{};   // for vertices (vertex_words); none: it is allocated
  size_t leaves = 0;              // that are listed
  uint32_t longest_row = 0;       // of atoms or arcs, at most

  // Room for the rows of bricks that are gathered at once, or part by part, each part behind the one before.
  template <class E>
  void open(E &executor, const SurfaceParameters &parameters, BrickRange bricks) {
    view.first_brick = bricks.first;
    view.bricks = bricks.size();
    brick_rows = executor.template allocate<gpu::CandidateRow>(bricks.size()).data;
    view.brick_leaves = executor.template allocate<uint8_t>(bricks.size()).data;
    if (gpu::have_leaf_rows(parameters))
      leaf_rows = executor.template allocate<gpu::CandidateRow>(size_t(bricks.size()) * kLeavesPerBrick).data;
  }
  // Room for what decides about points, of so many bricks at a time at least.
  template <class E>
  void keep_deciders(E &executor, uint32_t bricks) {
    uint32_t room = 1;
    while (room < bricks) room *= 2;
    view.decider_mask = room < view.bricks ? room * kLeavesPerBrick - 1 : ~uint32_t(0);
    decider_room = executor.template allocate<uint32_t>(size_t(std::min(room, view.bricks)) * kBrickPoints);
    view.deciders = decider_room.data;
  }
  // Words that placing vertices takes, of leaves that own some.
  static size_t vertex_words(const SurfaceParameters &parameters, size_t vertices, size_t leaves) {
    return 4 * vertices + leaves * gpu::leaf_list_words(parameters);
  }
  // Those of the last part are about to be found.
  template <class E>
  void decide(E &executor) {
    if (decider_room.size == 0) keep_deciders(executor, view.bricks);
    const uint32_t last = part.last - view.first_brick, room = static_cast<uint32_t>(decider_room.size / kBrickPoints);
    view.decided = {view.first_brick + (last > room ? last - room : 0), part.last};
  }
  bool are_of(BrickRange r) const { return part.size() > 0 && part.first == r.first && part.last == r.last; }
  bool include(BrickRange r) const { return part.size() > 0 && view.first_brick <= r.first && r.last <= part.last; }
  bool have_deciders() const { return view.decided.size() > 0; }
  // Steps of a thread that looks at all atoms and arcs of a row, and at an atom's caps.
  uint64_t look_steps(const FeatureView &features) const { return 64 + 2 * uint64_t(longest_row) + features.most_caps; }
};

}  // namespace quickses
