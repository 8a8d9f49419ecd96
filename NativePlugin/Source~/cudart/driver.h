// SPDX-License-Identifier: MIT
// NVIDIA's driver library, found when it is first asked for: a machine without one can load quickses all the same.
#pragma once

#include <cuda.h>

#include <string>

#if defined(_WIN32)
struct ID3D11Device;
struct ID3D11Resource;
#endif

namespace quickses {
namespace cudart {

// Every function of the driver that is used. Names as the driver exports them: cuda.h has macros for those with _v2.
#define QSES_DRIVER_FUNCTIONS(F)                                                                                \
  F(cuDriverGetVersion, CUresult, int *)                                                                        \
  F(cuInit, CUresult, unsigned)                                                                                 \
  F(cuGetErrorName, CUresult, CUresult, const char **)                                                          \
  F(cuGetErrorString, CUresult, CUresult, const char **)                                                        \
  F(cuDeviceGet, CUresult, CUdevice *, int)                                                                     \
  F(cuDeviceGetCount, CUresult, int *)                                                                          \
  F(cuDeviceGetName, CUresult, char *, int, CUdevice)                                                           \
  F(cuDeviceGetAttribute, CUresult, int *, CUdevice_attribute, CUdevice)                                        \
  F(cuDeviceTotalMem_v2, CUresult, size_t *, CUdevice)                                                          \
  F(cuDevicePrimaryCtxRetain, CUresult, CUcontext *, CUdevice)                                                  \
  F(cuCtxGetCurrent, CUresult, CUcontext *)                                                                     \
  F(cuCtxSetCurrent, CUresult, CUcontext)                                                                       \
  F(cuCtxGetDevice, CUresult, CUdevice *)                                                                       \
  F(cuCtxGetApiVersion, CUresult, CUcontext, unsigned *)                                                        \
  F(cuModuleLoadData, CUresult, CUmodule *, const void *)                                                       \
  F(cuModuleGetFunction, CUresult, CUfunction *, CUmodule, const char *)                                        \
  F(cuFuncGetAttribute, CUresult, int *, CUfunction_attribute, CUfunction)                                      \
  F(cuFuncSetAttribute, CUresult, CUfunction, CUfunction_attribute, int)                                        \
  F(cuOccupancyMaxActiveBlocksPerMultiprocessorWithFlags, CUresult, int *, CUfunction, int, size_t, unsigned)   \
  F(cuLaunchKernel, CUresult, CUfunction, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned, \
    CUstream, void **, void **)                                                                                 \
  F(cuMemAlloc_v2, CUresult, CUdeviceptr *, size_t)                                                             \
  F(cuMemFree_v2, CUresult, CUdeviceptr)                                                                        \
  F(cuMemHostAlloc, CUresult, void **, size_t, unsigned)                                                        \
  F(cuMemFreeHost, CUresult, void *)                                                                            \
  F(cuMemHostRegister_v2, CUresult, void *, size_t, unsigned)                                                   \
  F(cuMemHostUnregister, CUresult, void *)                                                                      \
  F(cuMemHostGetDevicePointer_v2, CUresult, CUdeviceptr *, void *, unsigned)                                    \
  F(cuMemGetInfo_v2, CUresult, size_t *, size_t *)                                                              \
  F(cuMemcpyHtoDAsync_v2, CUresult, CUdeviceptr, const void *, size_t, CUstream)                                \
  F(cuMemcpyDtoHAsync_v2, CUresult, void *, CUdeviceptr, size_t, CUstream)                                      \
  F(cuMemcpyDtoDAsync_v2, CUresult, CUdeviceptr, CUdeviceptr, size_t, CUstream)                                 \
  F(cuMemsetD8Async, CUresult, CUdeviceptr, unsigned char, size_t, CUstream)                                    \
  F(cuStreamCreate, CUresult, CUstream *, unsigned)                                                             \
  F(cuStreamCreateWithPriority, CUresult, CUstream *, unsigned, int)                                            \
  F(cuStreamDestroy_v2, CUresult, CUstream)                                                                     \
  F(cuStreamSynchronize, CUresult, CUstream)                                                                    \
  F(cuStreamQuery, CUresult, CUstream)                                                                          \
  F(cuStreamWaitEvent, CUresult, CUstream, CUevent, unsigned)                                                   \
  F(cuEventCreate, CUresult, CUevent *, unsigned)                                                               \
  F(cuEventDestroy_v2, CUresult, CUevent)                                                                       \
  F(cuEventRecord, CUresult, CUevent, CUstream)                                                                 \
  F(cuEventQuery, CUresult, CUevent)                                                                            \
  F(cuEventSynchronize, CUresult, CUevent)                                                                      \
  F(cuEventElapsedTime, CUresult, float *, CUevent, CUevent)

// An edge of a graph, as drivers know it from CUDA 12.3 on (CUgraphEdgeData).
struct GraphEdge {
  unsigned char from_port, to_port, type, reserved[5];
};

// Those that a driver need not have: of CUDA 11.8 and 12.0 …
#define QSES_DRIVER_NEWER_FUNCTIONS(F)                                                \
  F(cuLaunchKernelEx, CUresult, const CUlaunchConfig *, CUfunction, void **, void **) \
  F(cuCtxGetId, CUresult, CUcontext, unsigned long long *)

// … for graphs of kernels, and edges of CUDA 12.3 in them …
#define QSES_DRIVER_GRAPH_FUNCTIONS(F)                                                                      \
  F(cuGraphCreate, CUresult, CUgraph *, unsigned)                                                           \
  F(cuGraphAddKernelNode, CUresult, CUgraphNode *, CUgraph, const CUgraphNode *, size_t,                    \
    const CUDA_KERNEL_NODE_PARAMS_v1 *)                                                                     \
  F(cuGraphInstantiateWithFlags, CUresult, CUgraphExec *, CUgraph, unsigned long long)                      \
  F(cuGraphExecKernelNodeSetParams, CUresult, CUgraphExec, CUgraphNode, const CUDA_KERNEL_NODE_PARAMS_v1 *) \
  F(cuGraphLaunch, CUresult, CUgraphExec, CUstream)                                                         \
  F(cuGraphExecDestroy, CUresult, CUgraphExec)                                                              \
  F(cuGraphDestroy, CUresult, CUgraph)
#define QSES_DRIVER_EDGE_FUNCTIONS(F) \
  F(cuGraphAddDependencies_v2, CUresult, CUgraph, const CUgraphNode *, const CUgraphNode *, const GraphEdge *, size_t)

// … and for buffers of graphics APIs.
#if defined(_WIN32)
#define QSES_DRIVER_D3D11_FUNCTIONS(F)                                                       \
  F(cuD3D11GetDevices, CUresult, unsigned *, CUdevice *, unsigned, ID3D11Device *, unsigned) \
  F(cuGraphicsD3D11RegisterResource, CUresult, CUgraphicsResource *, ID3D11Resource *, unsigned)
#else
#define QSES_DRIVER_D3D11_FUNCTIONS(F)
#endif
#define QSES_DRIVER_OPENGL_FUNCTIONS(F)                                      \
  F(cuGLGetDevices_v2, CUresult, unsigned *, CUdevice *, unsigned, unsigned) \
  F(cuGraphicsGLRegisterBuffer, CUresult, CUgraphicsResource *, unsigned, unsigned)
#define QSES_DRIVER_MAPPING_FUNCTIONS(F)                                                          \
  F(cuGraphicsResourceSetMapFlags_v2, CUresult, CUgraphicsResource, unsigned)                     \
  F(cuGraphicsMapResources, CUresult, unsigned, CUgraphicsResource *, CUstream)                   \
  F(cuGraphicsResourceGetMappedPointer_v2, CUresult, CUdeviceptr *, size_t *, CUgraphicsResource) \
  F(cuGraphicsUnmapResources, CUresult, unsigned, CUgraphicsResource *, CUstream)                 \
  F(cuGraphicsUnregisterResource, CUresult, CUgraphicsResource)
#define QSES_DRIVER_GRAPHICS_FUNCTIONS(F) \
  QSES_DRIVER_OPENGL_FUNCTIONS(F)         \
  QSES_DRIVER_D3D11_FUNCTIONS(F)          \
  QSES_DRIVER_MAPPING_FUNCTIONS(F)

template <class Result, class... Arguments>
using DriverFunction = Result(CUDAAPI *)(Arguments...);

struct Driver {
#define QSES_DRIVER_MEMBER(name, ...) DriverFunction<__VA_ARGS__> name = nullptr;
  QSES_DRIVER_FUNCTIONS(QSES_DRIVER_MEMBER)
  QSES_DRIVER_NEWER_FUNCTIONS(QSES_DRIVER_MEMBER)
  QSES_DRIVER_GRAPH_FUNCTIONS(QSES_DRIVER_MEMBER)
  QSES_DRIVER_EDGE_FUNCTIONS(QSES_DRIVER_MEMBER)
  QSES_DRIVER_GRAPHICS_FUNCTIONS(QSES_DRIVER_MEMBER)
#undef QSES_DRIVER_MEMBER
  // Whether it has all that is asked of it for graphs of kernels, or for buffers of a graphics API.
#define QSES_DRIVER_HAS(name, ...) &&name
  bool has_graphs() const { return true QSES_DRIVER_GRAPH_FUNCTIONS(QSES_DRIVER_HAS); }
  bool has_opengl() const {
    return true QSES_DRIVER_OPENGL_FUNCTIONS(QSES_DRIVER_HAS) QSES_DRIVER_MAPPING_FUNCTIONS(QSES_DRIVER_HAS);
  }
  bool has_direct3d11() const {
    return true QSES_DRIVER_D3D11_FUNCTIONS(QSES_DRIVER_HAS) QSES_DRIVER_MAPPING_FUNCTIONS(QSES_DRIVER_HAS);
  }
#undef QSES_DRIVER_HAS
  // Whether its functions can be called: CUDA_SUCCESS; CUDA_ERROR_STUB_LIBRARY where there is none, an older one,
  // one that lacks a function, or the toolkit's stub; else what cuInit or cuDriverGetVersion returned.
  CUresult state = CUDA_ERROR_STUB_LIBRARY;
  std::string refusal;  // for CUDA_ERROR_STUB_LIBRARY: what is wrong and what to do, as the end of a sentence
};

// Loads and starts the driver when it is first called; may take a second then. Thread-safe.
const Driver &driver();

}  // namespace cudart
}  // namespace quickses
