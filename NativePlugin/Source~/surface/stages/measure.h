// SPDX-License-Identifier: MIT
// Area, enclosed volume and bounding box of a closed mesh.
#pragma once

#include "parallel/atomics.h"
#include "surface/mesh/mesh_memory.h"
#include "surface/stages/marching_cubes.h"
#include "surface/stages/triangle_measures.h"

#include <cstring>

namespace quickses {

struct Measures {
  TriangleSums sums;  // Å², Å³; volume is positive if the surface encloses it; cavities count negative
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
  static constexpr size_t kChunk = 1024;
  MeshView mesh;
  size_t vertices;
  const uint32_t *extra;  // a number to be copied behind the six, or nullptr
  uint32_t *least;
  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, BoundsScratch &scratch, size_t chunk) const {
    for (int d = team.rank(); d < 6; d += team.size()) scratch.least[d] = ~uint32_t(0);
    team.sync();
    const size_t begin = chunk * kChunk, end = begin + kChunk < vertices ? begin + kChunk : vertices;
    uint32_t low[3] = {~uint32_t(0), ~uint32_t(0), ~uint32_t(0)}, high[3] = {0, 0, 0};
    for (size_t v = begin + static_cast<size_t>(team.rank()); v < end; v += static_cast<size_t>(team.size()))
      for (int d = 0; d < 3; ++d) {
        const uint32_t x = ordered_bits(mesh.position(static_cast<uint32_t>(v))[d]);
        low[d] = x < low[d] ? x : low[d];
        high[d] = x > high[d] ? x : high[d];
      }
    for (int d = 0; d < 3; ++d) {
      atomic_min(scratch.least + d, low[d]);
      atomic_min(scratch.least + d + 3, ~high[d]);  // the bits of -x
    }
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

// bent: along the exact normals that the vertices have. Brings an extra number along, too. Waits.
template <class Executor>
Measures measure(Executor &executor, const MeshView &mesh, const MeshCounts &counts, bool bent,
                 const uint32_t *extra = nullptr, uint64_t *extra_value = nullptr) {
  Measures m = {{}, find_bounds(executor, mesh, counts, extra, extra_value)};
  if (counts.triangles == 0) return m;
  double c[3];
  for (int d = 0; d < 3; ++d)
    c[d] = 0.5 * (static_cast<double>(m.bounds.min[d]) + static_cast<double>(m.bounds.max[d]));
  m.sums = executor.template reduce<TriangleSums>(counts.triangles, MeasureTriangle{mesh, {c[0], c[1], c[2]}, bent});
  return m;
}

}  // namespace quickses
