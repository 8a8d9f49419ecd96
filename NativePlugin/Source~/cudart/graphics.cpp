// SPDX-License-Identifier: MIT
// CUDA Runtime API, "Graphics Interoperability", "OpenGL Interoperability" and "Direct3D 11 Interoperability".
#include "cudart/current_context.h"

#include <cuda_runtime_api.h>

namespace {

using namespace quickses::cudart;

// cudaErrorNotSupported where the driver has no such function.
template <class Function, class Call>
cudaError_t inside_graphics(Function Driver::*function, Call call) {
  if (!(driver().*function)) return remember(cudaErrorNotSupported);
  return inside([&](const Driver &d) { return call(d.*function); });
}

CUgraphicsResource handle(cudaGraphicsResource_t resource) { return reinterpret_cast<CUgraphicsResource>(resource); }
CUgraphicsResource *handles(cudaGraphicsResource_t *resources) {
  return reinterpret_cast<CUgraphicsResource *>(resources);
}

// The driver names devices by handles. One that CUDA does not show to this process is left out.
cudaError_t to_ordinals(cudaError_t error, unsigned *count, int *devices, unsigned room) {
  if (error != cudaSuccess) return error;
  const unsigned written = *count < room ? *count : room;
  *count = 0;
  for (unsigned k = 0; k < written; ++k) {
    int ordinal = -1;
    if (const CUresult result = find_ordinal(devices[k], &ordinal)) return remember(result);
    if (ordinal >= 0) devices[(*count)++] = ordinal;
  }
  return cudaSuccess;
}

}  // namespace

extern "C" {

cudaError_t CUDARTAPI cudaGraphicsResourceSetMapFlags(cudaGraphicsResource_t resource, unsigned flags) {
  return inside_graphics(&Driver::cuGraphicsResourceSetMapFlags_v2,
                         [&](auto function) { return function(handle(resource), flags); });
}
cudaError_t CUDARTAPI cudaGraphicsMapResources(int count, cudaGraphicsResource_t *resources, cudaStream_t stream) {
  return inside_graphics(&Driver::cuGraphicsMapResources, [&](auto function) {
    return function(static_cast<unsigned>(count), handles(resources), stream);
  });
}
cudaError_t CUDARTAPI cudaGraphicsResourceGetMappedPointer(void **pointer, size_t *size,
                                                           cudaGraphicsResource_t resource) {
  CUdeviceptr address = 0;
  const cudaError_t error = inside_graphics(&Driver::cuGraphicsResourceGetMappedPointer_v2,
                                            [&](auto function) { return function(&address, size, handle(resource)); });
  *pointer = reinterpret_cast<void *>(static_cast<uintptr_t>(address));
  return error;
}
cudaError_t CUDARTAPI cudaGraphicsUnmapResources(int count, cudaGraphicsResource_t *resources, cudaStream_t stream) {
  return inside_graphics(&Driver::cuGraphicsUnmapResources, [&](auto function) {
    return function(static_cast<unsigned>(count), handles(resources), stream);
  });
}
cudaError_t CUDARTAPI cudaGraphicsUnregisterResource(cudaGraphicsResource_t resource) {
  return inside_graphics(&Driver::cuGraphicsUnregisterResource,
                         [&](auto function) { return function(handle(resource)); });
}

// The lists have the numbers of CU_GL_DEVICE_LIST_* and CU_D3D11_DEVICE_LIST_*.
cudaError_t CUDARTAPI cudaGLGetDevices(unsigned *count, int *devices, unsigned room, unsigned list) {
  const cudaError_t error =
      inside_graphics(&Driver::cuGLGetDevices_v2, [&](auto function) { return function(count, devices, room, list); });
  return to_ordinals(error, count, devices, room);
}
cudaError_t CUDARTAPI cudaGraphicsGLRegisterBuffer(cudaGraphicsResource **resource, unsigned buffer, unsigned flags) {
  return inside_graphics(&Driver::cuGraphicsGLRegisterBuffer,
                         [&](auto function) { return function(handles(resource), buffer, flags); });
}
#if defined(_WIN32)
cudaError_t CUDARTAPI cudaD3D11GetDevices(unsigned *count, int *devices, unsigned room, ID3D11Device *d3d,
                                          unsigned list) {
  const cudaError_t error = inside_graphics(&Driver::cuD3D11GetDevices,
                                            [&](auto function) { return function(count, devices, room, d3d, list); });
  return to_ordinals(error, count, devices, room);
}
cudaError_t CUDARTAPI cudaGraphicsD3D11RegisterResource(cudaGraphicsResource **resource, ID3D11Resource *buffer,
                                                        unsigned flags) {
  return inside_graphics(&Driver::cuGraphicsD3D11RegisterResource,
                         [&](auto function) { return function(handles(resource), buffer, flags); });
}
#endif

}  // extern "C"
