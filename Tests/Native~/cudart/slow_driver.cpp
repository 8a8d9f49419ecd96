// SPDX-License-Identifier: MIT
// Stands in for libcuda.so.1: a driver with one GPU, which compiles device code until it is told to go on. Nothing is
// computed.
#include "cudart/driver.h"

#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <mutex>

namespace {

std::mutex mutex;
std::condition_variable changed;
int modules = 0;
bool is_compiling = false, may_go_on = false;
thread_local CUcontext current = nullptr;
char something;

}  // namespace

extern "C" {

// Waits until the driver compiles.
void slow_driver_wait() {
  std::unique_lock<std::mutex> lock(mutex);
  changed.wait(lock, [] { return is_compiling; });
}
void slow_driver_go_on() {
  const std::lock_guard<std::mutex> lock(mutex);
  may_go_on = true;
  changed.notify_all();
}

// The first module is small: what looks whether the library has code for the GPU.
CUresult cuModuleLoadData(CUmodule *module, const void *) {
  std::unique_lock<std::mutex> lock(mutex);
  *module = reinterpret_cast<CUmodule>(&something);
  if (++modules == 1) return CUDA_SUCCESS;
  is_compiling = true;
  changed.notify_all();
  changed.wait(lock, [] { return may_go_on; });
  is_compiling = false;
  return CUDA_SUCCESS;
}

CUresult cuDriverGetVersion(int *version) { return *version = CUDA_VERSION, CUDA_SUCCESS; }
CUresult cuInit(unsigned) { return CUDA_SUCCESS; }
CUresult cuDeviceGetCount(int *count) { return *count = 1, CUDA_SUCCESS; }
CUresult cuDeviceGet(CUdevice *device, int) { return *device = 0, CUDA_SUCCESS; }
CUresult cuDeviceGetName(char *name, int, CUdevice) { return std::strcpy(name, "Slow GPU"), CUDA_SUCCESS; }
CUresult cuDeviceGetAttribute(int *value, CUdevice_attribute, CUdevice) { return *value = 9, CUDA_SUCCESS; }
CUresult cuDeviceTotalMem_v2(size_t *bytes, CUdevice) { return *bytes = size_t(1) << 30, CUDA_SUCCESS; }
CUresult cuDevicePrimaryCtxRetain(CUcontext *context, CUdevice) {
  return *context = reinterpret_cast<CUcontext>(&something), CUDA_SUCCESS;
}
CUresult cuCtxGetCurrent(CUcontext *context) { return *context = current, CUDA_SUCCESS; }
CUresult cuCtxSetCurrent(CUcontext context) { return current = context, CUDA_SUCCESS; }
CUresult cuModuleGetFunction(CUfunction *function, CUmodule, const char *) {
  return *function = reinterpret_cast<CUfunction>(&something), CUDA_SUCCESS;
}
CUresult cuMemGetInfo_v2(size_t *free, size_t *total) { return *free = *total = size_t(1) << 30, CUDA_SUCCESS; }
CUresult cuMemHostAlloc(void **memory, size_t bytes, unsigned) { return *memory = std::calloc(bytes, 1), CUDA_SUCCESS; }
CUresult cuMemFreeHost(void *memory) { return std::free(memory), CUDA_SUCCESS; }

// What else the library asks for does nothing. (cuda.h declares them, so here they have other names.)
#define NOTHING(name)           \
  int slow_##name() asm(#name); \
  int slow_##name() { return 0; }
NOTHING(cuGetErrorName)
NOTHING(cuGetErrorString)
NOTHING(cuCtxGetDevice)
NOTHING(cuFuncGetAttribute)
NOTHING(cuFuncSetAttribute)
NOTHING(cuOccupancyMaxActiveBlocksPerMultiprocessorWithFlags)
NOTHING(cuLaunchKernel)
NOTHING(cuMemAlloc_v2)
NOTHING(cuMemFree_v2)
NOTHING(cuMemcpyHtoDAsync_v2)
NOTHING(cuMemcpyDtoHAsync_v2)
NOTHING(cuMemcpyDtoDAsync_v2)
NOTHING(cuMemsetD8Async)
NOTHING(cuStreamCreate)
NOTHING(cuStreamDestroy_v2)
NOTHING(cuStreamSynchronize)
NOTHING(cuEventCreate)
NOTHING(cuEventDestroy_v2)
NOTHING(cuEventRecord)
NOTHING(cuEventSynchronize)
NOTHING(cuEventElapsedTime)

}  // extern "C"
