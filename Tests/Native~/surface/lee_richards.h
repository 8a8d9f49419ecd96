// SPDX-License-Identifier: MIT
// Exposed areas of balls by slices (Lee & Richards 1971), in double precision, for tests; shares nothing with the
// library. What a slice of a sphere leaves free is exact; the sum over the slices is not, since areas begin and end
// within slices.
#pragma once

#include "surface/surface_fixture.h"

#include <algorithm>

namespace lee_richards {

using surface_fixture::Atoms;

// Å² per atom. Of balls at the same place only the first of the largest counts.
inline std::vector<double> exposed_areas(const Atoms &atoms, double probe, int slices = 4000) {
  const double kPi = std::acos(-1.0);
  std::vector<double> areas(atoms.size(), 0.0);
  std::vector<std::pair<double, double>> covered;
  for (size_t i = 0; i < atoms.size(); ++i) {
    const auto c = atoms.center(i);
    const double r = static_cast<double>(atoms.radii[i]) + probe;
    std::vector<std::array<double, 4>> near;  // from the centre, and the radius
    bool is_hidden = false;
    for (size_t j = 0; j < atoms.size(); ++j) {
      const auto o = atoms.center(j);
      const double q = static_cast<double>(atoms.radii[j]) + probe;
      const double d = std::hypot(o[0] - c[0], o[1] - c[1], o[2] - c[2]);
      is_hidden = is_hidden || (j != i && d <= q - r && (d > 0 || q > r || j < i));
      if (j != i && d > 0 && d < r + q) near.push_back({o[0] - c[0], o[1] - c[1], o[2] - c[2], q});
    }
    if (is_hidden) continue;
    for (int k = 0; k < slices; ++k) {
      const double z = r * ((2 * k + 1.0) / slices - 1), radius = std::sqrt(r * r - z * z);
      covered.clear();
      for (const auto &o : near) {
        const double q2 = o[3] * o[3] - (o[2] - z) * (o[2] - z), d = std::hypot(o[0], o[1]);
        if (q2 <= 0) continue;
        // Points of the circle in the direction of the disc: d^2 + radius^2 - 2 d radius cos(angle) < q2.
        const double need = d * d + radius * radius - q2;
        if (need >= 2 * d * radius) continue;
        const double half = need <= -2 * d * radius ? kPi : std::acos(need / (2 * d * radius));
        double begin = std::atan2(o[1], o[0]) - half;
        if (begin < 0) begin += 2 * kPi;
        covered.push_back({begin, std::min(2 * kPi, begin + 2 * half)});
        if (begin + 2 * half > 2 * kPi) covered.push_back({0.0, begin + 2 * half - 2 * kPi});
      }
      std::sort(covered.begin(), covered.end());
      double free = 2 * kPi, reach = 0;
      for (const auto &stretch : covered) {
        free -= std::max(0.0, stretch.second - std::max(reach, stretch.first));
        reach = std::max(reach, stretch.second);
      }
      areas[i] += free * r * 2 * r / slices;
    }
  }
  return areas;
}

}  // namespace lee_richards
