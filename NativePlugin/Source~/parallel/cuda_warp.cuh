// SPDX-License-Identifier: MIT
// Work that the 32 threads of a warp do together, or those of a block. All of them must call these.
#pragma once

#include "parallel/span.h"

namespace quickses {
namespace gpu {

constexpr unsigned kFullWarp = 0xffffffffu;
constexpr int kWarp = 32;

__device__ __forceinline__ int lane_id() { return static_cast<int>(threadIdx.x & 31u); }

// Of what one warp does alone, or all so many of a block together.
template <int kWarps>
__device__ __forceinline__ void sync_warps() {
  if constexpr (kWarps == 1)
    __syncwarp();
  else
    __syncthreads();
}

// Of teams of so many lanes that a warp is made of: the lane in its team, and the team's lanes.
template <int kLanes>
__device__ __forceinline__ int rank_in_team() {
  return lane_id() % kLanes;
}
template <int kLanes>
__device__ __forceinline__ unsigned lanes_of_team() {
  return (kFullWarp >> (kWarp - kLanes)) << (lane_id() / kLanes * kLanes);
}
template <int kLanes>
__device__ __forceinline__ unsigned ballot_of_team(bool own) {
  return __ballot_sync(kFullWarp, own) & lanes_of_team<kLanes>();
}
// Whether something that is the same in all lanes of a team holds for any team.
template <int kLanes>
__device__ __forceinline__ bool holds_for_any_team(bool own) {
  return kLanes == kWarp ? own : __any_sync(kFullWarp, own) != 0;
}

// How many of the lanes before this one are in a ballot: the place of this lane among them.
__device__ __forceinline__ int place_in(unsigned ballot, int lane) { return __popc(ballot & ((1u << lane) - 1u)); }

// Of what the warps of a block have each: the sum of those before the own one, and of all. In shared memory, of which
// there is a word for each warp, and which is free again behind another __syncthreads().
struct BlockSum {
  uint32_t before, all;
};
template <int kWarps>
__device__ __forceinline__ BlockSum sum_of_block(uint32_t own, uint32_t (&words)[kWarps]) {
  const int warp = static_cast<int>(threadIdx.x) / kWarp;
  if (lane_id() == 0) words[warp] = own;
  __syncthreads();
  BlockSum sum{0, 0};
#pragma unroll
  for (int w = 0; w < kWarps; ++w) {
    sum.before += w < warp ? words[w] : 0;
    sum.all += words[w];
  }
  return sum;
}

// Appends to a list that the lanes fill together: the place of this lane's item if it has one. count: of the list, the
// same in all lanes. team: those lanes that fill the same list.
template <class Count>
__device__ __forceinline__ Count append_place(bool has, Count *count, unsigned team = kFullWarp) {
  const unsigned ballot = __ballot_sync(kFullWarp, has) & team;
  const Count place = *count + static_cast<Count>(place_in(ballot, lane_id()));
  *count += static_cast<Count>(__popc(ballot));
  return place;
}

// The same of a list that all warps fill, whose count is in memory.
__device__ __forceinline__ uint32_t append_place_of_all(bool has, uint32_t *count) {
  uint32_t own = 0, base = 0;
  const uint32_t place = append_place(has, &own);
  if (lane_id() == 0 && own > 0) base = atomicAdd(count, own);
  return __shfl_sync(kFullWarp, base, 0) + place;
}
__device__ __forceinline__ void append(uint32_t *list, uint32_t *count, uint32_t item, bool has) {
  const uint32_t place = append_place_of_all(has, count);
  if (has) list[place] = item;
}

// The same by all threads of a block: the whole GPU can add to one count only every other clock cycle or so.
template <int kThreads>
__device__ __forceinline__ void append_of_block(uint32_t *list, uint32_t *count, uint32_t item, bool has) {
  __shared__ uint32_t words[kThreads / kWarp], base;
  uint32_t own = 0;
  const uint32_t place = append_place(has, &own);
  const BlockSum sum = sum_of_block(own, words);
  if (threadIdx.x == 0 && sum.all > 0) base = atomicAdd(count, sum.all);
  __syncthreads();
  if (has) list[base + sum.before + place] = item;
}

// Sum over the lanes up to and including this one.
template <class T>
__device__ __forceinline__ T warp_inclusive_sum(T value, int lane) {
#pragma unroll
  for (int d = 1; d < kWarp; d <<= 1) {
    const T other = __shfl_up_sync(kFullWarp, value, d);
    if (lane >= d) value += other;
  }
  return value;
}

// Of the first kLanes lanes, each with the sum of all up to it: the first whose sum exceeds t, of which there is one.
template <int kLanes>
__device__ __forceinline__ int lane_beyond(int sum, int t) {
  int lane = 0;
#pragma unroll
  for (int d = kLanes / 2; d > 0; d >>= 1)
    if (__shfl_sync(kFullWarp, sum, lane + d - 1) <= t) lane += d;
  return lane;
}

// Of a warp, or of each group of so many lanes; the same in all of them.
template <int Lanes, class T, class Combine>
__device__ __forceinline__ T fold_lanes(T value, const Combine &combine) {
#pragma unroll
  for (int d = Lanes / 2; d > 0; d >>= 1) value = combine(value, __shfl_xor_sync(kFullWarp, value, d));
  return value;
}

// From compute capability 8.0 on one instruction. (Clang 19's __reduce_or_sync() and its like can't be used: they take
// the mask for the value.)
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
#define QUICKSES_REDUCES_WARPS 1
#else
#define QUICKSES_REDUCES_WARPS 0
#endif
__device__ __forceinline__ uint32_t warp_or(uint32_t value) {
#if QUICKSES_REDUCES_WARPS
  asm volatile("redux.sync.or.b32 %0, %0, %1;" : "+r"(value) : "r"(kFullWarp));
  return value;
#else
  return fold_lanes<kWarp>(value, [](uint32_t a, uint32_t b) { return a | b; });
#endif
}
__device__ __forceinline__ uint32_t warp_sum(uint32_t value) {
#if QUICKSES_REDUCES_WARPS
  asm volatile("redux.sync.add.u32 %0, %0, %1;" : "+r"(value) : "r"(kFullWarp));
  return value;
#else
  return fold_lanes<kWarp>(value, [](uint32_t a, uint32_t b) { return a + b; });
#endif
}
__device__ __forceinline__ uint32_t warp_minimum(uint32_t value) {
#if QUICKSES_REDUCES_WARPS
  asm volatile("redux.sync.min.u32 %0, %0, %1;" : "+r"(value) : "r"(kFullWarp));
  return value;
#else
  return fold_lanes<kWarp>(value, [](uint32_t a, uint32_t b) { return a < b ? a : b; });
#endif
}
__device__ __forceinline__ int32_t warp_maximum(int32_t value) {
#if QUICKSES_REDUCES_WARPS
  asm volatile("redux.sync.max.s32 %0, %0, %1;" : "+r"(value) : "r"(kFullWarp));
  return value;
#else
  return fold_lanes<kWarp>(value, [](int32_t a, int32_t b) { return a > b ? a : b; });
#endif
}

// A number for a value, in their order, and a value for its number. Not for NaN; -0 comes before 0.
__device__ __forceinline__ int32_t in_order(int32_t bits) { return bits < 0 ? bits ^ 0x7fffffff : bits; }
__device__ __forceinline__ int32_t number_in_order(float value) { return in_order(__float_as_int(value)); }
__device__ __forceinline__ float value_in_order(int32_t number) { return __int_as_float(in_order(number)); }

// Of a warp, or of each group of so many lanes.
template <int Lanes = kWarp>
__device__ __forceinline__ float warp_maximum(float value) {
  if constexpr (Lanes == kWarp)
    return value_in_order(warp_maximum(number_in_order(value)));
  else
    return fold_lanes<Lanes>(value, [](float a, float b) { return fmaxf(a, b); });
}

// The largest value, and the smallest number that comes with it, of a warp or of each group of so many lanes. lanes: of
// all groups that ask.
struct NumberedValue {
  float value;
  uint32_t number;
  // Without || and &&, which a GPU would branch for.
  __device__ __forceinline__ void offer(const NumberedValue &other) {
    const bool is_better = (other.value > value) | ((other.value == value) & (other.number < number));
    value = is_better ? other.value : value;
    number = is_better ? other.number : number;
  }
};
template <int Lanes = kWarp>
__device__ __forceinline__ NumberedValue warp_largest(NumberedValue own, unsigned lanes = kFullWarp) {
  if constexpr (Lanes == kWarp) {
    const float most = warp_maximum(own.value);
    return {most, warp_minimum(own.value == most ? own.number : ~uint32_t(0))};
  } else {
#pragma unroll
    for (int d = Lanes / 2; d > 0; d >>= 1) {
      own.offer({__shfl_xor_sync(lanes, own.value, d), __shfl_xor_sync(lanes, own.number, d)});
    }
    return own;
  }
}

// A run of items for each lane: the t-th item of all, for t from t0 on, a lane each. t0: 0, 32, 64, ... in this order.
class RunItems {
 public:
  // sum: of the lengths of the runs before, and its own.
  __device__ __forceinline__ RunItems(const ItemRun &run, int sum)
      : sum_(sum), shift_(run.end - static_cast<uint32_t>(sum)) {}
  __device__ __forceinline__ uint32_t item(int t0) {
    const int t = t0 + lane_id();
    return __shfl_sync(kFullWarp, shift_, lane_beyond<kWarp>(sum_, t)) + static_cast<uint32_t>(t);
  }

 private:
  int sum_;
  uint32_t shift_;
};
// The same, quicker where there are many items: a word has a bit where a run begins, and so many bits up to an item
// tell which run it is in. For that lane k knows the k-th of the runs that have items.
class MarkedRunItems {
 public:
  __device__ __forceinline__ MarkedRunItems(const ItemRun &run, int sum)
      : begin_(sum - static_cast<int>(run.end - run.begin)), shift_(run.end - static_cast<uint32_t>(sum)), begun_(0) {
    const unsigned some = __ballot_sync(kFullWarp, run.begin < run.end);
    if (some & (some + 1)) {
      const int from = nth_bit32(some, lane_id()) & 31;  // any lane, if there are fewer
      begin_ = __shfl_sync(kFullWarp, begin_, from);
      shift_ = __shfl_sync(kFullWarp, shift_, from);
    }
    if (lane_id() >= __popc(some)) begin_ = -1;
  }
  __device__ __forceinline__ uint32_t item(int t0) {
    const unsigned from = static_cast<unsigned>(begin_ - t0);
    const uint32_t begins = warp_or(from < kWarp ? 1u << from : 0u);
    const int with_own = begun_ + __popc(begins << (31 - lane_id()));
    begun_ += __popc(begins);
    return __shfl_sync(kFullWarp, shift_, with_own - 1) + static_cast<uint32_t>(t0 + lane_id());
  }

 private:
  int begin_;  // of the lane's run; -1: there are fewer
  uint32_t shift_;
  int begun_;  // runs that begin before t0
};

// Calls visit(item, on) for every item of the runs run_of(0), ..., run_of(rows - 1), in this order, an item for each
// lane at a time: on tells whether the lane has one. Returns how many there are; once they turn out to be more than
// `most`, no more are visited.
template <class Items = RunItems, class RunOf, class Visit>
__device__ __forceinline__ uint32_t visit_runs(int rows, const RunOf &run_of, const Visit &visit,
                                               uint32_t most = ~uint32_t(0)) {
  const int lane = lane_id();
  uint32_t met = 0;
  for (int r0 = 0; r0 < rows; r0 += kWarp) {
    ItemRun run{0, 0};
    if (r0 + lane < rows) run = run_of(r0 + lane);
    const int sum = warp_inclusive_sum(static_cast<int>(run.end - run.begin), lane);
    const int total = __shfl_sync(kFullWarp, sum, kWarp - 1);
    met += static_cast<uint32_t>(total);
    if (met > most) break;
    Items items(run, sum);
    for (int t0 = 0; t0 < total; t0 += kWarp) {
      const uint32_t item = items.item(t0);
      visit(item, t0 + lane < total);
    }
  }
  return met;
}

}  // namespace gpu
}  // namespace quickses
