// SPDX-License-Identifier: MIT
// The verbs of parallel/executor.h on the CPU, by one of Thrust's parallel systems: TBB, or OpenMP where there is no
// TBB. Which one is a build option; nothing outside this file knows.
#pragma once

#include "parallel/arena.h"
#include "parallel/executor.h"

#if defined(QSES_CPU_SYSTEM_OMP)
#include <omp.h>
#include <thrust/system/omp/execution_policy.h>
#else
#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <thrust/system/tbb/execution_policy.h>
#endif
#include <thrust/execution_policy.h>
#include <thrust/for_each.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/merge.h>
#include <thrust/sort.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <map>
#include <memory>
#include <new>
#include <thread>
#include <typeindex>
#include <utility>
#include <vector>

namespace quickses {

struct CpuKernels;
const CpuKernels &cpu_kernels();

struct HostMemory {
  static constexpr const char *kName = "the machine";
  static void *acquire(size_t bytes) {
#if defined(_WIN32)
    return _aligned_malloc(bytes, 256);
#else
    return std::aligned_alloc(256, (bytes + 255) / 256 * 256);
#endif
  }
  static void release(void *p) {
#if defined(_WIN32)
    _aligned_free(p);
#else
    std::free(p);
#endif
  }
};

// Hands out memory that the caller has set aside, to Thrust, which takes a few pieces and gives them back. Where that
// is not enough, the heap's.
class RoomAllocator {
 public:
  using value_type = char;
  static constexpr size_t kAlignment = 64;
  // Of a room, for one piece.
  static size_t room_for(size_t bytes) { return bytes / kAlignment * kAlignment + 2 * kAlignment; }

  RoomAllocator(char *room, size_t bytes) : room_(room), end_(room + bytes), next_(room) {}
  char *allocate(size_t bytes) {
    bytes = (bytes + kAlignment - 1) / kAlignment * kAlignment;
    if (static_cast<size_t>(end_ - next_) < bytes) return static_cast<char *>(::operator new(bytes));
    char *const piece = next_;
    next_ += bytes;
    return piece;
  }
  void deallocate(char *piece, size_t) {
    if (piece < room_ || piece >= end_) ::operator delete(piece);
  }

 private:
  char *room_, *end_, *next_;
};

class CpuExecutor {
 public:
  static constexpr bool kIsCuda = false;

  // Held while a computation runs; on the CPU there is nothing to set up.
  struct CallScope {
    explicit CallScope(CpuExecutor &) {}
  };

  // While it lives, loops over bricks give up once the flag is set, and throw Cancelled.
  class StopScope {
   public:
    StopScope(CpuExecutor &executor, const std::atomic<bool> &flag) : executor_(executor) { executor.stop_ = &flag; }
    ~StopScope() { executor_.stop_ = nullptr; }
    StopScope(const StopScope &) = delete;
    StopScope &operator=(const StopScope &) = delete;

   private:
    CpuExecutor &executor_;
  };

  explicit CpuExecutor(unsigned threads)
      : threads_(threads ? threads : std::max(1u, std::thread::hardware_concurrency()))
#if !defined(QSES_CPU_SYSTEM_OMP)
        ,
        // More than the machine has are of no use, and TBB would complain on stderr.
        arena_threads_(std::min(static_cast<int>(threads_), tbb::info::default_concurrency()))
#endif
  {
  }

  unsigned threads() const { return threads_; }
  // The instruction set's kernels that the hot stages use; tests set others.
  const CpuKernels &kernels() const { return *kernels_; }
  void set_kernels(const CpuKernels &kernels) { kernels_ = &kernels; }
  Arena<HostMemory> &arena() { return arena_; }

  // What the threads' scratch takes, and what is set aside for it in a budget: it is larger only where atoms crowd.
  uint64_t scratch_bytes() const {
    uint64_t sum = 0;
    for (const auto &pool : scratch_pools_) sum += pool.second.bytes(pool.second.objects.get());
    return sum;
  }
  uint64_t scratch_allowance() const { return threads_ * (uint64_t(192) << 10); }

  // Memory was refused: to know how much there is would not help, since all work is cut small already.
  void bound_arena() {}

  template <class T>
  Span<T> allocate(size_t n) {
    return {static_cast<T *>(arena_.allocate(n * sizeof(T))), n};
  }

  template <class F>
  void for_each(size_t n, F f) {
    if (n == 0) return;
    if (n < kSerialItems || threads_ == 1) {
      for (size_t i = 0; i < n; ++i) f(i);
      return;
    }
    // Chunks keep the functor's loop tight and the scheduler out of it.
    const size_t chunk = std::max<size_t>(kSerialItems, n / (size_t(threads_) * 16));
    run([&] {
      thrust::for_each(policy(), thrust::counting_iterator<size_t>(0),
                       thrust::counting_iterator<size_t>((n + chunk - 1) / chunk), [=](size_t c) {
                         const size_t end = std::min(n, (c + 1) * chunk);
                         for (size_t i = c * chunk; i < end; ++i) f(i);
                       });
    });
  }

  // The scratch objects of a type that for_each_brick hands to its threads, kept from call to call. A driver may leave
  // results in them and collect those afterwards.
  template <class Scratch>
  std::vector<std::unique_ptr<Scratch>> &scratches() {
    ScratchPool &pool = scratch_pools_[std::type_index(typeid(Scratch))];
    if (!pool.objects) {
      auto made = std::make_shared<std::vector<std::unique_ptr<Scratch>>>();
      for (unsigned k = 0; k < threads_; ++k) made->emplace_back(new Scratch);
      pool = {made, &pool_bytes<Scratch>};
    }
    return *static_cast<std::vector<std::unique_ptr<Scratch>> *>(pool.objects.get());
  }

  // Gives every thread as much room as any of them needed so far, by Scratch::match: once a trajectory has shown how
  // much that is, no thread has to ask for memory.
  template <class Scratch>
  void match_scratches() {
    auto &pool = scratches<Scratch>();
    for (size_t k = 1; k < pool.size(); ++k) pool.front()->match(*pool[k]);
    for (const auto &scratch : pool) scratch->match(*pool.front());
  }

  // grain: items a thread takes at a time. Each thread that works has a scratch of its own.
  template <class Scratch, class F>
  void for_each_brick(size_t n, F f, size_t grain = 8) {
    if (n == 0) return;
    const size_t chunks = (n + grain - 1) / grain;
    const size_t workers = std::min<size_t>(threads_, chunks);
    std::atomic<size_t> next{0};
    auto &pool = scratches<Scratch>();
    // What one thread throws (memory that is refused) ends all of them and is thrown again here: not every parallel
    // system lets exceptions out.
    std::exception_ptr thrown;
    std::atomic<bool> failed{false};
    auto work = [&](size_t worker) {
      try {
        Scratch *const scratch = pool[worker].get();
        for (size_t c; !stopped() && !failed && (c = next.fetch_add(1, std::memory_order_relaxed)) < chunks;)
          for (size_t i = c * grain; i < std::min(n, (c + 1) * grain); ++i) f(SoloTeam{}, *scratch, i);
      } catch (...) {
        if (!failed.exchange(true)) thrown = std::current_exception();
      }
    };
    if (workers == 1) {
      work(0);
    } else {
      run([&] {
        thrust::for_each(policy(), thrust::counting_iterator<size_t>(0), thrust::counting_iterator<size_t>(workers),
                         work);
      });
    }
    if (arena_.has_budget()) {
      const uint64_t scratch = scratch_bytes(), allowed = scratch_allowance();
      arena_.set_taken(scratch > allowed ? scratch - allowed : 0);
    }
    if (thrown) std::rethrow_exception(thrown);
    if (stopped()) throw Cancelled{};
  }

  template <class Load, class T>
  void exclusive_scan(size_t n, Load load, Span<T> out) {
    // Two sweeps over chunks: sums, then the running values. One sweep where there is little to do.
    const size_t chunks = n < 65536 || threads_ == 1 ? 1 : size_t(threads_) * 4;
    const size_t chunk = (n + chunks - 1) / (chunks ? chunks : 1);
    const auto mark = arena_.mark();
    const Span<T> begin = allocate<T>(chunks + 1);
    begin[0] = T(0);
    if (chunks > 1) {
      for_each_brick<char>(
          chunks,
          [&](SoloTeam, char &, size_t c) {
            T sum = 0;
            for (size_t i = c * chunk; i < std::min(n, (c + 1) * chunk); ++i) sum += static_cast<T>(load(i));
            begin[c + 1] = sum;
          },
          1);
      for (size_t c = 0; c < chunks; ++c) begin[c + 1] += begin[c];
    }
    for_each_brick<char>(
        chunks,
        [&](SoloTeam, char &, size_t c) {
          T sum = begin[c];
          const size_t end = std::min(n, (c + 1) * chunk);
          for (size_t i = c * chunk; i < end; ++i) {
            const T value = static_cast<T>(load(i));
            out[i] = sum;
            sum += value;
          }
          if (end == n && (c + 1 == chunks || c * chunk < n)) out[n] = sum;
        },
        1);
    if (n == 0) out[0] = T(0);
    arena_.rewind(mark);
  }

  template <class T = double, class Load>
  T reduce(size_t n, Load load) {
    const size_t chunks = (n + kReduceChunk - 1) / kReduceChunk;
    const auto mark = arena_.mark();
    const Span<T> sums = allocate<T>(chunks);
    for_each_brick<char>(
        chunks,
        [&](SoloTeam, char &, size_t chunk) {
          SumChunk<T, Load>{load, n, sums.data}(chunk);
        },
        1);
    T sum{};
    for (const T &s : sums) sum += s;
    arena_.rewind(mark);
    return sum;
  }

  // Thrust's parallel sort takes its temporaries from the heap every time. Here its parts work in the arena: runs are
  // sorted one by one, then merged pairwise, an even number of times so that the result is where the keys were.
  template <class Key, class Value>
  void sort_by_key(Span<Key> keys, Span<Value> values, int /*key_bits*/) {
    const size_t n = keys.size;
    if (n < 2) return;
    size_t runs = 1;
    while (threads_ > 1 && n / runs > kSortedRun) runs *= 4;
    const size_t length = (n + runs - 1) / runs;
    const auto mark = arena_.mark();
    const size_t room = RoomAllocator::room_for(length * sizeof(Key)) + RoomAllocator::room_for(length * sizeof(Value));
    const Span<char> rooms = allocate<char>(runs * room);
    for_each_brick<char>(
        runs,
        [&](SoloTeam, char &, size_t k) {
          const size_t first = std::min(n, k * length), last = std::min(n, first + length);
          RoomAllocator allocator(rooms.data + k * room, room);
          thrust::stable_sort_by_key(thrust::seq(allocator), keys.data + first, keys.data + last, values.data + first);
        },
        1);
    arena_.rewind(mark);
    if (runs > 1) {
      Span<Key> other_keys = allocate<Key>(n);
      Span<Value> other_values = allocate<Value>(n);
      for (size_t merged = length; merged < length * runs; merged *= 2) {
        run([&] {
          for (size_t first = 0; first < n; first += 2 * merged) {
            const size_t middle = std::min(n, first + merged), last = std::min(n, middle + merged);
            thrust::merge_by_key(policy(), keys.data + first, keys.data + middle, keys.data + middle, keys.data + last,
                                 values.data + first, values.data + middle, other_keys.data + first,
                                 other_values.data + first);
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
    const size_t chunks = n < 65536 || threads_ == 1 ? 1 : size_t(threads_) * 4;
    const size_t chunk = (n + chunks - 1) / chunks;
    const auto mark = arena_.mark();
    const Span<size_t> begin = allocate<size_t>(chunks + 1);
    begin[0] = 0;
    for_each_brick<char>(
        chunks,
        [&](SoloTeam, char &, size_t c) {
          size_t count = 0;
          for (size_t i = c * chunk; i < std::min(n, (c + 1) * chunk); ++i) count += keep(i) ? 1 : 0;
          begin[c + 1] = count;
        },
        1);
    for (size_t c = 0; c < chunks; ++c) begin[c + 1] += begin[c];
    for_each_brick<char>(
        chunks,
        [&](SoloTeam, char &, size_t c) {
          size_t k = begin[c];
          for (size_t i = c * chunk; i < std::min(n, (c + 1) * chunk); ++i)
            if (keep(i)) out[k++] = static_cast<T>(i);
        },
        1);
    const size_t kept = begin[chunks];
    arena_.rewind(mark);
    return kept;
  }

  template <class T>
  T fetch(const T *p) {
    return *p;
  }
  // Several values with one wait.
  template <class T>
  void fetch_each(const T *const *sources, T *values, size_t n) {
    for (size_t k = 0; k < n; ++k) values[k] = *sources[k];
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
    if (span.size) std::memset(static_cast<void *>(span.data), byte, span.size * sizeof(T));
  }
  void wait() {}

 private:
  static constexpr size_t kSerialItems = 64;
  static constexpr size_t kSortedRun = size_t(1) << 15;  // items that one thread sorts

  struct ScratchPool {
    std::shared_ptr<void> objects;
    uint64_t (*bytes)(const void *objects) = nullptr;
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

  bool stopped() const { return stop_ && stop_->load(std::memory_order_relaxed); }

#if defined(QSES_CPU_SYSTEM_OMP)
  static auto policy() -> decltype((thrust::omp::par)) { return thrust::omp::par; }
  template <class F>
  void run(F f) {
    const struct Restore {
      int threads = omp_get_max_threads();
      ~Restore() { omp_set_num_threads(threads); }
    } restore;
    omp_set_num_threads(static_cast<int>(threads_));
    f();
  }
#else
  static auto policy() -> decltype((thrust::tbb::par)) { return thrust::tbb::par; }
  template <class F>
  void run(F f) {
    arena_threads_.execute(f);
  }
#endif

  unsigned threads_;
  const std::atomic<bool> *stop_ = nullptr;
#if !defined(QSES_CPU_SYSTEM_OMP)
  tbb::task_arena arena_threads_;
#endif
  const CpuKernels *kernels_ = &cpu_kernels();
  Arena<HostMemory> arena_;
  std::map<std::type_index, ScratchPool> scratch_pools_;
};

}  // namespace quickses
