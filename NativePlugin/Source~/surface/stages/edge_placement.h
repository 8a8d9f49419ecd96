// SPDX-License-Identifier: MIT
// Where the sign changes on a lattice edge: there vertices start if edges are long, and there those stay that no
// projection finds a place for.
#pragma once

#include "surface/stages/thin_walls.h"

namespace quickses {

// What decides about points near a place is asked of Near: near(place, reach) are the atoms whose balls, and the arcs
// whose enclosing balls grown by depth, come within reach of it; they serve until the next are asked for.

// A vertex that finds its place by no other way is where the sign changes on its edge.
constexpr int kPlaceHalvings = 12;

// A lattice edge longer than the probe is wide may hold more than its middle tells: a vertex starts near the sign
// change.
constexpr int kStartHalvings = 8;
QSES_FN bool starts_by_halving(const SurfaceParameters &p) { return p.depth > 0.f && p.spacing > 2.f * p.depth; }

// So many points are looked at on all edges of a lattice point together, to find solid next to it.
QSES_FN int most_solid_looks(const SurfaceParameters &p) {
  return 2 * kWallSteps * (starts_by_halving(p) ? kMostWallSteps : 3);
}
// Solid next to a lattice point that is marked inside because a wall passes through an edge from it (thin_walls.h):
// along the edges, from ball to ball, of one edge at as many points as a wall may be away. The point itself if none is
// found, as by rounding, or of a wall that only the middle of an edge tells of.
template <class Near>
QSES_FN Vec3<float> find_solid(const FeatureView &f, const Near &near, const Vec3<float> &x) {
  const SurfaceParameters &p = f.parameters;
  const auto candidates = near(x, wall_step_length(kWallSteps - 1) * p.spacing + 1e-3f);
  const NearestProbe probe = nearest_probe(f, candidates, x);
  int left = most_solid_looks(p);
  for (int k = 0; k < 2 * kWallSteps; ++k) {
    const Vec3<float> direction = wall_direction(k / 2) * (k % 2 ? -1.f : 1.f);
    const float length = wall_step_length(k / 2) * p.spacing;
    float at = way_out(p, probe, x, direction) + kWallStep;
    for (int looks = 0; looks < kMostWallSteps && at < length && left > 0; ++looks, --left) {
      const Vec3<float> point = x + direction * at;
      const NearestProbe next = nearest_probe(f, candidates, point);
      if (next.distance > p.depth) return point;
      at += way_out(p, next, point, direction) + kWallStep;
    }
  }
  return x;
}

// Where the sign changes between the ends of an edge, or between the solid that its inside end stands for and the
// other one.
template <class Near>
QSES_FN Vec3<float> find_sign_change(const FeatureView &f, const Near &near, CutEdge edge, int halvings) {
  const auto near_edge = [&] {
    return near(edge.middle(), 0.51f * square_root(length_squared(edge.outside - edge.inside)) + 1e-3f);
  };
  auto candidates = near_edge();
  if (f.parameters.has_thin_walls() && !is_inside(f, candidates, edge.inside)) {
    edge.inside = find_solid(f, near, edge.inside);
    candidates = near_edge();
  }
  for (int k = 0; k < halvings; ++k)
    (is_inside(f, candidates, edge.middle()) ? edge.inside : edge.outside) = edge.middle();
  return edge.middle();
}
// So many points are looked at for it.
inline uint64_t looks_for_sign_change(const SurfaceParameters &p, int halvings) {
  return static_cast<uint64_t>(halvings + 4 + most_solid_looks(p));
}

template <class Near>
QSES_FN SurfacePoint place_on_edge(const FeatureView &f, const Near &near, const CutEdge &edge) {
  const SurfaceParameters &p = f.parameters;
  const Vec3<float> x = find_sign_change(f, near, edge, kPlaceHalvings);
  SurfacePoint s = place_on_surface(p, x, nearest_boundary(f, near(x, 0.5f * p.spacing), x));
  const float far_out = maximum(maximum(absolute(x.x), absolute(x.y)), absolute(x.z));
  const float tolerance = 1e-3f * p.spacing + 4e-7f * far_out;  // of the halving, and of float32 there
  s.placed = s.placed && length_squared(s.position - x) <= tolerance * tolerance;
  // Without a feature there the sign changes all the same, so that is where the vertex stays.
  if (!s.placed) s.position = x, s.patch = QSES_PATCH_CONTACT;  // whatever is near
  return s;
}

}  // namespace quickses
