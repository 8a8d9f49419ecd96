// SPDX-License-Identifier: MIT
// Atomic operations on integers that several threads of a pass may meet on. Integers only: their sums do not depend on
// the order, so the results are the same in every run and on both back ends. None of them orders other memory.
#pragma once

#include "parallel/platform.h"

#include <type_traits>

namespace quickses {

// T is a 32-bit or 64-bit integer. Returns the value before.
template <class T>
QSES_FN T atomic_add(T *p, T value) {
  static_assert(std::is_integral<T>::value && (sizeof(T) == 4 || sizeof(T) == 8), "32-bit and 64-bit integers only");
#if defined(__CUDA_ARCH__)
  // Two's complement: one addition serves signed and unsigned.
  if constexpr (sizeof(T) == 4)
    return static_cast<T>(atomicAdd(reinterpret_cast<unsigned int *>(p), static_cast<unsigned int>(value)));
  else
    return static_cast<T>(atomicAdd(reinterpret_cast<unsigned long long *>(p), static_cast<unsigned long long>(value)));
#else
  return __atomic_fetch_add(p, value, __ATOMIC_RELAXED);
#endif
}

QSES_FN uint32_t atomic_load(const uint32_t *p) {
#if defined(__CUDA_ARCH__)
  return *reinterpret_cast<const volatile uint32_t *>(p);
#else
  return __atomic_load_n(p, __ATOMIC_RELAXED);
#endif
}

QSES_FN void atomic_store(uint32_t *p, uint32_t value) {
#if defined(__CUDA_ARCH__)
  *reinterpret_cast<volatile uint32_t *>(p) = value;
#else
  __atomic_store_n(p, value, __ATOMIC_RELAXED);
#endif
}

// Sets a flag of one byte.
QSES_FN void atomic_set(uint8_t *flag) {
#if defined(__CUDA_ARCH__)
  *flag = 1;
#else
  __atomic_store_n(flag, uint8_t(1), __ATOMIC_RELAXED);
#endif
}

// A byte that others may set meanwhile.
QSES_FN uint8_t atomic_load(const uint8_t *p) {
#if defined(__CUDA_ARCH__)
  return *reinterpret_cast<const volatile uint8_t *>(p);
#else
  return __atomic_load_n(p, __ATOMIC_RELAXED);
#endif
}
QSES_FN void atomic_store(uint8_t *p, uint8_t value) {
#if defined(__CUDA_ARCH__)
  *reinterpret_cast<volatile uint8_t *>(p) = value;
#else
  __atomic_store_n(p, value, __ATOMIC_RELAXED);
#endif
}

// Returns the value before.
QSES_FN uint32_t atomic_exchange(uint32_t *p, uint32_t value) {
#if defined(__CUDA_ARCH__)
  return atomicExch(p, value);
#else
  return __atomic_exchange_n(p, value, __ATOMIC_RELAXED);
#endif
}

QSES_FN void atomic_or(uint32_t *p, uint32_t bits) {
#if defined(__CUDA_ARCH__)
  atomicOr(p, bits);
#else
  __atomic_fetch_or(p, bits, __ATOMIC_RELAXED);
#endif
}
QSES_FN void atomic_or(uint64_t *p, uint64_t bits) {
#if defined(__CUDA_ARCH__)
  atomicOr(reinterpret_cast<unsigned long long *>(p), static_cast<unsigned long long>(bits));
#else
  __atomic_fetch_or(p, bits, __ATOMIC_RELAXED);
#endif
}

// Returns the value before.
QSES_FN uint32_t atomic_min(uint32_t *p, uint32_t value) {
#if defined(__CUDA_ARCH__)
  return atomicMin(p, value);
#else
  uint32_t before = __atomic_load_n(p, __ATOMIC_RELAXED);
  while (value < before && !__atomic_compare_exchange_n(p, &before, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
  return before;
#endif
}

QSES_FN uint64_t atomic_min(uint64_t *p, uint64_t value) {
#if defined(__CUDA_ARCH__)
  return atomicMin(reinterpret_cast<unsigned long long *>(p), static_cast<unsigned long long>(value));
#else
  uint64_t before = __atomic_load_n(p, __ATOMIC_RELAXED);
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
