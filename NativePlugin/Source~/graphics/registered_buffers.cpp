// SPDX-License-Identifier: MIT
#include "graphics/registered_buffers.h"

#include "cudart/driver.h"
#include "graphics/graphics_api.h"
#include "parallel/cuda_memory.h"
#include "parallel/error.h"

#include <cuda_runtime_api.h>

#include <algorithm>

namespace quickses {
namespace {

bool are_the_same(const qses_gpu_buffers &a, const qses_gpu_buffers &b) {
  return a.graphics == b.graphics && a.generation == b.generation && a.vertices == b.vertices && a.colors == b.colors &&
         a.owners == b.owners && a.texcoords == b.texcoords && a.indices == b.indices &&
         a.vertex_capacity == b.vertex_capacity && a.index_capacity == b.index_capacity;
}

// The surface must be where it is drawn: there is no way from one GPU's memory into buffers of another one.
void require_same_device(const GraphicsApi &api, const qses_gpu_buffers &buffers, int device) {
  const std::vector<int> drawing = api.drawing_devices(buffers.vertices);
  if (std::find(drawing.begin(), drawing.end(), device) != drawing.end()) return;
  throw Error(QSES_BACKEND_UNAVAILABLE,
              drawing.empty() ? std::string("what draws with ") + api.name + " on this thread is no CUDA device"
                              : "the surface is computed on CUDA device " + std::to_string(device) + ", but " +
                                    std::to_string(drawing.front()) + " draws");
}

}  // namespace

const GraphicsApi &graphics_api(qses_graphics graphics) {
  if (graphics == QSES_GRAPHICS_OPENGL) return opengl();
  if (graphics == QSES_GRAPHICS_D3D11) return direct3d11();
  invalid("graphics is " + std::to_string(static_cast<int>(graphics)) + ", which names nothing in the header");
}

void require_graphics(qses_graphics graphics) {
  const GraphicsApi &api = graphics_api(graphics);
  const bool has_started = cudart::driver().state == CUDA_SUCCESS;
  const std::string refusal = has_started ? api.refusal() : describe_cuda_device(0).reason;
  if (!refusal.empty())
    throw Error(QSES_BACKEND_UNAVAILABLE, std::string("buffers of ") + api.name + " can't be written: " + refusal);
}

void RegisteredBuffers::use(const qses_gpu_buffers &buffers, int device) {
  if (count_ > 0 && are_the_same(buffers, known_)) return;
  forget();
  const GraphicsApi &api = graphics_api(buffers.graphics);
  require_same_device(api, buffers, device);
  const uint64_t names[kMost] = {buffers.vertices, buffers.colors, buffers.owners, buffers.texcoords, buffers.indices};
  place_.fill(-1);
  try {
    for (size_t which = 0; which < kMost; ++which) {
      if (names[which] == 0) continue;
      resources_[count_] = api.register_buffer(names[which]);
      place_[which] = static_cast<int>(count_++);
      ++registrations_;
    }
  } catch (...) {
    forget();
    throw;
  }
  known_ = buffers;
}

void RegisteredBuffers::forget() noexcept {
  bool may = count_ > 0 && may_hand_back();
  while (count_ > 0) {
    --count_;
    if (!may || cudaGraphicsUnregisterResource(resources_[count_]) == cudaSuccess) continue;
    cudaGetLastError();
    may = may_hand_back();
  }
}

void *RegisteredBuffers::address(Which which, size_t bytes) const {
  const int place = place_[which];
  if (place < 0) return nullptr;
  void *address = nullptr;
  size_t room = 0;
  check_cuda(cudaGraphicsResourceGetMappedPointer(&address, &room, resources_[static_cast<size_t>(place)]),
             "cudaGraphicsResourceGetMappedPointer");
  if (room < bytes)
    invalid("a buffer has " + std::to_string(room) + " bytes, but " + std::to_string(bytes) + " are to be written");
  return address;
}

}  // namespace quickses
