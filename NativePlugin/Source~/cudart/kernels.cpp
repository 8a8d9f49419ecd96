// SPDX-License-Identifier: MIT
// Kernels: how the compiler makes them known, and how they are launched. The functions with two underscores are those
// that the host code of clang (clang/lib/CodeGen/CGCUDANV.cpp) and of nvcc (crt/host_runtime.h) calls; the others are
// the CUDA Runtime API's, "Execution Control" and "Occupancy".
#include "cudart/loaded_kernel.h"

#include <array>
#include <atomic>
#include <cstring>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

namespace quickses {
namespace cudart {
namespace {

// What the compiler leaves of the device code of one source (fatbinary_section.h).
struct FatBinary {
  int magic, version;
  const void *image;
  void *more;
};

struct Module {
  const void *image;
  std::array<CUmodule, kMostDevices> loaded{};  // guarded by the device's mutex
};

struct Kernel {
  Module *module;
  const char *name;
  std::array<std::atomic<CUfunction>, kMostDevices> function{};
  std::array<int, kMostDevices> architecture{};  // of its source, 10 * major + minor; there before the function is
};

struct Registry {
  std::array<std::mutex, kMostDevices> loading;  // by device: the driver may compile for one of them for a minute
  std::vector<std::unique_ptr<Module>> modules;
  // By the address of the host's stub. Complete once the library is loaded, and only read from then on.
  std::unordered_map<const void *, Kernel> kernels;
};

// Never destroyed: kernels may be launched as late as the process ends.
Registry &registry() {
  static Registry &the_registry = *new Registry;
  return the_registry;
}

}  // namespace

CUresult find_kernel(const void *stub, LoadedKernel *found_kernel) {
  Registry &r = registry();
  const auto found = r.kernels.find(stub);
  if (found == r.kernels.end()) return CUDA_ERROR_NOT_FOUND;
  const int device = current_device();
  if (device < 0) return CUDA_ERROR_INVALID_CONTEXT;
  Kernel &kernel = found->second;
  std::atomic<CUfunction> &slot = kernel.function[static_cast<size_t>(device)];
  int &architecture = kernel.architecture[static_cast<size_t>(device)];
  const auto is_there = [&] {
    const CUfunction function = slot.load(std::memory_order_acquire);
    if (function) *found_kernel = {function, architecture};
    return function != nullptr;
  };
  if (is_there()) return CUDA_SUCCESS;
  const std::lock_guard<std::mutex> lock(r.loading[static_cast<size_t>(device)]);
  if (is_there()) return CUDA_SUCCESS;  // another thread was first
  CUfunction function = nullptr;
  CUmodule &module = kernel.module->loaded[static_cast<size_t>(device)];
  CUresult result = CUDA_SUCCESS;
  if (!module) result = driver().cuModuleLoadData(&module, kernel.module->image);
  if (result == CUDA_SUCCESS) result = driver().cuModuleGetFunction(&function, module, kernel.name);
  if (result == CUDA_SUCCESS)
    result = driver().cuFuncGetAttribute(&architecture, CU_FUNC_ATTRIBUTE_PTX_VERSION, function);
  if (result == CUDA_SUCCESS) slot.store(function, std::memory_order_release);
  *found_kernel = {function, architecture};
  return result;
}

namespace {

template <class Call>
cudaError_t with_kernel(const void *stub, Call call) {
  return inside([&](const Driver &d) {
    LoadedKernel kernel;
    const CUresult result = find_kernel(stub, &kernel);
    return result == CUDA_SUCCESS ? call(d, kernel) : result;
  });
}
template <class Call>
cudaError_t with_function(const void *stub, Call call) {
  return with_kernel(stub, [&](const Driver &d, const LoadedKernel &kernel) { return call(d, kernel.function); });
}

struct CallConfiguration {
  dim3 grid, block;
  size_t shared_bytes = 0;
  void *stream = nullptr;
};
// From <<<...>>> to the stub that it calls; nothing is launched in between.
thread_local CallConfiguration call_configuration;

}  // namespace
}  // namespace cudart
}  // namespace quickses

using namespace quickses::cudart;

extern "C" {

// ---- called while the library is loaded, by one thread --------------------------------------------------------------

void **__cudaRegisterFatBinary(void *fat_binary) {
  Registry &r = registry();
  r.modules.push_back(std::make_unique<Module>());
  r.modules.back()->image = static_cast<const FatBinary *>(fat_binary)->image;
  return reinterpret_cast<void **>(r.modules.back().get());
}
void __cudaRegisterFatBinaryEnd(void **) {}
// Called as the process ends, when the driver may be gone already. The device code goes with the process.
void __cudaUnregisterFatBinary(void **) {}

void __cudaRegisterFunction(void **module, const char *stub, char *, const char *name, int, uint3 *, uint3 *, dim3 *,
                            dim3 *, int *) {
  Kernel &kernel = registry().kernels[stub];
  kernel.module = reinterpret_cast<Module *>(module);
  kernel.name = name;
}
// Variables are seen by kernels only: the host never asks for their addresses.
void __cudaRegisterVar(void **, char *, char *, const char *, int, size_t, int, int) {}

// ---- called for kernel<<<grid, block, shared_bytes, stream>>>(...) --------------------------------------------------

unsigned __cudaPushCallConfiguration(dim3 grid, dim3 block, size_t shared_bytes, struct CUstream_st *stream) {
  call_configuration = {grid, block, shared_bytes, stream};
  return 0;  // anything else: the kernel's stub is not called
}
cudaError_t __cudaPopCallConfiguration(dim3 *grid, dim3 *block, size_t *shared_bytes, void *stream) {
  *grid = call_configuration.grid;
  *block = call_configuration.block;
  *shared_bytes = call_configuration.shared_bytes;
  *static_cast<void **>(stream) = call_configuration.stream;
  return cudaSuccess;
}

// The launch is asynchronous; what it returns may be an error of earlier ones.
cudaError_t CUDARTAPI cudaLaunchKernel(const void *stub, dim3 grid, dim3 block, void **arguments, size_t shared_bytes,
                                       cudaStream_t stream) {
  return with_function(stub, [&](const Driver &d, CUfunction f) {
    return d.cuLaunchKernel(f, grid.x, grid.y, grid.z, block.x, block.y, block.z, static_cast<unsigned>(shared_bytes),
                            stream, arguments, nullptr);
  });
}

// Attributes: cudaLaunchAttributeProgrammaticStreamSerialization, which is passed over where the driver or the device
// code don't know it.
cudaError_t CUDARTAPI cudaLaunchKernelExC(const cudaLaunchConfig_t *config, const void *stub, void **arguments) {
  for (unsigned k = 0; k < config->numAttrs; ++k)
    if (config->attrs[k].id != cudaLaunchAttributeProgrammaticStreamSerialization) return cudaErrorNotSupported;
  const dim3 &grid = config->gridDim, &block = config->blockDim;
  return with_kernel(stub, [&](const Driver &d, const LoadedKernel &kernel) {
    if (config->numAttrs == 0 || !kernel.may_overlap())
      return d.cuLaunchKernel(kernel.function, grid.x, grid.y, grid.z, block.x, block.y, block.z,
                              static_cast<unsigned>(config->dynamicSmemBytes), config->stream, arguments, nullptr);
    CUlaunchAttribute attribute{};
    attribute.id = CU_LAUNCH_ATTRIBUTE_PROGRAMMATIC_STREAM_SERIALIZATION;
    attribute.value.programmaticStreamSerializationAllowed =
        config->attrs[0].val.programmaticStreamSerializationAllowed;
    CUlaunchConfig same{};
    same.gridDimX = grid.x, same.gridDimY = grid.y, same.gridDimZ = grid.z;
    same.blockDimX = block.x, same.blockDimY = block.y, same.blockDimZ = block.z;
    same.sharedMemBytes = static_cast<unsigned>(config->dynamicSmemBytes);
    same.hStream = config->stream;
    same.attrs = &attribute;
    same.numAttrs = 1;
    return d.cuLaunchKernelEx(&same, kernel.function, arguments, nullptr);
  });
}

// ---- what is known of a kernel on the thread's device ---------------------------------------------------------------

cudaError_t CUDARTAPI cudaFuncGetAttributes(cudaFuncAttributes *attributes, const void *stub) {
  return with_function(stub, [&](const Driver &d, CUfunction f) {
    std::memset(attributes, 0, sizeof *attributes);
    int shared = 0, constant = 0, local = 0;
    const struct {
      int *value;
      CUfunction_attribute attribute;
    } numbers[] = {{&shared, CU_FUNC_ATTRIBUTE_SHARED_SIZE_BYTES},
                   {&constant, CU_FUNC_ATTRIBUTE_CONST_SIZE_BYTES},
                   {&local, CU_FUNC_ATTRIBUTE_LOCAL_SIZE_BYTES},
                   {&attributes->maxThreadsPerBlock, CU_FUNC_ATTRIBUTE_MAX_THREADS_PER_BLOCK},
                   {&attributes->numRegs, CU_FUNC_ATTRIBUTE_NUM_REGS},
                   {&attributes->ptxVersion, CU_FUNC_ATTRIBUTE_PTX_VERSION},
                   {&attributes->binaryVersion, CU_FUNC_ATTRIBUTE_BINARY_VERSION},
                   {&attributes->cacheModeCA, CU_FUNC_ATTRIBUTE_CACHE_MODE_CA},
                   {&attributes->maxDynamicSharedSizeBytes, CU_FUNC_ATTRIBUTE_MAX_DYNAMIC_SHARED_SIZE_BYTES},
                   {&attributes->preferredShmemCarveout, CU_FUNC_ATTRIBUTE_PREFERRED_SHARED_MEMORY_CARVEOUT}};
    for (const auto &n : numbers) {
      const CUresult result = d.cuFuncGetAttribute(n.value, n.attribute, f);
      if (result != CUDA_SUCCESS) return result;
    }
    attributes->sharedSizeBytes = static_cast<size_t>(shared);
    attributes->constSizeBytes = static_cast<size_t>(constant);
    attributes->localSizeBytes = static_cast<size_t>(local);
    return CUDA_SUCCESS;
  });
}

// cudaFuncAttribute has the numbers of CUfunction_attribute (driver_types.h).
cudaError_t CUDARTAPI cudaFuncSetAttribute(const void *stub, cudaFuncAttribute attribute, int value) {
  return with_function(stub, [&](const Driver &d, CUfunction f) {
    return d.cuFuncSetAttribute(f, static_cast<CUfunction_attribute>(attribute), value);
  });
}

cudaError_t CUDARTAPI cudaOccupancyMaxActiveBlocksPerMultiprocessorWithFlags(int *blocks, const void *stub, int threads,
                                                                             size_t shared_bytes, unsigned flags) {
  return with_function(stub, [&](const Driver &d, CUfunction f) {
    return d.cuOccupancyMaxActiveBlocksPerMultiprocessorWithFlags(blocks, f, threads, shared_bytes, flags);
  });
}

}  // extern "C"
