// SPDX-License-Identifier: MIT
// Is a mesh a closed, consistently oriented 2-manifold? For tests; knows nothing of the library.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace mesh_checks {

struct Mesh {
  std::vector<float> positions;   // V x 3
  std::vector<float> normals;     // V x 3, or empty
  std::vector<uint32_t> owners;   // V, or empty
  std::vector<uint32_t> indices;  // T x 3

  size_t vertex_count() const { return positions.size() / 3; }
  size_t triangle_count() const { return indices.size() / 3; }
  std::array<double, 3> position(size_t v) const {
    return {positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]};
  }
};

// An empty string if every index is valid, every edge has exactly two triangles that pass it in opposite directions,
// the triangles around every vertex form one fan, every vertex is used, and no number is NaN or infinite. Else the
// first fault in words. Triangles may have no area: that is geometry, not connection.
inline std::string manifold_fault(const Mesh &mesh) {
  const auto number = [](size_t n) { return std::to_string(n); };
  const size_t vertices = mesh.vertex_count();
  if (mesh.positions.size() % 3 || mesh.indices.size() % 3) return "the arrays are not made of triples";
  for (size_t k = 0; k < mesh.positions.size(); ++k)
    if (!std::isfinite(mesh.positions[k])) return "vertex " + number(k / 3) + " is not finite";
  for (size_t k = 0; k < mesh.normals.size(); ++k)
    if (!std::isfinite(mesh.normals[k])) return "the normal of vertex " + number(k / 3) + " is not finite";

  // Around each vertex a triangle leads from its next corner to the one after: in a closed fan these links are a cycle.
  struct Link {
    uint32_t vertex, from, to;
  };
  std::vector<Link> links;
  links.reserve(mesh.indices.size());
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    const uint32_t *c = mesh.indices.data() + 3 * t;
    for (int k = 0; k < 3; ++k) {
      if (c[k] >= vertices)
        return "triangle " + number(t) + " names vertex " + number(c[k]) + " of " + number(vertices);
      if (c[k] == c[(k + 1) % 3]) return "triangle " + number(t) + " names vertex " + number(c[k]) + " twice";
      links.push_back({c[k], c[(k + 1) % 3], c[(k + 2) % 3]});
    }
  }
  std::sort(links.begin(), links.end(), [](const Link &a, const Link &b) {
    return std::make_pair(a.vertex, a.from) < std::make_pair(b.vertex, b.from);
  });
  size_t begin = 0;
  for (size_t v = 0; v < vertices; ++v) {
    size_t end = begin;
    while (end < links.size() && links[end].vertex == v) ++end;
    if (begin == end) return "vertex " + number(v) + " has no triangle";
    std::vector<std::pair<uint32_t, uint32_t>> fan;
    for (size_t k = begin; k < end; ++k) fan.emplace_back(links[k].from, links[k].to);
    for (size_t k = 1; k < fan.size(); ++k)
      if (fan[k].first == fan[k - 1].first)
        return "edge " + number(v) + " - " + number(fan[k].first) + " is passed twice in the same direction";
    size_t at = 0;
    for (size_t k = 0; k < fan.size(); ++k) {
      const auto next = std::lower_bound(fan.begin(), fan.end(), std::make_pair(fan[at].second, uint32_t(0)));
      if (next == fan.end() || next->first != fan[at].second)
        return "edge " + number(v) + " - " + number(fan[at].second) + " has one triangle only";
      at = static_cast<size_t>(next - fan.begin());
      if (at == 0 && k + 1 < fan.size()) return "the triangles around vertex " + number(v) + " form several fans";
    }
    if (at != 0) return "the triangles around vertex " + number(v) + " do not close";
    begin = end;
  }
  return "";
}

// Largest deviation of a normal's length from 1.
inline double worst_normal_length(const Mesh &mesh) {
  double worst = mesh.normals.size() == mesh.positions.size() ? 0.0 : 1.0;
  for (size_t v = 0; v + 2 < mesh.normals.size(); v += 3) {
    const double x = mesh.normals[v], y = mesh.normals[v + 1], z = mesh.normals[v + 2];
    worst = std::max(worst, std::abs(std::sqrt(x * x + y * y + z * z) - 1.0));
  }
  return worst;
}

inline double signed_volume(const Mesh &mesh) {
  double volume = 0;
  const std::array<double, 3> o = mesh.vertex_count() ? mesh.position(0) : std::array<double, 3>{};
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    std::array<double, 3> p[3];
    for (size_t k = 0; k < 3; ++k) p[k] = mesh.position(mesh.indices[3 * t + k]);
    // From a corner: of pieces far from o, products of large numbers would cancel.
    for (size_t d = 0; d < 3; ++d) p[1][d] -= p[0][d], p[2][d] -= p[0][d], p[0][d] -= o[d];
    volume += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) + p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
              p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
  }
  return volume / 6;
}

inline double area(const Mesh &mesh) {
  double sum = 0;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto a = mesh.position(mesh.indices[3 * t]), b = mesh.position(mesh.indices[3 * t + 1]);
    const auto c = mesh.position(mesh.indices[3 * t + 2]);
    const double u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    sum += 0.5 * std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  }
  return sum;
}

// Number of connected pieces.
inline size_t piece_count(const Mesh &mesh) {
  std::vector<uint32_t> root(mesh.vertex_count());
  for (size_t v = 0; v < root.size(); ++v) root[v] = static_cast<uint32_t>(v);
  const auto find = [&](uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (size_t k = 0; k + 2 < mesh.indices.size(); k += 3) {
    root[find(mesh.indices[k])] = find(mesh.indices[k + 1]);
    root[find(mesh.indices[k])] = find(mesh.indices[k + 2]);
  }
  size_t pieces = 0;
  for (size_t v = 0; v < root.size(); ++v) pieces += root[v] == v ? 1 : 0;
  return pieces;
}

}  // namespace mesh_checks
