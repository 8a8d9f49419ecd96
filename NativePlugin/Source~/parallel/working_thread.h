// SPDX-License-Identifier: MIT
// What holds on a thread while it works for the library: the floating-point environment that results are defined in,
// and the flag that tells it to stop.
#pragma once

#include "parallel/platform.h"

#include <atomic>

#if defined(__SSE2__) || defined(_M_X64)
#include <xmmintrin.h>
#else
#include <cfenv>
#endif

namespace quickses {

// While it lives, this thread rounds to nearest, knows denormal numbers, and traps nothing; then everything is as the
// caller had it.
class FloatScope {
 public:
#if defined(__SSE2__) || defined(_M_X64)
  FloatScope() : before_(_mm_getcsr()) {
    if (before_ != kDefault) _mm_setcsr(kDefault);
    x87_.begin();
  }
  ~FloatScope() {
    x87_.end();
    _mm_setcsr(before_);
  }

 private:
  static constexpr unsigned kDefault = 0x1f80;
  // MinGW's atan2 is an instruction of the x87, which rounds by a word of its own.
  struct X87 {
#if defined(_WIN32)
    void begin() {
      const uint16_t word = 0x37f;
      __asm__ volatile("fnstcw %0" : "=m"(before));
      __asm__ volatile("fldcw %0" : : "m"(word));
    }
    void end() { __asm__ volatile("fldcw %0" : : "m"(before)); }
    uint16_t before = 0;
#else
    void begin() {}
    void end() {}
#endif
  };
  unsigned before_;
  X87 x87_;
#else
  FloatScope() {
    std::fegetenv(&before_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~FloatScope() { std::fesetenv(&before_); }

 private:
  std::fenv_t before_;
#endif
 public:
  FloatScope(const FloatScope &) = delete;
  FloatScope &operator=(const FloatScope &) = delete;
};

// While it lives, this thread works on what the flag stops. The flag may be null.
class WorkScope {
 public:
  explicit WorkScope(const std::atomic<bool> *stop);
  ~WorkScope();

 private:
  const std::atomic<bool> *before_;
  FloatScope floats_;
};

// Throws Cancelled if the work of this thread is to stop. A few nanoseconds.
void throw_if_stopped();

// The same for functions that serve the GPU too, where it does nothing. Whatever may go on for longer than some
// milliseconds calls it now and then.
QSES_FN void look_for_stop() {
#if !defined(__CUDA_ARCH__)
  throw_if_stopped();
#endif
}

}  // namespace quickses
