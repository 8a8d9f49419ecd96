// SPDX-License-Identifier: MIT
// A CUDA stream, and a second one beside it: kernels in launches that are short on the smallest GPU (cuda_launch.cuh),
// copies, and waiting for them. Beside other computations, kernels of short frames are gathered (gathered_launches.h).
#pragma once

#include "cudart/current_context.h"
#include "parallel/cuda_launch.cuh"
#include "parallel/cuda_memory.h"
#include "parallel/error.h"
#include "parallel/gathered_launches.h"

#include <algorithm>
#include <atomic>
#include <type_traits>
#include <utility>

namespace quickses {

// Use from one thread at a time, with its device selected (DeviceGuard). Functions that fail throw Error.
class CudaQueue {
 public:
  // While it lives, nothing more is asked of the device once the flag is set: Cancelled is thrown instead. However the
  // computation ends, what was to be uploaded is with the device then, and what was lent has been read.
  class RunScope {
   public:
    RunScope(CudaQueue &queue, const std::atomic<bool> &flag) : queue_(queue) {
      queue.stop_ = &flag;
      ++queue.running();
    }
    ~RunScope() {
      --queue_.running();
      queue_.stop_ = nullptr;
      queue_.give_up_gathered();  // of what broke off
      queue_.wait_for_uploads();
    }
    RunScope(const RunScope &) = delete;
    RunScope &operator=(const RunScope &) = delete;

   private:
    CudaQueue &queue_;
  };
  // Held while a computation runs: keeps the device selected.
  struct CallScope {
    explicit CallScope(const CudaQueue &queue) : guard(queue.device_) {}
    DeviceGuard guard;
  };

  // goes_first: its kernels, before those of others.
  CudaQueue(int device, bool goes_first) : CudaQueue(device) {
    const DeviceGuard guard(device);
    int value = 0;
    check_cuda(cudaDeviceGetAttribute(&value, cudaDevAttrMultiProcessorCount, device), "cudaDeviceGetAttribute");
    multiprocessors_ = static_cast<unsigned>(value);
    if (LaunchObserver::current) multiprocessors_ = LaunchObserver::current->multiprocessors(multiprocessors_);
    check_cuda(cudaStreamCreateWithPriority(&stream_, cudaStreamNonBlocking, goes_first ? kHighestPriority : 0),
               "cudaStreamCreateWithPriority");
    for (cudaEvent_t *event : {&joined_, &uploaded_, &end_})
      check_cuda(cudaEventCreateWithFlags(event, cudaEventDisableTiming), "cudaEventCreateWithFlags");
  }
  // Does not wait: what kernels still use must not be given up before wait_for_all().
  ~CudaQueue() {
    try {
      const DeviceGuard guard(device_);
      if (!may_hand_back()) return;
      gathered_.release();
      for (cudaEvent_t event : {launched_[0], launched_[1], joined_, uploaded_, end_})
        if (event) cudaEventDestroy(event);
      for (cudaStream_t stream : {stream_, second_stream_})
        if (stream) cudaStreamDestroy(stream);
      cudaGetLastError();
    } catch (...) {  // the device is lost
    }
  }
  CudaQueue(const CudaQueue &) = delete;
  CudaQueue &operator=(const CudaQueue &) = delete;

  int device() const { return device_; }
  unsigned multiprocessors() const { return multiprocessors_; }
  // To give it something else than kernels: behind those that are gathered.
  cudaStream_t stream() {
    hand_over();
    return stream_;
  }
  cudaStream_t stream_handle() const { return stream_; }  // to be told, or behind hand_over()
  uint64_t graphs() const { return gathered_.graphs(); }  // how often kernels were handed over as one

  // How many items a launch is given, and how many launches that makes. Known before anything is launched.
  size_t items_per_launch(const LaunchShape &shape) const { return most_items_of_launch(shape, multiprocessors_); }
  size_t launches_of(size_t items, const LaunchShape &shape) const {
    const size_t most = items_per_launch(shape);
    return items / most + (items % most > 0 ? 1 : 0);
  }

  // So few that to know more about the items is not worth a wait.
  bool is_few_launches(size_t items, const LaunchShape &shape) const { return launches_of(items, shape) <= 4; }

  // A kernel on this stream, for all items, in as many launches as that takes: kernel(QueuedItems, arguments...). Of
  // several, no more than two are queued at a time, since what is queued can't be cancelled; but in a frame that is
  // known to be short. No items: nothing to do.
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
      const GatheredLaunches::Launch one{name,
                                         reinterpret_cast<const void *>(kernel),
                                         static_cast<unsigned>(blocks),
                                         static_cast<unsigned>(shape.threads),
                                         shape.shared_bytes,
                                         parameters};
      if (gathers()) {
        gathered_.add(one, queued, arguments...);
        if (gathered_.is_full()) hand_over();
        continue;
      }
      hand_over();
      launch_queued(one);
      if (launches > 1 && !runs_ahead_) wait_for_launch_before();
    }
  }

  // A frame begins: whether all of it may be queued, since it is known to be short; and whether its kernels may be
  // gathered then, since they are those of frames before. Of one that broke off, nothing more is asked for: its memory
  // may be others' by now.
  void run_ahead(bool runs_ahead, bool may_gather) {
    give_up_gathered();
    has_end_ = false;
    runs_ahead_ = runs_ahead;
    may_gather_ = runs_ahead && may_gather;
  }
  // Whether something that was gathered has been given up since this was last asked.
  bool has_given_up() { return std::exchange(has_given_up_, false); }
  bool runs_ahead() const { return runs_ahead_; }

  // What is gathered begins. Whatever else the stream is given, or the host waits for, does that as well.
  void hand_over() {
    if (gathered_.empty()) return;
    const bool had_given_up = std::exchange(has_given_up_, true);  // unless all of it begins
    gathered_.hand_over(stream_, [&](const auto &one) { launch_queued(one); });
    has_given_up_ = had_given_up;
  }

  // Between parts of a long work: waits for the part before the last one, so that little is queued that can't be
  // cancelled. In a frame that is known to be short nothing waits.
  void keep_pace() {
    if (!runs_ahead_) wait_for_launch_before();
  }

  // From page-locked memory the copy goes on after the call returns: leave the memory alone until something waits.
  template <class T>
  void upload(T *destination, const T *host, size_t n) {
    if (n == 0) return;
    is_uploading_ = true;
    check_cuda(cudaMemcpyAsync(destination, host, n * sizeof(T), cudaMemcpyHostToDevice, stream()), "cudaMemcpyAsync");
    check_cuda(cudaEventRecord(uploaded_, stream_), "cudaEventRecord");
  }
  // Page-locked memory that kernels read where it is, without waiting for a copy. Leave it alone as after upload().
  template <class T>
  const T *lend(const T *host) noexcept {
    is_lent_ = true;
    return host;
  }
  // Those asked for so far are all that read it. Whoever breaks off waits for them then; in a frame that is known to be
  // short, for all of it, since an event would keep kernels from being sent ahead.
  void end_lending() {
    if (!is_lent_ || runs_ahead_) return;
    check_cuda(cudaEventRecord(uploaded_, stream()), "cudaEventRecord");
    is_lent_ = false;
    is_uploading_ = true;
  }
  // Into page-locked memory the values are there after the next wait.
  template <class T>
  void download(T *host, const T *source, size_t n) {
    if (n == 0) return;
    check_cuda(cudaMemcpyAsync(host, source, n * sizeof(T), cudaMemcpyDeviceToHost, stream()), "cudaMemcpyAsync");
  }
  void wait() {
    if (std::exchange(has_end_, false))
      check_cuda(cudaEventSynchronize(end_), "cudaEventSynchronize");
    else
      check_cuda(cudaStreamSynchronize(stream()), "cudaStreamSynchronize");
    is_uploading_ = is_lent_ = false;
  }
  // The next wait() is not for what is asked for from now on.
  void end_wait_here() {
    check_cuda(cudaEventRecord(end_, stream()), "cudaEventRecord");
    has_end_ = true;
  }

  // ---- a second stream (SecondStream) -----------------------------------------------------------------------------

  void open_second_stream() {
    if (!second_stream_)
      check_cuda(cudaStreamCreateWithPriority(&second_stream_, cudaStreamNonBlocking, kHighestPriority),
                 "cudaStreamCreateWithPriority");
  }
  // What is given from now on goes to the other stream, or to this one again.
  // (Hand over before: what is still gathered is given up.)
  void turn_streams() noexcept {
    give_up_gathered();
    std::swap(stream_, second_stream_);
  }
  // What the second stream is given from now on comes behind all that this one has.
  void lead_second_stream() { check_cuda(follow(second_stream_, stream()), "cudaStreamWaitEvent"); }
  // The other way round.
  void join_second_stream() {
    if (follow(stream_, second_stream_) != cudaSuccess) cudaStreamSynchronize(second_stream_);
  }

  // What this is given from now on comes behind all that the other one has.
  void go_behind(CudaQueue &other) {
    hand_over();
    other.hand_over();
    follow_end_of(other);
  }
  // The same where the other one is given nothing more, and what it has only gathered is given up.
  void follow_end_of(CudaQueue &other) noexcept {
    if (other.follow(stream_, other.stream_) != cudaSuccess) cudaStreamSynchronize(other.stream_);
  }

 protected:
  // Whatever it has been given. Failures are ignored.
  void wait_for_all() noexcept {
    for (cudaStream_t stream : {stream_, second_stream_})
      if (stream) cudaStreamSynchronize(stream);
  }
  void stop_if_asked() const {
    if (stop_ && stop_->load(std::memory_order_relaxed)) throw Cancelled{};
  }

 private:
  explicit CudaQueue(int device) : device_(device) {}  // so that whatever is made after it is given back

  static constexpr int kHighestPriority = -1000;  // the driver takes the highest there is

  cudaError_t follow(cudaStream_t behind, cudaStream_t ahead) {
    const cudaError_t error = cudaEventRecord(joined_, ahead);
    return error == cudaSuccess ? cudaStreamWaitEvent(behind, joined_, 0) : error;
  }

  void wait_for_uploads() noexcept {
    if (is_lent_)
      cudaStreamSynchronize(stream_);
    else if (is_uploading_)
      cudaEventSynchronize(uploaded_);
    is_uploading_ = is_lent_ = false;
  }

  // Computations under way on the device.
  std::atomic<int> &running() const {
    static std::atomic<int> of_devices[cudart::kMostDevices];
    return of_devices[device_];
  }
  // Alone, each kernel is asked for at once, so that the GPU begins with the first; beside other computations, also the
  // other levels of a ladder, it has enough to do, and the host is what it waits for.
  bool gathers() const {
    return may_gather_ && !LaunchObserver::current && running().load(std::memory_order_relaxed) > 1;
  }
  void give_up_gathered() noexcept { has_given_up_ |= gathered_.drop(); }

  // A kernel that waits for what is queued before it by itself (QueuedItems).
  void launch_queued(const GatheredLaunches::Launch &launch) {
    cudaLaunchAttribute early{};
    early.id = cudaLaunchAttributeProgrammaticStreamSerialization;
    early.val.programmaticStreamSerializationAllowed = 1;
    cudaLaunchConfig_t config{};
    config.gridDim = dim3(launch.blocks);
    config.blockDim = dim3(launch.threads);
    config.dynamicSmemBytes = launch.shared_bytes;
    config.stream = stream_;
    config.attrs = &early;
    config.numAttrs = 1;
    check_cuda(cudaLaunchKernelExC(&config, launch.kernel, launch.arguments), launch.name);
  }

  void wait_for_launch_before() {
    cudaEvent_t &event = launched_[0];
    if (event) check_cuda(cudaEventSynchronize(event), "cudaEventSynchronize");
    if (!event) check_cuda(cudaEventCreateWithFlags(&event, cudaEventDisableTiming), "cudaEventCreateWithFlags");
    check_cuda(cudaEventRecord(event, stream()), "cudaEventRecord");
    std::swap(launched_[0], launched_[1]);
  }

  int device_;
  unsigned multiprocessors_ = 0;
  GatheredLaunches gathered_;  // for the stream
  cudaStream_t stream_ = nullptr, second_stream_ = nullptr;
  const std::atomic<bool> *stop_ = nullptr;
  cudaEvent_t launched_[2] = {};  // the next to be used: the launch before last
  cudaEvent_t joined_ = nullptr, uploaded_ = nullptr, end_ = nullptr;
  bool runs_ahead_ = false, may_gather_ = false, has_given_up_ = false, is_uploading_ = false, is_lent_ = false,
       has_end_ = false;
};

}  // namespace quickses
