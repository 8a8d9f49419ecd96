// SPDX-License-Identifier: MIT
// WidePack: as many floats as loops through columns take at a time. Sixteen with AVX-512, a Pack otherwise. Included
// only by the CPU kernels.
#pragma once

#include "parallel/pack.h"

#include <initializer_list>

namespace quickses {
namespace QSES_CPU_ISA {

#if defined(__AVX512F__)
constexpr int kWideLanes = 16;
#else
constexpr int kWideLanes = kPackSize;
#endif
constexpr uint32_t kAllWideLanes = (1u << kWideLanes) - 1;
// So many lanes from the first one on, without a branch.
QSES_FN uint32_t first_wide_lanes(uint32_t n) { return (1u << (n < kWideLanes ? n : kWideLanes)) - 1; }

#if defined(__AVX512F__)

struct WidePack {
  __m512 v;
  WidePack() = default;
  QSES_FN WidePack(__m512 x) : v(x) {}
  QSES_FN WidePack(float x) : v(_mm512_set1_ps(x)) {}
};
struct WideMask {
  __mmask16 m;
};
QSES_FN WidePack operator+(WidePack a, WidePack b) { return _mm512_add_ps(a.v, b.v); }
QSES_FN WidePack operator-(WidePack a, WidePack b) { return _mm512_sub_ps(a.v, b.v); }
QSES_FN WidePack operator*(WidePack a, WidePack b) { return _mm512_mul_ps(a.v, b.v); }
QSES_FN WidePack operator/(WidePack a, WidePack b) { return _mm512_div_ps(a.v, b.v); }
QSES_FN WidePack operator-(WidePack a) { return _mm512_xor_ps(a.v, _mm512_set1_ps(-0.f)); }
QSES_FN WidePack multiply_add(WidePack a, WidePack b, WidePack c) { return _mm512_fmadd_ps(a.v, b.v, c.v); }
QSES_FN WidePack rounded_product(WidePack a, WidePack b) {
  __m512 product = _mm512_mul_ps(a.v, b.v);
  __asm__("" : "+v"(product));
  return product;
}
QSES_FN WidePack square_root(WidePack a) { return _mm512_sqrt_ps(a.v); }
QSES_FN WidePack absolute(WidePack a) { return _mm512_abs_ps(a.v); }
QSES_FN WidePack maximum(WidePack a, WidePack b) { return _mm512_max_ps(a.v, b.v); }
QSES_FN WidePack minimum(WidePack a, WidePack b) { return _mm512_min_ps(a.v, b.v); }
QSES_FN WideMask operator<(WidePack a, WidePack b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ)}; }
QSES_FN WideMask operator<=(WidePack a, WidePack b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ)}; }
QSES_FN WideMask operator==(WidePack a, WidePack b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_EQ_OQ)}; }
QSES_FN WideMask operator>(WidePack a, WidePack b) { return b < a; }
QSES_FN WideMask operator>=(WidePack a, WidePack b) { return b <= a; }
QSES_FN WideMask operator&(WideMask a, WideMask b) { return {static_cast<__mmask16>(a.m & b.m)}; }
QSES_FN WideMask operator|(WideMask a, WideMask b) { return {static_cast<__mmask16>(a.m | b.m)}; }
QSES_FN WideMask operator^(WideMask a, WideMask b) { return {static_cast<__mmask16>(a.m ^ b.m)}; }
QSES_FN WidePack select(WideMask m, WidePack yes, WidePack no) { return _mm512_mask_blend_ps(m.m, no.v, yes.v); }
QSES_FN WidePack reciprocal_root(WidePack a) { return WidePack(1.f) / square_root(a); }
QSES_FN uint32_t lane_bits(WideMask m) { return m.m; }
QSES_FN WideMask wide_mask(uint32_t bits) { return {static_cast<__mmask16>(bits)}; }
QSES_FN float horizontal_minimum(WidePack a) { return _mm512_reduce_min_ps(a.v); }
QSES_FN float horizontal_maximum(WidePack a) { return _mm512_reduce_max_ps(a.v); }
QSES_FN WidePack load_wide(const float *p) { return _mm512_loadu_ps(p); }
QSES_FN void store_pack(float *p, WidePack a) { _mm512_storeu_ps(p, a.v); }
QSES_FN void store_lanes(float *dst, uint32_t set, WidePack a) {
  _mm512_storeu_ps(dst, _mm512_maskz_compress_ps(static_cast<__mmask16>(set), a.v));
}
QSES_FN int store_wide_numbers(int32_t *dst, uint32_t set, int32_t base) {
  const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  _mm512_storeu_si512(
      dst, _mm512_maskz_compress_epi32(static_cast<__mmask16>(set), _mm512_add_epi32(_mm512_set1_epi32(base), lanes)));
  return popcount64(set);
}
// The numbers in the lanes of the set, packed together.
QSES_FN void store_wide_lanes(int32_t *dst, uint32_t set, const int32_t *numbers) {
  _mm512_storeu_si512(dst, _mm512_maskz_compress_epi32(static_cast<__mmask16>(set), _mm512_loadu_si512(numbers)));
}
// The lanes with this number.
QSES_FN uint32_t wide_lanes_of(const int32_t *numbers, int32_t number) {
  return _mm512_cmpeq_epi32_mask(_mm512_loadu_si512(numbers), _mm512_set1_epi32(number));
}

// Rows of four floats, four in each register, turned into four packs: lane 4 k + l of a pack is of the k-th row of
// register l.
QSES_FN void transpose_rows(__m512 a, __m512 b, __m512 c, __m512 d, WidePack *x, WidePack *y, WidePack *z,
                            WidePack *w) {
  const __m512 ab_low = _mm512_unpacklo_ps(a, b), ab_high = _mm512_unpackhi_ps(a, b);
  const __m512 cd_low = _mm512_unpacklo_ps(c, d), cd_high = _mm512_unpackhi_ps(c, d);
  x->v = _mm512_shuffle_ps(ab_low, cd_low, 0x44);
  y->v = _mm512_shuffle_ps(ab_low, cd_low, 0xee);
  z->v = _mm512_shuffle_ps(ab_high, cd_high, 0x44);
  w->v = _mm512_shuffle_ps(ab_high, cd_high, 0xee);
}
// Of rows that lie behind each other. Zeros behind the last one, if there are fewer.
QSES_FN void load_wide_rows(const float *p, uint32_t rows, WidePack *x, WidePack *y, WidePack *z, WidePack *w) {
  const uint64_t floats = rows < kWideLanes ? (uint64_t(1) << 4 * rows) - 1 : ~uint64_t(0);
  const auto four_rows = [&](int k) {
    return _mm512_maskz_loadu_ps(static_cast<__mmask16>(floats >> 16 * k), p + 16 * k);
  };
  transpose_rows(four_rows(0), four_rows(1), four_rows(2), four_rows(3), x, y, z, w);
  const __m512i order = _mm512_setr_epi32(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15);
  for (WidePack *column : {x, y, z, w}) column->v = _mm512_permutexvar_ps(order, column->v);
}
// Of rows that lie anywhere. row(k): where the k-th begins.
template <class Row>
QSES_FN void load_rows(const Row &row, WidePack *x, WidePack *y, WidePack *z, WidePack *w) {
  // The k-th, fourth, eighth and twelfth after it.
  const auto every_fourth = [&](int k) {
    __m512 r = _mm512_castps128_ps512(_mm_loadu_ps(row(k)));
    r = _mm512_insertf32x4(r, _mm_loadu_ps(row(k + 4)), 1);
    r = _mm512_insertf32x4(r, _mm_loadu_ps(row(k + 8)), 2);
    return _mm512_insertf32x4(r, _mm_loadu_ps(row(k + 12)), 3);
  };
  transpose_rows(every_fourth(0), every_fourth(1), every_fourth(2), every_fourth(3), x, y, z, w);
}
// The lanes with these numbers, out of a Pack's.
QSES_FN WidePack spread_lanes(Pack a, __m512i numbers) {
  return _mm512_permutexvar_ps(numbers, _mm512_castps256_ps512(a.v));
}
// One bit for each lane of four packs.
QSES_FN uint64_t join_lanes(WideMask a, WideMask b, WideMask c, WideMask d) {
  return _mm512_kunpackd(_mm512_kunpackw(d.m, c.m), _mm512_kunpackw(b.m, a.m));
}

#else

using WidePack = Pack;
using WideMask = PackMask;
QSES_FN WideMask wide_mask(uint32_t bits) { return lane_mask(bits); }
QSES_FN WidePack load_wide(const float *p) { return load_pack(p); }
QSES_FN int store_wide_numbers(int32_t *dst, uint32_t set, int32_t base) { return store_lane_numbers(dst, set, base); }
QSES_FN void store_wide_lanes(int32_t *dst, uint32_t set, const int32_t *numbers) { store_lanes(dst, set, numbers); }
QSES_FN uint32_t wide_lanes_of(const int32_t *numbers, int32_t number) { return lanes_of(numbers, number); }
// Whole packs are read: there is something behind the last row.
QSES_FN void load_wide_rows(const float *p, uint32_t, WidePack *x, WidePack *y, WidePack *z, WidePack *w) {
  load_columns(p, x, y, z, w);
}

#endif

}  // namespace QSES_CPU_ISA
}  // namespace quickses
