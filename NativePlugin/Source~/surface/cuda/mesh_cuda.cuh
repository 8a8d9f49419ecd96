// SPDX-License-Identifier: MIT
// GPU driver of the mesh: vertices in the kernels of vertex_candidates_cuda.cuh, projection_cuda.cuh and
// edge_placement_cuda.cuh, triangles in that of triangles_cuda.cuh.
#pragma once

#include "surface/cuda/edge_placement_cuda.cuh"
#include "surface/cuda/gather_candidates_cuda.cuh"
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

// What the vertices of a slice need is allocated here; they start by halving here, where they do. No vertices: count is
// 0.
template <class E>
VertexJob open_vertices(E &executor, const CudaSlice &s, const VertexWork &v) {
  const FeatureView &features = s.features;
  const CudaCandidates &candidates = s.candidates;
  VertexJob job{};
  job.slice = s.slice;
  job.first = v.sizes.first_vertex;
  job.count = v.sizes.vertices;
  if (job.count == 0) return job;
  if (!candidates.include(s.slice)) gather_candidates(executor, s, nullptr);
  job.features = features;
  job.bricks = s.bricks;
  job.layout = v.layout;
  job.reach = CandidateReach::of(features.parameters);
  job.view = candidates.view;
  job.starts = v.starts;
  job.halved = !v.starts.moved && starts_by_halving(features.parameters);
  job.mesh = v.mesh;
  job.list_words = leaf_list_words(features.parameters);
  const size_t count = job.count, words = CudaCandidates::vertex_words(features.parameters, count, v.sizes.leaves);
  uint32_t *const room =
      candidates.vertex_room.size > 0 ? candidates.vertex_room.data : executor.template allocate<uint32_t>(words).data;
  job.list_of = room;
  job.open = room + count;
  job.unfinished = room + 2 * count;
  job.on_edges = room + 3 * count;
  job.first_leaf = v.sizes.first_leaf;
  job.lists = room + 4 * count;
  job.counts = executor.template take_counts<VertexCounts>();
  const uint64_t row = candidates.longest_row;
  if (job.halved)
    executor.launch("halve_starts", halve_starts_kernel, count, edge_shape(executor, features, row, kStartHalvings),
                    job);
  return job;
}

inline LaunchShape leaf_shape(size_t lanes, uint64_t row) {
  return {kLeafWarps * kWarp, kLeafWarps * kWarp / lanes, 128 + row * 8 / lanes};
}
// Starts and candidates of the vertices.
template <class E>
void prepare_vertices(E &executor, const VertexJob &job, size_t leaves, uint64_t row) {
  if (job.count > 0)
    executor.launch("prepare_vertices", prepare_vertices_kernel, leaves, leaf_shape(kHalfWarp, row), job);
}

template <class E>
void emit_triangles(E &executor, const BrickSet &bricks, const MeshLayout &layout, BrickRange slice,
                    const TableView &table, const MeshView &mesh) {
  executor.launch("emit_triangles", emit_triangles_kernel, slice.size(),
                  LaunchShape{kTriangleWarps * kWarp, kTriangleWarps, kTriangleSteps, blocks_in_turns(executor)},
                  TriangleJob{bricks, layout, table, mesh, slice});
}

// Both side by side, where few leaves leave a GPU idle, or have very long lists: the first blocks take bricks, the
// others leaves, a warp for each.
template <class E>
bool pay_side_by_side(const E &executor, const VertexJob &job, size_t leaves) {
  constexpr size_t kFew = 64;  // of a multiprocessor
  return leaves <= executor.multiprocessors() * kFew || job.list_words >= 2 * kLongList;
}
static __global__ __launch_bounds__(kLeafWarps *kWarp,
                                    blocks_at_once(kLeafWarps *kWarp,
                                                   9)) void prepare_beside_triangles_kernel(QueuedItems queued,
                                                                                            TriangleJob triangles,
                                                                                            VertexJob vertices,
                                                                                            uint32_t triangle_blocks) {
  const LaunchItems items = queued.in_turn();
  const uint32_t block = static_cast<uint32_t>(items.first / kLeafWarps) + blockIdx.x;
  if (block < triangle_blocks) {
    const uint32_t first = block * kTriangleWarps, last = first + kTriangleWarps, all = triangles.slice.size();
    emit_triangles_of(triangles, first, last < all ? last : all, kTriangleWarps);
  } else {
    prepare_vertices_of<kWarp>(vertices, size_t(block - triangle_blocks) * kLeafWarps,
                               items.last - size_t(triangle_blocks) * kLeafWarps);
  }
}
static_assert(kTriangleWarps == kLeafWarps, "blocks of one size");
template <class E>
void prepare_beside_triangles(E &executor, const TriangleJob &triangles, const VertexJob &job, size_t leaves,
                              uint64_t row) {
  LaunchShape shape = leaf_shape(kWarp, row);
  shape.steps = std::max(shape.steps, kTriangleSteps);
  const uint32_t blocks = (triangles.slice.size() + kTriangleWarps - 1) / kTriangleWarps;
  executor.launch("prepare_beside_triangles", prepare_beside_triangles_kernel, size_t(blocks) * kLeafWarps + leaves,
                  shape, triangles, job, blocks);
}

// Vertices are numbered over all slices: mesh.positions[0] is that of the very first. prepare(job): their starts and
// candidates. Waits once or twice if there are more than a few launches can place.
template <class E, class Prepare>
void emit_vertices_once_prepared(E &executor, const CudaSlice &s, const VertexWork &v, const Prepare &prepare) {
  const FeatureView &features = s.features;
  const CudaCandidates &candidates = s.candidates;
  const auto mark = executor.arena().mark();
  const bool gives_back = candidates.include(s.slice) && candidates.vertex_room.size == 0;
  const VertexJob job = open_vertices(executor, s, v);
  prepare(job);
  const uint64_t look = vertex_steps(features, candidates.longest_row);
  // Lanes for each of few vertices, or of such that have much to look at; so many for a multiprocessor at most. Arcs,
  // of which there are more to look at, are worth more lanes.
  constexpr size_t kSome = 2, kFew = 4, kMostThreads = 3072, kMostOfLongLists = 8192, kMore = 8, kMostForArcs = 2048;
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
  else if (have_very_much || are_few)
    launch_first("project_on_atoms", kFew, project_on_atoms_kernel<kFew>);
  else
    launch_first("project_on_atoms", 1, project_on_atoms_kernel<1>);
  if (are_very_few)
    launch_first("project_on_arcs", kWarp, project_on_arcs_kernel<kWarp>);
  else if (have_very_much || is_room_for(kMore, kMostForArcs))
    launch_first("project_on_arcs", kMore, project_on_arcs_kernel<kMore>);
  else if (are_few)
    launch_first("project_on_arcs", kFew, project_on_arcs_kernel<kFew>);
  else if (have_much)
    launch_first("project_on_arcs", kSome, project_on_arcs_kernel<kSome>);
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
void emit_vertices(E &executor, const CudaSlice &s, const VertexWork &v) {
  emit_vertices_once_prepared(executor, s, v, [&](const VertexJob &job) {
    prepare_vertices(executor, job, v.sizes.leaves, s.candidates.longest_row);
  });
}
// As of the back end.
template <class E, class TrianglesMade, class EmitApart>
void emit_mesh(E &executor, const CudaSlice &s, const VertexWork &v, const TableView &table,
               const TrianglesMade &triangles_made, const EmitApart &emit_apart) {
  emit_vertices_once_prepared(executor, s, v, [&](const VertexJob &job) {
    const uint64_t row = s.candidates.longest_row;
    if (job.count > 0 && pay_side_by_side(executor, job, v.sizes.leaves)) {
      prepare_beside_triangles(executor, TriangleJob{s.bricks, v.layout, table, v.mesh, s.slice}, job, v.sizes.leaves,
                               row);
      triangles_made();
      return;
    }
    emit_apart();
    prepare_vertices(executor, job, v.sizes.leaves, row);
  });
}

}  // namespace gpu
}  // namespace quickses
