// SPDX-License-Identifier: MIT
// Checks the caller's atoms and copies them into the back end's memory.
#include "capi/atoms_in.h"

#include "capi/barrier.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace quickses {
namespace {

constexpr float kLargestCoordinate = 1e6f;
constexpr float kLargestRadius = 100.f;

[[noreturn]] void bad_position(size_t atom, const glm::vec3 &p) {
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

// Of the positions at(0) ... at(count - 1), each a pointer to three floats. Once for each frame of a trajectory, while
// the back end waits for it.
template <class At>
AtomBounds check_and_copy(size_t count, const At &at, Sphere *atoms) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  glm::vec3 low(kInfinity), high(-kInfinity);
  bool all_good = true;
  for (size_t i = 0; i < count; ++i) {
    const glm::vec3 p = load(at(i));
    all_good &= is_in_range(p);
    for (int d = 0; d < 3; ++d) {
      low[d] = p[d] < low[d] ? p[d] : low[d];
      high[d] = p[d] > high[d] ? p[d] : high[d];
    }
    atoms[i].center = p;
  }
  for (size_t i = 0; !all_good && i < count; ++i)
    if (!is_in_range(atoms[i].center)) bad_position(i, atoms[i].center);
  if (count == 0) low = high = glm::vec3(0.f);
  return {low, high, 0.f};
}

const char *position_at(const float *positions, size_t stride, size_t i) {
  return reinterpret_cast<const char *>(positions) + i * (stride ? stride : 12);
}

}  // namespace

AtomBounds copy_positions(const float *positions, size_t stride, size_t count, Sphere *atoms) {
  return check_and_copy(
      count, [&](size_t i) { return position_at(positions, stride, i); }, atoms);
}

void check_indices(const uint32_t *indices, size_t count, size_t position_count) {
  if (count > 0) require(indices, "indices");
  for (size_t i = 0; i < count; ++i)
    if (indices[i] >= position_count)
      invalid("indices[" + std::to_string(i) + "] is " + std::to_string(indices[i]) + " but there are " +
              std::to_string(position_count) + " positions");
}

AtomBounds copy_indexed_positions(const float *positions, size_t stride, const uint32_t *indices, size_t count,
                                  Sphere *atoms) {
  return check_and_copy(
      count, [&](size_t i) { return position_at(positions, stride, indices[i]); }, atoms);
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

}  // namespace quickses
