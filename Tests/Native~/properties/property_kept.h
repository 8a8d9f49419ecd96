// SPDX-License-Identifier: MIT
// Meshes that are kept: downloaded from a GPU, and picked in.
#pragma once

#include "properties/property_checks.h"

#include <limits>

namespace properties {

class Kept {
 public:
  explicit Kept(qses_context *context) {
    surface_fixture::expect_ok(qses_kept_mesh_create(&kept_));
    if (qses_keep(context, kept_) != QSES_OK) throw std::runtime_error(qses_last_error());
  }
  ~Kept() { qses_kept_mesh_destroy(kept_); }
  Kept(const Kept &) = delete;
  Kept &operator=(const Kept &) = delete;
  operator qses_kept_mesh *() const { return kept_; }

  // In host memory, wherever it was.
  Result download() const {
    qses_mesh mesh;
    qses_mesh_init(&mesh);
    qses_report report;
    qses_report_init(&report);
    surface_fixture::expect_ok(qses_kept_mesh_download(kept_));
    surface_fixture::expect_ok(qses_kept_mesh_view(kept_, &mesh));
    surface_fixture::expect_ok(qses_kept_mesh_report(kept_, &report));
    return result_of(mesh, report);
  }

 private:
  qses_kept_mesh *kept_ = nullptr;
};

// How far along a ray (in lengths of the direction) the first triangle is that it meets farther from their borders than
// `clear` (Å), as seen along the ray: nearer to them, and in slivers, rounding decides.
inline double first_on_ray(const mesh_checks::Mesh &mesh, const Point &origin, const Point &direction, double clear) {
  double first = std::numeric_limits<double>::infinity();
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    const uint32_t *const corner = &mesh.indices[3 * t];
    const Point a = point(mesh.position(corner[0])), ab = point(mesh.position(corner[1])) - a,
                ac = point(mesh.position(corner[2])) - a;
    const Point p = exact_reference::cross(direction, ac), q = exact_reference::cross(origin - a, ab);
    const double det = exact_reference::dot(ab, p);
    if (det == 0) continue;
    const double v = exact_reference::dot(origin - a, p) / det, w = exact_reference::dot(direction, q) / det,
                 distance = exact_reference::dot(ac, q) / det;
    // A weight is the distance from the edge across over the height; twice the area is that by the edge's length.
    const auto is_clear = [&](double weight, const Point &edge) {
      return weight * std::abs(det) > clear * length(exact_reference::cross(direction, edge));
    };
    const bool is_met = is_clear(v, ac) && is_clear(w, ab) && is_clear(1 - v - w, ac - ab);
    if (is_met && distance >= 0) first = std::min(first, distance);
  }
  return first;
}

// Rays from outside towards some triangles: the nearest is found, and that is on the ray.
inline void check_picks(const Case &c, const Result &r, const Kept &kept, Verdict &v) {
  const mesh_checks::Mesh &mesh = r.surface.mesh;
  const double rounding = rounding_of_positions(c);
  if (mesh.triangle_count() == 0) return;
  Random random(c.seed + 99);
  for (int n = 0; n < 4; ++n) {
    const uint32_t *const target = &mesh.indices[3 * static_cast<size_t>(random.below(mesh.triangle_count()))];
    Point middle{0, 0, 0};
    for (int k = 0; k < 3; ++k) middle = middle + (1.0 / 3) * point(mesh.position(target[k]));
    const Point from = middle + random.uniform(1, 20) * random.direction();
    const float origin[3] = {float(from.x), float(from.y), float(from.z)};
    const Point exact{double(origin[0]), double(origin[1]), double(origin[2])}, way = middle - exact;
    const float direction[3] = {float(way.x), float(way.y), float(way.z)};
    const Point along{double(direction[0]), double(direction[1]), double(direction[2])};
    // Both work with doubles.
    const double clear = 1e-10 * (length(exact) + length(along)), distance = first_on_ray(mesh, exact, along, clear),
                 play = 1e-4 + 16 * rounding / length(along);
    qses_hit hit;
    qses_hit_init(&hit);
    if (qses_kept_mesh_pick(kept, origin, direction, nullptr, 0, &hit) != QSES_OK)
      return blame(v, Fault::kStatus, "pick: %s", qses_last_error());
    const double found = hit.found ? static_cast<double>(hit.distance) : exact_reference::kInfinity;
    if (found > distance + play)
      return blame(v, Fault::kForm, "a ray finds a triangle %g ways off, not that %g ways off", found, distance);
    if (!hit.found) continue;
    const uint32_t *const corner = &mesh.indices[3 * size_t(hit.triangle)];
    if (hit.vertex != corner[0] && hit.vertex != corner[1] && hit.vertex != corner[2])
      return blame(v, Fault::kForm, "a ray finds vertex %u, which triangle %u has not", hit.vertex, hit.triangle);
    if (hit.owner != mesh.owners[hit.vertex])
      return blame(v, Fault::kForm, "a ray finds atom %u at vertex %u", hit.owner, hit.vertex);
    const Point place{double(hit.position[0]), double(hit.position[1]), double(hit.position[2])};
    if (length(place - (exact + found * along)) > 1e-3 * (1 + length(along)) + 16 * rounding)
      return blame(v, Fault::kForm, "a ray finds a place beside it");
  }
}

}  // namespace properties
