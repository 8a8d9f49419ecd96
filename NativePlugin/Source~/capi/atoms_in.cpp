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

namespace {

// Box of the positions at(0) ... at(count - 1), each a pointer to three floats.
template <class At>
AtomBounds bound_positions(size_t count, const At &at) {
  AtomBounds bounds{glm::vec3(0.f), glm::vec3(0.f), 0.f};
  for (size_t i = 0; i < count; ++i) {
    float p[3];
    std::memcpy(p, at(i), sizeof p);
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

const char *position_at(const float *positions, size_t stride, size_t i) {
  return reinterpret_cast<const char *>(positions) + i * (stride ? stride : 12);
}

}  // namespace

AtomBounds check_positions(const float *positions, size_t stride, size_t count) {
  return bound_positions(count, [&](size_t i) { return position_at(positions, stride, i); });
}

AtomBounds check_indexed_positions(const float *positions, size_t stride, size_t position_count,
                                   const uint32_t *indices, size_t count) {
  if (count > 0) require(indices, "indices");
  for (size_t i = 0; i < count; ++i)
    if (indices[i] >= position_count)
      invalid("indices[" + std::to_string(i) + "] is " + std::to_string(indices[i]) + " but there are " +
              std::to_string(position_count) + " positions");
  return bound_positions(count, [&](size_t i) { return position_at(positions, stride, indices[i]); });
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
  for (size_t i = 0; i < count; ++i) std::memcpy(&atoms[i].center, position_at(positions, stride, i), 12);
}

void copy_indexed_positions(const float *positions, size_t stride, const uint32_t *indices, size_t count,
                            Sphere *atoms) {
  for (size_t i = 0; i < count; ++i) std::memcpy(&atoms[i].center, position_at(positions, stride, indices[i]), 12);
}

}  // namespace quickses
