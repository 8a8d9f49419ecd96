// SPDX-License-Identifier: MIT
// Simple closed meshes with known areas and volumes, for tests.
#pragma once

#include "surface/mesh_checks.h"

#include <cmath>
#include <map>
#include <utility>

namespace mesh_shapes {

using mesh_checks::Mesh;

inline Mesh tetrahedron() {
  Mesh m;
  m.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  m.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  return m;
}

// Edge 2, from (-1, -1, -1) to (1, 1, 1).
inline Mesh cube() {
  Mesh m;
  for (int c = 0; c < 8; ++c)
    for (int d = 0; d < 3; ++d) m.positions.push_back(c >> d & 1 ? 1.f : -1.f);
  m.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
               2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return m;
}

inline Mesh octahedron() {
  Mesh m;
  m.positions = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
  m.indices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  return m;
}

// Octahedron whose edges are halved so many times, on the unit sphere.
inline Mesh sphere(int halvings) {
  Mesh m = octahedron();
  for (int k = 0; k < halvings; ++k) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto found = middles.emplace(std::minmax(a, b), static_cast<uint32_t>(m.vertex_count()));
      if (found.second) {
        double p[3], length2 = 0;
        for (size_t d = 0; d < 3; ++d) {
          p[d] = static_cast<double>(m.positions[3 * a + d]) + static_cast<double>(m.positions[3 * b + d]);
          length2 += p[d] * p[d];
        }
        for (double x : p) m.positions.push_back(static_cast<float>(x / std::sqrt(length2)));
      }
      return found.first->second;
    };
    std::vector<uint32_t> finer;
    for (size_t t = 0; t < m.triangle_count(); ++t) {
      const uint32_t a = m.indices[3 * t], b = m.indices[3 * t + 1], c = m.indices[3 * t + 2];
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (uint32_t v : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca}) finer.push_back(v);
    }
    m.indices = finer;
  }
  return m;
}

inline void scale_and_move(Mesh &m, double scale, double x, double y, double z) {
  const double to[3] = {x, y, z};
  for (size_t k = 0; k < m.positions.size(); ++k)
    m.positions[k] = static_cast<float>(scale * static_cast<double>(m.positions[k]) + to[k % 3]);
}

inline void reverse(Mesh &m) {
  for (size_t k = 0; k < m.indices.size(); k += 3) std::swap(m.indices[k + 1], m.indices[k + 2]);
}

inline void append(Mesh &m, const Mesh &other) {
  const uint32_t first = static_cast<uint32_t>(m.vertex_count());
  m.positions.insert(m.positions.end(), other.positions.begin(), other.positions.end());
  for (uint32_t v : other.indices) m.indices.push_back(first + v);
}

}  // namespace mesh_shapes
