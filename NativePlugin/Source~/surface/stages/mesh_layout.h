// SPDX-License-Identifier: MIT
// How the mesh of marching cubes is numbered: every lattice edge that changes sign owns one vertex, named by counting
// bits, so the mesh is welded by construction and the same in every run.
#pragma once

#include "parallel/anticipation.h"
#include "surface/memory/counting_executor.h"
#include "surface/mesh/mesh_view.h"
#include "surface/stages/brick_border.h"
#include "surface/stages/marching_cubes_table.h"

#include <algorithm>
#include <cmath>

namespace quickses {

constexpr int kBrickMasks = kLeavesPerBrick * kAxes;

constexpr uint32_t kAnyNear = ~uint32_t(0);

// Triangles of so many of the bricks may go out while those of the others are made.
QSES_FN constexpr size_t early_bricks(size_t bricks) { return bricks / 8; }

// What is known of all bricks together, in the memory of the back end.
struct MeshTotals {
  uint32_t vertices, triangles;
  uint32_t leaves;           // that own vertices
  uint32_t border_changes;   // pairs of a brick and an inactive neighbour next to which signs differ
  uint32_t unplaced;         // vertices for which no feature was found; counted while they are emitted
  uint32_t near;             // numbers of two bricks next to each other differ by so much at most (GPU)
  uint32_t early_triangles;  // of the early bricks

  // most.near: kAnyNear for whoever does not care, else 0.
  static MeshTotals anticipated(const MeshTotals &last, const MeshTotals &most) {
    return {and_some_more(last.vertices),
            and_some_more(last.triangles),
            and_some_more(last.leaves),
            0,
            0,
            std::max(and_some_more(last.near), most.near),
            last.early_triangles};
  }
  bool covers(const MeshTotals &found) const {
    return found.vertices <= vertices && found.triangles <= triangles && found.leaves <= leaves &&
           found.border_changes <= border_changes && found.near <= near;
  }
};

// 32 bits: what is more does not become a mesh.
inline MeshTotals expected_value(const WorkFacts &facts, const MeshTotals *) {
  const auto number = [](double n) { return static_cast<uint32_t>(std::min(n, 4294967294.0)); };
  return {number(facts.size.vertices), number(facts.size.triangles), number(facts.size.leaves), 0, 0, 0, 0};
}

// What bricks own; leaves: those that own vertices.
struct BrickTotals {
  uint32_t vertices, triangles, leaves;
  QSES_FN BrickTotals operator+(const BrickTotals &b) const {
    return {vertices + b.vertices, triangles + b.triangles, leaves + b.leaves};
  }
};

// What counting leaves behind, per active brick. Vertices are numbered by brick, leaf, axis of their edge, and bit;
// triangles by brick, leaf, bit of their cell, and place in the table.
struct MeshLayout {
  const uint64_t *signs;    // [brick][leaf]: bit set = lattice point inside
  uint64_t *crossing;       // [brick][leaf][axis]: bit set = the edge from that point along the axis changes sign
  uint16_t *vertex_rank;    // [brick][leaf][axis]: vertices of the brick before that mask
  BrickTotals *base;        // [brick + 1]: what the bricks before it own
  BorderSigns *border;      // [brick]
  uint32_t *vertex_leaves;  // 8 * brick + leaf of those that own vertices; nullptr on the CPU, which goes by brick
  MeshTotals *totals;
  uint64_t vertex_total, triangle_total;  // of all bricks; if they are anticipated, there may be fewer
  uint64_t leaf_total;                    // that own vertices
  uint64_t early_triangles;               // of the early bricks; if they are anticipated, about
  uint64_t border_changes;                // 0, or the set of bricks must grow before anything is emitted
  uint32_t near;                          // at most; where it is not, what is emitted may not be final

  // Vertices of a brick before a leaf; of all, before leaf 8.
  QSES_FN uint32_t vertices_before(size_t brick, int leaf) const {
    if (leaf == kLeavesPerBrick) return base[brick + 1].vertices - base[brick].vertices;
    return vertex_rank[(brick * kLeavesPerBrick + static_cast<size_t>(leaf)) * kAxes];
  }

  // Where more were counted than anticipated nothing may be emitted: there is no room for it, or a brick is missing.
  QSES_FN bool has_room() const {
    const MeshTotals all = *totals;  // asked for together
    return (all.vertices <= vertex_total) & (all.triangles <= triangle_total) & (all.leaves <= leaf_total) &
           (all.border_changes == 0) & (all.near <= near);
  }
};

// Number of the vertex of a mask's set bit, if `first` is that of the lowest.
QSES_FN uint32_t vertex_number(uint32_t first, uint64_t crossing, int bit) {
  return first + static_cast<uint32_t>(popcount64(crossing & ((uint64_t(1) << bit) - 1)));
}

// Number of the vertex on the edge that starts at a lattice point of a brick.
QSES_FN uint32_t vertex_number(const MeshLayout &m, int brick, int leaf, int axis, int bit) {
  const size_t k =
      (static_cast<size_t>(brick) * kLeavesPerBrick + static_cast<size_t>(leaf)) * 3 + static_cast<size_t>(axis);
  return vertex_number(m.base[brick].vertices + m.vertex_rank[k], m.crossing[k], bit);
}

// A lattice edge, by its lower point: a bit of a leaf of a brick.
struct LatticeEdge {
  int leaf, axis, bit;
};

// The edge that owns a vertex of a brick.
QSES_FN LatticeEdge edge_of_vertex(const MeshLayout &m, uint32_t brick, uint32_t vertex) {
  const size_t first = static_cast<size_t>(brick) * kBrickMasks;
  const uint32_t rank = vertex - m.base[brick].vertices;
  int k = kBrickMasks - 1;  // the last mask that begins no later
  while (k > 0 && m.vertex_rank[first + static_cast<size_t>(k)] > rank) --k;
  uint64_t mask = m.crossing[first + static_cast<size_t>(k)];
  for (uint32_t n = rank - m.vertex_rank[first + static_cast<size_t>(k)]; n > 0; --n) mask &= mask - 1;
  return {k / kAxes, k % kAxes, lowest_bit64(mask)};
}

// Its ends, in the centred frame.
QSES_FN CutEdge ends_of_edge(const BrickSet &bricks, const MeshLayout &m, uint32_t brick, const LatticeEdge &edge) {
  const glm::ivec3 p = bricks.lattice.first_point(bricks.place(brick)) + brick_point(edge.leaf, edge.bit);
  const Vec3<float> low = bricks.lattice.position(p.x, p.y, p.z);
  const Vec3<float> high =
      bricks.lattice.position(p.x + (edge.axis == 0), p.y + (edge.axis == 1), p.z + (edge.axis == 2));
  const uint64_t word = m.signs[static_cast<size_t>(brick) * kLeavesPerBrick + static_cast<size_t>(edge.leaf)];
  const bool low_inside = (word >> edge.bit & 1) != 0;
  return low_inside ? CutEdge{low, high} : CutEdge{high, low};
}

// The brick of a run that owns a vertex.
QSES_FN uint32_t brick_of_vertex(const MeshLayout &m, BrickRange run, uint32_t vertex) {
  uint32_t first = run.first, n = run.size();  // the last one that begins no later
  while (n > 1) {
    const uint32_t half = n / 2;
    const bool later = m.base[first + half].vertices > vertex;
    first = later ? first : first + half;
    n = later ? half : n - half;
  }
  return first;
}

// Where the vertex of an edge starts: on the edge, from its lower point, in units of the spacing.
QSES_FN float vertex_start(bool low_inside) { return low_inside ? kVertexStart : 1.f - kVertexStart; }

struct MeshCounts {
  uint64_t vertices, triangles;
};

// Memory of a layout for so many bricks.
template <class Executor>
void allocate_layout(Executor &executor, size_t bricks, const uint64_t *signs, MeshLayout *layout) {
  const size_t leaves = bricks * kLeavesPerBrick;
  layout->signs = signs;
  layout->crossing = executor.template allocate<uint64_t>(leaves * 3).data;
  layout->vertex_rank = executor.template allocate<uint16_t>(leaves * 3).data;
  layout->base = executor.template allocate<BrickTotals>(bricks + 1).data;
  layout->border = executor.template allocate<BorderSigns>(bricks).data;
  layout->vertex_leaves = Executor::kIsCuda ? executor.template allocate<uint32_t>(leaves).data : nullptr;
  layout->totals = executor.template take_counts<MeshTotals>();
}

// What a run of bricks owns.
struct SliceSizes {
  uint32_t first_vertex, vertices, first_triangle, triangles, first_leaf, leaves;
};

inline SliceSizes sizes_between(const BrickTotals &begin, const BrickTotals &end) {
  return {begin.vertices, end.vertices - begin.vertices, begin.triangles, end.triangles - begin.triangles,
          begin.leaves,   end.leaves - begin.leaves};
}

// Waits, unless the slice is all of the bricks.
template <class Executor>
SliceSizes slice_sizes(Executor &executor, const BrickSet &bricks, const MeshLayout &layout, BrickRange slice) {
  if (slice.size() == bricks.count)
    return {0, static_cast<uint32_t>(layout.vertex_total), 0, static_cast<uint32_t>(layout.triangle_total),
            0, static_cast<uint32_t>(layout.leaf_total)};
  return sizes_between(executor.fetch(layout.base + slice.first), executor.fetch(layout.base + slice.last));
}
// The mean; but a few bricks may be three times as full.
template <class Executor>
SliceSizes slice_sizes(CountingExecutor<Executor> &, const BrickSet &bricks, const MeshLayout &layout,
                       BrickRange slice) {
  constexpr uint32_t kFew = 256;
  const double part =
      std::min(1.0, (slice.size() < kFew ? 3.0 : 1.0) * slice.size() / std::max<uint32_t>(1, bricks.count));
  const auto of = [&](uint64_t all) { return static_cast<uint32_t>(std::ceil(part * static_cast<double>(all))); };
  return {0, of(layout.vertex_total), 0, of(layout.triangle_total), 0, of(layout.leaf_total)};
}

}  // namespace quickses
