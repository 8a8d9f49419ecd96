// SPDX-License-Identifier: MIT
// For tests of the graphics event that are not about how long it is waited for.
#pragma once

#include "graphics/gpu_patience.h"
#include "process/patience.h"

// While it lives, meshes wait for their events however long the machine stands still in between.
class LongGpuPatience {
 public:
  LongGpuPatience() { begin(); }
  ~LongGpuPatience() { end(); }
  LongGpuPatience(const LongGpuPatience &) = delete;
  LongGpuPatience &operator=(const LongGpuPatience &) = delete;

  static void begin() { quickses::gpu_patience = kPatience; }
  // As long as is said to users.
  static void end() { quickses::gpu_patience = std::chrono::milliseconds(QSES_GPU_PATIENCE_MS); }
};
