// SPDX-License-Identifier: MIT
// OpenGL: CUDA Runtime API, "OpenGL Interoperability". Declared here as cuda_gl_interop.h does, which asks for GL's own
// headers.
#include "cudart/driver.h"
#include "graphics/graphics_api.h"

extern "C" {
cudaError_t CUDARTAPI cudaGLGetDevices(unsigned *count, int *devices, unsigned room, unsigned list);
cudaError_t CUDARTAPI cudaGraphicsGLRegisterBuffer(cudaGraphicsResource **resource, unsigned buffer, unsigned flags);
}

namespace quickses {
namespace {

std::string refusal() {
  return cudart::driver().has_opengl() ? "" : "the NVIDIA driver can't share buffers with OpenGL";
}

std::vector<int> drawing_devices(uint64_t) {
  constexpr unsigned kAll = 1;  // cudaGLDeviceListAll
  return list_devices("cudaGLGetDevices", [](unsigned *count, int *devices, unsigned room) {
    return cudaGLGetDevices(count, devices, room, kAll);
  });
}

cudaGraphicsResource *register_buffer(uint64_t buffer) {
  cudaGraphicsResource *resource = nullptr;
  check_cuda(
      cudaGraphicsGLRegisterBuffer(&resource, static_cast<unsigned>(buffer), cudaGraphicsRegisterFlagsWriteDiscard),
      "cudaGraphicsGLRegisterBuffer");
  return resource;
}

}  // namespace

const GraphicsApi &opengl() {
  static const GraphicsApi api = {"OpenGL", refusal, drawing_devices, register_buffer};
  return api;
}

}  // namespace quickses
