// SPDX-License-Identifier: MIT
// GPU: how a warp, or a block where there are few, puts together one row of candidates.
#pragma once

#include "surface/cuda/candidates_cuda.cuh"

namespace quickses {
namespace gpu {

// A cube: the points of a brick or leaf, from its first one on, and so much around them.
struct PointBox {
  Vec3<float> low;
  float extent;
  __device__ __forceinline__ PointBox(const Vec3<float> &first, float points_extent, float around)
      : low(first.x - around, first.y - around, first.z - around), extent(points_extent + 2.f * around) {}
  __device__ __forceinline__ bool meets(const glm::vec3 &center, float radius) const {
    const float dx = fmaxf(0.f, fmaxf(low.x - center.x, center.x - low.x - extent));
    const float dy = fmaxf(0.f, fmaxf(low.y - center.y, center.y - low.y - extent));
    const float dz = fmaxf(0.f, fmaxf(low.z - center.z, center.z - low.z - extent));
    return dx * dx + dy * dy + dz * dz < radius * radius;
  }
};

constexpr int kGatherWarps = 4, kMostGatherWarps = 16;
// Of each kind, in a warp's shared memory; longer rows are gathered twice.
constexpr uint32_t kGatherRoom = 192, kNarrowRoom = 512;

// The warps that put one row together: one, or all of a block where rows are few. Each goes over a run of what there
// is.
template <int kWarps>
struct GatherTeam {
  static_assert(kWarps == 1 || kWarps == kGatherWarps || kWarps == kMostGatherWarps, "a warp or a block");
  static constexpr int kBlockWarps = kWarps == 1 ? kGatherWarps : kWarps;
  struct Memory {
    uint32_t words[kWarps];
    unsigned long long first;
  };
  Memory &memory;
  __device__ __forceinline__ int rank() const { return kWarps == 1 ? 0 : static_cast<int>(threadIdx.x) / kWarp; }
  __device__ __forceinline__ bool leads() const { return rank() == 0 && lane_id() == 0; }
  __device__ __forceinline__ void sync() const { sync_warps<kWarps>(); }
  // Of what the warps have each, the sum, and all bits. Neither again before sync().
  __device__ __forceinline__ BlockSum sum(uint32_t own) const {
    if constexpr (kWarps == 1) return {0, own};
    return sum_of_block(own, memory.words);
  }
  __device__ __forceinline__ uint32_t all_bits(uint32_t own) const {
    if constexpr (kWarps == 1) return own;
    if (lane_id() == 0) memory.words[rank()] = own;
    __syncthreads();
    uint32_t all = 0;
    for (int w = 0; w < kWarps; ++w) all |= memory.words[w];
    return all;
  }
  // A number that the one who leads has. Not again before sync().
  __device__ __forceinline__ unsigned long long from_leader(unsigned long long value) const {
    if constexpr (kWarps == 1) return __shfl_sync(kFullWarp, value, 0);
    if (leads()) memory.first = value;
    __syncthreads();
    return memory.first;
  }
};

// Calls visit(item, on) for the items of the cells around a box that are this warp's share.
template <int kWarps, class Visit>
__device__ __forceinline__ void visit_cells(const GatherTeam<kWarps> &team, const NeighborGridView &grid,
                                            const PointBox &around, float reach, const Visit &visit) {
  if (grid.count == 0) return;
  const Vec3<float> &low = around.low;
  const float beyond = around.extent + reach;
  const CellBox box = cells_around(grid.cells, {low.x - reach, low.y - reach, low.z - reach},
                                   {low.x + beyond, low.y + beyond, low.z + beyond});
  const int rows = grid.runs(box), begin = rows * team.rank() / kWarps, end = rows * (team.rank() + 1) / kWarps;
  visit_runs<MarkedRunItems>(
      end - begin, [&](int r) { return grid.run(box, begin + r); }, visit);
}

// A list of one kind of things, and a warp's shared memory for the row it gathers.
struct RowMemory {
  uint32_t *near;
  uint32_t near_room;
  uint32_t *items;
  unsigned long long *counter;
  unsigned long long room;
};
struct GatheredRow {
  unsigned long long first;
  uint32_t count;
  bool fits;
};

// Gathers those of the things that visit_all(visit) visits for which test(item) holds, in that order. What is listed of
// each is number_of(item, place in the list), which is asked once all are known, so that no lane is idle. The first
// round counts, and keeps few in shared memory; a second one writes more. One copy of the test for both, so that they
// never disagree.
template <int kWarps, class VisitAll, class Test, class NumberOf>
__device__ __forceinline__ GatheredRow gather_row(const GatherTeam<kWarps> &team, const VisitAll &visit_all,
                                                  const RowMemory &memory, const Test &test,
                                                  const NumberOf &number_of) {
  uint32_t *to = memory.near, room = memory.near_room;
  GatheredRow row{0, 0, false};
  for (int round = 0;; ++round) {
    uint32_t n = 0;
    visit_all([&](uint32_t k, bool on) {
      const bool near = on && test(k);
      const uint32_t place = append_place(near, &n);
      if (near && place < room) to[place] = k;
    });
    if (round == 0) {
      const BlockSum sum = team.sum(n);
      row.count = sum.all;
      if (team.leads()) row.first = atomicAdd(memory.counter, static_cast<unsigned long long>(row.count));
      row.first = team.from_leader(row.first);
      row.fits = row.first + row.count <= memory.room;
      if (!row.fits) break;  // all will be done again
      to = memory.items + row.first + sum.before;
      room = 0xffffffffu;
      if (n > memory.near_room) continue;
    }
    __syncwarp();
    for (uint32_t k = static_cast<uint32_t>(lane_id()); k < n; k += kWarp) {
      const uint32_t item = round == 0 ? memory.near[k] : to[k];
      to[k] = number_of(item, static_cast<size_t>(to - memory.items) + k);
    }
    break;
  }
  team.sync();
  return row;
}

}  // namespace gpu
}  // namespace quickses
