// SPDX-License-Identifier: MIT
// Random numbers that are the same on every platform (the distributions of the standard library are not), and steps
// from a float to its neighbours. For the property tests.
#pragma once

#include "surface/exact_reference.h"

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <random>

namespace properties {

using exact_reference::Point;

// How many, and where to begin, for those who want more than the tests do by themselves.
inline uint64_t number_from_environment(const char *name, uint64_t otherwise) {
  const char *text = std::getenv(name);
  return text && *text ? std::strtoull(text, nullptr, 10) : otherwise;
}

class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}

  uint64_t below(uint64_t count) { return engine_() % count; }
  size_t count(size_t low, size_t high) { return low + static_cast<size_t>(below(high - low + 1)); }
  double unit() { return static_cast<double>(engine_() >> 11) * (1.0 / 9007199254740992.0); }
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  double log_uniform(double low, double high) { return low * std::exp(std::log(high / low) * unit()); }
  bool chance(double probability) { return unit() < probability; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }

  template <size_t N>
  double any_of(const double (&values)[N]) {
    return values[below(N)];
  }

  Point in_box(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Point direction() {
    for (;;) {
      const Point p = in_box(1);
      const double l = exact_reference::length(p);
      if (l > 0.1 && l < 1) return (1 / l) * p;
    }
  }

  // 0, or from 1 to 10,000 steps up or down, small ones as likely as large ones.
  int ulps() {
    if (chance(0.3)) return 0;
    return static_cast<int>(sign() * log_uniform(1, 10000));
  }

 private:
  std::mt19937_64 engine_;
};

// The float that is so many representable numbers away. Not across 0.
inline float stepped(float value, int ulps) {
  uint32_t bits;
  std::memcpy(&bits, &value, 4);
  const int64_t magnitude = static_cast<int64_t>(bits & 0x7fffffffu) + (bits >> 31 ? -ulps : ulps);
  if (magnitude <= 0 || magnitude >= 0x7f800000) return value;
  bits = (bits & 0x80000000u) | static_cast<uint32_t>(magnitude);
  std::memcpy(&value, &bits, 4);
  return value;
}

struct Rotation {
  double m[3][3];
  Point operator()(const Point &p) const {
    return {m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z, m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z,
            m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z};
  }
};

inline Rotation random_rotation(Random &random) {
  double q[4], n = 0;
  do {
    n = 0;
    for (double &v : q) {
      v = random.uniform(-1, 1);
      n += v * v;
    }
  } while (n < 0.01 || n > 1);
  for (double &v : q) v /= std::sqrt(n);
  const double a = q[0], b = q[1], c = q[2], d = q[3];
  return {{{a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
           {2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)},
           {2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d}}};
}

}  // namespace properties
