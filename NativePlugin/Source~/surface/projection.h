// SPDX-License-Identifier: MIT
// The nearest point of the boundary of the solvent-accessible surface, and with it the exact place of a vertex on the
// surface, its normal and its owner. The formulas are those of Connolly 1983, read backwards: a vertex lies `depth`
// from the nearest place y where the probe's centre may be, on the line from y through where the vertex started.
#pragma once

#include "quickses/quickses.h"

#include "surface/lattice.h"
#include "surface/solvent_features.h"

namespace quickses {

// A vertex start is at most this far from the surface, in units of the spacing, if the spacing is at most two probe
// radii; candidates are gathered accordingly.
constexpr float kStartReach = 0.9f;
// How far, in units of the spacing, a start may lie outside the box of the lattice points that own the edges: half an
// edge and a relaxation step.
constexpr float kStartOverhang = 1.2f;

// What would move a vertex further than this, in units of the spacing, is no feature of the surface near it.
constexpr float kLongestMove = 2.f;

// Nothing that is deeper than this in the probe's way counts as a second hit.
constexpr float kProjectionTolerance = 1e-4f;
constexpr int kMaxProjections = 5;

// Depth of a point in an inflated ball: R - |x - c|. The largest over the atoms is a lower bound of the distance to the
// boundary, and the distance itself if the radial projection on that atom is exposed; no other atom's can be.
template <class T>
QSES_FN T ball_depth(const Sphere &atom, const Vec3<T> &x) {
  return T(atom.radius) - square_root(length_squared(x - Vec3<T>(atom.center)));
}

// Is the projection of the point in direction d (of the given length) from an atom's centre exposed?
QSES_FN bool is_exposed(const FeatureView &f, uint32_t atom, const Vec3<float> &d, float length) {
  const CapRange range = f.cap_ranges[atom];
  if (range.count == kBuriedAtom) return false;
  const Cap *caps = f.caps + range.first;
  for (int32_t k = 0; k < range.count; ++k)
    if (cap_covers(load(caps + k), d, length)) return false;
  return true;
}

// The atom whose ball the point is deepest in: also the one whose van der Waals surface is nearest. Candidates:
// atom_count(), atom(k) -> atom number, arc_count(), arc(k) -> arc number.
struct DeepestAtom {
  uint32_t atom;
  float depth;
};
template <class Candidates>
QSES_FN DeepestAtom deepest_atom(const FeatureView &f, const Candidates &candidates, const Vec3<float> &x) {
  DeepestAtom best{0, -2.f * kFarAway};
  const int atoms = candidates.atom_count();
  for (int k = 0; k < atoms; ++k) {
    const uint32_t i = candidates.atom(k);
    const float d = ball_depth(load(f.atoms.items + i), x);
    if (d > best.depth) best = {i, d};
  }
  return best;
}

struct NearestArc {
  int arc = -1;                // -1: there is none
  float distance2 = kFarAway;  // squared
  float second2 = kFarAway;    // of the second nearest

  QSES_FN void offer(int a, float d2) {
    if (d2 < distance2 || (d2 == distance2 && a < arc)) {  // ties by number: arcs come in any order
      second2 = distance2;
      distance2 = d2;
      arc = a;
    } else {
      second2 = minimum(second2, d2);
    }
  }
};
template <class Candidates>
QSES_FN NearestArc nearest_arc(const FeatureView &f, const Candidates &candidates, const Vec3<float> &x) {
  NearestArc best;
  const int arcs = candidates.arc_count();
  for (int k = 0; k < arcs; ++k) {
    const int a = static_cast<int>(candidates.arc(k));
    best.offer(a, arc_distance2(load(f.arcs + a), x));
  }
  return best;
}

// What decides about one point.
struct BoundaryPoint {
  Vec3<float> position;  // y: where the probe's centre is when it touches the surface at the vertex
  float distance;        // |x - y|; negative if x is outside the union of the inflated balls
  float second;          // distance to the second nearest arc: only of interest where the first one decided
  qses_patch patch;
  bool found;  // false: nothing exposed is near, so that the rest means little
};

// The length of the offset of a point at some depth in a ball.
QSES_FN float offset_length(const Sphere &ball, float depth) { return maximum(ball.radius - depth, 1e-12f); }

// Outward from a ball's centre; a fixed direction at the centre itself.
QSES_FN Vec3<float> sphere_normal(const Sphere &ball, const Vec3<float> &x) {
  const Vec3<float> d = x - Vec3<float>(ball.center);
  const float length2 = length_squared(d);
  return length2 > 1e-12f ? d * reciprocal_root(length2) : Vec3<float>(0.f, 0.f, 1.f);
}

QSES_FN BoundaryPoint boundary_on_atom(const Sphere &ball, float depth, const Vec3<float> &x, bool exposed) {
  return {Vec3<float>(ball.center) + sphere_normal(ball, x) * ball.radius, depth, kFarAway, QSES_PATCH_CONTACT,
          exposed};
}

QSES_FN BoundaryPoint boundary_on_arc(const Arc &arc, float second2, const Vec3<float> &x) {
  const ArcPoint p = nearest_on_arc(arc, x);
  return {p.position, square_root(length_squared(p.position - x)), square_root(second2),
          p.at_end ? QSES_PATCH_REENTRANT : QSES_PATCH_TOROIDAL, true};
}

template <class Candidates>
QSES_FN BoundaryPoint nearest_boundary(const FeatureView &f, const Candidates &candidates, const Vec3<float> &x,
                                       bool arcs_only = false) {
  DeepestAtom deepest{0, -kFarAway};
  if (!arcs_only && candidates.atom_count() > 0) {
    deepest = deepest_atom(f, candidates, x);
    const Sphere ball = load(f.atoms.items + deepest.atom);
    if (is_exposed(f, deepest.atom, x - Vec3<float>(ball.center), offset_length(ball, deepest.depth)))
      return boundary_on_atom(ball, deepest.depth, x, true);
  }
  const NearestArc nearest = nearest_arc(f, candidates, x);
  if (nearest.arc >= 0) return boundary_on_arc(load(f.arcs + nearest.arc), nearest.second2, x);
  return boundary_on_atom(load(f.atoms.items + deepest.atom), deepest.depth, x, false);
}

struct SurfacePoint {
  Vec3<float> position, normal;
  qses_patch patch;
  bool placed;  // false: there is no feature to be placed on; the position is the start, the normal is not known
};

// The point `depth` inside the boundary point y on the line through x, which lies `distance` (signed) inside it.
QSES_FN SurfacePoint place_on_surface(const SurfaceParameters &p, const Vec3<float> &x, const BoundaryPoint &y) {
  Vec3<float> outward = (y.position - x) * quotient(1.f, absolute(y.distance) > 1e-9f ? y.distance : 1e-9f);
  const float length2 = length_squared(outward);
  outward = length2 > 0.25f ? outward * reciprocal_root(length2) : Vec3<float>(0.f, 0.f, 1.f);
  const Vec3<float> position = y.position - outward * p.depth;
  const float longest = kLongestMove * p.spacing;
  if (y.found && length_squared(position - x) <= longest * longest) return {position, outward, y.patch, true};
  return {x, outward, QSES_PATCH_CONTACT, false};
}

// Does the projection from a start nearer to y than depth have to be checked against other probes?
QSES_FN bool needs_another_look(float distance, float second, float depth) {
  return distance < depth - kProjectionTolerance && second < 2.f * depth - distance;
}

template <class Candidates>
QSES_FN SurfacePoint project_to_surface(const FeatureView &f, const Candidates &candidates, Vec3<float> x) {
  BoundaryPoint b = nearest_boundary(f, candidates, x);
  SurfacePoint s = place_on_surface(f.parameters, x, b);
  for (int k = 1; k < kMaxProjections; ++k) {
    if (b.patch == QSES_PATCH_CONTACT || !needs_another_look(b.distance, b.second, f.parameters.depth)) break;
    x = s.position;
    b = nearest_boundary(f, candidates, x, true);
    s = place_on_surface(f.parameters, x, b);
  }
  return s;
}

// The atom whose van der Waals surface is nearest to the point.
template <class Candidates>
QSES_FN uint32_t nearest_atom(const FeatureView &f, const Candidates &candidates, const Vec3<float> &x) {
  return deepest_atom(f, candidates, x).atom;
}

// On the SAS and VDW surfaces vertices may sit on creases, where the line to y has no length, and a vertex that was not
// placed has no such line: the normal is that of the owner's sphere.
QSES_FN Vec3<float> vertex_normal(const FeatureView &f, const SurfacePoint &s, uint32_t owner) {
  return f.parameters.depth == 0.f || !s.placed ? sphere_normal(load(f.atoms.items + owner), s.position) : s.normal;
}

// A lattice edge longer than the probe is wide may hold more than its middle tells: halve it towards the sign change
// first. inside and outside are its ends.
constexpr int kEdgeHalvings = 8;
QSES_FN bool starts_by_halving(const SurfaceParameters &p) { return p.depth > 0.f && p.spacing > 2.f * p.depth; }

template <class Candidates>
QSES_FN Vec3<float> halve_edge(const FeatureView &f, const Candidates &candidates, Vec3<float> inside,
                               Vec3<float> outside) {
  for (int k = 0; k < kEdgeHalvings; ++k) {
    const Vec3<float> middle = (inside + outside) * 0.5f;
    if (nearest_boundary(f, candidates, middle).distance > f.parameters.depth)
      inside = middle;
    else
      outside = middle;
  }
  return (inside + outside) * 0.5f;
}

}  // namespace quickses
