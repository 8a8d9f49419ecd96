// SPDX-License-Identifier: MIT
// The kernels behind the verbs of cuda_executor.cuh: a thread, or a block, for each item; sums of chunks; and passes
// over few items, which one block does, or some that do not wait for each other.
#pragma once

#include "parallel/cuda_launch.cuh"
#include "parallel/executor.h"

#include <cub/warp/warp_scan.cuh>

#include <cassert>
#include <cstddef>
#include <cstdint>

namespace quickses {

// Threads that work on one item of for_each_brick.
struct BlockTeam {
  static constexpr int kSize = 128;
  __device__ __forceinline__ int rank() const { return static_cast<int>(threadIdx.x); }
  __device__ __forceinline__ int size() const { return kSize; }
  __device__ __forceinline__ void sync() const { __syncthreads(); }
};

namespace gpu {

constexpr int kForEachThreads = 128;

template <class F>
__global__ __launch_bounds__(kForEachThreads) void for_each_kernel(QueuedItems queued, F f) {
  const LaunchItems items = queued.in_turn();
  const size_t i = items.first + static_cast<size_t>(blockIdx.x) * kForEachThreads + threadIdx.x;
  if (i < items.last) f(i);
}

// The scratch is in dynamic shared memory: one object per block, used by one item after the other.
template <class Scratch, class F>
__global__ __launch_bounds__(BlockTeam::kSize) void for_each_brick_kernel(QueuedItems queued, F f) {
  const LaunchItems items = queued.in_turn();
  extern __shared__ __align__(16) unsigned char scratch_memory[];
  Scratch &scratch = *reinterpret_cast<Scratch *>(scratch_memory);
  for (size_t i = items.first + blockIdx.x; i < items.last; i += gridDim.x) {
    f(BlockTeam{}, scratch, i);
    __syncthreads();
  }
}

// Sum of each chunk of reduce(): a thread adds every 128th item, then the threads are added as a tree. Always the same
// order, but not the one of a single thread.
constexpr int kSumBlocks = 4;  // of a multiprocessor, at least: sums of doubles wait for each other
template <class T, class Load>
__global__ __launch_bounds__(BlockTeam::kSize, kSumBlocks) void sum_chunks_kernel(QueuedItems queued, size_t n,
                                                                                  Load load, T *sums) {
  const LaunchItems chunks = queued.in_turn();
  __shared__ __align__(16) unsigned char partial_memory[BlockTeam::kSize * sizeof(T)];
  T *partial = reinterpret_cast<T *>(partial_memory);
  const size_t chunk = chunks.first + blockIdx.x, begin = chunk * reduce_chunk(n);
  const size_t end = begin + reduce_chunk(n) < n ? begin + reduce_chunk(n) : n;
  T sum{};
  for (size_t i = begin + threadIdx.x; i < end; i += BlockTeam::kSize) sum += load(i);
  partial[threadIdx.x] = sum;
  for (int half = BlockTeam::kSize / 2; half > 0; half >>= 1) {
    __syncthreads();
    if (static_cast<int>(threadIdx.x) < half) partial[threadIdx.x] += partial[threadIdx.x + half];
  }
  if (threadIdx.x == 0) sums[chunk] = partial[0];
}

// The sum that CUB knows better than any other operation.
#if CUB_VERSION >= 200800
using Sum = ::cuda::std::plus<>;
#else
using Sum = cub::Sum;
#endif

// Few items are scanned, or chosen, by one block, a tile of as many as it has threads after the other. CUB's passes
// over the whole device take two launches, of which each waits until all is done that was queued before it.
constexpr int kFewThreads = 1024;
constexpr size_t kFewItems = 8 * kFewThreads;
constexpr uint64_t kFewSteps = kFewItems / kFewThreads * kPlainSumSteps;  // of a thread, for those

template <class T>
struct TileMemory {
  typename cub::WarpScan<T>::TempStorage scans[kFewThreads / 32];
  T of_warps[kFewThreads / 32];
};
// Of the threads before this one; and of all. Memory: not used by the call before this one.
template <class T>
__device__ __forceinline__ T sum_before(TileMemory<T> &memory, const T &own, T *total) {
  using Scan = cub::WarpScan<T>;
  const int warp = static_cast<int>(threadIdx.x) / 32, lane = static_cast<int>(threadIdx.x) % 32;
  T with_own, before;
  Scan(memory.scans[warp]).Scan(own, with_own, before, T{}, Sum());
  if (lane == 31) memory.of_warps[warp] = with_own;
  __syncthreads();
  if (warp == 0) {
    T with_warp;
    Scan(memory.scans[0]).InclusiveScan(memory.of_warps[lane], with_warp, Sum());
    memory.of_warps[lane] = with_warp;
  }
  __syncthreads();
  *total = memory.of_warps[kFewThreads / 32 - 1];
  return warp > 0 ? memory.of_warps[warp - 1] + before : before;
}

// use(i, value, sum of those before it) for each of n items, whose values are load(i), in tiles: the next tile is asked
// for before this one is summed. Returns the sum of all.
template <class T, class Load, class Use>
__device__ __forceinline__ T for_sums(size_t n, const Load &load, const Use &use) {
  __shared__ __align__(16) unsigned char memory_of_tiles[2][sizeof(TileMemory<T>)];
  T sum{}, next = threadIdx.x < n ? static_cast<T>(load(threadIdx.x)) : T{};
  int tile = 0;
  for (size_t i = threadIdx.x; i - threadIdx.x < n; i += kFewThreads, tile ^= 1) {
    const T own = next;
    if (i + kFewThreads < n) next = static_cast<T>(load(i + kFewThreads));
    T total;
    const T before = sum_before(*reinterpret_cast<TileMemory<T> *>(memory_of_tiles[tile]), i < n ? own : T{}, &total);
    if (i < n) use(i, own, sum + before);
    sum = sum + total;
  }
  return sum;
}

template <class Load, class T>
__device__ __forceinline__ void scan_few(const Load &load, size_t n, T *out) {
  const T total = for_sums<T>(n, load, [&](size_t i, const T &, const T &before) { out[i] = before; });
  if (threadIdx.x == 0) out[n] = total;
}

// Some items are scanned in one launch, too, by a block for each tile, which adds up all that is before it by itself,
// so that none waits for another; if they all run at once. kGoesOn: out[0] holds the start, and is left alone.
constexpr size_t kSomeItems = 64 * kFewThreads;
template <class Load, class T, bool kGoesOn>
__global__ __launch_bounds__(kFewThreads) void scan_some_kernel(QueuedItems queued, Load load, size_t n, T *out) {
  __shared__ __align__(16) unsigned char memory[2][sizeof(TileMemory<T>)];
  const auto sum_of_block = [&](int k, const T &own, T *total) {
    return sum_before(*reinterpret_cast<TileMemory<T> *>(memory[k]), own, total);
  };
  const size_t tile = queued.in_turn().first + blockIdx.x, first = tile * kFewThreads, i = first + threadIdx.x;
  const T own = i < n ? static_cast<T>(load(i)) : T{};
  T start = kGoesOn && threadIdx.x == 0 ? *out : T{}, total;
#pragma unroll 8
  for (size_t k = threadIdx.x; k < first; k += kFewThreads) start = start + static_cast<T>(load(k));
  sum_of_block(0, start, &start);
  const T before = start + sum_of_block(1, own, &total);
  if (i < n && !(kGoesOn && i == 0)) out[i] = before;
  if (threadIdx.x == 0 && first + kFewThreads >= n) out[n] = start + total;
}

// Steps of do_in_turn(), by one block: a launch of their own takes each some microseconds. Two items for each thread:
// of more, one multiprocessor makes more than that.
constexpr size_t kFewInTurn = 2;
template <class F>
constexpr bool is_few(const ForEach<F> &step) {
  return step.n <= kFewInTurn * kFewThreads;
}
template <class Load, class T>
constexpr bool is_few(const Scan<Load, T> &step) {
  return step.n <= kFewItems;
}
template <class F>
constexpr uint64_t steps_of_few(const ForEach<F> &step) {
  return kFewInTurn * step.steps;
}
template <class Load, class T>
constexpr uint64_t steps_of_few(const Scan<Load, T> &) {
  return kFewSteps;
}
template <class F>
__device__ __forceinline__ void do_by_block(const ForEach<F> &step) {
  for (size_t i = threadIdx.x; i < step.n; i += kFewThreads) step.f(i);
  __syncthreads();
}
template <class Load, class T>
__device__ __forceinline__ void do_by_block(const Scan<Load, T> &step) {
  scan_few(step.load, step.n, step.out.data);
  __syncthreads();
}
template <class... Steps>
__global__ __launch_bounds__(kFewThreads) void do_few_kernel(QueuedItems queued, Steps... steps) {
  queued.in_turn();
  (do_by_block(steps), ...);
}

template <class Keep, class T>
__global__ __launch_bounds__(kFewThreads) void compact_few_kernel(QueuedItems queued, Keep keep, size_t n, T *out,
                                                                  uint64_t *count) {
  queued.in_turn();
  const uint32_t total = for_sums<uint32_t>(
      n, [&](size_t i) { return keep(i) ? 1u : 0u; },
      [&](size_t i, uint32_t kept, uint32_t before) {
        if (kept) out[before] = static_cast<T>(i);
      });
  if (threadIdx.x == 0) *count = total;
}

// By words of four bytes, the last of which may be shorter.
struct FillBytes {
  unsigned char *bytes;
  size_t count;
  uint32_t word;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    if (4 * i + 4 <= count)
      *reinterpret_cast<uint32_t *>(bytes + 4 * i) = word;
    else
      for (size_t k = 4 * i; k < count; ++k) bytes[k] = static_cast<unsigned char>(word);
  }
};
struct CopyWords {
  uint32_t *to;
  const uint32_t *from;
  QSES_HOST_DEVICE void operator()(size_t i) const { to[i] = from[i]; }
};

// Several runs of words, as if they were one.
struct CopyRuns {
  static constexpr int kMost = 8;
  CopyWords runs[kMost];
  size_t ends[kMost];  // of each, counted from the beginning of the first
  int count = 0;
  size_t words() const { return count > 0 ? ends[count - 1] : 0; }
  void add(void *to, const void *from, size_t bytes) {
    assert(count < kMost && bytes % sizeof(uint32_t) == 0);
    runs[count] = {static_cast<uint32_t *>(to), static_cast<const uint32_t *>(from)};
    ends[count] = words() + bytes / sizeof(uint32_t);
    ++count;
  }
  QSES_HOST_DEVICE void operator()(size_t i) const {
    int run = 0;
    while (i >= ends[run]) ++run;
    runs[run](run > 0 ? i - ends[run - 1] : i);
  }
};

// load(i), and 0 for the one element behind the last.
template <class Load, class T>
struct LoadOrZero {
  Load load;
  size_t n;
  QSES_HOST_DEVICE T operator()(size_t i) const { return i < n ? static_cast<T>(load(i)) : T{}; }
};

struct IsLess {
  template <class T>
  QSES_HOST_DEVICE bool operator()(const T &a, const T &b) const {
    return a < b;
  }
};

template <class Keep, class T>
struct KeepNumber {
  Keep keep;
  QSES_HOST_DEVICE bool operator()(T i) const { return keep(static_cast<size_t>(i)); }
};

}  // namespace gpu

}  // namespace quickses
