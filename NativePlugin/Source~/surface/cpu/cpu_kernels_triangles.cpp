// SPDX-License-Identifier: MIT
// CPU kernel: the triangles of one brick's cells. The numbers of all vertices in reach are written to an array first,
// so that a triangle is three look-ups.
#include "surface/cpu/cpu_kernels.h"

#include <cassert>
#if !defined(NDEBUG)
#include <cstring>
#endif

namespace quickses {
namespace QSES_CPU_ISA {
namespace {

// Numbers of the vertices on edges that start at lattice points 0 ... 8 in each axis.
constexpr int kSide = kBrickEdge + 1;
struct VertexNumbers {
  uint32_t at[kAxes][kSide * kSide * kSide];
};

// Where the vertex of a table edge is found, relative to that of the cell's own point on axis 0.
struct EdgeOffsets {
  int at[kCellEdges];
};
constexpr EdgeOffsets make_edge_offsets() {
  EdgeOffsets o{};
  for (int e = 0; e < kCellEdges; ++e) {
    const int x = e < 4 ? 0 : e & 1, y = e < 4 ? e & 1 : e < 8 ? 0 : e >> 1 & 1, z = e < 8 ? e >> 1 & 1 : 0;
    o.at[e] = (e >> 2) * kSide * kSide * kSide + x + kSide * (y + kSide * z);
  }
  return o;
}
constexpr EdgeOffsets kEdgeOffsets = make_edge_offsets();

// Points of a leaf that a neighbour towards larger x, y, z (bits of `towards`) shares with the brick's cells.
QSES_FN uint64_t shared_points(int towards) {
  uint64_t mask = ~uint64_t(0);
  if (towards & 1) mask &= 0x1111111111111111ull;
  if (towards & 2) mask &= 0x000f000f000f000full;
  if (towards & 4) mask &= 0xffffull;
  return mask;
}

void number_vertices(const MeshLayout &layout, size_t brick, int towards, VertexNumbers *numbers) {
  const uint64_t mask = shared_points(towards);
  const glm::ivec3 brick_step(towards & 1, towards >> 1 & 1, towards >> 2);
  for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) {
    if (leaf & towards) continue;
    const size_t k = brick * kLeavesPerBrick + static_cast<size_t>(leaf);
    for (int axis = 0; axis < kAxes; ++axis) {
      if (towards >> axis & 1) continue;
      const uint64_t crossing = layout.crossing[3 * k + static_cast<size_t>(axis)];
      const uint32_t base = layout.base[brick].vertices + layout.vertex_rank[3 * k + static_cast<size_t>(axis)];
      for (uint64_t w = crossing & mask; w; w &= w - 1) {
        const int bit = lowest_bit64(w);
        const glm::ivec3 p = brick_point(leaf, bit) + kBrickEdge * brick_step;
        numbers->at[axis][p.x + kSide * (p.y + kSide * p.z)] = vertex_number(base, crossing, bit);
      }
    }
  }
}

}  // namespace

void emit_brick_triangles(const BrickSet &bricks, const MeshLayout &layout, uint32_t brick, const TableView &table,
                          const MeshView &mesh) {
  const size_t begin = layout.base[brick].triangles;
  if (layout.base[brick + 1].triangles == begin) return;
  const UpperBricks upper = upper_bricks(bricks, brick);
  VertexNumbers numbers;
#if !defined(NDEBUG)
  std::memset(&numbers, 0xff, sizeof numbers);  // no signs change on the border of the set, so none of these is read
#endif
  number_vertices(layout, brick, 0, &numbers);
  for (int towards = 1; towards < 8; ++towards)
    if (upper.at[towards] >= 0) number_vertices(layout, static_cast<size_t>(upper.at[towards]), towards, &numbers);
  const int second = mesh.reversed ? 2 : 1, third = mesh.reversed ? 1 : 2;
  uint32_t *out = mesh.triangle(begin);
  for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) {
    const LeafWords corners = cell_corners(leaf_words(upper, layout.signs, leaf));
    for (uint64_t mixed = mixed_cells(corners); mixed; mixed &= mixed - 1) {
      const int bit = lowest_bit64(mixed), code = cell_case(corners, bit);
      const glm::ivec3 p = brick_point(leaf, bit);
      const uint32_t *here = &numbers.at[0][p.x + kSide * (p.y + kSide * p.z)];
      const uint8_t *edges = table.edges[code];
      for (int t = 0; t < table.triangle_count[code]; ++t, edges += 3, out += 3) {
        out[0] = here[kEdgeOffsets.at[edges[0]]];
        out[1] = here[kEdgeOffsets.at[edges[second]]];
        out[2] = here[kEdgeOffsets.at[edges[third]]];
        assert(out[0] < layout.vertex_total && out[1] < layout.vertex_total && out[2] < layout.vertex_total);
      }
    }
  }
}

}  // namespace QSES_CPU_ISA
}  // namespace quickses
