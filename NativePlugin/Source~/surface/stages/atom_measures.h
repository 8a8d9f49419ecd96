// SPDX-License-Identifier: MIT
// Area that each atom has of a surface that is the boundary of balls (SAS, VDW), and the volume within: exact, from
// caps and exposed arcs, without a mesh.
//
// The part of a unit sphere that lies left of a closed border has the area of the integral of (1 - cos(theta)) dphi
// along the border, about any pole whose opposite point the part does not contain (Stokes). The axis of the atom's
// largest cap is such a point: it is covered, and no border comes near it, unless that cap is tiny. So it need not be
// known how arcs join to borders, nor how many there are, as the formula of Gauss and Bonnet asks for. Volume by the
// divergence theorem.
//
// Where it is, ends of its arcs that are off by little would count for much. Then the opposite point is one that is
// exposed, far from all caps, and the integral is less by the whole sphere.
#pragma once

#include "parallel/atomics.h"
#include "surface/geometry/close_cut.h"
#include "surface/stages/solvent_features.h"

namespace quickses {

struct AtomMeasures {
  double area = 0;    // Å²
  double volume = 0;  // Å³, of the union of the balls
};

// Sums of solid angles are integers, so that they do not depend on the order: multiples of 1 / this. An atom's sum lies
// between 0 and 4 pi whatever wraps around on the way.
constexpr double kSolidAngleUnits = 17592186044416.0;   // 2^44
constexpr double kWholeSphere = 12.566370614359172954;  // 4 pi

// Of a thread of the GPU for one arc: double precision, some thousand operations.
constexpr uint64_t kArcMeasureSteps = 4096;

// Is the largest cap tiny, and do all together cover less than half of the sphere, even if they were as large?
QSES_FN bool has_tiny_caps(const CapRange &range, const Cap &largest) {
  return largest.cosine > 0.99f && static_cast<float>(range.count) * (1.f - largest.cosine) < 1.f;
}

// Of the directions to the points of a lattice about the centre, that which is farthest from the caps; the axis of the
// first one, if they cover all.
constexpr int kDirections = 5 * 5 * 5;  // one of them is none
QSES_FN Vec3<float> farthest_from_caps(const Cap *caps, int32_t count) {
  Vec3<float> best(load(caps).axis);
  float farthest = 0.f;
  for (int k = 0; k < kDirections; ++k) {
    const Vec3<float> way(static_cast<float>(k % 5 - 2), static_cast<float>(k / 5 % 5 - 2),
                          static_cast<float>(k / 25 - 2));
    if (k == kDirections / 2) continue;
    const Vec3<float> direction = way * reciprocal_root(length_squared(way));
    const auto chord_to = [](float cosine) { return square_root(maximum(0.f, 2.f - 2.f * cosine)); };
    float least = 2.f;
    for (int32_t j = 0; j < count && least > farthest; ++j) {
      const Cap cap = load(caps + j);
      least = minimum(least, chord_to(dot(direction, Vec3<float>(cap.axis))) - chord_to(cap.cosine));
    }
    if (least > farthest) farthest = least, best = direction;
  }
  return best;
}

// Area of the triangle of great circles, positive if a, b, c come counter-clockwise seen from outside (van Oosterom &
// Strackee 1983). All three of unit length.
QSES_FN double spherical_triangle(const Vec3<double> &a, const Vec3<double> &b, const Vec3<double> &c) {
  return 2.0 * atan2(dot(a, cross(b, c)), 1.0 + dot(a, b) + dot(b, c) + dot(c, a));
}

// An arc on the unit sphere, from -half to half about its middle, counter-clockwise about the axis of its circle.
struct SphereArc {
  Vec3<double> axis, middle, side;
  double cosine, sine;  // of the circle's angular radius
  double half, cos_half, sin_half;

  QSES_FN Vec3<double> at(double cos_angle, double sin_angle) const {
    return axis * cosine + (middle * cos_angle + side * sin_angle) * sine;
  }
};

// Integral of (1 - cos(theta)) dphi along the arc. Piece by piece of at most a quarter of a turn: the triangle of the
// pole and the chord, and what lies between chord and arc. The pole's opposite point is not in there, since it is no
// nearer to any arc than the arc's own cap is wide, or beyond all caps.
QSES_FN double integrate_about(const Vec3<double> &pole, const SphereArc &arc) {
  int pieces = 1;
  double c = arc.cos_half, s = arc.sin_half;  // of half a piece
  for (double half = arc.half; half > 0.7854; half *= 0.5) {
    s = sqrt(0.5 * (1.0 - c));
    c = sqrt(0.5 * (1.0 + c));
    pieces *= 2;
  }
  const double c2 = c * c - s * s, s2 = 2.0 * c * s;
  const double chord = 2.0 * atan2((1.0 - arc.cosine) * s2, (1.0 + arc.cosine) + (1.0 - arc.cosine) * c2);
  double sum = (1.0 - arc.cosine) * 2.0 * arc.half - pieces * chord;
  double x = arc.cos_half, y = -arc.sin_half;
  Vec3<double> a = arc.at(x, y);
  for (int k = 0; k < pieces; ++k) {
    const double t = x * c2 - y * s2;
    y = y * c2 + x * s2;
    x = t;
    const Vec3<double> b = arc.at(x, y);
    sum += spherical_triangle(pole, a, b);
    a = b;
  }
  return sum;
}

// The point opposite to the pole of each atom that has caps.
struct ChooseOpposite {
  const CapRange *cap_ranges;
  const Cap *caps;
  glm::vec3 *opposites;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const CapRange range = cap_ranges[i];
    if (range.count <= 0) return;
    const Cap *const own = caps + range.first;
    const Cap largest = load(own);
    opposites[i] = has_tiny_caps(range, largest) ? to_glm(farthest_from_caps(own, range.count)) : largest.axis;
  }
};

// Adds what the arcs bring to the areas of their two atoms, and notes what they bring to the volume.
struct MeasureArc {
  const Sphere *atoms;
  const CapRange *cap_ranges;
  const glm::vec3 *opposites;
  const Arc *arcs;
  const ArcAtoms *arc_atoms;
  int64_t *solid_angles;  // per atom
  double *volumes;        // per arc, three times

  QSES_HOST_DEVICE void operator()(size_t i) const {
    const ArcAtoms two = arc_atoms[i];
    const Arc stored = load(arcs + i);
    const Sphere first = load(atoms + two.first), second = load(atoms + two.second);
    const Vec3<double> low = to_double(first.center), apart = to_double(second.center) - low;
    const double r = static_cast<double>(first.radius), q = static_cast<double>(second.radius);
    const double distance2 = length_squared(apart), distance = sqrt(distance2);
    // From the first centre to the plane of the circle.
    const double along = 0.5 * (distance2 + (r - q) * (r + q)) / distance;
    const double radius2 = r * r - along * along, radius = sqrt(radius2 > 0.0 ? radius2 : 0.0);
    SphereArc arc;
    arc.axis = apart * (1.0 / distance);
    // The stored frame is good to single precision: turned into the plane.
    Vec3<double> middle = to_double(stored.middle);
    middle = middle - arc.axis * dot(middle, arc.axis);
    arc.middle = middle * (1.0 / sqrt(length_squared(middle)));
    arc.side = cross(arc.axis, arc.middle);
    const double c = static_cast<double>(stored.cos_half), s = static_cast<double>(stored.sin_half);
    const double scale = 1.0 / sqrt(c * c + s * s);
    arc.half = atan2(s, c);
    arc.cos_half = c * scale;
    arc.sin_half = s * scale;
    double volume = measure_side(two.first, low, r, along, radius, arc);
    arc.axis = arc.axis * -1.0;
    arc.side = arc.side * -1.0;
    volume += measure_side(two.second, low + apart, q, distance - along, radius, arc);
    volumes[i] = volume;
  }

 private:
  // Of the atom whose neighbour is in the direction of the arc's axis. What is exposed lies right of the arc.
  QSES_FN double measure_side(uint32_t atom, const Vec3<double> &center, double atom_radius, double along,
                              double circle_radius, SphereArc &arc) const {
    if (cap_ranges[atom].count <= 0) return 0.0;
    arc.cosine = along / atom_radius;
    arc.sine = circle_radius / atom_radius;
    const Vec3<double> opposite = to_double(opposites[atom]);
    const double solid_angle = -integrate_about(opposite * (-1.0 / sqrt(length_squared(opposite))), arc);
    atomic_add(solid_angles + atom, static_cast<int64_t>(floor(solid_angle * kSolidAngleUnits + 0.5)));
    // Half the integral of x cross dx along the arc, from the atom's centre.
    const Vec3<double> vector_area =
        arc.middle * (circle_radius * along * arc.sin_half) - arc.axis * (circle_radius * circle_radius * arc.half);
    return dot(center, vector_area);
  }
};

// What an atom has of the surface, Å².
struct AreaOfAtom {
  const Sphere *atoms;
  const CapRange *cap_ranges;
  const Cap *caps;
  const int64_t *solid_angles;
  QSES_FN double operator()(size_t i) const {
    const CapRange range = cap_ranges[i];
    if (range.count == kBuriedAtom) return 0.0;
    const double r = static_cast<double>(atoms[i].radius);
    double sum = static_cast<double>(solid_angles[i]) / kSolidAngleUnits;
    // More than half is exposed then, so that it is above half the sphere, or below nothing where the opposite point
    // is.
    if (range.count > 0 && has_tiny_caps(range, load(caps + range.first)) && sum < 0.25 * kWholeSphere)
      sum += kWholeSphere;
    const double solid_angle = range.count == 0 || sum > kWholeSphere ? kWholeSphere : sum < 0.0 ? 0.0 : sum;
    return rounded_product(rounded_product(r, r), solid_angle);
  }
};

// Area, and three times the volume, of arc i and of atom i.
struct SumAtomsAndArcs {
  AreaOfAtom area;
  size_t atoms, arcs;
  const double *volumes;
  QSES_HOST_DEVICE SumPair operator()(size_t i) const {
    SumPair pair;
    if (i < atoms) {
      pair.first = area(i);
      pair.second = rounded_product(static_cast<double>(area.atoms[i].radius), pair.first);
    }
    if (i < arcs) pair.second += volumes[i];
    return pair;
  }
};

// Areas in the caller's order.
struct StoreAreas {
  AreaOfAtom area;
  const uint32_t *order;
  double *areas;
  QSES_HOST_DEVICE void operator()(size_t i) const { areas[order[i]] = area(i); }
};

// Of all atoms. areas: in the back end's memory, of each atom in the caller's order; nullptr: they are not asked for.
// Waits.
template <class Executor>
AtomMeasures measure_atoms(Executor &executor, const NeighborGridView &atoms, const SolventFeatures &features,
                           double *areas) {
  const auto mark = executor.arena().mark();
  const size_t n = atoms.count, arcs = features.arcs.size;
  const Span<int64_t> solid_angles = executor.template allocate_zeros<int64_t>(n);
  const Span<double> volumes = executor.template allocate<double>(arcs);
  const Span<glm::vec3> opposites = executor.template allocate<glm::vec3>(n);
  executor.for_each(n, ChooseOpposite{features.cap_ranges.data, features.caps.data, opposites.data},
                    std::min(kThreadSteps, kPlainSteps + kDirections * uint64_t(features.most_caps)));
  executor.for_each(arcs,
                    MeasureArc{atoms.items, features.cap_ranges.data, opposites.data, features.arcs.data,
                               features.arc_atoms.data, solid_angles.data, volumes.data},
                    kArcMeasureSteps);
  const AreaOfAtom area{atoms.items, features.cap_ranges.data, features.caps.data, solid_angles.data};
  if (areas) executor.for_each(n, StoreAreas{area, atoms.order, areas});
  const SumPair sums =
      executor.template reduce<SumPair>(n > arcs ? n : arcs, SumAtomsAndArcs{area, n, arcs, volumes.data});
  executor.arena().rewind(mark);
  return {sums.first, sums.second / 3.0};
}

}  // namespace quickses
