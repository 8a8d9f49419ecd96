// SPDX-License-Identifier: MIT
// The verbs of parallel/executor.h on the CPU's threads, with the sequential algorithms of Thrust.
#pragma once

#include "parallel/arena.h"
#include "parallel/cpu_threads.h"
#include "parallel/executor.h"
#include "parallel/working_thread.h"
#include "process/host_memory.h"

#include <thrust/execution_policy.h>
#include <thrust/merge.h>
#include <thrust/sort.h>
#include <thrust/system/cpp/execution_policy.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <map>
#include <memory>
#include <typeindex>
#include <utility>
#include <vector>

namespace quickses {

class CpuExecutor : public NothingQueued {
 public:
  static constexpr bool kIsCuda = false, kCounts = false;
  using HostSource = HostMemory;  // of memory that the host shares with it

  // Held while a computation runs; on the CPU there is nothing to set up.
  struct CallScope {
    explicit CallScope(CpuExecutor &) {}
  };

  // While it lives, all work gives up soon after the flag is set, and throws Cancelled.
  class RunScope {
   public:
    RunScope(CpuExecutor &executor, const std::atomic<bool> &flag) : executor_(executor) { executor.stop_ = &flag; }
    ~RunScope() { executor_.stop_ = nullptr; }
    RunScope(const RunScope &) = delete;
    RunScope &operator=(const RunScope &) = delete;

   private:
    CpuExecutor &executor_;
  };

  explicit CpuExecutor(const WorkerThreads &threads) : threads_(threads) {}

  unsigned threads() const { return threads_.count(); }
  Arena<HostMemory> &arena() { return arena_; }

  // What the threads' scratch takes, and what is set aside for it in a budget: it is larger only where atoms crowd.
  uint64_t scratch_bytes() const {
    uint64_t sum = 0;
    for (const auto &pool : scratch_pools_) sum += pool.second.bytes(pool.second.objects.get());
    return sum;
  }
  uint64_t scratch_allowance() const { return threads() * (uint64_t(304) << 10); }

  template <class T>
  Span<T> allocate(size_t n) {
    return {static_cast<T *>(arena_.allocate(n * sizeof(T))), n};
  }
  template <class T>
  Span<T> allocate_zeros(size_t n) {
    Span<T> zeros = allocate<T>(n);
    fill(zeros, 0);
    return zeros;
  }

  template <class F>
  void for_each(size_t n, F f, uint64_t steps = kPlainSteps) {
    // Chunks keep the functor's loop tight and the scheduler out of it. Few items without loops are done before another
    // thread has woken up.
    const size_t chunk =
        std::max<size_t>(steps > kPlainSteps ? kSerialItems : kPlainItems, n / (size_t(threads()) * 16));
    run_chunks((n + chunk - 1) / chunk,
               [&](size_t, size_t c) { for_range(c * chunk, std::min(n, (c + 1) * chunk), f); });
  }

  // The scratch objects of a type that for_each_brick hands to its threads, kept from call to call. A driver may leave
  // results in them and collect those afterwards.
  template <class Scratch>
  std::vector<std::unique_ptr<Scratch>> &scratches() {
    const std::type_index type(typeid(Scratch));
    auto pool = scratch_pools_.find(type);
    if (pool == scratch_pools_.end()) {  // noted when all of it is there
      auto made = std::make_shared<std::vector<std::unique_ptr<Scratch>>>();
      made->reserve(threads());  // so that what is made below has an owner whatever fails
      for (unsigned k = 0; k < threads(); ++k) made->emplace_back(new Scratch);
      pool = scratch_pools_.emplace(type, ScratchPool{made, &pool_bytes<Scratch>}).first;
    }
    return *static_cast<std::vector<std::unique_ptr<Scratch>> *>(pool->second.objects.get());
  }

  // Gives every thread as much room as any of them needed so far, by Scratch::match: to do the same work once more,
  // shared out among the threads in whatever way, none has to ask for memory.
  template <class Scratch>
  void match_scratches() {
    auto &pool = scratches<Scratch>();
    for (size_t k = 1; k < pool.size(); ++k) pool.front()->match(*pool[k]);
    for (const auto &scratch : pool) scratch->match(*pool.front());
    take_off_budget();
  }

  // Gives up what has grown beyond the allowance, as in a crowded frame before this one. False if nothing has. Not
  // while a pass works.
  bool drop_grown_scratch() {
    if (scratch_bytes() <= scratch_allowance()) return false;
    scratch_pools_.clear();
    take_off_budget();
    return true;
  }

  // grain: items a thread takes at a time. Each thread that works has a scratch of its own.
  template <class Scratch, class F>
  void for_each_brick(size_t n, F f, size_t grain = 8, uint64_t /*steps*/ = 0) {
    auto &pool = scratches<Scratch>();
    grain = std::max<size_t>(1, std::min(grain, n / (size_t(threads()) * 16)));  // few bricks are shared out evenly
    run_chunks((n + grain - 1) / grain, [&](size_t worker, size_t c) {
      for (size_t i = c * grain; i < std::min(n, (c + 1) * grain); ++i) f(SoloTeam{}, *pool[worker], i);
    });
    take_off_budget();
  }

  // Bytes of the arena that the verbs take for as long as they work; T, Key and Value as there.
  template <class T>
  size_t scan_bytes(size_t n) const {
    return (scan_chunks(n) + 1) * sizeof(T);
  }
  template <class Key, class Value>
  size_t sort_bytes(size_t n) const {
    const SortRuns runs(n, threads());
    return std::max(runs.room_bytes<Key, Value>(threads()),
                    runs.count > 1 ? n * (sizeof(Key) + sizeof(Value)) + 2 * kArenaUnit : 0);
  }
  template <class T>
  size_t reduce_bytes(size_t n) const {
    return reduce_chunks(n) * sizeof(T);
  }
  size_t compact_bytes(size_t n) const { return (scan_chunks(n) + 1) * sizeof(size_t); }

  template <class Load, class T>
  void exclusive_scan(size_t n, Load load, Span<T> out) {
    // Two sweeps over chunks: sums, then the running values. One sweep where there is little to do.
    const size_t chunks = scan_chunks(n), chunk = (n + chunks - 1) / chunks;
    const auto mark = arena_.mark();
    const Span<T> begin = allocate<T>(chunks + 1);
    begin[0] = T{};
    if (chunks > 1) {
      run_chunks(chunks, [&](size_t, size_t c) {
        T sum{};
        for_range(c * chunk, std::min(n, (c + 1) * chunk), [&](size_t i) { sum = sum + static_cast<T>(load(i)); });
        begin[c + 1] = sum;
      });
      for (size_t c = 0; c < chunks; ++c) begin[c + 1] = begin[c + 1] + begin[c];
    }
    run_chunks(chunks, [&](size_t, size_t c) {
      T sum = begin[c];
      const size_t end = std::min(n, (c + 1) * chunk);
      for_range(c * chunk, end, [&](size_t i) {
        const T value = static_cast<T>(load(i));
        out[i] = sum;
        sum = sum + value;
      });
      if (c + 1 == chunks) out[n] = sum;
    });
    arena_.rewind(mark);
  }

  template <class T = double, class Load>
  T reduce(size_t n, Load load, uint64_t /*steps*/ = 0) {
    const size_t chunks = reduce_chunks(n);
    const auto mark = arena_.mark();
    const Span<T> sums = allocate<T>(chunks);
    run_chunks(chunks, [&](size_t, size_t chunk) {
      constexpr size_t kRun = 64;
      const size_t end = std::min(n, (chunk + 1) * reduce_chunk(n));
      T sum{};
      for (size_t begin = chunk * reduce_chunk(n); begin < end; begin += kRun) {
        look_for_stop();
        add_run(load, begin, std::min(begin + kRun, end), &sum);
      }
      sums[chunk] = sum;
    });
    T sum{};
    for (const T &s : sums) sum += s;
    arena_.rewind(mark);
    return sum;
  }

  // Thrust's parallel sort takes its temporaries from the heap every time, and can't be stopped. Here its parts work in
  // the arena (by cpp::par, since Thrust 3 does not take an allocator with seq): runs are sorted one by one, then
  // merged pairwise, an even number of times so that the result is where the keys were.
  template <class Key, class Value>
  void sort_by_key(Span<Key> keys, Span<Value> values) {
    const size_t n = keys.size;
    if (n < 2) return;
    const SortRuns sorted(n, threads());
    const size_t runs = sorted.count, length = sorted.length, room = sorted.room<Key, Value>();
    const auto mark = arena_.mark();
    const Span<char> rooms = allocate<char>(sorted.room_bytes<Key, Value>(threads()));
    run_chunks(runs, [&](size_t worker, size_t k) {
      const size_t first = std::min(n, k * length), last = std::min(n, first + length);
      RoomAllocator allocator(rooms.data + worker * room, room);
      thrust::stable_sort_by_key(thrust::cpp::par(allocator), keys.data + first, keys.data + last, values.data + first);
    });
    arena_.rewind(mark);
    if (runs > 1) {
      Span<Key> other_keys = allocate<Key>(n);
      Span<Value> other_values = allocate<Value>(n);
      for (size_t merged = length; merged < length * runs; merged *= 2) {
        // Each piece of the result knows where in the two runs it begins and ends.
        run_chunks((n + kSortedRun - 1) / kSortedRun, [&](size_t, size_t piece) {
          size_t begin = piece * kSortedRun;
          const size_t end = std::min(n, begin + kSortedRun);
          while (begin < end) {
            const size_t first = begin / (2 * merged) * (2 * merged), middle = std::min(n, first + merged);
            const size_t last = std::min(n, middle + merged), stop = std::min(end, last);
            const size_t i = merge_split(keys.data + first, middle - first, last - middle, begin - first);
            const size_t j = merge_split(keys.data + first, middle - first, last - middle, stop - first);
            const size_t k = middle + (begin - first - i), l = middle + (stop - first - j);
            thrust::merge_by_key(thrust::seq, keys.data + first + i, keys.data + first + j, keys.data + k,
                                 keys.data + l, values.data + first + i, values.data + k, other_keys.data + begin,
                                 other_values.data + begin);
            begin = stop;
          }
        });
        std::swap(keys, other_keys);
        std::swap(values, other_values);
      }
    }
    arena_.rewind(mark);
  }

  template <class Keep, class T>
  size_t compact(size_t n, Keep keep, Span<T> out) {
    const size_t chunks = scan_chunks(n), chunk = (n + chunks - 1) / chunks;
    const auto mark = arena_.mark();
    const Span<size_t> begin = allocate<size_t>(chunks + 1);
    begin[0] = 0;
    run_chunks(chunks, [&](size_t, size_t c) {
      size_t count = 0;
      for_range(c * chunk, std::min(n, (c + 1) * chunk), [&](size_t i) { count += keep(i) ? 1 : 0; });
      begin[c + 1] = count;
    });
    for (size_t c = 0; c < chunks; ++c) begin[c + 1] = begin[c + 1] + begin[c];
    run_chunks(chunks, [&](size_t, size_t c) {
      size_t k = begin[c];
      for_range(c * chunk, std::min(n, (c + 1) * chunk), [&](size_t i) {
        if (keep(i)) out[k++] = static_cast<T>(i);
      });
    });
    const size_t kept = begin[chunks];
    arena_.rewind(mark);
    return kept;
  }

  template <class Keep, class T>
  void compact(size_t n, Keep keep, Span<T> out, uint64_t *count) {
    *count = compact(n, keep, out);
  }

  template <class T>
  T *take_counts() {
    return allocate_zeros<T>(1).data;
  }
  template <class T>
  T expect(const char *, const T *counts, const T &) {
    return *counts;
  }
  template <class T>
  T verified(const T *counts) {
    return *counts;
  }

  template <class T>
  T fetch(const T *p) {
    return *p;
  }
  template <class T>
  void fetch_all(T *values, const T *source, size_t n) {
    if (values != source) std::copy(source, source + n, values);
  }
  template <class T>
  void upload(T *destination, const T *host, size_t n) {
    if (n) std::memcpy(destination, host, n * sizeof(T));
  }
  template <class T>
  void download(T *host, const T *source, size_t n) {
    if (n) std::memcpy(host, source, n * sizeof(T));
  }
  template <class T>
  void fill(Span<T> span, int byte) {
    const size_t bytes = span.size * sizeof(T);
    char *const memory = reinterpret_cast<char *>(span.data);
    run_chunks((bytes + kFilledPiece - 1) / kFilledPiece, [&](size_t, size_t c) {
      std::memset(memory + c * kFilledPiece, byte, std::min(kFilledPiece, bytes - c * kFilledPiece));
    });
  }

 private:
  // A load may know how to find what a run of them adds.
  template <class Load, class T>
  static auto add_run(const Load &load, size_t begin, size_t end, T *sum) -> decltype(load.add_run(begin, end, sum)) {
    return load.add_run(begin, end, sum);
  }
  template <class Load, class Sum>
  static void add_run(const Load &load, size_t begin, size_t end, Sum sum) {
    for (size_t i = begin; i < end; ++i) *sum += load(i);
  }

  static constexpr size_t kSerialItems = 64;
  static constexpr size_t kPlainItems = 1024;              // of a pass without loops, that one thread does
  static constexpr size_t kSortedRun = size_t(1) << 15;    // items that one thread sorts, or merges, at a time
  static constexpr size_t kFilledPiece = size_t(1) << 20;  // bytes

  size_t scan_chunks(size_t n) const { return n < 65536 || threads() == 1 ? 1 : size_t(threads()) * 4; }

  // The parts that sort_by_key sorts one by one.
  struct SortRuns {
    size_t count = 1, length;
    SortRuns(size_t n, unsigned threads) {
      while (n / count > (threads > 1 ? kSortedRun : 4 * kSortedRun)) count *= 4;
      length = (n + count - 1) / count;
    }
    template <class Key, class Value>
    size_t room() const {
      return RoomAllocator::room_for(length * sizeof(Key)) + RoomAllocator::room_for(length * sizeof(Value));
    }
    template <class Key, class Value>
    size_t room_bytes(unsigned threads) const {
      return std::min<size_t>(count, threads) * room<Key, Value>();
    }
  };

  // What scratch has grown beyond its allowance.
  void take_off_budget() {
    const uint64_t scratch = scratch_bytes(), allowed = scratch_allowance();
    arena_.set_taken(scratch > allowed ? scratch - allowed : 0);
  }

  struct ScratchPool {
    std::shared_ptr<void> objects;
    uint64_t (*bytes)(const void *objects);
  };
  // Scratch may tell by bytes() what it holds besides itself.
  template <class Scratch>
  static auto held_bytes(const Scratch &scratch, int) -> decltype(scratch.bytes()) {
    return scratch.bytes();
  }
  template <class Scratch>
  static uint64_t held_bytes(const Scratch &, long) {
    return 0;
  }
  template <class Scratch>
  static uint64_t pool_bytes(const void *objects) {
    uint64_t sum = 0;
    for (const auto &scratch : *static_cast<const std::vector<std::unique_ptr<Scratch>> *>(objects))
      sum += sizeof(Scratch) + held_bytes(*scratch, 0);
    return sum;
  }

  // f(i) for the numbers from first to last - 1, with a look at the flag in between.
  template <class F>
  static void for_range(size_t first, size_t last, const F &f) {
    while (first < last) {
      look_for_stop();
      const size_t end = std::min(last, first + kSerialItems);
      for (; first < end; ++first) f(first);
    }
  }

  // How many of the first n items of two runs merged, the one behind the other, come from the first: keys that are
  // equal are taken from it before.
  template <class Key>
  static size_t merge_split(const Key *keys, size_t first_run, size_t second_run, size_t n) {
    size_t low = n > second_run ? n - second_run : 0, high = std::min(n, first_run);
    while (low < high) {
      const size_t i = low + (high - low) / 2;
      if (keys[first_run + (n - i - 1)] < keys[i])
        high = i;
      else
        low = i + 1;
    }
    return low;
  }

  // Everything that is done in parallel passes here.
  template <class Body>
  void run_chunks(size_t chunks, const Body &body) {
    threads_.share_out(chunks, stop_, body);
  }

  CpuThreads threads_;
  const std::atomic<bool> *stop_ = nullptr;
  Arena<HostMemory> arena_;
  std::map<std::type_index, ScratchPool> scratch_pools_;
};

}  // namespace quickses
