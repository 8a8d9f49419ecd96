// SPDX-License-Identifier: MIT
// Area, enclosed volume and bounding box of a closed mesh.
#pragma once

#include "parallel/atomics.h"
#include "quickses/quickses.h"
#include "surface/mesh/mesh_memory.h"
#include "surface/stages/marching_cubes.h"
#include "surface/stages/triangle_measures.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace quickses {

struct Measures {
  TriangleSums sums;  // Å², Å³; volume is positive if the surface encloses it; cavities count negative
  Bounds bounds;
};

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

// What is summed up of a mesh: of vertices their box, and of triangles, if these are measured, what they measure.
struct Nothing {
  QSES_FN Nothing &operator+=(const Nothing &) { return *this; }
};
template <bool kMeasured>
struct MeshSums : std::conditional_t<kMeasured, TriangleSums, Nothing> {
  using Triangles = std::conditional_t<kMeasured, TriangleSums, Nothing>;
  uint32_t low[3] = {~uint32_t(0), ~uint32_t(0), ~uint32_t(0)}, high[3] = {0, 0, 0};  // as ordered bits
  uint64_t unplaced = 0;
  QSES_FN MeshSums &operator+=(const MeshSums &other) {
    Triangles::operator+=(other);
    for (int d = 0; d < 3; ++d) {
      low[d] = other.low[d] < low[d] ? other.low[d] : low[d];
      high[d] = other.high[d] > high[d] ? other.high[d] : high[d];
    }
    unplaced += other.unplaced;
    return *this;
  }
};

// By number of a vertex, and of a triangle.
template <bool kMeasured>
struct LoadMeshSums {
  MeshView mesh;
  size_t vertices, triangles;
  MeasureTriangle measure;
  const uint32_t *unplaced;
  size_t items() const { return kMeasured ? std::max(vertices, triangles) : vertices; }
  QSES_FN MeshSums<kMeasured> operator()(size_t i) const {
    MeshSums<kMeasured> s;
    if (i < vertices)
      for (int d = 0; d < 3; ++d) s.low[d] = s.high[d] = ordered_bits(mesh.position(static_cast<uint32_t>(i))[d]);
    if constexpr (kMeasured) {
      if (i < triangles) static_cast<TriangleSums &>(s) = measure(i);
    }
    if (i == 0 && unplaced) s.unplaced = *unplaced;
    return s;
  }
  // On the CPU.
  void add_run(size_t begin, size_t end, MeshSums<kMeasured> *sum) const {
    if constexpr (kMeasured) {
      TriangleSums measured[kTriangleRun];
      for (size_t t = begin; t < std::min(end, triangles); t += kTriangleRun) {
        const size_t run = std::min(kTriangleRun, std::min(end, triangles) - t);
        measure_triangles(measure, t, run, measured);
        for (size_t k = 0; k < run; ++k) static_cast<TriangleSums &>(*sum) += measured[k];
      }
    }
    const size_t last = std::min(end, vertices);
    if (begin < last) {
      float low[3], high[3];
      std::memcpy(low, mesh.position(static_cast<uint32_t>(begin)), sizeof low);
      std::memcpy(high, low, sizeof high);
      for (size_t v = begin + 1; v < last; ++v) {
        const float *const p = mesh.position(static_cast<uint32_t>(v));
        for (int d = 0; d < 3; ++d) {
          low[d] = std::min(low[d], p[d]);
          high[d] = std::max(high[d], p[d]);
        }
      }
      for (int d = 0; d < 3; ++d) {
        sum->low[d] = std::min(sum->low[d], ordered_bits(low[d]));
        sum->high[d] = std::max(sum->high[d], ordered_bits(high[d]));
      }
    }
    if (begin == 0 && unplaced) sum->unplaced += *unplaced;
  }
};

// unplaced: how many vertices are, in memory of the back end, which comes along so that nobody waits for it alone;
// nullptr: none.
inline LoadMeshSums<false> bound_sums(const MeshView &mesh, const MeshCounts &counts, const uint32_t *unplaced) {
  return {mesh, counts.vertices, 0, {}, unplaced};
}
// bent: along the exact normals that the vertices have. origin: a place near the mesh, from which volumes are counted.
inline LoadMeshSums<true> measured_sums(const MeshView &mesh, const MeshCounts &counts, bool bent, const double *origin,
                                        const uint32_t *unplaced) {
  return {mesh, counts.vertices, counts.triangles, {mesh, {origin[0], origin[1], origin[2]}, bent}, unplaced};
}

template <bool kMeasured>
Bounds bounds_of(const MeshSums<kMeasured> &found) {
  Bounds bounds;
  for (int d = 0; d < 3; ++d) {
    // Of two zeros, either may have been found.
    bounds.min[d] = from_ordered_bits(found.low[d]) + 0.f;
    bounds.max[d] = from_ordered_bits(found.high[d]) + 0.f;
  }
  return bounds;
}

// unplaced: gets their number; may be nullptr. Waits.
template <class Executor, bool kMeasured>
Measures sum_mesh(Executor &executor, const LoadMeshSums<kMeasured> &load, uint64_t *unplaced) {
  Measures m = {};
  if (load.vertices == 0) return m;
  const auto found = executor.template reduce<MeshSums<kMeasured>>(load.items(), load);
  if (unplaced) *unplaced = found.unplaced;
  if constexpr (kMeasured) m.sums = found;
  m.bounds = bounds_of(found);
  return m;
}

// Box of the vertices. Waits.
template <class Executor>
Bounds find_bounds(Executor &executor, const MeshView &mesh, const MeshCounts &counts) {
  return sum_mesh(executor, bound_sums(mesh, counts, nullptr), nullptr).bounds;
}

inline void note_measures(const TriangleSums &sums, qses_report *report) {
  report->area = sums.area;
  report->volume = sums.volume;
  report->triangle_area = sums.flat_area;
  report->triangle_volume = sums.flat_volume;
}

// On a GPU, the sums without waiting, as far as there is room for all parts of them.
template <class Executor, bool kMeasured>
bool send_sums(Executor &executor, const LoadMeshSums<kMeasured> &load, ComingSums *coming) {
  const auto parts = executor.template reduce_later<MeshSums<kMeasured>>(load.items(), load);
  *coming = {parts.data, parts.size, kMeasured};
  return parts.size > 0;
}
template <bool kMeasured>
void settle_parts(const ComingSums &coming, Bounds *bounds, qses_report *report) {
  MeshSums<kMeasured> sum{};
  for (size_t k = 0; k < coming.count; ++k) sum += static_cast<const MeshSums<kMeasured> *>(coming.parts)[k];
  *bounds = bounds_of(sum);
  report->unplaced_vertices = sum.unplaced;
  if constexpr (kMeasured) note_measures(sum, report);
}
// When something has been waited for.
inline void settle_sums(const ComingSums &coming, Bounds *bounds, qses_report *report) {
  if (coming.count == 0) return;
  if (coming.are_measured)
    settle_parts<true>(coming, bounds, report);
  else
    settle_parts<false>(coming, bounds, report);
}

}  // namespace quickses
