// SPDX-License-Identifier: MIT
// CPU kernels: the triangles of one brick's cells, counted and written. The numbers of all vertices in reach are
// written to an array first, so that a triangle is three look-ups.
#include "surface/cpu/cpu_leaf_bits.h"

#include <cassert>
#include <cstring>

namespace quickses {
namespace QSES_CPU_ISA {
namespace {

// Numbers of the vertices on edges that start at lattice points 0 ... 8 in each axis.
constexpr int kSide = kBrickEdge + 1;
constexpr PointPlaces<kSide, kSide * kSide> kPlaces;
struct VertexNumbers {
  uint32_t at[kAxes][kSide * kSide * kSide];
};

// Where the vertex of a table edge is found, relative to that of the cell's own point on axis 0.
struct EdgeOffsets {
  int at[kCellEdges];
};
constexpr EdgeOffsets make_edge_offsets() {
  EdgeOffsets o{};
  for (int e = 0; e < kCellEdges; ++e)
    o.at[e] = edge_axis(e) * kSide * kSide * kSide + kPlaces.of(edge_origin_x(e), edge_origin_y(e), edge_origin_z(e));
  return o;
}
constexpr EdgeOffsets kEdgeOffsets = make_edge_offsets();

// The masks of a brick whose edges its cells have: its own, and those of its neighbours towards larger x, y, z (bits of
// `towards`) with the points that they share.
struct EdgeMask {
  int towards, mask, axis, place;
  uint64_t shared;
};
struct EdgeMasks {
  static constexpr int kCount = kBrickMasks + 3 * 4 * 2 + 3 * 2;
  EdgeMask at[kCount];
};
constexpr EdgeMasks make_edge_masks() {
  EdgeMasks masks{};
  int n = 0;
  for (int towards = 0; towards < 8; ++towards)
    for (int k = 0; k < kBrickMasks; ++k) {
      const int leaf = k / kAxes, axis = k % kAxes;
      if (leaf & towards || towards >> axis & 1) continue;
      masks.at[n++] = {towards, k, axis,
                       kPlaces.of_leaf(leaf) + kBrickEdge * kPlaces.of(towards & 1, towards >> 1 & 1, towards >> 2),
                       (towards & 1 ? 0x1111111111111111ull : ~0ull) & (towards & 2 ? 0x000f000f000f000full : ~0ull) &
                           (towards & 4 ? 0xffffull : ~0ull)};
    }
  return masks;
}
constexpr EdgeMasks kEdgeMasks = make_edge_masks();

// The cases of the mixed cells of a leaf, in the order of their bits. Behind them stand cells that have no triangle, up
// to a whole word.
struct MixedCases {
  static constexpr int kTogether = 8;
  alignas(8) uint8_t code[64];
  QSES_FN MixedCases(const LeafWords &corners, uint64_t mixed) {
    LeafWords packed;
    for (int c = 0; c < 8; ++c) packed.at[c] = extract_bits(corners.at[c], mixed);
    const int count = popcount64(mixed);
    for (int k = 0; k < count; k += kTogether) {
      const uint64_t cases = cell_cases(packed, k);
      for (int j = 0; j < kTogether; ++j) code[k + j] = static_cast<uint8_t>(cases >> 8 * j);
    }
  }
};

void number_vertices(const MeshLayout &layout, const UpperBricks &upper, VertexNumbers *numbers) {
  for (const EdgeMask &edges : kEdgeMasks.at) {
    if (upper.at[edges.towards] < 0) continue;
    const size_t brick = static_cast<size_t>(upper.at[edges.towards]);
    const size_t k = brick * kBrickMasks + static_cast<size_t>(edges.mask);
    const uint64_t crossing = layout.crossing[k];
    const uint32_t base = layout.base[brick].vertices + layout.vertex_rank[k];
    uint32_t *const at = numbers->at[edges.axis] + edges.place;
    for (uint64_t w = crossing & edges.shared; w; w &= w - 1) {
      const int bit = lowest_bit64(w);
      at[kPlaces.of_bit[bit]] = vertex_number(base, crossing, bit);
    }
  }
}

}  // namespace

BrickTotals count_brick(const BrickSet &bricks, const MeshLayout &layout, uint32_t brick,
                        const uint8_t *case_triangles) {
  uint64_t *const crossing = layout.crossing + static_cast<size_t>(brick) * kBrickMasks;
  BrickCounts counts;
  for_leaf_words(upper_bricks(bricks, brick), layout.signs, [&](int leaf, const LeafWords &words) {
    const LeafWords corners = cell_corners(words);
    const uint64_t mixed = mixed_cells(corners);
    const MixedCases cases(corners, mixed);
    int triangles = 0;
    for (int k = 0, count = popcount64(mixed); k < count; k += MixedCases::kTogether)
      for (int j = 0; j < MixedCases::kTogether; ++j) triangles += case_triangles[cases.code[k + j]];
    find_crossings(corners, crossing + leaf * kAxes);
    counts.of_leaf[leaf] = pack_counts(crossing + leaf * kAxes, triangles);
  });
  return rank_brick(layout, brick, counts);
}

void emit_brick_triangles(const BrickSet &bricks, const MeshLayout &layout, uint32_t brick, const TableView &table,
                          const MeshView &mesh) {
  const size_t begin = layout.base[brick].triangles;
  if (layout.base[brick + 1].triangles == begin) return;
  const UpperBricks upper = upper_bricks(bricks, brick);
  VertexNumbers numbers;
#if !defined(NDEBUG)
  std::memset(&numbers, 0xff, sizeof numbers);  // no signs change on the border of the set, so none of these is read
#endif
  number_vertices(layout, upper, &numbers);
  const int second = mesh.reversed ? 2 : 1, third = mesh.reversed ? 1 : 2;
  uint32_t *out = mesh.triangle(begin);
  for_leaf_words(upper, layout.signs, [&](int leaf, const LeafWords &words) {
    const LeafWords corners = cell_corners(words);
    uint64_t mixed = mixed_cells(corners);
    const MixedCases cases(corners, mixed);
    for (const uint8_t *next = cases.code; mixed; mixed &= mixed - 1) {
      const int bit = lowest_bit64(mixed), code = *next++;
      const uint32_t *const here = numbers.at[0] + kPlaces.of_leaf(leaf) + kPlaces.of_bit[bit];
      const uint8_t *edges = table.edges[code];
      for (int t = 0; t < table.triangle_count[code]; ++t, edges += 3, out += 3) {
        out[0] = here[kEdgeOffsets.at[edges[0]]];
        out[1] = here[kEdgeOffsets.at[edges[second]]];
        out[2] = here[kEdgeOffsets.at[edges[third]]];
        assert(out[0] < layout.vertex_total && out[1] < layout.vertex_total && out[2] < layout.vertex_total);
      }
    }
  });
}

}  // namespace QSES_CPU_ISA
}  // namespace quickses
