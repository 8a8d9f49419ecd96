// SPDX-License-Identifier: MIT
// Merges short edges at creases: one end takes the place of the other, and the two triangles at the edge go. Where two
// vertices came onto a crease in the wrong order, what lies between them is folded, and where they came close together
// it is slim; both end with the edge. The mesh stays closed and a manifold, since the ends merge only if they have two
// neighbours in common (Dey, Edelsbrunner, Guha and Nekhayev 1999, Topology preserving edge contraction).
#pragma once

#include "parallel/atomics.h"
#include "surface/stages/creases.h"
#include "surface/stages/kept_parts.h"
#include "surface/stages/triangle_angles.h"

#include <cstring>

namespace quickses {

// The quality of a triangle: the cosine between it and the normals of its corners, up to this, less so much for what
// the cosine of its smallest angle is above that of 20 degrees. On a crease of its normals that which suits best.
constexpr float kEnoughFacing = 0.5f;
constexpr float kSlimCosine = 0.94f;
constexpr float kSlimWeight = 8.f;
// The least quality of the triangles around an edge has to grow so much by a merge.
constexpr float kLeastMergeGain = 0.05f;
// No longer edges are merged, and none comes to be farther from the surface than this or than before. In spacings.
constexpr float kLongestMerge = 0.5f;
constexpr float kMergeSagitta = 0.06f;
// Vertices with more triangles are left alone.
constexpr uint32_t kMostAround = 16;
// Steps of a thread for an edge: the triangles around both ends, and for each of them those around one.
constexpr uint64_t kMergeSteps = uint64_t(1) << 12;

// How far the middle of an edge is from a surface that bends evenly from one end to the other, in Å: on the sides that
// fit best.
QSES_FN float edge_sagitta(const CreaseEnd &a, const CreaseEnd &b) {
  const Vec3<float> way = b.position - a.position;
  const float a1 = dot(a.normal, way), a2 = dot(a.second_normal, way), b1 = dot(b.normal, way),
              b2 = dot(b.second_normal, way);
  return 0.125f * minimum(minimum(absolute(a1 - b1), absolute(a1 - b2)), minimum(absolute(a2 - b1), absolute(a2 - b2)));
}

// The mesh while its edges merge. Of each poor triangle the shortest edge is looked at.
struct EdgeMerges {
  static constexpr uint32_t kNone = ~uint32_t(0);
  enum Choice : uint8_t { kNeither, kFirstGoes, kSecondGoes };

  CreasedMesh mesh;  // all corners of triangles that are gone: kNone
  Lattice lattice;
  const uint32_t *poor;        // triangles
  const uint64_t *poor_count;  // of those listed at most `room`
  uint32_t room;
  uint32_t *slots;          // [vertex]: of the ends of such edges, of which each triangle has two; else kNone
  uint32_t *around_counts;  // [slot]: triangles around the end, more than kMostAround if they are too many to be known,
  uint32_t *around;         // and kMostAround of them, in any order; some may be gone
  uint64_t *claims;         // [triangle]: the best merge that concerns it, of those around known ends
  uint64_t *keys;           // [poor]: of its merge, in the order from the best to the worst
  Choice *choices;          // [poor]
  KeptParts kept_parts;

  QSES_FN uint32_t listed() const { return *poor_count < room ? static_cast<uint32_t>(*poor_count) : room; }
  QSES_FN bool is_gone(const uint32_t *t) const { return t[0] == kNone; }

  QSES_FN float quality(const CreaseEnd &a, const CreaseEnd &b, const CreaseEnd &c) const {
    const Vec3<float> normal = cross(b.position - a.position, c.position - a.position) * (mesh.reversed ? -1.f : 1.f);
    const float length2 = length_squared(normal);
    if (!(length2 > 1e-20f)) return -kSlimWeight;
    const auto facing = [&](const CreaseEnd &end) {
      return maximum(dot(normal, end.normal), dot(normal, end.second_normal));
    };
    const float least = minimum(facing(a), minimum(facing(b), facing(c))) * reciprocal_root(length2);
    const float slim = least_cosine_of_angles(a.position, b.position, c.position) - kSlimCosine;
    return minimum(least, kEnoughFacing) - kSlimWeight * maximum(0.f, slim);
  }
  QSES_FN CreaseEnd end(uint32_t v) const { return end_of_vertex(mesh, lattice, v); }
  QSES_FN float quality(const uint32_t *t) const { return quality(end(t[0]), end(t[1]), end(t[2])); }

  // The shortest edge of a triangle: from the corner of that number to the next one.
  QSES_FN int shortest_edge(const uint32_t *t) const {
    int shortest = 0;
    float least2 = kFarAway;
    for (int k = 0; k < 3; ++k) {
      const float length2 = length_squared(end(t[k == 2 ? 0 : k + 1]).position - end(t[k]).position);
      if (length2 < least2) least2 = length2, shortest = k;
    }
    return shortest;
  }

  // Calls use(triangle) for all triangles around a vertex that has a slot.
  template <class Use>
  QSES_FN void for_around(uint32_t v, const Use &use) const {
    const uint32_t slot = slots[v];
    for (uint32_t k = 0; k < around_counts[slot]; ++k) {
      const uint32_t triangle = around[slot * kMostAround + k];
      if (!is_gone(mesh.triangle(triangle))) use(triangle);
    }
  }
  QSES_FN bool is_known(uint32_t v) const { return slots[v] != kNone && around_counts[slots[v]] <= kMostAround; }

  // By how much the least quality grows if `kept` takes the place of `leaving`; 0: that must not be. Both are known.
  QSES_FN float gain_of(uint32_t leaving, uint32_t kept) const {
    const CreaseEnd from = end(leaving), to = end(kept);
    if (from.on_crease() && !to.on_crease()) return 0.f;
    const float longest = kLongestMerge * lattice.spacing, sagitta = kMergeSagitta * lattice.spacing;
    if (length_squared(to.position - from.position) > longest * longest) return 0.f;
    float before = kEnoughFacing, after = kEnoughFacing;
    bool is_near = true;
    int around_leaving = 0, around_kept = 0, common = 0;
    for_around(leaving, [&](uint32_t triangle) {
      const uint32_t *const t = mesh.triangle(triangle);
      CreaseEnd c[3] = {end(t[0]), end(t[1]), end(t[2])};
      ++around_leaving;
      before = minimum(before, quality(c[0], c[1], c[2]));
      if (t[0] == kept || t[1] == kept || t[2] == kept) return;
      for (int k = 0; k < 3; ++k) {
        if (t[k] == leaving)
          c[k] = to;
        else
          is_near &= edge_sagitta(to, c[k]) <= maximum(edge_sagitta(from, c[k]), sagitta);
      }
      after = minimum(after, quality(c[0], c[1], c[2]));
    });
    if (!is_near) return 0.f;
    for_around(kept, [&](uint32_t triangle) {
      const uint32_t *const t = mesh.triangle(triangle);
      const float here = quality(t);
      ++around_kept;
      before = minimum(before, here);
      if (t[0] != leaving && t[1] != leaving && t[2] != leaving) after = minimum(after, here);
      // Each neighbour follows in one triangle.
      const uint32_t next = t[0] == kept ? t[1] : t[1] == kept ? t[2] : t[0];
      bool is_common = false;
      for_around(leaving, [&](uint32_t other) {
        const uint32_t *const o = mesh.triangle(other);
        is_common |= next != leaving && (o[0] == next || o[1] == next || o[2] == next);
      });
      common += int(is_common);
    });
    if (common != 2 || (around_leaving <= 3 && around_kept <= 3)) return 0.f;  // of a tetrahedron
    return maximum(0.f, after - before);
  }

  // Calls use(first end, second end) for the edge that a poor triangle wants to be merged, if it is there still and
  // all triangles around it are known.
  template <class Use>
  QSES_FN void for_edge(size_t i, const Use &use) const {
    const uint32_t *const t = mesh.triangle(poor[i]);
    if (is_gone(t)) return;
    const int k = shortest_edge(t);
    const uint32_t first = t[k], second = t[k == 2 ? 0 : k + 1];
    if (is_known(first) && is_known(second)) use(first, second);
  }
  // Calls use(triangle) for all around both ends.
  template <class Use>
  QSES_FN void for_both(uint32_t first, uint32_t second, const Use &use) const {
    for_around(first, use);
    for_around(second, use);
  }
};

// Of triangles with a corner on a crease.
struct MarkPoorTriangles {
  EdgeMerges merges;
  QSES_FN void operator()(size_t i) const {
    const uint32_t *const t = merges.mesh.triangle(i);
    const bool near = merges.mesh.on_crease(t[0]) || merges.mesh.on_crease(t[1]) || merges.mesh.on_crease(t[2]);
    merges.mesh.near_marks[i] = near && merges.quality(t) < kEnoughFacing ? 1 : 0;
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
    atomic_min(merges.slots + t[k == 2 ? 0 : k + 1], slot + 1);
  }
};

struct CollectAround {
  EdgeMerges merges;
  QSES_FN void operator()(size_t i) const {
    const uint32_t *const t = merges.mesh.triangle(i);
    for (int k = 0; k < 3; ++k) {
      const uint32_t slot = merges.slots[t[k]];
      if (slot == EdgeMerges::kNone) continue;
      const uint32_t place = atomic_add(merges.around_counts + slot, uint32_t(1));
      if (place < kMostAround) merges.around[slot * kMostAround + place] = static_cast<uint32_t>(i);
    }
  }
};

// ---- a round ---------------------------------------------------------------------------------------------------

struct ClearClaims {
  EdgeMerges merges;
  QSES_FN void operator()(size_t i) const {
    if (i >= merges.listed()) return;
    merges.for_edge(i, [&](uint32_t first, uint32_t second) {
      merges.for_both(first, second, [&](uint32_t triangle) { merges.claims[triangle] = ~uint64_t(0); });
    });
  }
};

// What each poor triangle wants.
struct ProposeMerges {
  EdgeMerges merges;
  QSES_FN void operator()(size_t i) const {
    if (i >= merges.listed()) return;
    merges.choices[i] = EdgeMerges::kNeither;
    merges.for_edge(i, [&](uint32_t first, uint32_t second) {
      const float of_first = merges.gain_of(first, second), of_second = merges.gain_of(second, first);
      const float gain = maximum(of_first, of_second);
      if (!(gain > kLeastMergeGain)) return;
      merges.choices[i] = of_first >= of_second ? EdgeMerges::kFirstGoes : EdgeMerges::kSecondGoes;
      uint32_t bits;  // in the order of the gains, which are positive
      memcpy(&bits, &gain, sizeof bits);
      const uint64_t key = uint64_t(~bits) << 32 | i;
      merges.keys[i] = key;
      merges.for_both(first, second, [&](uint32_t triangle) { atomic_min(merges.claims + triangle, key); });
    });
  }
};
// Those are done that are the best for all triangles around: so no two have a triangle in common, and each finds around
// it what it was judged by.
struct ChooseMerges {
  EdgeMerges merges;
  QSES_FN void operator()(size_t i) const {
    if (i >= merges.listed() || merges.choices[i] == EdgeMerges::kNeither) return;
    bool wins = true;
    merges.for_edge(i, [&](uint32_t first, uint32_t second) {
      merges.for_both(first, second, [&](uint32_t triangle) { wins &= merges.claims[triangle] == merges.keys[i]; });
    });
    if (!wins) merges.choices[i] = EdgeMerges::kNeither;
  }
};
struct MergeEdges {
  EdgeMerges merges;
  QSES_FN void operator()(size_t i) const {
    const EdgeMerges &m = merges;
    if (i >= m.listed() || m.choices[i] == EdgeMerges::kNeither) return;
    uint32_t leaving = 0, kept = 0;
    m.for_edge(i, [&](uint32_t first, uint32_t second) {
      leaving = m.choices[i] == EdgeMerges::kFirstGoes ? first : second;
      kept = first + second - leaving;
    });
    uint32_t count = m.around_counts[m.slots[kept]];
    m.for_around(leaving, [&](uint32_t triangle) {
      uint32_t *const t = m.mesh.triangle(triangle);
      if (t[0] == kept || t[1] == kept || t[2] == kept) {
        t[0] = t[1] = t[2] = EdgeMerges::kNone;
        m.kept_parts.triangles.drop(triangle);
        return;
      }
      for (int k = 0; k < 3; ++k)
        if (t[k] == leaving) t[k] = kept;
      if (count < kMostAround) m.around[m.slots[kept] * kMostAround + count] = triangle;
      ++count;
    });
    m.around_counts[m.slots[kept]] = count;
    m.kept_parts.vertices.drop(leaving);
  }
};

}  // namespace quickses
