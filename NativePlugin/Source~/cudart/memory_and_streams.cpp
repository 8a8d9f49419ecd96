// SPDX-License-Identifier: MIT
// CUDA Runtime API, "Memory Management", "Stream Management" and "Event Management".
#include "cudart/current_context.h"

#include <cstdint>

using namespace quickses::cudart;

namespace {

CUdeviceptr address(const void *p) { return static_cast<CUdeviceptr>(reinterpret_cast<uintptr_t>(p)); }

// Whether something is done: that it is not is an answer, not an error.
template <class Call>
cudaError_t ask(Call call) {
  if (const cudaError_t error = enter()) return remember(error);
  const CUresult result = call(driver());
  return result == CUDA_ERROR_NOT_READY ? cudaErrorNotReady : remember(result);
}

}  // namespace

extern "C" {

// ---- memory ---------------------------------------------------------------------------------------------------------

// On failure *memory is null.
cudaError_t CUDARTAPI cudaMalloc(void **memory, size_t bytes) {
  *memory = nullptr;
  return inside([&](const Driver &d) {
    CUdeviceptr p = 0;
    const CUresult result = d.cuMemAlloc_v2(&p, bytes);
    if (result == CUDA_SUCCESS) *memory = reinterpret_cast<void *>(static_cast<uintptr_t>(p));
    return result;
  });
}
// Null is ignored, as the manual says.
cudaError_t CUDARTAPI cudaFree(void *memory) {
  if (!memory) return cudaSuccess;
  return inside([&](const Driver &d) { return d.cuMemFree_v2(address(memory)); });
}

// The flags have the numbers of CU_MEMHOSTALLOC_* (driver_types.h). On failure *memory is null.
cudaError_t CUDARTAPI cudaHostAlloc(void **memory, size_t bytes, unsigned flags) {
  *memory = nullptr;
  return inside([&](const Driver &d) { return d.cuMemHostAlloc(memory, bytes, flags); });
}
cudaError_t CUDARTAPI cudaFreeHost(void *memory) {
  if (!memory) return cudaSuccess;
  return inside([&](const Driver &d) { return d.cuMemFreeHost(memory); });
}

// The flags have the numbers of CU_MEMHOSTREGISTER_*.
cudaError_t CUDARTAPI cudaHostRegister(void *memory, size_t bytes, unsigned flags) {
  return inside([&](const Driver &d) { return d.cuMemHostRegister_v2(memory, bytes, flags); });
}
cudaError_t CUDARTAPI cudaHostUnregister(void *memory) {
  return inside([&](const Driver &d) { return d.cuMemHostUnregister(memory); });
}
cudaError_t CUDARTAPI cudaHostGetDevicePointer(void **on_device, void *memory, unsigned flags) {
  return inside([&](const Driver &d) {
    CUdeviceptr p = 0;
    const CUresult result = d.cuMemHostGetDevicePointer_v2(&p, memory, flags);
    if (result == CUDA_SUCCESS) *on_device = reinterpret_cast<void *>(static_cast<uintptr_t>(p));
    return result;
  });
}

cudaError_t CUDARTAPI cudaMemGetInfo(size_t *free, size_t *total) {
  return inside([&](const Driver &d) { return d.cuMemGetInfo_v2(free, total); });
}

// Nothing to copy or set is no error (the driver's functions would refuse it).
cudaError_t CUDARTAPI cudaMemcpyAsync(void *to, const void *from, size_t bytes, cudaMemcpyKind kind,
                                      cudaStream_t stream) {
  if (bytes == 0) return cudaSuccess;
  return inside([&](const Driver &d) {
    switch (kind) {
      case cudaMemcpyHostToDevice:
        return d.cuMemcpyHtoDAsync_v2(address(to), from, bytes, stream);
      case cudaMemcpyDeviceToHost:
        return d.cuMemcpyDtoHAsync_v2(to, address(from), bytes, stream);
      case cudaMemcpyDeviceToDevice:
        return d.cuMemcpyDtoDAsync_v2(address(to), address(from), bytes, stream);
      default:
        return CUDA_ERROR_NOT_SUPPORTED;  // the library says which way it copies
    }
  });
}
cudaError_t CUDARTAPI cudaMemsetAsync(void *memory, int byte, size_t bytes, cudaStream_t stream) {
  if (bytes == 0) return cudaSuccess;
  return inside([&](const Driver &d) {
    return d.cuMemsetD8Async(address(memory), static_cast<unsigned char>(byte), bytes, stream);
  });
}

// ---- streams and events, whose handles are those of the driver ------------------------------------------------------

cudaError_t CUDARTAPI cudaStreamCreateWithPriority(cudaStream_t *stream, unsigned flags, int priority) {
  return inside([&](const Driver &d) { return d.cuStreamCreateWithPriority(stream, flags, priority); });
}
cudaError_t CUDARTAPI cudaStreamCreateWithFlags(cudaStream_t *stream, unsigned flags) {
  return inside([&](const Driver &d) { return d.cuStreamCreate(stream, flags); });
}
cudaError_t CUDARTAPI cudaStreamDestroy(cudaStream_t stream) {
  return inside([&](const Driver &d) { return d.cuStreamDestroy_v2(stream); });
}
cudaError_t CUDARTAPI cudaStreamSynchronize(cudaStream_t stream) {
  return inside([&](const Driver &d) { return d.cuStreamSynchronize(stream); });
}
cudaError_t CUDARTAPI cudaStreamQuery(cudaStream_t stream) {
  return ask([&](const Driver &d) { return d.cuStreamQuery(stream); });
}
cudaError_t CUDARTAPI cudaStreamWaitEvent(cudaStream_t stream, cudaEvent_t event, unsigned flags) {
  return inside([&](const Driver &d) { return d.cuStreamWaitEvent(stream, event, flags); });
}

// The flags have the numbers of CU_EVENT_* (driver_types.h).
cudaError_t CUDARTAPI cudaEventCreateWithFlags(cudaEvent_t *event, unsigned flags) {
  return inside([&](const Driver &d) { return d.cuEventCreate(event, flags); });
}
cudaError_t CUDARTAPI cudaEventCreate(cudaEvent_t *event) {
  return inside([&](const Driver &d) { return d.cuEventCreate(event, CU_EVENT_DEFAULT); });
}
cudaError_t CUDARTAPI cudaEventDestroy(cudaEvent_t event) {
  return inside([&](const Driver &d) { return d.cuEventDestroy_v2(event); });
}
cudaError_t CUDARTAPI cudaEventRecord(cudaEvent_t event, cudaStream_t stream) {
  return inside([&](const Driver &d) { return d.cuEventRecord(event, stream); });
}
cudaError_t CUDARTAPI cudaEventQuery(cudaEvent_t event) {
  return ask([&](const Driver &d) { return d.cuEventQuery(event); });
}
cudaError_t CUDARTAPI cudaEventSynchronize(cudaEvent_t event) {
  return inside([&](const Driver &d) { return d.cuEventSynchronize(event); });
}
cudaError_t CUDARTAPI cudaEventElapsedTime(float *milliseconds, cudaEvent_t start, cudaEvent_t end) {
  return inside([&](const Driver &d) { return d.cuEventElapsedTime(milliseconds, start, end); });
}

}  // extern "C"
