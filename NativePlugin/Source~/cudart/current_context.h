// SPDX-License-Identifier: MIT
// The state behind the functions of CUDA's runtime: which device a thread has selected, and its last error.
//
// A thread's device is that of its current context, as in NVIDIA's runtime (CUDA Runtime API, "Interactions with the
// CUDA Driver API"): so code with another runtime, or with none, may share the thread.
#pragma once

#include "cudart/driver.h"

#include <cuda_runtime_api.h>

#include <cstddef>

namespace quickses {
namespace cudart {

constexpr int kMostDevices = 64;

// Keeps a failure for cudaGetLastError of this thread. Returns it.
cudaError_t remember(cudaError_t error);
// The two lists of numbers agree since CUDA 10.1 (driver_types.h), but for the stand-in for a missing driver.
cudaError_t remember(CUresult result);

// cudaSuccess once the driver has started.
cudaError_t start();

// Makes the primary context of a device the thread's. It is retained for good when it is first asked for: other users
// of CUDA in the process share it. CUDA_ERROR_CONTEXT_IS_DESTROYED from then on if one of them resets the device.
CUresult make_current(int device);

// The same for any device that is in use: CUDA_SUCCESS if none was reset. Then what we hold there is gone, and the
// driver must not be given it: it reads what the handles point to.
CUresult look_for_resets();

// The device that the thread made current last. If it never did: one that is in use already, so that a thread which
// only gives memory back starts no other; else 0.
int selected_device();

// The ordinal of a device of the driver; -1: it has none.
CUresult find_ordinal(CUdevice handle, int *ordinal);

// The device whose primary context is current; -1 if the current one is another's, which has none of our kernels.
int current_device();

// Sees that the thread has a context: the one it has, else that of selected_device().
cudaError_t enter();

// Calls a function of the driver with a context.
template <class Call>
cudaError_t inside(Call call) {
  if (const cudaError_t error = enter()) return remember(error);
  return remember(call(driver()));
}

}  // namespace cudart
}  // namespace quickses
