// SPDX-License-Identifier: MIT
// The table of marching cubes (Lorensen, Cline 1987), generated from two rules instead of typed in: on an ambiguous
// face the inside corners are separated, and no triangle has a diagonal inside a face of the cube. With vertices owned
// by lattice edges these make every mesh closed. The same table says how a vertex moves in the first relaxation step.
#pragma once

#include "parallel/platform.h"

namespace quickses {

// Corner c of a cell is at (c & 1, c >> 1 & 1, c >> 2); a case has the bits of its inside corners set.
// Edge 4 axis + k runs along the axis from the corner whose other two coordinates, lower axis first, are the bits of k.
constexpr int kCellCases = 256;
constexpr int kMostCaseTriangles = 5;
constexpr int kCellEdges = 12;

QSES_FN constexpr int edge_axis(int edge) { return edge >> 2; }
QSES_FN constexpr int edge_origin_x(int edge) { return edge < 4 ? 0 : edge & 1; }
QSES_FN constexpr int edge_origin_y(int edge) { return edge < 4 ? edge & 1 : edge < 8 ? 0 : edge >> 1 & 1; }
QSES_FN constexpr int edge_origin_z(int edge) { return edge < 8 ? edge >> 1 & 1 : 0; }

// Where a vertex starts on its edge, in units of the spacing from the inside end: a little outside of the middle, from
// where the projection reaches further into crevices.
constexpr float kVertexStart = 0.6f;
// Weight of the average of the neighbours in a relaxation step.
constexpr float kRelaxationWeight = 0.7f;

// Neighbours' offsets, summed over the triangles of one cell around one of its edges, in 1/128 of the spacing and
// biased so that the sums of the four cells around an edge can be added as one number: x, y, z, count, 16 bits each.
constexpr int kRingScale = 128;
constexpr int kRingBias = 4096;

struct MarchingCubesTable {
  uint8_t triangle_count[kCellCases];
  uint8_t edges[kCellCases][16];  // three edges per triangle, outward by the right-hand rule; one byte unused
  uint64_t ring[kCellCases][kCellEdges];
};

// Built on first use; thread-safe; lives as long as the program.
const MarchingCubesTable &marching_cubes_table();

// Displacement of the first relaxation step, in units of the spacing, from the summed ring of the four cells.
QSES_FN void ring_displacement(uint64_t ring, float *dx, float *dy, float *dz) {
  const float scale = kRelaxationWeight / kRingScale / static_cast<float>(ring >> 48);
  const int bias = 4 * kRingBias;
  *dx = scale * static_cast<float>(static_cast<int>(ring & 0xffff) - bias);
  *dy = scale * static_cast<float>(static_cast<int>(ring >> 16 & 0xffff) - bias);
  *dz = scale * static_cast<float>(static_cast<int>(ring >> 32 & 0xffff) - bias);
}

}  // namespace quickses
