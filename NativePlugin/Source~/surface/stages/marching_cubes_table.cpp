// SPDX-License-Identifier: MIT
// Generates the table of marching cubes: traces the closed polygons in which the surface meets a cell, and cuts each
// into triangles by dynamic programming over its diagonals.
#include "surface/stages/marching_cubes_table.h"

#include <array>
#include <cmath>
#include <vector>

namespace quickses {
namespace {

struct CellEdge {
  int low, high;               // corners
  std::array<int, 3> doubled;  // middle of the edge, times two
};

CellEdge cell_edge(int edge) {
  const int low = edge_origin_x(edge) | edge_origin_y(edge) << 1 | edge_origin_z(edge) << 2;
  const int high = low | 1 << edge_axis(edge);
  CellEdge e{low, high, {}};
  for (int d = 0; d < 3; ++d) e.doubled[d] = (low >> d & 1) + (high >> d & 1);
  return e;
}

int edge_between(int a, int b) {
  for (int e = 0; e < kCellEdges; ++e) {
    const CellEdge c = cell_edge(e);
    if ((c.low == a && c.high == b) || (c.low == b && c.high == a)) return e;
  }
  return -1;
}

bool share_a_face(int e, int f) {
  const CellEdge a = cell_edge(e), b = cell_edge(f);
  for (int d = 0; d < 3; ++d)
    if (a.doubled[d] != 1 && a.doubled[d] == b.doubled[d]) return true;
  return false;
}

double diagonal_cost(int e, int f) {
  const CellEdge a = cell_edge(e), b = cell_edge(f);
  double length2 = 0;
  for (int d = 0; d < 3; ++d) length2 += 0.25 * (a.doubled[d] - b.doubled[d]) * (a.doubled[d] - b.doubled[d]);
  return length2 + (share_a_face(e, f) ? 1000.0 : 0.0);
}

// The cheapest triangulation of the polygon, as triples of its corners.
std::vector<std::array<int, 3>> triangulate(const std::vector<int> &polygon) {
  const int n = static_cast<int>(polygon.size());
  std::vector<std::vector<double>> cost(n, std::vector<double>(n, 0.0));
  std::vector<std::vector<int>> apex(n, std::vector<int>(n, -1));
  auto diagonal = [&](int i, int j) {
    const bool side = j - i == 1 || j - i == n - 1;
    return side ? 0.0 : diagonal_cost(polygon[i], polygon[j]);
  };
  for (int span = 2; span < n; ++span)
    for (int i = 0; i + span < n; ++i) {
      const int j = i + span;
      for (int k = i + 1; k < j; ++k) {
        const double c = cost[i][k] + cost[k][j] + diagonal(i, k) + diagonal(k, j);
        if (apex[i][j] < 0 || c < cost[i][j]) {
          cost[i][j] = c;
          apex[i][j] = k;
        }
      }
    }
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::array<int, 2>> open = {{0, n - 1}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j - i < 2) continue;
    const int k = apex[i][j];
    triangles.push_back({polygon[i], polygon[k], polygon[j]});
    open.push_back({k, j});
    open.push_back({i, k});
  }
  return triangles;
}

// The polygons of a case. On each face, seen from outside, the surface runs from where the counter-clockwise walk
// around the face enters a run of inside corners to where it leaves that run: inside corners stay separated.
std::vector<std::vector<int>> polygons_of(int cell_case) {
  static const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  auto inside = [&](int corner) { return (cell_case >> corner & 1) != 0; };
  std::array<int, kCellEdges> next;
  next.fill(-1);
  for (const auto &face : faces)
    for (int i = 0; i < 4; ++i) {
      if (inside(face[i]) || !inside(face[(i + 1) & 3])) continue;
      int last = (i + 1) & 3;
      while (inside(face[(last + 1) & 3])) last = (last + 1) & 3;
      next[edge_between(face[i], face[(i + 1) & 3])] = edge_between(face[last], face[(last + 1) & 3]);
    }
  std::vector<std::vector<int>> polygons;
  std::array<bool, kCellEdges> used{};
  for (int e = 0; e < kCellEdges; ++e) {
    if (next[e] < 0 || used[e]) continue;
    polygons.emplace_back();
    for (int k = e; !used[k]; k = next[k]) {
      used[k] = true;
      polygons.back().push_back(k);
    }
  }
  return polygons;
}

// Where the vertex of an edge starts, in 1/128 of the spacing.
std::array<int, 3> start_of(int cell_case, int edge) {
  const CellEdge e = cell_edge(edge);
  const bool low_inside = (cell_case >> e.low & 1) != 0;
  std::array<int, 3> p;
  for (int d = 0; d < 3; ++d) p[d] = e.doubled[d] * kRingScale / 2;
  p[edge_axis(edge)] += static_cast<int>(
      std::lround((low_inside ? kVertexStart - 0.5f : 0.5f - kVertexStart) * static_cast<float>(kRingScale)));
  return p;
}

MarchingCubesTable build() {
  MarchingCubesTable table{};
  for (int c = 0; c < kCellCases; ++c) {
    int sum[kCellEdges][4] = {};
    for (const std::vector<int> &polygon : polygons_of(c))
      for (const std::array<int, 3> &t : triangulate(polygon)) {
        const int n = table.triangle_count[c]++;
        for (int k = 0; k < 3; ++k) {
          table.edges[c][3 * n + k] = static_cast<uint8_t>(t[k]);
          const std::array<int, 3> here = start_of(c, t[k]);
          for (int other = 1; other < 3; ++other) {
            const std::array<int, 3> there = start_of(c, t[(k + other) % 3]);
            for (int d = 0; d < 3; ++d) sum[t[k]][d] += there[d] - here[d];
            ++sum[t[k]][3];
          }
        }
      }
    for (int e = 0; e < kCellEdges; ++e)
      table.ring[c][e] = static_cast<uint64_t>(sum[e][0] + kRingBias) |
                         static_cast<uint64_t>(sum[e][1] + kRingBias) << 16 |
                         static_cast<uint64_t>(sum[e][2] + kRingBias) << 32 | static_cast<uint64_t>(sum[e][3]) << 48;
  }
  return table;
}

}  // namespace

const MarchingCubesTable &marching_cubes_table() {
  static const MarchingCubesTable table = build();
  return table;
}

}  // namespace quickses
