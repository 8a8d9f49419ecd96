// SPDX-License-Identifier: MIT
// Solves edges at creases, and moves their ends onto creases that are near, where no triangle would be folded or
// pressed flat.
#pragma once

#include "surface/stages/crease_edges.h"
#include "surface/stages/triangle_angles.h"

namespace quickses {

// The end that wants to be moved onto the crease: 0, 1, or -1 for neither.
QSES_FN int end_to_snap(const CreasePoint &p) {
  if (p.kind != CreasePoint::kCrossed) return -1;
  static_assert(kSnapPart < 0.5f, "a point is that near to one end at most");
  const float near = kSnapPart * (p.to_first + p.to_second);
  if (p.first_fits && p.to_first < near) return 0;
  return p.second_fits && p.to_second < near ? 1 : -1;
}

// Where vertices are to be moved: to the nearest of the points that want them; of two as near, to that of the first
// edge.
struct Snaps {
  static constexpr uint64_t kNone = ~uint64_t(0);
  uint64_t *nearest;  // [vertex]: the bits of the distance, then the number of the edge; kNone: stays
  CreaseEdges edges;

  QSES_FN static uint64_t key(float distance, uint32_t edge) {  // distance: not negative
    uint32_t bits;
    memcpy(&bits, &distance, sizeof bits);
    return uint64_t(bits) << 32 | edge;
  }
  QSES_FN bool is_wanted(uint32_t v) const { return nearest[v] != kNone; }
  QSES_FN uint32_t edge(uint32_t v) const { return static_cast<uint32_t>(nearest[v]); }
  QSES_FN bool is_moved(uint32_t v) const { return is_wanted(v) && !edges.snap_refused[edge(v)]; }
};

// The points of the edges; and what is near one of them wants to be moved there. Once ends were moved, those of the
// edges from them again.
template <class Sheets>
struct SolveEdges {
  CreasedMesh mesh;
  Sheets sheets;
  SplitRound round;
  CreaseEdges edges;
  Snaps snaps;
  bool ends_were_moved;

  // near_by: gathers what is near a point (stages/local_features.h).
  template <class NearBy>
  QSES_FN void operator()(NearBy &near_by, size_t i) const {
    if (i >= edges.count()) return;
    if (ends_were_moved && !snaps.is_moved(edges.firsts[i]) && !snaps.is_moved(edges.seconds[i])) return;
    const CreasePoint p =
        sheets.solve(near_by, end_of_vertex(mesh, sheets.lattice, edges.firsts[i]),
                     end_of_vertex(mesh, sheets.lattice, edges.seconds[i]), round == SplitRound::kLast);
    edges.points[i] = p;
    edges.refused[i] = is_split(p) ? 0 : CreaseEdges::kNeverSplit;
    if (round != SplitRound::kFirst || ends_were_moved) return;
    const int end = end_to_snap(p);
    const uint32_t e = static_cast<uint32_t>(i);
    if (end == 0) atomic_min(snaps.nearest + edges.firsts[e], Snaps::key(p.to_first, e));
    if (end == 1) atomic_min(snaps.nearest + edges.seconds[e], Snaps::key(p.to_second, e));
  }
};

// A triangle that a snap would fold, or press flat, keeps its corners.
constexpr float kLeastSnapTurn = 0.3f;     // cosine between its normals before and after
constexpr float kSnapAngleCosine = 0.97f;  // 14 degrees

struct RefuseSnaps {
  CreasedMesh mesh;
  Lattice lattice;
  Snaps snaps;
  QSES_FN void operator()(size_t i) const {
    const uint32_t triangle = static_cast<uint32_t>(i), *const t = mesh.triangle(triangle);
    const bool wanted[3] = {snaps.is_wanted(t[0]), snaps.is_wanted(t[1]), snaps.is_wanted(t[2])};
    if (!wanted[0] && !wanted[1] && !wanted[2]) return;
    mesh.near_marks[triangle] = 1;
    Vec3<float> before[3], after[3];
    for (int k = 0; k < 3; ++k) {
      before[k] = after[k] = lattice.from_caller(mesh.position(t[k]));
      if (wanted[k]) after[k] = snaps.edges.points[snaps.edge(t[k])].position;
    }
    const Vec3<float> old = cross(before[1] - before[0], before[2] - before[0]);
    const Vec3<float> now = cross(after[1] - after[0], after[2] - after[0]);
    const bool turned = !(dot(old, now) > kLeastSnapTurn * square_root(length_squared(old) * length_squared(now)));
    const float was = least_cosine_of_angles(before[0], before[1], before[2]);
    const float is = least_cosine_of_angles(after[0], after[1], after[2]);
    if (!turned && is <= maximum(kSnapAngleCosine, was)) return;
    for (int k = 0; k < 3; ++k)
      if (wanted[k]) atomic_set(snaps.edges.snap_refused + snaps.edge(t[k]));
  }
};

struct SnapVertices {
  CreasedMesh mesh;
  Lattice lattice;
  Snaps snaps;
  QSES_FN void operator()(size_t i) const {
    const CreaseEdges &edges = snaps.edges;
    if (i >= edges.count() || edges.snap_refused[i]) return;
    const int end = end_to_snap(edges.points[i]);
    if (end < 0) return;
    const uint32_t v = end == 0 ? edges.firsts[i] : edges.seconds[i];
    if (snaps.edge(v) == i) put_on_crease(mesh, lattice, v, edges.points[i]);
  }
};

}  // namespace quickses
