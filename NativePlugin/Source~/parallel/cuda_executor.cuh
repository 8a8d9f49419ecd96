// SPDX-License-Identifier: MIT
// The verbs of parallel/executor.h on one CUDA stream: plain kernels, and CUB for sorting, scanning and compaction.
// Work is cut into launches that are short on the smallest GPU (cuda_launch.cuh).
#pragma once

#include "parallel/arena.h"
#include "parallel/cuda_counts.cuh"

#include <cuda_runtime.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>
#include <cub/device/device_merge_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <cub/device/device_select.cuh>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

namespace quickses {

// Use from one thread at a time, with its device selected (DeviceGuard). Functions that fail throw Error.
class CudaExecutor {
 public:
  static constexpr bool kIsCuda = true, kCounts = false;
  using HostSource = PinnedMemory;  // of memory that the host shares with it

  // While it lives, nothing more is asked of the device once the flag is set: Cancelled is thrown instead. However the
  // computation ends, what was to be uploaded is with the device then.
  class RunScope {
   public:
    RunScope(CudaExecutor &executor, const std::atomic<bool> &flag) : executor_(executor) { executor.stop_ = &flag; }
    ~RunScope() {
      executor_.stop_ = nullptr;
      executor_.wait_for_uploads();
    }
    RunScope(const RunScope &) = delete;
    RunScope &operator=(const RunScope &) = delete;

   private:
    CudaExecutor &executor_;
  };
  // Held while a computation runs: keeps the device selected.
  struct CallScope {
    explicit CallScope(const CudaExecutor &executor) : guard(executor.device_) {}
    DeviceGuard guard;
  };

  // goes_first: its kernels, before those of others.
  explicit CudaExecutor(int device, bool goes_first = false) : device_(device) {
    const DeviceGuard guard(device);
    int value = 0;
    check_cuda(cudaDeviceGetAttribute(&value, cudaDevAttrMultiProcessorCount, device), "cudaDeviceGetAttribute");
    multiprocessors_ = static_cast<unsigned>(value);
    if (LaunchObserver::current) multiprocessors_ = LaunchObserver::current->multiprocessors(multiprocessors_);
    staging_.reserve(kStagingBytes);
    counts_.allocate();
    check_cuda(cudaStreamCreateWithPriority(&stream_, cudaStreamNonBlocking, goes_first ? kHighestPriority : 0),
               "cudaStreamCreateWithPriority");
    for (cudaEvent_t *event : {&joined_, &uploaded_})
      check_cuda(cudaEventCreateWithFlags(event, cudaEventDisableTiming), "cudaEventCreateWithFlags");
  }
  ~CudaExecutor() {
    try {
      const DeviceGuard guard(device_);
      if (!may_hand_back()) return;
      for (cudaStream_t stream : {stream_, second_stream_})
        if (stream) cudaStreamSynchronize(stream);
      for (cudaEvent_t event : {launched_[0], launched_[1], joined_, uploaded_})
        if (event) cudaEventDestroy(event);
      counts_.release();
      arena_.release();
      for (cudaStream_t stream : {stream_, second_stream_})
        if (stream) cudaStreamDestroy(stream);
      cudaGetLastError();
    } catch (...) {  // the device is lost, and its memory with it
    }
  }
  CudaExecutor(const CudaExecutor &) = delete;
  CudaExecutor &operator=(const CudaExecutor &) = delete;

  int device() const { return device_; }
  unsigned multiprocessors() const { return multiprocessors_; }
  cudaStream_t stream() const { return stream_; }
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

  // How many items a launch is given, and how many launches that makes. Known before anything is launched.
  size_t items_per_launch(const LaunchShape &shape) const { return most_items_of_launch(shape, multiprocessors_); }
  size_t launches_of(size_t items, const LaunchShape &shape) const {
    const size_t most = items_per_launch(shape);
    return items / most + (items % most > 0 ? 1 : 0);
  }

  // So few that to know more about the items is not worth a wait.
  bool is_few_launches(size_t items, const LaunchShape &shape) const { return launches_of(items, shape) <= 4; }
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
    return {BlockTeam::kSize, 1, steps, size_t(multiprocessors_) * 32};
  }

  // A kernel on this stream, for all items, in as many launches as that takes: kernel(QueuedItems, arguments...). Of
  // several, no more than two are queued at a time, since what is queued can't be cancelled; but in a frame that is
  // known to be short (open_counts). No items: nothing to do.
  template <class... Parameters>
  void launch(const char *name, void (*kernel)(QueuedItems, Parameters...), size_t items, const LaunchShape &shape,
              std::common_type_t<Parameters>... arguments) {
    if (items == 0) return;
    const size_t launches = launches_of(items, shape);
    const size_t even = (items + launches - 1) / launches;
    const size_t length = (even + shape.items_per_block - 1) / shape.items_per_block * shape.items_per_block;
    for (size_t first = 0; first < items; first += length) {
      const size_t last = std::min(items, first + length);
      const size_t wanted = (last - first + shape.items_per_block - 1) / shape.items_per_block;
      const size_t blocks = shape.most_blocks ? std::min(shape.most_blocks, wanted) : wanted;
      stop_if_asked();
      const LaunchWatch watch(name, blocks, wanted, shape, multiprocessors_, stream_);
      QueuedItems queued(first, last);
      void *parameters[] = {&queued, &arguments...};
      check_cuda(launch_queued(reinterpret_cast<const void *>(kernel), blocks, shape, parameters), name);
      if (launches > 1 && !runs_ahead_) wait_for_launch_before();
    }
  }

  // Whether all of this frame may be queued.
  bool runs_ahead() const { return runs_ahead_; }

  // Between parts of a long work: waits for the part before the last one, so that little is queued that can't be
  // cancelled. In a frame that is known to be short nothing waits.
  void keep_pace() {
    if (!runs_ahead_) wait_for_launch_before();
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
    if (n <= gpu::kFewItems) {
      launch("scan_few", gpu::scan_few_kernel<Load, T>, 1, few_shape(), load, n, out.data);
      return;
    }
    scan_all(n, load, out, T{});
  }
  // The same behind sums that are there already: out[0] is the last of them.
  template <class Load, class T>
  void go_on_scanning(size_t n, Load load, Span<T> out) {
    if (n <= gpu::kFewItems)
      launch("scan_few", gpu::go_on_scanning_few_kernel<Load, T>, 1, few_shape(), load, n, out.data);
    else
      scan_all(n, load, out, cub::FutureValue<T>(out.data));
  }

  // Bytes of the arena that the verbs take for as long as they work; T, Key and Value as there. CUB's scan keeps, for
  // each tile of 128 items or more, two sums and a status.
  template <class T>
  size_t scan_bytes(size_t n) const {
    return n <= gpu::kFewItems ? 0 : (n / 128 + 33) * (2 * sizeof(T) + 8) + 1024;
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
                                   static_cast<int>(n), gpu::KeepNumber<Keep, T>{keep}, stream_);
    });
  }

  template <class T>
  T fetch(const T *p) {
    T value;
    std::memcpy(&value, to_staging(p, sizeof(T)), sizeof(T));
    return value;
  }
  // Copies several values with one wait. Small ones: they go through the staging buffer.
  template <class T>
  void fetch_each(const T *const *sources, T *values, size_t n) {
    char *host = static_cast<char *>(staging_.reserve(n * sizeof(T)));
    for (size_t k = 0; k < n; ++k)
      check_cuda(cudaMemcpyAsync(host + k * sizeof(T), sources[k], sizeof(T), cudaMemcpyDeviceToHost, stream_),
                 "cudaMemcpyAsync");
    wait();
    std::memcpy(values, host, n * sizeof(T));
  }
  // ---- counts ---------------------------------------------------------------------------------------------------

  // A frame begins whose counts may be anticipated (anticipation.h); kind 0: none. is_short: the last one of its kind
  // was, so that all of it may be queued.
  void open_counts(uint64_t kind, bool is_short = false) {
    runs_ahead_ = is_short;
    const Span<unsigned char> counts = counts_.open(kind);
    if (counts.size == 0) return;
    fill(counts, 0);  // may throw
    counts_.note_zeros();
  }
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
    counts_.note_sent(stream_);
  }
  // Waits for that. False: all counts were exact. Throws AnticipatedTooLittle.
  bool verify_counts() { return counts_.verify(); }
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

  // From page-locked memory the copy goes on after the call returns: leave the memory alone until something waits.
  template <class T>
  void upload(T *destination, const T *host, size_t n) {
    if (n == 0) return;
    is_uploading_ = true;
    check_cuda(cudaMemcpyAsync(destination, host, n * sizeof(T), cudaMemcpyHostToDevice, stream_), "cudaMemcpyAsync");
    check_cuda(cudaEventRecord(uploaded_, stream_), "cudaEventRecord");
  }
  // Into page-locked memory the values are there after the next wait.
  template <class T>
  void download(T *host, const T *source, size_t n) {
    if (n == 0) return;
    check_cuda(cudaMemcpyAsync(host, source, n * sizeof(T), cudaMemcpyDeviceToHost, stream_), "cudaMemcpyAsync");
  }
  template <class T>
  void fill(Span<T> span, int byte) {
    // Little is filled by a kernel, which can be sent ahead as the others.
    auto *const bytes = reinterpret_cast<unsigned char *>(span.data);
    const size_t count = span.size * sizeof(T);
    if (count <= kLittleFill && reinterpret_cast<uintptr_t>(bytes) % sizeof(uint32_t) == 0)
      for_each((count + 3) / 4, gpu::FillBytes{bytes, count, 0x01010101u * static_cast<unsigned char>(byte)});
    else if (count > 0)
      check_cuda(cudaMemsetAsync(bytes, byte, count, stream_), "cudaMemsetAsync");
  }
  void wait() {
    check_cuda(cudaStreamSynchronize(stream_), "cudaStreamSynchronize");
    is_uploading_ = false;
  }

  // ---- a second stream (SecondStream) -----------------------------------------------------------------------------

  void open_second_stream() {
    if (!second_stream_)
      check_cuda(cudaStreamCreateWithPriority(&second_stream_, cudaStreamNonBlocking, kHighestPriority),
                 "cudaStreamCreateWithPriority");
  }
  // What is given from now on goes to the other stream, or to this one again.
  void turn_to_second_stream(bool second) {
    std::swap(stream_, second_stream_);
    counts_.anticipation().turn_aside(second);
  }
  // What the second stream is given from now on comes behind all that this one has.
  void lead_second_stream() { check_cuda(follow(second_stream_, stream_), "cudaStreamWaitEvent"); }
  // The other way round.
  void join_second_stream() {
    counts_.anticipation().join();
    if (follow(stream_, second_stream_) != cudaSuccess) cudaStreamSynchronize(second_stream_);
  }

  // What this is given from now on comes behind all that the other one has, also where that fails.
  void go_behind(CudaExecutor &other) noexcept {
    if (other.follow(stream_, other.stream_) != cudaSuccess) cudaStreamSynchronize(other.stream_);
  }

 private:
  static constexpr int kHighestPriority = -1000;  // the driver takes the highest there is
  static constexpr size_t kStagingBytes = 32768, kMostStaged = size_t(1) << 20;
  static constexpr size_t kLittleFill = size_t(1) << 19, kLittleFetch = size_t(1) << 22;
  static constexpr size_t kDefaultSharedBytes = 48 * 1024;

  // Sums of few chunks: over the bus one by one, which spares a launch.
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

  cudaError_t follow(cudaStream_t behind, cudaStream_t ahead) {
    const cudaError_t error = cudaEventRecord(joined_, ahead);
    return error == cudaSuccess ? cudaStreamWaitEvent(behind, joined_, 0) : error;
  }

  void wait_for_uploads() noexcept {
    if (is_uploading_) cudaEventSynchronize(uploaded_);
    is_uploading_ = false;
  }

  void stop_if_asked() const {
    if (stop_ && stop_->load(std::memory_order_relaxed)) throw Cancelled{};
  }

  // Not by digits: it is rare, and that would be half as much code again in the library.
  template <class Key, class Value>
  cudaError_t sort_pairs(void *temporary, size_t &bytes, Span<Key> keys, Span<Value> values) const {
    return cub::DeviceMergeSort::StableSortPairs(temporary, bytes, keys.data, values.data, static_cast<int>(keys.size),
                                                 gpu::IsLess{}, stream_);
  }

  template <class Load, class T, class Start>
  void scan_all(size_t n, Load load, Span<T> out, Start start) {
    check_count(n + 1, "exclusive_scan");
    const auto in =
        thrust::make_transform_iterator(thrust::counting_iterator<size_t>(0), gpu::LoadOrZero<Load, T>{load, n});
    with_temporary("cub::DeviceScan::ExclusiveScan", [&](void *temporary, size_t &bytes) {
      return cub::DeviceScan::ExclusiveScan(temporary, bytes, in, out.data, gpu::Sum(), start, static_cast<int>(n + 1),
                                            stream_);
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
    const LaunchWatch watch(name, stream_);
    check_cuda(call(temporary, bytes), name);
    arena_.rewind(mark);
  }

  // A kernel that waits for what is queued before it by itself (QueuedItems).
  cudaError_t launch_queued(const void *kernel, size_t blocks, const LaunchShape &shape, void **parameters) {
    cudaLaunchAttribute early{};
    early.id = cudaLaunchAttributeProgrammaticStreamSerialization;
    early.val.programmaticStreamSerializationAllowed = 1;
    cudaLaunchConfig_t config{};
    config.gridDim = dim3(static_cast<unsigned>(blocks));
    config.blockDim = dim3(static_cast<unsigned>(shape.threads));
    config.dynamicSmemBytes = shape.shared_bytes;
    config.stream = stream_;
    config.attrs = &early;
    config.numAttrs = 1;
    return cudaLaunchKernelExC(&config, kernel, parameters);
  }

  void wait_for_launch_before() {
    cudaEvent_t &event = launched_[0];
    if (event) check_cuda(cudaEventSynchronize(event), "cudaEventSynchronize");
    if (!event) check_cuda(cudaEventCreateWithFlags(&event, cudaEventDisableTiming), "cudaEventCreateWithFlags");
    check_cuda(cudaEventRecord(event, stream_), "cudaEventRecord");
    std::swap(launched_[0], launched_[1]);
  }

  // Waits; what it returns is valid until the next call that copies to the host.
  const void *to_staging(const void *source, size_t bytes) {
    void *host = staging_.reserve(bytes);
    // Little comes by a kernel: a copy would wait for those of a mesh that is on its way to the host.
    if (bytes <= kLittleFetch && bytes % sizeof(uint32_t) == 0 && reinterpret_cast<uintptr_t>(source) % 4 == 0)
      for_each(bytes / sizeof(uint32_t),
               gpu::CopyWords{static_cast<uint32_t *>(host), static_cast<const uint32_t *>(source)});
    else
      check_cuda(cudaMemcpyAsync(host, source, bytes, cudaMemcpyDeviceToHost, stream_), "cudaMemcpyAsync");
    wait();
    return host;
  }

  int device_;
  unsigned multiprocessors_ = 0;
  cudaStream_t stream_ = nullptr, second_stream_ = nullptr;
  const std::atomic<bool> *stop_ = nullptr;
  cudaEvent_t launched_[2] = {};  // the next to be used: the launch before last
  PinnedBuffer staging_;
  bool runs_ahead_ = false;
  CudaCounts counts_;
  cudaEvent_t joined_ = nullptr, uploaded_ = nullptr;
  bool is_uploading_ = false;
  Arena<DeviceMemory> arena_;
};

}  // namespace quickses
