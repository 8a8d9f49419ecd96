// SPDX-License-Identifier: MIT
// A vertex where two sheets of the surface meet, made into one per side, each with that side's normal. The second ones
// stand behind all others, in the order of the first.
#pragma once

#include "parallel/atomics.h"
#include "surface/methods/expected_splits.h"
#include "surface/stages/ranked_set.h"

namespace quickses {

struct MarkCrestVertices {
  MeshView mesh;
  size_t vertices;
  uint32_t *words;
  QSES_HOST_DEVICE void operator()(size_t word) const {
    uint32_t bits = 0;
    for (uint32_t k = 0; k < 32 && 32 * word + k < vertices; ++k)
      bits |= is_crest_vertex(mesh, 32 * static_cast<uint32_t>(word) + k) ? uint32_t(1) << k : 0;
    words[word] = bits;
  }
};

// Which sides of each crest vertex triangles have corners on.
struct MarkSides {
  MeshView mesh;
  const uint32_t *crest;
  uint32_t *sides[2];
  QSES_HOST_DEVICE void operator()(size_t triangle) const {
    const uint32_t *const t = mesh.triangle(triangle);
    for (int k = 0; k < 3; ++k) {
      const uint32_t bit = uint32_t(1) << t[k] % 32;
      if (!(crest[t[k] / 32] & bit)) continue;
      uint32_t *const word = sides[side_of_corner(mesh, t, k)] + t[k] / 32;
      if (!(atomic_load(word) & bit)) atomic_or(word, bit);
    }
  }
};

// Vertices with triangles on both sides remain in the first set; those with triangles on the second one only in the
// second.
struct SeparateSides {
  uint32_t *sides[2];
  QSES_HOST_DEVICE void operator()(size_t word) const {
    const uint32_t first = sides[0][word], second = sides[1][word];
    sides[0][word] = first & second;
    sides[1][word] = second & ~first;
  }
};

struct SplitVertex {
  MeshView from, to;
  size_t vertices;
  RankedSet both;
  const uint32_t *only_second;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t vertex = static_cast<uint32_t>(i);
    copy_vertex(from, vertex, to, vertex);
    if (only_second[vertex / 32] >> vertex % 32 & 1) take_second(vertex, vertex);
    if (!both.has(vertex)) return;
    const uint32_t place = static_cast<uint32_t>(vertices) + both.rank(vertex);
    copy_vertex(from, vertex, to, place);
    take_second(vertex, place);
    to.repeated[both.rank(vertex)] = vertex;
  }

 private:
  QSES_FN void take_second(uint32_t vertex, uint32_t place) const {
    store_vec3(to.normal(place), load_vec3(from.second_normal(vertex)));
  }
};

struct SplitTriangle {
  MeshView from, to;
  size_t vertices;
  RankedSet both;
  QSES_HOST_DEVICE void operator()(size_t triangle) const {
    const uint32_t *const t = from.triangle(triangle);
    uint32_t *const out = to.triangle(triangle);
    for (int k = 0; k < 3; ++k)
      out[k] =
          both.has(t[k]) && side_of_corner(from, t, k) == 1 ? static_cast<uint32_t>(vertices) + both.rank(t[k]) : t[k];
  }
};

// Which part of the vertices is on crests, where that is not known.
template <class Work>
double expected_hard_part(const Work &work) {
  return splits_creases(work) ? expected_splits(work).hard_part() : 0.02;
}

// The same surface, with its crests hard. Waits.
template <class Work>
MeshMemoryView harden_edges(Work &work, const MeshMemoryView &smooth) {
  auto &executor = work.executor;
  const size_t n = smooth.vertices, words = (n + 31) / 32;
  const RankedSet both = allocate_set(executor, n);
  const Span<uint32_t> crest = executor.template allocate<uint32_t>(words),
                       second = executor.template allocate_zeros<uint32_t>(words);
  executor.for_each(words, MarkCrestVertices{smooth.view, n, crest.data});
  executor.for_each(smooth.triangles, MarkSides{smooth.view, crest.data, {both.words, second.data}});
  executor.for_each(words, SeparateSides{{both.words, second.data}});
  size_t repeated = rank_set(executor, both, n);
  if (std::decay_t<decltype(executor)>::kCounts)
    repeated = static_cast<size_t>(expected_hard_part(work) * static_cast<double>(n));
  else
    check_mesh_size({n + repeated, smooth.triangles});
  if (!std::decay_t<decltype(executor)>::kCounts && splits_creases(work) && n > 0)
    work.facts->found.crest = exponent_of_part(static_cast<double>(repeated) / static_cast<double>(n));
  MeshShape shape = work.shape;
  shape.repeated = repeated;
  MeshMemoryView hard = work.memory.allocate_mesh(executor, n + repeated, smooth.triangles, shape,
                                                  MeshPurpose::kDelivered, work.plan.mesh_in_pieces);
  add_normals(work, false, &hard);
  executor.for_each(n, SplitVertex{smooth.view, hard.view, n, both, second.data});
  executor.for_each(smooth.triangles, SplitTriangle{smooth.view, hard.view, n, both});
  hard.bounds = smooth.bounds;
  hard.components = smooth.components;
  return hard;
}

}  // namespace quickses
