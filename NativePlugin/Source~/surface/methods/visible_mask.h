// SPDX-License-Identifier: MIT
// Drops the triangles of hidden atoms and of components that are left out, and the vertices that no triangle uses any
// more. What stays keeps its order.
#pragma once

#include "surface/methods/level_work.h"
#include "surface/stages/kept_parts.h"

namespace quickses {

// Which triangles stay: those whose owners are all visible and whose component is. nullptr: all are.
struct ShownParts {
  VisibleAtoms atoms;
  const uint8_t *components;
  QSES_FN bool has(const MeshView &mesh, const uint32_t *t) const {
    if (components && !components[mesh.component_id(t[0])]) return false;
    return !atoms || is_shown(t, mesh.owners, atoms);
  }
};

// 32 triangles: which stay, and the vertices of those.
struct MarkShown {
  MeshView mesh;
  size_t triangles;
  ShownParts shown;
  KeptParts kept;
  QSES_HOST_DEVICE void operator()(size_t word) const {
    uint32_t bits = 0;
    for (uint32_t k = 0; k < 32 && 32 * word + k < triangles; ++k) {
      const uint32_t *const t = mesh.triangle(32 * word + k);
      if (!shown.has(mesh, t)) continue;
      bits |= uint32_t(1) << k;
      for (int corner = 0; corner < 3; ++corner) {
        uint32_t *const at = kept.vertices.words + t[corner] / 32;
        const uint32_t bit = uint32_t(1) << t[corner] % 32;
        if (!(atomic_load(at) & bit)) atomic_or(at, bit);
      }
    }
    kept.triangles.words[word] = bits;
  }
};

template <class Work>
MeshMemoryView drop_hidden(Work &work, const MeshMemoryView &whole, const ShownParts &shown, MeshPurpose purpose) {
  auto &executor = work.executor;
  const KeptParts kept{allocate_set(executor, whole.vertices), allocate_set(executor, whole.triangles)};
  executor.for_each((whole.triangles + 31) / 32, MarkShown{whole.view, whole.triangles, shown, kept});
  uint32_t vertex_count = rank_set(executor, kept.vertices, whole.vertices);
  uint32_t triangle_count = rank_set(executor, kept.triangles, whole.triangles);
  if (std::decay_t<decltype(executor)>::kCounts) {  // how many stay is not known: at most all
    vertex_count = static_cast<uint32_t>(whole.vertices);
    triangle_count = static_cast<uint32_t>(whole.triangles);
  }
  MeshMemoryView part =
      work.memory.allocate_mesh(executor, vertex_count, triangle_count, work.shape, purpose, work.plan.mesh_in_pieces);
  add_normals(work, &part);
  keep_parts(executor, whole.view, whole.vertices, whole.triangles, kept, part.view);
  work.report->hidden_vertices = static_cast<uint32_t>(whole.vertices) - vertex_count;
  work.report->hidden_triangles = static_cast<uint32_t>(whole.triangles) - triangle_count;
  return part;
}

}  // namespace quickses
