// SPDX-License-Identifier: MIT
// GPU driver of the mesh: vertices in the kernels of vertex_candidates_cuda.cuh, projection_cuda.cuh and
// edge_placement_cuda.cuh, triangles in that of triangles_cuda.cuh.
#pragma once

#include "surface/cuda/edge_placement_cuda.cuh"
#include "surface/cuda/triangles_cuda.cuh"
#include "surface/stages/edge_placement.h"

namespace quickses {
namespace gpu {

// Steps of a thread that looks once at all that can decide about a vertex: atoms and arcs of a row, and an atom's caps.
inline uint64_t vertex_steps(const FeatureView &features, uint64_t row) { return 64 + 3 * row + features.most_caps; }

// Of warps that each look for the sign change on an edge: up to four times they choose what is near, and look at one
// point after the other.
template <class E>
LaunchShape edge_shape(const E &executor, const FeatureView &features, uint64_t row, int halvings) {
  const uint64_t steps =
      looks_for_sign_change(features.parameters, halvings) * (64 + vertex_steps(features, row) / kWarp) +
      4 * (32 + row / 4);
  return {kVertexThreads, kEdgeWarps, steps, blocks_in_turns(executor)};
}

// Starts and candidates of the vertices of a slice; what they need is allocated here. No vertices: count is 0.
template <class E>
VertexJob prepare_vertices(E &executor, const FeatureView &features, const BrickSet &bricks, const MeshLayout &layout,
                           BrickRange slice, const SliceSizes &sizes, CudaRooms &rooms, CudaCandidates &candidates,
                           const VertexStarts &starts, const MeshView &mesh) {
  VertexJob job{};
  job.slice = slice;
  job.first = sizes.first_vertex;
  job.count = sizes.vertices;
  if (job.count == 0) return job;
  if (!candidates.are_of(slice)) gather_candidates(executor, features, bricks, slice, rooms, candidates, nullptr);
  job.features = features;
  job.bricks = bricks;
  job.layout = layout;
  job.reach = CandidateReach::of(features.parameters);
  job.view = candidates.view;
  job.starts = starts;
  job.halved = !starts.moved && starts_by_halving(features.parameters);
  job.mesh = mesh;
  job.list_words = leaf_list_words(features.parameters);
  const size_t count = job.count, leaves = sizes.leaves;
  const size_t words = CudaCandidates::vertex_words(features.parameters, count, leaves);
  uint32_t *const room =
      candidates.vertex_room.size > 0 ? candidates.vertex_room.data : executor.template allocate<uint32_t>(words).data;
  job.list_of = room;
  job.open = room + count;
  job.unfinished = room + 2 * count;
  job.on_edges = room + 3 * count;
  job.first_leaf = sizes.first_leaf;
  job.lists = room + 4 * count;
  job.counts = executor.template take_counts<VertexCounts>();
  const uint64_t row = candidates.longest_row;
  if (job.halved)
    executor.launch("halve_starts", halve_starts_kernel, count, edge_shape(executor, features, row, kStartHalvings),
                    job);
  constexpr size_t kManyLeaves = 64;  // of a multiprocessor
  const bool by_halves = leaves > executor.multiprocessors() * kManyLeaves && job.list_words < kLongList;
  const size_t lanes = by_halves ? kWarp / 2 : kWarp;
  executor.launch("prepare_vertices", by_halves ? prepare_vertices_kernel<kWarp / 2> : prepare_vertices_kernel<kWarp>,
                  leaves, LaunchShape{kLeafWarps * kWarp, kLeafWarps * kWarp / lanes, 128 + row * 8 / lanes}, job);
  return job;
}

// Vertices are numbered over all slices: mesh.positions[0] is that of the very first. Waits once or twice if there are
// more than a few launches can place.
template <class E>
void emit_vertices(E &executor, const FeatureView &features, const BrickSet &bricks, const MeshLayout &layout,
                   BrickRange slice, const SliceSizes &sizes, CudaRooms &rooms, CudaCandidates &candidates,
                   const VertexStarts &starts, const MeshView &mesh) {
  if (slice.size() == 0) return;
  const auto mark = executor.arena().mark();
  const bool gives_back = candidates.are_of(slice) && candidates.vertex_room.size == 0;
  const VertexJob job =
      prepare_vertices(executor, features, bricks, layout, slice, sizes, rooms, candidates, starts, mesh);
  const uint64_t look = vertex_steps(features, candidates.longest_row);
  // Lanes for each of few vertices, or of such that have much to look at; so many for a multiprocessor at most. Arcs,
  // of which there are more to look at, are worth more lanes.
  constexpr size_t kFew = 4, kMostThreads = 3072, kMostOfLongLists = 8192, kMore = 8, kMostForArcs = 2048;
  const bool have_much = job.list_words >= kLongList, have_very_much = job.list_words >= 4 * kLongList;
  const auto is_room_for = [&](size_t lanes, size_t most) {
    return job.count * lanes <= executor.multiprocessors() * most;
  };
  const bool are_few = is_room_for(kFew, kMostThreads),
             are_very_few = is_room_for(kWarp, have_very_much ? kMostOfLongLists : kMostThreads);
  const auto launch_first = [&](const char *name, size_t lanes, auto kernel) {
    executor.launch(name, kernel, job.count, LaunchShape{kVertexThreads, kVertexThreads / lanes, 64 + 2 * look / lanes},
                    job);
  };
  if (are_very_few)
    launch_first("project_on_atoms", kWarp, project_on_atoms_kernel<kWarp>);
  else if (are_few)
    launch_first("project_on_atoms", kFew, project_on_atoms_kernel<kFew>);
  else
    launch_first("project_on_atoms", 1, project_on_atoms_kernel<1>);
  if (are_very_few)
    launch_first("project_on_arcs", kWarp, project_on_arcs_kernel<kWarp>);
  else if (have_very_much || is_room_for(kMore, kMostForArcs))
    launch_first("project_on_arcs", kMore, project_on_arcs_kernel<kMore>);
  else if (have_much || are_few)
    launch_first("project_on_arcs", kFew, project_on_arcs_kernel<kFew>);
  else
    launch_first("project_on_arcs", 1, project_on_arcs_kernel<1>);
  // As a rule few vertices are left: how many is asked if few launches can't place as many as there are.
  const auto launch_rest = [&](const char *name, const char *counted, auto kernel, const LaunchShape &shape,
                               Tally<uint32_t> VertexCounts::*left) {
    size_t vertices = job.count;
    if (!E::kCounts && !executor.is_few_launches(vertices, shape))
      vertices = executor.expect(counted, &(job.counts->*left), Tally<uint32_t>{job.count}).count;
    executor.launch(name, kernel, vertices, shape, job);
  };
  const bool by_warps = have_much || are_few;
  const size_t lanes = by_warps ? kWarp : 8;
  launch_rest("reproject", "unfinished vertices", by_warps ? reproject_kernel<kWarp> : reproject_kernel<8>,
              LaunchShape{kVertexThreads, kVertexThreads / lanes, (2 + kMaxProjections) * (64 + look / lanes),
                          blocks_in_turns(executor)},
              &VertexCounts::unfinished);
  launch_rest("place_on_edges", "vertices on edges", place_on_edges_kernel,
              edge_shape(executor, features, candidates.longest_row, kPlaceHalvings), &VertexCounts::on_edges);
  if (gives_back) executor.arena().rewind(mark);
}

template <class E>
void emit_triangles(E &executor, const BrickSet &bricks, const MeshLayout &layout, BrickRange slice,
                    const TableView &table, const MeshView &mesh) {
  constexpr uint64_t kSteps = 2048;  // of a brick that is full of triangles
  executor.launch("emit_triangles", emit_triangles_kernel, slice.size(),
                  LaunchShape{kTriangleWarps * kWarp, kTriangleWarps, kSteps, blocks_in_turns(executor)},
                  TriangleJob{bricks, layout, table, mesh, slice});
}

}  // namespace gpu
}  // namespace quickses
