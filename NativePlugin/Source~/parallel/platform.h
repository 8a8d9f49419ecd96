// SPDX-License-Identifier: MIT
// Compiler-dependent words that let one function serve the GPU and the CPU.
#pragma once

#include <cstddef>
#include <cstdint>

// QSES_FN: a small function of geometry or bit arithmetic. It is always inlined, so that the CPU kernels, which are
// compiled once per instruction set, never leave a copy behind that the linker could hand to the other ones.
#if defined(__CUDACC__)
#define QSES_HOST_DEVICE __host__ __device__
#define QSES_FN __host__ __device__ __forceinline__
#else
#define QSES_HOST_DEVICE
#define QSES_FN inline __attribute__((always_inline))
#endif

// GLM must know before its first inclusion that its functions run on both sides; its own inlining is forced for the
// same reason as ours.
#if defined(__CUDACC__)
#include <cuda.h>  // CUDA_VERSION, which GLM asks for
#ifndef GLM_FORCE_CUDA
#define GLM_FORCE_CUDA
#endif
#endif
#ifndef GLM_FORCE_INLINE
#define GLM_FORCE_INLINE
#endif

namespace quickses {

QSES_FN int popcount32(uint32_t v) {
#if defined(__CUDA_ARCH__)
  return __popc(v);
#else
  return __builtin_popcount(v);
#endif
}

QSES_FN int popcount64(uint64_t v) {
#if defined(__CUDA_ARCH__)
  return __popcll(v);
#else
  return __builtin_popcountll(v);
#endif
}

// Number of the lowest set bit; v must not be 0.
QSES_FN int lowest_bit64(uint64_t v) {
#if defined(__CUDA_ARCH__)
  return __ffsll(static_cast<long long>(v)) - 1;
#else
  return __builtin_ctzll(v);
#endif
}

QSES_FN int lowest_bit32(uint32_t v) {
#if defined(__CUDA_ARCH__)
  return __ffs(static_cast<int>(v)) - 1;
#else
  return lowest_bit64(v);
#endif
}

// Number of the highest.
QSES_FN int highest_bit32(uint32_t v) {
#if defined(__CUDA_ARCH__)
  return 31 - __clz(static_cast<int>(v));
#else
  return 31 - __builtin_clz(v);
#endif
}

// Number of the set bit with n others below it, if v has more than n.
QSES_FN int nth_bit32(uint32_t v, int n) {
  int at = 0;
  for (int width = 16; width > 0; width >>= 1) {
    const int below = popcount32(v & ((uint32_t(1) << width) - 1));
    if (n < below) continue;
    n -= below;
    v >>= width;
    at += width;
  }
  return at;
}
QSES_FN int nth_bit64(uint64_t v, int n) {
  const uint32_t low = static_cast<uint32_t>(v);
  const int below = popcount32(low);
  const bool in_low = n < below;
  return (in_low ? 0 : 32) + nth_bit32(in_low ? low : static_cast<uint32_t>(v >> 32), in_low ? n : n - below);
}

}  // namespace quickses
