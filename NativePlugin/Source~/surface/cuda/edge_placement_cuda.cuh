// SPDX-License-Identifier: MIT
// GPU: vertices where the sign changes on their lattice edges (edge_placement.h). A warp for each, which chooses what
// decides about its edge: all looks at it depend on one another.
#pragma once

#include "surface/cuda/projection_cuda.cuh"
#include "surface/stages/edge_placement.h"

namespace quickses {
namespace gpu {

// Those of some candidates that decide about points within `reach` of a middle, as those of an edge; all of them where
// there is no room for the choice.
template <int kLanes, class Candidates>
__device__ __forceinline__ LaneCandidates<kLanes, true> choose_near(const FeatureView &f, const Candidates &all,
                                                                    const Vec3<float> &middle, float reach,
                                                                    uint32_t *room, int most) {
  using Chosen = LaneCandidates<kLanes, true>;
  const unsigned team = Chosen::team();
  const int rank = Chosen::rank();
  const auto choose = [&](const Sphere *balls, const auto &item_at, int count, float reach, uint32_t *out, int left) {
    constexpr int kAhead = 4;  // loads that are under way together
    int n = 0;
    for (int k0 = rank; __any_sync(kFullWarp, k0 - rank < count); k0 += kAhead * kLanes) {
      uint32_t item[kAhead];
      bool near[kAhead];
#pragma unroll
      for (int j = 0; j < kAhead; ++j) {
        near[j] = k0 + j * kLanes < count;
        item[j] = near[j] ? item_at(k0 + j * kLanes) : 0;
      }
#pragma unroll
      for (int j = 0; j < kAhead; ++j) {
        if (!near[j]) continue;
        const Sphere ball = load(balls + item[j]);
        const float r = ball.radius + reach;
        near[j] = length_squared(Vec3<float>(ball.center) - middle) < r * r;
      }
#pragma unroll
      for (int j = 0; j < kAhead; ++j) {
        const int place = append_place(near[j], &n, kFullWarp, team);
        if (near[j] && place < left) out[place] = item[j];
      }
    }
    return n;
  };
  __syncwarp();  // the choice before is not looked at any more
  const int atoms = choose(
      f.atoms.items, [&](int k) { return all.atom(k); }, all.atom_total, reach, room, most);
  const int left = atoms < most ? most - atoms : 0;
  const int arcs = choose(
      f.arc_bounds.items, [&](int k) { return all.arc(k); }, all.arc_total, f.parameters.depth + reach,
      room + (most - left), left);
  __syncwarp();
  if (atoms > most || arcs > left) return {all.atoms, all.arcs, all.atom_total, all.arc_total};
  return {room, room + atoms, atoms, arcs};
}

constexpr uint32_t kNearRoom = 640;

// Near of edge_placement.h, for a warp.
struct NearOfWarp {
  const FeatureView &f;
  const ListedCandidates &all;
  uint32_t *room;  // kNearRoom
  __device__ __forceinline__ LaneCandidates<kWarp, true> operator()(const Vec3<float> &place, float reach) const {
    return choose_near<kWarp>(f, all, place, reach, room, kNearRoom);
  }
};

constexpr int kEdgeWarps = kVertexThreads / kWarp;

// use(k, edge, near, all) for vertices k = vertex_at(place) of a launch, of `total`: a warp each.
template <class VertexAt, class Use>
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
    use(k, ends_of_edge(job.bricks, job.layout, brick, edge), NearOfWarp{job.features, all, near_memory[warp]}, all);
  }
}

// Starts, for spacings much wider than the probe.
static __global__ __launch_bounds__(kVertexThreads, 8) void halve_starts_kernel(QueuedItems queued, VertexJob job) {
  const LaunchItems vertices = queued.in_turn();
  for_edges_of_vertices(
      job, vertices, vertex_count(job), [](uint32_t place) { return place; },
      [&](uint32_t k, const CutEdge &edge, const NearOfWarp &near, const ListedCandidates &) {
        const Vec3<float> x = find_sign_change(job.features, near, edge, kStartHalvings);
        if (lane_id() == 0) store_start(job, job.first + k, x);
      });
}

// Vertices that find no place by projection.
static __global__ __launch_bounds__(kVertexThreads, 8) void place_on_edges_kernel(QueuedItems queued, VertexJob job) {
  const LaunchItems vertices = queued.in_turn();
  for_edges_of_vertices(
      job, vertices, job.counts->on_edges.count, [&](uint32_t place) { return job.on_edges[place]; },
      [&](uint32_t k, const CutEdge &edge, const NearOfWarp &near, const ListedCandidates &all) {
        const SurfacePoint s = place_on_edge(job.features, near, edge);
        const uint32_t owner = nearest_atom(job.features, shared<kWarp>(all), s.position);
        if (lane_id() == 0) finish_vertex(job, k, s, owner);
      });
}

}  // namespace gpu
}  // namespace quickses
