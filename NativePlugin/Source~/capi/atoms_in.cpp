// SPDX-License-Identifier: MIT
// Checks the caller's atoms and copies them into the back end's memory.
#include "capi/atoms_in.h"

#include "capi/barrier.h"

#include <algorithm>
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
};

// Of those that lie behind each other, several at a time: compilers make vectors of a loop of this length. Returns how
// many.
size_t copy_groups(const float *positions, const float *radii, size_t count, Sphere *atoms, Met *met) {
  constexpr size_t kGroup = 16, kFloats = 3 * kGroup;
  float low[kFloats], high[kFloats];
  uint32_t bad[kFloats] = {};
  std::fill_n(low, kFloats, Met::kInfinity);
  std::fill_n(high, kFloats, -Met::kInfinity);
  size_t i = 0;
  for (; i + kGroup <= count; i += kGroup) {
    const float *const v = positions + 3 * i;
    for (size_t k = 0; k < kFloats; ++k) {
      low[k] = v[k] < low[k] ? v[k] : low[k];
      high[k] = v[k] > high[k] ? v[k] : high[k];
      bad[k] |= std::fabs(v[k]) <= kLargestCoordinate ? 0u : 1u;
    }
    for (size_t k = 0; k < kGroup; ++k) atoms[i + k] = {{v[3 * k], v[3 * k + 1], v[3 * k + 2]}, radii[i + k]};
  }
  for (size_t k = 0; k < kFloats && i > 0; k += 3) {
    met->meet({low[k], low[k + 1], low[k + 2]});
    met->meet({high[k], high[k + 1], high[k + 2]});
    met->all_good &= (bad[k] | bad[k + 1] | bad[k + 2]) == 0;
  }
  return i;
}

// Of the positions at(0) ... at(count - 1), each a pointer to three floats, of which so many are copied already.
template <class At>
AtomBounds copy_rest(size_t copied, size_t count, const At &at, const float *radii, Sphere *atoms, Met met) {
  for (size_t i = copied; i < count; ++i) {
    atoms[i] = {load(at(i)), radii[i]};
    met.meet(atoms[i].center);
  }
  for (size_t i = 0; !met.all_good && i < count; ++i)
    if (!is_in_range(atoms[i].center)) bad_position(i, atoms[i].center);
  if (count == 0) met.low = met.high = glm::vec3(0.f);
  return {met.low, met.high, 0.f};
}

const char *position_at(const float *positions, size_t stride, size_t i) {
  return reinterpret_cast<const char *>(positions) + i * (stride ? stride : 12);
}

}  // namespace

AtomBounds copy_atoms(const float *positions, size_t stride, const float *radii, size_t count, Sphere *atoms) {
  Met met;
  const size_t copied = stride == 0 || stride == 12 ? copy_groups(positions, radii, count, atoms, &met) : 0;
  return copy_rest(
      copied, count, [&](size_t i) { return position_at(positions, stride, i); }, radii, atoms, met);
}

void check_indices(const uint32_t *indices, size_t count, size_t position_count) {
  if (count > 0) require(indices, "indices");
  for (size_t i = 0; i < count; ++i)
    if (indices[i] >= position_count)
      invalid("indices[" + std::to_string(i) + "] is " + std::to_string(indices[i]) + " but there are " +
              std::to_string(position_count) + " positions");
}

AtomBounds copy_indexed_atoms(const float *positions, size_t stride, const uint32_t *indices, const float *radii,
                              size_t count, Sphere *atoms) {
  return copy_rest(0, count, [&](size_t i) { return position_at(positions, stride, indices[i]); }, radii, atoms, {});
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
