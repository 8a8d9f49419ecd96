// SPDX-License-Identifier: MIT
#include "cudart/current_context.h"

#include <array>
#include <atomic>
#include <mutex>

namespace quickses {
namespace cudart {
namespace {

thread_local cudaError_t last_error = cudaSuccess;
thread_local int last_selected = -1;

struct PrimaryContext {
  std::mutex mutex;
  std::atomic<CUcontext> handle{nullptr};
  unsigned long long id = 0;  // as it was retained; set before the handle
};
// Never destroyed: threads may be in here as the process ends.
std::array<PrimaryContext, kMostDevices> &primary_contexts() {
  static auto &contexts = *new std::array<PrimaryContext, kMostDevices>;
  return contexts;
}

// A number that no other context of the process has had. After a reset there is none, and once somebody uses the device
// again another one, though the handle is the same. Before CUDA 12.0 only the former can be told.
CUresult context_id(CUcontext context, unsigned long long *id) {
  if (driver().cuCtxGetId) return driver().cuCtxGetId(context, id);
  unsigned version = 0;
  *id = 0;
  const CUresult result = driver().cuCtxGetApiVersion(context, &version);
  return result == CUDA_ERROR_INVALID_CONTEXT ? CUDA_ERROR_CONTEXT_IS_DESTROYED : result;
}

CUresult look_for_reset(const PrimaryContext &primary, CUcontext context) {
  unsigned long long id = 0;
  const CUresult result = context_id(context, &id);
  return result == CUDA_SUCCESS && id != primary.id ? CUDA_ERROR_CONTEXT_IS_DESTROYED : result;
}

CUresult primary_context(int device, CUcontext *context) {
  if (device < 0 || device >= kMostDevices) return CUDA_ERROR_INVALID_DEVICE;
  PrimaryContext &primary = primary_contexts()[static_cast<size_t>(device)];
  *context = primary.handle.load(std::memory_order_acquire);
  if (*context) return look_for_reset(primary, *context);
  const std::lock_guard<std::mutex> lock(primary.mutex);
  *context = primary.handle.load(std::memory_order_relaxed);
  if (*context) return look_for_reset(primary, *context);
  CUdevice handle = 0;
  CUresult result = driver().cuDeviceGet(&handle, device);
  // What fails is tried again by the next call: memory may be short now and not later.
  if (result == CUDA_SUCCESS) result = driver().cuDevicePrimaryCtxRetain(context, handle);
  if (result == CUDA_SUCCESS) result = context_id(*context, &primary.id);
  if (result == CUDA_SUCCESS) primary.handle.store(*context, std::memory_order_release);
  return result;
}

}  // namespace

cudaError_t remember(cudaError_t error) {
  if (error != cudaSuccess) last_error = error;
  return error;
}
cudaError_t remember(CUresult result) {
  return remember(result == CUDA_ERROR_STUB_LIBRARY ? cudaErrorInsufficientDriver : static_cast<cudaError_t>(result));
}

cudaError_t start() {
  const CUresult state = driver().state;
  return state == CUDA_ERROR_STUB_LIBRARY ? cudaErrorInsufficientDriver : static_cast<cudaError_t>(state);
}

CUresult make_current(int device) {
  CUcontext context = nullptr;
  CUresult result = primary_context(device, &context);
  if (result == CUDA_SUCCESS) result = driver().cuCtxSetCurrent(context);
  if (result == CUDA_SUCCESS) last_selected = device;
  return result;
}

CUresult look_for_resets() {
  for (const PrimaryContext &primary : primary_contexts())
    if (const CUcontext context = primary.handle.load(std::memory_order_acquire))
      if (const CUresult result = look_for_reset(primary, context)) return result;
  return CUDA_SUCCESS;
}

int selected_device() {
  if (last_selected >= 0) return last_selected;
  for (int device = 0; device < kMostDevices; ++device)
    if (primary_contexts()[static_cast<size_t>(device)].handle.load(std::memory_order_acquire)) return device;
  return 0;
}

int current_device() {
  CUcontext current = nullptr;
  if (driver().cuCtxGetCurrent(&current) != CUDA_SUCCESS || !current) return -1;
  for (int device = 0; device < kMostDevices; ++device)
    if (primary_contexts()[static_cast<size_t>(device)].handle.load(std::memory_order_acquire) == current)
      return device;
  return -1;
}

cudaError_t enter() {
  if (const cudaError_t error = start()) return error;
  CUcontext current = nullptr;
  CUresult result = driver().cuCtxGetCurrent(&current);
  if (result == CUDA_SUCCESS && !current) result = make_current(selected_device());
  return static_cast<cudaError_t>(result);
}

}  // namespace cudart
}  // namespace quickses

using namespace quickses::cudart;

extern "C" {

// ---- CUDA Runtime API, "Error Handling" -----------------------------------------------------------------------------

// The last error of the calling thread, which is reset.
cudaError_t CUDARTAPI cudaGetLastError() {
  const cudaError_t error = last_error;
  last_error = cudaSuccess;
  return error;
}
// The same, not reset.
cudaError_t CUDARTAPI cudaPeekAtLastError() { return last_error; }

// Strings that live as long as the process; never null. Without a driver, why there is none.
const char *CUDARTAPI cudaGetErrorName(cudaError_t error) {
  const char *name = nullptr;
  if (error == cudaErrorInsufficientDriver) return "cudaErrorInsufficientDriver";  // the driver has no such number
  if (driver().cuGetErrorName) driver().cuGetErrorName(static_cast<CUresult>(error), &name);
  return name ? name : "unrecognized error code";
}
const char *CUDARTAPI cudaGetErrorString(cudaError_t error) {
  const char *text = nullptr;
  if (error == cudaErrorInsufficientDriver) return driver().refusal.c_str();
  if (driver().cuGetErrorString) driver().cuGetErrorString(static_cast<CUresult>(error), &text);
  return text ? text : "unrecognized error code";
}

}  // extern "C"
