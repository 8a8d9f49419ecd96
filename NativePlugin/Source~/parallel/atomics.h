// SPDX-License-Identifier: MIT
// Atomic operations on integers that several threads of a pass may meet on. Integers only: their sums do not depend on
// the order, so the results are the same in every run and on both back ends. None of them orders other memory.
#pragma once

#include "parallel/platform.h"

#include <type_traits>

namespace quickses {

#if defined(__CUDA_ARCH__)
// The name that CUDA's functions have for integers of 32 or 64 bits. Two's complement: it serves signed ones, too.
template <class T>
using CudaWord = typename std::conditional<sizeof(T) == 4, unsigned int, unsigned long long>::type;
template <class T>
QSES_FN CudaWord<T> *cuda_word(T *p) {
  return reinterpret_cast<CudaWord<T> *>(p);
}
#endif

// T is a 32-bit or 64-bit integer. Returns the value before.
template <class T>
QSES_FN T atomic_add(T *p, T value) {
  static_assert(std::is_integral<T>::value && (sizeof(T) == 4 || sizeof(T) == 8), "32-bit and 64-bit integers only");
#if defined(__CUDA_ARCH__)
  return static_cast<T>(atomicAdd(cuda_word(p), static_cast<CudaWord<T>>(value)));
#else
  return __atomic_fetch_add(p, value, __ATOMIC_RELAXED);
#endif
}

// T is an unsigned integer of 8 or 32 bits. What is loaded others may change meanwhile.
template <class T>
QSES_FN T atomic_load(const T *p) {
  static_assert(std::is_unsigned<T>::value && (sizeof(T) == 1 || sizeof(T) == 4), "bytes and 32-bit words only");
#if defined(__CUDA_ARCH__)
  return *static_cast<const volatile T *>(p);
#else
  return __atomic_load_n(p, __ATOMIC_RELAXED);
#endif
}
template <class T>
QSES_FN void atomic_store(T *p, T value) {
  static_assert(std::is_unsigned<T>::value && (sizeof(T) == 1 || sizeof(T) == 4), "bytes and 32-bit words only");
#if defined(__CUDA_ARCH__)
  *static_cast<volatile T *>(p) = value;
#else
  __atomic_store_n(p, value, __ATOMIC_RELAXED);
#endif
}

// Sets a flag of one byte.
QSES_FN void atomic_set(uint8_t *flag) { atomic_store(flag, uint8_t(1)); }

// Returns the value before.
QSES_FN uint32_t atomic_exchange(uint32_t *p, uint32_t value) {
#if defined(__CUDA_ARCH__)
  return atomicExch(p, value);
#else
  return __atomic_exchange_n(p, value, __ATOMIC_RELAXED);
#endif
}

// T is an unsigned integer of 32 or 64 bits.
template <class T>
QSES_FN void atomic_or(T *p, T bits) {
  static_assert(std::is_unsigned<T>::value && (sizeof(T) == 4 || sizeof(T) == 8), "32-bit and 64-bit words only");
#if defined(__CUDA_ARCH__)
  atomicOr(cuda_word(p), static_cast<CudaWord<T>>(bits));
#else
  __atomic_fetch_or(p, bits, __ATOMIC_RELAXED);
#endif
}

template <class T>
QSES_FN void atomic_and(T *p, T bits) {
  static_assert(std::is_unsigned<T>::value && (sizeof(T) == 4 || sizeof(T) == 8), "32-bit and 64-bit words only");
#if defined(__CUDA_ARCH__)
  atomicAnd(cuda_word(p), static_cast<CudaWord<T>>(bits));
#else
  __atomic_fetch_and(p, bits, __ATOMIC_RELAXED);
#endif
}

// The same. Returns the value before.
template <class T>
QSES_FN T atomic_min(T *p, T value) {
  static_assert(std::is_unsigned<T>::value && (sizeof(T) == 4 || sizeof(T) == 8), "32-bit and 64-bit words only");
#if defined(__CUDA_ARCH__)
  return static_cast<T>(atomicMin(cuda_word(p), static_cast<CudaWord<T>>(value)));
#else
  T before = __atomic_load_n(p, __ATOMIC_RELAXED);
  while (value < before && !__atomic_compare_exchange_n(p, &before, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
  return before;
#endif
}

// Returns the value before.
QSES_FN uint32_t atomic_max(uint32_t *p, uint32_t value) {
#if defined(__CUDA_ARCH__)
  return atomicMax(p, value);
#else
  uint32_t before = __atomic_load_n(p, __ATOMIC_RELAXED);
  while (value > before && !__atomic_compare_exchange_n(p, &before, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
  return before;
#endif
}

}  // namespace quickses
