// SPDX-License-Identifier: MIT
// Merges short edges at creases: one end takes the place of the other, and the two triangles at the edge go. Where two
// vertices came onto a crease in the wrong order, what lies between them is folded, and where they came close together
// it is slim; both end with the edge. The mesh stays closed and a manifold, since the ends merge only if they have two
// neighbours in common (Dey, Edelsbrunner, Guha and Nekhayev 1999, Topology preserving edge contraction).
#pragma once

#include "surface/stages/crease_edges.h"
#include "surface/stages/kept_parts.h"
#include "surface/stages/triangle_angles.h"

#include <cstring>

namespace quickses {

// The quality of a triangle: the cosine between it and the normals of its corners, up to this, less so much for what
// the cosine of its smallest angle is above that of 20 degrees. On a crease of its normals that which suits best.
constexpr float kEnoughFacing = 0.5f;
constexpr float kSlimCosine = 0.94f;
constexpr float kSlimWeight = 8.f;
// Triangles of less are poor: folded, slim, or both to some extent. Theirs are the edges that merge.
constexpr float kPoorQuality = 0.3f;
// The least quality of the triangles around an edge has to grow so much by a merge.
constexpr float kLeastMergeGain = 0.05f;
// No longer edges are merged, and none comes to be farther from the surface than this or than before. In spacings.
constexpr float kLongestMerge = 0.5f;
constexpr float kMergeSagitta = 0.1f;
// Vertices with more triangles are left alone.
constexpr uint32_t kMostAround = 16;
// Merges that are next to each other are done in so many rounds.
constexpr int kMergeRounds = 3;
// Steps of a thread for the edges of a team.
constexpr uint64_t kMergeSteps = uint64_t(1) << 12;

// How far the middle of an edge is from a surface that bends evenly from one end to the other, in Å: on the sides that
// fit best.
QSES_FN float edge_sagitta(const CreaseEnd &a, const CreaseEnd &b) {
  const Vec3<float> way = b.position - a.position;
  const float a1 = dot(a.normal, way), a2 = dot(a.second_normal, way), b1 = dot(b.normal, way),
              b2 = dot(b.second_normal, way);
  return 0.125f * minimum(minimum(absolute(a1 - b1), absolute(a1 - b2)), minimum(absolute(a2 - b1), absolute(a2 - b2)));
}

QSES_FN bool has_corner(const uint32_t *t, uint32_t v) { return t[0] == v || t[1] == v || t[2] == v; }

// The mesh while its edges merge. Of each poor triangle the shortest edge is looked at.
struct EdgeMerges {
  CreasedMesh mesh;  // all corners of triangles that are gone: kNoNumber
  Lattice lattice;
  const uint32_t *poor;        // triangles
  const uint64_t *poor_count;  // of those listed at most `room`
  uint32_t room;
  uint32_t *slots;          // [vertex]: of the ends of such edges, of which each triangle has two; else kNoNumber
  uint32_t *around_counts;  // [slot]: triangles around the end; more than kMostAround: they are too many to be known
  uint32_t *around;         // kMostAround of each slot, in any order; some may be gone
  uint32_t *changed;        // [slot]: the last round that changed a triangle around the end, from 1 on; 0: none did
  uint64_t *claims;         // [triangle]: the best merge that concerns it
  uint64_t *keys;           // [poor]: of its merge, in the order from the best to the worst,
  uint32_t *leaving;        // the end that goes; kNoNumber: it wants no merge; kLater: another one was better,
  uint32_t *staying;        // and the other one
  KeptParts kept;
  static constexpr uint32_t kLater = kNoNumber - 1;

  QSES_FN uint32_t listed() const { return *poor_count < room ? static_cast<uint32_t>(*poor_count) : room; }
  QSES_FN bool is_gone(const uint32_t *t) const { return t[0] == kNoNumber; }
  QSES_FN Vec3<float> position(uint32_t v) const { return lattice.from_caller(mesh.position(v)); }
  QSES_FN CreaseEnd end(uint32_t v) const { return end_of_vertex(mesh, lattice, v); }

  QSES_FN float quality(const CreaseEnd &a, const CreaseEnd &b, const CreaseEnd &c) const {
    const Vec3<float> normal = cross(b.position - a.position, c.position - a.position);
    const float length2 = length_squared(normal);
    if (!(length2 > 1e-20f)) return -kSlimWeight;
    const auto facing = [&](const CreaseEnd &end) {
      return maximum(dot(normal, end.normal), dot(normal, end.second_normal));
    };
    const float least = minimum(facing(a), minimum(facing(b), facing(c))) * reciprocal_root(length2);
    const float slim = least_cosine_of_angles(a.position, b.position, c.position) - kSlimCosine;
    return minimum(least, kEnoughFacing) - kSlimWeight * maximum(0.f, slim);
  }

  // The shortest edge of a triangle: from the corner of that number to the next one.
  QSES_FN int shortest_edge(const uint32_t *t) const {
    int shortest = 0;
    float least2 = kFarAway;
    for (int k = 0; k < 3; ++k) {
      const float length2 = length_squared(position(t[next_corner(k)]) - position(t[k]));
      if (length2 < least2) least2 = length2, shortest = k;
    }
    return shortest;
  }

  // Does that round find what the one before found, which was that there is nothing to merge?
  QSES_FN bool is_settled(size_t i, int round) const {
    if (round == 0 || leaving[i] != kNoNumber) return false;
    const uint32_t *const t = mesh.triangle(poor[i]);
    if (is_gone(t)) return true;
    for (int k = 0; k < 3; ++k)
      if (slots[t[k]] != kNoNumber && changed[slots[t[k]]] == static_cast<uint32_t>(round)) return false;
    return true;
  }

  QSES_FN bool is_known(uint32_t v) const { return slots[v] != kNoNumber && around_counts[slots[v]] <= kMostAround; }
  // Calls use(triangle) for all triangles around a known vertex.
  template <class Use>
  QSES_FN void for_around(uint32_t v, const Use &use) const {
    const uint32_t slot = slots[v];
    for (uint32_t k = 0; k < around_counts[slot]; ++k) {
      const uint32_t triangle = around[slot * kMostAround + k];
      if (!is_gone(mesh.triangle(triangle))) use(triangle);
    }
  }
};

// Of triangles with a corner on a crease.
struct MarkPoorTriangles {
  EdgeMerges merges;
  QSES_FN void operator()(size_t i) const {
    const EdgeMerges &m = merges;
    const uint32_t *const t = m.mesh.triangle(i);
    const bool near = m.mesh.on_crease(t[0]) || m.mesh.on_crease(t[1]) || m.mesh.on_crease(t[2]);
    m.mesh.near_marks[i] = near && m.quality(m.end(t[0]), m.end(t[1]), m.end(t[2])) < kPoorQuality ? 1 : 0;
  }
};

// Gives slots to the ends of the edges, the first one that may be.
struct ChooseSlots {
  EdgeMerges merges;
  QSES_FN void operator()(size_t i) const {
    if (i >= merges.listed()) return;
    const uint32_t slot = 2 * static_cast<uint32_t>(i), *const t = merges.mesh.triangle(merges.poor[i]);
    const int k = merges.shortest_edge(t);
    atomic_min(merges.slots + t[k], slot);
    atomic_min(merges.slots + t[next_corner(k)], slot + 1);
  }
};

struct CollectAround {
  EdgeMerges merges;
  QSES_FN void operator()(size_t i) const {
    const uint32_t *const t = merges.mesh.triangle(i);
    for (int k = 0; k < 3; ++k) {
      const uint32_t slot = merges.slots[t[k]];
      if (slot == kNoNumber) continue;
      const uint32_t place = atomic_add(merges.around_counts + slot, uint32_t(1));
      if (place < kMostAround) merges.around[slot * kMostAround + place] = static_cast<uint32_t>(i);
    }
  }
};

// ---- a round ---------------------------------------------------------------------------------------------------

// An edge, and what a merge of its ends would make of the triangles around them.
struct MergedEdge {
  static constexpr int kRoom = 2 * int(kMostAround);
  struct Around {
    uint32_t corners[3];
    float quality, merged;  // as it is, and with the end that it is around in the place of the other one
    bool is_there;
    bool at_edge;  // it has both ends, and goes with them
    bool moves_too_far;
    bool has_common_neighbor;
  };
  uint32_t ends[2];
  bool may_go[2];      // not off a crease
  uint32_t counts[2];  // around the ends; 0 where no merge can be
  bool is_settled;
  uint64_t key;
  Around around[kRoom];  // the first half around the first end

  QSES_FN static int end_of(int k) { return k < int(kMostAround) ? 0 : 1; }

  QSES_FN void find(const EdgeMerges &m, size_t i, int round) {
    counts[0] = counts[1] = 0;
    is_settled = i >= m.listed() || m.is_settled(i, round);
    if (is_settled) return;
    const uint32_t *const t = m.mesh.triangle(m.poor[i]);
    if (m.is_gone(t)) return;
    const int k = m.shortest_edge(t);
    ends[0] = t[k], ends[1] = t[next_corner(k)];
    if (!m.is_known(ends[0]) || !m.is_known(ends[1])) return;
    const float longest = kLongestMerge * m.lattice.spacing;
    if (length_squared(m.position(ends[1]) - m.position(ends[0])) > longest * longest) return;
    for (int e = 0; e < 2; ++e) {
      may_go[e] = m.mesh.on_crease(ends[1 - e]) || !m.mesh.on_crease(ends[e]);
      counts[e] = m.around_counts[m.slots[ends[e]]];
    }
  }
  QSES_FN uint32_t triangle(const EdgeMerges &m, int k) const {
    const int e = end_of(k);
    return m.around[m.slots[ends[e]] * kMostAround + static_cast<uint32_t>(k - e * int(kMostAround))];
  }

  QSES_FN void judge(const EdgeMerges &m, int k) {
    Around &a = around[k];
    const int e = end_of(k);
    a.is_there = false;
    if (static_cast<uint32_t>(k - e * int(kMostAround)) >= counts[e]) return;
    const uint32_t leaving = ends[e], staying = ends[1 - e], *const t = m.mesh.triangle(triangle(m, k));
    if (m.is_gone(t)) return;
    CreaseEnd c[3];
    for (int j = 0; j < 3; ++j) {
      a.corners[j] = t[j];
      c[j] = m.end(t[j]);
    }
    a.is_there = true;
    a.quality = m.quality(c[0], c[1], c[2]);
    a.at_edge = has_corner(t, staying);
    a.moves_too_far = false;
    if (a.at_edge || !may_go[e]) return;
    const CreaseEnd from = m.end(leaving), to = m.end(staying);
    for (int j = 0; j < 3; ++j) {
      if (t[j] == leaving)
        c[j] = to;
      else
        a.moves_too_far |=
            edge_sagitta(to, c[j]) > maximum(edge_sagitta(from, c[j]), kMergeSagitta * m.lattice.spacing);
    }
    a.merged = m.quality(c[0], c[1], c[2]);
  }

  // Of the second end the neighbour that follows in a triangle: is it one of the first end, too?
  QSES_FN void find_common_neighbor(int k) {
    if (end_of(k) == 0 || !around[k].is_there) return;
    const uint32_t *const t = around[k].corners;
    const uint32_t next = t[0] == ends[1] ? t[1] : t[1] == ends[1] ? t[2] : t[0];
    bool has = false;
    for (uint32_t j = 0; j < counts[0] && next != ends[0]; ++j) {
      has |= around[j].is_there && has_corner(around[j].corners, next);
    }
    around[k].has_common_neighbor = has;
  }

  // By how much the least quality grows if that end goes; 0: that must not be.
  QSES_FN float gain(int leaving) const {
    if (counts[0] == 0 || !may_go[leaving]) return 0.f;
    float before = kEnoughFacing, after = kEnoughFacing;
    uint32_t common = 0, triangles[2] = {0, 0};
    for (int k = 0; k < kRoom; ++k) {
      const Around &a = around[k];
      if (!a.is_there) continue;
      const int e = end_of(k);
      ++triangles[e];
      before = minimum(before, a.quality);
      if (e == 1) common += a.has_common_neighbor ? 1 : 0;
      if (a.at_edge) continue;
      if (e == leaving && a.moves_too_far) return 0.f;
      after = minimum(after, e == leaving ? a.merged : a.quality);
    }
    const bool is_tetrahedron = triangles[0] <= 3 && triangles[1] <= 3;
    return common == 2 && !is_tetrahedron ? maximum(0.f, after - before) : 0.f;
  }
};
struct MergedEdges {
  static constexpr int kCount = 16;
  MergedEdge edges[kCount];
};

// What the poor triangles want. Claims of later rounds come before those of earlier ones.
struct ProposeMerges {
  EdgeMerges merges;
  int round;
  size_t teams;  // which take turns
  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, MergedEdges &near, size_t number) const {
    constexpr size_t kEdges = MergedEdges::kCount;
    for (size_t first = number * kEdges; first < merges.listed(); first += teams * kEdges) propose(team, near, first);
  }

 private:
  template <class Team>
  QSES_FN void propose(const Team &team, MergedEdges &near, size_t first) const {
    constexpr int kEdges = MergedEdges::kCount, kRoom = MergedEdge::kRoom;
    const auto for_edges = [&](const auto &use) {
      for (int e = team.rank(); e < kEdges; e += team.size()) use(near.edges[e], first + static_cast<size_t>(e));
      team.sync();
    };
    const auto for_all_around = [&](const auto &use) {
      for (int k = team.rank(); k < kEdges * kRoom; k += team.size())
        if (near.edges[k / kRoom].counts[0] > 0) use(near.edges[k / kRoom], k % kRoom);
      team.sync();
    };
    for_edges([&](MergedEdge &edge, size_t i) { edge.find(merges, i, round); });
    for_all_around([&](MergedEdge &edge, int k) { edge.judge(merges, k); });
    for_all_around([&](MergedEdge &edge, int k) { edge.find_common_neighbor(k); });
    for_edges([&](MergedEdge &edge, size_t i) { choose(&edge, i); });
    for_all_around([&](MergedEdge &edge, int k) {
      if (edge.around[k].is_there) atomic_min(merges.claims + edge.triangle(merges, k), edge.key);
    });
  }
  QSES_FN void choose(MergedEdge *edge, size_t i) const {
    if (edge->is_settled) return;
    const float of_first = edge->gain(0), of_second = edge->gain(1), gain = maximum(of_first, of_second);
    const int leaving = of_first >= of_second ? 0 : 1;
    if (!(gain > kLeastMergeGain)) {
      merges.leaving[i] = kNoNumber;
      edge->counts[0] = 0;
      return;
    }
    merges.leaving[i] = edge->ends[leaving];
    merges.staying[i] = edge->ends[1 - leaving];
    uint32_t bits;  // in the order of the gains, which are positive
    memcpy(&bits, &gain, sizeof bits);
    merges.keys[i] = edge->key = uint64_t(kMergeRounds - round) << 61 | uint64_t(~bits & 0x7fffffffu) << 30 | i;
  }
};
// Those are done that are the best for all triangles around: so no two have a triangle in common, and each finds around
// it what it was judged by. If both triangles at an edge want it to merge, the first one does that.
struct ChooseMerges {
  EdgeMerges merges;
  QSES_FN void operator()(size_t i) const {
    if (i >= merges.listed() || merges.leaving[i] == kNoNumber) return;
    bool wins = true;
    for (const uint32_t end : {merges.leaving[i], merges.staying[i]})
      merges.for_around(end, [&](uint32_t triangle) { wins &= merges.claims[triangle] == merges.keys[i]; });
    if (!wins) merges.leaving[i] = EdgeMerges::kLater;
  }
};
struct MergeEdges {
  EdgeMerges merges;
  int round;
  QSES_FN void operator()(size_t i) const {
    const EdgeMerges &m = merges;
    if (i >= m.listed() || m.leaving[i] >= EdgeMerges::kLater) return;
    const uint32_t leaving = m.leaving[i], staying = m.staying[i], slot = m.slots[staying];
    uint32_t count = m.around_counts[slot];
    m.for_around(leaving, [&](uint32_t triangle) {
      uint32_t *const t = m.mesh.triangle(triangle);
      for (int k = 0; k < 3; ++k) mark_changed(t[k]);
      if (has_corner(t, staying)) {
        t[0] = t[1] = t[2] = kNoNumber;
        m.kept.triangles.drop(triangle);
        return;
      }
      for (int k = 0; k < 3; ++k)
        if (t[k] == leaving) t[k] = staying;
      if (count < kMostAround) m.around[slot * kMostAround + count] = triangle;
      ++count;
    });
    m.around_counts[slot] = count;
    m.kept.vertices.drop(leaving);
  }

 private:
  QSES_FN void mark_changed(uint32_t v) const {
    const uint32_t slot = merges.slots[v];
    if (slot != kNoNumber) atomic_store(merges.changed + slot, static_cast<uint32_t>(round + 1));
  }
};

}  // namespace quickses
