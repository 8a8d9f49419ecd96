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
#define QSES_V4(result, kernel, ...) , v4::kernel
constexpr CpuKernels kBase = {kBaseName QSES_CPU_KERNELS(QSES_BASE)};
#if defined(QUICKSES_HAS_NEWER_CPU_KERNELS)
constexpr CpuKernels kV3 = {"AVX2" QSES_CPU_KERNELS(QSES_V3)};
constexpr CpuKernels kV4 = {"AVX-512" QSES_CPU_KERNELS(QSES_V4)};
constexpr const CpuKernels *kSets[] = {&kBase, &kV3, &kV4};

// All that the compiler may use of x86-64-v3 and v4, as far as processors have one without the other.
size_t count_usable_sets() {
  const bool has_v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                      __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  const bool has_v4 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
  return !has_v3 ? 1 : !has_v4 ? 2 : 3;
}
#else
constexpr const CpuKernels *kSets[] = {&kBase};
size_t count_usable_sets() { return 1; }
#endif

}  // namespace

Span<const CpuKernels *const> usable_cpu_kernels() {
  static const size_t count = count_usable_sets();
  return {kSets, count};
}

const CpuKernels &cpu_kernels() {
  const Span<const CpuKernels *const> usable = usable_cpu_kernels();
  return *usable[usable.size - 1];
}

BrickTotals count_brick(const BrickSet &bricks, const MeshLayout &layout, uint32_t brick,
                        const uint8_t *case_triangles) {
  return cpu_kernels().count_brick(bricks, layout, brick, case_triangles);
}

void measure_triangles(const MeasureTriangle &measure, size_t first, size_t count, TriangleSums *sums) {
  cpu_kernels().measure_triangles(measure, first, count, sums);
}

}  // namespace quickses
