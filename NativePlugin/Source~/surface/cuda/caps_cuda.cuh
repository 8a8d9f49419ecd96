// SPDX-License-Identifier: MIT
// GPU driver of the caps: a warp per atom (atom_caps_cuda.cuh), with rows of neighbours in shared memory; then those
// that have more (crowded_caps_cuda.cuh).
#pragma once

#include "surface/cuda/crowded_caps_cuda.cuh"

#include <algorithm>

namespace quickses {
namespace gpu {

static __global__ __launch_bounds__(kCapWarps *kWarp,
                                    blocks_at_once(kCapWarps *kWarp, 9)) void find_caps_kernel(QueuedItems queued,
                                                                                               CapJob job) {
  const LaunchItems atoms = queued.in_turn();
  __shared__ Cap cap[kCapWarps][kRowNeighbors];
  __shared__ float sine[kCapWarps][kRowNeighbors];
  __shared__ uint32_t neighbor[kCapWarps][kRowNeighbors];
  const int warp = static_cast<int>(threadIdx.x) / kWarp;
  const CapRows rows{cap[warp], sine[warp], neighbor[warp]};
  CapTally tally{};
  for (size_t place = atoms.first + blockIdx.x * kCapWarps + static_cast<uint32_t>(warp); place < atoms.last;
       place += gridDim.x * kCapWarps) {
    const uint32_t i = job.run.first + static_cast<uint32_t>(place);
    if (!find_caps_of_atom(job, i, rows, kRowNeighbors, &tally) && lane_id() == 0) {
      job.long_atoms[atomicAdd(&job.counters->long_atoms, 1u)] = i;
      job.cap_ranges[i] = {0, 0};
      if (job.neighbors) job.circle_count[place] = 0;
    }
  }
  count_of_block(job, tally);
}

// The caps of a run of atoms. memory_is_short: rows of atoms with many neighbours get a quarter of what is free, or
// what those of one block need; else of a gigabyte.
template <class E>
void find_caps(E &executor, const CapJob &job, bool memory_is_short) {
  const size_t blocks =
      std::min<size_t>((job.run.size() + kCapWarps - 1) / kCapWarps, size_t(executor.multiprocessors()) * 32);
  // An atom is compared with those around it, 32 at a time; what may be its neighbours then with each other.
  const auto gather_steps = [](uint64_t near) { return 64 + near / 8; };
  const auto shape = [&](uint64_t near) {
    return LaunchShape{kCapWarps * kWarp, kCapWarps, gather_steps(near) + 13 * kRowNeighbors, blocks};
  };
  const uint64_t near = most_atoms_near(executor, job.atoms, 4.f * job.max_radius, [&](uint64_t items) {
    return executor.is_few_launches(job.run.size(), shape(items));
  });
  executor.launch("find_caps", find_caps_kernel, job.run.size(), shape(near), job);
  if (job.room.neighbors == 0) return;
  // Rows for as many warps as there is memory for; the others' atoms take turns.
  constexpr uint64_t kEnough = uint64_t(1) << 30;
  const size_t neighbors = job.room.neighbors, block_bytes = kCapWarps * neighbors * LongRows::kBytes;
  const uint64_t free = !memory_is_short ? kEnough : E::kCounts ? 0 : std::min(kEnough, executor.arena().available());
  const size_t long_blocks = static_cast<size_t>(std::max<uint64_t>(
      1, std::min<uint64_t>({blocks, size_t(executor.multiprocessors()) * 4, free / 4 / block_bytes})));
  const auto mark = executor.arena().mark();
  const LongRows rows{executor.template allocate<unsigned char>(long_blocks * block_bytes).data, neighbors};
  if (neighbors > kWarpNeighbors) {
    find_crowded_caps(executor, job, rows, long_blocks * kCapWarps, gather_steps(near));
  } else {
    const uint64_t pairs = uint64_t(neighbors) * neighbors;
    executor.launch("find_long_caps", find_long_caps_kernel, job.room.long_atoms,
                    LaunchShape{kCapWarps * kWarp, kCapWarps, gather_steps(near) + pairs / kWarp * 3, long_blocks}, job,
                    rows);
  }
  executor.arena().rewind(mark);
}

}  // namespace gpu
}  // namespace quickses
