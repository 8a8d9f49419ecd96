// SPDX-License-Identifier: MIT
// Meshes as random_use_test.cpp compares them: all their bytes, and what a context of its own makes of the same
// request.
#pragma once

#include "capi/kept_mesh_fixture.h"
#include "jobs/jobs_fixture.h"
#include "properties/property_random.h"

#include <memory>
#include <optional>
#include <set>

namespace random_use {

using namespace kept_mesh_fixture;
using properties::Random;

// What is computed: atoms and what they look like. Empty arrays are the defaults.
struct Frame {
  Atoms atoms;
  std::vector<uint8_t> visible, colors;
  std::vector<float> texcoords;
  bool is_wide = false;  // too wide for the finest spacing

  void give_to(qses_context *context) const {
    set_atoms(context, atoms);
    if (!visible.empty()) expect_ok(qses_set_visible(context, visible.data(), visible.size()));
    if (!colors.empty()) expect_ok(qses_set_colors(context, colors.data(), atoms.size()));
    if (!texcoords.empty()) expect_ok(qses_set_texcoords(context, texcoords.data(), atoms.size()));
  }
};

// All bytes of a mesh and of the part of its report that is a matter of the input.
class Snapshot {
 public:
  uint32_t tag = 0, level = 0, level_count = 0;

  Snapshot() = default;
  Snapshot(const qses_mesh &m, const qses_report &r) : tag(m.tag), level(m.level), level_count(m.level_count) {
    const size_t v = m.vertex_count, t = m.triangle_count;
    add("vertex_count", &m.vertex_count, 4);
    add("triangle_count", &m.triangle_count, 4);
    add("vertex_bytes", &m.vertex_bytes, 4);
    add("positions", m.positions, v * (m.vertex_bytes ? m.vertex_bytes : 12));
    add("normals", m.vertex_bytes ? nullptr : m.normals, 12 * v);
    add("colors", m.colors, 4 * v);
    add("texcoords", m.texcoords, 8 * v);
    add("owners", m.owners, 4 * v);
    add("patches", m.patches, v);
    add("indices", m.indices, 12 * t);
    add("bounds_min", m.bounds_min, 12);
    add("bounds_max", m.bounds_max, 12);
    add("spacing", &m.spacing, 4);
    add("components", m.components, m.component_count * sizeof(qses_component));
    add("component_ids", m.component_ids, 4 * v);
    add("atom_areas", m.atom_areas, 8 * size_t(m.atom_count));
    add("repeated", m.repeated, 4 * size_t(m.repeated_count));
    add("has_texcoords", &m.has_texcoords, 4);
    add("report.area", &r.area, 8);
    add("report.volume", &r.volume, 8);
    add("report.mesh_bytes", m.owners ? &r.mesh_bytes : nullptr, 8);  // else a matter of how it was made
    add("report.hidden_vertices", &r.hidden_vertices, 4);
    add("report.hidden_triangles", &r.hidden_triangles, 4);
    add("report.triangle_area", &r.triangle_area, 8);
    add("report.triangle_volume", &r.triangle_volume, 8);
    add("report.measured_by", &r.measured_by, 4);
  }

  // The first part that is another one, or "".
  std::string difference(const Snapshot &other) const {
    if (parts_.size() != other.parts_.size()) return "what there is of it";
    for (size_t k = 0; k < parts_.size(); ++k)
      if (parts_[k] != other.parts_[k]) return parts_[k].first;
    return "";
  }

 private:
  void add(const char *name, const void *bytes, size_t size) {
    if (!bytes) size = 0;
    parts_.emplace_back(std::string(name) + (bytes ? "" : " (none)"),
                        std::string(static_cast<const char *>(size ? bytes : ""), size));
  }
  std::vector<std::pair<std::string, std::string>> parts_;
};

// Why the mesh is not closed, though nothing is left out of it, or "".
inline std::string opening(const qses_mesh &m) {
  if (!m.indices || m.vertex_bytes) return "";
  mesh_checks::Mesh mesh;
  const size_t once = m.vertex_count - size_t(m.repeated_count);
  mesh.positions.assign(m.positions, m.positions + 3 * once);
  mesh.indices.assign(m.indices, m.indices + 3 * size_t(m.triangle_count));
  for (uint32_t &v : mesh.indices)
    if (v >= once) v = m.repeated[v - once];
  return mesh_checks::manifold_fault(mesh);
}

// A computation that was asked for, and what it has to give: made by a fresh context, once that is needed.
class Request {
 public:
  Request(std::shared_ptr<const Frame> of, const qses_settings &s, bool a_job)
      : frame(std::move(of)), settings(s), is_job(a_job) {
    for (uint32_t k = 0; k < s.level_count && a_job; ++k)
      if (s.levels[k] > s.spacing) spacings.push_back(s.levels[k]);
    spacings.push_back(s.spacing);
  }

  std::shared_ptr<const Frame> frame;
  qses_settings settings;
  bool is_job;
  bool is_dropped = false;      // never to be seen
  std::vector<float> spacings;  // of its levels
  uint32_t finest() const { return static_cast<uint32_t>(spacings.size()) - 1; }

  // How it ends at its finest spacing where nothing disturbs it.
  qses_status status() {
    if (!finest_) make_finest();
    return status_;
  }

  // "" if this is the mesh of that level.
  std::string difference(const Snapshot &mesh) {
    if (mesh.level > finest()) return "level";
    if (mesh.level_count != finest() + 1) return "level_count";
    if (mesh.level < finest()) {
      // Levels before one that is too fine are so small a part of the job that it may not tell of them one by one.
      if (settings.spacing < 0.01f) return "";
      if (coarser_.empty()) make_coarser();
      if (!coarser_[mesh.level]) return "a level that is never there";
      return mesh.difference(*coarser_[mesh.level]);
    }
    if (status() != QSES_OK) return "a mesh that can't be made";
    return mesh.difference(*finest_);
  }

 private:
  void make_finest() {
    const Context alone(1);
    frame->give_to(alone);
    qses_mesh mesh = empty_mesh();
    status_ = qses_compute(alone, &settings, &mesh);
    finest_.emplace();
    if (status_ != QSES_OK) return;
    finest_.emplace(mesh, report_of(alone));
    check_closed(mesh);
  }
  // Of a job that waits after each level until it is collected.
  void make_coarser() {
    coarser_.resize(finest());
    const Context alone(1);
    frame->give_to(alone);
    expect_ok(qses_set_progress_callback(alone, wait_until_collected, static_cast<qses_context *>(alone)));
    qses_settings all = settings;
    all.frame_budget_ms = 0;
    expect_ok(qses_begin(alone, &all));
    for (bool is_over = false; !is_over;) {
      qses_bool finished = 0;
      expect_ok(qses_wait(alone, 0.05, &finished));
      is_over = finished != 0;
      qses_mesh mesh = empty_mesh();
      if (qses_collect(alone, &mesh) != QSES_OK || mesh.level >= finest()) continue;
      coarser_[mesh.level].emplace(mesh, report_of(alone));
      check_closed(mesh);
    }
  }
  static void wait_until_collected(void *context, double) {
    while (jobs_fixture::poll(static_cast<qses_context *>(context)).mesh_ready) std::this_thread::yield();
  }

 public:
  void check_closed(const qses_mesh &mesh) const {
    if (frame->visible.empty() && !settings.outer_only) {
      EXPECT_EQ(opening(mesh), "");
    }
  }

 private:
  qses_status status_ = QSES_OK;
  std::optional<Snapshot> finest_;
  std::vector<std::optional<Snapshot>> coarser_;
};

}  // namespace random_use
