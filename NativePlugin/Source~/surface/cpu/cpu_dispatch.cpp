// SPDX-License-Identifier: MIT
// Chooses the CPU kernels for the processor the program runs on.
#include "surface/cpu/cpu_kernels.h"

namespace quickses {
namespace {

#if defined(__x86_64__) || defined(_M_X64)
constexpr const char *kBaseName = "SSE2";
#else
constexpr const char *kBaseName = "portable";
#endif

#define QSES_BASE(result, kernel, ...) , base::kernel
#define QSES_V3(result, kernel, ...) , v3::kernel
constexpr CpuKernels kBase = {kBaseName QSES_CPU_KERNELS(QSES_BASE)};
#if defined(QUICKSES_HAS_CPU_V3)
constexpr CpuKernels kV3 = {"AVX2" QSES_CPU_KERNELS(QSES_V3)};
#endif

}  // namespace

const CpuKernels &cpu_kernels() {
#if defined(QUICKSES_HAS_CPU_V3)
  static const bool has_v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                             __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  if (has_v3) return kV3;
#endif
  return kBase;
}

const CpuKernels &base_cpu_kernels() { return kBase; }

void measure_triangles(const MeasureTriangle &measure, size_t first, size_t count, TriangleSums *sums) {
  cpu_kernels().measure_triangles(measure, first, count, sums);
}

}  // namespace quickses
