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

// One of them, where it is near: of the triangles with area.
struct Fan {
  uint32_t size;
  uint32_t triangles[MarkedFans::kRoom];
  Vec3<float> normals[MarkedFans::kRoom];
};

// Turns a normal towards the triangle that it is most against, and again until it faces all of them: where there is
// such a normal, Rosenblatt's rule finds one. Else, of those that face any, the one that was the least against another
// is kept.
struct TurnNormals {
  static constexpr int kTurns = 32, kLongTurns = 8;
  MeshView mesh;
  MarkedFans fans;
  template <class Team>
  QSES_FN void operator()(const Team &team, Fan &fan, size_t i) const {
    const uint32_t count = fans.counts[i];
    if (count > fans.kRoom) return;
    if (team.rank() == 0) fan.size = 0;
    team.sync();
    for (uint32_t k = static_cast<uint32_t>(team.rank()); k < count; k += static_cast<uint32_t>(team.size())) {
      const uint32_t triangle = fans.triangles[i * fans.kRoom + k];
      const Vec3<float> face = face_normal(mesh, mesh.triangle(triangle));
      const float length2 = length_squared(face);
      if (length2 < 1e-20f) continue;
      const uint32_t place = atomic_add(&fan.size, uint32_t(1));
      fan.triangles[place] = triangle;
      fan.normals[place] = face * reciprocal_root(length2);
    }
    team.sync();
    if (team.rank() == 0) turn(fans.numbers[i], fan);
  }

 private:
  QSES_FN void turn(uint32_t vertex, const Fan &fan) const {
    constexpr float kEnough = 0.02f, kClear = 1e-3f;
    Vec3<float> n = load_vec3(mesh.normal(vertex)), best = n;
    float best_facing = -2.f;
    for (int k = 0; k < kTurns && best_facing < kEnough; ++k) {
      Vec3<float> away = n;
      float least = 2.f, most = -2.f;
      uint32_t number = 0;
#if defined(__CUDA_ARCH__)
#pragma unroll 4
#endif
      for (uint32_t i = 0; i < fan.size; ++i) {
        const Vec3<float> normal = fan.normals[i];
        const uint32_t triangle = fan.triangles[i];
        const float facing = dot(normal, n);
        most = maximum(most, facing);
        const bool is_less = !(facing > least || (facing == least && triangle > number));  // ties by number: any order
        away = {is_less ? normal.x : away.x, is_less ? normal.y : away.y, is_less ? normal.z : away.z};
        least = is_less ? facing : least;
        number = is_less ? triangle : number;
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
    executor.template for_each_brick<Fan>(fans.vertices, TurnNormals{mesh, fans}, 8,
                                          uint64_t(TurnNormals::kTurns) * MarkedFans::kRoom);
  }
  executor.arena().rewind(mark);
}

}  // namespace quickses
