// SPDX-License-Identifier: MIT
// Chooses the CPU kernels for the processor the program runs on.
#define QSES_CPU_ISA base
#include "surface/cpu/cpu_kernels_isa.h"
#if defined(QUICKSES_HAS_CPU_V3)
#undef QSES_CPU_ISA
#define QSES_CPU_ISA v3
#include "surface/cpu/cpu_kernels_isa.h"
#endif

namespace quickses {
namespace {

#if defined(__x86_64__) || defined(_M_X64)
constexpr const char *kBaseName = "SSE2";
#else
constexpr const char *kBaseName = "portable";
#endif

constexpr CpuKernels kBase = {kBaseName, base::find_atom_features, base::evaluate_brick_signs,
                              base::emit_brick_vertices, base::emit_brick_triangles};
#if defined(QUICKSES_HAS_CPU_V3)
constexpr CpuKernels kV3 = {"AVX2", v3::find_atom_features, v3::evaluate_brick_signs, v3::emit_brick_vertices,
                            v3::emit_brick_triangles};
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

}  // namespace quickses
