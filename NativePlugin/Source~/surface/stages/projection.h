// SPDX-License-Identifier: MIT
// The nearest point of the boundary of the solvent-accessible surface, and with it the exact place of a vertex on the
// surface, its normal and its owner. The formulas are those of Connolly 1983, read backwards: a vertex lies `depth`
// from the nearest place y where the probe's centre may be, on the line from y through where the vertex started.
#pragma once

#include "quickses/quickses.h"

#include "surface/geometry/lattice.h"
#include "surface/stages/solvent_features.h"

namespace quickses {

// A vertex start is at most this far from the surface, in units of the spacing, if the spacing is at most two probe
// radii; candidates are gathered accordingly.
constexpr float kStartReach = 0.9f;
// How far, in units of the spacing, a start may lie outside the box of the lattice points that own the edges: half an
// edge and a relaxation step.
constexpr float kStartOverhang = 1.2f;

// What would move a vertex further than this, in units of the spacing, is no feature of the surface near it.
constexpr float kLongestMove = 2.f;
// And what would move it further than this into the molecule might take it through a wall and out on its other side.
// Where thin walls are mended (thin_walls.h), a start may have to go farther: its inside end only stands for the wall.
constexpr float kLongestWayIn = 0.6f, kLongestWayToWall = 1.f;

// A probe covers what is deeper in it than this.
constexpr float kProjectionTolerance = 1e-4f;
// Rounds after which the lattice edge decides.
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
  return {Vec3<float>(ball.center) + sphere_normal(ball, x) * ball.radius, depth, QSES_PATCH_CONTACT, exposed};
}

QSES_FN BoundaryPoint boundary_on_arc(const Arc &arc, const Vec3<float> &x) {
  const ArcPoint p = nearest_on_arc(arc, x);
  return {p.position, square_root(length_squared(p.position - x)),
          p.at_end ? QSES_PATCH_REENTRANT : QSES_PATCH_TOROIDAL, true};
}

template <class Candidates>
QSES_FN BoundaryPoint nearest_boundary(const FeatureView &f, const Candidates &candidates, const Vec3<float> &x) {
  const DeepestAtom deepest = deepest_atom(f, candidates, x);
  const Sphere ball = load(f.atoms.items + deepest.atom);
  const bool exposed = candidates.atom_count() > 0 &&
                       is_exposed(f, deepest.atom, x - Vec3<float>(ball.center), offset_length(ball, deepest.depth));
  if (exposed) return boundary_on_atom(ball, deepest.depth, x, true);
  const NearestArc nearest = nearest_arc(f, candidates, x);
  if (nearest.arc >= 0) return boundary_on_arc(load(f.arcs + nearest.arc), x);
  return boundary_on_atom(ball, deepest.depth, x, false);
}

struct SurfacePoint {
  Vec3<float> position, normal;
  qses_patch patch;
  bool placed;  // false: no feature is near, or none can be trusted
};

// Can a vertex be trusted that moved so far, `way_in` of it into the molecule?
template <class T>
QSES_FN auto is_short_move(const SurfaceParameters &p, T way_in, T moved2) -> decltype(way_in <= moved2) {
  const float longest = kLongestMove * p.spacing;
  return (way_in <= T((p.has_thin_walls() ? kLongestWayToWall : kLongestWayIn) * p.spacing)) &
         (moved2 <= T(longest * longest));
}

// The point `depth` inside the boundary point y on the line through x, which lies `distance` (signed) inside it.
QSES_FN SurfacePoint place_on_surface(const SurfaceParameters &p, const Vec3<float> &x, const BoundaryPoint &y) {
  Vec3<float> outward = (y.position - x) * quotient(1.f, absolute(y.distance) > 1e-9f ? y.distance : 1e-9f);
  const float length2 = length_squared(outward);
  outward = length2 > 0.25f ? outward * reciprocal_root(length2) : Vec3<float>(0.f, 0.f, 1.f);
  const Vec3<float> position = y.position - outward * p.depth;
  const bool near = is_short_move(p, p.depth - y.distance, length_squared(position - x));
  return {position, outward, y.patch, y.found && near};
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

// ---- the rounds of a projection --------------------------------------------------------------------------------

// The way of a vertex to the surface: one rule for all loops over vertices.
//
//   first     on the contact patch of the ball it is deepest in, if the radial projection on that is exposed:
//             project_on_atom(). Else from the nearest arc: project_on_arc(), round 1
//   then      while another probe may cover it, from the arc that is nearest to where it is now: reproject(), rounds 2
//             to kMaxProjections. Where another probe does, it moves aside; where none does, it is placed
//   at last   where the sign changes on its lattice edge: place_on_edge(), if it has no arc, moved further than can be
//             trusted, came to lie over a contact patch when it moved aside, or is not placed after the last round
enum class ProjectionState : uint32_t { kOnEdge, kReproject, kPlaced };

struct Projection {
  SurfacePoint point;  // where the vertex is now
  ProjectionState state;
  int rounds;  // of arcs so far
};

QSES_FN Projection project_on_atom(const SurfaceParameters &p, const Sphere &ball, float depth, const Vec3<float> &x) {
  const SurfacePoint s = place_on_surface(p, x, boundary_on_atom(ball, depth, x, true));
  return {s, s.placed ? ProjectionState::kPlaced : ProjectionState::kOnEdge, 0};
}

QSES_FN Projection project_on_arc(const FeatureView &f, const NearestArc &nearest, const Vec3<float> &x) {
  if (nearest.arc < 0) return {{x, {0.f, 0.f, 1.f}, QSES_PATCH_REENTRANT, false}, ProjectionState::kOnEdge, 1};
  const SurfaceParameters &p = f.parameters;
  const Arc arc = load(f.arcs + nearest.arc);
  const BoundaryPoint y = boundary_on_arc(arc, x);
  const SurfacePoint s = place_on_surface(p, x, y);
  // On its way outward from a start that is nearer to y than depth, the point may get to where another probe is, or one
  // on the other side of the same circle.
  const Vec3<float> center(arc.center);
  const bool beyond_axis = dot(s.position - center, y.position - center) < 0.f;
  const bool may_be_covered = y.distance < p.depth - kProjectionTolerance &&
                              (square_root(nearest.second2) < 2.f * p.depth - y.distance || beyond_axis);
  if (!s.placed) return {s, ProjectionState::kOnEdge, 1};
  return {s, may_be_covered ? ProjectionState::kReproject : ProjectionState::kPlaced, 1};
}

// A point on the sphere of a probe, in direction `outward`, that another probe, at y, covers: away from both at once,
// onto the sphere of the other one. (From sphere to sphere it would come nearer to where they meet in ever smaller
// steps.)
QSES_FN SurfacePoint move_aside(const SurfaceParameters &p, const Vec3<float> &x, const Vec3<float> &outward,
                                const BoundaryPoint &y) {
  const float d = y.distance;
  const Vec3<float> other = (y.position - x) * quotient(1.f, maximum(d, 1e-9f)), between = outward + other;
  const Vec3<float> towards = between * reciprocal_root(maximum(length_squared(between), 1e-12f));
  const float along = d * dot(towards, other);
  const float step = square_root(maximum(0.f, along * along + (p.depth - d) * (p.depth + d))) - along;
  const Vec3<float> moved = x - towards * step, from = y.position - moved;
  const bool near = step <= kLongestMove * p.spacing;  // not a number: false
  return {moved, from * reciprocal_root(maximum(length_squared(from), 1e-12f)), y.patch, near};
}

// Of a point that moved aside: does a probe that touches a single atom cover it?
template <class Candidates>
QSES_FN bool is_over_contact(const FeatureView &f, const Candidates &candidates, const Vec3<float> &x) {
  if (candidates.atom_count() == 0) return false;
  const DeepestAtom deepest = deepest_atom(f, candidates, x);
  const Sphere ball = load(f.atoms.items + deepest.atom);
  return deepest.depth < f.parameters.depth - kProjectionTolerance &&
         is_exposed(f, deepest.atom, x - Vec3<float>(ball.center), offset_length(ball, deepest.depth));
}

// A further round for a vertex that lies on the sphere of a probe already.
template <class Candidates>
QSES_FN Projection reproject(const FeatureView &f, const Candidates &candidates, const NearestArc &nearest,
                             const Projection &before) {
  const SurfaceParameters &p = f.parameters;
  const int round = before.rounds + 1;
  if (nearest.arc < 0) return {before.point, ProjectionState::kPlaced, round};  // nothing is near it any more
  const Vec3<float> &x = before.point.position;
  const BoundaryPoint y = boundary_on_arc(load(f.arcs + nearest.arc), x);
  const bool covered = y.distance < p.depth - kProjectionTolerance;
  const SurfacePoint s = covered ? move_aside(p, x, before.point.normal, y) : place_on_surface(p, x, y);
  const bool was_moved_aside = before.rounds > 1;
  const bool given_up = !s.placed || (covered && round == kMaxProjections) ||
                        (was_moved_aside && is_over_contact(f, candidates, s.position));
  if (given_up) return {s, ProjectionState::kOnEdge, round};
  return {s, covered ? ProjectionState::kReproject : ProjectionState::kPlaced, round};
}

// ---- lattice edges ---------------------------------------------------------------------------------------------

// Is the point inside the surface? What the signs say of lattice points, for any point.
template <class Candidates>
QSES_FN bool is_inside(const FeatureView &f, const Candidates &candidates, const Vec3<float> &x) {
  if (candidates.atom_count() == 0) return false;
  const float depth = f.parameters.depth;
  const DeepestAtom deepest = deepest_atom(f, candidates, x);
  if (deepest.depth <= f.parameters.least_depth()) return false;
  if (deepest.depth > depth) return true;
  const Sphere ball = load(f.atoms.items + deepest.atom);
  if (is_exposed(f, deepest.atom, x - Vec3<float>(ball.center), offset_length(ball, deepest.depth))) return false;
  return nearest_arc(f, candidates, x).distance2 > depth * depth;
}

template <class Candidates>
QSES_FN Vec3<float> halve_edge(const FeatureView &f, const Candidates &candidates, CutEdge edge, int halvings) {
  for (int k = 0; k < halvings; ++k)
    (is_inside(f, candidates, edge.middle()) ? edge.inside : edge.outside) = edge.middle();
  return edge.middle();
}

// A lattice edge longer than the probe is wide may hold more than its middle tells: halve it towards the sign change
// first.
constexpr int kStartHalvings = 8;
QSES_FN bool starts_by_halving(const SurfaceParameters &p) { return p.depth > 0.f && p.spacing > 2.f * p.depth; }

}  // namespace quickses
