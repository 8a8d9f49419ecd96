// SPDX-License-Identifier: MIT
// GPU: the triangles of a brick's cells. A warp per brick lists them in shared memory, then a lane writes one.
#pragma once

#include "parallel/cuda_executor.cuh"
#include "parallel/cuda_warp.cuh"
#include "surface/stages/hot_stages.h"

#include <cassert>

namespace quickses {
namespace gpu {

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

static __global__ __launch_bounds__(kTriangleWarps *kWarp) void emit_triangles_kernel(QueuedItems queued,
                                                                                      TriangleJob job) {
  const LaunchItems items = queued.in_turn();
  __shared__ TriangleScratch scratch_memory[kTriangleWarps];
  __shared__ __align__(16) uint8_t edges[kCellCases][16];
  __shared__ uint8_t triangle_count[kCellCases];
  for (int k = static_cast<int>(threadIdx.x); k < kCellCases; k += kTriangleWarps * kWarp) {
    *reinterpret_cast<uint4 *>(edges[k]) = *reinterpret_cast<const uint4 *>(job.table.edges[k]);
    triangle_count[k] = job.table.triangle_count[k];
  }
  __syncthreads();
  if (!job.layout.has_room()) return;
  const int warp = static_cast<int>(threadIdx.x) / kWarp, lane = lane_id();
  TriangleScratch &scratch = scratch_memory[warp];
  const MeshLayout &layout = job.layout;
  const uint32_t last = job.slice.first + static_cast<uint32_t>(items.last);
  for (uint32_t b = job.slice.first + static_cast<uint32_t>(items.first) + blockIdx.x * kTriangleWarps +
                    static_cast<uint32_t>(warp);
       b < last; b += gridDim.x * kTriangleWarps) {
    const uint32_t base = layout.base[b].triangles, total = layout.base[b + 1].triangles - base;
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
          scratch.first[lane][axis] = layout.base[k].vertices + layout.vertex_rank[leaf * kAxes + axis];
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
        const int t = static_cast<int>(item & 255);
        const glm::ivec3 p = brick_point(cell >> 6, cell & 63);
        uint32_t id[3];
#pragma unroll
        for (int k = 0; k < 3; ++k) {
          const int e = edges[code][3 * t + k], axis = edge_axis(e);
          const int ex = p.x + edge_origin_x(e), ey = p.y + edge_origin_y(e), ez = p.z + edge_origin_z(e);
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
}  // namespace quickses
