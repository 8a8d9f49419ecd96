// SPDX-License-Identifier: MIT
// GPU: the caps of atoms that have more neighbours than rows in shared memory hold: by a warp for each, or of very many
// neighbours by all warps together.
#pragma once

#include "surface/cuda/atom_caps_cuda.cuh"

#include <algorithm>

namespace quickses {
namespace gpu {

// Atoms that have more neighbours, with rows of the needed length in global memory.
struct LongRows {
  unsigned char *memory;
  size_t room;
  static constexpr size_t kBytes = sizeof(Cap) + sizeof(float) + sizeof(uint32_t);  // per neighbour
  __device__ __forceinline__ CapRows of(size_t number) const {
    unsigned char *const row = memory + number * room * kBytes;
    return {reinterpret_cast<Cap *>(row), reinterpret_cast<float *>(row + room * sizeof(Cap)),
            reinterpret_cast<uint32_t *>(row + room * (sizeof(Cap) + sizeof(float)))};
  }
};

// A warp per atom.
static __global__ __launch_bounds__(kCapWarps *kWarp) void find_long_caps_kernel(QueuedItems queued, CapJob job,
                                                                                 LongRows long_rows) {
  const LaunchItems atoms = queued.in_turn();
  const uint32_t warp = (blockIdx.x * blockDim.x + threadIdx.x) / kWarp, warps = gridDim.x * kCapWarps;
  const CapRows rows = long_rows.of(warp);
  const size_t count = job.counters->long_atoms, end = atoms.last < count ? atoms.last : count;
  CapTally tally{};
  for (size_t k = atoms.first + warp; k < end; k += warps)
    find_caps_of_atom(job, job.long_atoms[k], rows, static_cast<int>(long_rows.room), &tally);
  count_of_block(job, tally);
}

// Where an atom has very many neighbours, comparing its caps with each other may take too long for one warp, though of
// a wide probe's most lie within a large one: here all warps share what is left, 32 caps each at a time, in one pass
// after the other.
constexpr size_t kWarpNeighbors = 1024;

struct CrowdedAtom {
  CapPlace place;
  int caps;  // 0 also of one that is not asked for
};
struct CrowdedJob {
  CapJob caps;
  LongRows rows;
  CrowdedAtom *atoms;  // as many as there are rows
  uint32_t first;      // of the long atoms
  uint32_t groups;     // of 32 caps, per row

  // Number of a long atom; false if there is none, or it is not asked for.
  __device__ __forceinline__ bool atom(size_t row, uint32_t *i) const {
    if (first + row >= caps.counters->long_atoms) return false;
    *i = caps.long_atoms[first + row];
    return !is_skipped(caps, *i, load(caps.atoms.items + *i));
  }
};

static __global__ __launch_bounds__(kCapWarps *kWarp) void gather_crowded_kernel(QueuedItems queued, CrowdedJob job) {
  const LaunchItems rows = queued.in_turn();
  const size_t row = rows.first + (blockIdx.x * blockDim.x + threadIdx.x) / kWarp;
  if (row >= rows.last) return;
  uint32_t i;
  if (!job.atom(row, &i)) {
    if (lane_id() == 0) job.atoms[row].caps = 0;
    return;
  }
  const int room = static_cast<int>(job.rows.room);
  const CapRows caps = job.rows.of(row);
  int n = gather_caps(job.caps.atoms, i, load(job.caps.atoms.items + i), caps, room);
  if (n > room) {
    if (lane_id() == 0) atomicMax(&job.caps.counters->neighbors, static_cast<uint32_t>(n));
    n = 0;  // all will be done again
  }
  // Again while that drops many: of those that are left, others are the largest of some.
  for (int before = 2 * n; n > kWarp && n <= before - before / 8;) {
    before = n;
    n = drop_caps_within_large(caps, n);
  }
  if (lane_id() == 0) job.atoms[row].caps = n;
}

static __global__ __launch_bounds__(kCapWarps *kWarp) void mark_crowded_kernel(QueuedItems queued, CrowdedJob job) {
  const LaunchItems groups = queued.in_turn();
  const size_t item = groups.first + (blockIdx.x * blockDim.x + threadIdx.x) / kWarp, row = item / job.groups;
  if (item >= groups.last) return;
  const CapRows rows = job.rows.of(row);
  const int n = job.atoms[row].caps, j = static_cast<int>(item % job.groups) * kWarp + lane_id();
  if (j < n && lies_within_another<1>(rows, n, j, 0)) rows.neighbor[j] |= kContainedCap;
}

static __global__ __launch_bounds__(kCapWarps *kWarp) void keep_crowded_kernel(QueuedItems queued, CrowdedJob job) {
  const LaunchItems rows = queued.in_turn();
  const size_t row = rows.first + (blockIdx.x * blockDim.x + threadIdx.x) / kWarp;
  uint32_t i;
  if (row >= rows.last || !job.atom(row, &i)) return;
  const int n = keep_free_caps(job.rows.of(row), job.atoms[row].caps);
  const CapPlace place = place_of_caps(job.caps, reserve_caps(job.caps, n), n);
  if (lane_id() != 0) return;
  job.atoms[row] = {place, n};
  note_caps(job.caps, i, n, place, false);
  CapTally{static_cast<uint32_t>(n), 0}.count(job.caps);
}

static __global__ __launch_bounds__(kCapWarps *kWarp) void rank_crowded_kernel(QueuedItems queued, CrowdedJob job) {
  const LaunchItems groups = queued.in_turn();
  const size_t item = groups.first + (blockIdx.x * blockDim.x + threadIdx.x) / kWarp, row = item / job.groups;
  if (item >= groups.last) return;
  const CrowdedAtom atom = job.atoms[row];
  const int first = static_cast<int>(item % job.groups) * kWarp, q = first + lane_id();
  if (first >= atom.caps) return;
  const uint32_t i = job.caps.long_atoms[job.first + row];
  const float radius = load(job.caps.atoms.items + i).radius;
  const CapRows rows = job.rows.of(row);
  const int rank = rank_of_cap(rows, atom.caps, q);
  const bool owns = q < atom.caps && write_cap(job.caps, i, radius, rows, q, rank, atom.place);
  const int circles = __popc(__ballot_sync(kFullWarp, owns));
  if (lane_id() != 0) return;
  CapTally{0, static_cast<unsigned long long>(circles)}.count(job.caps);
  if (job.caps.neighbors && atom.place.fits && circles > 0)
    atomicAdd(job.caps.circle_count + (i - job.caps.run.first), static_cast<uint32_t>(circles));
}

// Some rows' worth of atoms after the other.
template <class E>
void find_crowded_caps(E &executor, const CapJob &job, const LongRows &rows, size_t row_count, uint64_t gather_steps) {
  const size_t row_room = rows.room, groups = (row_room + kWarp - 1) / kWarp;
  const Span<CrowdedAtom> atoms = executor.template allocate<CrowdedAtom>(row_count);
  if (E::kCounts) return;
  const size_t crowded_atoms = std::min<size_t>(job.room.long_atoms, executor.fetch(&job.counters->long_atoms));
  for (size_t first = 0; first < crowded_atoms; first += row_count) {
    const size_t count = std::min(row_count, crowded_atoms - first);
    const CrowdedJob crowded{job, rows, atoms.data, static_cast<uint32_t>(first), static_cast<uint32_t>(groups)};
    constexpr int kThreads = kCapWarps * kWarp;
    executor.launch("gather_crowded", gather_crowded_kernel, count,
                    LaunchShape{kThreads, kCapWarps, gather_steps + 16 + 2 * row_room}, crowded);
    executor.launch("mark_crowded", mark_crowded_kernel, count * groups, LaunchShape{kThreads, kCapWarps, 2 * row_room},
                    crowded);
    executor.launch("keep_crowded", keep_crowded_kernel, count, LaunchShape{kThreads, kCapWarps, 64 + row_room / 8},
                    crowded);
    executor.launch("rank_crowded", rank_crowded_kernel, count * groups, LaunchShape{kThreads, kCapWarps, 2 * row_room},
                    crowded);
    executor.keep_pace();
  }
}

}  // namespace gpu
}  // namespace quickses
