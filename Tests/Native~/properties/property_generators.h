// SPDX-License-Identifier: MIT
// From a seed to a case of the property tests: atoms, settings, and what else is compared. Sizes are chosen so that a
// case costs milliseconds.
#pragma once

#include "properties/property_families.h"
#include "properties/property_forms.h"

namespace properties {

using surface_fixture::Atoms;

// What is compared besides the mesh itself.
enum Comparison : unsigned {
  kThreads = 1,     // with another number of threads
  kSlices = 2,      // with slice_size
  kBudget = 4,      // with a memory budget
  kStageTimes = 8,  // with the times of stages
  kLevels = 16,     // with the last level of a job
  kPermuted = 32,   // the atoms in another order: the same surface, not the same bytes
  kFrames = 64,     // after another frame, in a new context
  kPastComparisons = 128
};

struct Case {
  uint64_t seed = 0;
  std::string family;
  Atoms atoms;
  qses_settings settings;
  unsigned comparisons = 0;
  unsigned form = 0;  // in which it is asked for once more
};

// The probe by which atoms are inflated: none for the VDW surface, nor for an SES whose probe counts as none.
inline double inflation(const qses_settings &s) {
  const bool vdw = s.surface == QSES_SURFACE_VDW || (s.surface == QSES_SURFACE_SES && s.probe_radius < 0.05f);
  return vdw || s.surface == QSES_SURFACE_GAUSSIAN ? 0.0 : static_cast<double>(s.probe_radius);
}

inline double largest_coordinate(const Atoms &atoms) {
  double largest = 0;
  for (float p : atoms.positions) largest = std::max(largest, std::abs(static_cast<double>(p)));
  return largest;
}

// Half the longest side of the box of the centres.
inline double half_extent(const Atoms &atoms) {
  double half = 0;
  for (size_t d = 0; d < 3 && atoms.size() > 0; ++d) {
    double low = exact_reference::kInfinity, high = -low;
    for (size_t i = 0; i < atoms.size(); ++i) {
      low = std::min(low, atoms.center(i)[d]);
      high = std::max(high, atoms.center(i)[d]);
    }
    half = std::max(half, 0.5 * (high - low));
  }
  return half;
}

inline double largest_radius(const Atoms &atoms) {
  double largest = 0;
  for (float r : atoms.radii) largest = std::max(largest, static_cast<double>(r));
  return largest;
}

// Area of the inflated atoms' union, by a few directions per atom.
inline double rough_area(const Atoms &atoms, double probe) {
  static const std::vector<Point> directions = exact_reference::fibonacci_directions(24);
  double area = 0;
  for (size_t i = 0; i < atoms.size(); ++i) {
    const Point c = exact_reference::point(atoms.center(i));
    const double R = static_cast<double>(atoms.radii[i]) + probe;
    int exposed = 0;
    for (const Point &d : directions) {
      bool free = true;
      for (size_t j = 0; j < atoms.size() && free; ++j)
        free = j == i || length(c + R * d - exact_reference::point(atoms.center(j))) >=
                             static_cast<double>(atoms.radii[j]) + probe;
      exposed += free ? 1 : 0;
    }
    area += 4 * pi() * R * R * (exposed + 1) / 25;
  }
  return area;
}

inline double choose_probe(Random &random) {
  constexpr double kRound[] = {1, 2, 0.7, 1.5, 0.5, 3};
  const double which = random.unit();
  if (which < 0.45) return 1.4;
  if (which < 0.55) return random.any_of(kRound);
  if (which < 0.75) return random.uniform(0.5, 3);
  if (which < 0.83) return random.log_uniform(0.05, 0.5);
  if (which < 0.86) return random.uniform(0, 0.06);
  if (which < 0.88) return 0;
  return which < 0.96 ? random.uniform(3, 20) : random.log_uniform(20, 100);
}

inline double choose_spacing(Random &random, double area) {
  const double most_cells = random.chance(0.9) ? 4000 : random.chance(0.8) ? 20000 : 60000;
  constexpr double kRound[] = {0.5, 0.25, 1, 2, 0.7, 0.35, 0.2};
  const double finest = std::max(0.05, std::sqrt(area / most_cells));
  const double wanted = random.chance(0.35) ? random.any_of(kRound) : random.log_uniform(0.05, 10);
  if (wanted >= finest) return wanted;
  return std::min(100.0, finest * (random.chance(0.7) ? random.uniform(1, 2) : random.uniform(1, 8)));
}

inline qses_settings choose_settings(Random &random) {
  qses_settings s;
  qses_settings_init(&s);
  const double which = random.unit();
  s.surface = which < 0.6 ? QSES_SURFACE_SES : which < 0.8 ? QSES_SURFACE_SAS : QSES_SURFACE_VDW;
  s.probe_radius = static_cast<float>(choose_probe(random));
  if (s.surface == QSES_SURFACE_SES && s.probe_radius >= 0.05f && random.chance(0.08)) s.method = QSES_METHOD_GRID;
  s.relaxation_steps = random.chance(0.6) ? 1 : static_cast<uint32_t>(random.below(4));
  s.patch_types = s.method == QSES_METHOD_EXACT && random.chance(0.3) ? 1 : 0;
  s.components = 1;
  return s;
}

// Rounds a draft to float, somewhere in space, in some order, and makes its ties hold there.
inline Atoms place(Random &random, const Draft &draft, double probe) {
  const size_t n = draft.balls.size();
  Rotation rotation{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Point shift{0, 0, 0};
  const double where = random.unit();
  if (draft.move && where > 0.35) {
    if (where < 0.8) rotation = random_rotation(random);
    shift = random.in_box(where < 0.85 ? 50 : where < 0.96 ? 1000 : random.log_uniform(1e3, 9e5));
  }
  const bool decimals = draft.three_decimals || random.chance(0.1);
  const auto within = [](double x) { return std::min(1e6, std::max(-1e6, x)); };  // the largest that are taken
  Atoms placed;
  for (const Ball &b : draft.balls) {
    Point p = rotation(b.center) + shift;
    if (decimals) p = {std::round(p.x * 1000) / 1000, std::round(p.y * 1000) / 1000, std::round(p.z * 1000) / 1000};
    placed.add(within(p.x), within(p.y), within(p.z), std::min(100.0, std::max(1e-4, b.radius)));
  }
  if (random.chance(0.1))
    for (float &p : placed.positions) p = static_cast<float>(within(static_cast<double>(stepped(p, random.ulps()))));
  for (const Tie &tie : draft.ties) {
    const Point c = exact_reference::point(placed.center(tie.ball));
    double radius = 0;
    if (tie.kind == Tie::kThroughPoint) {
      radius = length(c - (rotation(tie.place) + shift)) - probe;
    } else {
      const double d = length(c - exact_reference::point(placed.center(tie.other)));
      const double other = static_cast<double>(placed.radii[tie.other]);
      radius = tie.kind == Tie::kTangentOutside ? d - other - 2 * probe : other - d;
    }
    if (draft.three_decimals) continue;
    const float r = stepped(static_cast<float>(radius), tie.ulps);
    if (r >= 1e-4f && r <= 100.f) placed.radii[tie.ball] = r;
  }
  std::vector<size_t> order(n);
  for (size_t i = 0; i < n; ++i) order[i] = i;
  if (random.chance(0.3))
    for (size_t i = n; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  Atoms atoms;
  for (size_t i : order) {
    for (size_t d = 0; d < 3; ++d) atoms.positions.push_back(placed.positions[3 * i + d]);
    atoms.radii.push_back(placed.radii[i]);
  }
  return atoms;
}

inline const Family &family_of(uint64_t seed) {
  int shares = 0;
  for (const Family &f : kFamilies) shares += f.share;
  int place = static_cast<int>((seed * 0x9e3779b97f4a7c15ull >> 20) % static_cast<uint64_t>(shares));
  for (const Family &f : kFamilies)
    if ((place -= f.share) < 0) return f;
  return kFamilies[0];
}

// Lattice points in balls that reach so many radii and a probe farther, each ball by itself.
inline double points_in_balls(const Atoms &atoms, double radii, double probe, double spacing) {
  double volume = 0;
  for (float r : atoms.radii) volume += std::pow(2 * (radii * static_cast<double>(r) + probe), 3);
  return volume / (spacing * spacing * spacing);
}

// So many are looked at in milliseconds.
constexpr double kMostPoints = 1e6;

constexpr double kReachOfGaussians = 4;  // standard deviations

inline void make_gaussian(Random &random, Case &c) {
  qses_settings &s = c.settings;
  s.surface = QSES_SURFACE_GAUSSIAN;
  s.method = QSES_METHOD_EXACT;
  s.patch_types = s.creases = 0;
  // Of smaller ones, owners may be atoms that are not the nearest: those are looked for where densities reach.
  constexpr double kLeastScale = 0.25;
  s.gaussian_radius_scale = random.chance(0.5) ? 1.f : static_cast<float>(random.log_uniform(kLeastScale, 10));
  s.gaussian_isovalue = random.chance(0.5) ? 0.5f : static_cast<float>(random.log_uniform(0.01, 5));
  const double scale = static_cast<double>(s.gaussian_radius_scale),
               wanted = choose_spacing(random, scale * scale * rough_area(c.atoms, 0)),
               finest = std::cbrt(points_in_balls(c.atoms, kReachOfGaussians * scale, 0, 1) / kMostPoints);
  s.spacing = static_cast<float>(std::min(100.0, std::max(wanted, finest)));
}

// Of numbers of its own, so that all else of a seed is what it was without.
inline void choose_more(uint64_t seed, Case &c) {
  Random random(seed * 0xbf58476d1ce4e5b9ull + 2);
  if (random.chance(0.06)) make_gaussian(random, c);
  if (random.chance(0.1)) c.comparisons |= kFrames;
  c.form = choose_form(random);
  // Ambient occlusion has a lattice of 1 Å, whatever the spacing is.
  const bool gaussian = c.settings.surface == QSES_SURFACE_GAUSSIAN;
  const double radii = gaussian ? kReachOfGaussians * static_cast<double>(c.settings.gaussian_radius_scale) : 1;
  if (points_in_balls(c.atoms, radii, inflation(c.settings), 1) > kMostPoints)
    c.form &= ~static_cast<unsigned>(kOcclusion);
}

inline Case make_case(uint64_t seed) {
  Random random(seed * 0x9e3779b97f4a7c15ull + 1);
  const Family &family = family_of(seed);
  Case c;
  c.seed = seed;
  c.family = family.name;
  c.settings = choose_settings(random);
  if (c.family == "tangent-file" && random.chance(0.7)) c.settings.probe_radius = 1.4f;
  // Of files, decimals; else the very float that the library has.
  const double probe = inflation(c.settings), decimal = std::round(probe * 1000) / 1000;
  c.atoms = place(random, family.draft(random, c.family == "tangent-file" ? decimal : probe), probe);
  double area = rough_area(c.atoms, inflation(c.settings));
  if (c.settings.method == QSES_METHOD_GRID) area *= 4;  // it fills the inside with bricks, too
  c.settings.spacing = static_cast<float>(choose_spacing(random, area));
  c.settings.creases = c.settings.method == QSES_METHOD_EXACT && Random(seed + 9).chance(0.5) ? 1 : 0;
  if (random.chance(0.12)) c.comparisons |= kThreads;
  if (random.chance(0.1)) c.comparisons |= kSlices;
  if (random.chance(0.05)) c.comparisons |= kBudget;
  if (random.chance(0.05)) c.comparisons |= kStageTimes;
  if (random.chance(0.06)) c.comparisons |= kLevels;
  if (random.chance(0.1)) c.comparisons |= kPermuted;
  choose_more(seed, c);
  return c;
}

}  // namespace properties
