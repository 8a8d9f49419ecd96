// SPDX-License-Identifier: MIT
// Direct3D 11: CUDA Runtime API, "Direct3D 11 Interoperability". Buffers must be of the default usage and not shared;
// that all of them is written is said with the map flags, since registering takes none for Direct3D.
#include "cudart/driver.h"
#include "graphics/graphics_api.h"
#include "parallel/error.h"

#if defined(_WIN32)
#include <d3d11.h>

extern "C" {
cudaError_t CUDARTAPI cudaD3D11GetDevices(unsigned *count, int *devices, unsigned room, ID3D11Device *d3d,
                                          unsigned list);
cudaError_t CUDARTAPI cudaGraphicsD3D11RegisterResource(cudaGraphicsResource **resource, ID3D11Resource *buffer,
                                                        unsigned flags);
}

namespace quickses {
namespace {

ID3D11Buffer *buffer_of(uint64_t pointer) { return reinterpret_cast<ID3D11Buffer *>(static_cast<uintptr_t>(pointer)); }

std::string refusal() {
  return cudart::driver().has_direct3d11() ? "" : "the NVIDIA driver can't share buffers with Direct3D 11";
}

std::vector<int> drawing_devices(uint64_t any_buffer) {
  constexpr unsigned kAll = 1;  // cudaD3D11DeviceListAll
  ID3D11Device *d3d = nullptr;
  buffer_of(any_buffer)->GetDevice(&d3d);
  return list_devices("cudaD3D11GetDevices", [&](unsigned *count, int *devices, unsigned room) {
    const cudaError_t error = cudaD3D11GetDevices(count, devices, room, d3d, kAll);
    if (d3d) d3d->Release();
    return error;
  });
}

cudaGraphicsResource *register_buffer(uint64_t pointer) {
  ID3D11Buffer *const buffer = buffer_of(pointer);
  D3D11_BUFFER_DESC description{};
  buffer->GetDesc(&description);
  if (description.Usage != D3D11_USAGE_DEFAULT || description.CPUAccessFlags != 0)
    throw Error(QSES_BACKEND_UNAVAILABLE,
                "CUDA can't write a buffer of Direct3D 11 that is not of the default usage (dynamic or immutable)");
  if (description.MiscFlags & (D3D11_RESOURCE_MISC_SHARED | D3D11_RESOURCE_MISC_SHARED_KEYEDMUTEX))
    throw Error(QSES_BACKEND_UNAVAILABLE, "CUDA can't write a shared buffer of Direct3D 11");
  cudaGraphicsResource *resource = nullptr;
  check_cuda(cudaGraphicsD3D11RegisterResource(&resource, buffer, cudaGraphicsRegisterFlagsNone),
             "cudaGraphicsD3D11RegisterResource");
  const cudaError_t error = cudaGraphicsResourceSetMapFlags(resource, cudaGraphicsMapFlagsWriteDiscard);
  if (error != cudaSuccess) cudaGraphicsUnregisterResource(resource);
  check_cuda(error, "cudaGraphicsResourceSetMapFlags");
  return resource;
}

}  // namespace
}  // namespace quickses
#else

namespace quickses {
namespace {

std::string refusal() { return "Direct3D 11 exists on Windows only"; }
std::vector<int> drawing_devices(uint64_t) { return {}; }
cudaGraphicsResource *register_buffer(uint64_t) { return nullptr; }

}  // namespace
}  // namespace quickses
#endif

namespace quickses {

const GraphicsApi &direct3d11() {
  static const GraphicsApi api = {"Direct3D 11", refusal, drawing_devices, register_buffer};
  return api;
}

}  // namespace quickses
