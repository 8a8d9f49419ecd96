// SPDX-License-Identifier: MIT
// Steps that move or describe the vertices of a whole mesh through its triangles: the Laplacian smoothing of the voxel
// method (QuickSES 2019, section 2.4), the tangential steps of the exact method, and area-weighted normals.
#pragma once

#include "parallel/atomics.h"
#include "surface/stages/hot_stages.h"
#include "surface/stages/side_normals.h"

namespace quickses {

// ---- sums over the triangles around each vertex ----------------------------------------------------------------

// Sums are kept as integers, in 2^-19 of a unit: integers add up to the same in any order. A vertex of marching cubes
// has at most 20 triangles, so with 40 terms of at most 64 units nothing overflows. Steps are given room for one sum
// per vertex.
constexpr float kRingUnits = 524288.f;
constexpr float kMaxRingTerm = 64.f;

// Two signed sums of 32 bits in one of 64, so that one atomic addition serves both.
QSES_FN int64_t two_sums(int32_t low, int32_t high) { return high * (int64_t(1) << 32) + low; }
QSES_FN int32_t low_sum(int64_t sums) { return static_cast<int32_t>(static_cast<uint32_t>(sums)); }
QSES_FN int32_t high_sum(int64_t sums) { return static_cast<int32_t>((sums - low_sum(sums)) >> 32); }

struct alignas(16) RingSum {
  int64_t x_and_y, z_and_count;
};

QSES_FN int32_t ring_term(float value, float scale) {
  const float v = value * scale;
  return static_cast<int32_t>(rintf(kRingUnits * minimum(kMaxRingTerm, maximum(-kMaxRingTerm, v))));
}

QSES_FN void add_to_ring(RingSum *sum, int32_t x, int32_t y, int32_t z, int32_t count) {
  atomic_add(&sum->x_and_y, two_sums(x, y));
  atomic_add(&sum->z_and_count, two_sums(z, count));
}

QSES_FN Vec3<float> ring_vector(const RingSum &sum, float unit) {
  const float k = unit / kRingUnits;
  return {static_cast<float>(low_sum(sum.x_and_y)) * k, static_cast<float>(high_sum(sum.x_and_y)) * k,
          static_cast<float>(low_sum(sum.z_and_count)) * k};
}

// Adds to each corner of a triangle the ways to the other two, in units of the spacing. On a closed mesh every
// neighbour is met twice, once in each triangle of their edge, so the mean of the ways is the plain mean over the
// neighbours.
struct AddNeighborOffsets {
  MeshView mesh;
  float inverse_spacing;
  RingSum *sums;
  QSES_HOST_DEVICE void operator()(size_t triangle) const {
    const uint32_t *t = mesh.triangle(triangle);
    const Vec3<float> a = load_vec3(mesh.position(t[0])), b = load_vec3(mesh.position(t[1])),
                      c = load_vec3(mesh.position(t[2]));
    const Vec3<float> ab = b - a, ac = c - a, bc = c - b;
    add(t[0], ab, ac);
    add(t[1], bc, ab * -1.f);
    add(t[2], ac * -1.f, bc * -1.f);
  }

 private:
  QSES_FN void add(uint32_t vertex, const Vec3<float> &u, const Vec3<float> &v) const {
    const auto both = [&](float a, float b) { return ring_term(a, inverse_spacing) + ring_term(b, inverse_spacing); };
    add_to_ring(sums + vertex, both(u.x, v.x), both(u.y, v.y), both(u.z, v.z), 2);
  }
};

// From a vertex to the mean of its neighbours.
QSES_FN Vec3<float> mean_offset(const RingSum &sum, float spacing) {
  const int32_t count = high_sum(sum.z_and_count);
  if (count == 0) return {0.f, 0.f, 0.f};
  return ring_vector(sum, spacing / static_cast<float>(count));
}

// ---- Laplacian smoothing ---------------------------------------------------------------------------------------

struct MoveToMean {
  const RingSum *sums;
  float spacing;
  MeshView mesh;
  QSES_HOST_DEVICE void operator()(size_t v) const {
    float *const position = mesh.position(static_cast<uint32_t>(v));
    store_vec3(position, load_vec3(position) + mean_offset(sums[v], spacing));
  }
};

// Every step puts every vertex at the mean of its neighbours, all with the same weight and without the vertex itself:
// the weights of the paper's program. That program moves the vertices one after the other, so that later ones see
// earlier ones moved; here all move at once, and the result does not depend on their order.
template <class Executor>
void smooth_laplacian(Executor &executor, const MeshView &mesh, const MeshCounts &counts, float spacing, uint32_t steps,
                      Span<RingSum> sums) {
  if (steps == 0 || counts.vertices == 0) return;
  for (uint32_t k = 0; k < steps; ++k) {
    executor.fill(sums, 0);
    executor.for_each(counts.triangles, AddNeighborOffsets{mesh, 1.f / spacing, sums.data});
    executor.for_each(counts.vertices, MoveToMean{sums.data, spacing, mesh});
  }
}

// ---- tangential steps of the exact method ----------------------------------------------------------------------

// Longest tangential step, in units of the spacing. With the reach of a projection it keeps a start within kStartReach.
constexpr float kMaxTangentialStep = 0.6f;

// Starts of the next projection for the vertices of a brick: towards the mean of the neighbours, but only along the
// surface, and never further from the brick than the projection looks for atoms and arcs.
struct TangentialStarts {
  BrickSet bricks;
  const BrickTotals *base;
  const RingSum *sums;
  MeshView mesh;
  glm::vec3 *starts;

  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, NoScratch &, size_t brick) const {
    const Lattice &lattice = bricks.lattice;
    const float h = lattice.spacing, overhang = 0.999f * kStartOverhang * h, edge = 7.f * h;
    const glm::ivec3 first = lattice.first_point(bricks.place(brick));
    const Vec3<float> low = lattice.position(first.x, first.y, first.z);
    const uint32_t end = base[brick + 1].vertices;
    for (uint32_t v = base[brick].vertices + static_cast<uint32_t>(team.rank()); v < end;
         v += static_cast<uint32_t>(team.size())) {
      const Vec3<float> n = shared_normal(mesh, v);
      const Vec3<float> x = lattice.from_caller(mesh.position(v));
      const Vec3<float> d = mean_offset(sums[v], h);
      Vec3<float> step = (d - n * dot(d, n)) * kRelaxationWeight;
      const float length2 = length_squared(step), longest = kMaxTangentialStep * h;
      if (length2 > longest * longest) step = step * (longest * reciprocal_root(length2));
      const Vec3<float> p = x + step;
      starts[v] = glm::vec3(limited(p.x, low.x - overhang, low.x + edge + overhang),
                            limited(p.y, low.y - overhang, low.y + edge + overhang),
                            limited(p.z, low.z - overhang, low.z + edge + overhang));
    }
  }

 private:
  QSES_FN static float limited(float v, float low, float high) { return minimum(high, maximum(low, v)); }
};

// Fills starts[vertex] (centred frame) from positions and normals of the mesh. starts is the caller's.
template <class Executor>
void tangential_starts(Executor &executor, const BrickSet &bricks, const MeshLayout &layout, const MeshView &mesh,
                       const MeshCounts &counts, Span<RingSum> sums, glm::vec3 *starts) {
  const float spacing = bricks.lattice.spacing;
  executor.fill(sums, 0);
  executor.for_each(counts.triangles, AddNeighborOffsets{mesh, 1.f / spacing, sums.data});
  executor.template for_each_brick<NoScratch>(bricks.count,
                                              TangentialStarts{bricks, layout.base, sums.data, mesh, starts});
}

// ---- normals ---------------------------------------------------------------------------------------------------

struct AddTriangleNormals {
  MeshView mesh;
  float scale;  // 1 / spacing²
  RingSum *sums;
  QSES_HOST_DEVICE void operator()(size_t triangle) const {
    const uint32_t *t = mesh.triangle(triangle);
    const Vec3<float> n = face_normal(mesh, t);  // to the last bit the same, whatever the winding
    const int32_t x = ring_term(n.x, scale), y = ring_term(n.y, scale), z = ring_term(n.z, scale);
    for (int k = 0; k < 3; ++k) add_to_ring(sums + t[k], x, y, z, 1);
  }
};

struct NormalizeSums {
  const RingSum *sums;
  MeshView mesh;
  QSES_HOST_DEVICE void operator()(size_t v) const {
    const Vec3<float> n = ring_vector(sums[v], 1.f);
    const float length2 = length_squared(n);
    // Triangles of no area, around vertices that coincide, say nothing: what stands there stays.
    constexpr float kLeast = 8.f / kRingUnits;
    if (length2 >= kLeast * kLeast) store_vec3(mesh.normal(static_cast<uint32_t>(v)), n * reciprocal_root(length2));
  }
};

// Unit normals, outward whatever the winding: the mean of the triangles around a vertex, weighted by their areas. A
// vertex that has only triangles without area keeps the normal it had.
template <class Executor>
void compute_normals(Executor &executor, const MeshView &mesh, const MeshCounts &counts, float spacing,
                     Span<RingSum> sums) {
  if (counts.vertices == 0) return;
  executor.fill(sums, 0);
  executor.for_each(counts.triangles, AddTriangleNormals{mesh, 1.f / (spacing * spacing), sums.data});
  executor.for_each(counts.vertices, NormalizeSums{sums.data, mesh});
}

}  // namespace quickses
