// SPDX-License-Identifier: MIT
// CPU: atoms that are buried beyond doubt are known without their circles. Discs are laid over the atom's sphere; it is
// covered if each lies within a cap, or each of the seven smaller discs that cover it does, and so on.
#pragma once

#include "parallel/wide_pack.h"
#include "parallel/working_thread.h"
#include "surface/geometry/circle.h"

#include <cmath>

namespace quickses {
namespace QSES_CPU_ISA {

// What is said to be covered lies this deep in a ball, at least, Å: of less, the circles of the neighbours, whose caps
// are rounded differently, could say that it is not.
inline float least_covered_depth(float max_radius) { return maximum(5 * kExposureTolerance, 1e-5f * max_radius); }

// Directions that turn by the golden angle while they go down, told in an order that is soon everywhere. None is
// farther from the nearest than 0.3414.
struct SpreadDirections {
  static constexpr int kCount = 64, kStep = 27;
  Vec3<float> at[kCount];
  SpreadDirections() {
    for (int k = 0; k < kCount; ++k) {
      const int place = k * kStep % kCount;
      const double z = 1 - (2 * place + 1) / double(kCount), r = std::sqrt(1 - z * z), turn = 2.399963229728653 * place;
      at[k] = {static_cast<float>(r * std::cos(turn)), static_cast<float>(r * std::sin(turn)), static_cast<float>(z)};
    }
  }
};

class CoveredSphere {
 public:
  static constexpr int kLevels = 4;

  // Of n caps, in columns that may be read up to the next whole pack: axes, cosines, sines, and how much deeper the
  // sphere lies in the ball with each radian from the border of the cap. bounds: room for as many.
  CoveredSphere(const Vec3<const float *> &axes, const float *cosines, const float *sines, const float *slopes, int n,
                float least_depth, float *const (&bounds)[kLevels])
      : axes_(axes), count_(n) {
    for (int level = 0; level < kLevels; ++level) bounds_[level] = bounds[level];
    for (int q = 0; q < n; q += kWideLanes) {
      const WidePack cosine = load_wide(cosines + q), sine = load_wide(sines + q), slope = load_wide(slopes + q);
      for (int level = 0; level < kLevels; ++level) {
        const Disc &disc = kDiscs[level];
        // The cosine of the cap's angle less the disc's, if there is anything left.
        const WidePack c(disc.cosine), bound = cosine * c + sine * WidePack(disc.sine);
        const auto counts = (cosine < c) & (WidePack(least_depth) < slope * WidePack(disc.margin));
        store_pack(bounds[level] + q, select(counts, bound, WidePack(2.f)));
      }
    }
  }

  bool is_covered() {
    static const SpreadDirections directions;
    for (int k = 0; k < SpreadDirections::kCount; ++k) {
      if (k % 8 == 0) look_for_stop();  // in a crowd, the smallest discs take their time
      if (!is_disc_covered(directions.at[k], 0)) return false;
    }
    return true;
  }

 private:
  // Discs of .345, .176, .0898 and .0458 radians. Seven of half a disc's radius, six of them .85 of it away from its
  // middle, cover it; these are larger by a margin.
  struct Disc {
    float cosine, sine;
    float cosine_away;
    float margin;  // radians
  };
  static constexpr Disc kDiscs[kLevels] = {{0.9410755f, 0.3381967f, 0.9573095f, 0.0035f},
                                           {0.9845519f, 0.1750928f, 0.9888308f, 0.0034f},
                                           {0.9959707f, 0.0896794f, 0.9970883f, 0.0017f},
                                           {0.9989514f, 0.0457840f, 0.9992423f, 0.0008f}};
  static constexpr float kHexagon[6][2] = {{1.f, 0.f},  {0.5f, 0.8660254f},   {-0.5f, 0.8660254f},
                                           {-1.f, 0.f}, {-0.5f, -0.8660254f}, {0.5f, -0.8660254f}};

  bool is_within_a_cap(const Vec3<float> &middle, int level) {
    const Vec3<WidePack> d(WidePack(middle.x), WidePack(middle.y), WidePack(middle.z));
    // Which caps it is can't be foreseen: a few packs are looked at before the next branch.
    constexpr int kTogether = 64;
    for (int first = 0, last; first < count_; first = last) {
      last = first + kTogether < count_ ? first + kTogether : count_;
      uint32_t within = 0;
      for (int q = first; q < last; q += kWideLanes) {
        const Vec3<WidePack> axis(load_wide(axes_.x + q), load_wide(axes_.y + q), load_wide(axes_.z + q));
        within |= lane_bits(load_wide(bounds_[level] + q) <= dot(d, axis));
      }
      if (within) return true;
    }
    return false;
  }

  bool is_disc_covered(const Vec3<float> &middle, int level) {
    if (is_within_a_cap(middle, level)) return true;
    if (level + 1 == kLevels || !is_disc_covered(middle, level + 1)) return false;
    const Circle around = make_circle(glm::vec3(middle.x, middle.y, middle.z), kDiscs[level].cosine_away, 1.f);
    for (int k = 0; k < 6; ++k) {
      const Vec3<float> side = around.e1 * kHexagon[k][0] + around.e2 * kHexagon[k][1];
      if (!is_disc_covered(around.axis * around.cosine + side * around.sine, level + 1)) return false;
    }
    return true;
  }

  Vec3<const float *> axes_;
  const float *bounds_[kLevels];
  int count_;
};

}  // namespace QSES_CPU_ISA
}  // namespace quickses
