// SPDX-License-Identifier: MIT
// A mesh that was handed out, with its numbers, copied out of the memory of the context.
#pragma once

#include "surface/surface_fixture.h"

#include <cstring>

namespace properties {

using surface_fixture::Surface;

struct Result {
  Surface surface;
  std::array<float, 3> low{}, high{};
  std::vector<qses_component> components;
  uint32_t vertex_count = 0, triangle_count = 0;      // also where there are no arrays
  std::vector<std::array<int8_t, 4>> packed_normals;  // of vertices that are COMPACT, instead of normals
  std::vector<uint8_t> colors;
  std::vector<float> texcoords;
  std::vector<uint32_t> component_ids, repeated;
  std::vector<double> atom_areas;
};

inline Result result_of(const qses_mesh &m, const qses_report &report) {
  const auto copy = [](auto *to, const auto *from, size_t count) {
    if (from) to->assign(from, from + count);
  };
  Result r;
  mesh_checks::Mesh &mesh = r.surface.mesh;
  const size_t v = m.vertex_count, t = m.triangle_count;
  if (m.vertex_bytes == 0) {
    copy(&mesh.positions, m.positions, 3 * v);
    copy(&mesh.normals, m.normals, 3 * v);
  } else if (m.positions) {
    const bool packed = m.vertex_bytes == 16;
    mesh.positions.resize(3 * v);
    mesh.normals.resize(packed ? 0 : 3 * v);
    r.packed_normals.resize(packed ? v : 0);
    for (size_t k = 0; k < v; ++k) {
      const char *const vertex = reinterpret_cast<const char *>(m.positions) + m.vertex_bytes * k;
      std::memcpy(&mesh.positions[3 * k], vertex, 12);
      if (packed)
        std::memcpy(r.packed_normals[k].data(), vertex + 12, 4);
      else
        std::memcpy(&mesh.normals[3 * k], vertex + 12, 12);
    }
  }
  copy(&mesh.owners, m.owners, v);
  copy(&mesh.indices, m.indices, 3 * t);
  copy(&r.surface.patches, m.patches, v);
  copy(&r.colors, m.colors, 4 * v);
  copy(&r.texcoords, m.texcoords, 2 * v);
  copy(&r.component_ids, m.component_ids, v);
  copy(&r.repeated, m.repeated, static_cast<size_t>(m.repeated_count));
  copy(&r.components, m.components, m.component_count);
  copy(&r.atom_areas, m.atom_areas, static_cast<size_t>(m.atom_count));
  r.vertex_count = m.vertex_count;
  r.triangle_count = m.triangle_count;
  r.surface.report = report;
  std::copy(m.bounds_min, m.bounds_min + 3, r.low.begin());
  std::copy(m.bounds_max, m.bounds_max + 3, r.high.begin());
  return r;
}

}  // namespace properties
