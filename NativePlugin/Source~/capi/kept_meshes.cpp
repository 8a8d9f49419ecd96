// SPDX-License-Identifier: MIT
// The part of the C API about kept meshes.
#include "capi/context.h"
#include "capi/structs.h"
#include "io/text.h"
#include "kept/kept_mesh.h"

#include <cmath>

namespace {

using quickses::check_struct;
using quickses::guarded;
using quickses::invalid;
using quickses::KeptMesh;
using quickses::require;
using quickses::require_owners;
using quickses::write_struct;

void check_on_host(const KeptMesh &kept) {
  if (kept.is_elsewhere()) invalid("the mesh is on the device only: call qses_kept_mesh_download first");
}

void check_owners(const KeptMesh &kept) {
  check_on_host(kept);
  require_owners(kept.mesh);
}

// one, many: of what there are `total`.
void check_run(const char *one, const char *many, uint32_t first, uint32_t count, uint32_t total) {
  if (first > total || count > total - first)
    invalid("first is " + std::to_string(first) + " and count is " + std::to_string(count) + ", but " +
            quickses::io::there_are(total, one, many));
}

void check_atoms(const KeptMesh &kept, size_t atom_count) {
  if (atom_count != kept.atom_count)
    invalid("atom_count is " + std::to_string(atom_count) + " but the mesh was made of " +
            quickses::io::counted(kept.atom_count, "atom"));
}

void check_ray(const float origin[3], const float direction[3]) {
  require(origin, "origin");
  require(direction, "direction");
  bool has_length = false;
  for (int d = 0; d < 3; ++d) {
    if (!std::isfinite(origin[d])) invalid("origin has a coordinate that is no finite number");
    if (!std::isfinite(direction[d])) invalid("direction has a coordinate that is no finite number");
    has_length = has_length || direction[d] != 0.f;
  }
  if (!has_length) invalid("direction has no length");
}

}  // namespace

extern "C" {

qses_status qses_kept_mesh_create(qses_kept_mesh **kept) {
  if (kept) *kept = nullptr;
  return guarded([&] {
    require(kept, "kept");
    *kept = new qses_kept_mesh;
  });
}

void qses_kept_mesh_destroy(qses_kept_mesh *kept) {
  guarded([&] { delete kept; });
}

void qses_kept_mesh_clear(qses_kept_mesh *kept) {
  guarded([&] {
    if (kept) kept->held.clear();
  });
}

qses_status qses_keep(qses_context *context, qses_kept_mesh *kept) {
  return guarded([&] {
    require(context, "context");
    require(kept, "kept");
    context->job->keep(&kept->held);
  });
}

qses_status qses_kept_mesh_download(qses_kept_mesh *kept) {
  return guarded([&] {
    require(kept, "kept");
    quickses::require_kept(*kept);
    kept->held.download();
  });
}

qses_status qses_kept_mesh_view(const qses_kept_mesh *kept, qses_mesh *mesh) {
  return guarded([&] {
    require(kept, "kept");
    require(mesh, "mesh");
    write_struct(mesh, kept->held.mesh, "qses_mesh");
  });
}

qses_status qses_kept_mesh_report(const qses_kept_mesh *kept, qses_report *report) {
  return guarded([&] {
    require(kept, "kept");
    require(report, "report");
    quickses::require_kept(*kept);
    write_struct(report, kept->held.report, "qses_report");
  });
}

qses_status qses_kept_mesh_paint(const qses_kept_mesh *kept, const void *per_atom, size_t value_bytes,
                                 size_t atom_count, uint32_t first, uint32_t count, void *per_vertex) {
  return guarded([&] {
    require(kept, "kept");
    if (value_bytes % 4 != 0 || value_bytes < 4 || value_bytes > 16)
      invalid("value_bytes is " + std::to_string(value_bytes) + ": it must be 4, 8, 12 or 16");
    check_owners(kept->held);
    check_atoms(kept->held, atom_count);
    check_run("vertex", "vertices", first, count, kept->held.mesh.vertex_count);
    if (count == 0) return;
    require(per_atom, "per_atom");
    require(per_vertex, "per_vertex");
    quickses::paint(kept->held.mesh, per_atom, value_bytes, first, count, per_vertex);
  });
}

qses_status qses_kept_mesh_filter(const qses_kept_mesh *kept, const uint8_t *visible, size_t atom_count, uint32_t first,
                                  uint32_t count, uint32_t *indices, uint32_t *kept_triangles) {
  if (kept_triangles) *kept_triangles = 0;
  return guarded([&] {
    require(kept, "kept");
    require(kept_triangles, "kept_triangles");
    check_owners(kept->held);
    check_atoms(kept->held, atom_count);
    check_run("triangle", "triangles", first, count, kept->held.mesh.triangle_count);
    if (count == 0) return;
    require(visible, "visible");
    require(indices, "indices");
    *kept_triangles = quickses::filter(kept->held.mesh, visible, first, count, indices);
  });
}

qses_status qses_kept_mesh_pick(const qses_kept_mesh *kept, const float origin[3], const float direction[3],
                                const uint8_t *visible, size_t atom_count, qses_hit *hit) {
  return guarded([&] {
    require(kept, "kept");
    require(hit, "hit");
    check_struct(hit, "qses_hit");
    check_ray(origin, direction);
    check_owners(kept->held);
    if (visible) check_atoms(kept->held, atom_count);
    const KeptMesh &held = kept->held;
    write_struct(hit, quickses::pick(held.mesh, held.boxes, origin, direction, visible), "qses_hit");
  });
}

}  // extern "C"
