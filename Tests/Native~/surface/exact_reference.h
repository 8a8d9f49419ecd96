// SPDX-License-Identifier: MIT
// The boundary of the solvent-accessible surface by brute force in double precision, twice: exactly, from every exposed
// sphere, circle and triple point; and by dense samples of every sphere. For tests; shares nothing with the library.
#pragma once

#include "surface/surface_fixture.h"

#include <algorithm>
#include <limits>

namespace exact_reference {

struct Point {
  double x, y, z;
};
inline Point operator+(const Point &a, const Point &b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point operator-(const Point &a, const Point &b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point operator*(double s, const Point &a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(const Point &a, const Point &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double length(const Point &a) { return std::sqrt(dot(a, a)); }
inline Point cross(const Point &a, const Point &b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Point point(const std::array<double, 3> &p) { return {p[0], p[1], p[2]}; }
inline Point perpendicular(const Point &a) {
  const Point p = std::abs(a.x) < 0.6 * length(a) ? cross(a, {1, 0, 0}) : cross(a, {0, 1, 0});
  return (1 / length(p)) * p;
}

// Evenly spread unit vectors.
inline std::vector<Point> fibonacci_directions(size_t count) {
  std::vector<Point> directions;
  const double turn = 4 * std::atan(1.0) * (3 - std::sqrt(5.0));
  for (size_t k = 0; k < count; ++k) {
    const double z = 1 - (2 * static_cast<double>(k) + 1) / static_cast<double>(count), s = std::sqrt(1 - z * z);
    directions.push_back({s * std::cos(turn * static_cast<double>(k)), s * std::sin(turn * static_cast<double>(k)), z});
  }
  return directions;
}

struct Ball {
  Point center;
  double radius;
};

struct Circle {
  size_t i, j;
  Point center, axis;
  double radius;
};

struct TriplePoint {
  Point position;
  size_t i, j, k;
};

enum class Kind { kNone, kSphere, kCircle, kTriple };

struct Nearest {
  double distance;  // to the complement of the union of the balls; 0 outside of it
  Point position;
  Kind kind;
};

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The union of the balls (c, r + p) and its boundary.
class Boundary {
 public:
  // tolerance: a point of the boundary may be this deep in other balls.
  Boundary(const surface_fixture::Atoms &atoms, double probe, double tolerance = 1e-9) : tolerance_(tolerance) {
    for (size_t i = 0; i < atoms.size(); ++i) {
      const Ball ball{point(atoms.center(i)), static_cast<double>(atoms.radii[i]) + probe};
      bool contained = false;  // in an earlier one at the same place
      for (const Ball &b : balls_)
        contained = contained || (length(b.center - ball.center) == 0 && b.radius >= ball.radius);
      if (!contained) balls_.push_back(ball);
    }
    near_.resize(balls_.size());
    for (size_t i = 0; i < balls_.size(); ++i)
      for (size_t j = 0; j < balls_.size(); ++j)
        if (i != j && length(balls_[i].center - balls_[j].center) < balls_[i].radius + balls_[j].radius)
          near_[i].push_back(j);
    // Those first that hold most of the sphere.
    for (size_t i = 0; i < balls_.size(); ++i) {
      const auto room = [&](size_t j) { return length(balls_[i].center - balls_[j].center) - balls_[j].radius; };
      std::sort(near_[i].begin(), near_[i].end(), [&](size_t a, size_t b) { return room(a) < room(b); });
    }
    for (size_t i = 0; i < balls_.size(); ++i)
      for (size_t j : near_[i])
        if (i < j) add_circle(i, j);
    for (size_t i = 0; i < balls_.size(); ++i)
      for (size_t j : near_[i])
        for (size_t k : near_[i])
          if (i < j && j < k) add_triple_points(i, j, k);
  }

  const std::vector<Ball> &balls() const { return balls_; }
  const std::vector<Circle> &circles() const { return circles_; }
  const std::vector<TriplePoint> &triple_points() const { return triples_; }

  // R - |x - c|, the largest over all balls.
  double depth(const Point &x) const {
    double deepest = -kInfinity;
    for (const Ball &b : balls_) deepest = std::max(deepest, b.radius - length(x - b.center));
    return deepest;
  }

  // Is a point of sphere i on the boundary? It may be one of the spheres j and k as well, whatever rounding says.
  bool exposed(size_t i, const Point &y, size_t j, size_t k) const {
    for (size_t other : near_[i]) {
      if (other == j || other == k) continue;
      const Point d = y - balls_[other].center;
      const double free = balls_[other].radius - tolerance_;
      if (free > 0 && dot(d, d) < free * free) return false;
    }
    return true;
  }
  bool exposed(size_t i, const Point &y) const { return exposed(i, y, i, i); }

  Nearest nearest(const Point &x) const {
    Nearest best{kInfinity, x, Kind::kNone};
    if (depth(x) <= 0) return {0, x, Kind::kNone};
    for (size_t i = 0; i < balls_.size(); ++i) {
      const Point d = x - balls_[i].center;
      const double l = length(d), distance = std::abs(balls_[i].radius - l);
      if (distance >= best.distance) continue;
      // At the very centre all of the sphere is as near.
      for (const Point &way : l > 0 ? std::vector<Point>{(1 / l) * d} : fibonacci_directions(200)) {
        const Point y = balls_[i].center + balls_[i].radius * way;
        if (exposed(i, y)) best = {distance, y, Kind::kSphere};
      }
    }
    for (const TriplePoint &t : triples_) {
      const double distance = length(x - t.position);
      if (distance < best.distance) best = {distance, t.position, Kind::kTriple};
    }
    for (const Circle &c : circles_) {
      const Point d = x - c.center;
      if (length(d) - c.radius >= best.distance) continue;
      const double along = dot(d, c.axis);
      Point in_plane = d - along * c.axis;
      const double q = length(in_plane), distance = std::hypot(q - c.radius, along);
      if (distance >= best.distance) continue;
      in_plane = q > 1e-12 ? (1 / q) * in_plane : perpendicular(c.axis);
      const Point y = c.center + c.radius * in_plane;
      if (exposed(c.i, y, c.j, c.j)) best = {distance, y, Kind::kCircle};
    }
    return best;
  }

 private:
  void add_circle(size_t i, size_t j) {
    const Point between = balls_[j].center - balls_[i].center;
    const double d = length(between), a = balls_[i].radius, b = balls_[j].radius;
    if (d < 1e-9) return;
    const double along = (d * d + a * a - b * b) / (2 * d), radius2 = a * a - along * along;
    if (radius2 <= 1e-12) return;
    const Point axis = (1 / d) * between;
    circles_.push_back({i, j, balls_[i].center + along * axis, axis, std::sqrt(radius2)});
  }

  // In the plane of the three centres, with one axis from i to j: well-conditioned also where they are nearly
  // collinear.
  void add_triple_points(size_t i, size_t j, size_t k) {
    const Point u = balls_[j].center - balls_[i].center, v = balls_[k].center - balls_[i].center;
    const double d = length(u), a = balls_[i].radius;
    if (d < 1e-9) return;
    const Point e1 = (1 / d) * u;
    const double v1 = dot(v, e1);
    const Point across = v - v1 * e1;
    const double v2 = length(across);
    if (v2 <= 1e-9 * length(v)) return;
    const Point e2 = (1 / v2) * across, e3 = cross(e1, e2);
    const double x = (d * d + a * a - balls_[j].radius * balls_[j].radius) / (2 * d);
    const double q = 0.5 * (v1 * v1 + v2 * v2 + a * a - balls_[k].radius * balls_[k].radius), y = (q - x * v1) / v2;
    double height2 = a * a - x * x - y * y;
    if (height2 < -1e-12 * a * a) return;
    height2 = std::max(0.0, height2);
    for (double sign : {-1.0, 1.0}) {
      const Point at = balls_[i].center + x * e1 + y * e2 + (sign * std::sqrt(height2)) * e3;
      if (exposed(i, at, j, k)) triples_.push_back({at, i, j, k});
    }
  }

  double tolerance_;
  std::vector<Ball> balls_;
  std::vector<std::vector<size_t>> near_;
  std::vector<Circle> circles_;
  std::vector<TriplePoint> triples_;
};

// Points of the boundary: samples of every ball's sphere that no other ball holds. Distances to them are never less
// than those to the boundary, and hardly more.
inline std::vector<Point> sample_boundary(const std::vector<Ball> &balls, size_t per_sphere) {
  std::vector<Point> samples;
  const std::vector<Point> directions = fibonacci_directions(per_sphere);
  for (const Ball &b : balls)
    for (const Point &d : directions) {
      const Point y = b.center + b.radius * d;
      bool free = true;
      for (const Ball &other : balls) free = free && (&other == &b || length(y - other.center) >= other.radius - 1e-9);
      if (free) samples.push_back(y);
    }
  return samples;
}

inline double nearest_sample(const std::vector<Point> &samples, const Point &x) {
  double best = kInfinity;
  for (const Point &s : samples) {
    const Point d = s - x;
    best = std::min(best, dot(d, d));
  }
  return std::sqrt(best);
}

}  // namespace exact_reference
