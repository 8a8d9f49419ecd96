// SPDX-License-Identifier: MIT
// Splits edges of a closed mesh: each edge at most once per round, and in both of its triangles, so that the mesh stays
// closed whatever the places are. Sheets say what to split and where (creases.h).
#pragma once

#include "surface/stages/crease_edges.h"
#include "surface/stages/kept_parts.h"
#include "surface/stages/triangle_angles.h"

namespace quickses {

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
      const int next = next_corner(k);
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

// Passes in which splits are refused that would fold triangles: what is left of the splits of one triangle may fold
// another one. While a pass goes on, what it has refused so far is there still.
constexpr uint8_t kRefusals = 2;

struct FindSplits {
  CreasedMesh mesh;
  NearTriangles list;
  CreaseEdges edges;
  uint8_t *chosen;       // [list]
  uint32_t *edges_of;    // [list]: three of each, or kNoNumber
  CreasePoint *corners;  // [list]: where a triangle has one
  uint8_t pass;          // that goes on; 0: all are over

  QSES_FN uint32_t edge_of(size_t i, int k) const { return edges_of[3 * i + static_cast<size_t>(k)]; }
  QSES_FN TriangleSplits operator()(size_t i) const {
    TriangleSplits s{{kNoNumber, kNoNumber, kNoNumber}, (chosen[i] & kHasCorner) != 0};
    for (int k = 0; k < 3; ++k) {
      const uint32_t e = edge_of(i, k);
      if (e == kNoNumber) continue;
      const uint8_t refused = atomic_load(edges.refused + e);
      if (refused == 0 || refused == pass) s.edge[k] = e;
    }
    return s;
  }
  // Did that pass refuse a split of the triangle?
  QSES_FN bool had_refusal(size_t i, uint8_t in_pass) const {
    for (int k = 0; k < 3; ++k) {
      const uint32_t e = edge_of(i, k);
      if (e != kNoNumber && atomic_load(edges.refused + e) == in_pass) return true;
    }
    return false;
  }
  QSES_FN void leave_out_corner(size_t i) const { chosen[i] &= static_cast<uint8_t>(~kHasCorner); }
  // The listed edges of a triangle.
  QSES_FN void find_edges(size_t i) const {
    const uint32_t *const t = mesh.triangle(list(i));
    uint32_t own = edges.starts[i];
    for (int k = 0; k < 3; ++k) {
      uint32_t e = kNoNumber;
      if (!owns_edge(t, k))
        e = edges.find(t[k], t[next_corner(k)]);
      else if (chosen[i] >> k & 1)
        e = own++;
      edges_of[3 * i + static_cast<size_t>(k)] = e;
    }
  }
};

// A triangle over a place where three creases meet gets a vertex there: one that has points on all three of them.
template <class Sheets>
QSES_FN void find_corner(const FindSplits &find, const Sheets &sheets, size_t i) {
  find.leave_out_corner(i);
  if (!(find.chosen[i] & kStillNear)) return;
  const uint32_t *const t = find.mesh.triangle(find.list(i));
  int creases = 0;
  for (int k = 0; k < 3; ++k) creases += int(find.edge_of(i, k) != kNoNumber) + int(find.mesh.on_crease(t[k]));
  if (creases < 3) return;
  const TriangleSplits s = find(i);

  // The pairs of sheets, the smaller number first, of the corners and the points on the edges. Most have fewer than
  // three: their places are not looked at.
  constexpr int kPoints = 6;
  constexpr uint64_t kNoPair = ~uint64_t(0);
  uint64_t pairs[kPoints];
  int count = 0;
  for (int k = 0; k < kPoints; ++k) {
    uint32_t first = 0, second = 0;
    if (k < 3) {
      first = find.mesh.owner(t[k]);
      second = find.mesh.on_crease(t[k]) ? find.mesh.second_owners[t[k]] : first;
    } else if (s.edge[k - 3] != kNoNumber) {
      const CreasePoint &p = find.edges.points[s.edge[k - 3]];
      first = p.owner;
      second = p.second_owner;
    }
    pairs[k] = first == second  ? kNoPair
               : first < second ? uint64_t(first) << 32 | second
                                : uint64_t(second) << 32 | first;
    for (int j = 0; j < k; ++j)
      if (pairs[j] == pairs[k]) pairs[k] = kNoPair;
    count += pairs[k] != kNoPair ? 1 : 0;
  }
  if (count < 3) return;

  uint32_t pair[kPoints][2];
  Vec3<float> place[kPoints], ends[3];
  count = 0;
  for (int k = 0; k < kPoints; ++k) {
    if (k < 3) ends[k] = sheets.lattice.from_caller(find.mesh.position(t[k]));
    if (pairs[k] == kNoPair) continue;
    place[count] = k < 3 ? ends[k] : find.edges.points[s.edge[k - 3]].position;
    pair[count][0] = static_cast<uint32_t>(pairs[k] >> 32);
    pair[count++][1] = static_cast<uint32_t>(pairs[k]);
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
        if (p.kind == CreasePoint::kNone) return;
        find.corners[i] = p;
        find.chosen[i] |= kHasCorner;
        return;
      }
    }
}

// Would a piece of the triangle be folded, or flat?
template <class Sheets>
QSES_FN bool spoils(const FindSplits &find, const Sheets &sheets, size_t i, const TriangleSplits &s) {
  const uint32_t *const t = find.mesh.triangle(find.list(i));
  CreaseEnd corner[7];
  for (int k = 0; k < 3; ++k) {
    corner[k] = end_of_vertex(find.mesh, sheets.lattice, t[k]);
    if (s.edge[k] != kNoNumber) corner[3 + k] = end_of_point(find.edges.points[s.edge[k]]);
  }
  if (s.within) corner[6] = end_of_point(find.corners[i]);
  const Pieces pieces = cut_triangle(s.edge[0] != kNoNumber, s.edge[1] != kNoNumber, s.edge[2] != kNoNumber, s.within,
                                     [&](int k) { return corner[k].position; });
  for (int p = 0; p < pieces.count; ++p) {
    const CreaseEnd *const c[3] = {corner + pieces.corner[p][0], corner + pieces.corner[p][1],
                                   corner + pieces.corner[p][2]};
    const Vec3<float> normal = cross(c[1]->position - c[0]->position, c[2]->position - c[0]->position);
    if (least_cosine_of_angles(c[0]->position, c[1]->position, c[2]->position) > Sheets::kFlatCosine ||
        sheets.is_folded(c, normal))
      return true;
  }
  return false;
}

// Where splits would fold a triangle, it gets no vertex within; and if its edges alone would, too, they are left as
// they are. The first pass looks at all triangles, the others at those that the one before has refused something, which
// are few.
template <class Sheets>
struct RefuseSplits {
  FindSplits find;
  Sheets sheets;
  QSES_FN bool is_done_at_a_glance(size_t i) const {
    if (find.pass == 1) find.find_edges(i);
    if (find.pass > 1 && !find.had_refusal(i, find.pass - 1)) return true;
    if constexpr (Sheets::kHasCorners) find_corner(find, sheets, i);
    const TriangleSplits s = find(i);
    return s.edges() == 0 && !s.within;
  }
  QSES_FN void operator()(size_t i) const {
    if (!is_done_at_a_glance(i)) finish(i);
  }
  QSES_FN void finish(size_t i) const {
    TriangleSplits s = find(i);
    while (spoils(find, sheets, i, s)) {
      if (!s.within) {
        for (int k = 0; k < 3; ++k)
          if (s.edge[k] != kNoNumber) atomic_store(find.edges.refused + s.edge[k], find.pass);
        return;
      }
      find.leave_out_corner(i);
      s.within = false;
    }
  }
};

// New vertices, in the upper half, and triangles of a triangle: those of the edges that belong to it.
template <class Sheets>
struct CountNew {
  FindSplits find;
  Sheets sheets;
  uint64_t *counts;  // [list]
  QSES_FN void operator()(size_t i) const {
    if constexpr (Sheets::kHasCorners)
      if (find.had_refusal(i, kRefusals)) {
        find_corner(find, sheets, i);
        const TriangleSplits left = find(i);
        if (left.within && spoils(find, sheets, i, left)) find.leave_out_corner(i);
      }
    const TriangleSplits s = find(i);
    uint64_t vertices = s.within ? 1 : 0;
    const uint32_t *const t = find.mesh.triangle(find.list(i));
    for (int k = 0; k < 3; ++k) vertices += s.edge[k] != kNoNumber && owns_edge(t, k) ? 1 : 0;
    counts[i] = vertices << 32 | static_cast<uint64_t>(s.new_triangles());
  }
};

// New vertices, each with the triangle that its edge belongs to.
struct AddVertices {
  FindSplits find;
  Lattice lattice;
  const uint64_t *before;  // [list]: new ones of the triangles before
  uint32_t first_vertex;
  uint32_t *vertex_of;  // [edge]
  QSES_FN void operator()(size_t i) const {
    if (before[i] == before[i + 1]) return;
    const TriangleSplits s = find(i);
    const uint32_t *const t = find.mesh.triangle(find.list(i));
    uint32_t v = first_vertex + static_cast<uint32_t>(before[i] >> 32);
    if (s.within) put_on_crease(find.mesh, lattice, v++, find.corners[i]);
    for (int k = 0; k < 3; ++k) {
      if (s.edge[k] == kNoNumber || !owns_edge(t, k)) continue;
      vertex_of[s.edge[k]] = v;
      put_on_crease(find.mesh, lattice, v++, find.edges.points[s.edge[k]]);
    }
  }
};

// The first piece of a triangle takes its place, the others come behind all triangles.
struct AddTriangles {
  FindSplits find;
  Lattice lattice;
  const uint64_t *before;  // [list]: new ones of the triangles before
  uint32_t first_vertex, first_triangle;
  const uint32_t *vertex_of;  // [edge]
  QSES_FN void operator()(size_t i) const {
    if (before[i] == before[i + 1]) return;
    const TriangleSplits s = find(i);
    uint32_t *const t = find.mesh.triangle(find.list(i));
    const uint32_t own[3] = {t[0], t[1], t[2]};
    const auto position = [&](int corner) {
      if (corner < 3) return lattice.from_caller(find.mesh.position(own[corner]));
      return find.edges.points[s.edge[corner - 3]].position;
    };
    const Pieces pieces =
        cut_triangle(s.edge[0] != kNoNumber, s.edge[1] != kNoNumber, s.edge[2] != kNoNumber, s.within, position);
    const auto number = [&](int corner) {
      if (corner < 3) return own[corner];
      return corner == 6 ? first_vertex + static_cast<uint32_t>(before[i] >> 32) : vertex_of[s.edge[corner - 3]];
    };
    uint32_t next = first_triangle + static_cast<uint32_t>(before[i]);
    for (int p = 0; p < pieces.count; ++p) {
      uint32_t *const out = p == 0 ? t : find.mesh.triangle(next);
      if (p > 0) find.mesh.near_marks[next++] = 1;
      for (int k = 0; k < 3; ++k) out[k] = number(pieces.corner[p][k]);
    }
  }
};

// A mesh in larger memory, with what is known of creases.
struct GrowMesh {
  CreasedMesh from, to;
  size_t vertices, triangles;
  QSES_FN void operator()(size_t i) const {
    KeepMesh{from, to, {}, vertices, triangles}(i);
    if (i < vertices) {
      if (from.second_owners) to.second_owners[i] = from.second_owners[i];
      to.crease_marks[i] = from.crease_marks[i];
    }
    if (i < triangles) to.near_marks[i] = from.near_marks[i];
  }
};

}  // namespace quickses
