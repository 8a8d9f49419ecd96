// SPDX-License-Identifier: MIT
// Periodic boxes: three vectors that space repeats along.
#pragma once

#include <array>
#include <optional>

namespace quickses::io {

// The vectors a, b and c in Å, as rows: vectors[1] is b. Any orientation, any handedness.
struct Box {
  std::array<std::array<double, 3>, 3> vectors = {};
};

// Edges in Å, angles in degrees: a along x, b in the plane of x and y. Nothing if they span no volume.
std::optional<Box> box_from_edges(double a, double b, double c, double alpha, double beta, double gamma);

// Nothing if the vectors aren't finite or span (next to) no volume; files say so where there is no box.
std::optional<Box> box_from_vectors(const std::array<std::array<double, 3>, 3> &vectors);

// Minimum images in a box that box_from_edges or box_from_vectors gave.
class Lattice {
 public:
  using Vector = std::array<double, 3>;

  explicit Lattice(const Box &box);

  // Coordinates along a, b and c, in units of their lengths.
  Vector fractional(const Vector &x) const;

  // The shortest of d plus multiples of the vectors. Vectors shorter than min_width() / 2 are always found; of longer
  // ones in a very skewed box, a vector next to the shortest may be given.
  Vector minimum_image(const Vector &d) const;

  // Distance between the planes that bound the box along a, b, c, Å.
  const Vector &widths() const { return widths_; }
  double min_width() const;

 private:
  std::array<Vector, 3> vectors_;
  std::array<Vector, 3> reciprocal_;
  Vector widths_;
};

}  // namespace quickses::io
