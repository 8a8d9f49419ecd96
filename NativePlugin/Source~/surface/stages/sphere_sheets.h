// SPDX-License-Identifier: MIT
// The sheets of the surfaces of balls (SAS and VDW), as creases see them (creases.h): the spheres of atoms. A crease is
// the circle of two of them, a corner the point of three. Everything here is about one edge or one triangle of a mesh
// whose vertices lie on the spheres; what is found is exact.
#pragma once

#include "parallel/atomics.h"
#include "surface/stages/creases.h"
#include "surface/stages/near_balls.h"
#include "surface/stages/projection.h"

namespace quickses {

// A vertex lies on a sheet that is nearer than this, Å, and besides what float32 leaves of its coordinates.
constexpr float kSheetTolerance = 1e-4f;
// No piece of a triangle may be turned away from its sheet further than to this cosine.
constexpr float kLeastTurn = 0.3f;

// ---- circles and corners of spheres ----------------------------------------------------------------------------

struct SphereCircle {
  Vec3<float> center, axis;
  float radius;  // 0: they do not meet
};

QSES_FN SphereCircle circle_of_spheres(const Sphere &a, const Sphere &b) {
  const Vec3<float> between = Vec3<float>(b.center) - Vec3<float>(a.center);
  const float distance2 = length_squared(between);
  if (!share_circle(a.radius, b.radius, distance2)) return {Vec3<float>(a.center), {0.f, 0.f, 1.f}, 0.f};
  const float inverse = reciprocal_root(distance2);
  const float along = 0.5f * (distance2 + (a.radius - b.radius) * (a.radius + b.radius)) * inverse;
  const Vec3<float> axis = between * inverse;
  return {Vec3<float>(a.center) + axis * along, axis,
          square_root(maximum(0.f, (a.radius - along) * (a.radius + along)))};
}

// The point of the circle that is nearest to x; false on its axis, where all are.
QSES_FN bool nearest_on_circle(const SphereCircle &circle, const Vec3<float> &x, Vec3<float> *nearest) {
  const Vec3<float> d = x - circle.center, in_plane = d - circle.axis * dot(d, circle.axis);
  const float length2 = length_squared(in_plane);
  if (circle.radius <= 0.f || length2 <= 1e-6f * circle.radius * circle.radius) return false;
  *nearest = circle.center + in_plane * (circle.radius * reciprocal_root(length2));
  return true;
}

// The point of the circle on a third sphere that is nearest to x; false if they do not meet.
QSES_FN bool nearest_corner(const SphereCircle &circle, const Sphere &third, const Vec3<float> &x,
                            Vec3<float> *nearest) {
  const Vec3<float> g = Vec3<float>(third.center) - circle.center, flat = g - circle.axis * dot(g, circle.axis);
  const float flat2 = length_squared(flat);
  if (circle.radius <= 0.f || flat2 <= 1e-8f) return false;
  const float inverse = reciprocal_root(flat2);
  const float cosine = (circle.radius * circle.radius + length_squared(g) - third.radius * third.radius) * 0.5f *
                       quotient(inverse, circle.radius);
  if (!(absolute(cosine) < 1.f)) return false;
  const Vec3<float> towards = flat * inverse, aside = cross(circle.axis, towards);
  const float sine = square_root((1.f - cosine) * (1.f + cosine));
  const float side = dot(x - circle.center, aside) < 0.f ? -sine : sine;
  *nearest = circle.center + (towards * cosine + aside * side) * circle.radius;
  return true;
}

// ---- the sheets of SAS and VDW ---------------------------------------------------------------------------------

// The atoms whose spheres come near an edge. Where there are more, as near most edges of 2 Å, it stays as it is.
struct NearSpheres {
  static constexpr int kMost = 24;
  static constexpr uint32_t kMostMet = 1 << 14;
  uint32_t place[kMost];
  int count = 0;
  bool crowded = false;
};

struct SphereSheets {
  static constexpr bool kGathers = false;  // needs the features near a place
  static constexpr bool kHasCorners = true;
  // Of the smallest angle that a piece of a triangle may have: 2.6 degrees. In deep grooves pieces are slim.
  static constexpr float kFlatCosine = 0.999f;
  FeatureView features;
  const uint32_t *places;  // caller's number of an atom -> its place in the grid
  Lattice lattice;
  float tolerance;

  QSES_FN Sphere sphere_of(uint32_t owner) const { return sphere(places[owner]); }
  QSES_FN Sphere sphere(uint32_t place) const { return load(features.atoms.items + place); }

  QSES_FN bool is_on(const Sphere &ball, const Vec3<float> &x) const {
    return absolute(ball_depth(ball, x)) <= tolerance;
  }

  // Has a triangle to do with creases?
  QSES_FN bool is_near_crease(const CreasedMesh &mesh, const uint32_t *t, bool along) const {
    const uint32_t owner = mesh.owner(t[0]);
    if (owner != mesh.owner(t[1]) || owner != mesh.owner(t[2])) return true;
    return along && int(mesh.on_crease(t[0])) + int(mesh.on_crease(t[1])) + int(mesh.on_crease(t[2])) > 1;
  }

  // May an edge cross a crease? At a glance; solve() decides.
  QSES_FN bool may_cross(const CreasedMesh &mesh, uint32_t u, uint32_t v) const {
    const uint32_t of_u = mesh.owner(u), of_v = mesh.owner(v);
    return of_u != of_v && !is_on(sphere_of(of_v), lattice.from_caller(mesh.position(u))) &&
           !is_on(sphere_of(of_u), lattice.from_caller(mesh.position(v)));
  }

  // Is a piece of a triangle turned away from the sheet that its corners have in common, or has it no area? normal:
  // outward, of any length. Where there is no such sheet, another one comes between, and only a piece that is turned
  // away from all three corners together is folded.
  QSES_FN bool is_folded(const CreaseEnd *const *corners, const Vec3<float> &normal) const {
    const float length2 = length_squared(normal);
    if (!(length2 > 0.f)) return true;
    const Vec3<float> middle = (corners[0]->position + corners[1]->position + corners[2]->position) * (1.f / 3.f);
    bool shared = false;
    for (int k = 0; k < 6; ++k) {
      const CreaseEnd &corner = *corners[k / 2], &next = *corners[(k / 2 + 1) % 3], &last = *corners[(k / 2 + 2) % 3];
      if (k % 2 == 1 && corner.second_owner == corner.owner) continue;
      const uint32_t owner = k % 2 ? corner.second_owner : corner.owner;
      const Sphere ball = sphere_of(owner);
      if (!(next.is_of(owner) || is_on(ball, next.position)) || !(last.is_of(owner) || is_on(ball, last.position)))
        continue;
      if (dot(normal, middle - Vec3<float>(ball.center)) > kLeastTurn * square_root(length2) * ball.radius)
        return false;
      shared = true;
    }
    if (shared) return true;
    Vec3<float> outward(0.f, 0.f, 0.f);
    for (int k = 0; k < 3; ++k) outward = outward + corners[k]->normal + corners[k]->second_normal;
    return !(dot(normal, outward) > 0.f);
  }

  // Describes a point on the spheres a and b (places).
  QSES_FN CreasePoint point_on(uint32_t a, uint32_t b, const Vec3<float> &x, CreasePoint::Kind kind) const {
    const uint32_t first = features.atoms.order[a] < features.atoms.order[b] ? a : b, second = first == a ? b : a;
    CreasePoint p{};
    p.position = x;
    p.normal = sphere_normal(sphere(first), x);
    p.second_normal = sphere_normal(sphere(second), x);
    p.owner = features.atoms.order[first];
    p.second_owner = features.atoms.order[second];
    p.patch = QSES_PATCH_TOROIDAL;
    p.kind = dot(p.normal, p.second_normal) > kSmoothCosine ? CreasePoint::kNone : kind;
    return p;
  }

  // Where the edge should have a vertex.
  template <class Local>
  QSES_FN CreasePoint solve(Local &, const CreaseEnd &u, const CreaseEnd &v, bool along) const {
    const uint32_t on_u[2] = {places[u.owner], places[u.second_owner]},
                   on_v[2] = {places[v.owner], places[v.second_owner]};
    uint32_t shared[4];
    int sharing = 0;
    const auto share = [&](uint32_t place) {
      for (int k = 0; k < sharing; ++k)
        if (shared[k] == place) return;
      shared[sharing++] = place;
    };
    for (int k = 0; k < 2; ++k)
      if (is_on(sphere(on_u[k]), v.position)) share(on_u[k]);
    for (int k = 0; k < 2; ++k)
      if (is_on(sphere(on_v[k]), u.position)) share(on_v[k]);
    if (sharing > 1 && along) return solve_along(u, v, shared[0], shared[1]);
    if (sharing > 0) return none();

    // The crease of two of the sheets that the ends lie on. Where another sphere covers it, or there is none, another
    // sheet comes between: then its crease with one of those of the ends.
    CreasePoint best = none();
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        if ((i == 1 && on_u[1] == on_u[0]) || (j == 1 && on_v[1] == on_v[0])) continue;
        const CreasePoint p = cross_over(u, v, on_u[i], on_v[j]);
        if (is_nearer(p, best) && !is_covered(on_u[i], p.position)) best = p;
      }
    if (best.kind != CreasePoint::kNone) return best;
    const float length = square_root(length_squared(v.position - u.position));
    const NearSpheres list = near((u.position + v.position) * 0.5f, 2.f * length + tolerance);
    if (list.crowded) return none();
    for (int i = 0; i < 4; ++i) {
      const uint32_t place = i < 2 ? on_u[i] : on_v[i - 2];
      for (int k = 0; k < list.count; ++k) {
        const CreasePoint p = cross_over(u, v, place, list.place[k]);
        if (is_nearer(p, best) && !is_covered(list, p.position)) best = p;
      }
    }
    return best;
  }

  // The corner where the creases of sheets a b, b c and c a meet that three points lie on; size: of the triangle that
  // it should be in.
  QSES_FN CreasePoint solve_corner(const uint32_t *owners, const Vec3<float> &middle, float size) const {
    const uint32_t a = places[owners[0]], b = places[owners[1]], c = places[owners[2]];
    Vec3<float> x;
    if (!nearest_corner(circle_of_spheres(sphere(a), sphere(b)), sphere(c), middle, &x)) return none();
    if (length_squared(x - middle) > size * size || is_covered(a, x)) return none();
    return point_on(a, b, x, CreasePoint::kCrossed);
  }

 private:
  QSES_FN static CreasePoint none() {
    CreasePoint p{};
    p.kind = CreasePoint::kNone;
    return p;
  }

  // crowded: where all is covered, too, which is no place on the surface.
  QSES_FN NearSpheres near(const Vec3<float> &x, float reach) const {
    NearSpheres near;
    near.crowded =
        !for_balls_near(features, x, x, reach, NearSpheres::kMostMet, [&](uint32_t place, const Sphere &ball) {
          const float d2 = length_squared(x - Vec3<float>(ball.center)), longest = ball.radius + reach;
          const float shortest = maximum(0.f, ball.radius - reach);
          if (d2 > longest * longest) return true;
          if (d2 < shortest * shortest || near.count == NearSpheres::kMost) return false;
          near.place[near.count++] = place;
          return true;
        });
    return near;
  }

  // What is found here was never rounded to the caller's coordinates, as vertices were.
  QSES_FN static float cover_tolerance(const Vec3<float> &x) {
    return kSheetTolerance + 1.2e-7f * maximum(absolute(x.x), maximum(absolute(x.y), absolute(x.z)));
  }
  QSES_FN bool is_covered(const NearSpheres &near, const Vec3<float> &x) const {
    const float most = cover_tolerance(x);
    for (int k = 0; k < near.count; ++k)
      if (ball_depth(sphere(near.place[k]), x) > most) return true;
    return false;
  }
  // The same of a point on the sphere of an atom, from its caps.
  QSES_FN bool is_covered(uint32_t place, const Vec3<float> &x) const {
    const CapRange range = features.cap_ranges[place];
    if (range.count == kBuriedAtom) return true;
    const Sphere ball = sphere(place);
    const Vec3<float> d = x - Vec3<float>(ball.center);
    const float most = cover_tolerance(x) + kExposureTolerance;
    for (int32_t k = 0; k < range.count; ++k) {
      const Cap cap = load(features.caps + range.first + k);
      if (dot(d, Vec3<float>(cap.axis)) - cap.cosine * ball.radius > most) return true;
    }
    return false;
  }

  // The place of the crease of two spheres where the edge passes over it, if it does.
  QSES_FN CreasePoint cross_over(const CreaseEnd &u, const CreaseEnd &v, uint32_t a, uint32_t b) const {
    const SphereCircle circle = circle_of_spheres(sphere(a), sphere(b));
    if (a == b || circle.radius <= 0.f) return none();
    // In the plane of the circle the chord is as deep in the one as in the other ball.
    const Vec3<float> edge = v.position - u.position;
    const float from = dot(circle.center - u.position, circle.axis), whole = dot(edge, circle.axis);
    const float part = quotient(from, absolute(whole) > 1e-9f ? whole : 1e-9f);
    if (!(part > 0.f && part < 1.f)) return none();
    const Vec3<float> under = u.position + edge * part;
    Vec3<float> x;
    if (!nearest_on_circle(circle, under, &x)) return none();
    CreasePoint p = point_on(a, b, x, CreasePoint::kCrossed);
    p.off2 = length_squared(x - under);
    if (!(p.off2 < kFarthestPart * kFarthestPart * length_squared(edge))) return none();
    set_ends(u, v, &p);
    p.first_fits = is_of(u, a, b);
    p.second_fits = is_of(v, a, b);
    return p;
  }
  QSES_FN static bool is_nearer(const CreasePoint &p, const CreasePoint &than) {
    return p.kind != CreasePoint::kNone && (than.kind == CreasePoint::kNone || p.off2 < than.off2);
  }
  QSES_FN bool is_of(const CreaseEnd &end, uint32_t a, uint32_t b) const {
    const uint32_t first = places[end.owner], second = places[end.second_owner];
    return (first == a || first == b) && (second == a || second == b);
  }

  QSES_FN CreasePoint solve_along(const CreaseEnd &u, const CreaseEnd &v, uint32_t a, uint32_t b) const {
    const Vec3<float> middle = (u.position + v.position) * 0.5f;
    Vec3<float> x;
    if (!nearest_on_circle(circle_of_spheres(sphere(a), sphere(b)), middle, &x)) return none();
    const float off2 = length_squared(x - middle), least = kLeastSagitta * lattice.spacing;
    if (off2 < least * least || off2 > 0.25f * length_squared(v.position - u.position) || is_covered(a, x))
      return none();
    CreasePoint p = point_on(a, b, x, CreasePoint::kAlong);
    set_ends(u, v, &p);
    return p;
  }

  QSES_FN static void set_ends(const CreaseEnd &u, const CreaseEnd &v, CreasePoint *p) {
    p->to_first = square_root(length_squared(p->position - u.position));
    p->to_second = square_root(length_squared(p->position - v.position));
  }
};

// ---- vertices that are on a circle from the beginning ----------------------------------------------------------

// A vertex may have been projected onto a circle: then it is on the sphere of a neighbour's atom besides its own. Of
// several such atoms that with the smallest number counts.
struct FindSecondOwners {
  CreasedMesh mesh;
  SphereSheets sheets;
  QSES_FN void operator()(size_t i) const {
    const uint32_t *const t = mesh.triangle(i);
    const uint32_t owners[3] = {mesh.owner(t[0]), mesh.owner(t[1]), mesh.owner(t[2])};
    if (owners[0] == owners[1] && owners[0] == owners[2]) return;
    for (int k = 0; k < 3; ++k)
      for (const int other : {next_corner(k), k == 0 ? 2 : k - 1})
        if (owners[other] != owners[k] &&
            sheets.is_on(sheets.sphere_of(owners[other]), sheets.lattice.from_caller(mesh.position(t[k]))))
          atomic_min(mesh.second_owners + t[k], owners[other]);
  }
};
struct MarkCircleVertices {
  CreasedMesh mesh;
  SphereSheets sheets;
  QSES_FN void operator()(size_t i) const {
    const uint32_t v = static_cast<uint32_t>(i), second = mesh.second_owners[v];
    if (second == kNoNumber || mesh.on_crease(v)) return;
    const CreasePoint p = sheets.point_on(sheets.places[mesh.owner(v)], sheets.places[second],
                                          sheets.lattice.from_caller(mesh.position(v)), CreasePoint::kCrossed);
    if (p.kind != CreasePoint::kNone) mark_on_crease(mesh, v, p);
  }
};

}  // namespace quickses
