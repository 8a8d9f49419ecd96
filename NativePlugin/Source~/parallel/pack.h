// SPDX-License-Identifier: MIT
// Pack: eight floats that the geometry functions treat like one. AVX2 where the file is compiled for it, two SSE
// registers otherwise, plain arrays on other processors. Included only by the CPU kernels, and by tests of their parts.
#pragma once

#include "parallel/scalar.h"

#if defined(__AVX2__)
#include <immintrin.h>
#elif defined(__SSE2__) || defined(_M_X64)
#include <emmintrin.h>
#define QSES_PACK_SSE 1
#endif

#ifndef QSES_CPU_ISA
#define QSES_CPU_ISA base
#endif

namespace quickses {
namespace QSES_CPU_ISA {

// Both kinds side by side: the functions below must not hide those of one float.
using quickses::absolute;
using quickses::maximum;
using quickses::minimum;
using quickses::reciprocal_root;
using quickses::select;
using quickses::square_root;

constexpr int kPackSize = 8;
constexpr uint32_t kAllLanes = 0xffu;
// So many lanes from the first one on, without a branch; all of eight and more.
QSES_FN uint32_t first_lanes(uint32_t n) { return (1u << (n < kPackSize ? n : kPackSize)) - 1; }

// For each set of lanes, the numbers of its members in order (then zeros): the permutation of a compressing store.
struct alignas(32) LaneTable {
  int32_t lanes[256][8];
  constexpr LaneTable() : lanes{} {
    for (int set = 0; set < 256; ++set) {
      int n = 0;
      for (int lane = 0; lane < 8; ++lane)
        if (set >> lane & 1) lanes[set][n++] = lane;
    }
  }
};
static constexpr LaneTable kLaneTable{};

#if defined(__AVX2__)

struct Pack {
  __m256 v;
  Pack() = default;
  QSES_FN Pack(__m256 x) : v(x) {}
  QSES_FN Pack(float x) : v(_mm256_set1_ps(x)) {}
};
struct PackMask {
  __m256 v;
};

QSES_FN Pack operator+(Pack a, Pack b) { return _mm256_add_ps(a.v, b.v); }
QSES_FN Pack operator-(Pack a, Pack b) { return _mm256_sub_ps(a.v, b.v); }
QSES_FN Pack operator*(Pack a, Pack b) { return _mm256_mul_ps(a.v, b.v); }
QSES_FN Pack operator/(Pack a, Pack b) { return _mm256_div_ps(a.v, b.v); }
QSES_FN Pack operator-(Pack a) { return _mm256_xor_ps(a.v, _mm256_set1_ps(-0.f)); }
QSES_FN Pack multiply_add(Pack a, Pack b, Pack c) {
#if defined(__FMA__)
  return _mm256_fmadd_ps(a.v, b.v, c.v);
#else
  return a * b + c;
#endif
}
QSES_FN Pack square_root(Pack a) { return _mm256_sqrt_ps(a.v); }
// A product that is rounded before anything is added to it, whatever the compiler would make of the two.
QSES_FN Pack rounded_product(Pack a, Pack b) {
  __m256 product = _mm256_mul_ps(a.v, b.v);
  __asm__("" : "+x"(product));
  return product;
}
QSES_FN Pack absolute(Pack a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.f), a.v); }
QSES_FN Pack maximum(Pack a, Pack b) { return _mm256_max_ps(a.v, b.v); }
QSES_FN Pack minimum(Pack a, Pack b) { return _mm256_min_ps(a.v, b.v); }
QSES_FN PackMask operator<(Pack a, Pack b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)}; }
QSES_FN PackMask operator<=(Pack a, Pack b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)}; }
QSES_FN PackMask operator==(Pack a, Pack b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_EQ_OQ)}; }
QSES_FN PackMask operator&(PackMask a, PackMask b) { return {_mm256_and_ps(a.v, b.v)}; }
QSES_FN PackMask operator|(PackMask a, PackMask b) { return {_mm256_or_ps(a.v, b.v)}; }
QSES_FN PackMask operator^(PackMask a, PackMask b) { return {_mm256_xor_ps(a.v, b.v)}; }
QSES_FN Pack select(PackMask m, Pack yes, Pack no) { return _mm256_blendv_ps(no.v, yes.v, m.v); }
QSES_FN uint32_t lane_bits(PackMask m) { return static_cast<uint32_t>(_mm256_movemask_ps(m.v)); }
// Of four rows of lanes: the lower halves one after the other, and then the upper ones.
QSES_FN uint32_t half_rows(PackMask a, PackMask b, PackMask c, PackMask d) {
  const auto words = [](PackMask m) { return _mm256_castps_si256(m.v); };
  return static_cast<uint32_t>(_mm256_movemask_epi8(
      _mm256_packs_epi16(_mm256_packs_epi32(words(a), words(b)), _mm256_packs_epi32(words(c), words(d)))));
}
QSES_FN PackMask lane_mask(uint32_t bits) {
  const __m256i one = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  return {
      _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(bits)), one), one))};
}
QSES_FN Pack load_pack(const float *p) { return _mm256_loadu_ps(p); }
QSES_FN void store_pack(float *p, Pack a) { _mm256_storeu_ps(p, a.v); }
// Eight rows of four floats, turned into four packs. row(k): where the k-th begins.
template <class Row>
QSES_FN void load_rows(const Row &row, Pack *x, Pack *y, Pack *z, Pack *w) {
  const __m256 r0 = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(row(0))), _mm_loadu_ps(row(4)), 1);
  const __m256 r1 = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(row(1))), _mm_loadu_ps(row(5)), 1);
  const __m256 r2 = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(row(2))), _mm_loadu_ps(row(6)), 1);
  const __m256 r3 = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(row(3))), _mm_loadu_ps(row(7)), 1);
  const __m256 a = _mm256_unpacklo_ps(r0, r1), b = _mm256_unpackhi_ps(r0, r1);
  const __m256 c = _mm256_unpacklo_ps(r2, r3), d = _mm256_unpackhi_ps(r2, r3);
  x->v = _mm256_shuffle_ps(a, c, 0x44);
  y->v = _mm256_shuffle_ps(a, c, 0xee);
  z->v = _mm256_shuffle_ps(b, d, 0x44);
  w->v = _mm256_shuffle_ps(b, d, 0xee);
}
// Writes the lanes of the set to dst, packed together. dst must have room for eight.
QSES_FN void store_lanes(float *dst, uint32_t set, Pack a) {
  _mm256_storeu_ps(
      dst, _mm256_permutevar8x32_ps(a.v, _mm256_load_si256(reinterpret_cast<const __m256i *>(kLaneTable.lanes[set]))));
}
// Writes base + lane for the lanes of the set. dst must have room for eight. Returns their number.
QSES_FN int store_lane_numbers(int32_t *dst, uint32_t set, int32_t base) {
  _mm256_storeu_si256(reinterpret_cast<__m256i *>(dst),
                      _mm256_add_epi32(_mm256_set1_epi32(base),
                                       _mm256_load_si256(reinterpret_cast<const __m256i *>(kLaneTable.lanes[set]))));
  return popcount64(set);
}
QSES_FN void store_lanes(int32_t *dst, uint32_t set, const int32_t *numbers) {
  const __m256i lanes = _mm256_load_si256(reinterpret_cast<const __m256i *>(kLaneTable.lanes[set]));
  _mm256_storeu_si256(
      reinterpret_cast<__m256i *>(dst),
      _mm256_permutevar8x32_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i *>(numbers)), lanes));
}
// The lanes with this number.
QSES_FN uint32_t lanes_of(const int32_t *numbers, int32_t number) {
  const __m256i same =
      _mm256_cmpeq_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i *>(numbers)), _mm256_set1_epi32(number));
  return static_cast<uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(same)));
}
QSES_FN float horizontal_minimum(Pack a) {
  __m128 m = _mm_min_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
  m = _mm_min_ps(m, _mm_movehl_ps(m, m));
  return _mm_cvtss_f32(_mm_min_ss(m, _mm_shuffle_ps(m, m, 1)));
}
QSES_FN float horizontal_maximum(Pack a) {
  __m128 m = _mm_max_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
  m = _mm_max_ps(m, _mm_movehl_ps(m, m));
  return _mm_cvtss_f32(_mm_max_ss(m, _mm_shuffle_ps(m, m, 1)));
}

#elif defined(QSES_PACK_SSE)

struct Pack {
  __m128 l, h;
  Pack() = default;
  QSES_FN Pack(__m128 low, __m128 high) : l(low), h(high) {}
  QSES_FN Pack(float x) : l(_mm_set1_ps(x)), h(_mm_set1_ps(x)) {}
};
struct PackMask {
  __m128 l, h;
};

QSES_FN Pack operator+(Pack a, Pack b) { return {_mm_add_ps(a.l, b.l), _mm_add_ps(a.h, b.h)}; }
QSES_FN Pack operator-(Pack a, Pack b) { return {_mm_sub_ps(a.l, b.l), _mm_sub_ps(a.h, b.h)}; }
QSES_FN Pack operator*(Pack a, Pack b) { return {_mm_mul_ps(a.l, b.l), _mm_mul_ps(a.h, b.h)}; }
QSES_FN Pack operator/(Pack a, Pack b) { return {_mm_div_ps(a.l, b.l), _mm_div_ps(a.h, b.h)}; }
QSES_FN Pack operator-(Pack a) {
  const __m128 s = _mm_set1_ps(-0.f);
  return {_mm_xor_ps(a.l, s), _mm_xor_ps(a.h, s)};
}
QSES_FN Pack multiply_add(Pack a, Pack b, Pack c) { return a * b + c; }
QSES_FN Pack square_root(Pack a) { return {_mm_sqrt_ps(a.l), _mm_sqrt_ps(a.h)}; }
QSES_FN Pack absolute(Pack a) {
  const __m128 s = _mm_set1_ps(-0.f);
  return {_mm_andnot_ps(s, a.l), _mm_andnot_ps(s, a.h)};
}
QSES_FN Pack maximum(Pack a, Pack b) { return {_mm_max_ps(a.l, b.l), _mm_max_ps(a.h, b.h)}; }
QSES_FN Pack minimum(Pack a, Pack b) { return {_mm_min_ps(a.l, b.l), _mm_min_ps(a.h, b.h)}; }
QSES_FN PackMask operator<(Pack a, Pack b) { return {_mm_cmplt_ps(a.l, b.l), _mm_cmplt_ps(a.h, b.h)}; }
QSES_FN PackMask operator<=(Pack a, Pack b) { return {_mm_cmple_ps(a.l, b.l), _mm_cmple_ps(a.h, b.h)}; }
QSES_FN PackMask operator==(Pack a, Pack b) { return {_mm_cmpeq_ps(a.l, b.l), _mm_cmpeq_ps(a.h, b.h)}; }
QSES_FN PackMask operator&(PackMask a, PackMask b) { return {_mm_and_ps(a.l, b.l), _mm_and_ps(a.h, b.h)}; }
QSES_FN PackMask operator|(PackMask a, PackMask b) { return {_mm_or_ps(a.l, b.l), _mm_or_ps(a.h, b.h)}; }
QSES_FN PackMask operator^(PackMask a, PackMask b) { return {_mm_xor_ps(a.l, b.l), _mm_xor_ps(a.h, b.h)}; }
QSES_FN Pack select(PackMask m, Pack yes, Pack no) {
  return {_mm_or_ps(_mm_and_ps(m.l, yes.l), _mm_andnot_ps(m.l, no.l)),
          _mm_or_ps(_mm_and_ps(m.h, yes.h), _mm_andnot_ps(m.h, no.h))};
}
QSES_FN uint32_t lane_bits(PackMask m) {
  return static_cast<uint32_t>(_mm_movemask_ps(m.l) | _mm_movemask_ps(m.h) << 4);
}
QSES_FN PackMask lane_mask(uint32_t bits) {
  const __m128i low = _mm_setr_epi32(1, 2, 4, 8), high = _mm_setr_epi32(16, 32, 64, 128);
  const __m128i b = _mm_set1_epi32(static_cast<int>(bits));
  return {_mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(b, low), low)),
          _mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(b, high), high))};
}
QSES_FN Pack load_pack(const float *p) { return {_mm_loadu_ps(p), _mm_loadu_ps(p + 4)}; }
QSES_FN void store_pack(float *p, Pack a) {
  _mm_storeu_ps(p, a.l);
  _mm_storeu_ps(p + 4, a.h);
}
template <class Row>
QSES_FN void load_rows(const Row &row, Pack *x, Pack *y, Pack *z, Pack *w) {
  __m128 r0 = _mm_loadu_ps(row(0)), r1 = _mm_loadu_ps(row(1)), r2 = _mm_loadu_ps(row(2)), r3 = _mm_loadu_ps(row(3));
  __m128 s0 = _mm_loadu_ps(row(4)), s1 = _mm_loadu_ps(row(5)), s2 = _mm_loadu_ps(row(6)), s3 = _mm_loadu_ps(row(7));
  _MM_TRANSPOSE4_PS(r0, r1, r2, r3);
  _MM_TRANSPOSE4_PS(s0, s1, s2, s3);
  *x = {r0, s0};
  *y = {r1, s1};
  *z = {r2, s2};
  *w = {r3, s3};
}
QSES_FN float horizontal_minimum(Pack a) {
  __m128 m = _mm_min_ps(a.l, a.h);
  m = _mm_min_ps(m, _mm_movehl_ps(m, m));
  return _mm_cvtss_f32(_mm_min_ss(m, _mm_shuffle_ps(m, m, 1)));
}
QSES_FN float horizontal_maximum(Pack a) {
  __m128 m = _mm_max_ps(a.l, a.h);
  m = _mm_max_ps(m, _mm_movehl_ps(m, m));
  return _mm_cvtss_f32(_mm_max_ss(m, _mm_shuffle_ps(m, m, 1)));
}

#else

struct Pack {
  float v[8];
  Pack() = default;
  QSES_FN Pack(float x) {
    for (float &e : v) e = x;
  }
};
struct PackMask {
  bool v[8];
};
// clang-format off
#define QSES_EACH_LANE for (int i = 0; i < 8; ++i)
QSES_FN Pack operator+(Pack a, Pack b) { QSES_EACH_LANE a.v[i] += b.v[i]; return a; }
QSES_FN Pack operator-(Pack a, Pack b) { QSES_EACH_LANE a.v[i] -= b.v[i]; return a; }
QSES_FN Pack operator*(Pack a, Pack b) { QSES_EACH_LANE a.v[i] *= b.v[i]; return a; }
QSES_FN Pack operator/(Pack a, Pack b) { QSES_EACH_LANE a.v[i] /= b.v[i]; return a; }
QSES_FN Pack operator-(Pack a) { QSES_EACH_LANE a.v[i] = -a.v[i]; return a; }
QSES_FN Pack multiply_add(Pack a, Pack b, Pack c) { return a * b + c; }
QSES_FN Pack square_root(Pack a) { QSES_EACH_LANE a.v[i] = std::sqrt(a.v[i]); return a; }
QSES_FN Pack absolute(Pack a) { QSES_EACH_LANE a.v[i] = std::fabs(a.v[i]); return a; }
QSES_FN Pack maximum(Pack a, Pack b) { QSES_EACH_LANE a.v[i] = a.v[i] > b.v[i] ? a.v[i] : b.v[i]; return a; }
QSES_FN Pack minimum(Pack a, Pack b) { QSES_EACH_LANE a.v[i] = a.v[i] < b.v[i] ? a.v[i] : b.v[i]; return a; }
QSES_FN PackMask operator<(Pack a, Pack b) { PackMask m; QSES_EACH_LANE m.v[i] = a.v[i] < b.v[i]; return m; }
QSES_FN PackMask operator<=(Pack a, Pack b) { PackMask m; QSES_EACH_LANE m.v[i] = a.v[i] <= b.v[i]; return m; }
QSES_FN PackMask operator==(Pack a, Pack b) { PackMask m; QSES_EACH_LANE m.v[i] = a.v[i] == b.v[i]; return m; }
QSES_FN PackMask operator&(PackMask a, PackMask b) { QSES_EACH_LANE a.v[i] = a.v[i] && b.v[i]; return a; }
QSES_FN PackMask operator|(PackMask a, PackMask b) { QSES_EACH_LANE a.v[i] = a.v[i] || b.v[i]; return a; }
QSES_FN PackMask operator^(PackMask a, PackMask b) { QSES_EACH_LANE a.v[i] = a.v[i] != b.v[i]; return a; }
QSES_FN Pack select(PackMask m, Pack yes, Pack no) { QSES_EACH_LANE no.v[i] = m.v[i] ? yes.v[i] : no.v[i]; return no; }
QSES_FN uint32_t lane_bits(PackMask m) { uint32_t b = 0; QSES_EACH_LANE b |= uint32_t(m.v[i]) << i; return b; }
QSES_FN PackMask lane_mask(uint32_t bits) { PackMask m; QSES_EACH_LANE m.v[i] = bits >> i & 1; return m; }
QSES_FN Pack load_pack(const float *p) { Pack a; QSES_EACH_LANE a.v[i] = p[i]; return a; }
QSES_FN void store_pack(float *p, Pack a) { QSES_EACH_LANE p[i] = a.v[i]; }
template <class Row>
QSES_FN void load_rows(const Row &row, Pack *x, Pack *y, Pack *z, Pack *w) {
  QSES_EACH_LANE { const float *p = row(i); x->v[i] = p[0]; y->v[i] = p[1]; z->v[i] = p[2]; w->v[i] = p[3]; }
}
QSES_FN float horizontal_minimum(Pack a) { QSES_EACH_LANE if (a.v[i] < a.v[0]) a.v[0] = a.v[i]; return a.v[0]; }
QSES_FN float horizontal_maximum(Pack a) { QSES_EACH_LANE if (a.v[i] > a.v[0]) a.v[0] = a.v[i]; return a.v[0]; }
#undef QSES_EACH_LANE
// clang-format on

#endif

#if !defined(__AVX2__)
QSES_FN uint32_t half_rows(PackMask a, PackMask b, PackMask c, PackMask d) {
  const uint32_t rows[4] = {lane_bits(a), lane_bits(b), lane_bits(c), lane_bits(d)};
  uint32_t halves = 0;
  for (int k = 0; k < 4; ++k) halves |= (rows[k] & 15) << 4 * k | (rows[k] >> 4) << (16 + 4 * k);
  return halves;
}
QSES_FN Pack rounded_product(Pack a, Pack b) { return a * b; }
QSES_FN void store_lanes(float *dst, uint32_t set, Pack a) {
  float lanes[8];
  store_pack(lanes, a);
  for (int n = 0; set; set &= set - 1) dst[n++] = lanes[lowest_bit32(set)];
}
QSES_FN int store_lane_numbers(int32_t *dst, uint32_t set, int32_t base) {
  int n = 0;
  for (; set; set &= set - 1) dst[n++] = base + lowest_bit32(set);
  return n;
}
QSES_FN void store_lanes(int32_t *dst, uint32_t set, const int32_t *numbers) {
  for (; set; set &= set - 1) *dst++ = numbers[lowest_bit32(set)];
}
QSES_FN uint32_t lanes_of(const int32_t *numbers, int32_t number) {
  uint32_t lanes = 0;
  for (int l = 0; l < kPackSize; ++l) lanes |= static_cast<uint32_t>(numbers[l] == number) << l;
  return lanes;
}
#endif

// Of rows that lie behind each other.
QSES_FN void load_columns(const float *p, Pack *x, Pack *y, Pack *z, Pack *w) {
  load_rows([p](int k) { return p + 4 * k; }, x, y, z, w);
}
QSES_FN Pack reciprocal_root(Pack a) { return Pack(1.f) / square_root(a); }
QSES_FN PackMask operator>(Pack a, Pack b) { return b < a; }
QSES_FN PackMask operator>=(Pack a, Pack b) { return b <= a; }

}  // namespace QSES_CPU_ISA
}  // namespace quickses
