// SPDX-License-Identifier: MIT
// The connected pieces of a mesh, with area and signed volume: outer surfaces enclose a positive volume, cavities a
// negative one. Vertices take the smallest number they can reach: they hook each other's roots and then jump.
#pragma once

#include "surface/measure.h"

#include <vector>

namespace quickses {

struct Component {
  uint64_t triangles;
  double area;    // Å²
  double volume;  // Å³, negative for a cavity
  bool cavity;
};

// Hooks the roots of a triangle's corners to the smallest of them.
struct HookTriangle {
  const uint32_t *indices;
  uint32_t *parents;
  uint32_t *changes;
  QSES_HOST_DEVICE void operator()(size_t triangle) const {
    const uint32_t *t = indices + 3 * triangle;
    join(t[0], t[1]);
    join(t[1], t[2]);
  }

 private:
  QSES_FN void join(uint32_t a, uint32_t b) const {
    const uint32_t pa = atomic_load(parents + a), pb = atomic_load(parents + b);
    if (pa == pb) return;
    const uint32_t low = pa < pb ? pa : pb, high = pa < pb ? pb : pa;
    atomic_min(parents + high, low);
    atomic_store(changes, 1);
  }
};

// Follows the parents of a vertex to the root.
struct JumpToRoot {
  uint32_t *parents;
  QSES_HOST_DEVICE void operator()(size_t v) const {
    uint32_t root = atomic_load(parents + v);
    for (uint32_t next = atomic_load(parents + root); next != root; next = atomic_load(parents + root)) root = next;
    atomic_store(parents + v, root);
  }
};

struct StartLabels {
  uint32_t *parents;
  QSES_HOST_DEVICE void operator()(size_t v) const { parents[v] = static_cast<uint32_t>(v); }
};

// Fills labels[vertex] with the smallest vertex number of its component. Waits, a few times.
template <class Executor>
void label_components(Executor &executor, const MeshView &mesh, const MeshCounts &counts, uint32_t *labels) {
  const auto mark = executor.arena().mark();
  Span<uint32_t> changes = executor.template allocate<uint32_t>(1);
  executor.for_each(counts.vertices, StartLabels{labels});
  do {
    executor.fill(changes, 0);
    executor.for_each(counts.triangles, HookTriangle{mesh.indices, labels, changes.data});
    executor.for_each(counts.vertices, JumpToRoot{labels});
  } while (executor.fetch(changes.data) != 0);
  executor.arena().rewind(mark);
}

// ---- what each component measures ------------------------------------------------------------------------------

struct IsRoot {
  const uint32_t *labels;
  QSES_HOST_DEVICE bool operator()(size_t v) const { return labels[v] == v; }
};

struct NumberRoots {
  const uint32_t *roots;
  uint32_t *number_of_root;
  QSES_HOST_DEVICE void operator()(size_t k) const { number_of_root[roots[k]] = static_cast<uint32_t>(k); }
};

// Sums as integers, so that they do not depend on the order: areas in 2^-30 of a squared spacing, volumes in 2^-30 of a
// cubed one, in two parts. That is enough for 2^32 triangles. Coordinates are taken from the component's first vertex.
struct ComponentSums {
  uint64_t triangles;
  int64_t area;
  int64_t volume_high;  // in units, rounded down
  int64_t volume_low;   // the rest, in 2^-30 of a unit
};

constexpr double kComponentUnits = 1073741824.0;

struct AddTriangle {
  MeshView mesh;
  const uint32_t *labels, *number_of_root;
  double inverse_spacing;
  ComponentSums *sums;
  QSES_HOST_DEVICE void operator()(size_t triangle) const {
    const uint32_t *t = mesh.triangle(triangle), root = labels[t[0]];
    const float *const tip = mesh.position(root);
    const double origin[3] = {tip[0], tip[1], tip[2]};
    const DoubleTriangle d = load_triangle(mesh, t, origin);
    const double area = triangle_area(d) * inverse_spacing * inverse_spacing;
    const double volume = triangle_volume(d) * inverse_spacing * inverse_spacing * inverse_spacing;
    const double high = floor(volume);
    ComponentSums *sum = sums + number_of_root[root];
    atomic_add(&sum->triangles, uint64_t(1));
    atomic_add(&sum->area, static_cast<int64_t>(area * kComponentUnits + 0.5));
    atomic_add(&sum->volume_high, static_cast<int64_t>(high));
    atomic_add(&sum->volume_low, static_cast<int64_t>((volume - high) * kComponentUnits + 0.5));
  }
};

// The components in the order of their first vertices. Waits.
template <class Executor>
std::vector<Component> find_components(Executor &executor, const MeshView &mesh, const MeshCounts &counts,
                                       float spacing) {
  std::vector<Component> components;
  if (counts.triangles == 0) return components;
  const auto mark = executor.arena().mark();
  const size_t n = counts.vertices;
  Span<uint32_t> labels = executor.template allocate<uint32_t>(n);
  label_components(executor, mesh, counts, labels.data);
  Span<uint32_t> roots = executor.template allocate<uint32_t>(n);
  const size_t count = executor.compact(n, IsRoot{labels.data}, roots);
  Span<uint32_t> number_of_root = executor.template allocate<uint32_t>(n);
  executor.for_each(count, NumberRoots{roots.data, number_of_root.data});
  Span<ComponentSums> sums = executor.template allocate<ComponentSums>(count);
  executor.fill(sums, 0);
  const double h = static_cast<double>(spacing);
  executor.for_each(counts.triangles, AddTriangle{mesh, labels.data, number_of_root.data, 1.0 / h, sums.data});
  std::vector<ComponentSums> found(count);
  executor.download(found.data(), sums.data, count);
  executor.wait();
  executor.arena().rewind(mark);
  for (const ComponentSums &s : found) {
    const double units = static_cast<double>(s.volume_high) + static_cast<double>(s.volume_low) / kComponentUnits;
    const double volume = (mesh.reversed ? -1.0 : 1.0) * units * h * h * h;
    components.push_back({s.triangles, static_cast<double>(s.area) / kComponentUnits * h * h, volume, volume < 0});
  }
  return components;
}

}  // namespace quickses
