// SPDX-License-Identifier: MIT
// Whether a mesh is closed.
#include "cli/mesh_check.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>
#include <vector>

namespace quickses::cli {
namespace {

// Calls action(from, to) for each edge of each triangle.
template <class Action>
void for_each_edge(const qses_mesh &mesh, const Action &action) {
  const size_t own = mesh.vertex_count - mesh.repeated_count;
  const uint32_t *corner = mesh.indices;
  for (size_t t = 0; t < mesh.triangle_count; ++t, corner += 3) {
    uint32_t v[3];
    for (int k = 0; k < 3; ++k)
      v[k] = corner[k] < own || corner[k] >= mesh.vertex_count ? corner[k] : mesh.repeated[corner[k] - own];
    for (int k = 0; k < 3; ++k) action(v[k], v[(k + 1) % 3]);
  }
}

// True if two lists hold the same numbers, and none twice. Puts them in order where they are long.
bool are_same_and_unique(uint32_t *a, uint32_t *b, size_t count) {
  constexpr size_t kFew = 8;
  if (count > kFew) {
    std::sort(a, a + count);
    std::sort(b, b + count);
    return std::adjacent_find(a, a + count) == a + count && std::equal(a, a + count, b);
  }
  for (size_t i = 0; i < count; ++i) {
    int in_a = 0, in_b = 0;
    for (size_t j = 0; j < count; ++j) {
      in_a += a[j] == a[i];
      in_b += b[j] == a[i];
    }
    if (in_a != 1 || in_b != 1) return false;
  }
  return true;
}

// Offset: a type that can count the edges.
template <class Offset>
bool is_closed_with(const qses_mesh &mesh) {
  const uint32_t vertex_count = mesh.vertex_count;
  // Each edge goes to the lower one of its vertices. Of those of a vertex, the other ends of the edges that leave it
  // fill its part of one array from the front, those of the edges that come in from the back.
  std::vector<Offset> begin(size_t(vertex_count) + 1, 0);
  bool has_edges = true;
  for_each_edge(mesh, [&](uint32_t from, uint32_t to) {
    has_edges = has_edges && from < vertex_count && to < vertex_count && from != to;
    if (has_edges) ++begin[std::min(from, to)];
  });
  if (!has_edges) return false;
  std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), Offset{0});
  std::vector<Offset> front(begin.begin(), begin.end() - 1), back(begin.begin() + 1, begin.end());
  const std::unique_ptr<uint32_t[]> ends(new uint32_t[begin.back()]);
  for_each_edge(mesh, [&](uint32_t from, uint32_t to) {
    if (from < to)
      ends[front[from]++] = to;
    else
      ends[--back[to]] = from;
  });
  for (size_t v = 0; v < vertex_count; ++v) {
    const size_t leaving = front[v] - begin[v], coming = begin[v + 1] - front[v];
    if (leaving != coming) return false;
    if (!are_same_and_unique(ends.get() + begin[v], ends.get() + front[v], leaving)) return false;
  }
  return true;
}

}  // namespace

bool is_closed(const qses_mesh &mesh) {
  const bool is_small = mesh.triangle_count <= std::numeric_limits<uint32_t>::max() / 3;
  return is_small ? is_closed_with<uint32_t>(mesh) : is_closed_with<size_t>(mesh);
}

}  // namespace quickses::cli
