// SPDX-License-Identifier: MIT
// Splits edges of a closed mesh: each edge at most once per round, and in both of its triangles, so that the mesh stays
// closed whatever the places are. Sheets say what to split and where (creases.h).
#pragma once

#include "surface/stages/crease_edges.h"
#include "surface/stages/triangle_angles.h"

namespace quickses {

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
