// SPDX-License-Identifier: MIT
// Normals that face the triangles around them, as light needs it. Where a triangle cuts a crest off, the exact normal
// of a corner may point against it.
#pragma once

#include "surface/stages/ranked_set.h"
#include "surface/stages/relaxation.h"

#include <algorithm>

namespace quickses {

// Vertices with a normal against a triangle of theirs.
struct MarkTurnedAway {
  MeshView mesh;
  uint32_t *vertices;  // bits
  QSES_HOST_DEVICE void operator()(size_t triangle) const {
    const uint32_t *const t = mesh.triangle(triangle);
    const Vec3<float> face = face_normal(mesh, t);
    for (int k = 0; k < 3; ++k)
      if (dot(face, load_vec3(mesh.normal(t[k]))) < 0.f) atomic_or(vertices + t[k] / 32, uint32_t(1) << t[k] % 32);
  }
};

// The triangles of a run of the marked vertices, in any order. Of a vertex with more than there is room for, only the
// number.
struct MarkedFans {
  static constexpr uint32_t kRoom = 32;
  RankedSet marked;
  uint32_t first, vertices;  // the run
  uint32_t *numbers;         // of the vertices
  uint32_t *counts;
  uint32_t *triangles;  // kRoom of each vertex

  // The place of a vertex in the run, or what is not in it.
  QSES_FN uint32_t place(uint32_t vertex) const { return marked.rank(vertex) - first; }
};

struct CollectFans {
  MeshView mesh;
  MarkedFans fans;
  QSES_HOST_DEVICE void operator()(size_t triangle) const {
    const uint32_t *const t = mesh.triangle(triangle);
    for (int k = 0; k < 3; ++k) {
      if (!fans.marked.has(t[k])) continue;
      const uint32_t vertex = fans.place(t[k]);
      if (vertex >= fans.vertices) continue;
      atomic_store(fans.numbers + vertex, t[k]);
      const uint32_t place = atomic_add(fans.counts + vertex, uint32_t(1));
      if (place < fans.kRoom) fans.triangles[vertex * fans.kRoom + place] = static_cast<uint32_t>(triangle);
    }
  }
};

// Turns a normal towards the triangle that it is most against, and again until it faces all of them: where there is
// such a normal, Rosenblatt's rule finds one. Else, of those that face any, the one that was the least against another
// is kept.
struct TurnNormals {
  static constexpr int kTurns = 32, kLongTurns = 8;
  MeshView mesh;
  MarkedFans fans;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    if (fans.counts[i] <= fans.kRoom) turn(fans.numbers[i], fans.triangles + i * fans.kRoom, fans.counts[i]);
  }

 private:
  QSES_FN void turn(uint32_t vertex, const uint32_t *fan, uint32_t count) const {
    constexpr float kEnough = 0.02f, kClear = 1e-3f;
    Vec3<float> units[MarkedFans::kRoom];  // of no length: of a triangle without area
    for (uint32_t i = 0; i < count; ++i) {
      const Vec3<float> face = face_normal(mesh, mesh.triangle(fan[i]));
      const float length2 = length_squared(face);
      units[i] = face * (length2 < 1e-20f ? 0.f : reciprocal_root(length2));
    }
    Vec3<float> n = load_vec3(mesh.normal(vertex)), best = n;
    float best_facing = -2.f;
    for (int k = 0; k < kTurns && best_facing < kEnough; ++k) {
      Vec3<float> away = n;
      float least = 2.f, most = -2.f;
      uint32_t number = 0;
      for (uint32_t i = 0; i < count; ++i) {
        const Vec3<float> unit = units[i];
        if (unit.x == 0.f && unit.y == 0.f && unit.z == 0.f) continue;
        const float facing = dot(unit, n);
        most = maximum(most, facing);
        if (facing > least || (facing == least && fan[i] > number)) continue;  // ties by number: any order will do
        away = unit, least = facing, number = fan[i];
      }
      if (most > kClear && least > best_facing) best_facing = least, best = n;
      const Vec3<float> sum = n + away * (k < kLongTurns ? 1.f : 0.3f);
      const float length2 = length_squared(sum);
      n = length2 > 1e-6f ? sum * reciprocal_root(length2) : away;  // from the very opposite
    }
    store_vec3(mesh.normal(vertex), best);
  }
};

// Turns the normals that point against a triangle of theirs: as a rule very few, for which there is room at once.
// Waits.
template <class Executor>
void face_triangles(Executor &executor, const MeshView &mesh, const MeshCounts &counts) {
  if (counts.vertices == 0) return;
  const auto mark = executor.arena().mark();
  const RankedSet marked = allocate_set(executor, counts.vertices);
  const size_t room = counts.vertices / 32 + 32;
  const Span<uint32_t> sizes = executor.template allocate<uint32_t>(room);
  MarkedFans fans{marked,     0,
                  0,          executor.template allocate<uint32_t>(room).data,
                  sizes.data, executor.template allocate<uint32_t>(room * MarkedFans::kRoom).data};
  executor.for_each(counts.triangles, MarkTurnedAway{mesh, marked.words});
  const uint32_t total = rank_set(executor, marked, counts.vertices);
  for (; fans.first < total; fans.first += fans.vertices) {
    fans.vertices = static_cast<uint32_t>(std::min<size_t>(room, total - fans.first));
    executor.fill(sizes, 0);
    executor.for_each(counts.triangles, CollectFans{mesh, fans});
    executor.for_each(fans.vertices, TurnNormals{mesh, fans}, uint64_t(TurnNormals::kTurns) * MarkedFans::kRoom);
  }
  executor.arena().rewind(mark);
}

}  // namespace quickses
