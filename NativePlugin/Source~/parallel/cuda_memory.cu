// SPDX-License-Identifier: MIT
// CUDA devices and their memory.
#include "parallel/cuda_memory.h"

#include "parallel/arena.h"
#include "parallel/error.h"

#include <cuda_runtime.h>

#include <algorithm>
#include <atomic>

namespace quickses {
namespace {

std::atomic<uint64_t> device_requests{0}, pinned_requests{0};

// Tells whether the library carries code for a device.
__global__ void probe_kernel() {}

std::string describe_error(cudaError_t error) {
  return std::string(cudaGetErrorString(error)) + " (" + cudaGetErrorName(error) + ")";
}

std::string version_text(int version) {
  return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

std::string reason_for_none(cudaError_t error) {
  if (error == cudaErrorNoDevice) return "no CUDA device is present, or none is visible to this process";
  int driver = 0, runtime = 0;
  cudaDriverGetVersion(&driver);
  cudaRuntimeGetVersion(&runtime);
  if (driver == 0) return "no NVIDIA driver is installed";
  if (error == cudaErrorInsufficientDriver)
    return "the NVIDIA driver serves CUDA " + version_text(driver) + ", but this library needs " +
           version_text(runtime) + ": update the driver";
  return "the CUDA runtime does not start: " + describe_error(error);
}

}  // namespace

void check_cuda(int error, const char *call) {
  const cudaError_t e = static_cast<cudaError_t>(error);
  if (e == cudaSuccess) return;
  cudaGetLastError();
  const std::string message = std::string(call) + " failed: " + describe_error(e);
  if (e == cudaErrorMemoryAllocation) throw MemoryRefused(message);
  throw Error(QSES_DEVICE_ERROR, message);
}

CudaDevice describe_cuda_device(int ordinal) {
  CudaDevice device;
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
  cudaDeviceProp properties{};
  error = cudaGetDeviceProperties(&properties, ordinal);
  if (error == cudaSuccess) {
    device.name = properties.name;
    device.total_memory = properties.totalGlobalMem;
    device.multiprocessors = properties.multiProcessorCount;
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
  if (device.available) return device;
  cudaGetLastError();
  if (error == cudaErrorNoKernelImageForDevice || error == cudaErrorInvalidDeviceFunction ||
      error == cudaErrorUnsupportedPtxVersion)
    device.reason = device.name + " (compute capability " + std::to_string(properties.major) + "." +
                    std::to_string(properties.minor) + ") is not among the GPUs this library was built for";
  else
    device.reason = "the GPU does not answer: " + describe_error(error);
  return device;
}

int count_cuda_devices() {
  int count = 0;
  if (cudaGetDeviceCount(&count) == cudaSuccess) return count;
  cudaGetLastError();
  return 0;
}

DeviceGuard::DeviceGuard(int device) : before_(device), device_(device) {
  check_cuda(cudaGetDevice(&before_), "cudaGetDevice");
  // Selected even if it was before: on a thread that has not used CUDA yet this makes the device current.
  check_cuda(cudaSetDevice(device_), "cudaSetDevice");
}

DeviceGuard::~DeviceGuard() {
  if (before_ != device_ && cudaSetDevice(before_) != cudaSuccess) cudaGetLastError();
}

CudaMemoryRequests cuda_memory_requests() { return {device_requests, pinned_requests}; }

uint64_t DeviceMemory::free_bytes() {
  // Code is loaded when a kernel first runs, and kernels have stacks: some 10 MiB. The rest is left to others.
  constexpr uint64_t kLeft = uint64_t(64) << 20;
  size_t free = 0, total = 0;
  if (cudaMemGetInfo(&free, &total) != cudaSuccess) {
    cudaGetLastError();
    return 0;
  }
  return std::max<uint64_t>(1, free - std::min<uint64_t>(free, std::max<uint64_t>(free / 16, kLeft)));
}

void *DeviceMemory::acquire(size_t bytes) {
  ++device_requests;
  void *memory = nullptr;
  if (cudaMalloc(&memory, bytes) == cudaSuccess) return memory;
  cudaGetLastError();
  return nullptr;
}

void DeviceMemory::release(void *memory) {
  if (cudaFree(memory) != cudaSuccess) cudaGetLastError();
}

void *PinnedMemory::acquire(size_t bytes) {
  ++pinned_requests;
  void *memory = nullptr;
  if (cudaHostAlloc(&memory, bytes, cudaHostAllocPortable) == cudaSuccess) return memory;
  cudaGetLastError();
  return nullptr;
}

void PinnedMemory::release(void *memory) {
  if (cudaFreeHost(memory) != cudaSuccess) cudaGetLastError();
}

}  // namespace quickses
