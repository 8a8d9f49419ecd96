// SPDX-License-Identifier: MIT
// GPU: the caps of one atom, by a warp: neighbours are gathered in rows, caps that lie within another one dropped, and
// the rest ranked.
#pragma once

#include "parallel/cuda_executor.cuh"
#include "parallel/cuda_warp.cuh"
#include "surface/cuda/learnt_rooms_cuda.cuh"
#include "surface/stages/solvent_features.h"

namespace quickses {
namespace gpu {

// The atoms a pass is about.
struct AtomRun {
  uint32_t first, last;
  QSES_FN uint32_t size() const { return last - first; }
};

struct CapJob {
  NeighborGridView atoms;
  float max_radius;
  AtomRun run;
  FeatureRoom room;
  FeatureCounters *counters;
  CapRange *cap_ranges;
  Cap *caps;
  // Per cap: the atom behind it. nullptr: only caps are wanted, of the exposed atoms; the others are marked as buried.
  uint32_t *neighbors;
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
constexpr int kCapWarps = 4;                     // per block

// Caps of all neighbours of atom i, in grid order; returns their number, which may exceed the room.
__device__ __forceinline__ int gather_caps(const NeighborGridView &atoms, uint32_t i, const Sphere &self,
                                           const CapRows &rows, int room) {
  const Vec3<float> center(self.center);
  const float reach = self.radius + atoms.cells.radii.in_cells;
  const CellLayout &cells = atoms.cells;
  const CellBox box = cells_within(cells, center, reach);
  const float edge = 1.f / cells.inverse_edge;
  // Cells are told apart by rounded arithmetic: coordinates are good to this much.
  const float slack = 1e-3f + 1e-6f * edge * static_cast<float>(cells.count.x + cells.count.y + cells.count.z);
  const auto run_of = [&](int r) {
    if (r >= box.rows()) return atoms.large_items();
    const auto [y, z] = box.row(r);
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
  visit_runs(atoms.runs(box), run_of, [&](uint32_t k, bool on) {
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

// Does cap j lie within one of the caps k, k + kStep, ...?
template <int kStep>
__device__ __forceinline__ bool lies_within_another(const CapRows &rows, int n, int j, int k) {
  const Cap cap = rows.cap[j];
  const float sine = rows.sine[j];
  bool within = false;  // to the end in any case: some lane's cap lies in none
#pragma unroll 4
  for (; k < n; k += kStep) {
    const Cap other = rows.cap[k];
    within |=
        cap_contains(other.cosine, rows.sine[k], cap.cosine, sine, dot(Vec3<float>(other.axis), Vec3<float>(cap.axis)));
  }
  return within;
}

// Keeps the caps for which stays(cap, sine, neighbor) holds, without gaps; returns how many.
template <class Stays>
__device__ __forceinline__ int keep_caps(const CapRows &rows, int n, const Stays &stays) {
  const int lane = lane_id();
  int kept = 0;
#pragma unroll 1
  for (int first = 0; first < n; first += kWarp) {
    const bool on = first + lane < n;
    const int j = on ? first + lane : first;
    const Cap cap = rows.cap[j];
    const float sine = rows.sine[j];
    const uint32_t neighbor = rows.neighbor[j];
    const bool keep = on & stays(cap, sine, neighbor);
    const int place = append_place(keep, &kept);
    __syncwarp();  // all are read
    if (keep) {
      rows.cap[place] = cap;
      rows.sine[place] = sine;
      rows.neighbor[place] = neighbor;
    }
    __syncwarp();
  }
  return kept;
}
__device__ __forceinline__ int keep_free_caps(const CapRows &rows, int n) {
  return keep_caps(rows, n, [](const Cap &, float, uint32_t neighbor) { return (neighbor & kContainedCap) == 0; });
}

// Drops caps that lie within one of eight large ones, each the largest of some; returns how many stay. Most that lie
// within any lie within one of these.
__device__ __forceinline__ int drop_caps_within_large(const CapRows &rows, int n) {
  constexpr int kLarge = 8, kLanes = kWarp / kLarge;
  __shared__ Cap large_memory[kCapWarps][kLarge];
  __shared__ float sine_memory[kCapWarps][kLarge];
  Cap *const large = large_memory[threadIdx.x / kWarp];
  float *const large_sine = sine_memory[threadIdx.x / kWarp];
  const int lane = lane_id();
  float least = 2.f;
  int largest = 0;
#pragma unroll 1
  for (int j = lane; j < n; j += kWarp) {
    const float cosine = rows.cap[j].cosine;
    if (cosine < least) least = cosine, largest = j;
  }
#pragma unroll
  for (int d = kLanes / 2; d > 0; d >>= 1) {
    const float other = __shfl_xor_sync(kFullWarp, least, d);
    const int other_largest = __shfl_xor_sync(kFullWarp, largest, d);
    if (other < least) least = other, largest = other_largest;
  }
  if (lane % kLanes == 0) {
    large[lane / kLanes] = rows.cap[largest];
    large_sine[lane / kLanes] = rows.sine[largest];
  }
  __syncwarp();
  return keep_caps(rows, n, [&](const Cap &cap, float sine, uint32_t) {
    bool within = false;
#pragma unroll
    for (int g = 0; g < kLarge; ++g)
      within |= cap_contains(large[g].cosine, large_sine[g], cap.cosine, sine,
                             dot(Vec3<float>(large[g].axis), Vec3<float>(cap.axis)));
    return !within;
  });
}

// Marks those of the caps from `first` on that lie within another one, so many lanes for each.
template <int kParts>
__device__ __forceinline__ void mark_contained_caps(const CapRows &rows, int n, int first) {
  const int lane = lane_id(), j = first + lane / kParts;
  const bool stays = j < n && !lies_within_another<kParts>(rows, n, j, lane % kParts);
  const unsigned ballot = __ballot_sync(kFullWarp, stays), all = (1u << kParts) - 1u;
  if (j < n && lane % kParts == 0 && (ballot >> lane & all) != all) rows.neighbor[j] |= kContainedCap;
  __syncwarp();
}

// Drops the caps that lie within another one; returns how many stay.
__device__ __forceinline__ int drop_contained_caps(const CapRows &rows, int n) {
  if (n > kWarp) n = drop_caps_within_large(rows, n);
  for (int first = 0; first < n; first += kWarp) {
    if (n - first > 8)
      mark_contained_caps<1>(rows, n, first);
    else
      mark_contained_caps<4>(rows, n, first);
  }
  return keep_free_caps(rows, n);
}

// Where the caps of an atom go.
struct CapPlace {
  unsigned long long first;
  bool fits;
};
// Asks for it, which lane 0 does: nothing waits until all are told.
__device__ __forceinline__ unsigned long long reserve_caps(const CapJob &job, int n) {
  return lane_id() == 0 && n > 0 ? atomicAdd(&job.counters->caps, static_cast<unsigned long long>(n)) : 0;
}
__device__ __forceinline__ CapPlace place_of_caps(const CapJob &job, unsigned long long reserved, int n) {
  const unsigned long long first = __shfl_sync(kFullWarp, reserved, 0);
  return {first, first + static_cast<unsigned>(n) <= job.room.caps};
}

// The rank of cap q, of which each lane has one, or none: the largest first; of equal ones the earlier atom. No cosine
// is near -2, since atoms within others have no caps.
__device__ __forceinline__ int rank_of_cap(const CapRows &rows, int n, int q) {
  const bool on = q < n;
  const float cosine = on ? rows.cap[q].cosine : -2.f;
  int rank = 0;
#pragma unroll 4
  for (int k = 0; k < n; ++k) rank += rows.cap[k].cosine < cosine ? 1 : 0;
  // Equal ones would share a rank, and the sum of all be less.
  if (n > kWarp || warp_sum(static_cast<uint32_t>(rank)) != static_cast<uint32_t>(n * (n - 1) / 2)) {
    const uint32_t neighbor = on ? rows.neighbor[q] : 0;
    for (int k = 0; k < n; ++k) rank += rows.cap[k].cosine == cosine && rows.neighbor[k] < neighbor ? 1 : 0;
  }
  return rank;
}

// Writes cap q of atom i to its rank. Returns whether the atom owns the circle.
__device__ __forceinline__ bool write_cap(const CapJob &job, uint32_t i, float radius, const CapRows &rows, int q,
                                          int rank, const CapPlace &place) {
  const Cap cap = rows.cap[q];
  const uint32_t neighbor = rows.neighbor[q];
  if (place.fits) {
    job.caps[place.first + rank] = {cap.axis, stored_cap_cosine(cap.cosine, radius)};
    if (job.neighbors) job.neighbors[place.first + rank] = neighbor;
  }
  return neighbor > i;
}

// By lane 0 of a warp, of an atom with n caps.
__device__ __forceinline__ void note_caps(const CapJob &job, uint32_t i, int n, const CapPlace &place, bool alone) {
  job.cap_ranges[i] = {static_cast<uint32_t>(place.first), place.fits ? n : 0};
  if (alone) job.exposed[i] = 1;
}

// Of several atoms. An addition to a counter takes the whole GPU two clock cycles, so a block adds what is only counted
// but once.
struct CapTally {
  uint32_t longest_row;
  unsigned long long circles;
  __device__ __forceinline__ void add(const CapTally &other) {
    longest_row = longest_row > other.longest_row ? longest_row : other.longest_row;
    circles += other.circles;
  }
  __device__ __forceinline__ void count(const CapJob &job) const {
    if (longest_row > 0) atomicMax(&job.counters->longest_row, longest_row);
    if (circles > 0) atomicAdd(&job.counters->circles, circles);
  }
};
// By all threads of a block; what lanes 0 know.
__device__ __forceinline__ void count_of_block(const CapJob &job, const CapTally &own) {
  __shared__ CapTally warps[kCapWarps];
  if (lane_id() == 0) warps[threadIdx.x / kWarp] = own;
  __syncthreads();
  if (threadIdx.x != 0) return;
  CapTally all = own;
  for (int w = 1; w < kCapWarps; ++w) all.add(warps[w]);
  all.count(job);
}

// Atoms that others contain are far away; others' caps nobody asks for.
__device__ __forceinline__ bool is_skipped(const CapJob &job, uint32_t i, const Sphere &self) {
  return is_removed(self) || (!job.neighbors && !job.exposed[i]);
}

// All about the caps of atom i. False if it has more neighbours than the rows hold.
__device__ __forceinline__ bool find_caps_of_atom(const CapJob &job, uint32_t i, const CapRows &rows, int room,
                                                  CapTally *tally) {
  const int lane = lane_id();
  const Sphere self = load(job.atoms.items + i);
  const bool with_circles = job.neighbors != nullptr;
  if (is_skipped(job, i, self)) {
    if (lane == 0) {
      job.cap_ranges[i] = {0, kBuriedAtom};
      if (with_circles) job.circle_count[i - job.run.first] = 0;
    }
    return true;
  }
  int n = gather_caps(job.atoms, i, self, rows, room);
  if (n > room) {
    if (lane == 0) atomicMax(&job.counters->neighbors, static_cast<uint32_t>(n));
    return false;
  }
  const bool alone = n == 0;
  n = drop_contained_caps(rows, n);
  const unsigned long long reserved = reserve_caps(job, n);
  int circles = 0;
  for (int q0 = 0; q0 < n; q0 += kWarp) {
    const int q = q0 + lane, rank = rank_of_cap(rows, n, q);
    const CapPlace place = place_of_caps(job, reserved, n);
    const bool owns = q < n && write_cap(job, i, self.radius, rows, q, rank, place);
    circles += __popc(__ballot_sync(kFullWarp, owns));
  }
  const CapPlace place = place_of_caps(job, reserved, n);
  if (lane == 0) {
    note_caps(job, i, n, place, alone);
    if (with_circles) job.circle_count[i - job.run.first] = place.fits ? static_cast<uint32_t>(circles) : 0;
  }
  tally->add({static_cast<uint32_t>(n), static_cast<unsigned long long>(circles)});
  __syncwarp();
  return true;
}

}  // namespace gpu
}  // namespace quickses
