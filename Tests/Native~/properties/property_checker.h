// SPDX-License-Identifier: MIT
// Computes the cases of the property tests and checks them, through the C API as a user would: one context computes set
// after set.
#pragma once

#include "properties/property_form_checks.h"
#include "properties/property_gaussian.h"
#include "properties/property_kept.h"

#include <chrono>
#include <thread>

namespace properties {

using surface_fixture::Context;

inline const char *difference(const Result &a, const Result &b) {
  const auto same = [](const auto &x, const auto &y) {
    return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0);
  };
  if (!same(a.surface.mesh.indices, b.surface.mesh.indices)) return "triangles";
  if (!same(a.surface.mesh.positions, b.surface.mesh.positions)) return "positions";
  if (!same(a.surface.mesh.normals, b.surface.mesh.normals)) return "normals";
  if (!same(a.surface.mesh.owners, b.surface.mesh.owners)) return "owners";
  if (!same(a.surface.patches, b.surface.patches)) return "patches";
  if (!same(a.texcoords, b.texcoords)) return "texture coordinates";
  if (!same(a.component_ids, b.component_ids)) return "component ids";
  if (!same(a.atom_areas, b.atom_areas)) return "areas of atoms";
  if (a.surface.report.area != b.surface.report.area || a.surface.report.volume != b.surface.report.volume)
    return "measures";
  return nullptr;
}

class Checker {
 public:
  Checker() : context_(2), one_thread_(1) {}

  Verdict check(const Case &wanted) {
    Case c = wanted;
    c.settings = settings_of_first(wanted.settings, wanted.form);
    const auto start = std::chrono::steady_clock::now();
    Verdict v;
    Result r;
    if (compute(context_, c.atoms, c.settings, c, v, r)) {
      v.border_bricks = r.surface.report.border_bricks;
      v.unplaced = r.surface.report.unplaced_vertices;
      v.vertices = static_cast<uint32_t>(r.surface.vertex_count());
      check_connection(r, v);
      if (v.good()) check_bounds(r, v);
      if (v.good()) check_measures(c, r, v);
      if (v.good()) check_owners(c, r, v);
      if (v.good()) check_additions(r, v);
      if (v.good() && c.settings.surface == QSES_SURFACE_GAUSSIAN) {
        check_gaussian(c, r, v);
      } else if (v.good() && c.settings.method == QSES_METHOD_EXACT) {
        const ExactSurface exact(c);
        check_distances(c, r, exact, v);
        if (v.good()) check_edges(c, r, v);
        if (v.good()) check_sides(c, r, exact, v);
        if (v.good()) check_closed_form(c, r, v);
      }
      if (v.good()) compare(c, r, v);
    }
    v.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return v;
  }

 private:
  // False if there is no mesh, which is a fault unless it is what the manual says.
  static bool compute(qses_context *context, const Atoms &atoms, const qses_settings &s, const Case &c, Verdict &v,
                      Result &r) {
    return is_done(set_atoms(context, atoms), c, v) && compute_again(context, s, c, v, r);
  }

  static qses_status set_atoms(qses_context *context, const Atoms &atoms) {
    return qses_set_atoms(context, atoms.positions.data(), 0, atoms.radii.data(), atoms.size());
  }

  // Of the atoms that the context has.
  static bool compute_again(qses_context *context, const qses_settings &s, const Case &c, Verdict &v, Result &r) {
    qses_mesh mesh;
    qses_mesh_init(&mesh);
    if (!is_done(qses_compute(context, &s, &mesh), c, v)) return false;
    r = result_of(mesh, surface_fixture::report_of(context));
    return true;
  }

  static bool is_done(qses_status status, const Case &c, Verdict &v) {
    if (status == QSES_OK) return true;
    // Float32 can't tell places apart that are 2^21 spacings from the middle; nobody can ask for half of that for
    // certain.
    const bool may_refuse =
        status == QSES_TOO_FINE && half_extent(c.atoms) > static_cast<double>(c.settings.spacing) * std::ldexp(1.0, 20);
    if (!may_refuse) blame(v, Fault::kStatus, "status %d: %s", static_cast<int>(status), qses_last_error());
    return false;
  }

  void expect_same(qses_context *context, const Case &c, const qses_settings &s, const Result &first, const char *how,
                   Verdict &v) {
    Result r;
    if (!v.good() || !compute(context, c.atoms, s, c, v, r)) return;
    if (const char *what = difference(first, r)) blame(v, Fault::kBytes, "other %s %s", what, how);
  }

  void compare(const Case &c, const Result &r, Verdict &v) {
    if (c.comparisons & kThreads) expect_same(one_thread_, c, c.settings, r, "with one thread", v);
    if (c.comparisons & kSlices) {
      qses_settings s = c.settings;
      s.slice_size = 8 + static_cast<uint32_t>(c.seed % 40);
      expect_same(context_, c, s, r, "in slices", v);
    }
    if (c.comparisons & kStageTimes) {
      qses_set_stage_times(context_, 1);
      expect_same(context_, c, c.settings, r, "with the times of stages", v);
      qses_set_stage_times(context_, 0);
    }
    if (c.comparisons & kBudget) compare_with_budget(c, r, v);
    if (c.comparisons & kLevels) compare_with_job(c, r, v);
    if (c.comparisons & kPermuted) compare_in_another_order(c, r, v);
    if (c.comparisons & kFrames) compare_after_another_frame(c, r, v);
    if (c.form && v.good()) compare_in_another_form(c, r, v);
  }

  void compare_in_another_form(const Case &c, const Result &first, Verdict &v) {
    const qses_settings s = settings_of_form(c.settings, c.form);
    const Look look(c.atoms.size(), c.form), plain(c.atoms.size(), 0);
    Result other;
    if (set_atoms(context_, c.atoms) != QSES_OK || look.set(context_, c.atoms.size()) != QSES_OK)
      return blame(v, Fault::kStatus, "look: %s", qses_last_error());
    if (compute_again(context_, s, c, v, other)) {
      if (s.delivery == QSES_DELIVERY_DEVICE) {
        if (!other.surface.mesh.positions.empty() || !other.surface.mesh.indices.empty())
          blame(v, Fault::kForm, "a mesh on the device only is in host memory");
        other = Kept(context_).download();
      }
      if (v.good()) FormComparison(c, first, other, v).run();
      // The mesh on the device has gone, and numbers are no mesh.
      if (v.good() && s.pickable && s.delivery == QSES_DELIVERY_HOST && !s.without_owners)
        check_picks(c, other, Kept(context_), v);
    }
    plain.set(context_, c.atoms.size());
  }

  // Each atom moved its own way; what a context has learnt of one frame must not matter to the next one.
  void compare_after_another_frame(const Case &c, const Result &first, Verdict &v) {
    Atoms before = c.atoms;
    for (size_t k = 0; k < before.positions.size(); ++k) {
      const double way = static_cast<double>((k + 1) * 2654435761u % 1024) / 512 - 1;
      before.positions[k] =
          static_cast<float>(std::min(1e6, std::max(-1e6, static_cast<double>(before.positions[k]) + 3 + way)));
    }
    const Context context(2);
    Result r;
    if (!compute(context, before, c.settings, c, v, r)) return;
    const qses_status status = qses_set_positions(context, c.atoms.positions.data(), 0, c.atoms.size());
    if (!is_done(status, c, v) || !compute_again(context, c.settings, c, v, r)) return;
    if (const char *what = difference(first, r)) blame(v, Fault::kFrame, "other %s after another frame", what);
  }

  void compare_with_budget(const Case &c, const Result &r, Verdict &v) {
    qses_size_estimate estimate;
    qses_size_estimate_init(&estimate);
    if (qses_estimate(context_, &c.settings, &estimate) != QSES_OK)
      return blame(v, Fault::kStatus, "estimate: %s", qses_last_error());
    const Context context(2, estimate.smallest_budget + estimate.smallest_budget / 2);
    qses_mesh mesh;
    qses_mesh_init(&mesh);
    qses_status status = set_atoms(context, c.atoms);
    if (status == QSES_OK) status = qses_compute(context, &c.settings, &mesh);
    if (status == QSES_OUT_OF_MEMORY) return;  // the estimate is one
    if (status != QSES_OK)
      return blame(v, Fault::kStatus, "status %d with a budget: %s", static_cast<int>(status), qses_last_error());
    if (const char *what = difference(r, result_of(mesh, surface_fixture::report_of(context))))
      blame(v, Fault::kBytes, "other %s with a memory budget", what);
  }

  // The mesh of a job's last level; all levels must be closed. The context stays with it.
  static Result run_job(qses_context *context, const Case &c, const qses_settings &s, Verdict &v) {
    Result last;
    if (set_atoms(context, c.atoms) != QSES_OK || qses_begin(context, &s) != QSES_OK) {
      blame(v, Fault::kStatus, "begin: %s", qses_last_error());
      return last;
    }
    qses_progress progress;
    do {
      qses_progress_init(&progress);
      qses_poll(context, &progress);
      qses_mesh mesh;
      qses_mesh_init(&mesh);
      if (progress.mesh_ready && qses_collect(context, &mesh) == QSES_OK) {
        last = result_of(mesh, surface_fixture::report_of(context));
        const std::string fault = mesh_checks::manifold_fault(last.surface.mesh);
        if (!fault.empty()) blame(v, Fault::kOpen, "level %u of a job: %s", mesh.level, fault.c_str());
      } else {
        std::this_thread::yield();
      }
    } while (progress.state == QSES_JOB_RUNNING || progress.mesh_ready);
    qses_wait(context, -1, nullptr);
    if (progress.state != QSES_JOB_FINISHED && progress.status != QSES_TOO_FINE)
      blame(v, Fault::kStatus, "job: %.200s", progress.message);
    return last;
  }

  // The same settings give the same bytes, computed or as the last level of a job.
  void compare_with_job(const Case &c, const Result &r, Verdict &v) {
    qses_settings s = c.settings;
    if (const char *what = difference(r, run_job(context_, c, s, v)))
      blame(v, Fault::kBytes, "other %s from a job", what);
    if (s.spacing > 25) return;
    s.level_count = 2;
    s.levels[0] = 4 * s.spacing;
    s.levels[1] = 2 * s.spacing;
    const Result first = run_job(context_, c, s, v), second = run_job(one_thread_, c, s, v);
    if (const char *what = difference(first, second))
      blame(v, Fault::kBytes, "other %s from a job with one thread", what);
  }

  // Rounding may differ, and with it lattice points on the surface: so do triangles, a little.
  void compare_in_another_order(const Case &c, const Result &r, Verdict &v) {
    Case other = c;
    Random random(c.seed + 5);
    for (size_t i = c.atoms.size(); i > 1; --i) {
      const size_t j = static_cast<size_t>(random.below(i));
      std::swap(other.atoms.radii[i - 1], other.atoms.radii[j]);
      for (size_t d = 0; d < 3; ++d)
        std::swap(other.atoms.positions[3 * (i - 1) + d], other.atoms.positions[3 * j + d]);
    }
    Result s;
    if (!compute(context_, other.atoms, other.settings, other, v, s)) return;
    check_connection(s, v);
    const double a = r.surface.report.triangle_area, b = s.surface.report.triangle_area,
                 h = static_cast<double>(c.settings.spacing);
    const double play = 0.02 * a + 40 * h * h + 1e-9;
    if (std::abs(a - b) > play) blame(v, Fault::kOrder, "area %.9g; with atoms in another order %.9g", a, b);
  }

  Context context_, one_thread_;
};

}  // namespace properties
