// SPDX-License-Identifier: MIT
// A stand-in for NVIDIA's driver library, with every function that cudart/ asks for. Its GPU has host memory, and its
// kernels do nothing. FAKE_VERSION: of CUDA, as cuDriverGetVersion counts; 0: it fails as cuInit. FAKE_START: what
// cuInit returns. FAKE_DEVICES: how many GPUs, else one. FAKE_WDDM: pages of the process have other addresses on the
// GPU, as with Windows' drivers. To leave a function out, rename it by a macro
// (-DcuMemAlloc_v2=left_out).
#include "fake_driver.h"

#include "../process/patience.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>

// CUDA 13 means other versions of these, which the library does not ask for.
#undef cuEventElapsedTime
#undef cuGraphAddKernelNode
#undef cuGraphExecKernelNodeSetParams

using namespace fake_driver;

namespace {

std::atomic<int> calls{0}, good_calls{-1}, failure{0};
thread_local CUcontext current = nullptr;
int contexts[FAKE_DEVICES], the_module, the_function;
std::atomic<int> retained[FAKE_DEVICES];
std::atomic<unsigned long long> context_id{1};
std::atomic<int> handles{0}, graphs_launched{0}, registrations{0};
std::atomic<uintptr_t> last_handle{0};

// Of cuModuleLoadData.
std::mutex mutex;
std::condition_variable changed;
bool is_held = false, is_compiling = false;

// What cuMemAlloc and cuMemHostAlloc have given: how many bytes by address.
std::mutex memory_mutex;
std::map<CUdeviceptr, size_t> memory_given;

CUresult give_memory(size_t bytes, void **memory) {
  bool fails = false;
  const CUresult result = next(&fails);
  if (fails) return result;
  if (!(*memory = std::calloc(bytes, 1))) return CUDA_ERROR_OUT_OF_MEMORY;
  const std::lock_guard<std::mutex> lock(memory_mutex);
  memory_given[address(*memory)] = bytes;
  return result;
}

CUresult take_memory_back(void *memory) {
  const std::lock_guard<std::mutex> lock(memory_mutex);
  if (memory_given.erase(address(memory)) == 0) return CUDA_ERROR_INVALID_VALUE;
  std::free(memory);
  return next();
}

bool is_given(CUdeviceptr memory, size_t bytes) {
  const std::lock_guard<std::mutex> lock(memory_mutex);
  const auto after = memory_given.upper_bound(memory);
  if (after == memory_given.begin()) return false;
  const auto &[begin, size] = *std::prev(after);
  return memory + bytes <= begin + size;
}

// What the GPU reads or writes must be memory that it has at that time.
bool is_there(CUdeviceptr memory, size_t bytes, CUstream stream) {
  return is_given(memory, bytes) || is_mapped_for(memory, bytes, stream);
}

template <class Copy>
CUresult copy_if(bool is_allowed, const Copy &copy) {
  if (!is_allowed) return CUDA_ERROR_ILLEGAL_ADDRESS;
  copy();
  return next();
}

template <class Handle>
CUresult make(Handle *handle) {
  bool fails = false;
  const CUresult result = next(&fails);
  if (fails) return result;
  ++handles;
  *handle = reinterpret_cast<Handle>(++last_handle);
  return result;
}

bool is_of_lost_device(CUresult result) {
  return result == CUDA_ERROR_LAUNCH_TIMEOUT || result == CUDA_ERROR_CONTEXT_IS_DESTROYED ||
         result == CUDA_ERROR_LAUNCH_FAILED || result == CUDA_ERROR_UNKNOWN;
}

CUresult end_one() {
  --handles;
  return next();
}

}  // namespace

CUcontext fake_driver::current_context() { return current; }

CUresult fake_driver::next(bool *fails) {
  const int call = calls++, good = good_calls.load(), error = failure.load();
  const bool now = good >= 0 && (error > 0 ? call >= good : call == good);
  if (fails) *fails = now;
  return now ? static_cast<CUresult>(error > 0 ? error : -error) : CUDA_SUCCESS;
}

// The first `good` calls from now on succeed; those that follow return `error`, and where it is negative, only the next
// one returns -error. good < 0: nothing fails. Returns how many calls there were since the last time.
FAKE_API int fake_driver_fail_after(int good, int error) {
  good_calls = -1;
  const int count = calls.exchange(0);
  failure = error;
  good_calls = good;
  return count;
}

// How many there were so far.
FAKE_API int fake_driver_calls() { return calls; }

// The CUDA that it was compiled with, and the library.
FAKE_API int fake_driver_toolkit() { return CUDA_VERSION; }

// How often the context of a device was asked for.
FAKE_API int fake_driver_retained(int device) { return retained[device]; }
// How many streams, events and graphs there are.
FAKE_API int fake_driver_handles() { return handles; }
// How many graphs were launched.
FAKE_API int fake_driver_graphs_launched() { return graphs_launched; }
// Whether the calling thread has one.
// How often pages of the process were locked.
FAKE_API int fake_driver_registrations() { return registrations; }
FAKE_API int fake_driver_has_context() { return current ? 1 : 0; }
FAKE_API int fake_driver_drop_context() {
  current = nullptr;
  return 0;
}

// As if other code in the process had reset all devices, and gone on with them.
FAKE_API int fake_driver_reset() {
  ++context_id;
  return 0;
}

// From now on device code is compiled, for the first GPU, until this is called with 0.
FAKE_API int fake_driver_hold(int hold) {
  const std::lock_guard<std::mutex> lock(mutex);
  is_held = hold != 0;
  changed.notify_all();
  return 0;
}
// Returns 1 while the driver compiles; 0 if it does not for as long as tests wait.
FAKE_API int fake_driver_wait_for_compiling() {
  std::unique_lock<std::mutex> lock(mutex);
  return changed.wait_for(lock, kPatience, [] { return is_compiling; }) ? 1 : 0;
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
  *device = device_of(ordinal);
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
#if defined(FAKE_WDDM)
  const bool same_addresses = false;
#else
  const bool same_addresses = true;
#endif
  *value = attribute == CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR                  ? 9
           : attribute == CU_DEVICE_ATTRIBUTE_CAN_USE_HOST_POINTER_FOR_REGISTERED_MEM ? same_addresses
                                                                                      : 4;
  return next();
}
FAKE_API CUresult CUDAAPI cuDeviceTotalMem_v2(size_t *bytes, CUdevice) {
  *bytes = size_t(128) << 20;
  return next();
}
FAKE_API CUresult CUDAAPI cuDevicePrimaryCtxRetain(CUcontext *context, CUdevice device) {
  const int ordinal = device - kFirstDevice;
  ++retained[ordinal];
  *context = reinterpret_cast<CUcontext>(&contexts[ordinal]);
  return next();
}
// These two ask nothing of the device: that it is lost is said by others.
FAKE_API CUresult CUDAAPI cuCtxGetCurrent(CUcontext *context) {
  *context = current;
  const CUresult result = next();
  return is_of_lost_device(result) ? CUDA_SUCCESS : result;
}
FAKE_API CUresult CUDAAPI cuCtxSetCurrent(CUcontext context) {
  const CUresult result = next();
  if (result != CUDA_SUCCESS && !is_of_lost_device(result)) return result;
  current = context;
  return CUDA_SUCCESS;
}
FAKE_API CUresult CUDAAPI cuCtxGetDevice(CUdevice *device) {
  *device = device_of(0);
  for (int k = 0; k < FAKE_DEVICES; ++k)
    if (current == reinterpret_cast<CUcontext>(&contexts[k])) *device = device_of(k);
  const CUresult result = next();
  return result == CUDA_SUCCESS && !current ? CUDA_ERROR_INVALID_CONTEXT : result;
}
FAKE_API CUresult CUDAAPI cuCtxGetId(CUcontext, unsigned long long *id) {
  *id = context_id;
  return next();
}
FAKE_API CUresult CUDAAPI cuCtxGetApiVersion(CUcontext, unsigned *version) {
  *version = FAKE_VERSION;
  return next();
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
  note_launch();
  return next();
}

FAKE_API CUresult CUDAAPI cuLaunchKernelEx(const CUlaunchConfig *config, CUfunction, void **, void **) {
  note_launch();
  for (unsigned k = 0; k < config->numAttrs; ++k)
    if (config->attrs[k].id != CU_LAUNCH_ATTRIBUTE_PROGRAMMATIC_STREAM_SERIALIZATION) return CUDA_ERROR_INVALID_VALUE;
  return next();
}

// ---- graphs of kernels
FAKE_API CUresult CUDAAPI cuGraphCreate(CUgraph *graph, unsigned) { return make(graph); }
FAKE_API CUresult CUDAAPI cuGraphAddKernelNode(CUgraphNode *node, CUgraph, const CUgraphNode *, size_t,
                                               const CUDA_KERNEL_NODE_PARAMS_v1 *) {
  *node = reinterpret_cast<CUgraphNode>(++last_handle);
  return next();
}
#if CUDA_VERSION >= 12030
FAKE_API CUresult CUDAAPI cuGraphAddDependencies_v2(CUgraph, const CUgraphNode *, const CUgraphNode *,
                                                    const CUgraphEdgeData *, size_t) {
#else
FAKE_API CUresult CUDAAPI cuGraphAddDependencies_v2(CUgraph, const CUgraphNode *, const CUgraphNode *,
                                                    const quickses::cudart::GraphEdge *, size_t) {
#endif
  return next();
}
FAKE_API CUresult CUDAAPI cuGraphInstantiateWithFlags(CUgraphExec *made, CUgraph, unsigned long long) {
  return make(made);
}
FAKE_API CUresult CUDAAPI cuGraphExecKernelNodeSetParams(CUgraphExec, CUgraphNode, const CUDA_KERNEL_NODE_PARAMS_v1 *) {
  return next();
}
FAKE_API CUresult CUDAAPI cuGraphLaunch(CUgraphExec, CUstream) {
  note_launch();
  ++graphs_launched;
  return next();
}
FAKE_API CUresult CUDAAPI cuGraphExecDestroy(CUgraphExec) { return end_one(); }
FAKE_API CUresult CUDAAPI cuGraphDestroy(CUgraph) { return end_one(); }

// ---- memory: zeros, so that what a kernel should have counted is nothing
FAKE_API CUresult CUDAAPI cuMemAlloc_v2(CUdeviceptr *memory, size_t bytes) {
  void *given = nullptr;
  const CUresult result = give_memory(bytes, &given);
  if (given) *memory = address(given);
  return result;
}
FAKE_API CUresult CUDAAPI cuMemFree_v2(CUdeviceptr memory) { return take_memory_back(host(memory)); }
FAKE_API CUresult CUDAAPI cuMemHostAlloc(void **memory, size_t bytes, unsigned) { return give_memory(bytes, memory); }
FAKE_API CUresult CUDAAPI cuMemFreeHost(void *memory) { return take_memory_back(memory); }
FAKE_API CUresult CUDAAPI cuMemHostRegister_v2(void *memory, size_t bytes, unsigned) {
  bool fails = false;
  const CUresult result = next(&fails);
  if (fails) return result;
  ++registrations;
  std::memset(memory, 0, bytes);  // nobody has written there yet
  const std::lock_guard<std::mutex> lock(memory_mutex);
  memory_given[address(memory)] = bytes;
  return result;
}
FAKE_API CUresult CUDAAPI cuMemHostUnregister(void *memory) {
  const std::lock_guard<std::mutex> lock(memory_mutex);
  if (memory_given.erase(address(memory)) == 0) return CUDA_ERROR_INVALID_VALUE;
  return next();
}
FAKE_API CUresult CUDAAPI cuMemHostGetDevicePointer_v2(CUdeviceptr *on_device, void *memory, unsigned) {
  *on_device = address(memory);
  return next();
}
FAKE_API CUresult CUDAAPI cuMemGetInfo_v2(size_t *free, size_t *total) {
  *free = size_t(96) << 20;
  *total = size_t(128) << 20;
  return next();
}
FAKE_API CUresult CUDAAPI cuMemcpyHtoDAsync_v2(CUdeviceptr to, const void *from, size_t bytes, CUstream stream) {
  return copy_if(is_there(to, bytes, stream), [&] { std::memcpy(host(to), from, bytes); });
}
FAKE_API CUresult CUDAAPI cuMemcpyDtoHAsync_v2(void *to, CUdeviceptr from, size_t bytes, CUstream stream) {
  return copy_if(is_there(from, bytes, stream), [&] { std::memcpy(to, host(from), bytes); });
}
FAKE_API CUresult CUDAAPI cuMemcpyDtoDAsync_v2(CUdeviceptr to, CUdeviceptr from, size_t bytes, CUstream stream) {
  return copy_if(is_there(from, bytes, stream) && is_there(to, bytes, stream),
                 [&] { std::memmove(host(to), host(from), bytes); });
}
FAKE_API CUresult CUDAAPI cuMemsetD8Async(CUdeviceptr memory, unsigned char byte, size_t bytes, CUstream stream) {
  return copy_if(is_there(memory, bytes, stream), [&] { std::memset(host(memory), byte, bytes); });
}

// ---- streams and events: what a stream is given is done at once
FAKE_API CUresult CUDAAPI cuStreamCreate(CUstream *stream, unsigned) { return make(stream); }
FAKE_API CUresult CUDAAPI cuStreamCreateWithPriority(CUstream *stream, unsigned, int) { return make(stream); }
FAKE_API CUresult CUDAAPI cuStreamDestroy_v2(CUstream) { return end_one(); }
FAKE_API CUresult CUDAAPI cuStreamSynchronize(CUstream) { return next(); }
FAKE_API CUresult CUDAAPI cuStreamWaitEvent(CUstream, CUevent, unsigned) { return next(); }
FAKE_API CUresult CUDAAPI cuEventCreate(CUevent *event, unsigned) { return make(event); }
FAKE_API CUresult CUDAAPI cuEventDestroy_v2(CUevent) { return end_one(); }
FAKE_API CUresult CUDAAPI cuEventRecord(CUevent, CUstream) { return next(); }
FAKE_API CUresult CUDAAPI cuEventQuery(CUevent) { return next(); }
FAKE_API CUresult CUDAAPI cuStreamQuery(CUstream) { return next(); }
FAKE_API CUresult CUDAAPI cuEventSynchronize(CUevent) { return next(); }
FAKE_API CUresult CUDAAPI cuEventElapsedTime(float *milliseconds, CUevent, CUevent) {
  *milliseconds = 1;
  return next();
}
