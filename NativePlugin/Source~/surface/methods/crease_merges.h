// SPDX-License-Identifier: MIT
// Merges edges at creases of a mesh whose edges were split there, in rounds.
#pragma once

#include "surface/methods/growing_mesh.h"
#include "surface/stages/crease_edges.h"
#include "surface/stages/edge_merges.h"

namespace quickses {

// Of the triangles at most this part is looked at; a hundredth is poor.
constexpr size_t kPoorPart = 32;

// What stays, and how many edges merged: each took a vertex and two triangles along. Waits once.
template <class Work>
KeptParts merge_at_creases(Work &work, const GrowingMesh &mesh, size_t *merged) {
  if (work.parameters.is_of_balls()) return {};  // their creases end in corners, which a merge would cut off
  auto &executor = work.executor;
  const size_t vertices = mesh.whole.vertices, triangles = mesh.whole.triangles, listed = triangles / kPoorPart + 64;
  const auto room = [&](auto kind, size_t n) { return mesh_room<decltype(kind)>(work, mesh, n); };
  const KeptParts kept{allocate_full_set(executor, vertices), allocate_full_set(executor, triangles)};
  const Span<uint32_t> poor = room(uint32_t{}, triangles), slots = room(uint32_t{}, vertices),
                       of_slots = room(uint32_t{}, 4 * listed);  // counts, then rounds
  const Span<uint64_t> poor_count = room(uint64_t{}, 1), claims = room(uint64_t{}, triangles);
  const EdgeMerges merges{mesh.view,
                          work.lattice,
                          poor.data,
                          poor_count.data,
                          static_cast<uint32_t>(listed),
                          slots.data,
                          of_slots.data,
                          room(uint32_t{}, 2 * listed * kMostAround).data,
                          of_slots.data + 2 * listed,
                          claims.data,
                          room(uint64_t{}, listed).data,
                          room(uint32_t{}, listed).data,
                          room(uint32_t{}, listed).data,
                          kept};
  executor.for_each(triangles, MarkPoorTriangles{merges});
  executor.compact(triangles, IsMarked{mesh.view.near_marks}, poor, poor_count.data);
  executor.fill(slots, 0xff);
  executor.fill(of_slots, 0);
  executor.fill(claims, 0xff);
  executor.for_each(listed, ChooseSlots{merges});
  executor.for_each(triangles, CollectAround{merges});
  // Most of those that there is room for are none: few teams take turns, since each costs time before it does anything.
  constexpr size_t kTeams = 512, kMostTurns = 64;
  const size_t groups = (listed + MergedEdges::kCount - 1) / MergedEdges::kCount;
  const size_t teams = std::min(groups, std::max(kTeams, groups / kMostTurns));
  for (int round = 0; round < kMergeRounds; ++round) {
    executor.template for_each_brick<MergedEdges>(teams, ProposeMerges{merges, round, teams}, 8,
                                                  kMergeSteps * ((groups + teams - 1) / teams));
    executor.for_each(listed, ChooseMerges{merges});
    executor.for_each(listed, MergeEdges{merges, round});
  }
  count_before(executor, kept.triangles, triangles);
  const uint32_t vertices_kept = rank_set(executor, kept.vertices, vertices);
  if (!std::decay_t<decltype(executor)>::kCounts) *merged = vertices - vertices_kept;
  return kept;
}

}  // namespace quickses
