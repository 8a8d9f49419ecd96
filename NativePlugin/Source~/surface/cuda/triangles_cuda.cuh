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
  uint64_t signs[27];
  uint64_t crossing[27][kAxes];
  uint32_t first[27][kAxes];         // vertex of each mask's lowest bit
  uint64_t cases[kBrickPoints / 8];  // of the cells, a byte each: by 64 * leaf + bit
  uint16_t items[kTriangleItems];    // cell << 3 | triangle of its case
  __device__ __forceinline__ int case_of(int cell) const { return reinterpret_cast<const uint8_t *>(cases)[cell]; }
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
    bool is_active = false;
    if (lane < 27) {
      const int x = lane % 3, y = lane / 3 % 3, z = lane / 9;
      int k = brick;
      if (x == 2 || y == 2 || z == 2) k = job.bricks.find(job.bricks.place(b) + glm::ivec3(x >> 1, y >> 1, z >> 1));
#if !defined(NDEBUG)
      for (int axis = 0; axis < kAxes; ++axis) scratch.first[lane][axis] = scratch.crossing[lane][axis] = 0xffffffffu;
#endif
      is_active = k >= 0;
      if (is_active) {
        const size_t leaf =
            static_cast<size_t>(k) * kLeavesPerBrick + static_cast<size_t>((x & 1) + 2 * (y & 1) + 4 * (z & 1));
        scratch.signs[lane] = layout.signs[leaf];
        for (int axis = 0; axis < kAxes; ++axis) {
          scratch.crossing[lane][axis] = layout.crossing[leaf * kAxes + axis];
          scratch.first[lane][axis] = layout.base[k].vertices + layout.vertex_rank[leaf * kAxes + axis];
        }
      }
    }
    const unsigned active = __ballot_sync(kFullWarp, is_active);
    // A lane has one layer of 16 cells of a leaf: in the order of the triangles.
    const int leaf = lane >> 2, first_cell = 16 * lane;
    const int own_place = (leaf & 1) + 3 * (leaf >> 1 & 1) + 9 * (leaf >> 2);
    const LeafWords corners = cell_corners(leaf_words(scratch.signs[own_place], [&](int d, uint64_t *word) {
      const int place = own_place + (d & 1) + 3 * (d >> 1 & 1) + 9 * (d >> 2);
      if (active >> place & 1) *word = scratch.signs[place];
    }));
    const uint32_t mixed = static_cast<uint32_t>(mixed_cells(corners) >> (first_cell & 63)) & 0xffff;
    uint32_t own = 0;
#pragma unroll
    for (int half = 0; half < 2; ++half) {
      const uint64_t cases = cell_cases(corners, (first_cell & 63) + 8 * half);
      scratch.cases[2 * lane + half] = cases;
#pragma unroll
      for (int shift = 0; shift < 64; shift += 8) own += triangle_count[cases >> shift & 0xff];  // none if not mixed
    }
    const uint32_t before = warp_inclusive_sum(own, lane) - own;
    for (uint32_t start = 0; start < total; start += kTriangleItems) {
      uint32_t place = before;
      for (uint32_t m = mixed; m; m &= m - 1) {
        const int cell = first_cell + lowest_bit32(m);
        const uint32_t count = triangle_count[scratch.case_of(cell)];
#pragma unroll
        for (uint32_t t = 0; t < uint32_t(kMostCaseTriangles); ++t)
          if (t < count && place + t - start < kTriangleItems)  // unsigned: not before start either
            scratch.items[place + t - start] = static_cast<uint16_t>(static_cast<uint32_t>(cell) << 3 | t);
        place += count;
      }
      __syncwarp();
      const uint32_t listed = total - start < kTriangleItems ? total - start : kTriangleItems;
      for (uint32_t r = static_cast<uint32_t>(lane); r < listed; r += kWarp) {
        const int item = scratch.items[r], cell = item >> 3, t = item & 7, code = scratch.case_of(cell);
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
