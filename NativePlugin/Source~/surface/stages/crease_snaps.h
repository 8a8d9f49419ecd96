// SPDX-License-Identifier: MIT
// Moves vertices onto creases that are near, where no triangle would be folded or pressed flat.
#pragma once

#include "surface/stages/crease_edges.h"
#include "surface/stages/triangle_angles.h"

namespace quickses {

// The end that wants to be moved onto the crease: 0, 1, or -1 for neither.
QSES_FN int end_to_snap(const CreasePoint &p, float length) {
  if (p.kind != CreasePoint::kCrossed) return -1;
  const bool first = p.first_fits && p.to_first < kSnapPart * length;
  const bool second = p.second_fits && p.to_second < kSnapPart * length;
  if (first && (!second || p.to_first <= p.to_second)) return 0;
  return second ? 1 : -1;
}

QSES_FN uint32_t bits_of(float positive) {
  uint32_t bits;
  memcpy(&bits, &positive, sizeof bits);
  return bits;
}

// Where vertices are to be moved: to the nearest of the points that want them; of two as near, to that of the first
// edge.
struct Snaps {
  uint32_t *nearest;  // [vertex]: bits of the distance
  uint32_t *edge;     // [vertex]: whose point it is, or kNoNumber
  uint8_t *refused;   // [vertex]: 1 if a triangle would suffer

  QSES_FN bool moved(uint32_t v) const { return edge[v] != kNoNumber && !refused[v]; }
};

struct EdgeOfSnap {
  EdgeTable table;
  const CreasePoint *points;
  Snaps snaps;
  // Calls use(vertex, distance) if an end of the edge wants to be moved.
  template <class Use>
  QSES_FN void with_end(size_t edge, const Use &use) const {
    const CreasePoint &p = points[edge];
    const int end = end_to_snap(p, p.to_first + p.to_second);
    if (end == 0) use(table.firsts[edge], p.to_first);
    if (end == 1) use(table.seconds[edge], p.to_second);
  }
};
struct FindNearestSnap : EdgeOfSnap {
  QSES_HOST_DEVICE void operator()(size_t edge) const {
    with_end(edge, [&](uint32_t v, float distance) { atomic_min(snaps.nearest + v, bits_of(distance)); });
  }
};
struct ChooseSnap : EdgeOfSnap {
  QSES_HOST_DEVICE void operator()(size_t edge) const {
    with_end(edge, [&](uint32_t v, float distance) {
      if (snaps.nearest[v] == bits_of(distance)) atomic_min(snaps.edge + v, static_cast<uint32_t>(edge));
    });
  }
};

// A triangle that a snap would fold, or press flat, keeps its corners.
constexpr float kLeastSnapTurn = 0.3f;     // cosine between its normals before and after
constexpr float kSnapAngleCosine = 0.97f;  // 14 degrees

struct TouchedBySnap {
  MeshParts mesh;
  const uint32_t *edge;
  QSES_HOST_DEVICE bool operator()(size_t i) const {
    const uint32_t *const t = mesh.triangle(static_cast<uint32_t>(i));
    return edge[t[0]] != kNoNumber || edge[t[1]] != kNoNumber || edge[t[2]] != kNoNumber;
  }
};

struct RefuseSnaps {
  MeshParts mesh;
  Lattice lattice;
  const uint32_t *list;
  const CreasePoint *points;
  Snaps snaps;
  uint8_t *near;  // [triangle]: those at moved vertices are near creases now
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t *const t = mesh.triangle(list[i]);
    near[list[i]] = 1;
    Vec3<float> before[3], after[3];
    bool any = false;
    for (int k = 0; k < 3; ++k) {
      before[k] = after[k] = centered_position(lattice, mesh.with(t[k]).position(t[k]));
      if (snaps.edge[t[k]] == kNoNumber) continue;
      after[k] = points[snaps.edge[t[k]]].position;
      any = true;
    }
    if (!any) return;
    const Vec3<float> old = cross(before[1] - before[0], before[2] - before[0]);
    const Vec3<float> now = cross(after[1] - after[0], after[2] - after[0]);
    const bool turned = !(dot(old, now) > kLeastSnapTurn * square_root(length_squared(old) * length_squared(now)));
    const float was = least_cosine_of_angles(before[0], before[1], before[2]);
    const float is = least_cosine_of_angles(after[0], after[1], after[2]);
    if (!turned && is <= maximum(kSnapAngleCosine, was)) return;
    for (int k = 0; k < 3; ++k)
      if (snaps.edge[t[k]] != kNoNumber) atomic_set(snaps.refused + t[k]);
  }
};

struct SnapVertices {
  MeshParts mesh;
  Lattice lattice;
  EdgeTable table;
  const CreasePoint *points;
  Snaps snaps;
  QSES_HOST_DEVICE void operator()(size_t e) const {
    const uint32_t ends[2] = {table.firsts[e], table.seconds[e]};
    for (int k = 0; k < 2; ++k)
      if (snaps.edge[ends[k]] == e && snaps.moved(ends[k])) put_on_crease(mesh, lattice, ends[k], points[e]);
  }
};

// Where ends were moved the edge is another one.
template <class Sheets>
struct SolveMovedEdges {
  SolveEdges<Sheets> solve;
  Snaps snaps;
  QSES_HOST_DEVICE void operator()(size_t edge) const {
    if (snaps.moved(solve.table.firsts[edge]) || snaps.moved(solve.table.seconds[edge])) solve(edge);
  }
};

}  // namespace quickses
