// SPDX-License-Identifier: MIT
// The connected pieces of a mesh, with area and signed volume: outer surfaces enclose a positive volume, cavities a
// negative one. Vertices are joined along the edges of the triangles into trees whose roots are the smallest vertices.
#pragma once

#include "parallel/growing_buffer.h"
#include "parallel/host_memory.h"
#include "surface/mesh/mesh_memory.h"
#include "surface/stages/host_components.h"
#include "surface/stages/measure.h"

namespace quickses {

// ---- which component a vertex belongs to -----------------------------------------------------------------------

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

// Joins the trees of a triangle's corners. Parents only ever get smaller, and a link that another thread replaces in
// between is made anew from where it led.
struct JoinCorners {
  const uint32_t *indices;
  uint32_t *parents;
  QSES_HOST_DEVICE void operator()(size_t triangle) const {
    const uint32_t *const t = indices + 3 * triangle;
    join(t[0], t[1]);
    join(t[1], t[2]);
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
  QSES_HOST_DEVICE void operator()(size_t v) const {
    atomic_store(parents + v, find_root(parents, static_cast<uint32_t>(v)));
  }
};

// Fills labels[vertex] with the smallest vertex number of its component.
template <class Executor>
void label_components(Executor &executor, const MeshView &mesh, const MeshCounts &counts, uint32_t *labels) {
  executor.for_each(counts.vertices, StartLabels{labels});
  executor.for_each(counts.triangles, JoinCorners{mesh.indices, labels});
  executor.for_each(counts.vertices, LabelWithRoot{labels});
}

// ---- what each component measures ------------------------------------------------------------------------------

struct IsRoot {
  const uint32_t *labels;
  QSES_HOST_DEVICE uint64_t operator()(size_t v) const { return labels[v] == v ? 1 : 0; }
};

// Sums as integers, so that they do not depend on the order: areas in squared spacings, volumes in cubed ones, rounded
// down, and the rests in units so small that as many as there are triangles just fit.
struct ComponentSums {
  uint64_t triangles;
  int64_t area, area_rest, volume, volume_rest;
};

// Rests are multiples of 1 / this.
inline double rest_units(uint64_t triangles) {
  int bits = 62;
  for (; triangles > 0; triangles >>= 1) --bits;
  return std::ldexp(1.0, bits);
}

QSES_FN void add_to_sum(double value, double units, int64_t *sum, int64_t *rest) {
  const double whole = floor(value);
  *sum += static_cast<int64_t>(whole);
  *rest += static_cast<int64_t>((value - whole) * units + 0.5);
}

QSES_FN void add_sums(const ComponentSums &from, ComponentSums *to) {
  if (from.triangles == 0) return;
  atomic_add(&to->triangles, from.triangles);
  atomic_add(&to->area, from.area);
  atomic_add(&to->area_rest, from.area_rest);
  atomic_add(&to->volume, from.volume);
  atomic_add(&to->volume_rest, from.volume_rest);
}

// Of the component that the first triangle of a chunk belongs to, as a rule that of them all.
struct ChunkSums {
  uint32_t number;
  ComponentSums sums;
};

struct SumComponents {
  static constexpr size_t kChunk = 2048;
  MeshView mesh;
  size_t triangles;
  const uint32_t *labels, *number_of_root;
  double inverse_spacing, units;
  bool bent;  // along the normals of the vertices
  ComponentSums *sums;

  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, ChunkSums &chunk, size_t k) const {
    const size_t begin = k * kChunk, end = begin + kChunk < triangles ? begin + kChunk : triangles;
    if (team.rank() == 0) chunk = {number_of_root[labels[mesh.triangle(begin)[0]]], {}};
    team.sync();
    uint32_t number = chunk.number;
    ComponentSums own = {};
    for (size_t t = begin + static_cast<size_t>(team.rank()); t < end; t += static_cast<size_t>(team.size())) {
      const uint32_t root = labels[mesh.triangle(t)[0]];
      if (number_of_root[root] != number) {
        add_sums(own, number == chunk.number ? &chunk.sums : sums + number);
        own = {};
        number = number_of_root[root];
      }
      add_triangle(mesh.triangle(t), root, &own);
    }
    add_sums(own, number == chunk.number ? &chunk.sums : sums + number);
    team.sync();
    if (team.rank() == 0) add_sums(chunk.sums, sums + chunk.number);
  }

 private:
  QSES_FN void add_triangle(const uint32_t *triangle, uint32_t root, ComponentSums *own) const {
    const float *const tip = mesh.position(root);
    const double origin[3] = {static_cast<double>(tip[0]), static_cast<double>(tip[1]), static_cast<double>(tip[2])};
    const TriangleSums t = measure_triangle(mesh, triangle, origin, bent);
    ++own->triangles;
    add_to_sum(t.area * inverse_spacing * inverse_spacing, units, &own->area, &own->area_rest);
    add_to_sum(t.volume * inverse_spacing * inverse_spacing * inverse_spacing, units, &own->volume, &own->volume_rest);
  }
};

inline qses_component describe_component(const ComponentSums &s, double units, double spacing) {
  const auto value = [&](int64_t whole, int64_t rest) {
    return static_cast<double>(whole) + static_cast<double>(rest) / units;
  };
  qses_component c{};
  c.triangles = s.triangles;
  c.area = value(s.area, s.area_rest) * spacing * spacing;
  c.volume = value(s.volume, s.volume_rest) * spacing * spacing * spacing;
  c.is_cavity = c.volume < 0 ? 1 : 0;
  return c;
}

// ---- the list --------------------------------------------------------------------------------------------------

// Host memory for the components of one mesh. It only grows.
class ComponentMemory {
 public:
  // For n components, in memory of the next call of each.
  Span<ComponentSums> sums(size_t n) {
    return {static_cast<ComponentSums *>(sums_.reserve(n * sizeof(ComponentSums))), n};
  }
  Span<qses_component> list(size_t n) {
    return {static_cast<qses_component *>(list_.reserve(n * sizeof(qses_component))), n};
  }
  uint64_t bytes() const { return sums_.size() + list_.size(); }

 private:
  GrowingBuffer<HostMemory> sums_, list_;
};

// The components in the order of their first vertices; valid until the next call with the same memory. Waits.
template <class Executor>
Span<const qses_component> find_components(Executor &executor, const MeshView &mesh, const MeshCounts &counts,
                                           float spacing, bool bent, ComponentMemory &memory) {
  if (counts.triangles == 0) return {};
  const auto mark = executor.arena().mark();
  const size_t n = counts.vertices;
  const Span<uint32_t> labels = executor.template allocate<uint32_t>(n);
  label_components(executor, mesh, counts, labels.data);
  const Span<uint32_t> number_of_root = executor.template allocate<uint32_t>(n + 1);
  executor.exclusive_scan(n, IsRoot{labels.data}, number_of_root);
  const size_t count = executor.fetch(number_of_root.data + n);

  const Span<ComponentSums> found = memory.sums(count);
  const Span<ComponentSums> sums = Executor::kIsCuda ? executor.template allocate<ComponentSums>(count) : found;
  executor.fill(sums, 0);
  const double h = static_cast<double>(spacing), units = rest_units(counts.triangles);
  executor.template for_each_brick<ChunkSums>(
      (counts.triangles + SumComponents::kChunk - 1) / SumComponents::kChunk,
      SumComponents{mesh, counts.triangles, labels.data, number_of_root.data, 1.0 / h, units, bent, sums.data}, 1);
  if (Executor::kIsCuda) executor.download(found.data, sums.data, count);
  executor.wait();
  executor.arena().rewind(mark);

  const Span<qses_component> components = memory.list(count);
  for (size_t k = 0; k < count; ++k) components[k] = describe_component(found[k], units, h);
  return {components.data, count};
}

// Finds them where the mesh is, with memory that is kept: on the device, or, for a mesh that left it in pieces, by the
// CPU's threads. The numbers are the same.
class ComponentFinder {
 public:
  // threads: used only for meshes that left the device.
  explicit ComponentFinder(const WorkerThreads &threads) : on_host_(threads) {}
  template <class Executor>
  Span<const qses_component> find(Executor &executor, const MeshMemoryView &mesh, float spacing, bool bent) {
    const MeshCounts counts{mesh.vertices, mesh.triangles};
    if (!mesh.in_pieces) return find_components(executor, mesh.view, counts, spacing, bent, memory_);
    executor.wait();
    return Executor::kCounts ? Span<const qses_component>{} : on_host_.find(mesh.view, counts, spacing, bent, memory_);
  }
  uint64_t bytes() const { return memory_.bytes() + on_host_.bytes(); }

 private:
  ComponentMemory memory_;
  HostComponents on_host_;
};

}  // namespace quickses
