// SPDX-License-Identifier: MIT
// What differs between graphics APIs: which GPU draws, and how a buffer is made known to CUDA. On the thread that
// draws.
#pragma once

#include "quickses/quickses_gpu.h"

#include <string>
#include <vector>

struct cudaGraphicsResource;

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

const GraphicsApi &opengl();
const GraphicsApi &direct3d11();

// Throws Error (INVALID_ARGUMENT) for another number.
const GraphicsApi &graphics_api(qses_graphics graphics);

}  // namespace quickses
