// SPDX-License-Identifier: MIT
// The verbs of parallel/executor.h on a CUDA stream: plain kernels, and CUB for sorting, scanning and compaction.
#pragma once

#include "parallel/arena.h"
#include "parallel/cuda_counts.cuh"
#include "parallel/cuda_queue.cuh"

#include <cuda_runtime.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>
#include <cub/device/device_merge_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <cub/device/device_select.cuh>

#include <cstring>
#include <limits>
#include <string>

namespace quickses {

// Use from one thread at a time, with its device selected (DeviceGuard). Functions that fail throw Error.
class CudaExecutor : public CudaQueue {
 public:
  static constexpr bool kIsCuda = true, kCounts = false;
  using HostSource = PinnedMemory;  // of memory that the host shares with it

  explicit CudaExecutor(int device, bool goes_first = false) : CudaQueue(device, goes_first) {
    const DeviceGuard guard(device);
    staging_.reserve(kStagingBytes);
    counts_.allocate();
  }
  ~CudaExecutor() {
    try {
      const DeviceGuard guard(device());
      if (!may_hand_back()) return;
      wait_for_all();
      counts_.release();
      arena_.release();
      cudaGetLastError();
    } catch (...) {  // the device is lost, and its memory with it
    }
  }

  // Rewinding it is safe while kernels still use what was there: whoever gets the memory next runs after them.
  Arena<DeviceMemory> &arena() { return arena_; }

  template <class T>
  Span<T> allocate(size_t n) {
    return {static_cast<T *>(arena_.allocate(n * sizeof(T))), n};
  }
  // The first few of a frame lie behind its counts, and were filled with them at once.
  template <class T>
  Span<T> allocate_zeros(size_t n) {
    if (void *const there = counts_.take_zeros(n * sizeof(T))) return {static_cast<T *>(there), n};
    Span<T> zeros = allocate<T>(n);
    fill(zeros, 0);
    return zeros;
  }

  static LaunchShape for_each_shape(uint64_t steps) { return {gpu::kForEachThreads, gpu::kForEachThreads, steps}; }

  static LaunchShape few_shape() { return {gpu::kFewThreads, 1, gpu::kFewSteps}; }
  // Of do_in_turn(). False: one of them has too many items, and nothing is done.
  template <class... Steps>
  bool do_few(const Steps &...steps) {
    const uint64_t longest = (gpu::steps_of_few(steps) + ...);
    if (!(gpu::is_few(steps) && ...) || longest > kLaunchSteps / (gpu::kFewThreads / 32)) return false;
    launch("do_few", gpu::do_few_kernel<Steps...>, 1, {gpu::kFewThreads, 1, longest}, steps...);
    return true;
  }
  LaunchShape for_each_brick_shape(uint64_t steps) const {
    return {BlockTeam::kSize, 1, steps, size_t(multiprocessors()) * 32};
  }

  // steps: of one thread for one item, at most (cuda_launch.cuh). What is not told is a plain pass.
  template <class F>
  void for_each(size_t n, F f, uint64_t steps = kPlainSteps) {
    launch("for_each", gpu::for_each_kernel<F>, n, for_each_shape(steps), f);
  }

  template <class Scratch, class F>
  void for_each_brick(size_t n, F f, size_t /*grain*/ = 8, uint64_t steps = kPlainTeamSteps) {
    if (n == 0) return;
    const auto kernel = gpu::for_each_brick_kernel<Scratch, F>;
    if (sizeof(Scratch) > kDefaultSharedBytes)
      check_cuda(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, sizeof(Scratch)),
                 "cudaFuncSetAttribute");
    LaunchShape shape = for_each_brick_shape(steps);
    shape.shared_bytes = sizeof(Scratch);
    launch("for_each_brick", kernel, n, shape, f);
  }

  template <class Load, class T>
  void exclusive_scan(size_t n, Load load, Span<T> out) {
    if (is_some(n))
      scan_some(gpu::scan_some_kernel<Load, T, false>, n, load, out);
    else
      scan_all(n, load, out, T{});
  }
  // The same behind sums that are there already: out[0] is the last of them.
  template <class Load, class T>
  void go_on_scanning(size_t n, Load load, Span<T> out) {
    if (is_some(n))
      scan_some(gpu::scan_some_kernel<Load, T, true>, n, load, out);
    else
      scan_all(n, load, out, cub::FutureValue<T>(out.data));
  }

  // Bytes of the arena that the verbs take for as long as they work; T, Key and Value as there. CUB's scan keeps, for
  // each tile of 128 items or more, two sums and a status.
  template <class T>
  size_t scan_bytes(size_t n) const {
    return is_some(n) ? 0 : (n / 128 + 33) * (2 * sizeof(T) + 8) + 1024;
  }
  template <class Key, class Value>
  size_t sort_bytes(size_t n) const {
    if (n >= kMostItems) return n * (sizeof(Key) + sizeof(Value));  // forecast, but never done
    size_t bytes = 0;
    check_cuda(sort_pairs(nullptr, bytes, Span<Key>{nullptr, n}, Span<Value>{nullptr, n}), "CUB");
    return bytes;
  }
  template <class T>
  size_t reduce_bytes(size_t n) const {
    return sums_go_to_host<T>(reduce_chunks(n)) ? 0 : reduce_chunks(n) * sizeof(T);
  }
  size_t compact_bytes(size_t n) const { return n / 128 + 4096; }  // CUB's states of its tiles, generously

  // Sums of the chunks, to be added up when something has been waited for; they stay until the next call that copies to
  // the host. Of too many chunks, none, and nothing is done.
  template <class T, class Load>
  Span<const T> reduce_later(size_t n, Load load, uint64_t steps = kPlainSumSteps) {
    const size_t chunks = reduce_chunks(n);
    if (!sums_go_to_host<T>(chunks)) return {};
    T *const sums = static_cast<T *>(staging_.reserve(chunks * sizeof(T)));
    sum_chunks(n, load, sums, steps);
    return {sums, chunks};
  }
  template <class T = double, class Load>
  T reduce(size_t n, Load load, uint64_t steps = kPlainSumSteps) {
    if (n == 0) return T{};
    Span<const T> sums = reduce_later<T>(n, load, steps);
    if (sums.size > 0) {
      wait();
    } else {
      const auto mark = arena_.mark();
      const Span<T> here = allocate<T>(reduce_chunks(n));
      sum_chunks(n, load, here.data, steps);
      sums = {static_cast<const T *>(to_staging(here.data, here.size * sizeof(T))), here.size};
      arena_.rewind(mark);
    }
    T sum{};
    for (const T &part : sums) sum += part;
    return sum;
  }

  template <class Key, class Value>
  void sort_by_key(Span<Key> keys, Span<Value> values) {
    if (keys.size < 2) return;
    check_count(keys.size, "sort_by_key");
    with_temporary("cub::DeviceMergeSort::StableSortPairs",
                   [&](void *temporary, size_t &bytes) { return sort_pairs(temporary, bytes, keys, values); });
  }

  template <class Keep, class T>
  size_t compact(size_t n, Keep keep, Span<T> out) {
    if (n == 0) return 0;
    const auto mark = arena_.mark();
    Span<uint64_t> count = allocate<uint64_t>(1);
    compact(n, keep, out, count.data);
    const size_t result = static_cast<size_t>(fetch(count.data));
    arena_.rewind(mark);
    return result;
  }
  template <class Keep, class T>
  void compact(size_t n, Keep keep, Span<T> out, uint64_t *count) {
    if (n <= gpu::kFewItems) {
      launch("compact_few", gpu::compact_few_kernel<Keep, T>, 1, few_shape(), keep, n, out.data, count);
      return;
    }
    check_count(n, "compact");
    with_temporary("cub::DeviceSelect::If", [&](void *temporary, size_t &bytes) {
      return cub::DeviceSelect::If(temporary, bytes, thrust::counting_iterator<T>(0), out.data, count,
                                   static_cast<int>(n), gpu::KeepNumber<Keep, T>{keep}, stream());
    });
  }

  template <class T>
  T fetch(const T *p) {
    T value;
    std::memcpy(&value, to_staging(p, sizeof(T)), sizeof(T));
    return value;
  }
  // ---- counts ---------------------------------------------------------------------------------------------------

  // A frame begins whose counts may be anticipated (anticipation.h); kind 0: none. is_short: the last one of its kind
  // was, so that all of it may be queued.
  void open_counts(uint64_t kind, bool is_short = false) {
    run_ahead(is_short, kind != 0);
    if (has_given_up()) counts_.doubt_zeros();
    clear(counts_.open(kind));
  }
  // A frame ends, of which nothing more is asked for that counts. For the next one all is zero again, while the host
  // waits for what was asked for before.
  void close_counts() {
    if (counts_.written().size == 0) return;
    end_wait_here();
    clear(counts_.written());
    hand_over();
  }
  bool knows_frames() const { return counts_.anticipation().knows_frames(); }
  void forget_frames() { counts_.anticipation().forget_frames(); }
  bool has_anticipated() const { return counts_.anticipation().has_anticipated(); }
  void turn_counts_to(float level, uint32_t part = 0) { counts_.anticipation().turn_to(level, part); }

  // Counts of zero, for as long as what is allocated now.
  template <class T>
  T *take_counts() {
    T *const counts = counts_.take<T>();
    return counts ? counts : allocate_zeros<T>(1).data;
  }
  // How many there are, waiting for it; or how many there are at most, to be verified later.
  template <class T>
  T expect(const char *name, const T *counts, const T &most) {
    if (!counts_.has(counts)) return fetch(counts);
    T value;
    if (counts_.anticipation().anticipate(name, counts_.place_of(counts), most, &value)) return value;
    value = fetch(counts);
    counts_.anticipation().note(name, value);
    return value;
  }
  // What expect() would say without waiting. False, and nothing, where it would wait, also since these counts of the
  // frame, or any others that it took before, found no room among those that are sent.
  template <class T>
  bool foresee(const char *name, const void *counts, const T &most, T *expected) const {
    return counts_.has(counts) && counts_.anticipation().foresee(name, most, expected);
  }
  // All that is anticipated so far will have been counted when the device gets here.
  void send_counts() {
    if (counts_.anticipation().relies_on_something()) send_all_counts();
  }
  // Also if nothing is: for what verified() tells.
  void send_all_counts() {
    size_t words = 0;
    const gpu::CopyWords copy = counts_.begin_to_send(&words);
    for_each(words, copy);  // not by a copy, around which the device would wait
    counts_.note_sent(stream());
  }
  // Waits for that. False: all counts were exact. Throws AnticipatedTooLittle.
  bool verify_counts() {
    hand_over();  // so that the rest goes on meanwhile
    return counts_.verify();
  }
  // As they were found then.
  template <class T>
  T verified(const T *counts) {
    return counts_.has(counts) ? counts_.verified(counts) : fetch(counts);
  }
  // Copies n values. Waits.
  template <class T>
  void fetch_all(T *values, const T *source, size_t n) {
    if (n * sizeof(T) <= kMostStaged) {
      if (n > 0) std::memcpy(values, to_staging(source, n * sizeof(T)), n * sizeof(T));
      return;
    }
    download(values, source, n);
    wait();
  }
  static constexpr size_t kFixedBytes = CudaCounts::kDeviceBytes;  // of the device, beside the arena

  template <class T>
  void fill(Span<T> span, int byte) {
    // Little is filled by a kernel, which can be sent ahead as the others.
    auto *const bytes = reinterpret_cast<unsigned char *>(span.data);
    const size_t count = span.size * sizeof(T);
    if (count <= kLittleFill && reinterpret_cast<uintptr_t>(bytes) % sizeof(uint32_t) == 0)
      for_each((count + 3) / 4, gpu::FillBytes{bytes, count, 0x01010101u * static_cast<unsigned char>(byte)});
    else if (count > 0)
      check_cuda(cudaMemsetAsync(bytes, byte, count, stream()), "cudaMemsetAsync");
  }
  // As of the queue; what is counted on the second stream is not there for the other until both are joined.
  void turn_to_second_stream(bool second) noexcept {
    turn_streams();
    counts_.anticipation().turn_aside(second);
  }
  void join_second_stream() {
    counts_.anticipation().join();
    CudaQueue::join_second_stream();
  }

 private:
  static constexpr size_t kStagingBytes = 32768, kMostStaged = size_t(1) << 20;
  static constexpr size_t kLittleFill = size_t(1) << 19, kLittleFetch = size_t(1) << 22;
  static constexpr size_t kDefaultSharedBytes = 48 * 1024;

  void clear(Span<unsigned char> counts) {
    if (counts.size == 0) return;
    fill(counts, 0);  // may throw
    counts_.note_zeros();
  }

  // All but those of very many chunks: over the bus one by one, which spares a launch.
  template <class T>
  static bool sums_go_to_host(size_t chunks) {
    return chunks * sizeof(T) <= kMostStaged;
  }
  template <class T, class Load>
  void sum_chunks(size_t n, Load load, T *sums, uint64_t steps) {
    launch("reduce", gpu::sum_chunks_kernel<T, Load>, reduce_chunks(n),
           {BlockTeam::kSize, 1, reduce_chunk(n) / BlockTeam::kSize * steps}, n, load, sums);
  }

  static constexpr size_t kMostItems = std::numeric_limits<int>::max();  // of CUB's passes
  static void check_count(size_t n, const char *verb) {
    if (n >= kMostItems)
      throw Error(QSES_OUT_OF_MEMORY,
                  std::string(verb) + ": more than 2^31 items; use a larger spacing or a smaller slice size");
  }

  // Not by digits: it is rare, and that would be half as much code again in the library.
  template <class Key, class Value>
  cudaError_t sort_pairs(void *temporary, size_t &bytes, Span<Key> keys, Span<Value> values) const {
    return cub::DeviceMergeSort::StableSortPairs(temporary, bytes, keys.data, values.data, static_cast<int>(keys.size),
                                                 gpu::IsLess{}, stream_handle());
  }

  // On small GPUs their blocks would wait for each other.
  bool is_some(size_t n) const {
    return n <= std::max(gpu::kFewItems, std::min(gpu::kSomeItems, multiprocessors() * size_t(gpu::kFewThreads)));
  }
  template <class Kernel, class Load, class T>
  void scan_some(Kernel kernel, size_t n, const Load &load, Span<T> out) {
    launch("scan_some", kernel, std::max<size_t>(1, (n + gpu::kFewThreads - 1) / gpu::kFewThreads),
           {gpu::kFewThreads, 1, (n / gpu::kFewThreads + 2) * kPlainSumSteps}, load, n, out.data);
  }
  template <class Load, class T, class Start>
  void scan_all(size_t n, Load load, Span<T> out, Start start) {
    check_count(n + 1, "exclusive_scan");
    const auto in =
        thrust::make_transform_iterator(thrust::counting_iterator<size_t>(0), gpu::LoadOrZero<Load, T>{load, n});
    with_temporary("cub::DeviceScan::ExclusiveScan", [&](void *temporary, size_t &bytes) {
      return cub::DeviceScan::ExclusiveScan(temporary, bytes, in, out.data, gpu::Sum(), start, static_cast<int>(n + 1),
                                            stream());
    });
  }

  // CUB's two calls: how much memory, then the work.
  template <class Call>
  void with_temporary(const char *name, Call call) {
    stop_if_asked();
    size_t bytes = 0;
    check_cuda(call(nullptr, bytes), name);
    const auto mark = arena_.mark();
    void *temporary = arena_.allocate(bytes);
    hand_over();
    const LaunchWatch watch(name, stream_handle());
    check_cuda(call(temporary, bytes), name);
    arena_.rewind(mark);
  }

  // Waits; what it returns is valid until the next call that copies to the host.
  const void *to_staging(const void *source, size_t bytes) {
    void *host = staging_.reserve(bytes);
    // Little comes by a kernel: a copy would wait for those of a mesh that is on its way to the host.
    if (bytes <= kLittleFetch && bytes % sizeof(uint32_t) == 0 && reinterpret_cast<uintptr_t>(source) % 4 == 0)
      for_each(bytes / sizeof(uint32_t),
               gpu::CopyWords{static_cast<uint32_t *>(host), static_cast<const uint32_t *>(source)});
    else
      check_cuda(cudaMemcpyAsync(host, source, bytes, cudaMemcpyDeviceToHost, stream()), "cudaMemcpyAsync");
    wait();
    return host;
  }

  PinnedBuffer staging_;
  CudaCounts counts_;
  Arena<DeviceMemory> arena_;
};

}  // namespace quickses
