// SPDX-License-Identifier: MIT
// Checks the caller's atoms and copies them into the back end's memory.
#include "capi/atoms_in.h"

#include "capi/barrier.h"

#include <cmath>
#include <cstring>

namespace quickses {
namespace {

constexpr float kLargestCoordinate = 1e6f;
constexpr float kLargestRadius = 100.f;

[[noreturn]] void bad_position(size_t atom, const float *p) {
  char text[160];
  const bool finite = std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
  std::snprintf(text, sizeof text, "position of atom %zu is (%g, %g, %g): %s", atom, static_cast<double>(p[0]),
                static_cast<double>(p[1]), static_cast<double>(p[2]),
                finite ? "coordinates must lie within 1e6 Å of the origin" : "coordinates must be finite");
  invalid(text);
}

}  // namespace

void check_layout(const float *positions, size_t stride, size_t count) {
  if (count == 0) return;
  require(positions, "positions");
  if (count > 0x7fffffffu) invalid("count is " + std::to_string(count) + ": at most 2147483647 atoms are possible");
  if (stride != 0 && (stride < 12 || stride % 4 != 0))
    invalid("stride is " + std::to_string(stride) + ": it must be 0, or a multiple of 4 that is at least 12");
}

AtomBounds check_positions(const float *positions, size_t stride, size_t count) {
  AtomBounds bounds{glm::vec3(0.f), glm::vec3(0.f), 0.f};
  const size_t step = stride ? stride : 12;
  const char *at = reinterpret_cast<const char *>(positions);
  for (size_t i = 0; i < count; ++i, at += step) {
    float p[3];
    std::memcpy(p, at, sizeof p);
    // NaN fails every comparison, so it ends here too.
    if (!(std::fabs(p[0]) <= kLargestCoordinate && std::fabs(p[1]) <= kLargestCoordinate &&
          std::fabs(p[2]) <= kLargestCoordinate))
      bad_position(i, p);
    for (int d = 0; d < 3; ++d) {
      bounds.low[d] = i == 0 || p[d] < bounds.low[d] ? p[d] : bounds.low[d];
      bounds.high[d] = i == 0 || p[d] > bounds.high[d] ? p[d] : bounds.high[d];
    }
  }
  return bounds;
}

float check_radii(const float *radii, size_t count) {
  if (count == 0) return 0.f;
  require(radii, "radii");
  float largest = 0.f;
  for (size_t i = 0; i < count; ++i) {
    if (!(radii[i] > 0.f && radii[i] <= kLargestRadius)) {
      char text[128];
      std::snprintf(text, sizeof text, "radius of atom %zu is %g: it must be above 0 and at most 100 Å", i,
                    static_cast<double>(radii[i]));
      invalid(text);
    }
    largest = radii[i] > largest ? radii[i] : largest;
  }
  return largest;
}

void copy_positions(const float *positions, size_t stride, size_t count, Sphere *atoms) {
  const size_t step = stride ? stride : 12;
  const char *at = reinterpret_cast<const char *>(positions);
  for (size_t i = 0; i < count; ++i, at += step) std::memcpy(&atoms[i].center, at, 12);
}

}  // namespace quickses
