// SPDX-License-Identifier: MIT
// The directions in which the nodes of the ambient occlusion look at the sky, the steps of their rays, and what they
// know of it (occlusion.h).
#pragma once

#include "surface/geometry/types.h"
#include "surface/stages/bricks.h"

#include <cmath>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace quickses {

constexpr float kOcclusionPoint = 1.f;  // Å between points of the lattice; its bricks have 8 of them along an edge
constexpr float kSkyDistance = 20.f;    // Å

// Evenly spread over the sphere: a spiral with the golden angle.
struct SkyDirections {
  static constexpr int kCount = 48;
  float direction[kCount][kAxes];
  SkyDirections() {
    for (int k = 0; k < kCount; ++k) {
      const double z = 1 - (2 * k + 1) / static_cast<double>(kCount), across = std::sqrt(1 - z * z);
      const double angle = 2.399963229728653 * k;
      direction[k][0] = rounded(across * std::cos(angle));
      direction[k][1] = rounded(across * std::sin(angle));
      direction[k][2] = rounded(z);
    }
  }
  // So that sums of them are exact, whatever their order.
  static float rounded(double x) { return static_cast<float>(std::nearbyint(x * 65536) / 65536); }
};

// What a node knows: twice the mean of the directions that are free, and what part of all they are. The light on a
// plane is then dot(mean, normal) + part. Within a ball, part is kFilled.
struct alignas(16) Openness {
  float value[4];
  QSES_FN float part() const { return value[3]; }
};
constexpr float kFilled = -1.f;

// A sum of what nodes know, in the order in which it is added. With weights, those within a ball do not count.
struct OpennessSum {
#if defined(__SSE__) && !defined(__CUDA_ARCH__)
  __m128 value = _mm_setzero_ps(), weights = _mm_setzero_ps();  // weights: four times the same
  void add(const Openness &open) { value = _mm_add_ps(value, _mm_load_ps(open.value)); }
  void add(float weight, const Openness &open) {
    const __m128 other = _mm_load_ps(open.value), part = _mm_shuffle_ps(other, other, 0xff);
    const __m128 counted = _mm_and_ps(_mm_cmpge_ps(part, _mm_setzero_ps()), _mm_set1_ps(weight));
    value = _mm_add_ps(value, _mm_mul_ps(counted, other));
    weights = _mm_add_ps(weights, counted);
  }
  float weight() const { return _mm_cvtss_f32(weights); }
  Openness total() const {
    Openness t;
    _mm_store_ps(t.value, value);
    return t;
  }
#else
  Openness value = {};
  float weights = 0.f;
  QSES_FN void add(const Openness &open) {
    for (int k = 0; k < 4; ++k) value.value[k] += open.value[k];
  }
  QSES_FN void add(float weight, const Openness &open) {
    const float counted = open.part() >= 0.f ? weight : 0.f;
    for (int k = 0; k < 4; ++k) value.value[k] += counted * open.value[k];
    weights += counted;
  }
  QSES_FN float weight() const { return weights; }
  QSES_FN Openness total() const { return value; }
#endif
};

// The bricks that rays from a brick may come to, numbered: a cube around it.
struct SkyBricks {
  static constexpr int kReach = 3, kEdge = 2 * kReach + 1, kCount = kEdge * kEdge * kEdge;
  QSES_FN static glm::ivec3 step(int k) {
    return glm::ivec3(k % kEdge, k / kEdge % kEdge, k / (kEdge * kEdge)) - kReach;
  }
  // Of the point so far from the brick's first.
  QSES_FN static int number(int dx, int dy, int dz) {
    return (dx >> 3) + kReach + kEdge * ((dy >> 3) + kReach + kEdge * ((dz >> 3) + kReach));
  }
};

// What is a step of a ray away from each node of a brick, out of the words of up to eight bricks: from which brick on,
// which of their words, and how many nodes on besides.
struct SkyStep {
  uint64_t stays_x, stays_y;  // nodes of which that is in the same brick along x and y
  int16_t brick;
  int8_t word, x, y, z;
  SkyStep() = default;
  QSES_FN SkyStep(int dx, int dy, int dz)
      : stays_x(static_cast<uint64_t>(0xf >> (dx >> 1 & 3)) * 0x1111111111111111ull),
        stays_y(static_cast<uint64_t>(0xffff >> 4 * (dy >> 1 & 3)) * 0x0001000100010001ull),
        brick(static_cast<int16_t>(SkyBricks::number(dx, dy, dz))),
        word(static_cast<int8_t>((dx & 1) | (dy & 1) << 1 | (dz & 1) << 2)),
        x(static_cast<int8_t>(dx >> 1 & 3)),
        y(static_cast<int8_t>(dy >> 1 & 3)),
        z(static_cast<int8_t>(dz >> 1 & 3)) {}
};

// Steps grow with the distance, as what is seen there covers more of the sky, but never beyond a layer of atoms.
// visit(step) tells whether to go on.
template <class Visit>
QSES_FN void for_sky_steps(const float (&direction)[kAxes], const Visit &visit) {
  const auto round = [](float x) { return static_cast<int>(x + 64.5f) - 64; };  // of numbers above -64
  for (float t = 1.f; t <= kSkyDistance / kOcclusionPoint; t += minimum(2.5f, maximum(1.f, 0.35f * t)))
    if (!visit(SkyStep(round(t * direction[0]), round(t * direction[1]), round(t * direction[2])))) return;
}

#if !defined(__CUDA_ARCH__)
// What is the same for all bricks: a CPU looks it up, which takes a GPU longer than to find it.
struct SkyTable {
  static constexpr int kMostSteps = 16, kFour = 4;
  SkyStep steps[SkyDirections::kCount][kMostSteps];
  int step_count = 0;  // of each direction
  int16_t bricks[SkyBricks::kCount];
  int brick_count = 0;  // that rays do come to
  Openness sums[SkyDirections::kCount / kFour][1 << kFour] =
      {};  // of each set of four directions that follow each other

  SkyTable() {
    const SkyDirections sky;
    bool reached[SkyBricks::kCount] = {};
    for (int d = 0; d < SkyDirections::kCount; ++d) {
      step_count = 0;
      for_sky_steps(sky.direction[d], [&](const SkyStep &step) {
        steps[d][step_count++] = step;
        constexpr int kEdge = SkyBricks::kEdge;
        for (int z = 0; z <= (step.z ? 1 : 0); ++z)
          for (int y = 0; y <= (step.y ? 1 : 0); ++y)
            for (int x = 0; x <= (step.x ? 1 : 0); ++x) reached[step.brick + x + kEdge * (y + kEdge * z)] = true;
        return step_count < kMostSteps;
      });
      for (int set = 0; set < 1 << kFour; ++set) {
        Openness &sum = sums[d / kFour][set];
        if ((set >> d % kFour & 1) == 0) continue;
        for (int axis = 0; axis < kAxes; ++axis) sum.value[axis] += sky.direction[d][axis];
        sum.value[3] += 1.f;
      }
    }
    for (int k = 0; k < SkyBricks::kCount; ++k)
      if (reached[k]) bricks[brick_count++] = static_cast<int16_t>(k);
  }

  static const SkyTable &get() {
    static const SkyTable table;
    return table;
  }
};

// Bit j of word k goes to bit k of word j, by halves, quarters, and so on (Warren, Hacker's Delight, 7-3).
inline void transpose_bits(uint64_t (&words)[64]) {
  uint64_t low = 0x00000000ffffffffull;
  for (int half = 32; half; half >>= 1, low ^= low << half)
    for (int k = 0; k < 64; k = (k + half + 1) & ~half) {
      const uint64_t exchanged = (words[k] >> half ^ words[k + half]) & low;
      words[k] ^= exchanged << half;
      words[k + half] ^= exchanged;
    }
}
#endif

}  // namespace quickses
