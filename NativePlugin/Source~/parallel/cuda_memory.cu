// SPDX-License-Identifier: MIT
// CUDA devices and their memory.
#include "parallel/cuda_memory.h"

#include "cudart/current_context.h"
#include "parallel/arena.h"
#include "parallel/cuda_preparation.h"
#include "parallel/error.h"
#include "process/touched_pages.h"

#include <cuda_runtime.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <new>
#include <set>

namespace quickses {
namespace {

std::atomic<uint64_t> device_requests{0}, pinned_requests{0};

// Tells whether the library carries code for a device.
__global__ void probe_kernel() {}

std::string describe_error(cudaError_t error) {
  return std::string(cudaGetErrorString(error)) + " (" + cudaGetErrorName(error) + ")";
}

// The errors that CUDA does not recover from: memory or links that failed, and what a kernel did wrong. Of the latter
// its manual says (cudaError_t) that they leave the process in an inconsistent state, in which any further work with
// CUDA returns the same error until the process ends. After a cudaDeviceReset by others the process might go on, but
// not with what we have there: to hand it back to the driver ends in a segmentation fault.
bool is_sticky(cudaError_t error) {
  constexpr int kContained = 226;  // cudaErrorContained, of CUDA 12.8 and later: by the hardware, or a peer's
  switch (static_cast<int>(error)) {
    case kContained:
    case cudaErrorECCUncorrectable:
    case cudaErrorNvlinkUncorrectable:
    case cudaErrorIllegalAddress:
    case cudaErrorLaunchTimeout:
    case cudaErrorAssert:
    case cudaErrorHardwareStackError:
    case cudaErrorIllegalInstruction:
    case cudaErrorMisalignedAddress:
    case cudaErrorInvalidAddressSpace:
    case cudaErrorInvalidPc:
    case cudaErrorLaunchFailure:
    case cudaErrorContextIsDestroyed:
    case cudaErrorMpsClientTerminated:
    case cudaErrorExternalDevice:
      return true;
    default:
      return false;
  }
}

// An unknown error may be one of a single call. Windows' drivers report it of all calls where the GPU was reset; then
// it is one of those.
bool is_of_lost_device(cudaError_t error) {
  if (error != cudaErrorUnknown) return is_sticky(error);
  size_t free = 0, total = 0;
  const bool is_lost = cudaMemGetInfo(&free, &total) == cudaErrorUnknown;
  cudaGetLastError();
  return is_lost;
}

// The first such error of the process. The sentence is written before the flag is set, and never again.
struct Fault {
  std::atomic<bool> is_there{false};
  std::mutex mutex;
  std::string sentence;

  void remember(cudaError_t error, const char *call) {
    const std::lock_guard<std::mutex> lock(mutex);
    if (is_there) return;
    sentence = std::string("the GPU met a fault that CUDA does not recover from before the process ends: ") +
               describe_error(error) + ", reported by " + call;
    is_there = true;
  }
};

Fault &fault() {
  static Fault &the_fault = *new Fault;  // never destroyed: contexts may be as late as the process ends
  return the_fault;
}

CudaPreparations &preparations() {
  static CudaPreparations &all = *new CudaPreparations;  // never destroyed, as the fault
  return all;
}

// Whether memory was given. After a fault, which any call may be the first to report, less would not do either.
bool was_granted(cudaError_t error, const char *call) {
  if (error == cudaSuccess) return true;
  if (is_of_lost_device(error)) check_cuda(error, call);
  cudaGetLastError();
  return false;
}

// Memory is also given back by threads that have no context. The one that CUDA gives them for it must not stay.
void give_back(void *memory, cudaError_t(CUDARTAPI *free)(void *)) {
  if (!memory) return;
  CUcontext before = nullptr;
  const bool has_none = cudart::driver().cuCtxGetCurrent(&before) == CUDA_SUCCESS && !before;
  if (may_hand_back() && free(memory) != cudaSuccess) cudaGetLastError();
  if (has_none) cudart::driver().cuCtxSetCurrent(nullptr);
}

std::string reason_for_none(cudaError_t error) {
  if (error == cudaErrorNoDevice) return "no CUDA device is present, or none is visible to this process";
  if (error == cudaErrorInsufficientDriver) return cudaGetErrorString(error);
  return "the NVIDIA driver does not start: " + describe_error(error);
}

// What is known of a device without a context on it.
cudaError_t describe_hardware(int ordinal, CudaDevice *device, int *major, int *minor) {
  const cudart::Driver &driver = cudart::driver();
  CUdevice handle = 0;
  char name[256] = "";
  size_t total = 0;
  CUresult result = driver.cuDeviceGet(&handle, ordinal);
  if (result == CUDA_SUCCESS) result = driver.cuDeviceGetName(name, sizeof name, handle);
  if (result == CUDA_SUCCESS) result = driver.cuDeviceTotalMem_v2(&total, handle);
  if (result != CUDA_SUCCESS) return static_cast<cudaError_t>(result);
  device->name = name;
  device->total_memory = total;
  const cudaError_t error = cudaDeviceGetAttribute(major, cudaDevAttrComputeCapabilityMajor, ordinal);
  return error == cudaSuccess ? cudaDeviceGetAttribute(minor, cudaDevAttrComputeCapabilityMinor, ordinal) : error;
}

}  // namespace

void check_cuda(int error, const char *call) {
  const cudaError_t e = static_cast<cudaError_t>(error);
  if (e == cudaSuccess) return;
  cudaGetLastError();
  if (is_of_lost_device(e)) fault().remember(e, call);
  refuse_after_fault();
  const std::string message = std::string(call) + " failed: " + describe_error(e);
  if (e == cudaErrorMemoryAllocation) throw MemoryRefused(message);
  throw Error(QSES_DEVICE_ERROR, message);
}

bool may_hand_back() {
  if (fault().is_there) return false;
  size_t free = 0, total = 0;
  cudaError_t error = static_cast<cudaError_t>(cudart::look_for_resets());
  if (error == cudaSuccess) error = cudaMemGetInfo(&free, &total);
  if (error == cudaSuccess) return true;
  cudaGetLastError();
  const bool is_lost = is_of_lost_device(error);
  if (is_lost) fault().remember(error, "the look at the device");
  return !is_lost;
}

void refuse_after_fault() {
  if (fault().is_there) throw Error(QSES_DEVICE_ERROR, fault().sentence);
}

CudaDevice describe_cuda_device(int ordinal) {
  CudaDevice device;
  if (fault().is_there) {
    device.reason = fault().sentence;
    return device;
  }
  if (preparations().is_preparing(ordinal, &device)) return device;
  int count = 0;
  cudaError_t error = cudaGetDeviceCount(&count);
  if (error != cudaSuccess || count == 0) {
    cudaGetLastError();
    device.reason = reason_for_none(error == cudaSuccess ? cudaErrorNoDevice : error);
    return device;
  }
  if (ordinal < 0 || ordinal >= count) {
    device.reason =
        "there is no CUDA device " + std::to_string(ordinal) + ": the last one is " + std::to_string(count - 1);
    return device;
  }
  int major = 0, minor = 0;
  error = describe_hardware(ordinal, &device, &major, &minor);
  if (error == cudaSuccess) {
    try {
      const DeviceGuard guard(ordinal);
      cudaFuncAttributes attributes{};
      error = cudaFuncGetAttributes(&attributes, probe_kernel);
      if (error == cudaSuccess) {
        size_t free = 0, total = 0;
        error = cudaMemGetInfo(&free, &total);
        device.free_memory = free;
      }
    } catch (const Error &e) {
      device.reason = e.what();
      return device;
    }
  }
  device.available = error == cudaSuccess;
  if (device.available) {
    preparations().remember(ordinal, device);
    return device;
  }
  cudaGetLastError();
  if (is_of_lost_device(error)) {
    fault().remember(error, "the look at the device");
    device.reason = fault().sentence;
    return device;
  }
  if (error == cudaErrorNoKernelImageForDevice || error == cudaErrorInvalidDeviceFunction ||
      error == cudaErrorUnsupportedPtxVersion)
    device.reason = device.name + " (compute capability " + std::to_string(major) + "." + std::to_string(minor) +
                    ") is not among the GPUs this library was built for";
  else
    device.reason = "the GPU does not answer: " + describe_error(error);
  return device;
}

void load_cuda_kernels(int device, const void *kernel) {
  preparations().prepare(device, [&] {
    const DeviceGuard guard(device);
    cudaFuncAttributes attributes{};
    check_cuda(cudaFuncGetAttributes(&attributes, kernel), "cudaFuncGetAttributes");
  });
}

int count_cuda_devices() {
  int count = 0;
  if (cudaGetDeviceCount(&count) == cudaSuccess) return count;
  cudaGetLastError();
  return 0;
}

DeviceGuard::DeviceGuard(int device) {
  refuse_after_fault();
  CUcontext before = nullptr;
  check_cuda(cudart::start(), "cuInit");
  check_cuda(cudart::driver().cuCtxGetCurrent(&before), "cuCtxGetCurrent");
  before_ = before;
  check_cuda(cudaSetDevice(device), "cudaSetDevice");
}

DeviceGuard::~DeviceGuard() { cudart::driver().cuCtxSetCurrent(static_cast<CUcontext>(before_)); }

StreamMark::StreamMark(int device) : device_(device) {
  const DeviceGuard guard(device);
  cudaEvent_t event = nullptr;
  check_cuda(cudaEventCreateWithFlags(&event, cudaEventDisableTiming), "cudaEventCreateWithFlags");
  event_ = event;
}

StreamMark::~StreamMark() {
  try {
    const DeviceGuard guard(device_);
    if (may_hand_back()) cudaEventDestroy(static_cast<cudaEvent_t>(event_));
  } catch (...) {  // the device is lost
  }
}

void StreamMark::set(void *stream) {
  check_cuda(cudaEventRecord(static_cast<cudaEvent_t>(event_), static_cast<cudaStream_t>(stream)), "cudaEventRecord");
}

void StreamMark::hold_back(void *stream) const {
  check_cuda(cudaStreamWaitEvent(static_cast<cudaStream_t>(stream), static_cast<cudaEvent_t>(event_), 0),
             "cudaStreamWaitEvent");
}

void StreamMark::wait() const noexcept {
  try {
    const DeviceGuard guard(device_);
    check_cuda(cudaEventSynchronize(static_cast<cudaEvent_t>(event_)), "cudaEventSynchronize");
  } catch (...) {
  }
}

void copy_to_host(int device, void *to, const void *from, size_t bytes) {
  const DeviceGuard guard(device);
  cudaStream_t stream = nullptr;
  check_cuda(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "cudaStreamCreateWithFlags");
  cudaError_t error = cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, stream);
  if (error == cudaSuccess) error = cudaStreamSynchronize(stream);
  cudaStreamDestroy(stream);
  check_cuda(error, "cudaMemcpyAsync");
}

CudaMemoryRequests cuda_memory_requests() { return {device_requests, pinned_requests}; }

uint64_t DeviceMemory::free_bytes() {
  // Code is loaded when a kernel first runs, and kernels have stacks: some 10 MiB. The rest is left to others.
  constexpr uint64_t kLeft = uint64_t(64) << 20;
  size_t free = 0, total = 0;
  if (!was_granted(cudaMemGetInfo(&free, &total), "cudaMemGetInfo")) return 0;
  return std::max<uint64_t>(1, free - std::min<uint64_t>(free, std::max<uint64_t>(free / 16, kLeft)));
}

void *DeviceMemory::acquire(size_t bytes) {
  ++device_requests;
#if defined(_WIN32)
  // Where the GPU has no more, Windows' drivers give of the host's memory instead (NVIDIA calls it system memory
  // fallback), with which all would be slow.
  size_t free = 0, total = 0;
  check_cuda(cudaMemGetInfo(&free, &total), "cudaMemGetInfo");
  if (bytes > free) return nullptr;
#endif
  void *memory = nullptr;
  const cudaError_t error = cudaMalloc(&memory, bytes);
  if (error != cudaErrorMemoryAllocation) check_cuda(error, "cudaMalloc");
  return was_granted(error, "cudaMalloc") ? memory : nullptr;
}

void DeviceMemory::release(void *memory) { give_back(memory, cudaFree); }

namespace {

// Pages that were touched first and locked then, which for many of them takes a fifth of what cudaHostAlloc does. They
// are ours: a mesh there can still be read when other code has reset the device, which takes away what CUDA gave.
class LockedPages {
 public:
  // Null where that can't be had: then it is for cudaHostAlloc to say why.
  void *acquire(size_t bytes) {
    void *const memory = can_lock() ? TouchedPages::acquire(bytes) : nullptr;
    if (!memory) return nullptr;
    if (note(memory)) {
      if (lock(memory, bytes)) return memory;
      forget(memory);
    }
    TouchedPages::release(memory);
    return nullptr;
  }
  // False: it is none of these.
  bool release(void *memory) {
    if (!forget(memory)) return false;
    give_back(memory, [](void *pages) {
      const cudaError_t error = cudaHostUnregister(pages);
      if (error == cudaSuccess) TouchedPages::release(pages);
      return error;
    });
    return true;
  }

 private:
  // Kernels write there by the address that the host has, for which Windows' drivers (WDDM) have no way.
  static bool can_lock() {
    int device = 0, can = 0;
    return was_granted(cudaGetDevice(&device), "cudaGetDevice") &&
           was_granted(cudaDeviceGetAttribute(&can, cudaDevAttrCanUseHostPointerForRegisteredMem, device),
                       "cudaDeviceGetAttribute") &&
           can != 0;
  }
  static bool lock(void *memory, size_t bytes) {
    if (!was_granted(cudaHostRegister(memory, bytes, cudaHostRegisterPortable), "cudaHostRegister")) return false;
    void *on_device = nullptr;
    if (was_granted(cudaHostGetDevicePointer(&on_device, memory, 0), "cudaHostGetDevicePointer") && on_device == memory)
      return true;
    cudaHostUnregister(memory);
    return false;
  }
  bool note(void *memory) {
    try {
      const std::lock_guard<std::mutex> guard(mutex_);
      return known_.insert(memory).second;
    } catch (const std::bad_alloc &) {
      return false;
    }
  }
  bool forget(void *memory) {
    const std::lock_guard<std::mutex> guard(mutex_);
    return known_.erase(memory) > 0;
  }

  std::mutex mutex_;
  std::set<void *> known_;
};
// Lives as long as the process: threads give memory back until the end.
LockedPages &locked_pages() {
  static LockedPages &pages = *new LockedPages;
  return pages;
}

}  // namespace

void *PinnedMemory::acquire(size_t bytes) {
  ++pinned_requests;
  if (void *const memory = locked_pages().acquire(bytes)) return memory;
  void *memory = nullptr;
  return was_granted(cudaHostAlloc(&memory, bytes, cudaHostAllocPortable), "cudaHostAlloc") ? memory : nullptr;
}

void PinnedMemory::release(void *memory) {
  if (!locked_pages().release(memory)) give_back(memory, cudaFreeHost);
}

}  // namespace quickses
