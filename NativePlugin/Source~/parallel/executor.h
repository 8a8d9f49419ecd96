// SPDX-License-Identifier: MIT
// The few verbs every pass is written in. There are two back ends with the same members: CpuExecutor (threads of
// its own) and CudaExecutor (CUB on a stream). Stages are templates over the executor and know neither.
//
// clang-format off
//   Span<T> allocate<T>(n)         memory of the back end, uninitialised, valid until the arena is rewound
//   allocate_zeros<T>(n)           the same, of zeros
//   for_each(n, f)                 f(i) for i in [0, n), in any order
//   for_each_brick<Scratch>(n, f)  f(team, scratch, i): a team of threads shares one Scratch per item
//   exclusive_scan(n, load, out)   out[i] = load(0) + ... + load(i - 1); out has n + 1 elements
//   do_in_turn(executor, steps...) for_each and exclusive_scan one after the other: ForEach{n, f}, Scan{n, load, out}
//   reduce<T>(n, load)             sum of load(i), T a double or a few: fixed chunks, added in fixed order. Waits
//   sort_by_key(keys, values)      stable, in place
//   compact(n, keep, out)          the i with keep(i), in order; returns their number. Waits
//   compact(n, keep, out, count)   the same; their number stays with the back end
//   fetch(p)                       copies a value to the host. Waits
//   fetch_all(values, source, n)   copies an array to the host, if it is not there already. Waits
//   take_counts<T>()               a T of zeros for passes to count in
//   expect(name, counts, most)     what was counted. Waits; or, if it is told by the frame before, at most so much
//   send_counts(), verify_counts() later: what was expected is compared with what was counted (anticipation.h). Waits
//   verified(counts)               what was counted then
//   foresee(name, counts, most, out)  what expect() would say without waiting; false, and nothing, where it would wait
//   open_counts(kind), turn_counts_to(level, part)  which frames, and what of them, have counts that are alike
//   close_counts()                 the frame counts nothing more. The next wait is for what was asked for before
//   has_anticipated()              whether this frame went on with anything that the one before told
//   go_on_scanning(n, load, out), send_all_counts()  of the GPU only, for work in slabs (methods/exact_slabs.h)
//   runs_ahead()                   whether all of this frame may be queued, since frames like it are short
//   hand_over()                    what was asked for begins, if it was held back: before others are waited for
//   keep_pace()                    called between parts of a long work, so that it can be cancelled. May wait
//   wait()                         until all that was asked for is done
//   upload, download, fill         copies between host and back end, and memset
//   lend(host), end_lending()      memory of HostSource for passes to read where it is
//   scan_bytes<T>(n), sort_bytes<Key, Value>(n), reduce_bytes<T>(n), compact_bytes(n)  of the arena, that these verbs
//                                  take while they work: for forecasts (surface/memory/counting_executor.h)
// clang-format on
//
// Functors are plain structs that hold views and have a QSES_HOST_DEVICE operator(). A verb may return before its work
// is done, but everything runs in the order it was asked for; only what "waits" blocks the calling thread.
//
// for_each, for_each_brick and reduce take a last argument, `steps`: of a thread of the GPU for an item, at most. A
// pass over items that may need many of them must tell, since the launches of the GPU are cut by it. On the CPU, few
// items of a for_each that needs no more than kPlainSteps stay on one thread.
//
// A team has rank() in [0, size()), and sync(). On the CPU it is one thread, so its loops run straight through.
#pragma once

#include "parallel/span.h"
#include "parallel/working_thread.h"

#include <cstddef>
#include <cstdint>

namespace quickses {

// The verbs that only say when a queue's work is to begin or to have ended, and what the frame before tells: of
// executors whose work is done when a verb returns.
struct NothingQueued {
  template <class T>
  bool foresee(const char *, const void *, const T &, T *) const {
    return false;
  }
  void open_counts(uint64_t, bool = false) {}
  void close_counts() {}
  bool has_anticipated() const { return false; }
  void turn_counts_to(float, uint32_t = 0) {}
  void send_counts() {}
  bool verify_counts() { return false; }
  bool runs_ahead() const { return false; }
  void hand_over() {}
  void keep_pace() {}
  template <class T>
  const T *lend(const T *host) {
    return host;
  }
  void end_lending() {}
  void wait() {}
};

// Of a pass of for_each_brick() that needs none.
struct NoScratch {};

// Items per chunk of reduce(): part of the result's definition, since float sums depend on the order. Few items are
// enough chunks for a GPU, many not too many for the host, which adds them up.
QSES_FN constexpr size_t reduce_chunk(size_t n) { return n <= (size_t(1) << 18) ? 512 : 2048; }
inline size_t reduce_chunks(size_t n) { return (n + reduce_chunk(n) - 1) / reduce_chunk(n); }

// Steps of a thread: rounds of its loops, of some 25 instructions each (cuda_launch.cuh). For one item no more than
// this may be asked for: the work on it is cut.
constexpr uint64_t kThreadSteps = uint64_t(1) << 19;
// For an item of a pass without loops, whatever it reads and writes: also arrays in the host's memory, which come over
// the bus. And where a team works on some thousand elements.
constexpr uint64_t kPlainSteps = 512, kPlainTeamSteps = 4096;
// For a sum's item: double precision, of which the smallest GPU does one thirty-second.
constexpr uint64_t kPlainSumSteps = 64;

// Each item its own number, as before a sort.
struct NumberItems {
  uint32_t *numbers;
  QSES_HOST_DEVICE void operator()(size_t i) const { numbers[i] = static_cast<uint32_t>(i); }
};

// So many keep a GPU busy with a thread for each.
constexpr size_t kManyItems = size_t(1) << 15;

// Where several threads share each of few items, fewer than 2^32 in all: which one, and which of its threads.
struct ThreadOfItem {
  size_t item;
  uint32_t rank;
};
QSES_FN ThreadOfItem thread_of_item(size_t i, uint32_t threads) {
  if (threads == 1) return {i, 0};
  const uint32_t k = static_cast<uint32_t>(i);  // a GPU takes much longer to divide 64 bits
  return {k / threads, k % threads};
}

// The usual thing to sum up or scan.
template <class T>
struct LoadCount {
  const T *counts;
  QSES_HOST_DEVICE uint64_t operator()(size_t i) const { return counts[i]; }
};

// Steps that follow each other. A GPU does those of few items in one launch; then none may read by load(), or else as
// what never changes, what one before it wrote.
template <class F>
struct ForEach {
  size_t n;
  F f;
  uint64_t steps = kPlainSteps;  // of a thread for an item, at most
};
template <class Load, class T>
struct Scan {
  size_t n;
  Load load;
  Span<T> out;
};
template <class F>
ForEach(size_t, F) -> ForEach<F>;
template <class F>
ForEach(size_t, F, uint64_t) -> ForEach<F>;
template <class Load, class T>
Scan(size_t, Load, Span<T>) -> Scan<Load, T>;

template <class Executor, class F>
void do_step(Executor &executor, const ForEach<F> &step) {
  executor.for_each(step.n, step.f, step.steps);
}
template <class Executor, class Load, class T>
void do_step(Executor &executor, const Scan<Load, T> &step) {
  executor.exclusive_scan(step.n, step.load, step.out);
}
template <class Executor, class... Steps>
void do_in_turn(Executor &executor, const Steps &...steps) {
  if constexpr (Executor::kIsCuda && !Executor::kCounts && sizeof...(Steps) > 1)
    if (executor.do_few(steps...)) return;
  (do_step(executor, steps), ...);
}

struct SoloTeam {
  QSES_FN int rank() const { return 0; }
  QSES_FN int size() const { return 1; }
  QSES_FN void sync() const {}
};

// Two sums at once.
struct SumPair {
  double first = 0, second = 0;
  QSES_FN SumPair &operator+=(const SumPair &other) {
    first += other.first;
    second += other.second;
    return *this;
  }
};

}  // namespace quickses
