// SPDX-License-Identifier: MIT
// GPU: copies into shared memory that are under way while their thread goes on (CUDA C++ Programming Guide,
// "Asynchronous Data Copies"); before compute capability 8.0 they are done at once.
#pragma once

#include <cstddef>
#include <cstdint>

namespace quickses {
namespace gpu {

// Of what no running kernel writes.
template <class T>
__device__ __forceinline__ void begin_copy(T *shared, const T *global) {
  constexpr size_t kUnit = 16;
  static_assert(sizeof(T) % kUnit == 0 && alignof(T) % kUnit == 0, "whole units");
#pragma unroll
  for (size_t k = 0; k < sizeof(T); k += kUnit) {
    char *const to = reinterpret_cast<char *>(shared) + k;
    const char *const from = reinterpret_cast<const char *>(global) + k;
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
    asm volatile("cp.async.ca.shared.global [%0], [%1], 16;" ::"r"(static_cast<uint32_t>(__cvta_generic_to_shared(to))),
                 "l"(from));
#else
    *reinterpret_cast<float4 *>(to) = *reinterpret_cast<const float4 *>(from);
#endif
  }
}

// For those that this thread began. Others see them once they have met it at a barrier behind.
__device__ __forceinline__ void wait_for_copies() {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
  asm volatile("cp.async.wait_all;" ::: "memory");
#endif
}

}  // namespace gpu
}  // namespace quickses
