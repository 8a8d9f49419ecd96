// SPDX-License-Identifier: MIT
// CUDA devices and their memory, for code that does not see CUDA's own headers.
#pragma once

#include "parallel/growing_buffer.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace quickses {

// Throws if a CUDA call failed: MemoryRefused where memory was (a launch takes some for the kernel's stack), else Error
// with QSES_DEVICE_ERROR and the call's name. error is a cudaError_t. The runtime's record of the failure is cleared. A
// fault that CUDA does not recover from is remembered for as long as the process lives.
void check_cuda(int error, const char *call);

// Throws Error (QSES_DEVICE_ERROR) from the first such fault on, with what it was: nothing more is asked of CUDA then.
void refuse_after_fault();

// Whether what is on the thread's device may be handed back to the driver: after a fault it is lost, and the driver may
// crash. Asks the driver, since destructors may be the first to meet one. Never throws.
bool may_hand_back();

struct CudaDevice {
  bool available = false, preparing = false;   // preparing: its kernels are being loaded (cuda_preparation.h)
  std::string reason;                          // why not, if it is not available; what is done while it is prepared
  std::string name;                            // empty if there is no such device
  uint64_t total_memory = 0, free_memory = 0;  // bytes
};

// Looks whether this library's kernels can run on a device. Never throws; leaves the selected device as it was. The
// first call starts CUDA; none waits for load_cuda_kernels.
CudaDevice describe_cuda_device(int ordinal);

// Brings onto a device the kernels that were compiled together with this one, as far as that was not done before, which
// may take a minute. Throws Error.
void load_cuda_kernels(int device, const void *kernel);

// 0 where CUDA does not start. Never throws.
int count_cuda_devices();

// Selects a device for the calling thread, and when it goes the context that was current before: also one that is no
// runtime's. Throws Error; after a fault always.
class DeviceGuard {
 public:
  explicit DeviceGuard(int device);
  ~DeviceGuard();
  DeviceGuard(const DeviceGuard &) = delete;
  DeviceGuard &operator=(const DeviceGuard &) = delete;

 private:
  void *before_ = nullptr;  // CUcontext
};

// What a stream had been given when the mark was set. Streams are cudaStream_t. What may fail throws Error.
class StreamMark {
 public:
  explicit StreamMark(int device);
  ~StreamMark();
  StreamMark(const StreamMark &) = delete;
  StreamMark &operator=(const StreamMark &) = delete;

  void set(void *stream);
  // What the stream is given from now on is done after that. Nobody waits on the CPU.
  void hold_back(void *stream) const;
  // Until it is done, or the device is lost.
  void wait() const noexcept;

 private:
  const int device_;
  void *event_ = nullptr;  // cudaEvent_t
};

// Copies from memory of a device and waits for it, beside what its streams do. Throws Error.
void copy_to_host(int device, void *to, const void *from, size_t bytes);

// Sources for Arena.
struct DeviceMemory {
  static constexpr const char *kName = "the GPU";
  static constexpr bool kTakenUntouched = true;
  static uint64_t free_bytes();  // of the selected device; what kernels need at their first launch is left to them
  static void *acquire(size_t bytes);
  static void release(void *memory);
};
struct PinnedMemory {
  static constexpr const char *kName = "the machine (page-locked memory)";
  static uint64_t free_bytes() { return 0; }
  static void *acquire(size_t bytes);
  static void release(void *memory);
};

// How often this process has asked for memory through the two sources so far.
struct CudaMemoryRequests {
  uint64_t device, pinned;
};
CudaMemoryRequests cuda_memory_requests();

// Page-locked host memory, which the GPU reads and writes at the same address.
using PinnedBuffer = GrowingBuffer<PinnedMemory>;

}  // namespace quickses
