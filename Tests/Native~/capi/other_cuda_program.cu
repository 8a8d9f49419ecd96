// SPDX-License-Identifier: MIT
#include "capi/other_cuda_program.h"

#include <cuda_runtime.h>

#include <string>
#include <vector>

namespace {

constexpr unsigned kCount = 1 << 20;
constexpr int kKernels = 8;

__global__ void step(unsigned *numbers, unsigned count) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < count) numbers[i] = numbers[i] * 1664525u + 1013904223u + i;
}

unsigned *numbers = nullptr;
unsigned *pinned = nullptr;
cudaStream_t stream = nullptr;
std::vector<unsigned> expected;
std::string wrong;

bool is_well(cudaError_t error, const char *call) {
  if (error == cudaSuccess) return true;
  wrong = std::string(call) + ": " + cudaGetErrorString(error);
  return false;
}
#define IS_WELL(call) is_well(call, #call)

}  // namespace

bool other_start() {
  expected.assign(kCount, 0);
  return IS_WELL(cudaSetDevice(0)) && IS_WELL(cudaMalloc(&numbers, kCount * sizeof(unsigned))) &&
         IS_WELL(cudaMallocHost(&pinned, kCount * sizeof(unsigned))) &&
         IS_WELL(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking)) &&
         IS_WELL(cudaMemsetAsync(numbers, 0, kCount * sizeof(unsigned), stream)) &&
         IS_WELL(cudaStreamSynchronize(stream));
}

const char *other_work() {
  wrong.clear();
  int device = -1;
  if (!IS_WELL(cudaGetLastError()) || !IS_WELL(cudaGetDevice(&device))) return wrong.c_str();
  if (device != 0) return "another device is selected";
  for (int k = 0; k < kKernels; ++k) {
    step<<<(kCount + 255) / 256, 256, 0, stream>>>(numbers, kCount);
    for (unsigned i = 0; i < kCount; ++i) expected[i] = expected[i] * 1664525u + 1013904223u + i;
  }
  if (!IS_WELL(cudaGetLastError()) ||
      !IS_WELL(cudaMemcpyAsync(pinned, numbers, kCount * sizeof(unsigned), cudaMemcpyDeviceToHost, stream)) ||
      !IS_WELL(cudaStreamSynchronize(stream)))
    return wrong.c_str();
  for (unsigned i = 0; i < kCount; ++i)
    if (pinned[i] != expected[i]) return "its memory was written to";
  return "";
}

bool other_reset() { return IS_WELL(cudaDeviceReset()); }

void other_end() {
  cudaStreamDestroy(stream);
  cudaFreeHost(pinned);
  cudaFree(numbers);
}
