// SPDX-License-Identifier: MIT
// GPU driver of the mesh: a thread per vertex, which starts on its edge and is projected onto the exact surface, and a
// thread per triangle.
#pragma once

#include "surface/cuda/vertex_candidates_cuda.cuh"

#include <cassert>

namespace quickses {
namespace gpu {

// ---- vertices --------------------------------------------------------------------------------------------------

constexpr int kVertexThreads = 128;

// Three kernels, so that lanes do not wait for each other: vertices on contact patches are done with the first, nearly
// all others with the second; the third has those that turn from one probe to another, or find no place.

// Adds a vertex to a list. A warp together.
__device__ __forceinline__ void append(uint32_t *list, uint32_t *count, uint32_t k, bool on) {
  const unsigned ballot = __ballot_sync(kFullWarp, on);
  uint32_t base = 0;
  if (lane_id() == 0 && ballot) base = atomicAdd(count, static_cast<uint32_t>(__popc(ballot)));
  base = __shfl_sync(kFullWarp, base, 0);
  if (on) list[base + static_cast<uint32_t>(place_in(ballot, lane_id()))] = k;
}

__device__ __forceinline__ void finish_vertex(const VertexJob &job, uint32_t k, SurfacePoint s, uint32_t owner) {
  const FeatureView &f = job.features;
  const uint32_t vertex = job.first + k;
  if (!s.placed) atomic_add(job.starts.unplaced, 1u);
  s.normal = vertex_normal(f, s, owner);
  const glm::vec3 position = job.bricks.lattice.to_caller(s.position);
  store_vec3(job.mesh.position(vertex), Vec3<float>(position));
  store_vec3(job.mesh.normal(vertex), s.normal);
  job.mesh.owner(vertex) = f.atoms.order[owner];
  if (job.mesh.patches) job.mesh.patch(vertex) = static_cast<uint8_t>(s.patch);
}

// Between the kernels, the place of a vertex in the mesh holds where it is on its way; its owner tells what is known.
enum Way : uint32_t { kNowhere, kProjected, kMovedAside };
__device__ __forceinline__ void leave_vertex(const VertexJob &job, uint32_t k, const SurfacePoint &s, Way way) {
  const uint32_t vertex = job.first + k;
  store_start(job, vertex, s.position);
  store_vec3(job.mesh.normal(vertex), s.normal);
  job.mesh.owner(vertex) = s.placed ? way : kNowhere;
}

static __global__ __launch_bounds__(kVertexThreads) void project_on_atoms_kernel(VertexJob job) {
  const uint32_t k0 = blockIdx.x * kVertexThreads + threadIdx.x;
  const bool on = k0 < job.count;
  const uint32_t k = on ? k0 : job.count - 1;
  const FeatureView &f = job.features;
  const RowCandidates candidates = vertex_candidates(job, job.vertex_row[k]);
  const Vec3<float> x = stored_start(job, job.first + k);
  const DeepestAtom deepest = deepest_atom(f, candidates, x);
  __syncwarp();
  const Sphere ball = load(f.atoms.items + deepest.atom);
  const bool contact = candidates.atom_count() > 0 &&
                       is_exposed(f, deepest.atom, x - Vec3<float>(ball.center), offset_length(ball, deepest.depth));
  const bool open = !contact && candidates.arc_count() > 0;
  const SurfacePoint s = place_on_surface(f.parameters, x, boundary_on_atom(ball, deepest.depth, x, contact));
  __syncwarp();
  append(job.open, job.open_count, k, on && open);
  append(job.again, job.again_count, k, on && !open && !s.placed);
  if (!on || open) return;
  if (s.placed)
    finish_vertex(job, k, s, deepest.atom);
  else
    leave_vertex(job, k, s, kNowhere);
}

static __global__ __launch_bounds__(kVertexThreads) void project_on_arcs_kernel(VertexJob job) {
  const uint32_t place = blockIdx.x * kVertexThreads + threadIdx.x, total = *job.open_count;
  if (place - static_cast<uint32_t>(lane_id()) >= total) return;
  const bool on = place < total;
  const uint32_t k = job.open[on ? place : total - 1];
  const FeatureView &f = job.features;
  const RowCandidates candidates = vertex_candidates(job, job.vertex_row[k]);
  const Vec3<float> x = stored_start(job, job.first + k);

  // The nearest arc, and which are hardly farther than depth: no others can matter in a second look.
  constexpr int kMaskBits = 64;
  const float depth = f.parameters.depth, near = depth + 0.3f * job.reach.spacing;
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
  const SurfaceParameters &p = f.parameters;
  Look look = look_at_arc(p, load(f.arcs + nearest.arc), nearest.second2, x);
  const bool mask_tells = arcs <= kMaskBits && 2.f * depth - look.distance < near;
  __syncwarp();
  Way way = kProjected;
  if (look.point.placed && look.again && mask_tells) {
    way = kMovedAside;
    const Vec3<float> from = look.point.position;
    nearest = NearestArc();
    for (uint64_t rest = near_arcs; rest; rest &= rest - 1) {
      const int a = static_cast<int>(candidates.arc(lowest_bit64(rest)));
      nearest.offer(a, arc_distance2(load(f.arcs + a), from));
    }
    look = look_around(p, load(f.arcs + nearest.arc), nearest.second2, from, look.point.normal);
  }
  __syncwarp();
  const bool done = look.point.placed && !look.again;
  append(job.again, job.again_count, k, on && !done);
  if (!on) return;
  if (done)
    finish_vertex(job, k, look.point, nearest_atom(f, candidates, look.point.position));
  else
    leave_vertex(job, k, look.point, way);
}

// Candidates that a few lanes look at together for one vertex, with the same result in each. The two functions are
// those of projection.h, to the last bit.
constexpr int kVertexLanes = 8;
struct SharedCandidates : RowCandidates {
  __device__ __forceinline__ uint32_t atom(int k) const { return atoms[k]; }  // in any memory
  __device__ __forceinline__ uint32_t arc(int k) const { return arcs[k]; }
  static __device__ __forceinline__ int rank() { return lane_id() % kVertexLanes; }
  static __device__ __forceinline__ unsigned lanes() {
    return ((1u << kVertexLanes) - 1u) << (lane_id() / kVertexLanes * kVertexLanes);
  }
};

__device__ __forceinline__ DeepestAtom deepest_atom(const FeatureView &f, const SharedCandidates &candidates,
                                                    const Vec3<float> &x) {
  DeepestAtom best{0, -2.f * kFarAway};
  int place = 0x7fffffff;  // in the list: of several, the first
  for (int k = candidates.rank(); k < candidates.atom_count(); k += kVertexLanes) {
    const uint32_t i = candidates.atom(k);
    const float d = ball_depth(load(f.atoms.items + i), x);
    if (d > best.depth) {
      best = {i, d};
      place = k;
    }
  }
  const unsigned lanes = candidates.lanes();
#pragma unroll
  for (int d = kVertexLanes / 2; d > 0; d >>= 1) {
    const float depth = __shfl_xor_sync(lanes, best.depth, d);
    const uint32_t atom = __shfl_xor_sync(lanes, best.atom, d);
    const int other = __shfl_xor_sync(lanes, place, d);
    if (depth > best.depth || (depth == best.depth && other < place)) {
      best = {atom, depth};
      place = other;
    }
  }
  return best;
}

__device__ __forceinline__ NearestArc nearest_arc(const FeatureView &f, const SharedCandidates &candidates,
                                                  const Vec3<float> &x) {
  NearestArc best;
  for (int k = candidates.rank(); k < candidates.arc_count(); k += kVertexLanes) {
    const int a = static_cast<int>(candidates.arc(k));
    best.offer(a, arc_distance2(load(f.arcs + a), x));
  }
  const unsigned lanes = candidates.lanes();
#pragma unroll
  for (int d = kVertexLanes / 2; d > 0; d >>= 1) {
    const int arc = __shfl_xor_sync(lanes, best.arc, d);
    const float distance2 = __shfl_xor_sync(lanes, best.distance2, d);
    const float second2 = __shfl_xor_sync(lanes, best.second2, d);
    if (arc >= 0) best.offer(arc, distance2);
    best.second2 = minimum(best.second2, second2);
  }
  return best;
}

// Those of a brick's candidates that decide about an edge; all of them where there is no room for the choice.
constexpr int kEdgeRoom = 160;
__device__ __forceinline__ SharedCandidates choose_for_edge(const FeatureView &f, const RowCandidates &all,
                                                            const CutEdge &edge, uint32_t *room) {
  const unsigned lanes = SharedCandidates::lanes();
  const int rank = SharedCandidates::rank();
  const Vec3<float> middle = edge.middle();
  const auto choose = [&](const Sphere *balls, const uint32_t *items, int count, float reach, uint32_t *out, int left) {
    int n = 0;
    for (int k0 = 0; k0 < count; k0 += kVertexLanes) {
      const int k = k0 + rank;
      bool near = false;
      uint32_t i = 0;
      if (k < count) {
        i = __ldg(items + k);
        const Sphere ball = load(balls + i);
        const float r = ball.radius + reach;
        near = length_squared(Vec3<float>(ball.center) - middle) < r * r;
      }
      const unsigned ballot = __ballot_sync(lanes, near) & lanes;
      const int place = n + place_in(ballot, lane_id());
      if (near && place < left) out[place] = i;
      n += __popc(ballot);
    }
    return n;
  };
  __syncwarp(lanes);  // the choice before is not looked at any more
  const int atoms = choose(f.atoms.items, all.atoms, all.atom_total, edge_reach(f.parameters), room, kEdgeRoom);
  const int left = atoms < kEdgeRoom ? kEdgeRoom - atoms : 0;
  const int arcs = choose(f.arc_bounds.items, all.arcs, all.arc_total, edge_arc_reach(f.parameters),
                          room + (kEdgeRoom - left), left);
  __syncwarp(lanes);
  if (atoms > kEdgeRoom || arcs > left) return {all};
  return {{room, room + atoms, atoms, arcs}};
}

static __global__ __launch_bounds__(kVertexThreads) void project_again_kernel(VertexJob job) {
  __shared__ uint32_t edge_memory[kVertexThreads / kVertexLanes][kEdgeRoom];
  const FeatureView &f = job.features;
  const uint32_t teams = gridDim.x * (kVertexThreads / kVertexLanes), total = *job.again_count;
  for (uint32_t place = (blockIdx.x * kVertexThreads + threadIdx.x) / kVertexLanes; place < total; place += teams) {
    const uint32_t k = job.again[place], vertex = job.first + k;
    const uint32_t way = job.mesh.owner(vertex);
    Look look{{stored_start(job, vertex), load_vec3(job.mesh.normal(vertex)), QSES_PATCH_CONTACT, way != kNowhere},
              0.f,
              true};
    SharedCandidates candidates{vertex_candidates(job, job.vertex_row[k])};
    bool aside = way == kMovedAside;
    for (int round = 1; round < kMaxProjections && look.point.placed && look.again; ++round) {
      const Vec3<float> x = look.point.position;
      const NearestArc nearest = nearest_arc(f, candidates, x);
      look = look_around(f.parameters, load(f.arcs + nearest.arc), nearest.second2, x, look.point.normal);
      aside |= look.again;
    }
    SurfacePoint s = look.point;
    if (!s.placed || look.again || (aside && is_over_contact(f, candidates, s.position))) {
      const uint32_t brick = brick_of_vertex(job.layout, job.bricks.count, vertex);
      const CutEdge edge = ends_of_edge(job.bricks, job.layout, brick, edge_of_vertex(job.layout, brick, vertex));
      candidates = {brick_candidates(job.view, brick - job.view.first_brick)};
      s = place_on_edge(f, choose_for_edge(f, candidates, edge, edge_memory[threadIdx.x / kVertexLanes]), edge);
    }
    const uint32_t owner = nearest_atom(f, candidates, s.position);
    __syncwarp(candidates.lanes());  // all of them have read what is written now
    if (candidates.rank() == 0) finish_vertex(job, k, s, owner);
  }
}

// ---- triangles -------------------------------------------------------------------------------------------------

constexpr int kTriangleWarps = 4;
constexpr int kTriangleItems = 512;  // triangles of a brick listed at a time

struct TriangleJob {
  BrickSet bricks;
  MeshLayout layout;
  TableView table;
  MeshView mesh;
  BrickRange slice;
};

// The 27 leaves whose vertices a brick's cells use.
struct TriangleScratch {
  uint64_t crossing[27][kAxes];
  uint32_t first[27][kAxes];       // vertex of each mask's lowest bit
  uint32_t items[kTriangleItems];  // cell << 16 | case << 8 | triangle of the case
};

static __global__ __launch_bounds__(kTriangleWarps *kWarp) void emit_triangles_kernel(TriangleJob job) {
  __shared__ TriangleScratch scratch_memory[kTriangleWarps];
  __shared__ __align__(16) uint8_t edges[kCellCases][16];
  __shared__ uint8_t triangle_count[kCellCases];
  for (int k = static_cast<int>(threadIdx.x); k < kCellCases; k += kTriangleWarps * kWarp) {
    *reinterpret_cast<uint4 *>(edges[k]) = *reinterpret_cast<const uint4 *>(job.table.edges[k]);
    triangle_count[k] = job.table.triangle_count[k];
  }
  __syncthreads();
  const int warp = static_cast<int>(threadIdx.x) / kWarp, lane = lane_id();
  TriangleScratch &scratch = scratch_memory[warp];
  const MeshLayout &layout = job.layout;
  for (uint32_t b = job.slice.first + blockIdx.x * kTriangleWarps + static_cast<uint32_t>(warp); b < job.slice.last;
       b += gridDim.x * kTriangleWarps) {
    const uint32_t base = layout.triangle_base[b], total = layout.triangle_base[b + 1] - base;
    if (total == 0) continue;
    const int brick = static_cast<int>(b);
    __syncwarp();
    if (lane < 27) {
      const int x = lane % 3, y = lane / 3 % 3, z = lane / 9;
      int k = brick;
      if (x == 2 || y == 2 || z == 2)
        k = job.bricks.find(job.bricks.lattice.brick_at(job.bricks.linear[b]) + glm::ivec3(x >> 1, y >> 1, z >> 1));
#if !defined(NDEBUG)
      for (int axis = 0; axis < kAxes; ++axis) scratch.first[lane][axis] = scratch.crossing[lane][axis] = 0xffffffffu;
#endif
      if (k >= 0) {
        const size_t leaf =
            static_cast<size_t>(k) * kLeavesPerBrick + static_cast<size_t>((x & 1) + 2 * (y & 1) + 4 * (z & 1));
        for (int axis = 0; axis < kAxes; ++axis) {
          scratch.crossing[lane][axis] = layout.crossing[leaf * kAxes + axis];
          scratch.first[lane][axis] = layout.vertex_base[k] + layout.vertex_rank[leaf * kAxes + axis];
        }
      }
    }
    // A lane has one layer of 16 cells of a leaf: in the order of the triangles.
    const int leaf = lane >> 2, layer = lane & 3;
    const LeafWords corners = cell_corners(leaf_words(job.bricks, layout.signs, brick, leaf));
    const uint64_t mixed = mixed_cells(corners) & uint64_t(0xffff) << (16 * layer);
    uint32_t own = 0;
    for (uint64_t m = mixed; m; m &= m - 1) own += triangle_count[cell_case(corners, lowest_bit64(m))];
    const uint32_t before = warp_inclusive_sum(own, lane) - own;
    for (uint32_t start = 0; start < total; start += kTriangleItems) {
      uint32_t place = before;
      for (uint64_t m = mixed; m; m &= m - 1) {
        const int bit = lowest_bit64(m), code = cell_case(corners, bit);
        const uint32_t item = static_cast<uint32_t>(leaf << 6 | bit) << 16 | static_cast<uint32_t>(code) << 8;
        for (uint32_t t = 0; t < triangle_count[code]; ++t, ++place)
          if (place >= start && place - start < kTriangleItems) scratch.items[place - start] = item | t;
      }
      __syncwarp();
      const uint32_t listed = total - start < kTriangleItems ? total - start : kTriangleItems;
      for (uint32_t r = static_cast<uint32_t>(lane); r < listed; r += kWarp) {
        const uint32_t item = scratch.items[r];
        const int code = static_cast<int>(item >> 8 & 255), cell = static_cast<int>(item >> 16);
        const int cell_leaf = cell >> 6, bit = cell & 63, t = static_cast<int>(item & 255);
        const int x = 4 * (cell_leaf & 1) + (bit & 3), y = 4 * (cell_leaf >> 1 & 1) + (bit >> 2 & 3),
                  z = 4 * (cell_leaf >> 2) + (bit >> 4);
        uint32_t id[3];
#pragma unroll
        for (int k = 0; k < 3; ++k) {
          const int e = edges[code][3 * t + k], axis = edge_axis(e);
          const int ex = x + edge_origin_x(e), ey = y + edge_origin_y(e), ez = z + edge_origin_z(e);
          const int place27 = (ex >> 2) + 3 * (ey >> 2) + 9 * (ez >> 2);
          id[k] = vertex_number(scratch.first[place27][axis], scratch.crossing[place27][axis],
                                leaf_bit(ex & 3, ey & 3, ez & 3));
          assert(id[k] < layout.vertex_total);  // no signs change on the border of the set
        }
        uint32_t *out = job.mesh.triangle(size_t(base) + start + r);
        out[0] = id[0];
        out[1] = job.mesh.reversed ? id[2] : id[1];
        out[2] = job.mesh.reversed ? id[1] : id[2];
      }
      __syncwarp();
    }
  }
}

}  // namespace gpu

namespace gpu {

// Starts and rows of the vertices of a slice; what they need is allocated here. No vertices: count is 0.
inline VertexJob prepare_vertices(CudaExecutor &executor, const FeatureView &features, const BrickSet &bricks,
                                  const MeshLayout &layout, BrickRange slice, CudaCandidates &candidates,
                                  const VertexStarts &starts, const MeshView &mesh) {
  VertexJob job{};
  uint32_t range[4] = {0, static_cast<uint32_t>(layout.vertex_total), 0, static_cast<uint32_t>(layout.leaf_total)};
  if (slice.size() < bricks.count) {
    const uint32_t *const sources[4] = {layout.vertex_base + slice.first, layout.vertex_base + slice.last,
                                        layout.leaf_base + slice.first, layout.leaf_base + slice.last};
    executor.fetch_each(sources, range, 4);
  }
  job.first = range[0];
  job.count = range[1] - range[0];
  if (job.count == 0) return job;
  if (candidates.slice.first != slice.first || candidates.slice.last != slice.last)
    gather_candidates(executor, features, bricks, slice, candidates, nullptr);
  const size_t leaves = static_cast<size_t>(slice.size()) * kLeavesPerBrick;
  job.features = features;
  job.bricks = bricks;
  job.layout = layout;
  job.reach = CandidateReach::of(features.parameters);
  job.view = candidates.view;
  job.starts = starts;
  job.halved = !starts.moved && starts_by_halving(features.parameters);
  job.mesh = mesh;
  job.vertex_row = executor.allocate<uint32_t>(job.count).data;
  job.row_words = row_words(features.parameters);
  job.first_row = range[2];
  job.rows = executor.allocate<uint32_t>(size_t(range[3] - range[2]) * job.row_words).data;
  job.open = executor.allocate<uint32_t>(job.count).data;
  job.again = executor.allocate<uint32_t>(job.count).data;
  Span<uint32_t> counts = executor.allocate<uint32_t>(2);
  job.open_count = counts.data;
  job.again_count = counts.data + 1;
  executor.fill(counts, 0);
  const size_t blocks = (leaves + kLeafWarps - 1) / kLeafWarps;
  if (job.halved) executor.launch("halve_starts", halve_starts_kernel, blocks, kLeafWarps * kWarp, 0, job);
  executor.launch("prepare_vertices", prepare_vertices_kernel, blocks, kLeafWarps * kWarp, 0, job);
  return job;
}

}  // namespace gpu

// Vertices are numbered over all slices: mesh.positions[0] is that of the very first. Waits once if there are several
// slices.
inline void emit_vertices(CudaExecutor &executor, const FeatureView &features, const BrickSet &bricks,
                          const MeshLayout &layout, BrickRange slice, CudaCandidates &candidates,
                          const VertexStarts &starts, const MeshView &mesh) {
  using namespace gpu;
  if (slice.size() == 0) return;
  const auto mark = executor.arena().mark();
  const bool gathered = candidates.slice.first == slice.first && candidates.slice.last == slice.last;
  const VertexJob job = prepare_vertices(executor, features, bricks, layout, slice, candidates, starts, mesh);
  const size_t blocks = (job.count + kVertexThreads - size_t(1)) / kVertexThreads;
  executor.launch("project_on_atoms", project_on_atoms_kernel, blocks, kVertexThreads, 0, job);
  executor.launch("project_on_arcs", project_on_arcs_kernel, blocks, kVertexThreads, 0, job);
  executor.launch("project_again", project_again_kernel, blocks, kVertexThreads, 0, job);
  if (gathered) executor.arena().rewind(mark);
}

inline void emit_triangles(CudaExecutor &executor, const BrickSet &bricks, const MeshLayout &layout, BrickRange slice,
                           const TableView &table, const MeshView &mesh) {
  using namespace gpu;
  executor.launch("emit_triangles", emit_triangles_kernel,
                  std::min<size_t>((slice.size() + kTriangleWarps - size_t(1)) / kTriangleWarps,
                                   size_t(executor.multiprocessors()) * 16),
                  kTriangleWarps * kWarp, 0, TriangleJob{bricks, layout, table, mesh, slice});
}

}  // namespace quickses
