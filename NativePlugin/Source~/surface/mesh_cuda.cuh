// SPDX-License-Identifier: MIT
// GPU driver of the mesh: a thread per vertex, which starts on its edge and is projected onto the exact surface, and a
// thread per triangle.
#pragma once

#include "surface/vertex_rows_cuda.cuh"

namespace quickses {
namespace gpu {

// ---- vertices --------------------------------------------------------------------------------------------------

constexpr int kVertexThreads = 128;

// project_to_surface() in steps that a warp takes together. A vertex on a contact patch knows its owner already.
__global__ __launch_bounds__(kVertexThreads) void project_vertices_kernel(VertexJob job) {
  const uint32_t k0 = blockIdx.x * kVertexThreads + threadIdx.x;
  const bool on = k0 < job.count;
  const uint32_t k = on ? k0 : job.count - 1, vertex = job.first + k;
  const FeatureView &f = job.features;
  const float depth = f.parameters.depth;
  const RowCandidates candidates = vertex_candidates(job, job.vertex_row[k]);
  Vec3<float> x = stored_start(job, vertex);
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

}  // namespace gpu

// Vertices are numbered over all slices: mesh.positions[0] is that of the very first. Waits once if there are several
// slices.
inline void emit_vertices(CudaExecutor &executor, const FeatureView &features, const BrickSet &bricks,
                          const MeshLayout &layout, BrickRange slice, CudaCandidates &candidates,
                          const VertexStarts &starts, const MeshView &mesh) {
  using namespace gpu;
  if (slice.size() == 0) return;
  uint32_t range[2] = {0, static_cast<uint32_t>(layout.vertex_total)};
  if (slice.size() < bricks.count) {
    const uint32_t *const sources[2] = {layout.vertex_base + slice.first, layout.vertex_base + slice.last};
    executor.fetch_each(sources, range, 2);
  }
  const uint32_t count = range[1] - range[0];
  if (count == 0) return;
  if (candidates.slice.first != slice.first || candidates.slice.last != slice.last)
    gather_candidates(executor, features, bricks, slice, candidates, nullptr);
  const auto mark = executor.arena().mark();
  const size_t leaves = static_cast<size_t>(slice.size()) * kLeavesPerBrick;
  VertexJob job{};
  job.features = features;
  job.bricks = bricks;
  job.layout = layout;
  job.reach = CandidateReach::of(features.parameters);
  job.view = candidates.view;
  job.starts = starts;
  job.halved = !starts.moved && starts_by_halving(features.parameters);
  job.mesh = mesh;
  job.first = range[0];
  job.count = count;
  job.vertex_row = executor.allocate<uint32_t>(count).data;
  // Half of the leaves own vertices at most, as a rule; those that get no row use their brick's.
  job.row_room = static_cast<uint32_t>(std::min<size_t>({count, leaves, leaves / 2 + 1024}));
  job.rows = executor.allocate<uint32_t>(size_t(job.row_room) * kRowWords).data;
  Span<uint32_t> row_count = executor.allocate<uint32_t>(1);
  job.row_count = row_count.data;
  executor.fill(row_count, 0);
  const size_t leaf_blocks = (leaves + kLeafWarps - 1) / kLeafWarps;
  if (job.halved) executor.launch("halve_starts", halve_starts_kernel, leaf_blocks, kLeafWarps * kWarp, 0, job);
  executor.launch("prepare_vertices", prepare_vertices_kernel, leaf_blocks, kLeafWarps * kWarp, 0, job);
  executor.launch("project_vertices", project_vertices_kernel, (count + kVertexThreads - size_t(1)) / kVertexThreads,
                  kVertexThreads, 0, job);
  executor.arena().rewind(mark);
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
