// SPDX-License-Identifier: MIT
// WordPack: four 64-bit words that bit arithmetic treats like one. AVX2 where the file is compiled for it, plain words
// otherwise. Included only by the CPU kernels.
#pragma once

#include "parallel/pack.h"

namespace quickses {
namespace QSES_CPU_ISA {

constexpr int kPackWords = 4;

#if defined(__AVX2__)

struct WordPack {
  __m256i v;
  WordPack() = default;
  QSES_FN WordPack(__m256i x) : v(x) {}
  QSES_FN WordPack(uint64_t x) : v(_mm256_set1_epi64x(static_cast<long long>(x))) {}
  QSES_FN WordPack(uint64_t a, uint64_t b, uint64_t c, uint64_t d)
      : v(_mm256_setr_epi64x(static_cast<long long>(a), static_cast<long long>(b), static_cast<long long>(c),
                             static_cast<long long>(d))) {}
};
QSES_FN WordPack operator&(WordPack a, WordPack b) { return _mm256_and_si256(a.v, b.v); }
QSES_FN WordPack operator|(WordPack a, WordPack b) { return _mm256_or_si256(a.v, b.v); }
QSES_FN WordPack operator~(WordPack a) { return _mm256_xor_si256(a.v, _mm256_set1_epi64x(-1)); }
QSES_FN WordPack operator<<(WordPack a, int n) { return _mm256_slli_epi64(a.v, n); }
QSES_FN WordPack operator>>(WordPack a, int n) { return _mm256_srli_epi64(a.v, n); }
QSES_FN bool has_bits(WordPack a) { return !_mm256_testz_si256(a.v, a.v); }
// Two words from each of two places.
QSES_FN WordPack load_word_pairs(const uint64_t *low, const uint64_t *high) {
  return _mm256_inserti128_si256(_mm256_castsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i *>(low))),
                                 _mm_loadu_si128(reinterpret_cast<const __m128i *>(high)), 1);
}
QSES_FN WordPack load_words(const uint64_t *p) { return _mm256_loadu_si256(reinterpret_cast<const __m256i *>(p)); }
QSES_FN void store_words(uint64_t *p, WordPack a) { _mm256_storeu_si256(reinterpret_cast<__m256i *>(p), a.v); }
// {1, none, 3, none} and {none, 0, none, 2}; {2, 3, none, none} and {none, none, 0, 1}.
QSES_FN WordPack next_words(WordPack a) { return _mm256_unpackhi_epi64(a.v, _mm256_setzero_si256()); }
QSES_FN WordPack words_before(WordPack a) { return _mm256_unpacklo_epi64(_mm256_setzero_si256(), a.v); }
QSES_FN WordPack next_pairs(WordPack a) { return _mm256_permute2x128_si256(a.v, a.v, 0x81); }
QSES_FN WordPack pairs_before(WordPack a) { return _mm256_permute2x128_si256(a.v, a.v, 0x08); }

#else

struct WordPack {
  uint64_t v[kPackWords];
  WordPack() = default;
  QSES_FN WordPack(uint64_t x) : v{x, x, x, x} {}
  QSES_FN WordPack(uint64_t a, uint64_t b, uint64_t c, uint64_t d) : v{a, b, c, d} {}
};
// clang-format off
#define QSES_EACH_WORD for (int i = 0; i < kPackWords; ++i)
QSES_FN WordPack operator&(WordPack a, WordPack b) { QSES_EACH_WORD a.v[i] &= b.v[i]; return a; }
QSES_FN WordPack operator|(WordPack a, WordPack b) { QSES_EACH_WORD a.v[i] |= b.v[i]; return a; }
QSES_FN WordPack operator~(WordPack a) { QSES_EACH_WORD a.v[i] = ~a.v[i]; return a; }
QSES_FN WordPack operator<<(WordPack a, int n) { QSES_EACH_WORD a.v[i] <<= n; return a; }
QSES_FN WordPack operator>>(WordPack a, int n) { QSES_EACH_WORD a.v[i] >>= n; return a; }
#undef QSES_EACH_WORD
// clang-format on
QSES_FN bool has_bits(WordPack a) { return (a.v[0] | a.v[1] | a.v[2] | a.v[3]) != 0; }
QSES_FN WordPack load_word_pairs(const uint64_t *low, const uint64_t *high) {
  return {low[0], low[1], high[0], high[1]};
}
QSES_FN WordPack load_words(const uint64_t *p) { return {p[0], p[1], p[2], p[3]}; }
QSES_FN void store_words(uint64_t *p, WordPack a) {
  for (int i = 0; i < kPackWords; ++i) p[i] = a.v[i];
}
QSES_FN WordPack next_words(WordPack a) { return {a.v[1], 0, a.v[3], 0}; }
QSES_FN WordPack words_before(WordPack a) { return {0, a.v[0], 0, a.v[2]}; }
QSES_FN WordPack next_pairs(WordPack a) { return {a.v[2], a.v[3], 0, 0}; }
QSES_FN WordPack pairs_before(WordPack a) { return {0, 0, a.v[0], a.v[1]}; }

#endif

}  // namespace QSES_CPU_ISA
}  // namespace quickses
