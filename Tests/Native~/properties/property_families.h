// SPDX-License-Identifier: MIT
// Kinds of arrangements of atoms for the property tests: what breaks methods for molecular surfaces, by name.
#pragma once

#include "properties/property_random.h"

#include <string>
#include <vector>

namespace properties {

using exact_reference::length;

struct Ball {
  Point center;
  double radius;  // van der Waals
};

// What shall hold after the centres have been rounded to float: the radius of `ball` follows from the others'.
struct Tie {
  enum Kind { kTangentOutside, kTangentInside, kThroughPoint } kind;
  size_t ball, other;
  Point place;  // of kThroughPoint: a point of the inflated sphere
  int ulps;     // and then off by so many steps of the radius
};

struct Draft {
  std::vector<Ball> balls;
  std::vector<Tie> ties;
  bool three_decimals = false;  // as in PDB files
  bool move = true;             // may be rotated and shifted
};

constexpr double kStandardRadii[] = {1.52, 1.7, 1.55, 1.2, 1.8, 1.4};

inline double pi() { return std::acos(-1.0); }

inline double atom_radius(Random &random) {
  if (random.chance(0.75)) return random.any_of(kStandardRadii);
  return random.chance(0.8) ? random.uniform(0.3, 3) : random.log_uniform(1e-4, 100);
}

inline Draft lone_atoms(Random &random, double) {
  Draft draft;
  if (random.chance(0.9)) draft.balls.push_back({random.in_box(3), atom_radius(random)});
  return draft;
}

// From apart to one within the other.
inline Draft pair(Random &random, double probe) {
  Draft draft;
  const double a = atom_radius(random), b = atom_radius(random);
  const double least = std::abs(a - b), most = a + b + 2 * probe;
  draft.balls = {{{0, 0, 0}, a}, {random.uniform(0.9 * least, 1.1 * most) * random.direction(), b}};
  return draft;
}

inline Draft gas(Random &random, double probe) {
  Draft draft;
  const size_t n = random.chance(0.05) ? random.count(60, 300) : random.count(2, 40);
  const double r = atom_radius(random),
               half = std::cbrt(static_cast<double>(n)) * (r + probe * random.unit()) * random.log_uniform(0.2, 3);
  for (size_t i = 0; i < n; ++i)
    draft.balls.push_back({random.in_box(half), random.chance(0.5) ? r : atom_radius(random)});
  return draft;
}

// As dense as a protein.
inline Draft cluster(Random &random, double) {
  Draft draft;
  const size_t n = random.chance(0.1) ? random.count(60, 300) : random.count(3, 50);
  const double extent = 1.35 * std::cbrt(static_cast<double>(n));
  for (size_t tries = 0; draft.balls.size() < n && tries < 100 * n; ++tries) {
    const Point p = random.in_box(extent);
    bool free = length(p) < extent;
    for (size_t i = 0; i < draft.balls.size() && free; ++i) free = length(draft.balls[i].center - p) > 1.25;
    if (free) draft.balls.push_back({p, random.any_of(kStandardRadii)});
  }
  return draft;
}

// An edge at which something happens: spheres touch, meet in the middle of a face or of a cell, or none of that.
inline double lattice_edge(Random &random, double inflated) {
  constexpr double kRound[] = {0.5, 1, 1.5, 2, 2.5, 3, 4};
  const double special[] = {2 * inflated, std::sqrt(2.0) * inflated, std::sqrt(4.0 / 3) * inflated,
                            std::sqrt(8.0) * inflated};
  if (random.chance(0.4)) return random.any_of(kRound);
  return random.chance(0.5) ? special[random.below(4)] : inflated * random.uniform(0.3, 2.2);
}

inline Draft cubic_lattice(Random &random, double probe) {
  Draft draft;
  const double r = random.any_of(kStandardRadii), edge = lattice_edge(random, r + probe);
  const size_t nx = random.count(1, 4), ny = random.count(1, 4), nz = random.count(1, 4);
  for (size_t z = 0; z < nz; ++z)
    for (size_t y = 0; y < ny; ++y)
      for (size_t x = 0; x < nx; ++x)
        draft.balls.push_back(
            {{edge * static_cast<double>(x), edge * static_cast<double>(y), edge * static_cast<double>(z)}, r});
  return draft;
}

inline Draft face_centered_lattice(Random &random, double probe) {
  Draft draft;
  const double r = random.any_of(kStandardRadii), half = 0.5 * lattice_edge(random, r + probe);
  const size_t nx = random.count(2, 5), ny = random.count(2, 5), nz = random.count(2, 4);
  for (size_t z = 0; z < nz; ++z)
    for (size_t y = 0; y < ny; ++y)
      for (size_t x = 0; x < nx; ++x)
        if ((x + y + z) % 2 == 0)
          draft.balls.push_back(
              {{half * static_cast<double>(x), half * static_cast<double>(y), half * static_cast<double>(z)}, r});
  return draft;
}

inline Draft ring(Random &random, double probe) {
  Draft draft;
  const size_t n = random.count(3, 20);
  const double r = random.any_of(kStandardRadii), R = r + probe, step = pi() / static_cast<double>(n);
  // Neighbours overlap, or touch, or all pass through the middle.
  const double choices[] = {random.uniform(0.2, 1) * R / std::sin(step), R / std::sin(step), R, 1.39};
  const double radius = choices[random.below(4)];
  for (size_t k = 0; k < n; ++k) {
    const double angle = 2 * step * static_cast<double>(k);
    draft.balls.push_back({{radius * std::cos(angle), radius * std::sin(angle), 0}, r});
  }
  if (random.chance(0.2)) draft.balls.push_back({{0, 0, random.uniform(-2, 2)}, r});
  return draft;
}

// Vertices of the truncated icosahedron.
inline Draft fullerene(Random &random, double) {
  Draft draft;
  const double g = 0.5 * (1 + std::sqrt(5.0)), scale = 0.71 * (random.chance(0.5) ? 1.0 : random.uniform(0.7, 1.6));
  const double r = random.chance(0.5) ? 1.7 : random.any_of(kStandardRadii);
  const double kinds[3][3] = {{0, 1, 3 * g}, {1, 2 + g, 2 * g}, {g, 2, 2 * g + 1}};
  for (const auto &k : kinds)
    for (int turn = 0; turn < 3; ++turn)
      for (int signs = 0; signs < 8; ++signs) {
        if (k[0] == 0 && (signs & 1)) continue;
        double p[3];
        for (int d = 0; d < 3; ++d) p[(d + turn) % 3] = (signs >> d & 1 ? -1 : 1) * k[d] * scale;
        draft.balls.push_back({{p[0], p[1], p[2]}, r});
      }
  return draft;
}

inline Draft icosahedron(Random &random, double probe) {
  Draft draft;
  const double g = 0.5 * (1 + std::sqrt(5.0)), r = random.any_of(kStandardRadii), R = r + probe;
  // Vertices have a length of sqrt(1 + g²) and a distance of 2 before scaling: inflated spheres through the middle,
  // just touching, through the middles of the faces, or none of it.
  const double choices[] = {R / std::sqrt(1 + g * g), R, R * std::sqrt(3.0) / 2, R * random.uniform(0.3, 1.2)};
  const double scale = choices[random.below(4)];
  for (int turn = 0; turn < 3; ++turn)
    for (int signs = 0; signs < 4; ++signs) {
      double p[3];
      p[turn] = 0;
      p[(turn + 1) % 3] = (signs & 1 ? -1 : 1) * scale;
      p[(turn + 2) % 3] = (signs & 2 ? -1 : 1) * g * scale;
      draft.balls.push_back({{p[0], p[1], p[2]}, r});
    }
  if (random.chance(0.3)) draft.balls.push_back({{0, 0, 0}, atom_radius(random)});
  return draft;
}

inline Draft collinear(Random &random, double probe) {
  Draft draft;
  const size_t n = random.count(3, 12);
  const double r = random.any_of(kStandardRadii), step = (r + probe) * random.uniform(0.1, 2.1);
  const bool equal = random.chance(0.5), even = random.chance(0.5);
  double at = 0;
  for (size_t k = 0; k < n; ++k) {
    draft.balls.push_back({{at, 0, 0}, equal ? r : atom_radius(random)});
    at += even ? step : step * random.uniform(0.1, 2);
  }
  return draft;
}

inline Draft coplanar(Random &random, double probe) {
  Draft draft;
  const double r = random.any_of(kStandardRadii), edge = lattice_edge(random, r + probe);
  const int kind = static_cast<int>(random.below(3));  // square, hexagonal, random
  const size_t nx = random.count(2, 6), ny = random.count(1, 6);
  for (size_t y = 0; y < ny; ++y)
    for (size_t x = 0; x < nx; ++x) {
      const double u = static_cast<double>(x), v = static_cast<double>(y), half = static_cast<double>(ny) * edge;
      Point p{edge * u, edge * v, 0};
      if (kind == 1) p = {edge * (u + 0.5 * static_cast<double>(y % 2)), edge * std::sqrt(0.75) * v, 0};
      if (kind == 2) p = {random.uniform(-half, half), random.uniform(-half, half), 0};
      draft.balls.push_back({p, kind == 2 ? atom_radius(random) : r});
    }
  return draft;
}

// One probe touches them all.
inline Draft cospherical(Random &random, double probe) {
  Draft draft;
  const size_t n = random.count(4, 16);
  const bool half_only = random.chance(0.5), equal = random.chance(0.5);
  const double r = random.any_of(kStandardRadii);
  for (size_t k = 0; k < n; ++k) {
    Point d = random.direction();
    if (half_only && d.z < 0) d.z = -d.z;
    const double radius = equal ? r : random.any_of(kStandardRadii);
    draft.balls.push_back({(radius + probe) * d, radius});
    draft.ties.push_back({Tie::kThroughPoint, k, k, {0, 0, 0}, random.chance(0.5) ? 0 : random.ulps()});
  }
  return draft;
}

inline Draft duplicates(Random &random, double probe) {
  Draft draft = random.chance(0.7) ? cluster(random, probe) : gas(random, probe);
  const size_t n = std::min<size_t>(draft.balls.size(), 30);
  draft.balls.resize(n);
  const double away = random.chance(0.4) ? 0 : random.log_uniform(1e-7, 0.5);
  for (size_t k = 0; k < n; ++k)
    for (uint64_t copies = random.below(3); copies > 0; --copies) {
      Ball b = draft.balls[k];
      b.center = b.center + away * random.direction();
      if (random.chance(0.3)) b.radius = atom_radius(random);
      draft.balls.push_back(b);
    }
  return draft;
}

inline Draft contained(Random &random, double) {
  Draft draft;
  const size_t large = random.count(1, 3);
  for (size_t k = 0; k < large; ++k) draft.balls.push_back({random.in_box(4), random.uniform(2, 6)});
  for (size_t n = random.count(1, 8); n > 0; --n) {
    const size_t host = static_cast<size_t>(random.below(large));
    const double r = random.uniform(0.3, 1.8), room = draft.balls[host].radius - r;
    const size_t at = draft.balls.size();
    const bool touching = random.chance(0.5);
    draft.balls.push_back(
        {draft.balls[host].center + ((touching ? 1.0 : random.unit()) * room) * random.direction(), r});
    if (touching) draft.ties.push_back({Tie::kTangentInside, at, host, {}, random.ulps()});
  }
  return draft;
}

// Inflated spheres that touch from outside; of the VDW surface, the atoms themselves.
inline Draft tangent(Random &random, double probe) {
  Draft draft;
  const size_t n = random.chance(0.5) ? 2 : random.count(3, 6);
  const bool along_axis = random.chance(0.4), standard = random.chance(0.5);
  const auto radius = [&] { return standard ? random.any_of(kStandardRadii) : random.log_uniform(0.05, 5); };
  draft.balls.push_back({{0, 0, 0}, radius()});
  for (size_t k = 1; k < n; ++k) {
    const size_t other = static_cast<size_t>(random.below(k));
    const double r = radius();
    Point d = random.direction();
    if (along_axis) {
      const double s = random.sign();
      d = k % 3 == 0 ? Point{s, 0, 0} : k % 3 == 1 ? Point{0, s, 0} : Point{0, 0, s};
    }
    draft.balls.push_back({draft.balls[other].center + (r + draft.balls[other].radius + 2 * probe) * d, r});
    draft.ties.push_back({Tie::kTangentOutside, k, other, {}, random.ulps()});
  }
  return draft;
}

// The same as files have it: three decimals, radii of the table.
inline Draft tangent_in_a_file(Random &random, double probe) {
  Draft draft;
  const double a = random.any_of(kStandardRadii), b = random.any_of(kStandardRadii), d = a + b + 2 * probe;
  const Point p = random.in_box(random.chance(0.5) ? 10 : 100);
  const double s = random.sign() * d;
  const Point steps[] = {{s, 0, 0}, {0, s, 0}, {0, 0, s}, {0.6 * s, 0.8 * s, 0}, {0, 0.6 * s, 0.8 * s}};
  const Point round{std::round(p.x * 1000) / 1000, std::round(p.y * 1000) / 1000, std::round(p.z * 1000) / 1000};
  draft.balls = {{round, a}, {round + steps[random.below(5)], b}};
  draft.three_decimals = true;
  draft.move = false;
  return draft;
}

// Coaxial balls through one circle: a pencil.
inline Draft through_a_circle(Random &random, double probe) {
  Draft draft;
  const size_t n = random.count(3, 7);
  const bool simple = random.chance(0.4);  // numbers that float holds exactly, so that the circle may be common, too
  const double circle =
      simple ? 0.5 * static_cast<double>(random.count(4, 12)) : (probe + 1) * random.uniform(0.3, 1.5);
  const bool exactly = random.chance(0.5);
  for (size_t k = 0; k < n; ++k) {
    const double along =
        simple ? 0.25 * (static_cast<double>(random.below(25)) - 12) : circle * random.uniform(-1.5, 1.5);
    draft.balls.push_back({{along, 0, 0}, std::max(1e-4, std::hypot(circle, along) - probe)});
    draft.ties.push_back({Tie::kThroughPoint, k, k, {0, circle, 0}, exactly ? 0 : random.ulps()});
  }
  for (size_t others = random.below(3); others > 0; --others)
    draft.balls.push_back({random.in_box(circle), random.any_of(kStandardRadii)});
  return draft;
}

// Two balls and others that touch the circle in which they meet, or pass through a point of it.
inline Draft touching_a_circle(Random &random, double probe) {
  Draft draft;
  const double a = random.any_of(kStandardRadii) + probe, b = random.any_of(kStandardRadii) + probe;
  const double d = random.uniform(std::abs(a - b) + 0.05 * a, 0.98 * (a + b));
  draft.balls = {{{0, 0, 0}, a - probe}, {{d, 0, 0}, b - probe}};
  const double along = (d * d + a * a - b * b) / (2 * d), radius = std::sqrt(std::max(0.0, a * a - along * along));
  for (size_t n = random.count(1, 4); n > 0; --n) {
    const double angle = 0.5 * pi() * random.uniform(0, 4), tilt = random.uniform(0, 2 * pi());
    const Point out{0, std::cos(angle), std::sin(angle)};
    const Point y = Point{along, 0, 0} + radius * out;
    Point way{std::cos(tilt), std::sin(tilt) * out.y, std::sin(tilt) * out.z};
    if (random.chance(0.3)) way = random.direction();
    const double r = random.any_of(kStandardRadii);
    draft.ties.push_back({Tie::kThroughPoint, draft.balls.size(), 0, y, random.ulps()});
    draft.balls.push_back({y + (r + probe) * way, r});
  }
  return draft;
}

inline Draft all_radii(Random &random, double probe) {
  Draft draft;
  const size_t n = random.count(2, 20);
  const double least = random.log_uniform(1e-4, 1), most = random.log_uniform(1, 100);
  double reach = 0;
  for (size_t k = 0; k < n; ++k) {
    const double r = random.log_uniform(least, most);
    if (draft.balls.empty() || random.chance(0.3)) {
      draft.balls.push_back({random.in_box(0.5 * reach), r});
    } else {  // across the sphere of another one
      const Ball &other = draft.balls[random.below(draft.balls.size())];
      const double away = other.radius + probe * random.sign() * random.unit() + r * random.uniform(-1, 1);
      draft.balls.push_back({other.center + std::abs(away) * random.direction(), r});
    }
    reach = std::max(reach, r);
  }
  return draft;
}

inline Draft far_apart(Random &random, double probe) {
  Draft draft = random.chance(0.5) ? pair(random, probe) : cluster(random, probe);
  draft.balls.resize(std::min<size_t>(draft.balls.size(), 12));
  for (size_t strays = random.count(1, 3); strays > 0; --strays)
    draft.balls.push_back({random.log_uniform(100, 900000) * random.direction(), atom_radius(random)});
  return draft;
}

inline Draft copies(Random &random, double probe) {
  Draft draft = random.chance(0.5) ? cluster(random, probe) : pair(random, probe);
  draft.balls.resize(std::min<size_t>(draft.balls.size(), 15));
  const std::vector<Ball> one = draft.balls;
  for (size_t n = random.count(1, 3); n > 0; --n) {
    Rotation rotation{{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}};  // half a turn, which float keeps exact
    if (random.chance(0.5)) rotation = random_rotation(random);
    Point shift = random.in_box(6);
    if (random.chance(0.5)) shift = {std::round(shift.x), std::round(shift.y), std::round(shift.z)};
    for (const Ball &b : one) draft.balls.push_back({rotation(b.center) + shift, b.radius});
  }
  return draft;
}

struct Family {
  const char *name;
  Draft (*draft)(Random &, double probe);
  int share;
};

constexpr Family kFamilies[] = {{"lone", lone_atoms, 2},
                                {"pair", pair, 6},
                                {"gas", gas, 6},
                                {"cluster", cluster, 6},
                                {"cubic", cubic_lattice, 6},
                                {"fcc", face_centered_lattice, 5},
                                {"ring", ring, 6},
                                {"c60", fullerene, 3},
                                {"icosahedron", icosahedron, 5},
                                {"collinear", collinear, 5},
                                {"coplanar", coplanar, 5},
                                {"cospherical", cospherical, 7},
                                {"duplicates", duplicates, 5},
                                {"contained", contained, 5},
                                {"tangent", tangent, 9},
                                {"tangent-file", tangent_in_a_file, 6},
                                {"circle", through_a_circle, 9},
                                {"at-circle", touching_a_circle, 7},
                                {"radii", all_radii, 6},
                                {"far", far_apart, 4},
                                {"copies", copies, 5}};

}  // namespace properties
