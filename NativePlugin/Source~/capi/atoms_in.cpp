// SPDX-License-Identifier: MIT
// Checks the caller's atoms and copies them into the back end's memory.
#include "capi/atoms_in.h"

#include "capi/barrier.h"
#include "capi/structs.h"
#include "io/text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#if defined(__SSE2__) || defined(_M_X64)
#include <emmintrin.h>
#endif

namespace quickses {
namespace {

constexpr float kLargestCoordinate = 1e6f;
constexpr float kLargestRadius = 100.f;

[[noreturn]] void bad_position(size_t atom, const glm::vec3 &p) {
  const bool finite = std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
  const auto text = [&p](int axis) { return number_text(static_cast<double>(p[axis])); };
  invalid("position of atom " + std::to_string(atom) + " is (" + text(0) + ", " + text(1) + ", " + text(2) +
          "): " + (finite ? "coordinates must lie within 1e6 Å of the origin" : "coordinates must be finite"));
}

}  // namespace

void check_layout(const float *positions, size_t stride, size_t count, const char *argument) {
  if (count == 0) return;
  require(positions, "positions");
  if (count > 0x7fffffffu)
    invalid(std::string(argument) + " is " + std::to_string(count) + ": at most 2147483647 are possible");
  if (stride != 0 && (stride < 12 || stride % 4 != 0))
    invalid("stride is " + std::to_string(stride) + ": it must be 0, or a multiple of 4 that is at least 12");
  if (stride != 0 && count - 1 > static_cast<size_t>(PTRDIFF_MAX) / stride)
    invalid("stride is " + std::to_string(stride) + ": no memory holds " + std::to_string(count) +
            " positions that are so far apart");
}

namespace {

glm::vec3 load(const char *position) {
  glm::vec3 p;
  for (int d = 0; d < 3; ++d) std::memcpy(&p[d], position + 4 * d, 4);
  return p;
}

bool is_in_range(const glm::vec3 &p) {
  bool is_good = true;
  for (int d = 0; d < 3; ++d) is_good &= std::fabs(p[d]) <= kLargestCoordinate;  // NaN fails every comparison
  return is_good;
}

// What is known of positions while they are copied, which is done for each frame of a trajectory while the back end
// waits for it.
struct Met {
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();
  glm::vec3 low{kInfinity}, high{-kInfinity};
  bool all_good = true;

  void meet(const glm::vec3 &p) {
    all_good &= is_in_range(p);
    for (int d = 0; d < 3; ++d) {
      low[d] = p[d] < low[d] ? p[d] : low[d];
      high[d] = p[d] > high[d] ? p[d] : high[d];
    }
  }
  void add(const Met &other) {
    all_good &= other.all_good;
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
};

#if defined(__SSE2__) || defined(_M_X64)

// Writes past the caches, which many atoms do not fit into: they are not read soon.
struct StorePast {
  void operator()(float *to, __m128 v) const { _mm_stream_ps(to, v); }
};
struct Store {
  void operator()(float *to, __m128 v) const { _mm_storeu_ps(to, v); }
};

// Of those that lie behind each other, four at a time; compilers do not find these shuffles. Returns how many.
template <class StorePack>
size_t copy_in_fours(const float *positions, const float *radii, size_t count, Sphere *atoms, Met *met,
                     const StorePack &store) {
  constexpr size_t kFloats = 12;
  __m128 low[3], high[3], has_nan = _mm_setzero_ps();
  for (int k = 0; k < 3; ++k) {
    low[k] = _mm_set1_ps(Met::kInfinity);
    high[k] = _mm_set1_ps(-Met::kInfinity);
  }
  size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    // x0 y0 z0 x1, y1 z1 x2 y2, z2 x3 y3 z3
    const float *const from = positions + 3 * i;
    const __m128 v[3] = {_mm_loadu_ps(from), _mm_loadu_ps(from + 4), _mm_loadu_ps(from + 8)};
    for (int k = 0; k < 3; ++k) {
      low[k] = _mm_min_ps(v[k], low[k]);  // of a NaN, the second
      high[k] = _mm_max_ps(v[k], high[k]);
    }
    has_nan = _mm_or_ps(has_nan, _mm_or_ps(_mm_cmpunord_ps(v[0], v[1]), _mm_cmpunord_ps(v[2], v[2])));
    const __m128 r = _mm_loadu_ps(radii + i);
    const __m128 z0r0 = _mm_shuffle_ps(v[0], r, _MM_SHUFFLE(0, 0, 2, 2)),
                 x1y1 = _mm_shuffle_ps(v[0], v[1], _MM_SHUFFLE(0, 0, 3, 3)),
                 z1r1 = _mm_shuffle_ps(v[1], r, _MM_SHUFFLE(1, 1, 1, 1)),
                 z2r2 = _mm_shuffle_ps(v[2], r, _MM_SHUFFLE(2, 2, 0, 0)),
                 z3r3 = _mm_shuffle_ps(v[2], r, _MM_SHUFFLE(3, 3, 3, 3));
    float *const to = &atoms[i].center.x;
    store(to, _mm_shuffle_ps(v[0], z0r0, _MM_SHUFFLE(2, 0, 1, 0)));
    store(to + 4, _mm_shuffle_ps(x1y1, z1r1, _MM_SHUFFLE(2, 0, 2, 0)));
    store(to + 8, _mm_shuffle_ps(v[1], z2r2, _MM_SHUFFLE(2, 0, 3, 2)));
    store(to + 12, _mm_shuffle_ps(v[2], z3r3, _MM_SHUFFLE(2, 0, 2, 1)));
  }
  float lows[kFloats], highs[kFloats];
  for (size_t k = 0; k < 3; ++k) {
    _mm_storeu_ps(lows + 4 * k, low[k]);
    _mm_storeu_ps(highs + 4 * k, high[k]);
  }
  for (size_t k = 0; k < kFloats && i > 0; k += 3) {
    met->meet({lows[k], lows[k + 1], lows[k + 2]});
    met->meet({highs[k], highs[k + 1], highs[k + 2]});
  }
  met->all_good &= _mm_movemask_ps(has_nan) == 0;
  return i;
}

// goes_past: the caches.
size_t copy_in_fours(const float *positions, const float *radii, size_t count, Sphere *atoms, bool goes_past,
                     Met *met) {
  if (!goes_past || reinterpret_cast<uintptr_t>(atoms) % sizeof(__m128) != 0)
    return copy_in_fours(positions, radii, count, atoms, met, Store{});
  const size_t copied = copy_in_fours(positions, radii, count, atoms, met, StorePast{});
  _mm_sfence();
  return copied;
}

#else

size_t copy_in_fours(const float *, const float *, size_t, Sphere *, bool, Met *) { return 0; }

#endif

constexpr size_t kChunk = size_t(1) << 13;  // for a thread at a time
// So many go past the caches: what a GPU fetches is in none, and to get it there takes longer than to write it.
constexpr size_t kManyForGpu = size_t(1) << 11, kManyForCpu = size_t(1) << 17;  // 2 MB

// From first to last, of the positions at(i), each a pointer to three floats.
template <class At>
void copy_each(size_t first, size_t last, const At &at, const float *radii, Sphere *atoms, Met *met) {
  Met own;  // which stays in registers
  for (size_t i = first; i < last; ++i) {
    const glm::vec3 p = load(at(i));
    atoms[i] = {p, radii[i]};
    own.meet(p);
  }
  met->add(own);
}

#if defined(__x86_64__) || defined(_M_X64)
template <class Copy>
__attribute__((target("avx"), flatten)) void copy_by_avx(const Copy &copy, size_t first, size_t last, Met *met) {
  copy(first, last, met);
}
#endif
// copy(first, last, met), in AVX's encoding of the same instructions where there is AVX: it overwrites whole registers.
// The older one keeps their upper parts, which others may have left in use (the C library's memcpy does, with AVX-512),
// and then each instruction waits for the one that wrote its register before. Positions take 1.7 times as long so.
template <class Copy>
void copy_run(const Copy &copy, size_t first, size_t last, Met *met) {
#if defined(__x86_64__) || defined(_M_X64)
  if (__builtin_cpu_supports("avx")) return copy_by_avx(copy, first, last, met);
#endif
  copy(first, last, met);
}

// copy(first, last, met) for all atoms, by threads that share them out; returns what was met of them.
template <class Copy>
AtomBounds copy_all(size_t count, const Sphere *atoms, CpuThreads *threads, const Copy &copy) {
  Met by_worker[kMostCopyThreads];
  const size_t chunks = count / kChunk + 1;
  const auto copy_chunk = [&](size_t worker, size_t chunk) {
    copy_run(copy, chunk * kChunk, std::min(count, (chunk + 1) * kChunk), &by_worker[worker]);
  };
  if (threads && chunks > 2)
    threads->share_out(chunks, nullptr, copy_chunk);
  else
    copy_run(copy, 0, count, &by_worker[0]);
  Met met;
  for (const Met &own : by_worker) met.add(own);
  for (size_t i = 0; !met.all_good && i < count; ++i)
    if (!is_in_range(atoms[i].center)) bad_position(i, atoms[i].center);
  if (count == 0) met.low = met.high = glm::vec3(0.f);
  return {met.low, met.high, 0.f};
}

const char *position_at(const float *positions, size_t stride, size_t i) {
  return reinterpret_cast<const char *>(positions) + i * (stride ? stride : 12);
}

}  // namespace

AtomBounds copy_atoms(const float *positions, size_t stride, const float *radii, size_t count, Sphere *atoms,
                      CpuThreads *threads) {
  const bool is_packed = stride == 0 || stride == 12;
  const bool goes_past = count >= (threads ? kManyForGpu : kManyForCpu);
  const auto at = [&](size_t i) { return position_at(positions, stride, i); };
  return copy_all(count, atoms, threads, [&](size_t first, size_t last, Met *met) {
    if (is_packed)
      first += copy_in_fours(positions + 3 * first, radii + first, last - first, atoms + first, goes_past, met);
    copy_each(first, last, at, radii, atoms, met);
  });
}

void check_indices(const uint32_t *indices, size_t count, size_t position_count) {
  if (count > 0) require(indices, "indices");
  for (size_t i = 0; i < count; ++i)
    if (indices[i] >= position_count)
      invalid("indices[" + std::to_string(i) + "] is " + std::to_string(indices[i]) + " but " +
              io::there_are(position_count, "position"));
}

AtomBounds copy_indexed_atoms(const float *positions, size_t stride, const uint32_t *indices, const float *radii,
                              size_t count, Sphere *atoms, CpuThreads *threads) {
  const auto at = [&](size_t i) { return position_at(positions, stride, indices[i]); };
  return copy_all(count, atoms, threads,
                  [&](size_t first, size_t last, Met *met) { copy_each(first, last, at, radii, atoms, met); });
}

namespace {

// Below this nobody notices how far look-ups reach.
constexpr float kNoticedRadius = 8.f;  // Å
// So many are soon looked at, beside what else is near a place.
constexpr size_t kMostLarge = 32;

// Those at least twice as large as all others, if they are few; again while the others still reach far.
AtomRadii tell_large_atoms(const float *radii, size_t count, float largest) {
  const size_t most = std::min(kMostLarge, count / 8);
  AtomRadii found{largest, largest, 0};
  while (found.usual > kNoticedRadius) {
    const float half = 0.5f * found.usual;
    float usual = 0.f;
    size_t large = 0;
    for (size_t i = 0; i < count && large <= most; ++i)
      if (radii[i] > half)
        ++large;
      else
        usual = std::max(usual, radii[i]);
    if (large > most) break;
    found.usual = usual;
    found.large = static_cast<uint32_t>(large);
  }
  return found;
}

}  // namespace

AtomRadii check_radii(const float *radii, size_t count) {
  if (count == 0) return {};
  require(radii, "radii");
  float largest = 0.f;
  for (size_t i = 0; i < count; ++i) {
    if (!(radii[i] > 0.f && radii[i] <= kLargestRadius))
      invalid("radius of atom " + std::to_string(i) + " is " + number_text(static_cast<double>(radii[i])) +
              ": it must be above 0 and at most 100 Å");
    largest = radii[i] > largest ? radii[i] : largest;
  }
  return tell_large_atoms(radii, count, largest);
}

}  // namespace quickses
