// SPDX-License-Identifier: MIT
// Marching cubes on sign masks (QuickSES 2019, section 2.4): count, scan, emit. Every lattice edge that changes sign
// owns one vertex, named by counting bits, so the mesh is welded by construction and the same in every run.
#pragma once

#include "parallel/anticipation.h"
#include "parallel/atomics.h"
#include "surface/memory/counting_executor.h"
#include "surface/mesh/mesh_view.h"
#include "surface/stages/brick_border.h"
#include "surface/stages/leaf_cells.h"
#include "surface/stages/marching_cubes_table.h"

namespace quickses {

constexpr uint32_t kAnyNear = ~uint32_t(0);

// What is known of all bricks together, in the memory of the back end.
struct MeshTotals {
  uint32_t vertices, triangles;
  uint32_t leaves;          // that own vertices
  uint32_t border_changes;  // pairs of a brick and an inactive neighbour next to which signs differ
  uint32_t unplaced;        // vertices for which no feature was found; counted while they are emitted
  uint32_t near;            // numbers of two bricks next to each other differ by so much at most (GPU)

  // most.near: kAnyNear for whoever does not care, else 0.
  static MeshTotals anticipated(const MeshTotals &last, const MeshTotals &most) {
    return {and_some_more(last.vertices),
            and_some_more(last.triangles),
            and_some_more(last.leaves),
            0,
            0,
            std::max(and_some_more(last.near), most.near)};
  }
  bool covers(const MeshTotals &found) const {
    return found.vertices <= vertices && found.triangles <= triangles && found.leaves <= leaves &&
           found.border_changes <= border_changes && found.near <= near;
  }
};

// 32 bits: what is more does not become a mesh.
inline MeshTotals expected_value(const WorkFacts &facts, const MeshTotals *) {
  const auto number = [](double n) { return static_cast<uint32_t>(std::min(n, 4294967294.0)); };
  return {number(facts.size.vertices), number(facts.size.triangles), number(facts.size.leaves), 0, 0, 0};
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
  uint64_t border_changes;                // 0, or the set of bricks must grow before anything is emitted
  uint32_t near;                          // at most; where it is not, what is emitted may not be final

  // Vertices of a brick before a leaf; of all, before leaf 8.
  QSES_FN uint32_t vertices_before(size_t brick, int leaf) const {
    if (leaf == kLeavesPerBrick) return base[brick + 1].vertices - base[brick].vertices;
    return vertex_rank[(brick * kLeavesPerBrick + static_cast<size_t>(leaf)) * kAxes];
  }

  // Where more were counted than anticipated nothing may be emitted: there is no room for it, or a brick is missing.
  QSES_FN bool has_room() const {
    return totals->vertices <= vertex_total && totals->triangles <= triangle_total && totals->leaves <= leaf_total &&
           totals->border_changes == 0 && totals->near <= near;
  }
};

// ---- count -----------------------------------------------------------------------------------------------------

// The masks of a leaf's edges that change sign, from its corner words.
QSES_FN void find_crossings(const LeafWords &c, uint64_t *crossing) {
  for (int axis = 0; axis < kAxes; ++axis) crossing[axis] = c.at[0] ^ c.at[1 << axis];
}
// They go to crossing[axis]. Returns how many triangles the leaf's cells have.
QSES_FN int count_leaf(const LeafWords &words, const uint8_t *case_triangles, uint64_t *crossing) {
  const LeafWords c = cell_corners(words);
  find_crossings(c, crossing);
  const uint64_t mixed = mixed_cells(c);
  int triangles = 0;
  for (int first = 0; first < 64; first += 8) {
    if ((mixed >> first & 0xff) == 0) continue;
    const uint64_t cases = cell_cases(c, first);
    for (int shift = 0; shift < 64; shift += 8)
      triangles += case_triangles[cases >> shift & 0xff];  // none of cells that are not mixed
  }
  return triangles;
}

constexpr int kBrickMasks = kLeavesPerBrick * kAxes;

// The counts of a leaf in one word: of vertices on edges along x, y and z, and of triangles.
constexpr int kCountBits = 7;
QSES_FN uint32_t pack_counts(const uint64_t *crossing, int triangles) {
  uint32_t counts = static_cast<uint32_t>(triangles) << (kAxes * kCountBits);
  for (int axis = 0; axis < kAxes; ++axis)
    counts |= static_cast<uint32_t>(crossing[axis] ? popcount64(crossing[axis]) : 0) << (axis * kCountBits);
  return counts;
}
struct alignas(16) BrickCounts {
  uint32_t of_leaf[kLeavesPerBrick];
};

// Ranks of a brick, as they lie in the layout: stored as a whole.
struct alignas(16) VertexRanks {
  uint16_t of_mask[kBrickMasks];
};

// The ranks of a brick from its counts. Returns its totals.
QSES_FN BrickTotals rank_brick(const MeshLayout &layout, size_t brick, const BrickCounts &counts) {
  VertexRanks vertex;
  uint32_t v = 0, t = 0, owning = 0;
#if defined(__CUDA_ARCH__)
#pragma unroll
#endif
  for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) {
    const uint32_t before = v, count = counts.of_leaf[leaf];
    for (int axis = 0; axis < kAxes; ++axis) {
      vertex.of_mask[leaf * kAxes + axis] = static_cast<uint16_t>(v);
      v += count >> (axis * kCountBits) & ((1u << kCountBits) - 1);
    }
    owning += v != before ? 1 : 0;
    t += count >> (kAxes * kCountBits);
  }
  layout.border[brick] = border_signs(layout.signs + brick * kLeavesPerBrick);
  reinterpret_cast<VertexRanks *>(layout.vertex_rank)[brick] = vertex;
  return {v, t, owning};
}

// On the GPU a thread per leaf, then one per brick: of those from brick `first` on. Counts and totals are by brick.
struct CountLeaf {
  BrickSet bricks;
  MeshLayout layout;
  const uint8_t *case_triangles;
  BrickCounts *counts;
  size_t first;
  QSES_FN void operator()(size_t i) const {
    const size_t brick = first + i / kLeavesPerBrick, slot = first * kLeavesPerBrick + i;
    const int leaf = static_cast<int>(i % kLeavesPerBrick);
    const UpperBricks upper = upper_bricks(bricks, static_cast<uint32_t>(brick));
    uint64_t crossing[kAxes];
    const int triangles = count_leaf(leaf_words(upper, layout.signs, leaf), case_triangles, crossing);
    for (int axis = 0; axis < kAxes; ++axis) layout.crossing[kAxes * slot + static_cast<size_t>(axis)] = crossing[axis];
    counts[brick].of_leaf[leaf] = pack_counts(crossing, triangles);
  }
};
struct RankBrick {
  MeshLayout layout;
  const BrickCounts *counts;
  BrickTotals *totals;
  size_t first;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const size_t brick = first + i;
    const BrickCounts own = counts[brick];
    totals[brick] = rank_brick(layout, brick, own);
  }
};

// On the CPU both at once, by the kernel of the processor (cpu_kernels.h).
BrickTotals count_brick(const BrickSet &bricks, const MeshLayout &layout, uint32_t brick,
                        const uint8_t *case_triangles);
struct CountBrick {
  BrickSet bricks;
  MeshLayout layout;
  const uint8_t *case_triangles;
  BrickTotals *totals;
  void operator()(size_t brick) const {
    totals[brick] = count_brick(bricks, layout, static_cast<uint32_t>(brick), case_triangles);
  }
};

struct LoadTotals {
  const BrickTotals *totals;
  QSES_HOST_DEVICE BrickTotals operator()(size_t i) const { return totals[i]; }
};
struct LoadTotal {
  const BrickTotals *totals;
  uint32_t BrickTotals::*which;
  QSES_HOST_DEVICE double operator()(size_t i) const { return totals[i].*which; }
};

// Of the bricks from `first` on, when bases and borders of their neighbours are known; those of `counted` bricks are.
struct CountBorderChanges {
  BrickSet bricks;
  MeshLayout layout;
  size_t first, counted;
  QSES_FN void operator()(size_t i) const {
    const size_t brick = first + i;
    uint32_t near = 0;
    const int changes = popcount64(border_changes(bricks, layout.border, brick, counted, &near));
    if (changes > 0) atomic_add(&layout.totals->border_changes, static_cast<uint32_t>(changes));
    if (layout.vertex_leaves) {
      if (near > layout.totals->near) atomic_max(&layout.totals->near, near);
      uint32_t next = layout.base[brick].leaves, before = 0;
      for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) {
        const uint32_t with = layout.vertices_before(brick, leaf + 1);
        if (with != before)
          layout.vertex_leaves[next++] = static_cast<uint32_t>(brick) * kLeavesPerBrick + static_cast<uint32_t>(leaf);
        before = with;
      }
    }
    if (i > 0) return;
    const BrickTotals all = layout.base[counted];
    layout.totals->vertices = all.vertices;
    layout.totals->triangles = all.triangles;
    layout.totals->leaves = all.leaves;
  }
};

// ---- emit ------------------------------------------------------------------------------------------------------

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

// Sum of the ring tables of the four cells around an edge. cell_case(second, third) is the case of the cell at the
// edge's lower point moved by 0 or -1 along the other two axes, lower axis first.
template <class CellCase>
QSES_FN uint64_t edge_ring_of_cells(const CellCase &cell_case, int axis, const uint64_t (*ring)[kCellEdges]) {
  uint64_t sum = 0;
  for (int w = -1; w <= 0; ++w)
    for (int v = -1; v <= 0; ++v) sum += ring[cell_case(v, w)][4 * axis - v - 2 * w];
  return sum;
}

// The same from rows of signs along x: `row` is that of the edge's lower point, which is its bit x; the next in y is
// behind it, the next in z by so many.
template <class Row>
QSES_FN uint64_t edge_ring_of_rows(const Row *row, int rows_per_layer, int x, int axis,
                                   const uint64_t (*ring)[kCellEdges]) {
  const auto case_near = [&](int second, int third) {
    const int dx = axis == 0 ? 0 : second, dy = axis == 0 ? second : axis == 1 ? 0 : third, dz = axis == 2 ? 0 : third;
    return cell_case(row + dy + rows_per_layer * dz, rows_per_layer, x + dx);
  };
  return edge_ring_of_cells(case_near, axis, ring);
}

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

// What is counted before it is numbered, by brick.
struct CountedCells {
  Span<BrickTotals> totals;
  Span<BrickCounts> counts;  // on the GPU
  template <class Executor>
  CountedCells(Executor &executor, size_t bricks) : totals(executor.template allocate<BrickTotals>(bricks)) {
    if (Executor::kIsCuda) counts = executor.template allocate<BrickCounts>(bricks);
  }
};

// Counts what a run of bricks owns, and numbers it behind what those before own. The signs of the run and of the bricks
// around it must be known.
template <class Executor>
void count_cells(Executor &executor, const BrickSet &bricks, const MeshLayout &layout, const uint8_t *case_triangles,
                 const CountedCells &counts, BrickRange run) {
  const size_t n = run.size();
  const LoadTotals load{counts.totals.data + run.first};
  const Span<BrickTotals> base{layout.base + run.first, n + 1};
  if constexpr (Executor::kIsCuda) {
    executor.for_each(n * kLeavesPerBrick, CountLeaf{bricks, layout, case_triangles, counts.counts.data, run.first});
    executor.for_each(n, RankBrick{layout, counts.counts.data, counts.totals.data, run.first});
    if constexpr (!Executor::kCounts)
      if (run.first > 0) return executor.go_on_scanning(n, load, base);
  } else {
    executor.for_each(n, CountBrick{bricks, layout, case_triangles, counts.totals.data}, kLeavesPerBrick * kPlainSteps);
  }
  executor.exclusive_scan(n, load, base);
}

// Whether bases of so many bricks can't wrap.
inline bool fits_bases(uint64_t bricks) { return bricks * kBrickPoints * kMostCaseTriangles <= 0xffffffffull; }

// Counts and scans; the signs of all bricks must be known. The bases of the layout are only valid if all totals fit 32
// bits.
template <class Executor>
MeshCounts lay_out_mesh(Executor &executor, const BrickSet &bricks, const uint64_t *signs,
                        const uint8_t *case_triangles, MeshLayout *layout) {
  const size_t n = bricks.count;
  allocate_layout(executor, n, signs, layout);
  const auto mark = executor.arena().mark();
  const CountedCells counts(executor, n);
  count_cells(executor, bricks, *layout, case_triangles, counts, {0, bricks.count});
  executor.for_each(n, CountBorderChanges{bricks, *layout, 0, n});
  layout->near = kAnyNear;
  const MeshTotals totals =
      n > 0 ? executor.expect("mesh", layout->totals, MeshTotals{0, 0, 0, 0, 0, kAnyNear}) : MeshTotals{};
  layout->border_changes = totals.border_changes;
  // The bases wrap if there are too many; then the true totals are summed up for the message.
  if (!Executor::kCounts && !fits_bases(n)) {
    const auto sum = [&](uint32_t BrickTotals::*which) {
      return static_cast<uint64_t>(executor.reduce(n, LoadTotal{counts.totals.data, which}));
    };
    layout->vertex_total = sum(&BrickTotals::vertices);
    layout->triangle_total = sum(&BrickTotals::triangles);
    layout->leaf_total = sum(&BrickTotals::leaves);
    executor.arena().rewind(mark);
    return {layout->vertex_total, layout->triangle_total};
  }
  executor.arena().rewind(mark);
  layout->vertex_total = totals.vertices;
  layout->triangle_total = totals.triangles;
  layout->leaf_total = totals.leaves;
  return {totals.vertices, totals.triangles};
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
  const BrickTotals *const ends[2] = {layout.base + slice.first, layout.base + slice.last};
  BrickTotals n[2];
  executor.fetch_each(ends, n, 2);
  return sizes_between(n[0], n[1]);
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
