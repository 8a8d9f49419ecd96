// SPDX-License-Identifier: MIT
// Walls of solid thinner than the spacing: where two probes come close to each other from both sides, no lattice point
// lies inside the wall between them, so that its signs have a hole. A lattice edge with both ends outside that passes
// through such a wall gets one end, the one deeper in, marked inside. Edges are those along the axes and the diagonals
// of faces: marching cubes separates points that only a diagonal of a face joins, so a wall one point thick would leak
// without them.
//
// Whether an edge passes through solid is asked of probes alone. Where the probe may be, nothing is solid, and its ball
// is convex: an edge that one probe covers, or two that overlap on it, is open. What is left is walked from ball to
// ball, and is a wall if a point right behind a ball, or in the middle, is farther than depth from all places where the
// probe may be.
#pragma once

#include "surface/stages/marching_cubes.h"
#include "surface/stages/projection.h"

namespace quickses {

// Edges by their first end: its lattice point and the step to the second.
constexpr int kWallSteps = 9;
constexpr int kWallStepTable[kWallSteps][3] = {{1, 0, 0}, {0, 1, 0},  {0, 0, 1}, {1, 1, 0}, {1, -1, 0},
                                               {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}};
// Along one axis, two bits each: of a table, the lanes of a GPU would have to load them.
constexpr uint32_t packed_wall_steps(int axis) {
  uint32_t packed = 0;
  for (int k = 0; k < kWallSteps; ++k) packed |= static_cast<uint32_t>(kWallStepTable[k][axis] + 1) << 2 * k;
  return packed;
}
QSES_FN glm::ivec3 wall_step(int k) {
  constexpr uint32_t kAlongX = packed_wall_steps(0), kAlongY = packed_wall_steps(1), kAlongZ = packed_wall_steps(2);
  const auto along = [&](uint32_t packed) { return static_cast<int>(packed >> 2 * k & 3) - 1; };
  return {along(kAlongX), along(kAlongY), along(kAlongZ)};
}
// Their length, in spacings.
QSES_FN float wall_step_length(int k) { return k < 3 ? 1.f : 1.41421356f; }

QSES_FN Vec3<float> wall_direction(int k) {
  const glm::ivec3 s = wall_step(k);
  const float scale = k < 3 ? 1.f : 0.70710678f;
  return {static_cast<float>(s.x) * scale, static_cast<float>(s.y) * scale, static_cast<float>(s.z) * scale};
}

// The words of a leaf and its neighbours, numbered as neighbours of a brick are (brick_border.h). Word: of one leaf, or
// several side by side.
template <class Word>
struct WordNeighborhood {
  Word at[kNeighborhood];
};
using LeafNeighborhood = WordNeighborhood<uint64_t>;

// The word of a leaf at a place counted from the first leaf of a brick, from -1 to 2 along each axis. words: of the
// brick that it is in; nullptr if that is not active: no wall is there, so all is outside.
QSES_FN uint64_t word_of_leaf(const glm::ivec3 &p, const uint64_t *words) {
  return words ? words[(p.x & 1) + 2 * (p.y & 1) + 4 * (p.z & 1)] : 0;
}

// Edges that may pass through a wall, by the bit of their first end in the leaf: both ends are outside, and a point
// next to both is inside, since a wall does not begin farther from where it is thick enough to be seen.
template <class Word>
QSES_FN void list_wall_candidates(const WordNeighborhood<Word> &n, Word edges[kWallSteps]) {
  // Inside within 0 to 1 or -1 to 1 along x; then within so much along y; the rows are those along x.
  Word own[9], next[9], x2[9], x3[9];
  for (int r = 0; r < 9; ++r) {
    own[r] = n.at[3 * r + 1];
    next[r] = shift_x(own[r], n.at[3 * r + 2]);
    x2[r] = own[r] | next[r];
    x3[r] = x2[r] | shift_x_back(own[r], n.at[3 * r]);
  }
  Word x2_up[3], x2_down[3], x2_all[3], x3_up[3], x3_all[3];
  for (int z = 0; z < 3; ++z) {
    const int r = 3 * z + 1;
    x2_up[z] = x2[r] | shift_y(x2[r], x2[r + 1]);
    x2_down[z] = x2[r] | shift_y_back(x2[r], x2[r - 1]);
    x2_all[z] = x2_up[z] | x2_down[z];
    x3_up[z] = x3[r] | shift_y(x3[r], x3[r + 1]);
    x3_all[z] = x3_up[z] | shift_y_back(x3[r], x3[r - 1]);
  }
  const auto up = [](const Word *w) { return w[1] | shift_z(w[1], w[2]); };
  const auto down = [](const Word *w) { return w[1] | shift_z_back(w[1], w[0]); };
  constexpr int kOwnRow = 4;
  const Word first = own[kOwnRow], first_y = shift_y(own[4], own[5]);
  edges[0] = (up(x2_all) | down(x2_all)) & ~(first | next[kOwnRow]);
  edges[1] = (up(x3_up) | down(x3_up)) & ~(first | first_y);
  edges[2] = up(x3_all) & ~(first | shift_z(own[4], own[7]));
  edges[3] = (up(x2_up) | down(x2_up)) & ~(first | shift_y(next[4], next[5]));
  edges[4] = (up(x2_down) | down(x2_down)) & ~(first | shift_y_back(next[4], next[3]));
  edges[5] = up(x2_all) & ~(first | shift_z(next[4], next[7]));
  edges[6] = down(x2_all) & ~(first | shift_z_back(next[4], next[1]));
  edges[7] = up(x3_up) & ~(first | shift_z(first_y, shift_y(own[7], own[8])));
  edges[8] = down(x3_up) & ~(first | shift_z_back(first_y, shift_y(own[1], own[2])));
}
// Those of one leaf, if there is any.
QSES_FN bool find_wall_candidates(const LeafNeighborhood &n, uint64_t edges[kWallSteps]) {
  uint64_t any = 0, left = 0;
  for (int k = 0; k < kNeighborhood; ++k) any |= n.at[k];
  if (any == 0 || n.at[kOwnPlace] == ~uint64_t(0)) return false;
  list_wall_candidates(n, edges);
  for (int k = 0; k < kWallSteps; ++k) left |= edges[k];
  return left != 0;
}

// The nearest place where the probe's centre may be, as far as that matters: a point is outside because of it.
// distance: 0 outside all balls, kFarAway in the solid.
struct NearestProbe {
  Vec3<float> center;
  float distance;
};

// Where a point is outside all balls or in the solid, the ball it is deepest in tells so.
QSES_FN bool tells_probe(const SurfaceParameters &p, const DeepestAtom &deepest) {
  return deepest.depth <= p.least_depth() || deepest.depth > p.depth;
}
QSES_FN NearestProbe told_probe(const SurfaceParameters &p, const DeepestAtom &deepest, const Vec3<float> &x) {
  return {x, deepest.depth > p.depth ? kFarAway : 0.f};
}
QSES_FN NearestProbe probe_on_atom(const FeatureView &f, const DeepestAtom &deepest, const Vec3<float> &x) {
  return {boundary_on_atom(load(f.atoms.items + deepest.atom), deepest.depth, x, true).position, deepest.depth};
}
QSES_FN NearestProbe probe_on_arc(const FeatureView &f, const NearestArc &nearest, const Vec3<float> &x) {
  if (nearest.distance2 > f.parameters.depth * f.parameters.depth) return {x, kFarAway};
  const BoundaryPoint y = boundary_on_arc(load(f.arcs + nearest.arc), x);
  return {y.position, y.distance};
}

template <class Candidates>
QSES_FN NearestProbe nearest_probe(const FeatureView &f, const Candidates &candidates, const Vec3<float> &x) {
  const DeepestAtom deepest = deepest_atom(f, candidates, x);
  if (tells_probe(f.parameters, deepest)) return told_probe(f.parameters, deepest, x);
  if (is_on_contact(f, candidates, deepest, x)) return probe_on_atom(f, deepest, x);
  return probe_on_arc(f, nearest_arc(f, candidates, x), x);
}

// Is the other end of an edge in the ball of the probe of this one? Then so is all of the edge.
QSES_FN bool probe_covers(const SurfaceParameters &p, const NearestProbe &probe, const Vec3<float> &x) {
  return probe.distance > p.depth || length_squared(x - probe.center) < p.depth * p.depth;
}
// For each step from a point, use(step, along, left): the ball of a probe, whose squared radius that is, covers the
// point there if along < left, and the one a step back if -along < left.
template <class T, class Use>
QSES_FN void look_around(float spacing, const Vec3<T> &from_probe, T radius2, const Use &use) {
  // |v + h s|^2 = |v|^2 + 2 h v s + h^2 s^2
  const T h2(spacing * spacing), left_axis = radius2 - length_squared(from_probe) - h2, left_diagonal = left_axis - h2;
  const Vec3<T> v = from_probe * T(2.f * spacing);
  use(0, v.x, left_axis);
  use(1, v.y, left_axis);
  use(2, v.z, left_axis);
  use(3, v.x + v.y, left_diagonal);
  use(4, v.x - v.y, left_diagonal);
  use(5, v.x + v.z, left_diagonal);
  use(6, v.x - v.z, left_diagonal);
  use(7, v.y + v.z, left_diagonal);
  use(8, v.y - v.z, left_diagonal);
}

// How far from x, which it covers, in a direction of length 1, the ball of a probe ends.
QSES_FN float way_out(const SurfaceParameters &p, const NearestProbe &probe, const Vec3<float> &x,
                      const Vec3<float> &direction) {
  const Vec3<float> from = x - probe.center;
  const float along = dot(from, direction), outside = length_squared(from) - p.depth * p.depth;
  return square_root(maximum(0.f, along * along - outside)) - along;
}

// An edge on its way through balls of probes: how far from the first end it is open, and from where on to the second.
// So far behind a ball the next point is looked at, in Å, so that a shorter wall may be passed over. An edge with more
// balls than so many on it is open.
constexpr float kWallStep = 1e-3f;
constexpr int kMostWallSteps = 12;
// Before the first two, the middle of what is left: its probe covers all of that on most edges that are open.
constexpr int kMiddleLooks = 2, kMostWallLooks = kMostWallSteps + kMiddleLooks;
struct WallWalk {
  float at, end;
  QSES_FN bool is_open() const { return !(at + kWallStep < end); }
  // Where to look next.
  QSES_FN float next(int look) const {
    const bool middle = look < 2 * kMiddleLooks && look % 2 == 0;
    return middle ? 0.5f * (at + end) : at + kWallStep;
  }
  // A probe covers it from one place to another, between which the last look was.
  QSES_FN void open(float from, float to) {
    if (to >= end) end = minimum(end, from);
    if (from <= at + kWallStep) at = maximum(at, to);
  }
};

// By the probes of both ends, of which that of the first does not cover the second.
QSES_FN WallWalk begin_wall_walk(const SurfaceParameters &p, int step, const Vec3<float> &a,
                                 const NearestProbe &probe_a, const Vec3<float> &b, const NearestProbe &probe_b) {
  if (probe_covers(p, probe_b, a)) return {0.f, 0.f};
  const Vec3<float> direction = wall_direction(step);
  return {way_out(p, probe_a, a, direction),
          wall_step_length(step) * p.spacing - way_out(p, probe_b, b, direction * -1.f)};
}

// By the probe of the point that was looked at, which it covers.
QSES_FN void walk_through(const SurfaceParameters &p, const NearestProbe &probe, const Vec3<float> &x, int step,
                          float at, WallWalk *walk) {
  const Vec3<float> direction = wall_direction(step);
  const float before = way_out(p, probe, x, direction * -1.f), behind = way_out(p, probe, x, direction);
  walk->open(at - maximum(0.f, before), at + maximum(0.f, behind));  // never without x itself
}

// What no probe at an end of an edge covers: from one point to another.
struct WallRest {
  Vec3<float> from, to;
};
QSES_FN WallRest rest_of_walk(const WallWalk &walk, int step, const Vec3<float> &a) {
  const Vec3<float> direction = wall_direction(step);
  return {a + direction * walk.at, a + direction * walk.end};
}
// Is that in the ball of a probe that is known from another point? Not by a hair, so that a walk would find no wall
// either.
QSES_FN bool covers_rest(const SurfaceParameters &p, const Vec3<float> &probe, const WallRest &rest) {
  const float clear = p.depth - kWallStep;
  return length_squared(rest.from - probe) < clear * clear && length_squared(rest.to - probe) < clear * clear;
}

// Which end of a wall is marked: the deeper one; of two that are as deep but for rounding, the first.
QSES_FN bool marks_first_end(const NearestProbe &probe_a, const NearestProbe &probe_b) {
  return probe_a.distance >= probe_b.distance - 1e-4f;
}

// Marks a point, counted from the first one of a brick, in the words of its brick.
QSES_FN void mark_wall(const BrickSet &bricks, uint32_t brick, const glm::ivec3 &p, uint64_t *marks) {
  const LocatedPoint at = bricks.locate(brick, p);
  if (at.brick >= 0) atomic_or(marks + at.word(), uint64_t(1) << at.bit);
}

struct AddMarks {
  const uint64_t *marks;
  uint64_t *signs;
  QSES_HOST_DEVICE void operator()(size_t i) const { signs[i] |= marks[i]; }
};

}  // namespace quickses
