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
constexpr uint64_t kTriangleSteps = 2048;                              // of a brick that is full of triangles
constexpr int kTriangleItems = 256;                                    // triangles of a brick listed at a time
constexpr uint32_t kMostTrianglesOfWarp = kWarp * kMostCaseTriangles;  // of a cell for each lane
static_assert(kMostTrianglesOfWarp <= kTriangleItems, "they are listed together");

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
  uint16_t mixed[kBrickPoints];      // the cells that have triangles
  uint16_t items[kTriangleItems];    // cell << 3 | triangle of its case
  __device__ __forceinline__ int case_of(int cell) const { return reinterpret_cast<const uint8_t *>(cases)[cell]; }
};

// A point and what is added to it, a byte for each coordinate; the highest byte is an axis.
__device__ __forceinline__ uint32_t packed_point(const glm::ivec3 &p) {
  return static_cast<uint32_t>(p.x | p.y << 8 | p.z << 16);
}
// The lower three bytes, two bits of each, times these numbers: no sum exceeds a byte.
template <uint32_t kOfX, uint32_t kOfY, uint32_t kOfZ>
__device__ __forceinline__ uint32_t sum_of_bytes(uint32_t packed) {
  static_assert(3 * (kOfX + kOfY + kOfZ) < 256, "nor a part of it");
  return (packed & 0x030303) * (kOfZ | kOfY << 8 | kOfX << 16) >> 16 & 0xff;
}

// By a block, of the bricks of a slice from `first` on, a warp each: they go on with those `step` behind.
__device__ __forceinline__ void emit_triangles_of(const TriangleJob &job, uint32_t first, uint32_t last,
                                                  uint32_t step) {
  __shared__ TriangleScratch scratch_memory[kTriangleWarps];
  __shared__ __align__(16) uint8_t edges[kCellCases][16];
  __shared__ uint8_t triangle_count[kCellCases];
  __shared__ uint32_t edge_steps[kCellEdges];  // from a cell's lower corner to an edge's lower point, and its axis
  for (int k = static_cast<int>(threadIdx.x); k < kCellCases; k += kTriangleWarps * kWarp) {
    *reinterpret_cast<uint4 *>(edges[k]) = *reinterpret_cast<const uint4 *>(job.table.edges[k]);
    triangle_count[k] = job.table.triangle_count[k];
    if (k < kCellEdges)
      edge_steps[k] = packed_point({edge_origin_x(k), edge_origin_y(k), edge_origin_z(k)}) |
                      static_cast<uint32_t>(edge_axis(k)) << 24;
  }
  __syncthreads();
  if (!job.layout.has_room()) return;
  const int warp = static_cast<int>(threadIdx.x) / kWarp, lane = lane_id();
  TriangleScratch &scratch = scratch_memory[warp];
  const MeshLayout &layout = job.layout;
  const uint32_t end = job.slice.first + last;
  for (uint32_t b = job.slice.first + first + static_cast<uint32_t>(warp); b < end; b += step) {
    const uint32_t base = layout.base[b].triangles;
    if (layout.base[b + 1].triangles == base) continue;
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
    __syncwarp();
    // A lane has one layer of 16 cells of a leaf: in the order of the triangles.
    const int leaf = lane >> 2, first_cell = 16 * lane;
    const int own_place = (leaf & 1) + 3 * (leaf >> 1 & 1) + 9 * (leaf >> 2);
    const LeafWords corners = cell_corners(leaf_words(scratch.signs[own_place], [&](int d, uint64_t *word) {
      const int place = own_place + (d & 1) + 3 * (d >> 1 & 1) + 9 * (d >> 2);
      if (active >> place & 1) *word = scratch.signs[place];
    }));
    const uint32_t mixed = static_cast<uint32_t>(mixed_cells(corners) >> (first_cell & 63)) & 0xffff;
#pragma unroll
    for (int half = 0; half < 2; ++half)
      scratch.cases[2 * lane + half] = cell_cases(corners, (first_cell & 63) + 8 * half);
    const uint32_t own = static_cast<uint32_t>(__popc(mixed)), with_own = warp_inclusive_sum(own, lane),
                   cells = __shfl_sync(kFullWarp, with_own, kWarp - 1);
    uint32_t next = with_own - own;
    for (uint32_t m = mixed; m; m &= m - 1) scratch.mixed[next++] = static_cast<uint16_t>(first_cell + lowest_bit32(m));
    __syncwarp();
    uint32_t *out = job.mesh.triangle(base);  // of the first that is listed
    for (uint32_t cell0 = 0; cell0 < cells;) {
      uint32_t listed = 0;
      for (; cell0 < cells && listed + kMostTrianglesOfWarp <= kTriangleItems; cell0 += kWarp) {
        const bool on = cell0 + static_cast<uint32_t>(lane) < cells;
        const int cell = scratch.mixed[on ? cell0 + static_cast<uint32_t>(lane) : 0];
        const uint32_t count = on ? triangle_count[scratch.case_of(cell)] : 0,
                       with_count = warp_inclusive_sum(count, lane);
#pragma unroll
        for (uint32_t t = 0; t < uint32_t(kMostCaseTriangles); ++t)
          if (t < count)
            scratch.items[listed + with_count - count + t] =
                static_cast<uint16_t>(static_cast<uint32_t>(cell) << 3 | t);
        listed += __shfl_sync(kFullWarp, with_count, kWarp - 1);
      }
      __syncwarp();
      for (uint32_t r = static_cast<uint32_t>(lane); r < listed; r += kWarp) {
        const int item = scratch.items[r], cell = item >> 3, t = item & 7, code = scratch.case_of(cell);
        const uint32_t corner = packed_point(brick_point(cell >> 6, cell & 63));
        uint32_t id[3];
#pragma unroll
        for (int k = 0; k < 3; ++k) {
          const uint32_t lower = corner + edge_steps[edges[code][3 * t + k]], axis = lower >> 24,
                         place = sum_of_bytes<1, 3, 9>(lower >> 2);
          id[k] = vertex_number(scratch.first[place][axis], scratch.crossing[place][axis],
                                static_cast<int>(sum_of_bytes<1, 4, 16>(lower)));
          assert(id[k] < layout.vertex_total);  // no signs change on the border of the set
        }
        uint32_t *const own_out = out + 3 * r;
        own_out[0] = id[0];
        own_out[1] = job.mesh.reversed ? id[2] : id[1];
        own_out[2] = job.mesh.reversed ? id[1] : id[2];
      }
      out += 3 * listed;
      __syncwarp();
    }
  }
}

static __global__ __launch_bounds__(kTriangleWarps *kWarp) void emit_triangles_kernel(QueuedItems queued,
                                                                                      TriangleJob job) {
  const LaunchItems items = queued.in_turn();
  emit_triangles_of(job, static_cast<uint32_t>(items.first) + blockIdx.x * kTriangleWarps,
                    static_cast<uint32_t>(items.last), gridDim.x * kTriangleWarps);
}

}  // namespace gpu
}  // namespace quickses
