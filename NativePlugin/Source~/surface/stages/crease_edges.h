// SPDX-License-Identifier: MIT
// The edges of a closed mesh that cross creases or run along them, each found once, and the point of the crease at
// each.
#pragma once

#include "parallel/atomics.h"
#include "surface/stages/creases.h"

namespace quickses {

// Steps of a thread for an edge: it looks at so many atoms and arcs at most, a few times.
constexpr uint64_t kCreaseSteps = uint64_t(1) << 15;

// The passes of creases are inlined into their kernels (QSES_FN), since they are large: a function that is called would
// get them by way of memory, a copy for each thread.

// In the first round vertices may be moved to a crease that is near; in the last one edges along creases are split,
// too, and triangles over corners.
enum class SplitRound { kFirst, kLast };

// The triangles that a round looks at: some of those that were there before the last one, and all that this one made.
struct NearTriangles {
  const uint32_t *old_ones;
  uint32_t old_count, first_new;
  QSES_FN uint32_t operator()(size_t i) const {
    return i < old_count ? old_ones[i] : first_new + static_cast<uint32_t>(i - old_count);
  }
};

// Marks the triangles that have something to do with creases, in any round: vertices may be on some from the beginning.
template <class Sheets>
struct MarkNearTriangles {
  CreasedMesh mesh;
  Sheets sheets;
  QSES_FN void operator()(size_t i) const {
    const uint32_t t = static_cast<uint32_t>(i);
    mesh.near_marks[t] = sheets.is_near_crease(mesh, mesh.triangle(t), true) ? 1 : 0;
  }
};
struct IsMarked {
  const uint8_t *marks;
  QSES_FN bool operator()(size_t i) const { return marks[i] != 0; }
};

// An edge belongs to the triangle in which it goes from its smaller to its larger vertex: of a closed mesh that is one.
QSES_FN bool owns_edge(const uint32_t *t, int k) { return t[k] < t[next_corner(k)]; }

// An edge is not split too near to an end.
QSES_FN bool is_split(const CreasePoint &p) {
  if (p.kind == CreasePoint::kNone) return false;
  return minimum(p.to_first, p.to_second) >= kLeastPart * (p.to_first + p.to_second);
}

// The edges of the listed triangles that may have to be split, in the order of the triangles that they belong to.
struct CreaseEdges {
  const uint32_t *starts;  // [list], and the total: edges of the triangles before
  uint32_t listed;
  uint32_t *firsts, *seconds;  // [edge]: the vertices, the smaller one first
  uint32_t *heads, *nexts;     // [vertex], [edge]: the edges of a first vertex, in any order; kNoNumber: no more
  CreasePoint *points;         // [edge]
  uint8_t *snap_refused;       // [edge]: 1 if a triangle would suffer
  uint8_t *refused;            // [edge]: 0: is split; or the pass that found that this would fold a triangle
  static constexpr uint8_t kNeverSplit = 255;

  QSES_FN uint32_t count() const { return starts[listed]; }  // there is room for half as many again as triangles
  QSES_FN uint32_t find(uint32_t u, uint32_t v) const {
    const uint32_t low = u < v ? u : v, high = u < v ? v : u;
    uint32_t e = heads[low];
    while (e != kNoNumber && seconds[e] != high) e = nexts[e];
    return e;
  }
};

// What is looked for in a triangle of the list: bit k for the edge from corner k to the next, if it belongs to it,
// whether it is near a crease still, and whether it gets a vertex within.
constexpr uint8_t kStillNear = 8, kHasCorner = 16;
template <class Sheets>
struct ChooseEdges {
  CreasedMesh mesh;
  Sheets sheets;
  SplitRound round;
  NearTriangles list;
  uint8_t *chosen;  // [list]
  QSES_FN void operator()(size_t i) const {
    const uint32_t *const t = mesh.triangle(list(i));
    uint8_t bits = 0;
    const bool along = round == SplitRound::kLast;
    if (sheets.is_near_crease(mesh, t, along)) {
      bits = kStillNear;
      for (int k = 0; k < 3; ++k) {
        if (!owns_edge(t, k)) continue;
        const uint32_t u = t[k], v = t[next_corner(k)];
        const bool crest = along && mesh.on_crease(u) && mesh.on_crease(v);
        if (crest || sheets.may_cross(mesh, u, v)) bits |= uint8_t(1u << k);
      }
    }
    chosen[i] = bits;
  }
};
struct CountChosen {
  const uint8_t *chosen;
  QSES_FN uint64_t operator()(size_t i) const { return static_cast<uint64_t>(popcount64(chosen[i] & 7)); }
};

struct ListEdges {
  CreasedMesh mesh;
  NearTriangles list;
  const uint8_t *chosen;
  CreaseEdges edges;
  QSES_FN void operator()(size_t i) const {
    if (!(chosen[i] & 7)) return;
    const uint32_t *const t = mesh.triangle(list(i));
    uint32_t e = edges.starts[i];
    for (int k = 0; k < 3; ++k) {
      if (!(chosen[i] >> k & 1)) continue;
      edges.firsts[e] = t[k];
      edges.seconds[e] = t[next_corner(k)];
      edges.nexts[e] = atomic_exchange(edges.heads + t[k], e);
      edges.snap_refused[e] = 0;
      ++e;
    }
  }
};

}  // namespace quickses
