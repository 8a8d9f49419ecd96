// SPDX-License-Identifier: MIT
// What differs between graphics APIs: which GPU draws, and how a buffer is made known to CUDA. On the thread that
// draws.
#pragma once

#include "parallel/cuda_memory.h"
#include "quickses/quickses_gpu.h"

#include <cuda_runtime_api.h>

#include <string>
#include <vector>

namespace quickses {

struct GraphicsApi {
  const char *name;
  // Why it can't be used with the driver that is installed; empty: it can.
  std::string (*refusal)();
  // CUDA ordinals of what draws. any_buffer: one of those that are to be written. Throws Error.
  std::vector<int> (*drawing_devices)(uint64_t any_buffer);
  // For writing only. Throws Error.
  cudaGraphicsResource *(*register_buffer)(uint64_t buffer);
};

// The devices that ask(count, devices, room) lists, as the functions cuda...GetDevices do; none where something else
// draws. Throws Error.
template <class Ask>
std::vector<int> list_devices(const char *call, const Ask &ask) {
  std::vector<int> devices(16);
  unsigned count = 0;
  const cudaError_t error = ask(&count, devices.data(), static_cast<unsigned>(devices.size()));
  if (error == cudaErrorNoDevice)
    count = 0, cudaGetLastError();
  else
    check_cuda(error, call);
  devices.resize(count);
  return devices;
}

const GraphicsApi &opengl();
const GraphicsApi &direct3d11();

// Throws Error (INVALID_ARGUMENT) for another number.
const GraphicsApi &graphics_api(qses_graphics graphics);

}  // namespace quickses
