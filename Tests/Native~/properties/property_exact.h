// SPDX-License-Identifier: MIT
// Where the exact surface may be, for the property tests: by brute force in double precision, with the play that the
// documented tolerance and the rounding of float32 leave.
#pragma once

#include "properties/property_generators.h"

#include <memory>

namespace properties {

using exact_reference::Boundary;
using exact_reference::kInfinity;
using exact_reference::point;

// Å. Coordinates of the mesh are float32, computed in a frame around the middle of the atoms.
inline double rounding_of_positions(const Case &c) {
  const double R = largest_radius(c.atoms) + static_cast<double>(c.settings.probe_radius);
  return std::ldexp(largest_coordinate(c.atoms) + half_extent(c.atoms) + R, -23);
}

// Å, of the SES. Where spheres nearly touch, rounding moves the circle in which they meet by so much. Of balls below 20
// Å within 1000 Å it is little, and no excuse.
inline double rounding_of_circles(const Case &c) {
  const double R = largest_radius(c.atoms) + inflation(c.settings);
  if (R <= 20 && std::max(largest_coordinate(c.atoms), half_extent(c.atoms)) <= 1000) return 0;
  return std::sqrt(2 * R * rounding_of_positions(c));
}

// By how much the radii of balls may seem changed: where the surface touches itself within 0.00002 Å, rounding decides.
inline double play_of_radii(const Case &c) {
  const double R = largest_radius(c.atoms) + inflation(c.settings);
  return 3e-5 + std::ldexp(half_extent(c.atoms) + R, -22);
}

// The distance to the complement of the union of inflated balls lies between the two: that of balls a little smaller
// and that of balls a little larger. They are far apart only where the surface is next to a discontinuity.
struct Range {
  double least, most;
  Point probe;  // where a probe's centre may be, `most` away
};

class ExactSurface {
 public:
  explicit ExactSurface(const Case &c) : case_(c), probe_(inflation(c.settings)), play_(play_of_radii(c)) {
    for (size_t i = 0; i < c.atoms.size(); ++i) {
      centers_.push_back(point(c.atoms.center(i)));
      radii_.push_back(static_cast<double>(c.atoms.radii[i]) + probe_);
    }
  }

  double probe() const { return probe_; }
  bool is_ses() const { return case_.settings.surface == QSES_SURFACE_SES && probe_ > 0; }

  // R - |x - c|, the largest over all balls.
  double depth(const Point &x) const {
    double deepest = -kInfinity;
    for (size_t i = 0; i < centers_.size(); ++i) deepest = std::max(deepest, radii_[i] - length(x - centers_[i]));
    return deepest;
  }

  // Right as far as it is below reach; larger distances may come out too large. Where too many atoms are in reach, what
  // is known without looking.
  Range distance(const Point &x, double reach) const {
    if (centers_.size() > kWhole) {
      Atoms near;
      for (size_t i = 0; i < centers_.size(); ++i)
        if (length(x - centers_[i]) < radii_[i] + reach + play_) {
          near.positions.insert(near.positions.end(), &case_.atoms.positions[3 * i], &case_.atoms.positions[3 * i] + 3);
          near.radii.push_back(case_.atoms.radii[i]);
        }
      if (near.size() > 100) return {0, kInfinity, x};
      return range(Boundary(near, probe_ - play_), Boundary(near, probe_ + play_), x);
    }
    if (!smaller_) {
      smaller_ = std::make_unique<Boundary>(case_.atoms, probe_ - play_);
      larger_ = std::make_unique<Boundary>(case_.atoms, probe_ + play_);
    }
    return range(*smaller_, *larger_, x);
  }

  bool is_costly() const { return centers_.size() > kWhole; }

 private:
  static Range range(const Boundary &smaller, const Boundary &larger, const Point &x) {
    const exact_reference::Nearest far = larger.nearest(x);
    return {smaller.nearest(x).distance, far.distance, far.position};
  }

  static constexpr size_t kWhole = 64;  // with more atoms, those near a point are taken

  const Case &case_;
  double probe_, play_;
  std::vector<Point> centers_;
  std::vector<double> radii_;
  mutable std::unique_ptr<Boundary> smaller_, larger_;
};

}  // namespace properties
