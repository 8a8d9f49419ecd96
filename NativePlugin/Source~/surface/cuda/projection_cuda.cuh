// SPDX-License-Identifier: MIT
// GPU: vertices from their starts to the exact surface, a thread per vertex. Three kernels step the rule of
// projection.h, so that lanes do not wait for each other: vertices on contact patches are done with the first, nearly
// all others with the second; the third has those that turn from one probe to another, or find no place.
#pragma once

#include "surface/cuda/lane_candidates_cuda.cuh"
#include "surface/cuda/vertex_candidates_cuda.cuh"

namespace quickses {
namespace gpu {

constexpr int kVertexThreads = 128;

__device__ __forceinline__ void finish_vertex(const VertexJob &job, uint32_t k, SurfacePoint s, uint32_t owner) {
  const FeatureView &f = job.features;
  const uint32_t vertex = job.first + k;
  if (!s.placed) atomic_add(job.starts.unplaced, 1u);
  settle_normals(f, owner, &s);
  const glm::vec3 position = job.bricks.lattice.to_caller(s.position);
  store_vec3(job.mesh.position(vertex), Vec3<float>(position));
  store_normals(job.mesh, vertex, s.normal, s.second_normal);
  job.mesh.owner(vertex) = f.atoms.order[owner];
  if (job.mesh.patches) job.mesh.patch(vertex) = static_cast<uint8_t>(s.patch);
}

// Between the kernels the mesh holds where a vertex is on its way, on the sphere of one probe, and for its owner the
// rounds it has had; 0 if its edge decides.
__device__ __forceinline__ void leave_vertex(const VertexJob &job, uint32_t k, const Projection &v) {
  const uint32_t vertex = job.first + k;
  store_start(job, vertex, v.point.position);
  store_vec3(job.mesh.normal(vertex), v.point.normal);
  job.mesh.owner(vertex) = v.state == ProjectionState::kOnEdge ? 0u : static_cast<uint32_t>(v.rounds);
}
__device__ __forceinline__ Projection left_vertex(const VertexJob &job, uint32_t k) {
  const uint32_t vertex = job.first + k, rounds = job.mesh.owner(vertex);
  const Vec3<float> normal = load_vec3(job.mesh.normal(vertex));
  return {{stored_start(job, vertex), normal, normal, QSES_PATCH_CONTACT, rounds > 0},
          rounds > 0 ? ProjectionState::kReproject : ProjectionState::kOnEdge,
          static_cast<int>(rounds)};
}

static __global__ __launch_bounds__(kVertexThreads) void project_on_atoms_kernel(LaunchItems vertices, VertexJob job) {
  const uint32_t k0 = static_cast<uint32_t>(vertices.first) + blockIdx.x * kVertexThreads + threadIdx.x;
  const uint32_t count = vertex_count(job);
  if (k0 - static_cast<uint32_t>(lane_id()) >= count) return;
  const bool on = k0 < count;
  const uint32_t k = on ? k0 : count - 1;
  const FeatureView &f = job.features;
  const ListedCandidates candidates = vertex_candidates(job, k);
  const Vec3<float> x = stored_start(job, job.first + k);
  const DeepestAtom deepest = deepest_atom(f, candidates, x);
  __syncwarp();
  const Sphere ball = load(f.atoms.items + deepest.atom);
  const bool contact = is_on_contact(f, deepest, x);
  const Projection v = project_on_atom(f.parameters, ball, deepest.depth, x);
  const bool done = v.state == ProjectionState::kPlaced;
  __syncwarp();
  append(job.open, &job.counts->open, k, on && !contact);
  append(job.unfinished, &job.counts->unfinished, k, on && contact && !done);
  if (!on || !contact) return;
  if (done)
    finish_vertex(job, k, v.point, deepest.atom);
  else
    leave_vertex(job, k, v);
}

static __global__ __launch_bounds__(kVertexThreads) void project_on_arcs_kernel(LaunchItems vertices, VertexJob job) {
  const uint32_t place = static_cast<uint32_t>(vertices.first) + blockIdx.x * kVertexThreads + threadIdx.x,
                 total = job.counts->open;
  if (place - static_cast<uint32_t>(lane_id()) >= total) return;
  const bool on = place < total;
  const uint32_t k = job.open[on ? place : total - 1];
  const FeatureView &f = job.features;
  const ListedCandidates candidates = vertex_candidates(job, k);
  const Vec3<float> x = stored_start(job, job.first + k);

  // The nearest arc, and which are hardly farther than depth: of a vertex that has moved by no more than the difference
  // no others can be nearer than depth.
  constexpr int kMaskBits = 64;
  const float margin = 0.3f * job.reach.spacing, near = f.parameters.depth + margin;
  NearestArc nearest;
  uint64_t near_arcs = 0;
  const int arcs = candidates.arc_count();
  for (int q = 0; q < arcs; ++q) {
    const int a = static_cast<int>(candidates.arc(q));
    const float d2 = arc_distance2(load(f.arcs + a), x);
    nearest.offer(a, d2);
    near_arcs |= static_cast<uint64_t>(d2 < near * near) << (q & (kMaskBits - 1));
  }
  __syncwarp();
  Projection v = project_on_arc(f, nearest, x);
  const bool mask_tells = arcs <= kMaskBits && f.parameters.depth - square_root(nearest.distance2) < margin;
  __syncwarp();
  if (v.state == ProjectionState::kReproject && mask_tells) {
    nearest = NearestArc();
    for (uint64_t rest = near_arcs; rest; rest &= rest - 1) {
      const int a = static_cast<int>(candidates.arc(lowest_bit64(rest)));
      nearest.offer(a, arc_distance2(load(f.arcs + a), v.point.position));
    }
    const Projection next = reproject(f, candidates, nearest, v);
    if (next.state == ProjectionState::kPlaced) v = next;  // else that round is done again
  }
  __syncwarp();
  const bool done = v.state == ProjectionState::kPlaced;
  append(job.unfinished, &job.counts->unfinished, k, on && !done);
  if (!on) return;
  if (done)
    finish_vertex(job, k, v.point, nearest_atom(f, candidates, v.point.position));
  else
    leave_vertex(job, k, v);
}

constexpr int kVertexLanes = 8;
using SharedCandidates = LaneCandidates<kVertexLanes>;
template <class Candidates>
__device__ __forceinline__ SharedCandidates shared(const Candidates &all) {
  return {all.atoms, all.arcs, all.atom_total, all.arc_total};
}

// Those of a brick's candidates that decide about points of an edge, which are within `reach` of its middle; all of
// them where there is no room for the choice.
constexpr int kEdgeRoom = 160;
template <class Candidates>
__device__ __forceinline__ SharedCandidates choose_for_edge(const FeatureView &f, const Candidates &all,
                                                            const Vec3<float> &middle, float reach, uint32_t *room) {
  const unsigned lanes = SharedCandidates::lanes();
  const int rank = SharedCandidates::rank();
  const auto choose = [&](const Sphere *balls, const uint32_t *items, int count, float reach, uint32_t *out, int left) {
    constexpr int kAhead = 4;  // loads that are under way together
    int n = 0;
    for (int k0 = rank; k0 - rank < count; k0 += kAhead * kVertexLanes) {
      uint32_t item[kAhead];
      bool near[kAhead];
#pragma unroll
      for (int j = 0; j < kAhead; ++j)
        item[j] = __ldg(items + (k0 + j * kVertexLanes < count ? k0 + j * kVertexLanes : 0));
#pragma unroll
      for (int j = 0; j < kAhead; ++j) {
        const Sphere ball = load(balls + item[j]);
        const float r = ball.radius + reach;
        near[j] = k0 + j * kVertexLanes < count && length_squared(Vec3<float>(ball.center) - middle) < r * r;
      }
#pragma unroll
      for (int j = 0; j < kAhead; ++j) {
        const int place = append_place(near[j], &n, lanes);
        if (near[j] && place < left) out[place] = item[j];
      }
    }
    return n;
  };
  __syncwarp(lanes);  // the choice before is not looked at any more
  const int atoms = choose(f.atoms.items, all.atoms, all.atom_total, reach, room, kEdgeRoom);
  const int left = atoms < kEdgeRoom ? kEdgeRoom - atoms : 0;
  const int arcs =
      choose(f.arc_bounds.items, all.arcs, all.arc_total, f.parameters.depth + reach, room + (kEdgeRoom - left), left);
  __syncwarp(lanes);
  if (atoms > kEdgeRoom || arcs > left) return shared(all);
  return {room, room + atoms, atoms, arcs};
}

static __global__ __launch_bounds__(kVertexThreads, 8) void reproject_kernel(LaunchItems vertices, VertexJob job) {
  __shared__ uint32_t edge_memory[kVertexThreads / kVertexLanes][kEdgeRoom];
  const FeatureView &f = job.features;
  const uint32_t teams = gridDim.x * (kVertexThreads / kVertexLanes), unfinished = job.counts->unfinished;
  const uint32_t total = unfinished < vertices.last ? unfinished : static_cast<uint32_t>(vertices.last);
  for (uint32_t place =
           static_cast<uint32_t>(vertices.first) + (blockIdx.x * kVertexThreads + threadIdx.x) / kVertexLanes;
       place < total; place += teams) {
    const uint32_t k = job.unfinished[place], vertex = job.first + k;
    SharedCandidates candidates = shared(vertex_candidates(job, k));
    Projection v = left_vertex(job, k);
    while (v.state == ProjectionState::kReproject)
      v = reproject(f, candidates, nearest_arc(f, candidates, v.point.position), v);
    SurfacePoint s = v.point;
    if (v.state == ProjectionState::kOnEdge) {
      const uint32_t brick = brick_of_vertex(job.layout, job.bricks.count, vertex);
      const CutEdge edge = ends_of_edge(job.bricks, job.layout, brick, edge_of_vertex(job.layout, brick, vertex));
      candidates = shared(brick_candidates(job.view, brick - job.view.first_brick));
      const SharedCandidates near = choose_for_edge(f, candidates, edge.middle(), edge_reach(f.parameters),
                                                    edge_memory[threadIdx.x / kVertexLanes]);
      s = place_on_edge(f, near, edge);
    }
    const uint32_t owner = nearest_atom(f, candidates, s.position);
    __syncwarp(candidates.lanes());  // all of them have read what is written now
    if (candidates.rank() == 0) finish_vertex(job, k, s, owner);
  }
}

}  // namespace gpu
}  // namespace quickses
