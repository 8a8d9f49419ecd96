// SPDX-License-Identifier: MIT
// Splits edges of a closed mesh: each edge at most once per round, and in both of its triangles, so that the mesh stays
// closed whatever the places are. Sheets say what to split and where (creases.h).
#pragma once

#include "parallel/atomics.h"
#include "surface/mesh/mesh_parts.h"
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

// ---- snapping --------------------------------------------------------------------------------------------------

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

QSES_FN float least_cosine_of_angles(const Vec3<float> &a, const Vec3<float> &b, const Vec3<float> &c) {
  const Vec3<float> ab = b - a, bc = c - b, ca = a - c;
  const float u = length_squared(ab), v = length_squared(bc), w = length_squared(ca);
  const float at_a = -dot(ab, ca) * reciprocal_root(maximum(u * w, 1e-30f));
  const float at_b = -dot(ab, bc) * reciprocal_root(maximum(u * v, 1e-30f));
  const float at_c = -dot(bc, ca) * reciprocal_root(maximum(v * w, 1e-30f));
  return maximum(at_a, maximum(at_b, at_c));  // of the smallest angle
}

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

// Writes a vertex onto a crease. Positions of a mesh are the caller's.
QSES_FN void put_on_crease(const MeshParts &mesh, const Lattice &lattice, uint32_t vertex, const CreasePoint &p) {
  const int k = mesh.part_with(vertex);
  const MeshView &view = mesh.part[k];
  store_vec3(view.position(vertex), Vec3<float>(lattice.to_caller(p.position)));
  store_vec3(view.normal(vertex), p.normal);
  store_vec3(view.second_normal(vertex), p.second_normal);
  view.owner(vertex) = p.owner;
  if (view.patches) view.patch(vertex) = static_cast<uint8_t>(p.patch);
  mesh.marks[k].second_owners[view.place(vertex)] = p.second_owner;
  mesh.marks[k].on_crease[view.place(vertex)] = 1;
}

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

// ---- splitting -------------------------------------------------------------------------------------------------

// An edge is not split too near to an end.
QSES_FN bool is_split(const CreasePoint &p) {
  if (p.kind == CreasePoint::kNone) return false;
  return minimum(p.to_first, p.to_second) >= kLeastPart * (p.to_first + p.to_second);
}
struct CountSplit {
  const CreasePoint *points;
  QSES_HOST_DEVICE uint64_t operator()(size_t edge) const { return is_split(points[edge]) ? 1 : 0; }
};

// The triangles that one becomes: corners 0, 1, 2 are its own, 3 + k is on the edge from corner k, 6 is within.
struct Pieces {
  uint8_t corner[6][3];
  int count;
};

template <class Position>  // position(corner)
QSES_FN Pieces cut_triangle(bool on0, bool on1, bool on2, bool within, const Position &position) {
  Pieces p{};
  const bool on[3] = {on0, on1, on2};
  const int splits = int(on0) + int(on1) + int(on2);
  const auto add = [&](int a, int b, int c) {
    p.corner[p.count][0] = static_cast<uint8_t>(a);
    p.corner[p.count][1] = static_cast<uint8_t>(b);
    p.corner[p.count++][2] = static_cast<uint8_t>(c);
  };
  if (within) {
    for (int k = 0; k < 3; ++k) {
      const int next = k == 2 ? 0 : k + 1;
      if (on[k]) {
        add(k, 3 + k, 6);
        add(3 + k, next, 6);
      } else {
        add(k, next, 6);
      }
    }
    return p;
  }
  if (splits == 0) {
    add(0, 1, 2);
  } else if (splits == 1) {
    const int k = on0 ? 0 : on1 ? 1 : 2, b = (k + 1) % 3, c = (k + 2) % 3;
    add(k, 3 + k, c);
    add(3 + k, b, c);
  } else if (splits == 2) {
    // The corner between the two edges is cut off; of the diagonals of the rest, that with the larger angles.
    const int k = !on0 ? 0 : !on1 ? 1 : 2, a = k, b = (k + 1) % 3, c = (k + 2) % 3, p1 = 3 + b, p2 = 3 + c;
    add(p2, p1, c);
    const Vec3<float> xa = position(a), xb = position(b), x1 = position(p1), x2 = position(p2);
    const float first = maximum(least_cosine_of_angles(xa, xb, x1), least_cosine_of_angles(xa, x1, x2));
    const float second = maximum(least_cosine_of_angles(xa, xb, x2), least_cosine_of_angles(xb, x1, x2));
    if (first <= second) {
      add(a, b, p1);
      add(a, p1, p2);
    } else {
      add(a, b, p2);
      add(b, p1, p2);
    }
  } else {
    add(3, 4, 5);
    add(0, 3, 5);
    add(1, 4, 3);
    add(2, 5, 4);
  }
  return p;
}

// The splits of a triangle of the list: edges that are split, and whether there is a vertex within.
struct TriangleSplits {
  uint32_t edge[3];  // kNoNumber: not split
  bool within;
  QSES_FN int edges() const {
    return int(edge[0] != kNoNumber) + int(edge[1] != kNoNumber) + int(edge[2] != kNoNumber);
  }
  QSES_FN int new_triangles() const { return within ? 2 + edges() : edges(); }
};

struct FindSplits {
  MeshParts mesh;
  EdgeTable table;
  const uint32_t *list;
  const uint8_t *chosen;
  const CreasePoint *points;   // [edge]
  const CreasePoint *corners;  // [list], or nullptr
  QSES_FN TriangleSplits operator()(size_t i) const {
    const uint32_t *const t = mesh.triangle(list[i]);
    TriangleSplits s{{kNoNumber, kNoNumber, kNoNumber}, false};
    for (int k = 0; k < 3; ++k) {
      if (!(chosen[i] >> k & 1)) continue;
      const uint32_t e = table.find(t[k], t[k == 2 ? 0 : k + 1]);
      if (e != kNoNumber && is_split(points[e])) s.edge[k] = e;
    }
    s.within = corners && corners[i].kind != CreasePoint::kNone;
    return s;
  }
};
struct CountNewTriangles {
  FindSplits find;
  QSES_HOST_DEVICE uint64_t operator()(size_t i) const { return static_cast<uint64_t>(find(i).new_triangles()); }
};

// What splits depend on: refusals come in passes, and only what another one left changed is looked at again.
struct Refusals {
  const uint8_t *before;  // [edge]: 1 where the pass before refused a split; nullptr: this is the first
  uint8_t *now;

  QSES_FN bool concern(const EdgeTable &table, const uint32_t *t, uint8_t chosen) const {
    if (!before) return true;
    for (int k = 0; k < 3; ++k) {
      if (!(chosen >> k & 1)) continue;
      const uint32_t e = table.find(t[k], t[k == 2 ? 0 : k + 1]);
      if (e != kNoNumber && before[e]) return true;
    }
    return false;
  }
};

// A triangle over a place where three creases meet gets a vertex there: one that has points on all three of them.
template <class Sheets>
struct SolveCorners {
  FindSplits find;
  Sheets sheets;
  Lattice lattice;
  CreasePoint *corners;  // [list]
  Refusals refusals;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t *const t = find.mesh.triangle(find.list[i]);
    if (!refusals.before) corners[i].kind = CreasePoint::kNone;
    int creases = popcount64(find.chosen[i]);
    for (int k = 0; k < 3; ++k) creases += find.mesh.on_crease(t[k]) ? 1 : 0;
    if (!Sheets::kHasCorners || creases < 3 || !refusals.concern(find.table, t, find.chosen[i])) return;
    corners[i].kind = CreasePoint::kNone;
    const TriangleSplits s = find(i);
    uint32_t pair[6][2];
    Vec3<float> place[6], ends[3];
    int count = 0;
    for (int k = 0; k < 6; ++k) {
      CreaseEnd c;
      if (k < 3) {
        c = end_of_vertex(find.mesh, lattice, t[k]);
        ends[k] = c.position;
        if (c.owner == c.second_owner) continue;
      } else {
        if (s.edge[k - 3] == kNoNumber) continue;
        c = end_of_point(find.points[s.edge[k - 3]]);
      }
      const uint32_t low = c.owner < c.second_owner ? c.owner : c.second_owner,
                     high = c.owner < c.second_owner ? c.second_owner : c.owner;
      bool known = false;
      for (int j = 0; j < count; ++j) known |= pair[j][0] == low && pair[j][1] == high;
      if (known) continue;
      place[count] = c.position;
      pair[count][0] = low;
      pair[count++][1] = high;
    }
    for (int a = 0; a < count; ++a)
      for (int b = a + 1; b < count; ++b) {
        // The third pair of what two pairs with one sheet in common name.
        const bool first = pair[a][0] == pair[b][0] || pair[a][0] == pair[b][1];
        const bool second = pair[a][1] == pair[b][0] || pair[a][1] == pair[b][1];
        if (first == second) continue;
        const uint32_t common = pair[a][first ? 0 : 1], x = pair[a][first ? 1 : 0],
                       y = pair[b][pair[b][0] == common ? 1 : 0];
        for (int c = b + 1; c < count; ++c) {
          if (!((pair[c][0] == x && pair[c][1] == y) || (pair[c][0] == y && pair[c][1] == x))) continue;
          const uint32_t owners[3] = {common, x, y};
          const float size2 = maximum(length_squared(ends[1] - ends[0]),
                                      maximum(length_squared(ends[2] - ends[0]), length_squared(ends[2] - ends[1])));
          const CreasePoint p =
              sheets.solve_corner(owners, (place[a] + place[b] + place[c]) * (1.f / 3.f), square_root(size2));
          const float least2 = kLeastPart * kLeastPart * size2;
          for (int k = 0; k < count; ++k)
            if (length_squared(place[k] - p.position) < least2) return;  // it has one there
          corners[i] = p;
          return;
        }
      }
  }
};
struct CountCorner {
  const CreasePoint *corners;
  QSES_HOST_DEVICE uint64_t operator()(size_t i) const { return corners[i].kind != CreasePoint::kNone ? 1 : 0; }
};

// Where splits would fold a triangle, its edges are left as they are.
template <class Sheets>
struct RefuseSplits {
  FindSplits find;
  Sheets sheets;
  Lattice lattice;
  Refusals refusals;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t *const t = find.mesh.triangle(find.list[i]);
    if (find.chosen[i] == 0 || !refusals.concern(find.table, t, find.chosen[i])) return;
    const TriangleSplits s = find(i);
    if (s.edges() == 0) return;
    CreaseEnd corner[7];
    for (int k = 0; k < 3; ++k) {
      corner[k] = end_of_vertex(find.mesh, lattice, t[k]);
      if (s.edge[k] != kNoNumber) corner[3 + k] = end_of_point(find.points[s.edge[k]]);
    }
    if (s.within) corner[6] = end_of_point(find.corners[i]);
    const Pieces pieces = cut_triangle(s.edge[0] != kNoNumber, s.edge[1] != kNoNumber, s.edge[2] != kNoNumber, s.within,
                                       [&](int k) { return corner[k].position; });
    const float sign = find.mesh.part[0].reversed ? -1.f : 1.f;
    bool bad = false;
    for (int p = 0; p < pieces.count && !bad; ++p) {
      const CreaseEnd *const c[3] = {corner + pieces.corner[p][0], corner + pieces.corner[p][1],
                                     corner + pieces.corner[p][2]};
      const Vec3<float> normal = cross(c[1]->position - c[0]->position, c[2]->position - c[0]->position) * sign;
      bad = least_cosine_of_angles(c[0]->position, c[1]->position, c[2]->position) > Sheets::kFlatCosine ||
            sheets.is_folded(c, normal);
    }
    if (!bad) return;
    for (int k = 0; k < 3; ++k)
      if (s.edge[k] != kNoNumber) atomic_set(refusals.now + s.edge[k]);
  }
};
struct DropRefused {
  const uint8_t *refused;
  CreasePoint *points;
  QSES_HOST_DEVICE void operator()(size_t edge) const {
    if (refused[edge]) points[edge].kind = CreasePoint::kNone;
  }
};

// New vertices: those of edges in the order of these, then those within triangles in the order of those.
struct AddVertex {
  MeshParts mesh;
  Lattice lattice;
  const CreasePoint *points;
  const uint32_t *rank;
  uint32_t first;
};
struct AddVertexOnEdge : AddVertex {
  QSES_HOST_DEVICE void operator()(size_t edge) const {
    if (is_split(points[edge])) put_on_crease(mesh, lattice, first + rank[edge], points[edge]);
  }
};
struct AddCorner : AddVertex {
  QSES_HOST_DEVICE void operator()(size_t i) const {
    if (points[i].kind != CreasePoint::kNone) put_on_crease(mesh, lattice, first + rank[i], points[i]);
  }
};

// The first piece of a triangle takes its place, the others come behind all triangles.
struct AddTriangles {
  FindSplits find;
  Lattice lattice;
  const uint32_t *edge_rank, *corner_rank;
  uint32_t first_of_edges, first_of_corners;
  const uint32_t *triangles_before;  // [list]
  uint32_t first_triangle;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const TriangleSplits s = find(i);
    if (s.new_triangles() == 0) return;
    uint32_t *const t = find.mesh.triangle(find.list[i]);
    const uint32_t own[3] = {t[0], t[1], t[2]};
    const auto position = [&](int corner) {
      if (corner < 3) return centered_position(lattice, find.mesh.with(own[corner]).position(own[corner]));
      return find.points[s.edge[corner - 3]].position;
    };
    const Pieces pieces =
        cut_triangle(s.edge[0] != kNoNumber, s.edge[1] != kNoNumber, s.edge[2] != kNoNumber, s.within, position);
    const auto number = [&](int corner) {
      if (corner < 3) return own[corner];
      return corner == 6 ? first_of_corners + corner_rank[i] : first_of_edges + edge_rank[s.edge[corner - 3]];
    };
    uint32_t next = first_triangle + triangles_before[i];
    for (int p = 0; p < pieces.count; ++p) {
      uint32_t *const out = p == 0 ? t : find.mesh.triangle(next++);
      for (int k = 0; k < 3; ++k) out[k] = number(pieces.corner[p][k]);
    }
  }
};

// What vertices begin with.
struct MarkVertices {
  MeshView mesh;
  CreaseMarks marks;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t v = mesh.first_vertex + static_cast<uint32_t>(i);
    const float *const n = mesh.normal(v), *const second = mesh.second_normal(v);
    marks.second_owners[i] = mesh.owner(v);
    marks.on_crease[i] = n[0] != second[0] || n[1] != second[1] || n[2] != second[2];
  }
};

// ---- the finished mesh -----------------------------------------------------------------------------------------

struct JoinVertex {
  MeshParts from;
  MeshView to;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t v = static_cast<uint32_t>(i);
    const MeshView &view = from.with(v);
    store_vec3(to.position(v), load_vec3(view.position(v)));
    store_vec3(to.normal(v), load_vec3(view.normal(v)));
    store_vec3(to.second_normal(v), load_vec3(view.second_normal(v)));
    to.owner(v) = view.owner(v);
    if (to.patches) to.patch(v) = view.patch(v);
  }
};
struct JoinTriangle {
  MeshParts from;
  MeshView to;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t *const t = from.triangle(static_cast<uint32_t>(i));
    uint32_t *const out = to.triangle(i);
    for (int k = 0; k < 3; ++k) out[k] = t[k];
  }
};

}  // namespace quickses
