// SPDX-License-Identifier: MIT
// Periodic boxes: three vectors that space repeats along.
#include "io/box.h"

#include <algorithm>
#include <cmath>

namespace quickses::io {
namespace {

using Vector = Lattice::Vector;

constexpr double kMaxEdge = 1e7;       // Å
constexpr double kMinFlatness = 1e-6;  // volume over the product of the edges
constexpr double kDegree = 0.017453292519943295;

double dot(const Vector &u, const Vector &v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }

Vector cross(const Vector &u, const Vector &v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

double length(const Vector &v) { return std::sqrt(dot(v, v)); }

// Exact where it matters: a right angle gives a right box.
double cosine(double degrees) { return degrees == 90 ? 0 : std::cos(degrees * kDegree); }

}  // namespace

std::optional<Box> box_from_vectors(const std::array<std::array<double, 3>, 3> &vectors) {
  double product = 1;
  for (const Vector &v : vectors) {
    const double edge = length(v);
    if (!(edge > 1e-3 && edge < kMaxEdge)) return std::nullopt;  // also NaN
    product *= edge;
  }
  const double volume = std::abs(dot(vectors[0], cross(vectors[1], vectors[2])));
  if (!(volume > kMinFlatness * product)) return std::nullopt;
  return Box{vectors};
}

std::optional<Box> box_from_edges(double a, double b, double c, double alpha, double beta, double gamma) {
  for (double angle : {alpha, beta, gamma})
    if (!(angle > 0 && angle < 180)) return std::nullopt;
  const double cos_alpha = cosine(alpha), cos_beta = cosine(beta), cos_gamma = cosine(gamma);
  const double sin_gamma = std::sqrt(1 - cos_gamma * cos_gamma);
  const double y = (cos_alpha - cos_beta * cos_gamma) / sin_gamma;
  const double z = std::sqrt(1 - cos_beta * cos_beta - y * y);  // no number: the angles span nothing
  return box_from_vectors({{{a, 0, 0}, {b * cos_gamma, b * sin_gamma, 0}, {c * cos_beta, c * y, c * z}}});
}

Lattice::Lattice(const Box &box) : vectors_(box.vectors) {
  const double volume = dot(vectors_[0], cross(vectors_[1], vectors_[2]));
  for (int i = 0; i < 3; ++i) {
    reciprocal_[i] = cross(vectors_[(i + 1) % 3], vectors_[(i + 2) % 3]);
    for (double &x : reciprocal_[i]) x /= volume;
    widths_[i] = 1 / length(reciprocal_[i]);
  }
}

Vector Lattice::fractional(const Vector &x) const {
  return {dot(x, reciprocal_[0]), dot(x, reciprocal_[1]), dot(x, reciprocal_[2])};
}

double Lattice::min_width() const { return *std::min_element(widths_.begin(), widths_.end()); }

Vector Lattice::minimum_image(const Vector &d) const {
  const Vector f = fractional(d);
  Vector best = d;
  for (int i = 0; i < 3; ++i) {
    const double n = std::nearbyint(f[i]);
    if (n == 0) continue;
    for (int axis = 0; axis < 3; ++axis) best[axis] -= n * vectors_[i][axis];
  }
  const double half = min_width() / 2;
  double best_squared = dot(best, best);
  if (best_squared <= half * half) return best;

  // Rounding finds the image next to the origin along the vectors; in a skewed box another one may be nearer.
  const Vector start = best;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k) {
        Vector other = start;
        for (int axis = 0; axis < 3; ++axis)
          other[axis] += i * vectors_[0][axis] + j * vectors_[1][axis] + k * vectors_[2][axis];
        const double squared = dot(other, other);
        if (squared < best_squared * (1 - 1e-12)) {
          best = other;
          best_squared = squared;
        }
      }
  return best;
}

}  // namespace quickses::io
