// SPDX-License-Identifier: MIT
// Facts about a mesh that the report states, found from its triangles alone.
#include "cli/mesh_check.h"

#include "io/disjoint_sets.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace quickses::cli {
bool is_closed(const qses_mesh &mesh) {
  const size_t edge_count = size_t(mesh.triangle_count) * 3;
  for (size_t i = 0; i < edge_count; ++i)
    if (mesh.indices[i] >= mesh.vertex_count) return false;
  // The ends of the edges that leave each vertex, side by side.
  std::vector<size_t> begin(size_t(mesh.vertex_count) + 1, 0);
  for (size_t i = 0; i < edge_count; ++i) ++begin[mesh.indices[i] + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<uint32_t> ends(edge_count);
  std::vector<size_t> next(begin.begin(), begin.end() - 1);
  for (size_t i = 0; i < edge_count; ++i) {
    const uint32_t end = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
    ends[next[mesh.indices[i]]++] = end;
  }
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const auto first = ends.begin() + begin[v], last = ends.begin() + begin[v + 1];
    std::sort(first, last);
    if (std::adjacent_find(first, last) != last) return false;
  }
  for (uint32_t v = 0; v < mesh.vertex_count; ++v)
    for (size_t i = begin[v]; i < begin[v + 1]; ++i) {
      const uint32_t end = ends[i];
      if (end == v || !std::binary_search(ends.begin() + begin[end], ends.begin() + begin[end + 1], v)) return false;
    }
  return true;
}

std::vector<Component> find_components(const qses_mesh &mesh) {
  io::DisjointSets pieces(mesh.vertex_count);
  for (size_t t = 0; t < mesh.triangle_count; ++t) {
    const uint32_t *corner = mesh.indices + 3 * t;
    pieces.join(corner[0], corner[1]);
    pieces.join(corner[0], corner[2]);
  }
  constexpr uint32_t kNone = ~0u;
  std::vector<uint32_t> number(mesh.vertex_count, kNone);
  std::vector<Component> components;
  // Volumes are sums of tetrahedra with a common tip; a tip near the mesh keeps their rounding small.
  double tip[3];
  for (int axis = 0; axis < 3; ++axis) tip[axis] = 0.5 * (double(mesh.bounds_min[axis]) + mesh.bounds_max[axis]);
  for (size_t t = 0; t < mesh.triangle_count; ++t) {
    uint32_t &piece = number[pieces.find(mesh.indices[3 * t])];
    if (piece == kNone) {
      piece = static_cast<uint32_t>(components.size());
      components.emplace_back();
    }
    double p[3][3];
    for (int corner = 0; corner < 3; ++corner)
      for (int axis = 0; axis < 3; ++axis)
        p[corner][axis] = mesh.positions[3 * size_t(mesh.indices[3 * t + corner]) + axis] - tip[axis];
    double u[3], v[3];
    for (int axis = 0; axis < 3; ++axis) {
      u[axis] = p[1][axis] - p[0][axis];
      v[axis] = p[2][axis] - p[0][axis];
    }
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    Component &component = components[piece];
    ++component.triangles;
    component.area += 0.5 * std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    component.volume += (p[0][0] * n[0] + p[0][1] * n[1] + p[0][2] * n[2]) / 6;
  }
  std::stable_sort(components.begin(), components.end(),
                   [](const Component &a, const Component &b) { return a.area > b.area; });
  return components;
}

}  // namespace quickses::cli
