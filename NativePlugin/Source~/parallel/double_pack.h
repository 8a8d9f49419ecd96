// SPDX-License-Identifier: MIT
// DoublePack: four doubles that a rule treats like one. AVX2 where the file is compiled for it, two SSE2 registers
// otherwise, plain arrays on other processors. Included only by the CPU kernels.
#pragma once

#include "parallel/pack.h"

namespace quickses {
namespace QSES_CPU_ISA {

using quickses::any;
using quickses::rounded_product;

constexpr int kDoublePackSize = 4;

#if defined(__AVX2__)

struct DoublePack {
  __m256d v;
  DoublePack() = default;
  QSES_FN DoublePack(__m256d x) : v(x) {}
  QSES_FN DoublePack(double x) : v(_mm256_set1_pd(x)) {}
};
struct DoubleMask {
  __m256d v;
};
QSES_FN DoublePack operator+(DoublePack a, DoublePack b) { return _mm256_add_pd(a.v, b.v); }
QSES_FN DoublePack operator-(DoublePack a, DoublePack b) { return _mm256_sub_pd(a.v, b.v); }
QSES_FN DoublePack operator*(DoublePack a, DoublePack b) { return _mm256_mul_pd(a.v, b.v); }
QSES_FN DoublePack operator/(DoublePack a, DoublePack b) { return _mm256_div_pd(a.v, b.v); }
QSES_FN DoublePack square_root(DoublePack a) { return _mm256_sqrt_pd(a.v); }
// As that of packs of floats.
QSES_FN DoublePack rounded_product(DoublePack a, DoublePack b) {
  __m256d product = _mm256_mul_pd(a.v, b.v);
  __asm__("" : "+x"(product));
  return product;
}
QSES_FN DoubleMask operator<(DoublePack a, DoublePack b) { return {_mm256_cmp_pd(a.v, b.v, _CMP_LT_OQ)}; }
QSES_FN DoubleMask operator<=(DoublePack a, DoublePack b) { return {_mm256_cmp_pd(a.v, b.v, _CMP_LE_OQ)}; }
QSES_FN DoubleMask operator!=(DoublePack a, DoublePack b) { return {_mm256_cmp_pd(a.v, b.v, _CMP_NEQ_UQ)}; }
QSES_FN DoubleMask operator&(DoubleMask a, DoubleMask b) { return {_mm256_and_pd(a.v, b.v)}; }
QSES_FN DoubleMask operator|(DoubleMask a, DoubleMask b) { return {_mm256_or_pd(a.v, b.v)}; }
QSES_FN DoublePack select(DoubleMask m, DoublePack yes, DoublePack no) { return _mm256_blendv_pd(no.v, yes.v, m.v); }
QSES_FN bool any(DoubleMask m) { return _mm256_movemask_pd(m.v) != 0; }
QSES_FN void store_pack(double *p, DoublePack a) { _mm256_storeu_pd(p, a.v); }
QSES_FN DoublePack to_doubles(__m128 four) { return _mm256_cvtps_pd(four); }

#elif defined(QSES_PACK_SSE)

struct DoublePack {
  __m128d l, h;
  DoublePack() = default;
  QSES_FN DoublePack(__m128d low, __m128d high) : l(low), h(high) {}
  QSES_FN DoublePack(double x) : l(_mm_set1_pd(x)), h(_mm_set1_pd(x)) {}
};
struct DoubleMask {
  __m128d l, h;
};
QSES_FN DoublePack operator+(DoublePack a, DoublePack b) { return {_mm_add_pd(a.l, b.l), _mm_add_pd(a.h, b.h)}; }
QSES_FN DoublePack operator-(DoublePack a, DoublePack b) { return {_mm_sub_pd(a.l, b.l), _mm_sub_pd(a.h, b.h)}; }
QSES_FN DoublePack operator*(DoublePack a, DoublePack b) { return {_mm_mul_pd(a.l, b.l), _mm_mul_pd(a.h, b.h)}; }
QSES_FN DoublePack operator/(DoublePack a, DoublePack b) { return {_mm_div_pd(a.l, b.l), _mm_div_pd(a.h, b.h)}; }
QSES_FN DoublePack square_root(DoublePack a) { return {_mm_sqrt_pd(a.l), _mm_sqrt_pd(a.h)}; }
QSES_FN DoublePack rounded_product(DoublePack a, DoublePack b) { return a * b; }
QSES_FN DoubleMask operator<(DoublePack a, DoublePack b) { return {_mm_cmplt_pd(a.l, b.l), _mm_cmplt_pd(a.h, b.h)}; }
QSES_FN DoubleMask operator<=(DoublePack a, DoublePack b) { return {_mm_cmple_pd(a.l, b.l), _mm_cmple_pd(a.h, b.h)}; }
QSES_FN DoubleMask operator!=(DoublePack a, DoublePack b) { return {_mm_cmpneq_pd(a.l, b.l), _mm_cmpneq_pd(a.h, b.h)}; }
QSES_FN DoubleMask operator&(DoubleMask a, DoubleMask b) { return {_mm_and_pd(a.l, b.l), _mm_and_pd(a.h, b.h)}; }
QSES_FN DoubleMask operator|(DoubleMask a, DoubleMask b) { return {_mm_or_pd(a.l, b.l), _mm_or_pd(a.h, b.h)}; }
QSES_FN DoublePack select(DoubleMask m, DoublePack yes, DoublePack no) {
  return {_mm_or_pd(_mm_and_pd(m.l, yes.l), _mm_andnot_pd(m.l, no.l)),
          _mm_or_pd(_mm_and_pd(m.h, yes.h), _mm_andnot_pd(m.h, no.h))};
}
QSES_FN bool any(DoubleMask m) { return (_mm_movemask_pd(m.l) | _mm_movemask_pd(m.h)) != 0; }
QSES_FN void store_pack(double *p, DoublePack a) {
  _mm_storeu_pd(p, a.l);
  _mm_storeu_pd(p + 2, a.h);
}
QSES_FN DoublePack to_doubles(__m128 four) { return {_mm_cvtps_pd(four), _mm_cvtps_pd(_mm_movehl_ps(four, four))}; }

#else

struct DoublePack {
  double v[4];
  DoublePack() = default;
  QSES_FN DoublePack(double x) : v{x, x, x, x} {}
};
struct DoubleMask {
  bool v[4];
};
// clang-format off
#define QSES_EACH_LANE for (int i = 0; i < kDoublePackSize; ++i)
QSES_FN DoublePack operator+(DoublePack a, DoublePack b) { QSES_EACH_LANE a.v[i] += b.v[i]; return a; }
QSES_FN DoublePack operator-(DoublePack a, DoublePack b) { QSES_EACH_LANE a.v[i] -= b.v[i]; return a; }
QSES_FN DoublePack operator*(DoublePack a, DoublePack b) { QSES_EACH_LANE a.v[i] *= b.v[i]; return a; }
QSES_FN DoublePack operator/(DoublePack a, DoublePack b) { QSES_EACH_LANE a.v[i] /= b.v[i]; return a; }
QSES_FN DoublePack square_root(DoublePack a) { QSES_EACH_LANE a.v[i] = std::sqrt(a.v[i]); return a; }
QSES_FN DoublePack rounded_product(DoublePack a, DoublePack b) {
  QSES_EACH_LANE { volatile double product = a.v[i] * b.v[i]; a.v[i] = product; }
  return a;
}
QSES_FN DoubleMask operator<(DoublePack a, DoublePack b) { DoubleMask m; QSES_EACH_LANE m.v[i] = a.v[i] < b.v[i]; return m; }
QSES_FN DoubleMask operator<=(DoublePack a, DoublePack b) { DoubleMask m; QSES_EACH_LANE m.v[i] = a.v[i] <= b.v[i]; return m; }
QSES_FN DoubleMask operator!=(DoublePack a, DoublePack b) { DoubleMask m; QSES_EACH_LANE m.v[i] = a.v[i] != b.v[i]; return m; }
QSES_FN DoubleMask operator&(DoubleMask a, DoubleMask b) { QSES_EACH_LANE a.v[i] = a.v[i] && b.v[i]; return a; }
QSES_FN DoubleMask operator|(DoubleMask a, DoubleMask b) { QSES_EACH_LANE a.v[i] = a.v[i] || b.v[i]; return a; }
QSES_FN DoublePack select(DoubleMask m, DoublePack yes, DoublePack no) { QSES_EACH_LANE no.v[i] = m.v[i] ? yes.v[i] : no.v[i]; return no; }
QSES_FN bool any(DoubleMask m) { bool found = false; QSES_EACH_LANE found |= m.v[i]; return found; }
QSES_FN void store_pack(double *p, DoublePack a) { QSES_EACH_LANE p[i] = a.v[i]; }
// clang-format on

#endif

QSES_FN DoubleMask operator>(DoublePack a, DoublePack b) { return b < a; }

// Three floats each from four places, of which nothing behind them is read.
#if defined(__AVX2__) || defined(QSES_PACK_SSE)
QSES_FN __m128 load_triple(const float *p) {
  return _mm_movelh_ps(_mm_loadl_pi(_mm_setzero_ps(), reinterpret_cast<const __m64 *>(p)), _mm_load_ss(p + 2));
}
template <class Place>
QSES_FN void load_triples(const Place &place, DoublePack *x, DoublePack *y, DoublePack *z) {
  __m128 a = load_triple(place(0)), b = load_triple(place(1)), c = load_triple(place(2)), d = load_triple(place(3));
  _MM_TRANSPOSE4_PS(a, b, c, d);
  *x = to_doubles(a);
  *y = to_doubles(b);
  *z = to_doubles(c);
}
#else
template <class Place>
QSES_FN void load_triples(const Place &place, DoublePack *x, DoublePack *y, DoublePack *z) {
  QSES_EACH_LANE { x->v[i] = place(i)[0], y->v[i] = place(i)[1], z->v[i] = place(i)[2]; }
}
#undef QSES_EACH_LANE
#endif

}  // namespace QSES_CPU_ISA
}  // namespace quickses
