// SPDX-License-Identifier: MIT
// Area and volume of the surfaces of one and two atoms, in closed form, and how far a mesh may be from them.
#pragma once

#include "properties/property_exact.h"

namespace properties {

struct Measures {
  double area = 0, volume = 0;
  double chord_area = 0, chord_volume = 0;  // how much less a mesh may have
};

// A part of a surface whose smaller radius of curvature is given. Triangles' edges are about a spacing; a sagitta is
// edge² / 8 radius, and the area is less by (edge / radius)² / 12 of it or so; a radius that is small against the
// spacing may be lost altogether.
inline void add_part(Measures &m, double area, double volume, double radius, double spacing) {
  m.area += area;
  m.volume += volume;
  const double edge = 2 * spacing, turn = edge / std::max(radius, 1e-9);
  m.chord_area += std::abs(area) * std::min(1.0, turn * turn / 4 + 1e-5);
  m.chord_volume += std::abs(area) * std::min(edge * std::min(1.0, turn) / 4 + 1e-6, 2 * std::max(radius, spacing));
}

// A ridge, a crease or a tip around a circle: triangles cut across it.
inline void add_edge(Measures &m, double circle_radius, double spacing) {
  const double edge = 2 * spacing, around = 2 * pi() * circle_radius + edge;
  m.chord_area += around * edge;
  m.chord_volume += around * edge * edge / 2;
}

inline void add_ball(Measures &m, double r, double spacing) {
  add_part(m, 4 * pi() * r * r, 4 * pi() * r * r * r / 3, r, spacing);
}

// The side of a ball of radius r up to a plane, `along` beyond its centre.
inline void add_cap(Measures &m, double r, double along, double spacing) {
  const double height = r + along;
  add_part(m, 2 * pi() * r * height, pi() * height * height * (3 * r - height) / 3, r, spacing);
}

// Two balls, one beside the other: where the space between them is thinner than the lattice can tell, the mesh lacks
// what faces it, or has a bridge across.
inline void add_gap(Measures &m, double a, double b, double gap, double spacing) {
  gap = std::max(0.0, gap);
  const double thick = 2 * spacing - gap, neck = std::min({a, b, spacing});
  if (thick <= 0) return;
  const double ring = 2 * pi() * thick * a * b / (a + b);
  m.chord_area += 2 * ring + 2 * pi() * neck * gap;
  m.chord_volume += ring * thick + pi() * neck * neck * gap;
}

inline Measures measures_of_union(double a, double b, double d, double spacing) {
  Measures m;
  if (d >= a + b) {
    add_ball(m, a, spacing);
    add_ball(m, b, spacing);
    add_gap(m, a, b, d - a - b, spacing);
  } else if (d <= std::abs(a - b)) {
    add_ball(m, std::max(a, b), spacing);
  } else {
    const double along = (d * d + a * a - b * b) / (2 * d);
    add_cap(m, a, along, spacing);
    add_cap(m, b, d - along, spacing);
    add_edge(m, std::sqrt(std::max(0.0, a * a - along * along)), spacing);
    add_gap(m, a, b, 0, spacing);
  }
  return m;
}

// The part of a torus that faces its axis, between two angles from its equatorial plane: what a probe leaves that rolls
// around two atoms. `around` is the radius of its centre's circle.
inline void add_saddle(Measures &m, double around, double probe, double from, double to, double spacing) {
  if (to <= from) return;
  const auto area = [&](double t) { return 2 * pi() * probe * (around * t - probe * std::sin(t)); };
  const auto volume = [&](double t) {
    const double s = std::sin(t);
    return pi() * probe *
           (around * around * s - around * probe * (t + 0.5 * std::sin(2 * t)) + probe * probe * (s - s * s * s / 3));
  };
  // The waist may be narrower than the probe.
  const double waist = std::max(around - probe, spacing * 1e-3);
  add_part(m, area(to) - area(from), volume(to) - volume(from), std::min(probe, waist), spacing);
}

// SES of two atoms.
inline Measures measures_of_ses(double r1, double r2, double d, double probe, double spacing) {
  const double a = r1 + probe, b = r2 + probe;
  if (d >= a + b || d <= std::abs(a - b)) return measures_of_union(r1, r2, d, spacing);
  Measures m;
  const double along = (d * d + a * a - b * b) / (2 * d);
  const double around = std::sqrt(std::max(0.0, a * a - along * along));
  add_cap(m, r1, along * r1 / a, spacing);
  add_cap(m, r2, (d - along) * r2 / b, spacing);
  const double from = std::asin(std::max(-1.0, -along / a)), to = std::asin(std::min(1.0, (d - along) / b));
  if (around < probe) {  // a spindle: the probe passes the axis, and leaves two tips
    const double tip = std::acos(around / probe);
    add_saddle(m, around, probe, from, std::min(to, -tip), spacing);
    add_saddle(m, around, probe, std::max(from, tip), to, spacing);
    add_edge(m, spacing, spacing);
    add_edge(m, spacing, spacing);
  } else {
    add_saddle(m, around, probe, from, to, spacing);
    if (around - probe < 4 * spacing) add_edge(m, around - probe, spacing);
  }
  return m;
}

// Of one or two atoms.
inline Measures closed_form(const Case &c) {
  const double probe = inflation(c.settings), spacing = static_cast<double>(c.settings.spacing);
  const double skin = c.settings.surface == QSES_SURFACE_SAS ? probe : 0;
  const double a = static_cast<double>(c.atoms.radii[0]) + skin;
  Measures m;
  if (c.atoms.size() == 1) {
    add_ball(m, a, spacing);
  } else {
    const double b = static_cast<double>(c.atoms.radii[1]) + skin;
    const double d = length(point(c.atoms.center(0)) - point(c.atoms.center(1)));
    m = skin > 0 || probe == 0 ? measures_of_union(a, b, d, spacing) : measures_of_ses(a, b, d, probe, spacing);
  }
  return m;
}

}  // namespace properties
