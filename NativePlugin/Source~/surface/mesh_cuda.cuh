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
  CandidateView view;
  VertexStarts starts;
  MeshView mesh;
  uint32_t first, count;  // vertices of the slice
  uint32_t *leaves;       // per vertex: 8 * brick of the slice + leaf
  uint8_t *edges;         // per vertex: 64 * axis + bit of the edge's lower point
};

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

__device__ __forceinline__ RowCandidates row_of(const CandidateView &view, uint32_t slot) {
  const int32_t place = view.leaf_row[slot];
  if (place >= 0) {
    const uint32_t *row = view.rows + static_cast<size_t>(place) * kRowWords;
    const uint32_t head = __ldg(row);
    if (head != kLongRow) {
      const int atoms = static_cast<int>(head & 0xffff);
      return {row + 1, row + 1 + atoms, atoms, static_cast<int>(head >> 16)};
    }
  }
  const BrickRow row = view.brick_rows[slot / kLeavesPerBrick];
  return {view.atoms + row.first_atom, view.arcs + row.first_arc, static_cast<int>(row.atom_count),
          static_cast<int>(row.arc_count)};
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
  const int second = axis == 0 ? 1 : 0, third = axis == 2 ? 1 : 2;
  EdgeSigns result{0};
#pragma unroll
  for (int k = 0; k < 18; ++k) {
    const int along = k % 2, s = k / 2 % 3 - 1, t = k / 6 - 1;
    const int x = point.x + (axis == 0 ? along : s), y = point.y + (axis == 1 ? along : second == 1 ? s : t),
              z = point.z + (axis == 2 ? along : t);
    int b = static_cast<int>(brick);
    if ((x | y | z) & ~7) {
      b = bricks.find(place + glm::ivec3(x >> 3, y >> 3, z >> 3));
      if (b < 0) b = static_cast<int>(brick);  // no cell with a sign change reaches there: any sign will do
    }
    const uint64_t word = signs[static_cast<size_t>(b) * kLeavesPerBrick + leaf_of(x & 7, y & 7, z & 7)];
    result.bits |= static_cast<uint32_t>(word >> leaf_bit(x & 3, y & 3, z & 3) & 1) << k;
  }
  (void)third;
  return result;
}

// Where a vertex starts, in the centred frame.
__device__ __forceinline__ Vec3<float> start_of(const VertexJob &job, uint32_t slot, int axis, int bit, uint32_t vertex,
                                                const RowCandidates &candidates) {
  if (job.starts.moved) return Vec3<float>(job.starts.moved[vertex]);
  const Lattice &lattice = job.bricks.lattice;
  const float h = lattice.spacing;
  const uint32_t brick = job.view.first_brick + slot / kLeavesPerBrick;
  const int leaf = static_cast<int>(slot % kLeavesPerBrick);
  const glm::ivec3 place = lattice.brick_at(job.bricks.linear[brick]);
  const glm::ivec3 point(4 * (leaf & 1) + (bit & 3), 4 * (leaf >> 1 & 1) + (bit >> 2 & 3),
                         4 * (leaf >> 2) + (bit >> 4));
  const glm::ivec3 p = lattice.first_point(place) + point;
  Vec3<float> x = lattice.position(p.x, p.y, p.z);
  const bool low_inside =
      job.layout.signs[static_cast<size_t>(brick) * kLeavesPerBrick + static_cast<size_t>(leaf)] >> bit & 1;
  if (starts_by_halving(job.features.parameters)) {
    const Vec3<float> end = lattice.position(p.x + (axis == 0), p.y + (axis == 1), p.z + (axis == 2));
    return low_inside ? halve_edge(job.features, candidates, x, end) : halve_edge(job.features, candidates, end, x);
  }
  Vec3<float> move(0.f, 0.f, 0.f);
  if (job.starts.relax)
    ring_displacement(edge_ring(signs_around(job.bricks, job.layout.signs, brick, place, point, axis), axis,
                                job.starts.ring),
                      &move.x, &move.y, &move.z);
  const float along = vertex_start(low_inside);
  move.x += axis == 0 ? along : 0.f;
  move.y += axis == 1 ? along : 0.f;
  move.z += axis == 2 ? along : 0.f;
  return x + move * h;
}

// project_to_surface() in steps that a warp takes together. A vertex on a contact patch knows its owner already.
__global__ __launch_bounds__(kVertexThreads) void emit_vertices_kernel(VertexJob job) {
  const uint32_t k0 = blockIdx.x * kVertexThreads + threadIdx.x;
  const bool on = k0 < job.count;
  const uint32_t k = on ? k0 : job.count - 1;
  const FeatureView &f = job.features;
  const float depth = f.parameters.depth;
  const uint32_t slot = job.leaves[k], edge = job.edges[k], vertex = job.first + k;
  const RowCandidates candidates = row_of(job.view, slot);
  Vec3<float> x = start_of(job, slot, static_cast<int>(edge >> 6), static_cast<int>(edge & 63), vertex, candidates);
  __syncwarp();

  const DeepestAtom deepest = deepest_atom(f, candidates, x);
  __syncwarp();
  const Sphere ball = load(f.atoms.items + deepest.atom);
  const bool contact = candidates.atom_count() > 0 &&
                       is_exposed(f, deepest.atom, x - Vec3<float>(ball.center), offset_length(ball, deepest.depth));
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
  VertexJob job{features, bricks, layout, candidates.view, starts, mesh, range[0], count, nullptr, nullptr};
  job.leaves = executor.allocate<uint32_t>(count).data;
  job.edges = executor.allocate<uint8_t>(count).data;
  const size_t masks = static_cast<size_t>(slice.size()) * kLeavesPerBrick * kAxes;
  executor.launch("name_vertices", name_vertices_kernel, (masks + 127) / 128, 128, 0, job);
  executor.launch("emit_vertices", emit_vertices_kernel, (count + kVertexThreads - size_t(1)) / kVertexThreads,
                  kVertexThreads, 0, job);
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
