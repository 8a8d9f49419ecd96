// SPDX-License-Identifier: MIT
// The nearest point of the boundary of the solvent-accessible surface, and with it the exact place of a vertex on the
// surface, its normal and its owner. The formulas are those of Connolly 1983, read backwards: a vertex lies `depth`
// from the nearest place y where the probe's centre may be, on the line from y through where the vertex started.
#pragma once

#include "quickses/quickses.h"

#include "surface/geometry/lattice.h"
#include "surface/stages/side_normals.h"
#include "surface/stages/solvent_features.h"

namespace quickses {

// A vertex start is at most this far from the surface, in units of the spacing, if the spacing is at most two probe
// radii; candidates are gathered accordingly.
constexpr float kStartReach = 0.9f;
// So far from a start, arcs decide about it: what is farther has nothing to do with the surface near it, and is listed
// for it or not as it comes.
QSES_FN float start_reach(const SurfaceParameters &p) { return p.depth + kStartReach * p.spacing; }
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
constexpr int kMaxProjections = 10;
// Probes whose centres are nearer to each other than this, in units of the probe, make one sheet of the surface.
constexpr float kSameSheet = 0.07f;

// Depth of a point in an inflated ball: R - |x - c|. The largest over the atoms is a lower bound of the distance to the
// boundary, and the distance itself if the radial projection on that atom is exposed; no other atom's can be.
template <class Ball, class T>
QSES_FN T ball_depth(const Ball &atom, const Vec3<T> &x) {
  return T(atom.radius) - square_root(length_squared(x - Vec3<T>(atom.center)));
}

// Is the projection of the point in direction d (of the given length) from an atom's centre exposed?
QSES_FN bool is_exposed(const FeatureView &f, uint32_t atom, const Vec3<float> &d, float length) {
  const CapRange range = f.cap_ranges[atom];
  if (range.count == kBuriedAtom) return false;
  const Cap *caps = f.caps + range.first;
  constexpr int32_t kTogether = 4;  // so that a GPU waits for their loads together
  int32_t k = 0;
  for (; k + kTogether <= range.count; k += kTogether) {
    bool covered = false;
    for (int32_t j = 0; j < kTogether; ++j) covered |= cap_covers(load(caps + k + j), d, length);
    if (covered) return false;
  }
  for (; k < range.count; ++k)
    if (cap_covers(load(caps + k), d, length)) return false;
  return true;
}

// How far a point at some depth in a ball is from its centre.
template <class T>
QSES_FN T offset_length(const Sphere &ball, T depth) {
  return maximum(T(ball.radius) - depth, T(1e-12f));
}

constexpr float kNoDepth = -2.f * kFarAway;  // where there is no atom

// The atom whose ball the point is deepest in: also the one whose van der Waals surface is nearest. Candidates:
// atom_count(), atom(k) -> atom number, arc_count(), arc(k) -> arc number.
struct DeepestAtom {
  uint32_t atom;
  float depth;
};
template <class Candidates>
QSES_FN DeepestAtom deepest_atom(const FeatureView &f, const Candidates &candidates, const Vec3<float> &x) {
  DeepestAtom best{0, kNoDepth};
  const int atoms = candidates.atom_count();
  for (int k = 0; k < atoms; ++k) {
    const uint32_t i = candidates.atom(k);
    const float d = ball_depth(load(f.atoms.items + i), x);
    if (d > best.depth) best = {i, d};
  }
  return best;
}

// Is the point on the contact patch of that atom: is its radial projection exposed?
QSES_FN bool is_on_contact(const FeatureView &f, const DeepestAtom &deepest, const Vec3<float> &x) {
  if (deepest.depth <= -kFarAway) return false;  // there is no atom
  const Sphere ball = load(f.atoms.items + deepest.atom);
  return is_exposed(f, deepest.atom, x - Vec3<float>(ball.center), offset_length(ball, deepest.depth));
}
// By whoever looks at the candidates.
template <class Candidates>
QSES_FN bool is_on_contact(const FeatureView &f, const Candidates &, const DeepestAtom &deepest, const Vec3<float> &x) {
  return is_on_contact(f, deepest, x);
}

struct NearestArc {
  int arc = -1;                // -1: there is none
  float distance2 = kFarAway;  // squared
  float second2 = kFarAway;    // of the second nearest

  QSES_FN void offer(int a, float d2) {
    // Ties by number: arcs come in any order. (Without || and &&, which a GPU would branch for.)
    const bool nearer = (d2 < distance2) | ((d2 == distance2) & (a < arc));
    second2 = minimum(second2, maximum(d2, distance2));
    distance2 = minimum(distance2, d2);
    arc = nearer ? a : arc;
  }

  // Of those not farther than that.
  QSES_FN NearestArc within(float reach) const {
    const float reach2 = reach * reach;
    return {distance2 <= reach2 ? arc : -1, distance2, second2 <= reach2 ? second2 : kFarAway};
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

QSES_FN Vec3<float> direction(const Vec3<float> &from, const Vec3<float> &to) {
  const Vec3<float> d = to - from;
  return d * reciprocal_root(maximum(length_squared(d), 1e-12f));
}

// Outward from a ball's centre; a fixed direction at the centre itself.
template <class T>
QSES_FN Vec3<T> sphere_normal(const Sphere &ball, const Vec3<T> &x) {
  const Vec3<T> d = x - Vec3<T>(ball.center);
  const T length2 = length_squared(d), inverse = reciprocal_root(maximum(length2, T(1e-12f)));
  const auto off_center = T(1e-12f) < length2;
  return {select(off_center, d.x * inverse, T(0.f)), select(off_center, d.y * inverse, T(0.f)),
          select(off_center, d.z * inverse, T(1.f))};
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
  if (is_on_contact(f, candidates, deepest, x)) return boundary_on_atom(ball, deepest.depth, x, true);
  const NearestArc nearest = nearest_arc(f, candidates, x);
  if (nearest.arc >= 0) return boundary_on_arc(load(f.arcs + nearest.arc), x);
  return boundary_on_atom(ball, deepest.depth, x, false);
}

struct SurfacePoint {
  Vec3<float> position, normal;
  Vec3<float> second_normal;  // where two sheets meet, of the other one; elsewhere equal to the first
  qses_patch patch;
  bool placed;  // false: no feature is near, or none can be trusted

  QSES_FN bool is_crest() const { return normal != second_normal; }
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
  return {position, outward, outward, y.patch, y.found && near};
}

// The atom whose van der Waals surface is nearest to the point.
template <class Candidates>
QSES_FN uint32_t nearest_atom(const FeatureView &f, const Candidates &candidates, const Vec3<float> &x) {
  return deepest_atom(f, candidates, x).atom;
}

// A vertex as the mesh has it. On the SAS and VDW surfaces it may sit on a crease, where the line to y has no length,
// and one that was not placed has no such line: the normal is that of the owner's sphere.
QSES_FN void write_vertex(const FeatureView &f, const Lattice &lattice, const MeshView &mesh, uint32_t vertex,
                          uint32_t owner, SurfacePoint s) {
  if (f.parameters.is_of_balls() || !s.placed)
    s.normal = s.second_normal = sphere_normal(load(f.atoms.items + owner), s.position);
  store_vec3(mesh.position(vertex), Vec3<float>(lattice.to_caller(s.position)));
  store_normals(mesh, vertex, s.normal, s.second_normal);
  mesh.owner(vertex) = f.atoms.order[owner];
  if (mesh.patches) mesh.patch(vertex) = static_cast<uint8_t>(s.patch);
}

// ---- the rounds of a projection --------------------------------------------------------------------------------

// The way of a vertex to the surface: one rule for all loops over vertices.
//
//   first     on the contact patch of the ball it is deepest in, if the radial projection on that is exposed:
//             project_on_atom(). Else from the nearest arc: project_on_arc(), round 1. But from outside of all balls
//             either way would lead off
//   then      while another probe may cover it, from the arc that is nearest to where it is now: reproject(), rounds 2
//             to kMaxProjections. Where another probe does, it jumps to the crest, where the spheres of both probes
//             meet; where none does, it is placed
//   at last   where the sign changes on its lattice edge: place_on_edge(), if it starts outside or has no arc, moved
//             further than can be trusted, or is covered still after the last round
enum class ProjectionState : uint32_t { kOnEdge, kReproject, kPlaced };

struct Projection {
  SurfacePoint point;  // where the vertex is now: on the sphere of a probe, or on those of two
  ProjectionState state;
  int rounds;  // of arcs so far; one more for a long way in the first
};

// Next to a lattice point that stands for a wall a start may be outside of all balls: as told by the deepest of all.
QSES_FN bool starts_outside(const SurfaceParameters &p, const DeepestAtom &deepest) {
  return p.depth > 0.f && deepest.depth <= p.least_depth();
}

// From the centre outward: from where the probe may be, which may be x itself, the way would be lost in rounding.
QSES_FN Projection project_on_atom(const SurfaceParameters &p, const Sphere &ball, float depth, const Vec3<float> &x) {
  const Vec3<float> outward = sphere_normal(ball, x),
                    position = Vec3<float>(ball.center) + outward * (ball.radius - p.depth);
  const bool near = is_short_move(p, p.depth - depth, length_squared(position - x));
  return {{position, outward, outward, QSES_PATCH_CONTACT, near},
          near ? ProjectionState::kPlaced : ProjectionState::kOnEdge,
          0};
}

QSES_FN Projection project_on_arc(const FeatureView &f, const NearestArc &of_all, const Vec3<float> &x) {
  const Vec3<float> up(0.f, 0.f, 1.f);
  const SurfaceParameters &p = f.parameters;
  const NearestArc nearest = of_all.within(start_reach(p));
  if (nearest.arc < 0) return {{x, up, up, QSES_PATCH_REENTRANT, false}, ProjectionState::kOnEdge, 1};
  const Arc arc = load(f.arcs + nearest.arc);
  const BoundaryPoint y = boundary_on_arc(arc, x);
  // Where the probe's centre may be itself, rounding would say which way the surface is.
  if (p.depth > 0.f && y.distance < kProjectionTolerance)
    return {{x, up, up, QSES_PATCH_REENTRANT, false}, ProjectionState::kOnEdge, 1};
  const SurfacePoint s = place_on_surface(p, x, y);
  // On its way outward from a start that is nearer to y than depth, the point may get to where another probe is, or one
  // on the other side of the same circle.
  const Vec3<float> center(arc.center);
  const bool beyond_axis = dot(s.position - center, y.position - center) < 0.f;
  const bool may_be_covered = y.distance < p.depth - kProjectionTolerance &&
                              (square_root(nearest.second2) < 2.f * p.depth - y.distance || beyond_axis);
  if (!s.placed) return {s, ProjectionState::kOnEdge, 1};
  // On its way to a wall it may also get to where a probe is that touches a single atom: looked at from round 2 on.
  if (p.depth - y.distance > kLongestWayIn * p.spacing) return {s, ProjectionState::kReproject, 2};
  return {s, may_be_covered ? ProjectionState::kReproject : ProjectionState::kPlaced, 1};
}

// A point on the sphere of a probe, or on those of two, that another probe covers, at y: onto the crest, which is the
// circle where the sphere of that one and of the farther one of the former meet. (From sphere to sphere it would come
// nearer to the crest in ever smaller steps.)
QSES_FN SurfacePoint leave_probe(const SurfaceParameters &p, const SurfacePoint &s, const BoundaryPoint &y) {
  const Vec3<float> &x = s.position;
  Vec3<float> first = x + s.normal * p.depth, second = x + s.second_normal * p.depth;
  const float to_first2 = length_squared(y.position - first), to_second2 = length_squared(y.position - second);
  if (s.is_crest() && to_first2 < to_second2)
    first = y.position;
  else
    second = y.position;
  const Vec3<float> between = second - first, middle = (first + second) * 0.5f;
  const float between2 = length_squared(between), same = kSameSheet * p.depth;
  if (between2 <= same * same) return place_on_surface(p, x, y);
  const Vec3<float> from = x - middle, off = from - between * quotient(dot(from, between), between2);
  const float height2 = p.depth * p.depth - 0.25f * between2, off2 = length_squared(off);
  const Vec3<float> crest =
      middle + off * (square_root(maximum(0.f, height2)) * reciprocal_root(maximum(off2, 1e-12f)));
  const float longest = kLongestMove * p.spacing;
  const bool near = off2 > 1e-12f && length_squared(crest - x) <= longest * longest;  // not a number: false
  return {crest, direction(crest, first), direction(crest, second), y.patch, near};
}

// A further round for a vertex that lies on the sphere of a probe already.
template <class Candidates>
QSES_FN Projection reproject(const FeatureView &f, const Candidates &candidates, const NearestArc &nearest,
                             const Projection &before) {
  const SurfaceParameters &p = f.parameters;
  const SurfacePoint &s = before.point;
  const int round = before.rounds + 1;
  const BoundaryPoint y = nearest.arc < 0 ? BoundaryPoint{s.position, p.depth, s.patch, false}
                                          : boundary_on_arc(load(f.arcs + nearest.arc), s.position);
  if (y.distance < p.depth - kProjectionTolerance) {
    const SurfacePoint left = leave_probe(p, s, y);
    const bool goes_on = left.placed && round < kMaxProjections;
    return {left, goes_on ? ProjectionState::kReproject : ProjectionState::kOnEdge, round};
  }
  if (before.rounds > 1) {  // where it is now, a probe that touches a single atom may cover it
    const DeepestAtom deepest = deepest_atom(f, candidates, s.position);
    if (deepest.depth < p.depth - kProjectionTolerance && is_on_contact(f, candidates, deepest, s.position)) {
      Projection on = project_on_atom(p, load(f.atoms.items + deepest.atom), deepest.depth, s.position);
      on.rounds = round;
      return on;
    }
    if (deepest.depth < 0.f) return {s, ProjectionState::kOnEdge, round};
  }
  if (s.is_crest() || !y.found) return {s, ProjectionState::kPlaced, round};
  const SurfacePoint on = place_on_surface(p, s.position, y);
  return {on, on.placed ? ProjectionState::kPlaced : ProjectionState::kOnEdge, round};
}

// ---- lattice edges ---------------------------------------------------------------------------------------------

// Is the point inside the surface? What the signs say of lattice points, for any point.
template <class Candidates>
QSES_FN bool is_inside(const FeatureView &f, const Candidates &candidates, const Vec3<float> &x) {
  const float depth = f.parameters.depth;
  const DeepestAtom deepest = deepest_atom(f, candidates, x);
  if (deepest.depth <= f.parameters.least_depth()) return false;
  if (deepest.depth > depth) return true;
  if (is_on_contact(f, candidates, deepest, x)) return false;
  return nearest_arc(f, candidates, x).distance2 > depth * depth;
}

}  // namespace quickses
