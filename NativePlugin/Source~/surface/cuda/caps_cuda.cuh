// SPDX-License-Identifier: MIT
// GPU driver of the caps: a warp per atom gathers its neighbours, drops the caps that lie within another one, and ranks
// the rest.
#pragma once

#include "surface/cuda/arcs_cuda.cuh"

namespace quickses {
namespace gpu {

struct CapJob {
  NeighborGridView atoms;
  float max_radius;
  AtomRun run;
  FeatureRoom room;
  FeatureCounters *counters;
  CapRange *cap_ranges;
  Cap *caps;
  uint32_t *neighbors;     // per cap: the atom behind it; nullptr: of the exposed atoms, only caps are wanted
  uint32_t *circle_count;  // per atom of the run: circles it owns
  uint8_t *exposed;        // per atom
  uint32_t *long_atoms;    // those with more neighbours than a warp's rows hold
};

// What a warp knows of one atom's neighbours.
struct CapRows {
  Cap *cap;
  float *sine;
  uint32_t *neighbor;
};
constexpr uint32_t kContainedCap = 0x80000000u;  // flag of a neighbour whose cap lies within another
constexpr int kRowNeighbors = 128;               // rows in shared memory
constexpr int kCapWarps = 4;                     // per block

// Caps of all neighbours of atom i, in grid order; returns their number, which may exceed the room.
__device__ __forceinline__ int gather_caps(const NeighborGridView &atoms, float max_radius, uint32_t i,
                                           const Sphere &self, const CapRows &rows, int room) {
  const Vec3<float> center(self.center);
  const float reach = self.radius + max_radius;
  const CellLayout &cells = atoms.cells;
  const CellBox box =
      cells_around(cells, center - Vec3<float>(reach, reach, reach), center + Vec3<float>(reach, reach, reach));
  const float edge = 1.f / cells.inverse_edge;
  // Cells are told apart by rounded arithmetic: coordinates are good to this much.
  const float slack = 1e-3f + 1e-6f * edge * static_cast<float>(cells.count.x + cells.count.y + cells.count.z);
  const int rows_y = box.y1 - box.y0 + 1, row_count = rows_y * (box.z1 - box.z0 + 1);
  const auto run_of = [&](int r) {
    const int y = box.y0 + r % rows_y, z = box.z0 + r / rows_y;
    // Only the part of the row that the reach leaves beside the distance to it.
    const float y_low = cells.origin.y + static_cast<float>(y) * edge - self.center.y;
    const float z_low = cells.origin.z + static_cast<float>(z) * edge - self.center.z;
    const float dy = fmaxf(0.f, fmaxf(y_low, -y_low - edge) - slack),
                dz = fmaxf(0.f, fmaxf(z_low, -z_low - edge) - slack);
    const float left2 = reach * reach - dy * dy - dz * dz;
    if (left2 <= 0.f) return ItemRun{0, 0};
    const float left = square_root(left2) + slack;
    return atoms.run(cells.cell_along(self.center.x - left, cells.origin.x, cells.count.x),
                     cells.cell_along(self.center.x + left, cells.origin.x, cells.count.x), y, z);
  };
  int n = 0;
  visit_runs(row_count, run_of, [&](uint32_t k, bool on) {
    bool meets = false;
    Vec3<float> axis(0.f, 0.f, 0.f);
    float cosine = 0.f;
    if (on && k != i) {
      const Sphere other = load(atoms.items + k);
      axis = Vec3<float>(other.center) - center;
      const float distance2 = maximum(length_squared(axis), 1e-20f), sum = self.radius + other.radius;
      if (distance2 < sum * sum) {
        const float inverse = reciprocal_root(distance2);
        axis = axis * inverse;
        cosine = cap_cosine(self.radius, other.radius, distance2, inverse);
        meets = overlap(self.radius, other.radius, distance2);
      }
    }
    const int place = append_place(meets, &n);
    if (meets && place < room) {
      rows.cap[place] = {to_glm(axis), cosine};
      rows.sine[place] = cap_sine(cosine);
      rows.neighbor[place] = k;
    }
  });
  __syncwarp();
  return n;
}

// Drops the caps that lie within another one; returns how many stay. Few caps are tested by several lanes each.
__device__ __forceinline__ int drop_contained_caps(const CapRows &rows, int n) {
  const int lane = lane_id();
  for (int first = 0; first < n; first += kWarp) {
    const int left = n - first;
    const int parts = left > 16 ? 1 : left > 8 ? 2 : 4;
    const int j = first + lane / parts;
    bool stays = j < n;
    if (stays) {
      const Cap cap = rows.cap[j];
      const float sine = rows.sine[j];
      for (int k = lane % parts; k < n; k += parts) {
        const Cap other = rows.cap[k];
        if (cap_contains(other.cosine, rows.sine[k], cap.cosine, sine,
                         dot(Vec3<float>(other.axis), Vec3<float>(cap.axis)))) {
          stays = false;
          break;
        }
      }
    }
    const unsigned ballot = __ballot_sync(kFullWarp, stays), all = (1u << parts) - 1u;
    if (j < n && lane % parts == 0 && (ballot >> lane & all) != all) rows.neighbor[j] |= kContainedCap;
    __syncwarp();
  }
  int kept = 0;
  for (int first = 0; first < n; first += kWarp) {
    const int j = first + lane;
    Cap cap{};
    uint32_t neighbor = kContainedCap;
    if (j < n) {
      cap = rows.cap[j];
      neighbor = rows.neighbor[j];
    }
    const bool stays = !(neighbor & kContainedCap);
    const int place = append_place(stays, &kept);
    __syncwarp();
    if (stays) {
      rows.cap[place] = cap;
      rows.neighbor[place] = neighbor;
    }
    __syncwarp();
  }
  return kept;
}

// All about the caps of atom i. False if it has more neighbours than the rows hold.
__device__ __forceinline__ bool find_caps(const CapJob &job, uint32_t i, const CapRows &rows, int room) {
  const int lane = lane_id();
  const Sphere self = load(job.atoms.items + i);
  const bool with_circles = job.neighbors != nullptr;
  if (is_far_away(self) || (!with_circles && !job.exposed[i])) {
    if (lane == 0) {
      job.cap_ranges[i] = {0, 0};
      if (with_circles) job.circle_count[i - job.run.first] = 0;
    }
    return true;
  }
  int n = gather_caps(job.atoms, job.max_radius, i, self, rows, room);
  if (n > room) {
    if (lane == 0) atomicMax(&job.counters->neighbors, static_cast<uint32_t>(n));
    return false;
  }
  const bool alone = n == 0;
  n = drop_contained_caps(rows, n);
  unsigned long long first = 0;
  if (lane == 0 && n > 0) first = atomicAdd(&job.counters->caps, static_cast<unsigned long long>(n));
  first = __shfl_sync(kFullWarp, first, 0);
  const bool fits = first + static_cast<unsigned>(n) <= job.room.caps;
  int circles = 0;
  for (int q0 = 0; q0 < n; q0 += kWarp) {
    const int q = q0 + lane;
    bool owns = false;
    if (q < n) {
      const Cap cap = rows.cap[q];
      const uint32_t neighbor = rows.neighbor[q];
      int rank = 0;  // largest cap first; of equal ones the earlier atom
      for (int k = 0; k < n; ++k) {
        const float other = rows.cap[k].cosine;
        rank += other < cap.cosine || (other == cap.cosine && rows.neighbor[k] < neighbor) ? 1 : 0;
      }
      if (fits) {
        job.caps[first + rank] = {cap.axis, stored_cap_cosine(cap.cosine, self.radius)};
        if (with_circles) job.neighbors[first + rank] = neighbor;
      }
      owns = neighbor > i;
    }
    circles += __popc(__ballot_sync(kFullWarp, owns));
  }
  if (lane == 0) {
    job.cap_ranges[i] = {static_cast<uint32_t>(first), fits ? n : 0};
    if (with_circles) job.circle_count[i - job.run.first] = fits ? static_cast<uint32_t>(circles) : 0;
    if (alone) job.exposed[i] = 1;
    if (circles > 0) atomicAdd(&job.counters->circles, static_cast<unsigned long long>(circles));
    if (n > 0) atomicMax(&job.counters->longest_row, static_cast<uint32_t>(n));
  }
  __syncwarp();
  return true;
}

static __global__ __launch_bounds__(kCapWarps *kWarp) void find_caps_kernel(CapJob job) {
  __shared__ Cap cap[kCapWarps][kRowNeighbors];
  __shared__ float sine[kCapWarps][kRowNeighbors];
  __shared__ uint32_t neighbor[kCapWarps][kRowNeighbors];
  const int warp = static_cast<int>(threadIdx.x) / kWarp;
  const CapRows rows{cap[warp], sine[warp], neighbor[warp]};
  for (uint32_t place = blockIdx.x * kCapWarps + static_cast<uint32_t>(warp); place < job.run.size();
       place += gridDim.x * kCapWarps) {
    const uint32_t i = job.run.first + place;
    if (!find_caps(job, i, rows, kRowNeighbors) && lane_id() == 0) {
      job.long_atoms[atomicAdd(&job.counters->long_atoms, 1u)] = i;
      job.cap_ranges[i] = {0, 0};
      if (job.neighbors) job.circle_count[place] = 0;
    }
  }
}

// The same for the atoms that have more neighbours, with rows of the needed length in global memory.
static __global__ __launch_bounds__(kCapWarps *kWarp) void find_long_caps_kernel(CapJob job, unsigned char *memory,
                                                                                 uint32_t first, uint32_t last) {
  const uint32_t warp = (blockIdx.x * blockDim.x + threadIdx.x) / kWarp, warps = gridDim.x * kCapWarps;
  const size_t room = job.room.neighbors;
  unsigned char *row = memory + warp * room * (sizeof(Cap) + sizeof(float) + sizeof(uint32_t));
  const CapRows rows{reinterpret_cast<Cap *>(row), reinterpret_cast<float *>(row + room * sizeof(Cap)),
                     reinterpret_cast<uint32_t *>(row + room * (sizeof(Cap) + sizeof(float)))};
  const uint32_t count = job.counters->long_atoms, end = last < count ? last : count;
  for (uint32_t k = first + warp; k < end; k += warps) find_caps(job, job.long_atoms[k], rows, static_cast<int>(room));
}

// The caps of a run of atoms. Rows of atoms with many neighbours get a quarter of what there is; memory_is_short: at
// least those of one block, and no more than is free.
template <class E>
void find_caps(E &executor, const CapJob &job, bool memory_is_short) {
  const size_t blocks =
      std::min<size_t>((job.run.size() + kCapWarps - 1) / kCapWarps, size_t(executor.multiprocessors()) * 128);
  executor.launch("find_caps", find_caps_kernel, blocks, kCapWarps * kWarp, 0, job);
  if (job.room.neighbors == 0) return;
  // Rows for as many warps as there is memory for; the others' atoms take turns.
  constexpr uint64_t kEnough = uint64_t(1) << 30;
  const size_t block_bytes = kCapWarps * job.room.neighbors * (sizeof(Cap) + sizeof(float) + sizeof(uint32_t));
  const uint64_t free = !memory_is_short ? kEnough : E::kCounts ? 0 : std::min(kEnough, executor.arena().available());
  const size_t long_blocks = static_cast<size_t>(std::max<uint64_t>(
      1, std::min<uint64_t>({blocks, size_t(executor.multiprocessors()) * 4, free / 4 / block_bytes})));
  const auto mark = executor.arena().mark();
  Span<unsigned char> memory = executor.template allocate<unsigned char>(long_blocks * block_bytes);
  // Caps are compared with each other, 32 pairs at a time in some 3 ns: where there are very many, the work is cut into
  // launches of about 10 ms that are waited for, since what is queued can't be cancelled.
  const double pairs = static_cast<double>(job.room.neighbors) * static_cast<double>(job.room.neighbors);
  const double atoms_per_warp = std::max(1.0, 1e-2 / (pairs / kWarp * 3e-9));
  const uint64_t step = static_cast<uint64_t>(static_cast<double>(long_blocks * kCapWarps) * atoms_per_warp);
  for (uint64_t first = 0;; first += step) {
    const bool is_last = first + step >= job.room.long_atoms;
    executor.launch("find_long_caps", find_long_caps_kernel, long_blocks, kCapWarps * kWarp, 0, job, memory.data,
                    static_cast<uint32_t>(first), is_last ? 0xffffffffu : static_cast<uint32_t>(first + step));
    if (is_last) break;
    executor.wait();
  }
  executor.arena().rewind(mark);
}

}  // namespace gpu
}  // namespace quickses
