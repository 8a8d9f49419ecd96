// SPDX-License-Identifier: MIT
// Area, enclosed volume and bounding box of a closed mesh.
#pragma once

#include "parallel/atomics.h"
#include "parallel/scalar.h"
#include "surface/mesh/mesh_memory.h"
#include "surface/stages/marching_cubes.h"

#include <cstring>

namespace quickses {

struct Measures {
  double area;    // Å², sum over the triangles
  double volume;  // Å³, positive if the surface encloses it; cavities count negative
  Bounds bounds;
};

// ---- bounds ----------------------------------------------------------------------------------------------------

// A float as an integer that is ordered like it.
QSES_FN uint32_t ordered_bits(float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}
QSES_FN float from_ordered_bits(uint32_t ordered) {
  const uint32_t bits = ordered & 0x80000000u ? ordered & 0x7fffffffu : ~ordered;
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

// Smallest x, y, z and smallest -x, -y, -z, as ordered bits.
struct BoundsScratch {
  uint32_t least[6];
};

struct FindBounds {
  static constexpr size_t kChunk = 8192;
  MeshView mesh;
  size_t vertices;
  const uint32_t *extra;  // a number to be copied behind the six, or nullptr
  uint32_t *least;
  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, BoundsScratch &scratch, size_t chunk) const {
    for (int d = team.rank(); d < 6; d += team.size()) scratch.least[d] = ~uint32_t(0);
    team.sync();
    const size_t begin = chunk * kChunk, end = begin + kChunk < vertices ? begin + kChunk : vertices;
    uint32_t own[6] = {~uint32_t(0), ~uint32_t(0), ~uint32_t(0), ~uint32_t(0), ~uint32_t(0), ~uint32_t(0)};
    for (size_t v = begin + static_cast<size_t>(team.rank()); v < end; v += static_cast<size_t>(team.size()))
      for (int d = 0; d < 3; ++d) {
        const float x = mesh.position(static_cast<uint32_t>(v))[d];
        const uint32_t low = ordered_bits(x), high = ordered_bits(-x);
        own[d] = low < own[d] ? low : own[d];
        own[d + 3] = high < own[d + 3] ? high : own[d + 3];
      }
    for (int d = 0; d < 6; ++d) atomic_min(scratch.least + d, own[d]);
    team.sync();
    for (int d = team.rank(); d < 6; d += team.size()) atomic_min(least + d, scratch.least[d]);
    if (chunk == 0 && team.rank() == 0) least[6] = extra ? *extra : 0;
    team.sync();
  }
};

// Box of the vertices. A number in the back end's memory, if there is one, comes along, so that nobody waits for it
// alone. Waits.
template <class Executor>
Bounds find_bounds(Executor &executor, const MeshView &mesh, const MeshCounts &counts, const uint32_t *extra = nullptr,
                   uint64_t *extra_value = nullptr) {
  Bounds bounds = {};
  if (counts.vertices == 0) return bounds;
  const auto mark = executor.arena().mark();
  constexpr size_t kNumbers = 7;
  Span<uint32_t> least = executor.template allocate<uint32_t>(kNumbers);
  executor.fill(least, 0xff);
  executor.template for_each_brick<BoundsScratch>((counts.vertices + FindBounds::kChunk - 1) / FindBounds::kChunk,
                                                  FindBounds{mesh, counts.vertices, extra, least.data});
  uint32_t found[kNumbers] = {};
  executor.download(found, least.data, kNumbers);
  executor.wait();
  executor.arena().rewind(mark);
  if (extra_value) *extra_value = found[6];
  for (int d = 0; d < 3; ++d) {
    bounds.min[d] = from_ordered_bits(found[d]);
    bounds.max[d] = -from_ordered_bits(found[d + 3]);
  }
  return bounds;
}

// ---- area and volume -------------------------------------------------------------------------------------------

struct DoubleTriangle {
  double a[3], u[3], n[3];  // a corner, the edge from it to the second one, and twice the area along the normal
};

// Coordinates are taken from an origin near the mesh, so that the volume keeps its digits far away from zero. GPU and
// CPU find the same numbers to the last bit.
QSES_FN DoubleTriangle load_triangle(const MeshView &mesh, const uint32_t *t, const double *origin) {
  DoubleTriangle d;
  double v[3];
  for (int k = 0; k < 3; ++k) {
    d.a[k] = static_cast<double>(mesh.position(t[0])[k]) - origin[k];
    d.u[k] = static_cast<double>(mesh.position(t[1])[k]) - origin[k] - d.a[k];
    v[k] = static_cast<double>(mesh.position(t[2])[k]) - origin[k] - d.a[k];
  }
  for (int k = 0; k < 3; ++k) {
    const int p = (k + 1) % 3, q = (k + 2) % 3;
    d.n[k] = rounded_product(d.u[p], v[q]) - rounded_product(d.u[q], v[p]);
  }
  return d;
}
QSES_FN double dot_product(const double *a, const double *b) {
  return rounded_product(a[0], b[0]) + rounded_product(a[1], b[1]) + rounded_product(a[2], b[2]);
}
QSES_FN double triangle_area(const DoubleTriangle &d) { return 0.5 * sqrt(dot_product(d.n, d.n)); }
// Signed volume of the tetrahedron over the triangle with its apex at the origin.
QSES_FN double triangle_volume(const DoubleTriangle &d) { return dot_product(d.a, d.n) / 6.0; }

// Area and volume of one triangle.
struct TriangleMeasures {
  MeshView mesh;
  double origin[3];
  QSES_HOST_DEVICE SumPair operator()(size_t t) const {
    const DoubleTriangle d = load_triangle(mesh, mesh.triangle(t), origin);
    SumPair pair;
    pair.first = triangle_area(d);
    pair.second = triangle_volume(d);
    return pair;
  }
};

// Brings an extra number along, too. Waits.
template <class Executor>
Measures measure(Executor &executor, const MeshView &mesh, const MeshCounts &counts, const uint32_t *extra = nullptr,
                 uint64_t *extra_value = nullptr) {
  Measures m = {0.0, 0.0, find_bounds(executor, mesh, counts, extra, extra_value)};
  if (counts.triangles == 0) return m;
  double c[3];
  for (int d = 0; d < 3; ++d)
    c[d] = 0.5 * (static_cast<double>(m.bounds.min[d]) + static_cast<double>(m.bounds.max[d]));
  const SumPair sums = executor.template reduce<SumPair>(counts.triangles, TriangleMeasures{mesh, {c[0], c[1], c[2]}});
  m.area = sums.first;
  m.volume = mesh.reversed ? -sums.second : sums.second;
  return m;
}

}  // namespace quickses
