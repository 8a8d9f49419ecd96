// SPDX-License-Identifier: MIT
// Marching cubes on sign masks (QuickSES 2019, section 2.4): what bricks own is counted, then numbered (mesh_layout.h).
#pragma once

#include "parallel/atomics.h"
#include "surface/stages/leaf_cells.h"
#include "surface/stages/marching_cubes_table.h"
#include "surface/stages/mesh_layout.h"

namespace quickses {

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

// On the GPU by chunks of bricks: a thread per leaf, then one per brick.
struct CountBrickChunk {
  static constexpr size_t kChunk = 16;
  struct Counts {
    BrickCounts of_brick[kChunk];
  };
  BrickSet bricks;
  MeshLayout layout;
  const uint8_t *case_triangles;
  BrickTotals *totals;
  BrickRange run;
  template <class Team>
  QSES_FN void operator()(const Team &team, Counts &counts, size_t chunk) const {
    const size_t first = run.first + chunk * kChunk, left = run.last - first, n = left < kChunk ? left : kChunk,
                 rank = static_cast<size_t>(team.rank()), size = static_cast<size_t>(team.size());
    for (size_t i = rank; i < n * kLeavesPerBrick; i += size) {
      const size_t brick = first + i / kLeavesPerBrick;
      const int leaf = static_cast<int>(i % kLeavesPerBrick);
      const UpperBricks upper = upper_bricks(bricks, static_cast<uint32_t>(brick));
      uint64_t crossing[kAxes];
      const int triangles = count_leaf(leaf_words(upper, layout.signs, leaf), case_triangles, crossing);
      for (int axis = 0; axis < kAxes; ++axis)
        layout.crossing[brick * kBrickMasks + static_cast<size_t>(leaf * kAxes + axis)] = crossing[axis];
      counts.of_brick[i / kLeavesPerBrick].of_leaf[leaf] = pack_counts(crossing, triangles);
    }
    team.sync();
    for (size_t i = rank; i < n; i += size) totals[first + i] = rank_brick(layout, first + i, counts.of_brick[i]);
  }
};

// On the CPU by the kernel of the processor (cpu_kernels.h).
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
    layout.totals->early_triangles = layout.base[early_bricks(counted)].triangles;
  }
};

// Counts what a run of bricks owns, and numbers it behind what those before own. The signs of the run and of the bricks
// around it must be known. totals: by brick.
template <class Executor>
void count_cells(Executor &executor, const BrickSet &bricks, const MeshLayout &layout, const uint8_t *case_triangles,
                 BrickTotals *totals, BrickRange run) {
  const size_t n = run.size();
  const LoadTotals load{totals + run.first};
  const Span<BrickTotals> base{layout.base + run.first, n + 1};
  if constexpr (Executor::kIsCuda) {
    executor.template for_each_brick<CountBrickChunk::Counts>(
        (n + CountBrickChunk::kChunk - 1) / CountBrickChunk::kChunk,
        CountBrickChunk{bricks, layout, case_triangles, totals, run}, 1, 2 * kPlainSteps);
    if constexpr (!Executor::kCounts)
      if (run.first > 0) return executor.go_on_scanning(n, load, base);
  } else {
    executor.for_each(n, CountBrick{bricks, layout, case_triangles, totals}, kLeavesPerBrick * kPlainSteps);
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
  const Span<BrickTotals> owned = executor.template allocate<BrickTotals>(n);
  count_cells(executor, bricks, *layout, case_triangles, owned.data, {0, bricks.count});
  executor.for_each(n, CountBorderChanges{bricks, *layout, 0, n});
  layout->near = kAnyNear;
  const MeshTotals totals =
      n > 0 ? executor.expect("mesh", layout->totals, MeshTotals{0, 0, 0, 0, 0, kAnyNear, 0}) : MeshTotals{};
  layout->border_changes = totals.border_changes;
  layout->early_triangles = totals.early_triangles;
  // The bases wrap if there are too many; then the true totals are summed up for the message.
  if (!Executor::kCounts && !fits_bases(n)) {
    const auto sum = [&](uint32_t BrickTotals::*which) {
      return static_cast<uint64_t>(executor.reduce(n, LoadTotal{owned.data, which}));
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

}  // namespace quickses
