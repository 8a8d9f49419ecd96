// SPDX-License-Identifier: MIT
// A stand-in for NVIDIA's driver library, with every function that cudart/ asks for. Its GPU has host memory, and its
// kernels do nothing. FAKE_VERSION: of CUDA, as cuDriverGetVersion counts; 0: it fails as cuInit. FAKE_START: what
// cuInit returns. FAKE_DEVICES: how many GPUs, else one. To leave a function out, rename it by a macro
// (-DcuMemAlloc_v2=left_out).
#include "cudart/driver.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <mutex>

#if !defined(FAKE_DEVICES)
#define FAKE_DEVICES 1
#endif

#if defined(_WIN32)
#define FAKE_API extern "C" __declspec(dllexport)
#else
#define FAKE_API extern "C" __attribute__((visibility("default")))
#endif

namespace {

std::atomic<int> calls{0}, good_calls{-1}, failure{0};
thread_local CUcontext current = nullptr;
int contexts[FAKE_DEVICES], the_module, the_function;
std::atomic<int> retained[FAKE_DEVICES];

// Of cuModuleLoadData.
std::mutex mutex;
std::condition_variable changed;
bool is_held = false, is_compiling = false;

// What any function returns: the failure from one call on, for all the calls after it or for that one.
CUresult next(bool *fails = nullptr) {
  const int call = calls++, good = good_calls.load(), error = failure.load();
  const bool now = good >= 0 && (error > 0 ? call >= good : call == good);
  if (fails) *fails = now;
  return now ? static_cast<CUresult>(error > 0 ? error : -error) : CUDA_SUCCESS;
}

void *host(CUdeviceptr p) { return reinterpret_cast<void *>(static_cast<uintptr_t>(p)); }

}  // namespace

// The first `good` calls from now on succeed; those that follow return `error`, and where it is negative, only the next
// one returns -error. good < 0: nothing fails. Returns how many calls there were since the last time.
FAKE_API int fake_driver_fail_after(int good, int error) {
  good_calls = -1;
  const int count = calls.exchange(0);
  failure = error;
  good_calls = good;
  return count;
}

// How often the context of a device was asked for.
FAKE_API int fake_driver_retained(int device) { return retained[device]; }
// Whether the calling thread has one.
FAKE_API int fake_driver_has_context() { return current ? 1 : 0; }

// From now on device code is compiled, for the first GPU, until this is called with 0.
FAKE_API int fake_driver_hold(int hold) {
  const std::lock_guard<std::mutex> lock(mutex);
  is_held = hold != 0;
  changed.notify_all();
  return 0;
}
// Returns 1 while the driver compiles; 0 if it does not within ten seconds.
FAKE_API int fake_driver_wait_for_compiling() {
  std::unique_lock<std::mutex> lock(mutex);
  return changed.wait_for(lock, std::chrono::seconds(10), [] { return is_compiling; }) ? 1 : 0;
}

FAKE_API CUresult CUDAAPI cuInit(unsigned) { return static_cast<CUresult>(FAKE_START); }
FAKE_API CUresult CUDAAPI cuDriverGetVersion(int *version) {
  *version = FAKE_VERSION;
  return static_cast<CUresult>(FAKE_VERSION > 0 ? 0 : FAKE_START);
}
FAKE_API CUresult CUDAAPI cuGetErrorName(CUresult, const char **name) {
  *name = "CUDA_ERROR_OF_THE_FAKE";
  return CUDA_SUCCESS;
}
FAKE_API CUresult CUDAAPI cuGetErrorString(CUresult, const char **text) {
  *text = "the fake driver was told to fail";
  return CUDA_SUCCESS;
}

// ---- devices and contexts
FAKE_API CUresult CUDAAPI cuDeviceGet(CUdevice *device, int ordinal) {
  *device = ordinal;
  return next();
}
FAKE_API CUresult CUDAAPI cuDeviceGetCount(int *count) {
  *count = FAKE_DEVICES;
  return next();
}
FAKE_API CUresult CUDAAPI cuDeviceGetName(char *name, int, CUdevice) {
  std::strcpy(name, "Fake GPU");
  return next();
}
FAKE_API CUresult CUDAAPI cuDeviceGetAttribute(int *value, CUdevice_attribute attribute, CUdevice) {
  *value = attribute == CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR ? 9 : 4;
  return next();
}
FAKE_API CUresult CUDAAPI cuDeviceTotalMem_v2(size_t *bytes, CUdevice) {
  *bytes = size_t(128) << 20;
  return next();
}
FAKE_API CUresult CUDAAPI cuDevicePrimaryCtxRetain(CUcontext *context, CUdevice device) {
  ++retained[device];
  *context = reinterpret_cast<CUcontext>(&contexts[device]);
  return next();
}
FAKE_API CUresult CUDAAPI cuCtxGetCurrent(CUcontext *context) {
  *context = current;
  return next();
}
FAKE_API CUresult CUDAAPI cuCtxSetCurrent(CUcontext context) {
  bool fails = false;
  const CUresult result = next(&fails);
  if (!fails) current = context;
  return result;
}
FAKE_API CUresult CUDAAPI cuCtxGetDevice(CUdevice *device) {
  *device = 0;
  for (int k = 0; k < FAKE_DEVICES; ++k)
    if (current == reinterpret_cast<CUcontext>(&contexts[k])) *device = k;
  const CUresult result = next();
  return result == CUDA_SUCCESS && !current ? CUDA_ERROR_INVALID_CONTEXT : result;
}

// ---- kernels
FAKE_API CUresult CUDAAPI cuModuleLoadData(CUmodule *module, const void *) {
  std::unique_lock<std::mutex> lock(mutex);
  if (current == reinterpret_cast<CUcontext>(&contexts[0])) {
    is_compiling = is_held;
    changed.notify_all();
    changed.wait(lock, [] { return !is_held; });
    is_compiling = false;
  }
  *module = reinterpret_cast<CUmodule>(&the_module);
  return next();
}
FAKE_API CUresult CUDAAPI cuModuleGetFunction(CUfunction *function, CUmodule, const char *) {
  *function = reinterpret_cast<CUfunction>(&the_function);
  return next();
}
FAKE_API CUresult CUDAAPI cuFuncGetAttribute(int *value, CUfunction_attribute, CUfunction) {
  *value = 90;
  return next();
}
FAKE_API CUresult CUDAAPI cuFuncSetAttribute(CUfunction, CUfunction_attribute, int) { return next(); }
FAKE_API CUresult CUDAAPI cuOccupancyMaxActiveBlocksPerMultiprocessorWithFlags(int *blocks, CUfunction, int, size_t,
                                                                               unsigned) {
  *blocks = 2;
  return next();
}
FAKE_API CUresult CUDAAPI cuLaunchKernel(CUfunction, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned,
                                         unsigned, CUstream, void **, void **) {
  return next();
}

// ---- memory: zeros, so that what a kernel should have counted is nothing
FAKE_API CUresult CUDAAPI cuMemAlloc_v2(CUdeviceptr *memory, size_t bytes) {
  bool fails = false;
  const CUresult result = next(&fails);
  if (!fails) *memory = reinterpret_cast<uintptr_t>(std::calloc(bytes, 1));
  return fails || *memory ? result : CUDA_ERROR_OUT_OF_MEMORY;
}
FAKE_API CUresult CUDAAPI cuMemFree_v2(CUdeviceptr memory) {
  std::free(host(memory));
  return next();
}
FAKE_API CUresult CUDAAPI cuMemHostAlloc(void **memory, size_t bytes, unsigned) {
  bool fails = false;
  const CUresult result = next(&fails);
  if (!fails) *memory = std::calloc(bytes, 1);
  return fails || *memory ? result : CUDA_ERROR_OUT_OF_MEMORY;
}
FAKE_API CUresult CUDAAPI cuMemFreeHost(void *memory) {
  std::free(memory);
  return next();
}
FAKE_API CUresult CUDAAPI cuMemGetInfo_v2(size_t *free, size_t *total) {
  *free = size_t(96) << 20;
  *total = size_t(128) << 20;
  return next();
}
FAKE_API CUresult CUDAAPI cuMemcpyHtoDAsync_v2(CUdeviceptr to, const void *from, size_t bytes, CUstream) {
  std::memcpy(host(to), from, bytes);
  return next();
}
FAKE_API CUresult CUDAAPI cuMemcpyDtoHAsync_v2(void *to, CUdeviceptr from, size_t bytes, CUstream) {
  std::memcpy(to, host(from), bytes);
  return next();
}
FAKE_API CUresult CUDAAPI cuMemcpyDtoDAsync_v2(CUdeviceptr to, CUdeviceptr from, size_t bytes, CUstream) {
  std::memmove(host(to), host(from), bytes);
  return next();
}
FAKE_API CUresult CUDAAPI cuMemsetD8Async(CUdeviceptr memory, unsigned char byte, size_t bytes, CUstream) {
  std::memset(host(memory), byte, bytes);
  return next();
}

// ---- streams and events
FAKE_API CUresult CUDAAPI cuStreamCreate(CUstream *stream, unsigned) {
  *stream = nullptr;
  return next();
}
FAKE_API CUresult CUDAAPI cuStreamDestroy_v2(CUstream) { return next(); }
FAKE_API CUresult CUDAAPI cuStreamSynchronize(CUstream) { return next(); }
FAKE_API CUresult CUDAAPI cuEventCreate(CUevent *event, unsigned) {
  *event = nullptr;
  return next();
}
FAKE_API CUresult CUDAAPI cuEventDestroy_v2(CUevent) { return next(); }
FAKE_API CUresult CUDAAPI cuEventRecord(CUevent, CUstream) { return next(); }
FAKE_API CUresult CUDAAPI cuEventSynchronize(CUevent) { return next(); }
FAKE_API CUresult CUDAAPI cuEventElapsedTime(float *milliseconds, CUevent, CUevent) {
  *milliseconds = 1;
  return next();
}
