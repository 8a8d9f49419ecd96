// SPDX-License-Identifier: MIT
// The sheets of the solvent-excluded surface, as creases see them (creases.h): the spheres of probes. A vertex knows
// where the probes are that touch it: on its normals, a probe radius away. Creases are where two probes meet: edges
// that cross one are found by how far they are from both spheres, and a point on it by projection.
#pragma once

#include "surface/stages/creases.h"
#include "surface/stages/local_features.h"
#include "surface/stages/point_projection.h"

namespace quickses {

// Sheets whose normals have a smaller cosine than this meet in a crease, if the edge between them leaves both probes by
// more than this, in spacings.
constexpr float kCreaseCosine = 0.7f;
constexpr float kLeastDeviation = 0.06f;
// A new vertex is at least this far from its edge, in spacings.
constexpr float kLeastMove = 0.04f;
// And not farther from it than this, in lengths of the edge.
constexpr float kFarthestProbePart = 1.f;
// Projected again, a point of the surface stays where it is. Å.
constexpr float kSteadyMove = 5e-4f;

struct ProbeSheets {
  static constexpr bool kGathers = true;       // needs the features near a place
  static constexpr bool kHasCorners = false;   // creases of probes end smoothly
  static constexpr float kFlatCosine = 0.99f;  // 8 degrees
  FeatureView features;
  Lattice lattice;

  // Has a triangle to do with creases?
  QSES_FN bool is_near_crease(const CreasedMesh &mesh, const uint32_t *t, bool along) const {
    Vec3<float> n[3];
    int creases = 0;
    for (int k = 0; k < 3; ++k) {
      n[k] = load_vec3(mesh.normal(t[k]));
      creases += mesh.on_crease(t[k]) ? 1 : 0;
    }
    if (creases > 1 && along) return true;
    return creases > 0 || minimum(dot(n[0], n[1]), minimum(dot(n[1], n[2]), dot(n[2], n[0]))) <= kCreaseCosine;
  }

  QSES_FN bool may_cross(const CreasedMesh &mesh, uint32_t u, uint32_t v) const {
    if (!mesh.on_crease(u) && !mesh.on_crease(v) &&
        dot(load_vec3(mesh.normal(u)), load_vec3(mesh.normal(v))) > kCreaseCosine)
      return false;  // as find_crossing() says, without the places
    Crossing c{};
    return find_crossing(end_of_vertex(mesh, lattice, u), end_of_vertex(mesh, lattice, v), &c);
  }

  template <class Local>
  QSES_FN CreasePoint solve(Local &local, const CreaseEnd &u, const CreaseEnd &v, bool along) const {
    Crossing c{};
    if (find_crossing(u, v, &c)) return solve_crossing(local, u, v, c);
    if (along && u.on_crease() && v.on_crease()) return solve_along(local, u, v);
    return none();
  }

  QSES_FN CreasePoint solve_corner(const uint32_t *, const Vec3<float> &, float) const { return none(); }

  // Is a piece of a triangle turned away from all sheets at a corner, or has it no area?
  QSES_FN bool is_folded(const CreaseEnd *const *corners, const Vec3<float> &normal) const {
    const float length2 = length_squared(normal);
    if (!(length2 > 0.f)) return true;
    for (int k = 0; k < 3; ++k) {
      const float most = maximum(dot(normal, corners[k]->normal), dot(normal, corners[k]->second_normal));
      if (!(most > 0.f)) return true;
    }
    return false;
  }

 private:
  // Two probes, one at each end of an edge, and where the edge is as far from one as from the other.
  struct Crossing {
    Vec3<float> first, second;  // their centres
    Vec3<float> under;
  };

  QSES_FN static CreasePoint none() {
    CreasePoint p{};
    p.kind = CreasePoint::kNone;
    return p;
  }

  QSES_FN Vec3<float> probe(const CreaseEnd &end, bool second) const {
    return end.position + (second ? end.second_normal : end.normal) * features.parameters.depth;
  }

  QSES_FN bool find_crossing(const CreaseEnd &u, const CreaseEnd &v, Crossing *c) const {
    // The pair of probes that are closest together: an edge that ends on a crease stays on one of its sheets.
    float least2 = kFarAway, cosine = 1.f;
    for (int k = 0; k < 4; ++k) {
      if ((k & 1 && !u.on_crease()) || (k & 2 && !v.on_crease())) continue;
      const Vec3<float> a = probe(u, (k & 1) != 0), b = probe(v, (k & 2) != 0);
      const float d2 = length_squared(b - a);
      if (d2 >= least2) continue;
      least2 = d2;
      c->first = a;
      c->second = b;
      cosine = dot(k & 1 ? u.second_normal : u.normal, k & 2 ? v.second_normal : v.normal);
    }
    if (cosine > kCreaseCosine) return false;
    const float p = features.parameters.depth;
    const Vec3<float> between = c->second - c->first, edge = v.position - u.position;
    const float along = dot(edge, between);
    if (!(along > 1e-6f)) return false;
    const float part = quotient(dot((c->first + c->second) * 0.5f - u.position, between), along);
    c->under = u.position + edge * minimum(1.f, maximum(0.f, part));
    const float deviation = absolute(square_root(length_squared(c->under - c->first)) - p);
    return deviation >= kLeastDeviation * lattice.spacing;
  }

  template <class Local>
  QSES_FN CreasePoint describe(const Local &local, const SurfacePoint &s, const CreaseEnd &u, const CreaseEnd &v,
                               CreasePoint::Kind kind) const {
    CreasePoint p{};
    p.position = s.position;
    p.normal = s.normal;
    p.second_normal = s.second_normal;
    p.owner = p.second_owner = features.atoms.order[nearest_atom(features, local, s.position)];
    p.patch = s.patch;
    p.kind = kind;
    p.to_first = square_root(length_squared(s.position - u.position));
    p.to_second = square_root(length_squared(s.position - v.position));
    p.first_fits = !u.on_crease();
    p.second_fits = !v.on_crease();
    return p;
  }

  template <class Local>
  QSES_FN bool is_steady(const Local &local, const SurfacePoint &s) const {
    const SurfacePoint again = project_point(features, local, s.position);
    return again.placed && length_squared(again.position - s.position) <= kSteadyMove * kSteadyMove;
  }

  template <class Local>
  QSES_FN CreasePoint solve_crossing(Local &local, const CreaseEnd &u, const CreaseEnd &v, const Crossing &c) const {
    constexpr int kRounds = 3;
    const float p = features.parameters.depth, length = square_root(length_squared(v.position - u.position));
    const Vec3<float> between = c.second - c.first, middle = (c.first + c.second) * 0.5f, up = middle - c.under;
    const float height2 = p * p - 0.25f * length_squared(between), up2 = length_squared(up);
    const float longest = kFarthestProbePart * length;
    if (!local.gather(features, c.under, longest + 0.1f)) return none();
    const Vec3<float> way = up2 > 1e-6f ? up * reciprocal_root(up2) : Vec3<float>(0.f, 0.f, 0.f);
    Vec3<float> x = c.under;
    if (height2 > 0.f && up2 > 1e-6f) {
      const Vec3<float> move = middle - way * square_root(height2) - c.under;
      const float moved = square_root(length_squared(move));
      x = c.under + move * minimum(1.f, quotient(longest, maximum(moved, 1e-9f)));
    }
    // Along the way from the middle between the probes until the point is its own projection.
    SurfacePoint s{};
    for (int round = 0;; ++round) {
      s = project_point(features, local, x);
      if (!s.placed) return none();
      const float off = square_root(length_squared(s.position - x));
      if (off < 2e-3f || s.is_crest()) break;
      if (round == kRounds) {
        if (off > 0.05f) return none();
        break;
      }
      const float step = quotient(dot(s.position - x, s.normal), maximum(0.25f, absolute(dot(s.normal, way))));
      x = x + way * minimum(0.4f, maximum(-0.4f, dot(s.normal, way) < 0.f ? -step : step));
      if (length_squared(x - c.under) > longest * longest) return none();
    }
    const float least = kLeastMove * lattice.spacing;
    if (length_squared(s.position - c.under) < least * least) return none();
    if (!s.is_crest()) {
      if (!is_steady(local, s)) return none();
      const float to_first = square_root(length_squared(c.first - s.position)),
                  to_second = square_root(length_squared(c.second - s.position));
      if (absolute(to_first - p) < 0.02f && absolute(to_second - p) < 0.02f) {
        s.normal = (c.first - s.position) * quotient(1.f, to_first);
        s.second_normal = (c.second - s.position) * quotient(1.f, to_second);
      } else {  // a ridge that bends sharply, or another probe in between
        const SurfacePoint first = project_point(features, local, s.position + (u.position - s.position) * 0.1f),
                           second = project_point(features, local, s.position + (v.position - s.position) * 0.1f);
        if (first.placed && second.placed) {
          s.normal = first.normal;
          s.second_normal = second.normal;
        }
      }
    }
    const CreasePoint found = describe(local, s, u, v, CreasePoint::kCrossed);
    return minimum(found.to_first, found.to_second) > longest ? none() : found;
  }

  template <class Local>
  QSES_FN CreasePoint solve_along(Local &local, const CreaseEnd &u, const CreaseEnd &v) const {
    const float p = features.parameters.depth, length = square_root(length_squared(v.position - u.position));
    if (length < 0.3f * lattice.spacing) return none();
    const Vec3<float> u1 = probe(u, false), u2 = probe(u, true), v1 = probe(v, false), v2 = probe(v, true);
    const float straight = maximum(length_squared(v1 - u1), length_squared(v2 - u2)),
                crossed = maximum(length_squared(v2 - u1), length_squared(v1 - u2));
    const float widest = maximum(length, 0.3f);
    if (minimum(straight, crossed) > widest * widest) return none();  // another crease
    const Vec3<float> first = (u1 + (straight <= crossed ? v1 : v2)) * 0.5f,
                      second = (u2 + (straight <= crossed ? v2 : v1)) * 0.5f;
    const Vec3<float> between = second - first, middle = (u.position + v.position) * 0.5f;
    const float between2 = length_squared(between);
    Vec3<float> x = middle;
    if (between2 > 0.01f && between2 < 4.f * p * p) {
      const Vec3<float> center = (first + second) * 0.5f, from = middle - center;
      const Vec3<float> off = from - between * quotient(dot(from, between), between2);
      const float off2 = length_squared(off);
      if (off2 > 1e-6f) x = center + off * (square_root(p * p - 0.25f * between2) * reciprocal_root(off2));
      // Where the edge is as good as on the crease of the two there is nothing to be found.
      const float away = square_root(length_squared(x - middle));
      if (away < 0.7f * kLeastSagitta * lattice.spacing) return none();
      if (away > 0.5f * length) x = middle;
    }
    if (!local.gather(features, x, 0.7f * length + 0.1f)) return none();
    const SurfacePoint s = project_point(features, local, x);
    const float off = square_root(length_squared(s.position - middle)), least = kLeastSagitta * lattice.spacing;
    if (!s.placed || off < least || off > 0.6f * length) return none();
    if (!s.is_crest() && !is_steady(local, s)) return none();
    SurfacePoint crest = s;
    if (!s.is_crest()) {
      crest.normal = direction(s.position, first);
      crest.second_normal = direction(s.position, second);
    }
    const CreasePoint found = describe(local, crest, u, v, CreasePoint::kAlong);
    return minimum(found.to_first, found.to_second) < 0.25f * length ? none() : found;
  }
};

}  // namespace quickses
