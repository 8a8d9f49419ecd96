// SPDX-License-Identifier: MIT
// What each connected piece of a mesh measures: area, signed volume, centre and box. All of them together measure what
// the mesh does.
#pragma once

#include "surface/stages/component_labels.h"
#include "surface/stages/measure.h"
#include "surface/stages/triangle_measures.h"

namespace quickses {

struct IsRoot {
  const uint32_t *labels;
  QSES_HOST_DEVICE uint64_t operator()(size_t v) const { return labels[v] == v ? 1 : 0; }
};

// A sum as integers, so that it does not depend on the order: whole parts, and the rests in units so small that as many
// as there are triangles just fit.
struct ExactSum {
  int64_t whole, rest;
  QSES_FN void add(double value, double units) {
    const int64_t part = static_cast<int64_t>(value);
    whole += part;
    rest += static_cast<int64_t>((value - static_cast<double>(part)) * units);
  }
  double value(double units) const { return static_cast<double>(whole) + static_cast<double>(rest) / units; }
};
QSES_FN void atomic_add(ExactSum *sum, const ExactSum &more) {
  atomic_add(&sum->whole, more.whole);
  atomic_add(&sum->rest, more.rest);
}

// Lengths in spacings, from the first vertex of the component.
struct ComponentSums {
  uint64_t triangles;
  ExactSum area, volume;
  ExactSum flat_area, flat_volume, moment[3];  // of the triangles as they are
  ExactSum facing;                             // facing_area(), where normals bend the triangles
  uint32_t most[6];                            // greatest x, y, z and -x, -y, -z, as ordered bits
  float first[3];                              // the first vertex
  uint32_t unplaced;                           // of the first component: what comes along
};

// Rests are multiples of 1 / this.
inline double rest_units(uint64_t triangles) {
  int bits = 62;
  for (; triangles > 0; triangles >>= 1) --bits;
  return std::ldexp(1.0, bits);
}

// Of a run of triangles of one component, by one thread.
struct RunSums {
  ComponentSums sums{};
  Box box{{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

  QSES_FN const ComponentSums &total() {
    for (int d = 0; d < 3; ++d) {
      // A zero has one sign, whichever came first.
      sums.most[d] = ordered_bits(box.high[d] + 0.f);
      sums.most[d + 3] = ordered_bits(-(box.low[d] + 0.f));
    }
    return sums;
  }
};

QSES_FN void add_sums(const ComponentSums &from, ComponentSums *to) {
  if (from.triangles == 0) return;
  atomic_add(&to->triangles, from.triangles);
  atomic_add(&to->area, from.area);
  atomic_add(&to->volume, from.volume);
  atomic_add(&to->flat_area, from.flat_area);
  atomic_add(&to->flat_volume, from.flat_volume);
  atomic_add(&to->facing, from.facing);
  for (int d = 0; d < 3; ++d) atomic_add(to->moment + d, from.moment[d]);
  for (int d = 0; d < 6; ++d) atomic_max(to->most + d, from.most[d]);
}

// Of the component that the first triangle of a chunk belongs to, as a rule that of them all.
struct ChunkSums {
  uint32_t number;
  ComponentSums sums;
};

// The number of the component with a root. If there are more than anticipated, the last one stands for the others: all
// will be done again.
struct ComponentNumbers {
  const uint32_t *of_root;
  uint32_t count;
  QSES_FN uint32_t operator()(uint32_t root) const {
    const uint32_t number = of_root[root];
    return number < count ? number : count - 1;
  }
};

// Numbers the vertices' components, and tells each component its first vertex.
struct NumberComponents {
  MeshView mesh;
  const uint32_t *labels;
  ComponentNumbers number_of;
  const uint32_t *unplaced;
  ComponentSums *sums;
  QSES_HOST_DEVICE void operator()(size_t v) const {
    const uint32_t vertex = static_cast<uint32_t>(v), number = number_of(labels[v]);
    if (mesh.component_ids) mesh.component_id(vertex) = number;
    if (labels[v] != vertex) return;
    for (int d = 0; d < 3; ++d) sums[number].first[d] = mesh.position(vertex)[d];
    if (v == 0 && unplaced) sums->unplaced = *unplaced;
  }
};

struct SumComponents {
  MeshView mesh;
  size_t triangles, chunk_size;
  const uint32_t *labels;
  ComponentNumbers number_of;
  double inverse_spacing, units;
  bool bent;  // along the normals of the vertices
  ComponentSums *sums;

  template <class Team>
  QSES_FN void operator()(const Team &team, ChunkSums &chunk, size_t k) const {
    const size_t begin = k * chunk_size, end = begin + chunk_size < triangles ? begin + chunk_size : triangles;
    if (team.rank() == 0) chunk = {number_of(labels[mesh.triangle(begin)[0]]), {}};
    team.sync();
    uint32_t number = chunk.number;
    RunSums own;
    measure_each(team, begin, end,
                 [&](size_t t, uint32_t root, const Vec3<double> &origin, const TriangleSums &measured) {
                   if (number_of(root) != number) {
                     add_sums(own.total(), number == chunk.number ? &chunk.sums : sums + number);
                     own = RunSums{};
                     number = number_of(root);
                   }
                   add_triangle(mesh.triangle(t), origin, measured, &own);
                 });
    add_sums(own.total(), number == chunk.number ? &chunk.sums : sums + number);
    team.sync();
    if (team.rank() == 0) add_sums(chunk.sums, sums + chunk.number);
  }

 private:
  QSES_FN uint32_t root_of(size_t triangle) const { return labels[mesh.triangle(triangle)[0]]; }
  QSES_FN Vec3<double> origin_of(uint32_t root) const {
    const float *const tip = mesh.position(root);
    return {static_cast<double>(tip[0]), static_cast<double>(tip[1]), static_cast<double>(tip[2])};
  }
  // visit(triangle, root, origin, what it measures from there), for all triangles that a thread of the team has.
  template <class Team, class Visit>
  QSES_FN void measure_each(const Team &team, size_t begin, size_t end, const Visit &visit) const {
    for (size_t t = begin + static_cast<size_t>(team.rank()); t < end; t += static_cast<size_t>(team.size())) {
      const uint32_t root = root_of(t);
      const Vec3<double> origin = origin_of(root);
      visit(t, root, origin, measure_triangle(mesh, t, origin, bent));
    }
  }
  template <class Visit>
  void measure_each(const SoloTeam &, size_t begin, size_t end, const Visit &visit) const {
    TriangleSums measured[kTriangleRun];
    for (size_t t = begin, run = 1; t < end; t += run) {
      const uint32_t root = root_of(t);
      for (run = 1; run < kTriangleRun && t + run < end && root_of(t + run) == root;) ++run;
      const Vec3<double> origin = origin_of(root);
      measure_triangles({mesh, origin, bent}, t, run, measured);
      for (size_t k = 0; k < run; ++k) visit(t + k, root, origin, measured[k]);
    }
  }

  QSES_FN void add_triangle(const uint32_t *triangle, const Vec3<double> &origin, const TriangleSums &t,
                            RunSums *own) const {
    const double per_area = inverse_spacing * inverse_spacing, per_volume = per_area * inverse_spacing;
    // Rounded before their whole parts are taken off.
    const double flat_volume = rounded_product(t.flat_volume, per_volume);
    ComponentSums &own_sums = own->sums;
    ++own_sums.triangles;
    own_sums.area.add(rounded_product(t.area, per_area), units);
    own_sums.volume.add(rounded_product(t.volume, per_volume), units);
    own_sums.flat_area.add(rounded_product(t.flat_area, per_area), units);
    own_sums.flat_volume.add(flat_volume, units);
    if (bent) own_sums.facing.add(rounded_product(facing_area(mesh, triangle), per_area), units);
    for (int k = 0; k < 3; ++k) {
      double sum = -3.0 * (k == 0 ? origin.x : k == 1 ? origin.y : origin.z);
      for (int corner = 0; corner < 3; ++corner) {
        const float x = mesh.position(triangle[corner])[k];
        sum += static_cast<double>(x);
        own->box.low[k] = x < own->box.low[k] ? x : own->box.low[k];
        own->box.high[k] = own->box.high[k] < x ? x : own->box.high[k];
      }
      own_sums.moment[k].add(rounded_product(flat_volume, 0.25 * inverse_spacing * sum), units);
    }
  }
};

inline TriangleSums measured_sums(const ComponentSums &s, double units, double spacing) {
  const double h2 = spacing * spacing, h3 = h2 * spacing;
  return {s.area.value(units) * h2, s.volume.value(units) * h3, s.flat_area.value(units) * h2,
          s.flat_volume.value(units) * h3};
}
inline Bounds bounds_of(const ComponentSums &s) {
  Bounds b;
  for (int d = 0; d < 3; ++d) {
    b.min[d] = -from_ordered_bits(s.most[d + 3]);
    b.max[d] = from_ordered_bits(s.most[d]);
  }
  return b;
}

inline qses_component describe_component(const ComponentSums &s, double units, double spacing) {
  qses_component c{};
  const TriangleSums measured = measured_sums(s, units, spacing);
  const Bounds bounds = bounds_of(s);
  c.triangles = s.triangles;
  c.area = measured.area;
  c.volume = measured.volume;
  // What bounds a hollow in the mesh, however small; but no speck that its relaxation has turned inside out, away from
  // its normals.
  c.is_cavity = measured.flat_volume < 0 && s.facing.value(units) >= 0 ? 1 : 0;
  bool is_within = true;
  double center[3];
  for (int d = 0; d < 3; ++d) {
    c.bounds_min[d] = bounds.min[d];
    c.bounds_max[d] = bounds.max[d];
    center[d] = static_cast<double>(s.first[d]) + s.moment[d].value(units) / s.flat_volume.value(units) * spacing;
    is_within = is_within && center[d] >= static_cast<double>(c.bounds_min[d]) &&
                center[d] <= static_cast<double>(c.bounds_max[d]);
  }
  // What encloses next to nothing has no centre that can be told: then it is that of the box.
  for (int d = 0; d < 3; ++d)
    c.center[d] = static_cast<float>(
        is_within ? center[d] : 0.5 * (static_cast<double>(c.bounds_min[d]) + static_cast<double>(c.bounds_max[d])));
  return c;
}

}  // namespace quickses
