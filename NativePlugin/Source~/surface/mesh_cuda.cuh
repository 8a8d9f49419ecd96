// SPDX-License-Identifier: MIT
// GPU driver of the mesh: a thread per vertex, which starts on its edge and is projected onto the exact surface, and a
// thread per triangle.
#pragma once

#include "surface/exact_ses_cuda.cuh"

namespace quickses {
namespace cuda {

// ---- vertices --------------------------------------------------------------------------------------------------

constexpr int kVertexThreads = 128;

struct VertexJob {
  FeatureView features;
  BrickSet bricks;
  MeshLayout layout;
  CandidateReach reach;
  CandidateView view;
  uint32_t active_leaves;
  VertexStarts starts;
  MeshView mesh;          // holds the starts, in the centred frame, until they are projected
  uint32_t first, count;  // vertices of the slice
  uint32_t *leaves;       // per vertex: 8 * brick of the slice + leaf
  uint8_t *edges;         // per vertex: 64 * axis + bit of the edge's lower point
  uint32_t *rows;         // kRowWords per active leaf
};

// Row of a leaf's vertices: word 0 has the number of atoms in its lower and of arcs in its upper half, then they follow.
// If they are too many the word is kLongRow, and the brick's row is to be used.
constexpr int kRowWords = 64;
constexpr uint32_t kLongRow = 0xffffffffu;

// The candidates of one vertex.
struct RowCandidates {
  const uint32_t *atoms;
  const uint32_t *arcs;
  int atom_total, arc_total;
  __device__ __forceinline__ int atom_count() const { return atom_total; }
  __device__ __forceinline__ int arc_count() const { return arc_total; }
  __device__ __forceinline__ uint32_t atom(int k) const { return __ldg(atoms + k); }
  __device__ __forceinline__ uint32_t arc(int k) const { return __ldg(arcs + k); }
};

__device__ __forceinline__ RowCandidates brick_candidates(const CandidateView &view, uint32_t slot) {
  const BrickRow row = view.brick_rows[slot / kLeavesPerBrick];
  return {view.atoms + row.first_atom, view.arcs + row.first_arc, static_cast<int>(row.atom_count),
          static_cast<int>(row.arc_count)};
}

__device__ __forceinline__ RowCandidates leaf_candidates(const VertexJob &job, uint32_t slot) {
  const int32_t place = job.view.leaf_place[slot];
  if (place >= 0) {
    const uint32_t *row = job.rows + static_cast<size_t>(place) * kRowWords;
    const uint32_t head = __ldg(row);
    if (head != kLongRow) {
      const int atoms = static_cast<int>(head & 0xffff);
      return {row + 1, row + 1 + atoms, atoms, static_cast<int>(head >> 16)};
    }
  }
  return brick_candidates(job.view, slot);
}

__device__ __forceinline__ Vec3<float> start_of(const VertexJob &job, uint32_t vertex) {
  const float *p = job.mesh.positions + size_t(3) * vertex;
  return {p[0], p[1], p[2]};
}

// Names the edge of each vertex. A thread per mask.
__global__ __launch_bounds__(128) void name_vertices_kernel(VertexJob job) {
  const size_t t = static_cast<size_t>(blockIdx.x) * blockDim.x + threadIdx.x;
  if (t >= static_cast<size_t>(job.view.bricks) * kLeavesPerBrick * kAxes) return;
  const uint32_t slot = static_cast<uint32_t>(t / kAxes), axis = static_cast<uint32_t>(t % kAxes);
  const uint32_t brick = job.view.first_brick + slot / kLeavesPerBrick;
  const size_t k = static_cast<size_t>(job.view.first_brick) * kLeavesPerBrick * kAxes + t;
  uint32_t v = job.layout.vertex_base[brick] + job.layout.vertex_rank[k] - job.first;
  for (uint64_t mask = job.layout.crossing[k]; mask; mask &= mask - 1, ++v) {
    job.leaves[v] = slot;
    job.edges[v] = static_cast<uint8_t>(axis << 6 | static_cast<uint32_t>(lowest_bit64(mask)));
  }
}

// Signs of the 3 x 3 x 2 lattice points around an edge, read once each.
struct EdgeSigns {
  uint32_t bits;
  __device__ __forceinline__ bool operator()(int along, int second, int third) const {
    return bits >> (along + 2 * (second + 1) + 6 * (third + 1)) & 1;
  }
};

__device__ __forceinline__ EdgeSigns signs_around(const BrickSet &bricks, const uint64_t *signs, uint32_t brick,
                                                  const glm::ivec3 &place, const glm::ivec3 &point, int axis) {
  EdgeSigns result{0};
#pragma unroll
  for (int k = 0; k < 18; ++k) {
    const int along = k % 2, second = k / 2 % 3 - 1, third = k / 6 - 1;
    const int x = point.x + (axis == 0 ? along : second),
              y = point.y + (axis == 1 ? along : axis == 0 ? second : third), z = point.z + (axis == 2 ? along : third);
    int b = static_cast<int>(brick);
    if ((x | y | z) & ~7) {
      b = bricks.find(place + glm::ivec3(x >> 3, y >> 3, z >> 3));
      if (b < 0) b = static_cast<int>(brick);  // no cell with a sign change reaches there: any sign will do
    }
    const uint64_t word = signs[static_cast<size_t>(b) * kLeavesPerBrick + leaf_of(x & 7, y & 7, z & 7)];
    result.bits |= static_cast<uint32_t>(word >> leaf_bit(x & 3, y & 3, z & 3) & 1) << k;
  }
  return result;
}

// Where the vertices start. A thread per vertex.
__global__ __launch_bounds__(kVertexThreads) void start_vertices_kernel(VertexJob job) {
  const uint32_t k = blockIdx.x * kVertexThreads + threadIdx.x;
  if (k >= job.count) return;
  const uint32_t vertex = job.first + k;
  Vec3<float> x(0.f, 0.f, 0.f);
  if (job.starts.moved) {
    x = Vec3<float>(job.starts.moved[vertex]);
  } else {
    const uint32_t slot = job.leaves[k], brick = job.view.first_brick + slot / kLeavesPerBrick;
    const int axis = job.edges[k] >> 6, bit = job.edges[k] & 63, leaf = static_cast<int>(slot % kLeavesPerBrick);
    const Lattice &lattice = job.bricks.lattice;
    const glm::ivec3 place = lattice.brick_at(job.bricks.linear[brick]);
    const glm::ivec3 point(4 * (leaf & 1) + (bit & 3), 4 * (leaf >> 1 & 1) + (bit >> 2 & 3),
                           4 * (leaf >> 2) + (bit >> 4));
    const glm::ivec3 p = lattice.first_point(place) + point;
    x = lattice.position(p.x, p.y, p.z);
    const bool low_inside =
        job.layout.signs[static_cast<size_t>(brick) * kLeavesPerBrick + static_cast<size_t>(leaf)] >> bit & 1;
    if (starts_by_halving(job.features.parameters)) {
      const Vec3<float> end = lattice.position(p.x + (axis == 0), p.y + (axis == 1), p.z + (axis == 2));
      const RowCandidates candidates = brick_candidates(job.view, slot);
      x = low_inside ? halve_edge(job.features, candidates, x, end) : halve_edge(job.features, candidates, end, x);
    } else {
      Vec3<float> move(0.f, 0.f, 0.f);
      if (job.starts.relax)
        ring_displacement(edge_ring(signs_around(job.bricks, job.layout.signs, brick, place, point, axis), axis,
                                    job.starts.ring),
                          &move.x, &move.y, &move.z);
      const float along = vertex_start(low_inside);
      move.x += axis == 0 ? along : 0.f;
      move.y += axis == 1 ? along : 0.f;
      move.z += axis == 2 ? along : 0.f;
      x = x + move * lattice.spacing;
    }
  }
  float *out = job.mesh.positions + size_t(3) * vertex;
  out[0] = x.x;
  out[1] = x.y;
  out[2] = x.z;
}

// The row of each leaf that owns vertices: what can decide about its starts, and what can own their projections. A warp
// per active leaf.
__global__ __launch_bounds__(128) void gather_rows_kernel(VertexJob job) {
  const uint32_t place = (blockIdx.x * blockDim.x + threadIdx.x) / kWarp;
  if (place >= job.active_leaves) return;
  const int lane = lane_id();
  const uint32_t slot = job.view.leaf_list[place];
  const size_t brick = job.view.first_brick + slot / kLeavesPerBrick;
  const size_t masks = (brick * kLeavesPerBrick + slot % kLeavesPerBrick) * kAxes;
  const int count = popcount64(job.layout.crossing[masks]) + popcount64(job.layout.crossing[masks + 1]) +
                    popcount64(job.layout.crossing[masks + 2]);
  if (count == 0) return;
  const uint32_t first = job.layout.vertex_base[brick] + job.layout.vertex_rank[masks];
  Vec3<float> low(kFarAway, kFarAway, kFarAway), high(-kFarAway, -kFarAway, -kFarAway);
  for (int k = lane; k < count; k += kWarp) {
    const Vec3<float> x = start_of(job, first + static_cast<uint32_t>(k));
    low = {fminf(low.x, x.x), fminf(low.y, x.y), fminf(low.z, x.z)};
    high = {fmaxf(high.x, x.x), fmaxf(high.y, x.y), fmaxf(high.z, x.z)};
  }
  low = {-warp_maximum(-low.x), -warp_maximum(-low.y), -warp_maximum(-low.z)};
  high = {warp_maximum(high.x), warp_maximum(high.y), warp_maximum(high.z)};
  const Vec3<float> center = (low + high) * 0.5f, half = (high - low) * 0.5f;

  const FeatureView &f = job.features;
  const RowCandidates all = brick_candidates(job.view, slot);
  uint32_t *const row = job.rows + static_cast<size_t>(place) * kRowWords;
  int atoms = 0, arcs = 0;
  if (all.atom_total > 0) {
    const LeafBest best = deepest_at(f, all.atoms, static_cast<uint32_t>(all.atom_total), center);
    const float move = kStartReach * job.reach.spacing;
    BoxCull cull;
    cull.set(center, {half.x + move, half.y + move, half.z + move}, load(f.atoms.items + best.atom), job.reach.slack);
    for (int k0 = 0; k0 < all.atom_total; k0 += kWarp) {
      const int k = k0 + lane;
      bool keep = false;
      uint32_t i = 0;
      if (k < all.atom_total) {
        i = all.atom(k);
        const Sphere ball = load(f.atoms.items + i);
        keep = cull.keeps(ball, ball_depth(ball, center)) || i == best.atom;
      }
      const unsigned ballot = __ballot_sync(kFullWarp, keep);
      const int at = 1 + atoms + place_in(ballot, lane);
      if (keep && at < kRowWords) row[at] = i;
      atoms += __popc(ballot);
    }
  }
  const float radius = square_root(length_squared(half)), limit = job.reach.start_reach;
  for (int k0 = 0; k0 < all.arc_total; k0 += kWarp) {
    const int k = k0 + lane;
    bool keep = false;
    uint32_t a = 0;
    if (k < all.arc_total) {
      a = all.arc(k);
      const Sphere ball = load(f.arc_bounds.items + a);
      const float near = ball.radius + limit;
      const Vec3<float> d(fmaxf(0.f, absolute(ball.center.x - center.x) - half.x),
                          fmaxf(0.f, absolute(ball.center.y - center.y) - half.y),
                          fmaxf(0.f, absolute(ball.center.z - center.z) - half.z));
      if (length_squared(d) <= near * near)
        keep = arc_distance2(load(f.arcs + a), center) <= (limit + radius) * (limit + radius);
    }
    const unsigned ballot = __ballot_sync(kFullWarp, keep);
    const int at = 1 + atoms + arcs + place_in(ballot, lane);
    if (keep && at < kRowWords) row[at] = a;
    arcs += __popc(ballot);
  }
  if (lane == 0)
    row[0] = 1 + atoms + arcs <= kRowWords ? static_cast<uint32_t>(atoms) | static_cast<uint32_t>(arcs) << 16 : kLongRow;
}

// project_to_surface() in steps that a warp takes together. A vertex on a contact patch knows its owner already.
__global__ __launch_bounds__(kVertexThreads) void project_vertices_kernel(VertexJob job) {
  const uint32_t k0 = blockIdx.x * kVertexThreads + threadIdx.x;
  const bool on = k0 < job.count;
  const uint32_t k = on ? k0 : job.count - 1, vertex = job.first + k;
  const FeatureView &f = job.features;
  const float depth = f.parameters.depth;
  const RowCandidates candidates = leaf_candidates(job, job.leaves[k]);
  Vec3<float> x = start_of(job, vertex);
  __syncwarp();

  const DeepestAtom deepest = deepest_atom(f, candidates, x);
  __syncwarp();
  const Sphere ball = load(f.atoms.items + deepest.atom);
  const bool contact = candidates.atom_count() > 0 && is_exposed(f, deepest.atom, x - Vec3<float>(ball.center),
                                                                 offset_length(ball, deepest.depth));
  BoundaryPoint boundary = boundary_on_atom(ball, deepest.depth, x);
  SurfacePoint s = place_on_surface(x, boundary.position, boundary.distance, depth, boundary.patch);
  __syncwarp();
  bool open = !contact && candidates.arc_count() > 0;
  for (int round = 0; round < kMaxProjections; ++round) {
    if (!__any_sync(kFullWarp, open)) break;
    NearestArc nearest{-1, 0.f, 0.f};
    if (open) nearest = nearest_arc(f, candidates, x);
    __syncwarp();
    if (open) {
      boundary = boundary_on_arc(load(f.arcs + nearest.arc), nearest.second2, x);
      s = place_on_surface(x, boundary.position, boundary.distance, depth, boundary.patch);
      x = s.position;
      open = needs_another_look(boundary.distance, boundary.second, depth);
    }
    __syncwarp();
  }
  uint32_t owner = deepest.atom;
  if (s.patch != QSES_PATCH_CONTACT) owner = nearest_atom(f, candidates, s.position);
  __syncwarp();
  if (!on) return;
  if (depth == 0.f) s.normal = sphere_normal(load(f.atoms.items + owner), s.position);
  const glm::vec3 position = job.bricks.lattice.to_caller(s.position);
  float *const out = job.mesh.positions + size_t(3) * vertex, *const normal = job.mesh.normals + size_t(3) * vertex;
  out[0] = position.x;
  out[1] = position.y;
  out[2] = position.z;
  normal[0] = s.normal.x;
  normal[1] = s.normal.y;
  normal[2] = s.normal.z;
  job.mesh.owners[vertex] = f.atoms.order[owner];
  if (job.mesh.patches) job.mesh.patches[vertex] = static_cast<uint8_t>(s.patch);
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
  uint32_t first[27][kAxes];         // vertex of each mask's lowest bit
  uint32_t items[kTriangleItems];    // cell << 16 | case << 8 | triangle of the case
};

__global__ __launch_bounds__(kTriangleWarps *kWarp) void emit_triangles_kernel(TriangleJob job) {
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
      if (k >= 0) {
        const size_t leaf = static_cast<size_t>(k) * kLeavesPerBrick + static_cast<size_t>((x & 1) + 2 * (y & 1) + 4 * (z & 1));
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
        }
        uint32_t *out = job.mesh.indices + size_t(3) * (base + start + r);
        out[0] = id[0];
        out[1] = job.mesh.reversed ? id[2] : id[1];
        out[2] = job.mesh.reversed ? id[1] : id[2];
      }
      __syncwarp();
    }
  }
}

}  // namespace cuda

// Vertices are numbered over all slices: mesh.positions[0] is that of the very first. Waits once.
inline void emit_vertices(CudaExecutor &executor, const FeatureView &features, const BrickSet &bricks,
                          const MeshLayout &layout, BrickRange slice, CudaCandidates &candidates,
                          const VertexStarts &starts, const MeshView &mesh) {
  using namespace cuda;
  if (slice.size() == 0) return;
  const uint32_t *const sources[2] = {layout.vertex_base + slice.first, layout.vertex_base + slice.last};
  uint32_t range[2];
  executor.fetch_each(sources, range, 2);
  const uint32_t count = range[1] - range[0];
  if (count == 0) return;
  if (candidates.slice.first != slice.first || candidates.slice.last != slice.last)
    gather_candidates(executor, features, bricks, slice, candidates, nullptr);
  const auto mark = executor.arena().mark();
  VertexJob job{};
  job.features = features;
  job.bricks = bricks;
  job.layout = layout;
  job.reach = CandidateReach::of(features.parameters);
  job.view = candidates.view;
  job.active_leaves = static_cast<uint32_t>(candidates.leaves);
  job.starts = starts;
  job.mesh = mesh;
  job.first = range[0];
  job.count = count;
  job.leaves = executor.allocate<uint32_t>(count).data;
  job.edges = executor.allocate<uint8_t>(count).data;
  job.rows = executor.allocate<uint32_t>(candidates.leaves * kRowWords).data;
  const size_t masks = static_cast<size_t>(slice.size()) * kLeavesPerBrick * kAxes;
  const size_t blocks = (count + kVertexThreads - size_t(1)) / kVertexThreads;
  executor.launch("name_vertices", name_vertices_kernel, (masks + 127) / 128, 128, 0, job);
  executor.launch("start_vertices", start_vertices_kernel, blocks, kVertexThreads, 0, job);
  executor.launch("gather_rows", gather_rows_kernel, (candidates.leaves + 3) / 4, 128, 0, job);
  executor.launch("project_vertices", project_vertices_kernel, blocks, kVertexThreads, 0, job);
  executor.arena().rewind(mark);
}

inline void emit_triangles(CudaExecutor &executor, const BrickSet &bricks, const MeshLayout &layout, BrickRange slice,
                           const TableView &table, const MeshView &mesh) {
  using namespace cuda;
  executor.launch("emit_triangles", emit_triangles_kernel,
                  std::min<size_t>((slice.size() + kTriangleWarps - size_t(1)) / kTriangleWarps,
                                   size_t(executor.multiprocessors()) * 16),
                  kTriangleWarps * kWarp, 0, TriangleJob{bricks, layout, table, mesh, slice});
}

}  // namespace quickses
