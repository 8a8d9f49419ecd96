// SPDX-License-Identifier: MIT
#pragma once

#include "quickses/quickses_gpu.h"

#include <atomic>
#include <chrono>

namespace quickses {

// How long meshes wait for their events. Others than tests leave it as it is.
inline std::atomic<std::chrono::milliseconds> gpu_patience{std::chrono::milliseconds(QSES_GPU_PATIENCE_MS)};

}  // namespace quickses
