// SPDX-License-Identifier: MIT
// Which connected piece of a mesh a vertex belongs to. Vertices are joined along the edges of the triangles into trees
// whose roots are the smallest vertices.
#pragma once

#include "parallel/anticipation.h"
#include "parallel/atomics.h"
#include "parallel/executor.h"
#include "surface/stages/mesh_layout.h"

namespace quickses {

// Parents have smaller numbers than their children; a root is its own parent.
struct StartLabels {
  uint32_t *parents;
  QSES_HOST_DEVICE void operator()(size_t v) const { parents[v] = static_cast<uint32_t>(v); }
};

QSES_FN uint32_t find_root(uint32_t *parents, uint32_t v) {
  for (;;) {
    const uint32_t parent = atomic_load(parents + v), next = atomic_load(parents + parent);
    if (next == parent) return parent;
    atomic_min(parents + v, next);  // half of the way for whoever comes next
    v = next;
  }
}

// Of a triangle of a closed mesh, the edges that lead to a larger number: each edge of the mesh is met once, since its
// other triangle has it the other way round.
template <class Visit>
QSES_FN void for_rising_edges(const uint32_t *corners, const Visit &visit) {
  for (int k = 0; k < 3; ++k) {
    const uint32_t a = corners[k], b = corners[next_corner(k)];
    if (a < b) visit(a, b);
  }
}

// Hangs the trees of a triangle's corners under each other. Where several are hung at once, one link stays and the
// others are lost: joining the corners makes them anew. Few trees are left for that (hooking, as in ECL-CC, Jaiganesh
// and Burtscher 2018).
struct HookCorners {
  const uint32_t *indices;
  uint32_t *parents;
  QSES_HOST_DEVICE void operator()(size_t triangle) const {
    for_rising_edges(indices + 3 * triangle, [this](uint32_t a, uint32_t b) {
      const uint32_t p = atomic_load(parents + a), q = atomic_load(parents + b);
      if (p != q) atomic_min(parents + (p < q ? q : p), p < q ? p : q);
    });
  }
};

// Joins the trees of a triangle's corners, of a closed mesh. Parents only ever get smaller, and a link that another
// thread replaces in between is made anew from where it led.
struct JoinCorners {
  const uint32_t *indices;
  uint32_t *parents;
  QSES_HOST_DEVICE void operator()(size_t triangle) const {
    for_rising_edges(indices + 3 * triangle, [this](uint32_t low, uint32_t high) { join(low, high); });
  }

 private:
  QSES_FN void join(uint32_t a, uint32_t b) const {
    for (;;) {
      a = find_root(parents, a);
      b = find_root(parents, b);
      if (a == b) return;
      const uint32_t low = a < b ? a : b, high = a < b ? b : a, before = atomic_min(parents + high, low);
      if (before == high) return;
      a = before;
      b = low;
    }
  }
};

struct LabelWithRoot {
  uint32_t *parents;
  Tally<uint32_t> *roots;  // nullptr: not counted
  QSES_HOST_DEVICE void operator()(size_t v) const {
    const uint32_t root = find_root(parents, static_cast<uint32_t>(v));
    atomic_store(parents + v, root);
    if (roots && root == v) atomic_add(&roots->count, 1u);
  }
};

// Fills labels[vertex] with the smallest vertex number of its component, and adds to the number of components.
template <class Executor>
void label_components(Executor &executor, const MeshView &mesh, const MeshCounts &counts, uint32_t *labels,
                      Tally<uint32_t> *components) {
  executor.for_each(counts.vertices, StartLabels{labels});
  constexpr int kHookings = Executor::kIsCuda ? 3 : 0;  // the few threads of a CPU hardly meet
  for (int k = 0; k < kHookings; ++k) {
    executor.for_each(counts.triangles, HookCorners{mesh.indices, labels});
    executor.for_each(counts.vertices, LabelWithRoot{labels, nullptr});
  }
  executor.for_each(counts.triangles, JoinCorners{mesh.indices, labels});
  executor.for_each(counts.vertices, LabelWithRoot{labels, components});
}

}  // namespace quickses
