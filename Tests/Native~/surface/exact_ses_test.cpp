// SPDX-License-Identifier: MIT
// The exact surfaces against closed forms for one, two and three atoms, and against brute-force samples of the
// solvent-accessible surface.
#include "surface/surface_checks.h"

namespace {

using namespace surface_checks;
using exact_reference::cross;
using exact_reference::dot;
using exact_reference::length;

constexpr double kPi = 3.14159265358979323846;

// ---- one atom

// Every triangle of an inscribed mesh lies between the sphere and its own plane, and a triangle of a cell of spacing h
// is at most h²/(2r) deep. So area and volume lie between those of the two balls.
void check_sphere(const Surface &surface, const Point &center, double radius, double spacing) {
  const mesh_checks::Mesh &mesh = surface.mesh;
  check_connection(mesh);
  for (size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Point d = point(mesh.position(v)) - center;
    ASSERT_NEAR(length(d), radius, 2e-6 + 1e-6 * radius);
    ASSERT_LT(length((1 / radius) * d - point(surface.normal(v))), 5e-6);
    ASSERT_EQ(mesh.owners[v], 0u);
  }
  double innermost = radius;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Point a = point(mesh.position(mesh.indices[3 * t])) - center;
    const Point b = point(mesh.position(mesh.indices[3 * t + 1])) - center;
    const Point c = point(mesh.position(mesh.indices[3 * t + 2])) - center;
    const Point n = cross(b - a, c - a);
    if (length(n) > 1e-9) innermost = std::min(innermost, dot(n, a) / length(n));
  }
  EXPECT_GT(innermost, radius - spacing * spacing / (2 * radius));
  const double area = 4 * kPi * radius * radius, volume = area * radius / 3;
  const double share = innermost / radius;
  EXPECT_LE(surface.report.triangle_area, area * (1 + 1e-6));
  EXPECT_GE(surface.report.triangle_area, area * share * share * (1 - 1e-6));
  EXPECT_LE(surface.report.triangle_volume, volume * (1 + 1e-6));
  EXPECT_GE(surface.report.triangle_volume, volume * share * share * share * (1 - 1e-6));
  check_report(surface);
  EXPECT_EQ(mesh_checks::piece_count(mesh), 1u);
}

TEST(OneAtom, IsASphere) {
  for (double h : {0.1, 0.25, 0.5, 0.7, 1.0})
    for (double r : {1.2, 1.7, 3.0}) {
      SCOPED_TRACE(testing::Message() << "spacing " << h << " radius " << r);
      Atoms atoms;
      atoms.add(0.31, -0.17, 0.23, r);
      const Point center = point(atoms.center(0));
      const double radius = static_cast<double>(atoms.radii[0]);
      check_sphere(compute(atoms, settings(h)), center, radius, h);
      check_sphere(compute(atoms, settings(h, 0.0)), center, radius, h);
      check_sphere(compute(atoms, settings(h, 1.4, QSES_SURFACE_VDW)), center, radius, h);
      check_sphere(compute(atoms, settings(h, 1.4, QSES_SURFACE_SAS)), center, radius + static_cast<double>(1.4f), h);
    }
}

TEST(OneAtom, OnALatticePoint) {
  Atoms atoms;
  atoms.add(0, 0, 0, 1.5);  // the sphere passes through lattice points
  for (double h : {0.25, 0.5, 0.75}) check_sphere(compute(atoms, settings(h)), {0, 0, 0}, 1.5, h);
}

TEST(OneAtom, SmallerThanACellHasNoSurfaceOrAClosedOne) {
  Atoms atoms;
  atoms.add(0.5, 0.5, 0.5, 0.3);
  EXPECT_EQ(compute(atoms, settings(2.0, 0.0)).vertex_count(), 0u);  // no lattice point inside
  atoms.add(4.0, 4.0, 4.0, 0.3);
  const Surface one = compute(atoms, settings(2.0, 0.0));
  EXPECT_EQ(one.vertex_count(), 6u);  // one lattice point inside: an octahedron
  check_connection(one.mesh);
}

// ---- two atoms: in the half plane of distance along and from the axis everything is a curve

struct Pair {
  Point first, axis;
  double distance, r1, r2;
};

// Vertices of a contact patch lie on their atom; those of the saddle at p from the circle on which the probe rolls.
void check_pair(const Surface &surface, const Pair &pair, double probe) {
  const double a = pair.r1 + probe, b = pair.r2 + probe, d = pair.distance;
  const double z = (d * d + a * a - b * b) / (2 * d), q = std::sqrt(a * a - z * z);
  size_t contact = 0, saddle = 0;
  for (size_t v = 0; v < surface.vertex_count(); ++v) {
    const Point x = point(surface.mesh.position(v)) - pair.first;
    const double along = dot(x, pair.axis), from = length(x - along * pair.axis);
    // The cones from the atoms' centres through the circle bound the saddle: positive inside both.
    const double of_first = along * q - from * z, of_second = (d - along) * q - from * (d - z);
    if (std::min(of_first, of_second) > 0.01) {
      ASSERT_NEAR(std::hypot(along - z, from - q), probe, 1e-5);
      ASSERT_EQ(surface.patches[v], QSES_PATCH_TOROIDAL);
      ++saddle;
    } else if (std::min(of_first, of_second) < -0.01) {
      const bool second = of_second < of_first;
      ASSERT_NEAR(second ? std::hypot(d - along, from) : std::hypot(along, from), second ? pair.r2 : pair.r1, 1e-5);
      ASSERT_EQ(surface.patches[v], QSES_PATCH_CONTACT);
      ASSERT_EQ(surface.mesh.owners[v], second ? 1u : 0u);
      ++contact;
    }
  }
  EXPECT_GT(contact, 100u);
  EXPECT_GT(saddle, 50u);
}

TEST(TwoAtoms, HaveATorusBetweenThem) {
  for (double distance : {1.5, 2.6, 3.9})
    for (bool turn : {false, true}) {
      SCOPED_TRACE(testing::Message() << distance << " Å" << (turn ? ", turned" : ""));
      Atoms atoms;
      atoms.add(0, 0, 0, 1.7).add(distance, 0, 0, 1.4);
      if (turn) atoms = turned(atoms, 3.3, -7.1, 2.2);
      qses_settings s = settings(0.3);
      s.patch_types = 1;
      const Surface surface = checked_surface(atoms, s, {1e-4, 1e-3});
      const Point between = point(atoms.center(1)) - point(atoms.center(0));
      const double d = length(between);
      check_pair(surface,
                 {point(atoms.center(0)), (1 / d) * between, d, static_cast<double>(atoms.radii[0]),
                  static_cast<double>(atoms.radii[1])},
                 static_cast<double>(1.4f));
      EXPECT_EQ(mesh_checks::piece_count(surface.mesh), 1u);
    }
}

// The other two surfaces: vertices at r + p, or at r, of the nearest atom.
TEST(TwoAtoms, UnionsOfBalls) {
  Atoms atoms;
  atoms.add(0, 0, 0, 1.7).add(2.6, 0.3, -0.2, 1.4);
  for (qses_surface kind : {QSES_SURFACE_SAS, QSES_SURFACE_VDW})
    for (double h : {0.2, 0.5, 1.0}) {
      SCOPED_TRACE(testing::Message() << "surface " << kind << " spacing " << h);
      checked_surface(atoms, settings(h, 1.4, kind), {1e-4, 2e-3});
    }
}

// Do the triangles lead from a vertex of atom 0 to one of atom 1?
bool some_piece_has_both(const mesh_checks::Mesh &mesh) {
  std::vector<uint8_t> reached(mesh.vertex_count());
  for (size_t v = 0; v < reached.size(); ++v) reached[v] = mesh.owners[v] == 0;
  for (bool more = true; more;) {
    more = false;
    for (size_t t = 0; t < mesh.triangle_count(); ++t) {
      const uint32_t *k = &mesh.indices[3 * t];
      const int n = reached[k[0]] + reached[k[1]] + reached[k[2]];
      if (n == 0 || n == 3) continue;
      reached[k[0]] = reached[k[1]] = reached[k[2]] = 1;
      more = true;
    }
  }
  for (size_t v = 0; v < reached.size(); ++v)
    if (reached[v] && mesh.owners[v] == 1) return true;
  return false;
}

// The probe passes between the atoms although their inflated spheres meet: the circle is narrower than the probe.
TEST(TwoAtoms, ApartEnoughAreTwoPieces) {
  const double s = std::sqrt(1.0 / 3);
  const double axes[][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {s, s, s}, {0.6, 0.8, 0}, {-s, s, s}};
  for (const auto &axis : axes)
    for (double shift : {0.0, 0.25, 0.1})
      for (double h : {0.5, 0.25, 0.7}) {
        SCOPED_TRACE(testing::Message() << axis[0] << " " << axis[1] << " " << axis[2] << " shifted " << shift
                                        << " spacing " << h);
        Atoms atoms;
        atoms.add(shift, shift, shift, 1.7)
            .add(shift + 5.8 * axis[0], shift + 5.8 * axis[1], shift + 5.8 * axis[2], 1.7);
        const Surface surface = checked_surface(atoms, settings(h));
        // (Along a diagonal, the lattice point next to the tip of an atom's piece may be a piece of its own.)
        if (axis[0] + axis[1] + axis[2] == 1) {
          EXPECT_EQ(mesh_checks::piece_count(surface.mesh), 2u);
        }
        EXPECT_FALSE(some_piece_has_both(surface.mesh));
      }
}

// ---- three atoms: the probe rests on them at two places, where it leaves two concave triangles

TEST(ThreeAtoms, HaveConcaveTriangles) {
  const double p = static_cast<double>(1.4f);
  for (bool turn : {false, true}) {
    Atoms atoms;
    atoms.add(0, 0, 0, 1.7).add(2.9, 0, 0, 1.55).add(1.2, 2.7, 0.2, 1.8);
    if (turn) atoms = turned(atoms, -11.2, 5.5, 40.4);
    qses_settings s = settings(0.25);
    s.patch_types = 1;
    const Surface surface = checked_surface(atoms, s, {1e-4, 1e-3});
    const Boundary boundary(atoms, p);
    ASSERT_EQ(boundary.triple_points().size(), 2u);
    size_t concave = 0, others = 0;
    for (size_t v = 0; v < surface.vertex_count(); ++v) {
      const Point x = point(surface.mesh.position(v));
      // Inside the cone that the probe at rest spans with the three atoms? Signs against its three side planes.
      bool clearly_in = false, clearly_out = true;
      Point rest{};
      for (const auto &t : boundary.triple_points()) {
        const Point d[3] = {boundary.balls()[0].center - t.position, boundary.balls()[1].center - t.position,
                            boundary.balls()[2].center - t.position};
        const double side = dot(d[0], cross(d[1], d[2])) > 0 ? 1 : -1;
        double least = 1e9;
        for (int k = 0; k < 3; ++k) {
          const Point n = cross(d[k], d[(k + 1) % 3]);
          least = std::min(least, side * dot(n, x - t.position) / length(n));
        }
        if (least > 0.01 && length(x - t.position) < 2) {
          clearly_in = true;
          rest = t.position;
        }
        clearly_out = clearly_out && (least < -0.01 || length(x - t.position) > 2);
      }
      if (clearly_in) {
        ASSERT_NEAR(length(x - rest), p, 1e-5);
        ASSERT_LT(length((1 / p) * (rest - x) - point(surface.normal(v))), 2e-5);
        ASSERT_EQ(surface.patches[v], QSES_PATCH_REENTRANT) << v;
        ++concave;
      } else if (clearly_out) {
        ASSERT_NE(surface.patches[v], QSES_PATCH_REENTRANT) << v;
        ++others;
      }
    }
    EXPECT_GT(concave, 20u);
    EXPECT_GT(others, 500u);
  }
}

// The probe rolls around two atoms but for a gap, at whose sides it comes to rest on the third: the ends of one arc are
// near each other.
TEST(ThreeAtoms, LeaveAGapInARing) {
  for (double apart : {4.6, 4.9, 5.3})
    for (double away : {2.6, 2.9, 3.2, 3.5})
      for (double h : {0.25, 0.5, 0.8})
        for (int turn = 0; turn < 3; ++turn) {
          SCOPED_TRACE(testing::Message() << apart << " and " << away << " at " << h << ", turned " << turn);
          Atoms atoms;
          atoms.add(0, 0, 0, 1.7).add(apart, 0, 0, 1.7).add(apart / 2, away, 0, 0.3);
          for (int k = 0; k < turn; ++k) atoms = turned(atoms, 0.7 * k, -0.3, 0.2);
          checked_surface(atoms, settings(h), {1e-4, 1e-3});
        }
}

// ---- against samples: a second reference that knows neither circles nor triple points

void check_against_samples(const Atoms &atoms, double h, double p, size_t per_sphere) {
  const Surface surface = compute(atoms, settings(h, p));
  const Boundary boundary(atoms, static_cast<double>(static_cast<float>(p)));
  const std::vector<Point> samples = exact_reference::sample_boundary(boundary.balls(), per_sphere);
  double largest = 0;
  for (const auto &b : boundary.balls()) largest = std::max(largest, b.radius);
  // Samples lie this far apart; distances to them are that much too large at most, but where a patch is smaller.
  const double apart = std::sqrt(4 * kPi * largest * largest / static_cast<double>(per_sphere));
  std::vector<double> excess;
  for (size_t v = 0; v < surface.vertex_count(); v += 3)
    excess.push_back(exact_reference::nearest_sample(samples, point(surface.mesh.position(v))) -
                     boundary_probe(settings(h, p)));
  EXPECT_GE(quantile(excess, 0), -0.05);
  EXPECT_GE(quantile(excess, 0.01), -1e-3);
  EXPECT_LE(quantile(excess, 0.5), 0.25 * apart);
  EXPECT_LE(quantile(excess, 0.99), 1.5 * apart);

  // And nothing is missing: where a sampled probe touches an atom, the mesh is near.
  std::vector<double> missing;
  for (size_t k = 0; k < samples.size(); k += 41) {
    size_t atom = 0;
    for (size_t i = 0; i < atoms.size(); ++i)
      if (std::abs(length(samples[k] - boundary.balls()[i].center) - boundary.balls()[i].radius) < 1e-9) atom = i;
    const Point c = boundary.balls()[atom].center;
    const double share = static_cast<double>(atoms.radii[atom]) / boundary.balls()[atom].radius;
    const Point touched = c + share * (samples[k] - c);
    double best = exact_reference::kInfinity;
    for (size_t v = 0; v < surface.vertex_count(); ++v)
      best = std::min(best, length(point(surface.mesh.position(v)) - touched));
    missing.push_back(best);
  }
  EXPECT_LE(quantile(missing, 0.99), h);
  EXPECT_LE(quantile(missing, 1), 2 * h);
}

TEST(Samples, OfThreeAtoms) {
  Atoms atoms;
  atoms.add(0, 0, 0, 1.7).add(2.9, 0, 0, 1.55).add(1.2, 2.7, 0.2, 1.8);
  check_against_samples(atoms, 0.5, 1.4, 20000);
  check_against_samples(atoms, 0.5, 0.7, 20000);
}
TEST(Samples, OfAMolecule) {
  Atoms all = crambin(), atoms;
  for (size_t i = 0; i < 40; ++i) {
    const auto c = all.center(i);
    atoms.add(c[0], c[1], c[2], static_cast<double>(all.radii[i]));
  }
  check_against_samples(atoms, 0.5, 1.4, 4000);
}

// ---- settings

TEST(Structures, CrambinAtSeveralSpacings) {
  const Atoms atoms = crambin();
  ASSERT_EQ(atoms.size(), 327u);
  for (double h : {0.35, 0.5, 0.7}) {
    SCOPED_TRACE(h);
    Limits limits;
    limits.stride = h < 0.4 ? 3 : 1;
    checked_surface(atoms, settings(h), limits);
  }
}

// Vertices stay exact on coarse lattices, but for those few that find the far side of a crease.
TEST(Structures, OnCoarseLattices) {
  const Atoms atoms = cluster(1500, 3);
  ASSERT_EQ(atoms.size(), 1500u);
  Limits limits;
  limits.stride = 2;
  limits.worst = 0.1;
  checked_surface(atoms, settings(1.0), limits);
  limits.worst = 0.7;
  checked_surface(atoms, settings(2.0), limits);
}

TEST(Structures, OtherSurfaces) {
  const Atoms atoms = crambin();
  for (qses_surface kind : {QSES_SURFACE_SAS, QSES_SURFACE_VDW}) {
    SCOPED_TRACE(kind);
    checked_surface(atoms, settings(0.5, 1.4, kind));
  }
}

TEST(Structures, OtherProbes) {
  const Atoms atoms = cluster(150, 8);
  for (double p : {0.3, 0.8, 2.5, 6.0}) {
    SCOPED_TRACE(p);
    checked_surface(atoms, settings(0.5, p));
  }
}

// What it could not reach into is less than rounding: no time is spent on its arcs.
TEST(Structures, OfATinyProbeAreTheAtomsThemselves) {
  const Atoms atoms = crambin();
  const Surface vdw = compute(atoms, settings(0.5, 1.4, QSES_SURFACE_VDW));
  for (double probe : {0.0, 0.049}) {
    const Surface ses = compute(atoms, settings(0.5, probe));
    EXPECT_EQ(ses.mesh.positions, vdw.mesh.positions) << probe;
    EXPECT_EQ(ses.mesh.indices, vdw.mesh.indices) << probe;
    EXPECT_EQ(ses.report.area, vdw.report.area) << probe;
  }
  EXPECT_NE(compute(atoms, settings(0.5, 0.051)).mesh.positions, vdw.mesh.positions);
}

TEST(Structures, RelaxationStepsStayOnTheSurface) {
  const Atoms atoms = cluster(120, 5);
  qses_settings s = settings();
  size_t vertices = 0;
  for (uint32_t steps : {0u, 1u, 2u, 5u}) {
    SCOPED_TRACE(steps);
    s.relaxation_steps = steps;
    const Surface surface = checked_surface(atoms, s);
    EXPECT_TRUE(steps == 0 || surface.vertex_count() == vertices);
    vertices = surface.vertex_count();
  }
}

}  // namespace
