// SPDX-License-Identifier: MIT
// Inputs that once gave an open mesh, a crash or a surface in the wrong place. property_test prints rows like these.
#pragma once

#include "property_generators.h"

namespace properties {

constexpr qses_surface kSes = QSES_SURFACE_SES, kSas = QSES_SURFACE_SAS, kVdw = QSES_SURFACE_VDW;
constexpr qses_method kExact = QSES_METHOD_EXACT, kGrid = QSES_METHOD_GRID;

struct Regression {
  std::string name;
  qses_surface surface;
  qses_method method;
  double probe, spacing;
  uint32_t relaxation_steps;
  unsigned comparisons;
  std::vector<std::array<double, 4>> atoms;  // x, y, z, r
};

inline void PrintTo(const Regression &r, std::ostream *out) { *out << r.name; }

inline std::vector<Regression> regressions() {
  return {
      {"HydrogenAndOxygenTouch", kSes, kExact, 1.4, 0.5, 1, 0, {{-8.516, 7.755, -44.339, 1.2}, {-8.516, 13.275, -44.339, 1.52}}},
      {"SmallBesideLarge", kSes, kExact, 2, 1, 1, 0, {{0, 0, 0, 1.7}, {5.92805243, 0, 0, 0.228052557}}},
      {"AMillionApart", kSas, kExact, 0.466673106, 0.197114795, 1, 0, {{2, -1, 4.1, 1.55}, {-645618, -412593, -631546, 1}}},
      {"ThreeNearlyOnALine", kSes, kExact, 0.05, 0.5, 1, 0,
       {{-2.64380527, 0.933022857, -0.263838857, 2.78429317}, {-0.338749826, 0.119547874, -0.0338055752, 0.433275193}, {3.12921739, -1.10432911, 0.312280595, 3.29849696}}},
  };
}

inline Case case_of(const Regression &r) {
  Case c;
  c.family = r.name;
  c.settings = surface_fixture::settings(r.spacing, r.probe, r.surface);
  c.settings.method = r.method;
  c.settings.relaxation_steps = r.relaxation_steps;
  c.settings.components = 1;
  c.comparisons = r.comparisons;
  for (const auto &a : r.atoms) c.atoms.add(a[0], a[1], a[2], a[3]);
  return c;
}

}  // namespace properties
