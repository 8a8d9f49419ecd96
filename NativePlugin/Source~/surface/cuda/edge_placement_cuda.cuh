// SPDX-License-Identifier: MIT
// GPU: vertices where the sign changes on their lattice edges (edge_placement.h). A warp for each, which chooses what
// decides about its edge: all looks at it depend on one another.
#pragma once

#include "surface/cuda/held_candidates_cuda.cuh"
#include "surface/cuda/projection_cuda.cuh"
#include "surface/stages/edge_placement.h"

namespace quickses {
namespace gpu {

constexpr uint32_t kNearRoom = 640;

// Near of edge_placement.h, for a warp. kHeld: where few warps are at work (held_candidates_cuda.cuh).
template <bool kHeld>
struct NearOfWarp {
  const FeatureView &f;
  const ListedCandidates &all;
  uint32_t *room;  // kNearRoom
  __device__ __forceinline__ auto operator()(const Vec3<float> &place, float reach) const {
    const LaneCandidates<kWarp, true> near = choose_near<kWarp>(f, all, place, reach, room, kNearRoom);
    if constexpr (kHeld)
      return HeldCandidates(f, near);
    else
      return near;
  }
};

constexpr int kEdgeWarps = kVertexThreads / kWarp;

// use(k, edge, near, all) for vertices k = vertex_at(place) of a launch, of `total`: a warp each.
template <bool kHeld, class VertexAt, class Use>
__device__ __forceinline__ void for_edges_of_vertices(const VertexJob &job, const LaunchItems &places, uint32_t total,
                                                      const VertexAt &vertex_at, const Use &use) {
  __shared__ uint32_t near_memory[kEdgeWarps][kNearRoom];
  const uint32_t warp = threadIdx.x / kWarp, last = static_cast<uint32_t>(places.last),
                 end = total < last ? total : last;
  for (uint32_t place = static_cast<uint32_t>(places.first) + blockIdx.x * kEdgeWarps + warp; place < end;
       place += gridDim.x * kEdgeWarps) {
    const uint32_t k = vertex_at(place), vertex = job.first + k;
    const uint32_t brick = brick_of_vertex(job.layout, job.slice, vertex);
    const LatticeEdge edge = edge_of_vertex(job.layout, brick, vertex);
    const ListedCandidates all = row_candidates(job.view, job.view.slot_of(brick, edge.leaf));
    use(k, ends_of_edge(job.bricks, job.layout, brick, edge), NearOfWarp<kHeld>{job.features, all, near_memory[warp]},
        all);
  }
}

// Starts, for spacings much wider than the probe.
static __global__ __launch_bounds__(kVertexThreads, 8) void halve_starts_kernel(QueuedItems queued, VertexJob job) {
  const LaunchItems vertices = queued.in_turn();
  for_edges_of_vertices<false>(
      job, vertices, vertex_count(job), [](uint32_t place) { return place; },
      [&](uint32_t k, const CutEdge &edge, const auto &near, const ListedCandidates &) {
        const Vec3<float> x = find_sign_change(job.features, near, edge, kStartHalvings);
        if (lane_id() == 0) store_start(job, job.first + k, x);
      });
}

// Vertices that find no place by projection.
static __global__ __launch_bounds__(kVertexThreads, 4) void place_on_edges_kernel(QueuedItems queued, VertexJob job) {
  const LaunchItems vertices = queued.in_turn();
  for_edges_of_vertices<true>(
      job, vertices, job.counts->on_edges.count, [&](uint32_t place) { return job.on_edges[place]; },
      [&](uint32_t k, const CutEdge &edge, const auto &near, const ListedCandidates &all) {
        const SurfacePoint s = place_on_edge(job.features, near, edge);
        const uint32_t owner = nearest_atom(job.features, shared<kWarp>(all), s.position);
        if (lane_id() == 0) finish_vertex(job, k, s, owner);
      });
}

}  // namespace gpu
}  // namespace quickses
