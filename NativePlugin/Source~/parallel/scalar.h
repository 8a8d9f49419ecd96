// SPDX-License-Identifier: MIT
// The functions of one float under the names that packs of floats have too, so that templates serve both.
#pragma once

#include "parallel/platform.h"

#include <cmath>

namespace quickses {

// The scalar counterparts of the pack functions in parallel/pack.h.
QSES_FN float square_root(float x) {
#if defined(__CUDA_ARCH__)
  float r;
  asm("sqrt.approx.ftz.f32 %0, %1;" : "=f"(r) : "f"(x));  // 1 ulp off at most, and a third of the instructions
  return r;
#else
  return std::sqrt(x);
#endif
}
QSES_FN float reciprocal_root(float x) {
#if defined(__CUDA_ARCH__)
  float r;
  asm("rsqrt.approx.ftz.f32 %0, %1;" : "=f"(r) : "f"(x));
  return r * (1.5f - 0.5f * x * r * r);
#else
  return 1.f / std::sqrt(x);
#endif
}
// a / b, on the GPU within 2 ulp.
template <class T>
QSES_FN T quotient(T a, T b) {
  return a / b;
}
QSES_FN float quotient(float a, float b) {
#if defined(__CUDA_ARCH__)
  float r;
  asm("div.approx.ftz.f32 %0, %1, %2;" : "=f"(r) : "f"(a), "f"(b));
  return r;
#else
  return a / b;
#endif
}
// A product that is rounded before anything is added to it. Left alone, the GPU's compiler would make one operation of
// the two, which rounds otherwise than those of the CPU do.
QSES_FN double rounded_product(double a, double b) {
#if defined(__CUDA_ARCH__)
  return __dmul_rn(a, b);
#else
  return a * b;
#endif
}
QSES_FN float absolute(float x) { return fabsf(x); }
// Of numbers. (On a GPU one instruction, and not the two of a choice.)
QSES_FN float maximum(float a, float b) {
#if defined(__CUDA_ARCH__)
  return fmaxf(a, b);
#else
  return a > b ? a : b;
#endif
}
QSES_FN float minimum(float a, float b) {
#if defined(__CUDA_ARCH__)
  return fminf(a, b);
#else
  return a < b ? a : b;
#endif
}
QSES_FN float select(bool m, float yes, float no) { return m ? yes : no; }
QSES_FN bool any(bool m) { return m; }
QSES_FN double square_root(double x) { return sqrt(x); }
QSES_FN double select(bool m, double yes, double no) { return m ? yes : no; }

}  // namespace quickses
