// SPDX-License-Identifier: MIT
// CUDA Runtime API, "Device Management".
#include "cudart/current_context.h"

namespace quickses {
namespace cudart {

CUresult find_ordinal(CUdevice handle, int *ordinal) {
  int count = 0;
  *ordinal = -1;
  CUresult result = driver().cuDeviceGetCount(&count);
  for (int k = 0; k < count && result == CUDA_SUCCESS && *ordinal < 0; ++k) {
    CUdevice there = 0;
    result = driver().cuDeviceGet(&there, k);
    if (there == handle) *ordinal = k;
  }
  return result;
}

}  // namespace cudart
}  // namespace quickses

using namespace quickses::cudart;

extern "C" {

cudaError_t CUDARTAPI cudaGetDeviceCount(int *count) {
  *count = 0;
  if (const cudaError_t error = start()) return remember(error);
  return remember(driver().cuDeviceGetCount(count));
}

// The device of the thread's current context. Where there is none yet, or the driver can't tell any more: that of
// selected_device(). So it fails only without a driver: CUB (1.17, util_device.cuh) does not look whether
// it has, and would go on with entry -1 of an array.
cudaError_t CUDARTAPI cudaGetDevice(int *device) {
  *device = selected_device();
  if (const cudaError_t error = start()) return remember(error);
  CUdevice current = 0;
  if (driver().cuCtxGetDevice(&current) != CUDA_SUCCESS) return cudaSuccess;
  int ordinal = -1;
  if (find_ordinal(current, &ordinal) == CUDA_SUCCESS && ordinal >= 0) *device = ordinal;
  return cudaSuccess;
}

// Makes the device's primary context the thread's, and starts the device if nobody has yet.
cudaError_t CUDARTAPI cudaSetDevice(int device) {
  if (const cudaError_t error = start()) return remember(error);
  return remember(make_current(device));
}

// cudaDeviceAttr has the numbers of CUdevice_attribute (driver_types.h).
cudaError_t CUDARTAPI cudaDeviceGetAttribute(int *value, cudaDeviceAttr attribute, int device) {
  if (const cudaError_t error = start()) return remember(error);
  CUdevice handle = 0;
  CUresult result = driver().cuDeviceGet(&handle, device);
  if (result == CUDA_SUCCESS)
    result = driver().cuDeviceGetAttribute(value, static_cast<CUdevice_attribute>(attribute), handle);
  return remember(result);
}

}  // extern "C"
