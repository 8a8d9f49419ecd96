// SPDX-License-Identifier: MIT
// Kernels as the driver knows them.
#pragma once

#include "cudart/current_context.h"

namespace quickses {
namespace cudart {

// A kernel on a device.
struct LoadedKernel {
  CUfunction function = nullptr;
  int architecture = 0;
  // Whether it may be sent before those queued ahead of it are done. Code for GPUs before Hopper has no way to wait for
  // them.
  bool may_overlap() const { return driver().cuLaunchKernelEx && architecture >= 90; }
};

// The kernel behind a stub, on the thread's device. The first kernel of a source loads the device code of all of it;
// on a GPU newer than the toolkit the driver compiles it then, which takes seconds.
CUresult find_kernel(const void *stub, LoadedKernel *found_kernel);

}  // namespace cudart
}  // namespace quickses
