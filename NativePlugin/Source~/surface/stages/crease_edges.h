// SPDX-License-Identifier: MIT
// The edges of a closed mesh that cross creases or run along them, each found once, and the point of the crease at
// each.
#pragma once

#include "parallel/atomics.h"
#include "surface/stages/creases.h"

namespace quickses {

constexpr uint32_t kNoNumber = ~uint32_t(0);

// Steps of a thread for an edge: it looks at so many atoms and arcs at most, a few times.
constexpr uint64_t kCreaseSteps = uint64_t(1) << 15;

// Edges of the triangles of a list, each met once: a closed mesh has it from its smaller to its larger vertex in one of
// its triangles. They are found again by the smaller vertex.
struct EdgeTable {
  uint32_t *starts;   // [vertex], and the total: edges of smaller vertices
  uint32_t *seconds;  // [edge]: the larger vertex; in order for each smaller one
  uint32_t *firsts;   // [edge]

  QSES_FN uint32_t find(uint32_t u, uint32_t v) const {
    const uint32_t low = u < v ? u : v, high = u < v ? v : u;
    for (uint32_t k = starts[low]; k < starts[low + 1]; ++k)
      if (seconds[k] == high) return k;
    return kNoNumber;
  }
};

// What a round may do.
struct SplitRound {
  bool snap;   // vertices may be moved to a crease that is near
  bool along;  // edges along creases are split, too, and triangles over corners
};

// Triangles that have something to do with creases.
template <class Sheets>
struct FindNearCrease {
  MeshParts mesh;
  Sheets sheets;
  bool along;
  size_t known;   // triangles that another round looked at: no others of these come into question
  uint8_t *near;  // [triangle]
  QSES_HOST_DEVICE void operator()(size_t i) const {
    if (i < known && !near[i]) return;
    near[i] = sheets.is_near_crease(mesh, mesh.triangle(static_cast<uint32_t>(i)), along) ? 1 : 0;
  }
};
struct CopyMarks {
  const uint8_t *from;
  uint8_t *to;
  QSES_HOST_DEVICE void operator()(size_t i) const { to[i] = from[i]; }
};
struct IsMarked {
  const uint8_t *marks;
  QSES_HOST_DEVICE bool operator()(size_t i) const { return marks[i] != 0; }
};

// Edges of a triangle that may have to be split, as bits: k is that from corner k to the next.
template <class Sheets>
struct ChooseEdges {
  MeshParts mesh;
  Sheets sheets;
  SplitRound round;
  const uint32_t *list;
  uint8_t *chosen;  // [list]
  uint32_t *count;  // [vertex]
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t *const t = mesh.triangle(list[i]);
    uint8_t bits = 0;
    for (int k = 0; k < 3; ++k) {
      const uint32_t a = t[k], b = t[k == 2 ? 0 : k + 1], u = a < b ? a : b, v = a < b ? b : a;
      const bool crest = round.along && mesh.on_crease(u) && mesh.on_crease(v);
      if (!crest && !sheets.may_cross(mesh, u, v)) continue;
      bits |= uint8_t(1u << k);
      if (a < b) atomic_add(count + a, uint32_t(1));
    }
    chosen[i] = bits;
  }
};

struct ListEdges {
  MeshParts mesh;
  const uint32_t *list;
  const uint8_t *chosen;
  const uint32_t *starts;
  uint32_t *taken;    // [vertex]
  uint32_t *seconds;  // in any order for each first
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t *const t = mesh.triangle(list[i]);
    for (int k = 0; k < 3; ++k) {
      const uint32_t a = t[k], b = t[k == 2 ? 0 : k + 1];
      if (!(chosen[i] >> k & 1) || a > b) continue;
      seconds[starts[a] + atomic_add(taken + a, uint32_t(1))] = b;
    }
  }
};

// Orders the edges of each first vertex by the second.
struct OrderEdges {
  const uint32_t *unordered;
  EdgeTable table;
  QSES_HOST_DEVICE void operator()(size_t vertex) const {
    const uint32_t begin = table.starts[vertex], end = table.starts[vertex + 1];
    for (uint32_t k = begin; k < end; ++k) {
      uint32_t place = begin;
      for (uint32_t j = begin; j < end; ++j)
        if (unordered[j] < unordered[k]) ++place;
      table.seconds[place] = unordered[k];
      table.firsts[place] = static_cast<uint32_t>(vertex);
    }
  }
};

template <class Sheets>
struct SolveEdges {
  MeshParts mesh;
  Sheets sheets;
  EdgeTable table;
  bool along;
  CreasePoint *points;  // [edge]
  QSES_HOST_DEVICE void operator()(size_t edge) const {
    const uint32_t u = table.firsts[edge], v = table.seconds[edge];
    points[edge] = sheets.solve(end_of_vertex(mesh, sheets.lattice, u), end_of_vertex(mesh, sheets.lattice, v), along);
  }
};

}  // namespace quickses
