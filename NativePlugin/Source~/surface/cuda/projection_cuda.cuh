// SPDX-License-Identifier: MIT
// GPU: vertices from their starts to the exact surface. Three kernels step the rule of projection.h, so that lanes do
// not wait for each other: vertices on contact patches are done with the first, nearly all others with the second, both
// with a thread for each, or some where they are few or lists are long; the third has those that turn from one probe to
// another, eight lanes for each or, where lists are long, a warp. Those that find no place are left to
// edge_placement_cuda.cuh.
#pragma once

#include "surface/cuda/lane_candidates_cuda.cuh"
#include "surface/cuda/vertex_candidates_cuda.cuh"

namespace quickses {
namespace gpu {

constexpr int kVertexThreads = 128;
// Nearly all starts are nearer to the surface than this, in units of the spacing.
constexpr float kUsualStart = 0.5f;

__device__ __forceinline__ void finish_vertex(const VertexJob &job, uint32_t k, const SurfacePoint &s, uint32_t owner) {
  if (!s.placed) atomic_add(job.starts.unplaced, 1u);
  write_vertex(job.features, job.bricks.lattice, job.mesh, job.first + k, owner, s);
}

// A vertex that is left to the kernels behind: the mesh holds where it is on its way, on the sphere of one probe, and
// for its normal that one times the rounds it has had, one or two; none if it is where it starts. Owners are atoms'
// numbers even where more are left than was anticipated.
__device__ __forceinline__ void leave(const VertexJob &job, uint32_t k, const Vec3<float> &rounds_of_normal) {
  store_vec3(job.mesh.normal(job.first + k), rounds_of_normal);
  job.mesh.owner(job.first + k) = 0;
}
__device__ __forceinline__ void leave_start(const VertexJob &job, uint32_t k) { leave(job, k, {0.f, 0.f, 0.f}); }
__device__ __forceinline__ void leave_vertex(const VertexJob &job, uint32_t k, const Projection &v) {
  store_start(job, job.first + k, v.point.position);
  leave(job, k, v.point.normal * static_cast<float>(v.rounds));
}
__device__ __forceinline__ Projection left_vertex(const VertexJob &job, uint32_t k) {
  const uint32_t vertex = job.first + k;
  Vec3<float> normal = load_vec3(job.mesh.normal(vertex));
  const float length2 = length_squared(normal);
  const int rounds = length2 < 0.25f ? 0 : length2 < 2.25f ? 1 : 2;
  normal = rounds == 0 ? Vec3<float>(0.f, 0.f, 1.f) : rounds == 2 ? normal * 0.5f : normal;
  return {{stored_start(job, vertex), normal, normal, QSES_PATCH_CONTACT, true}, ProjectionState::kReproject, rounds};
}

template <int kLanes, class Candidates>
__device__ __forceinline__ auto shared(const Candidates &all) {
  if constexpr (kLanes == 1)
    return all;
  else
    return LaneCandidates<kLanes, true>{all.atoms, all.arcs, all.atom_total, all.arc_total};
}
__device__ __forceinline__ const ListedCandidates &apart(const ListedCandidates &all) { return all; }

// The first two kernels have so many lanes for each vertex: few vertices leave a GPU idle with one.
template <int kLanes>
struct VertexTeam {
  uint32_t place;
  bool on, writes;
  // Of a team that takes one of `total` places.
  __device__ __forceinline__ VertexTeam(const LaunchItems &vertices, uint32_t total)
      : place(static_cast<uint32_t>(vertices.first) + (blockIdx.x * kVertexThreads + threadIdx.x) / kLanes),
        on(place < total),
        writes(on && rank_in_team<kLanes>() == 0) {}
  // Whether any team of this warp has a place.
  __device__ __forceinline__ bool has_work(uint32_t total) const {
    return place - static_cast<uint32_t>(lane_id() / kLanes) < total;
  }
};

// Vertex k, if it is on a contact patch, or starts outside. True if it is on another patch, as its first lane says.
template <int kLanes>
__device__ __forceinline__ bool project_on_atoms(const VertexJob &job, const VertexTeam<kLanes> &team, uint32_t k) {
  const FeatureView &f = job.features;
  const auto candidates = shared<kLanes>(vertex_candidates(job, k));
  const Vec3<float> x = stored_start(job, job.first + k);
  const DeepestAtom deepest = deepest_atom(f, candidates, x);
  __syncwarp();
  const Sphere ball = load(f.atoms.items + deepest.atom);
  const bool exposed = is_on_contact(f, candidates, deepest, x);  // asked by all lanes of a warp
  const bool outside = starts_outside(f.parameters, deepest), contact = exposed && !outside;
  const Projection v = project_on_atom(f.parameters, ball, deepest.depth, x);
  const bool done = contact && v.state == ProjectionState::kPlaced, on_edge = outside || (contact && !done);
  __syncwarp();
  append(job.on_edges, &job.counts->on_edges.count, k, team.writes && on_edge);
  if (team.writes && on_edge) leave_start(job, k);
  if (team.writes && done) finish_vertex(job, k, v.point, deepest.atom);
  return team.writes && !done && !on_edge;
}

template <int kLanes>
static __global__ __launch_bounds__(kVertexThreads,
                                    blocks_at_once(kVertexThreads, 14)) void project_on_atoms_kernel(QueuedItems queued,
                                                                                                     VertexJob job) {
  const LaunchItems vertices = queued.in_turn();
  const uint32_t count = vertex_count(job);
  const VertexTeam<kLanes> team(vertices, count);
  const uint32_t k = team.on ? team.place : count - 1;
  const bool open = team.has_work(count) && project_on_atoms<kLanes>(job, team, k);
  append_of_block<kVertexThreads>(job.open, &job.counts->open, k, open);
}

// Arcs are looked at in runs of so many, of which a lane's choice is one word.
constexpr int kArcRun = 32;
// use(q, number_at(q)) for each of a choice. kAhead: the next number is asked for before it is needed, which pays where
// a lane has many.
template <bool kAhead, class NumberAt, class Use>
__device__ __forceinline__ void for_each_chosen(uint32_t chosen, const NumberAt &number_at, const Use &use) {
  if constexpr (kAhead) {
    if (chosen == 0) return;
    int next = lowest_bit32(chosen);
    for (uint32_t next_number = number_at(next);;) {
      const int q = next;
      const uint32_t number = next_number;
      chosen &= chosen - 1;
      if (chosen != 0) {
        next = lowest_bit32(chosen);
        next_number = number_at(next);
      }
      use(q, number);
      if (chosen == 0) break;
    }
  } else {
    for (; chosen != 0; chosen &= chosen - 1) {
      const int q = lowest_bit32(chosen);
      use(q, number_at(q));
    }
  }
}

template <int kLanes>
static __global__ __launch_bounds__(kVertexThreads,
                                    blocks_at_once(kVertexThreads, 11)) void project_on_arcs_kernel(QueuedItems queued,
                                                                                                    VertexJob job) {
  const LaunchItems vertices = queued.in_turn();
  const uint32_t total = job.counts->open;
  const VertexTeam<kLanes> team(vertices, total);
  if (!team.has_work(total)) return;
  const uint32_t k = job.open[team.on ? team.place : total - 1];
  const FeatureView &f = job.features;
  const auto candidates = shared<kLanes>(vertex_candidates(job, k));
  const Vec3<float> x = stored_start(job, job.first + k);

  // Of a usual start, no arc that is farther than `near` is the nearest, nor can it cover where the vertex goes. So
  // only arcs are looked at whose bounds are nearer; where the nearest of them tells that the start is not usual, what
  // they say is not used.
  const float margin = kUsualStart * job.reach.spacing, near = f.parameters.depth + margin;
  const float limit_beyond = near + job.reach.slack, near2 = near * near;
  NearestArc nearest;
  constexpr int kRuns = 2;  // whose near arcs are kept
  uint32_t near_arcs[kRuns] = {};
  const int arcs = candidates.arc_count(), rank = LaneCandidates<kLanes>::rank();
  const auto arc_at = [&](int q) { return candidates.arc(q * kLanes + rank); };
  constexpr bool kAhead = kLanes == 1;
  const int own_arcs = (arcs - rank + kLanes - 1) / kLanes;
  for (int q0 = 0; q0 < own_arcs; q0 += kArcRun) {
    const int count = own_arcs - q0 < kArcRun ? own_arcs - q0 : kArcRun;
    uint32_t chosen = 0, near_run = 0;
#pragma unroll 4
    for (int q = 0; q < count; ++q) {
      const Sphere bound = load(f.arc_bounds.items + arc_at(q0 + q));
      const float limit = bound.radius + limit_beyond;
      chosen |= static_cast<uint32_t>(length_squared(x - Vec3<float>(bound.center)) < limit * limit) << q;
    }
    for_each_chosen<kAhead>(
        chosen, [&](int q) { return arc_at(q0 + q); },
        [&](int q, uint32_t arc) {
          const float d2 = arc_distance2(load(f.arcs + arc), x);
          nearest.offer(static_cast<int>(arc), d2);
          if (d2 < near2) near_run |= 1u << q;
        });
    near_arcs[q0 == 0 ? 0 : 1] = near_run;
  }
  nearest = nearest_of_lanes<kLanes>(nearest, kFullWarp);
  __syncwarp();
  const bool usual = absolute(f.parameters.depth - square_root(nearest.distance2)) < margin;
  Projection v = project_on_arc(f, nearest, x);
  __syncwarp();
  const bool again = usual && v.state == ProjectionState::kReproject && arcs <= kRuns * kArcRun * kLanes;
  nearest = NearestArc();
#pragma unroll
  for (int run = 0; run < kRuns; ++run)
    for_each_chosen<kAhead>(
        again ? near_arcs[run] : 0, [&](int q) { return arc_at(run * kArcRun + q); },
        [&](int, uint32_t arc) {
          nearest.offer(static_cast<int>(arc), arc_distance2(load(f.arcs + arc), v.point.position));
        });
  nearest = nearest_of_lanes<kLanes>(nearest, kFullWarp);
  if (again) {
    const Projection next = reproject(f, apart(candidates), nearest, v);
    if (next.state == ProjectionState::kPlaced) v = next;  // else that round is done again
  }
  __syncwarp();
  const bool placed = usual && v.state == ProjectionState::kPlaced,
             on_edge = usual && v.state == ProjectionState::kOnEdge;
  append(job.unfinished, &job.counts->unfinished.count, k, team.writes && !placed && !on_edge);
  append(job.on_edges, &job.counts->on_edges.count, k, team.writes && on_edge);
  if (team.writes && on_edge) leave_start(job, k);
  uint32_t owner = 0;
  if (kLanes > 1 || placed) owner = nearest_atom(f, candidates, v.point.position);
  if (!team.writes || on_edge) return;
  if (placed)
    finish_vertex(job, k, v.point, owner);
  else if (usual)
    leave_vertex(job, k, v);
  else
    leave_start(job, k);
}

template <int kLanes>
static __global__ __launch_bounds__(kVertexThreads, 8) void reproject_kernel(QueuedItems queued, VertexJob job) {
  const LaunchItems vertices = queued.in_turn();
  const FeatureView &f = job.features;
  const uint32_t teams = gridDim.x * (kVertexThreads / kLanes), unfinished = job.counts->unfinished.count;
  const uint32_t total = unfinished < vertices.last ? unfinished : static_cast<uint32_t>(vertices.last);
  const uint32_t team = static_cast<uint32_t>(lane_id()) / kLanes;
  for (uint32_t place0 =
           static_cast<uint32_t>(vertices.first) + (blockIdx.x * kVertexThreads + threadIdx.x) / kLanes - team;
       place0 < total; place0 += teams) {
    const bool on = place0 + team < total;
    const uint32_t k = job.unfinished[on ? place0 + team : place0];
    const auto candidates = shared<kLanes>(vertex_candidates(job, k));
    Projection v{};
    if (on) v = left_vertex(job, k);
    // In step, so that the lanes of all teams look for arcs together.
    while (__any_sync(kFullWarp, v.state == ProjectionState::kReproject)) {
      const NearestArc nearest = nearest_arc(f, candidates, v.point.position);
      if (v.state == ProjectionState::kReproject)
        v = v.rounds == 0 ? project_on_arc(f, nearest, v.point.position) : reproject(f, apart(candidates), nearest, v);
      __syncwarp();
    }
    const bool placed = v.state == ProjectionState::kPlaced, writes = on && candidates.rank() == 0;
    append(job.on_edges, &job.counts->on_edges.count, k, writes && !placed);
    if (writes && !placed) leave_start(job, k);
    const uint32_t owner = nearest_atom(f, candidates, v.point.position);
    if (writes && placed) finish_vertex(job, k, v.point, owner);
  }
}

}  // namespace gpu
}  // namespace quickses
