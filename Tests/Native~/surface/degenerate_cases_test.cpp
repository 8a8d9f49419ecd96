// SPDX-License-Identifier: MIT
// Arrangements of atoms that break methods for molecular surfaces: many atoms on one sphere, tangent, equal and
// contained balls, collinear centres, extremes of size and place. The surface is exact there, too.
#include "surface/surface_checks.h"

namespace {

using namespace surface_checks;

// Vertices of the truncated icosahedron.
Atoms fullerene() {
  const double g = 0.5 * (1 + std::sqrt(5.0)), scale = 1.42 / 2;
  const double kinds[3][3] = {{0, 1, 3 * g}, {1, 2 + g, 2 * g}, {g, 2, 2 * g + 1}};
  Atoms atoms;
  for (const auto &k : kinds)
    for (int turn = 0; turn < 3; ++turn)
      for (int sign = 0; sign < 8; ++sign) {
        double p[3];
        for (int d = 0; d < 3; ++d) p[(d + turn) % 3] = (sign >> d & 1 ? -1 : 1) * k[d] * scale;
        if (k[0] == 0 && (sign & 1)) continue;  // -0
        atoms.add(p[0], p[1], p[2], 1.7);
      }
  return atoms;
}

// As it stands on the lattice, turned, and turned and far from the origin.
void check_everywhere(const Atoms &atoms, double h = 0.5, double p = 1.4, Limits limits = {}) {
  for (qses_surface kind : {QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW}) {
    SCOPED_TRACE(testing::Message() << "surface " << kind);
    checked_surface(atoms, settings(h, p, kind), limits);
    {
      SCOPED_TRACE("turned");
      checked_surface(turned(atoms), settings(h, p, kind), limits);
    }
    SCOPED_TRACE("turned and shifted");
    checked_surface(turned(atoms, 33.3, -87.1, 61.7), settings(h, p, kind), limits);
  }
}

// ---- four and more atoms on one sphere

TEST(Cospherical, FourAtomsOfASquare) { check_everywhere(ring(4, 1.8, 1.7)); }
TEST(Cospherical, Tetrahedron) {
  Atoms atoms;
  for (int k = 0; k < 4; ++k) atoms.add(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k == 0 || k == 3 ? 1 : -1, 1.5);
  check_everywhere(atoms);
}
TEST(Cospherical, Benzene) { check_everywhere(with(ring(6, 1.39, 1.7), ring(6, 2.48, 1.2))); }
TEST(Cospherical, RingWithAHole) { check_everywhere(ring(10, 3.6, 1.5)); }
TEST(Cospherical, CubeOfEight) {
  check_everywhere(lattice(2, 1.5, 1.7));
  check_everywhere(lattice(2, 2.0, 1.7));
}
TEST(Cospherical, LatticeOfSixCubed) {
  Limits limits;
  limits.stride = 3;
  checked_surface(lattice(6, 1.5, 1.7), settings(), limits);
  checked_surface(turned(lattice(6, 1.5, 1.7), 12.3, 4.5, -6.7), settings(), limits);
  checked_surface(lattice(6, 2.0, 1.2), settings(), limits);
  checked_surface(turned(lattice(6, 2.0, 1.2), 12.3, 4.5, -6.7), settings(), limits);
}
TEST(Cospherical, FullereneHasACavity) {
  const Atoms atoms = fullerene();
  ASSERT_EQ(atoms.size(), 60u);
  for (const Atoms &a : {atoms, turned(atoms), turned(atoms, 150.5, -20.2, 70.7)}) {
    const Surface surface = checked_surface(a, settings());
    EXPECT_EQ(mesh_checks::piece_count(surface.mesh), 2u);
    // A probe fits into the middle, with some room: the cavity counts negative.
    mesh_checks::Mesh hull = surface.mesh, cavity = surface.mesh;
    hull.indices.clear();
    cavity.indices.clear();
    Point middle{0, 0, 0};
    for (size_t i = 0; i < a.size(); ++i) middle = middle + (1.0 / 60) * point(a.center(i));
    for (size_t t = 0; t < surface.mesh.triangle_count(); ++t) {
      const uint32_t *k = &surface.mesh.indices[3 * t];
      const bool within = exact_reference::length(point(surface.mesh.position(k[0])) - middle) < 2.5;
      mesh_checks::Mesh &part = within ? cavity : hull;
      part.indices.insert(part.indices.end(), k, k + 3);
    }
    EXPECT_GT(mesh_checks::signed_volume(hull), 300.0);
    const double probe = 4.0 / 3 * std::acos(-1.0) * 1.4 * 1.4 * 1.4;
    EXPECT_LT(mesh_checks::signed_volume(cavity), -0.9 * probe);
    EXPECT_GT(mesh_checks::signed_volume(cavity), -4 * probe);
  }
}

// ---- touching, equal and contained balls

TEST(Touching, TangentInflatedSpheres) {
  Atoms atoms;
  atoms.add(0, 0, 0, 1.6).add(6, 0, 0, 1.6);  // 1.6 + 1.4 twice
  const Surface surface = checked_surface(atoms, settings());
  EXPECT_EQ(mesh_checks::piece_count(surface.mesh), 2u);
  check_everywhere(atoms);
  atoms.add(3, 5.196152, 0, 1.6);
  check_everywhere(atoms);
  for (double nearly : {1e-3, 1e-4, 1e-5, 1e-6}) {
    Atoms two;
    two.add(0, 0, 0, 1.6).add(6 - nearly, 0, 0, 1.6);
    checked_surface(two, settings());
    checked_surface(turned(two, 20, 30, 40), settings());
  }
}
TEST(Touching, TangentFromWithin) {
  Atoms atoms;
  atoms.add(0, 0, 0, 2.0).add(0.5, 0, 0, 1.5).add(0, 2.6, 0, 1.2);
  const Surface surface = checked_surface(atoms, settings());
  for (uint32_t owner : surface.mesh.owners) EXPECT_NE(owner, 1u);
  check_everywhere(atoms);
}

TEST(Equal, DuplicatesChangeNothing) {
  Atoms once = cluster(30, 2), twice;
  for (size_t i = 0; i < once.size(); ++i) {
    const auto c = once.center(i);
    for (int k = 0; k < 2; ++k) twice.add(c[0], c[1], c[2], static_cast<double>(once.radii[i]));
  }
  const Surface a = compute(once, settings()), b = checked_surface(twice, settings());
  EXPECT_EQ(a.mesh.indices, b.mesh.indices);
  ASSERT_EQ(a.vertex_count(), b.vertex_count());
  for (size_t v = 0; v < b.vertex_count(); ++v) {
    ASSERT_LT(exact_reference::length(point(a.mesh.position(v)) - point(b.mesh.position(v))), 1e-5);
    ASSERT_EQ(b.mesh.owners[v] % 2, 0u);  // of two equal atoms, the first
  }
}
TEST(Equal, AThousandTimesTheSameAtom) {
  Atoms atoms;
  for (int k = 0; k < 1000; ++k) atoms.add(1.25, -2.5, 3.75, 1.7);
  const Surface surface = checked_surface(atoms, settings());
  for (uint32_t owner : surface.mesh.owners) EXPECT_EQ(owner, 0u);
}
TEST(Equal, OfTwoRadiiTheLarger) {
  Atoms atoms;
  atoms.add(0.1, 0.2, 0.3, 1.2).add(0.1, 0.2, 0.3, 1.7).add(0.1, 0.2, 0.3, 1.5);
  const Surface surface = checked_surface(atoms, settings());
  for (uint32_t owner : surface.mesh.owners) EXPECT_EQ(owner, 1u);
}

// Alternate locations: the same atom a few thousandths to tenths of an Å away.
TEST(Equal, NearDuplicates) {
  for (double away : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.4}) {
    SCOPED_TRACE(away);
    Atoms atoms;
    const Atoms base = cluster(25, 9);
    for (size_t i = 0; i < base.size(); ++i) {
      const auto c = base.center(i);
      const double r = static_cast<double>(base.radii[i]);
      atoms.add(c[0], c[1], c[2], r);
      if (i % 2 == 0) atoms.add(c[0] + away * 0.6, c[1] - away * 0.64, c[2] + away * 0.48, r);
    }
    checked_surface(atoms, settings());
  }
}

TEST(Contained, AtomsOwnNothing) {
  Atoms atoms;
  atoms.add(0, 0, 0, 3.0).add(0.4, 0.3, -0.2, 1.2).add(-0.5, 0, 0.5, 1.7).add(3.4, 0.2, 0, 1.5);
  const Surface surface = checked_surface(atoms, settings());
  for (uint32_t owner : surface.mesh.owners) EXPECT_TRUE(owner == 0 || owner == 3);
  check_everywhere(atoms);
}

// An atom that others bury together, though none alone contains it.
TEST(Contained, BuriedByMany) {
  Atoms atoms;
  atoms.add(0, 0, 0, 1.2);
  for (int k = 0; k < 6; ++k) {
    double p[3] = {0, 0, 0};
    p[k % 3] = k < 3 ? 1.6 : -1.6;
    atoms.add(p[0], p[1], p[2], 1.8);
  }
  const Surface surface = checked_surface(atoms, settings());
  for (uint32_t owner : surface.mesh.owners) EXPECT_NE(owner, 0u);
  check_everywhere(atoms);
}

// ---- collinear

TEST(Collinear, ThreeInARow) {
  for (double apart : {0.7, 1.54, 3.0}) {
    Atoms atoms;
    for (int k = 0; k < 3; ++k) atoms.add(apart * k, 0, 0, k == 1 ? 1.5 : 1.7);
    SCOPED_TRACE(apart);
    check_everywhere(atoms);
  }
}
TEST(Collinear, ThroughOneCircle) {
  // Three balls whose surfaces share one circle: centres at -1, 0, 1 and R² = 9 + z².
  Atoms atoms;
  atoms.add(-1, 0, 0, std::sqrt(10.0) - 1.4).add(0, 0, 0, 3.0 - 1.4).add(1, 0, 0, std::sqrt(10.0) - 1.4);
  check_everywhere(atoms);
}
TEST(Collinear, Nearly) {
  for (double off : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
    SCOPED_TRACE(off);
    Atoms atoms;
    atoms.add(0, 0, 0, 1.7).add(1.5, off, 0, 1.7).add(3, 0, 0, 1.7).add(4.5, 0, off, 1.7);
    checked_surface(atoms, settings());
    checked_surface(turned(atoms, 9, 8, 7), settings());
  }
}
TEST(Collinear, LongRod) {
  Atoms atoms;
  for (int k = 0; k < 40; ++k) atoms.add(1.5 * k, 0, 0, 1.7);
  checked_surface(atoms, settings());
  checked_surface(turned(atoms), settings());
}

// ---- extremes of size

TEST(Radii, OfCoarseGrainedBeads) {
  Atoms atoms;
  atoms.add(0, 0, 0, 20).add(31, 3, 2, 17).add(12, 25, -4, 9).add(22, 2, 18, 1.7).add(5, -20, 3, 1.2);
  Limits limits;
  limits.stride = 5;
  checked_surface(atoms, settings(0.8), limits);
  checked_surface(turned(atoms, 100, 200, -300), settings(0.8), limits);
}
TEST(Radii, TinyAndHugeTogether) {
  Atoms atoms = cluster(60, 4);
  atoms.add(0, 0, 112, 100).add(20, 0, 0, 0.05).add(-20, 3, 1, 0.4);
  Limits limits;
  limits.stride = 17;
  checked_surface(atoms, settings(1.0), limits);
}

// Of which neighbours of the others know nothing until they meet them; one is within another, one far from all.
TEST(Radii, AFewMuchLargerThanAllOthers) {
  Atoms atoms;
  atoms.add(30, 0, 0, 28);
  const Atoms protein = crambin();
  for (size_t k = 0; k < 150; ++k) {
    const auto c = protein.center(k);
    atoms.add(c[0], c[1], c[2], static_cast<double>(protein.radii[k]));
  }
  atoms.add(32, 1, 0, 20).add(-26, 5, 14, 9.5).add(-60, -90, 40, 12);
  Limits limits;
  limits.stride = 13;
  for (const qses_surface kind : {QSES_SURFACE_SES, QSES_SURFACE_SAS}) {
    const Surface surface = checked_surface(atoms, settings(1.0, 1.4, kind), limits);
    const std::vector<uint32_t> &owners = surface.mesh.owners;
    for (const uint32_t large : {0u, 152u, 153u})
      EXPECT_GT(std::count(owners.begin(), owners.end(), large), 100) << "of atom " << large;
    EXPECT_EQ(std::count(owners.begin(), owners.end(), 151u), 0);
  }
}

TEST(Probe, ZeroIsTheVanDerWaalsSurface) {
  const Atoms atoms = cluster(80, 6);
  const Surface ses = checked_surface(atoms, settings(0.5, 0.0));
  const Surface vdw = checked_surface(atoms, settings(0.5, 1.4, QSES_SURFACE_VDW));
  EXPECT_EQ(ses.mesh.positions, vdw.mesh.positions);
  EXPECT_EQ(ses.mesh.indices, vdw.mesh.indices);
  const Surface sas = compute(atoms, settings(0.5, 0.0, QSES_SURFACE_SAS));
  EXPECT_EQ(sas.mesh.positions, vdw.mesh.positions);
}
TEST(Probe, SmallAgainstTheSpacing) {
  const Atoms atoms = cluster(120, 7);
  checked_surface(atoms, settings(0.5, 0.2));
  checked_surface(atoms, settings(0.5, 0.06));
  checked_surface(atoms, settings(2.0, 0.6));
  const Atoms protein = crambin();
  checked_surface(protein, settings(0.5, 0.2));
}
TEST(Probe, Huge) {
  checked_surface(cluster(60, 1), settings(0.5, 20.0));
  // Float32 is that much coarser where the probe's centre is.
  checked_surface(cluster(60, 1), settings(1.0, 100.0), {5e-3, 0.1});
}

TEST(Spacing, ATenth) {
  Atoms atoms;
  atoms.add(0, 0, 0, 1.7).add(1.5, 0, 0, 1.2).add(0.4, 1.4, 0, 1.55).add(1.7, 1.9, 0.8, 1.8);
  Limits limits;
  limits.stride = 2;
  checked_surface(atoms, settings(0.1), limits);
}
TEST(Spacing, LargerThanTheMolecule) {
  Atoms atoms;
  atoms.add(0, 0, 0, 1.7).add(1.5, 0, 0, 1.2);
  const Surface surface = compute(atoms, settings(30.0));
  check_connection(surface.mesh);
  check_owners(atoms, surface.mesh, {});
  check_connection(compute(cluster(100, 3), settings(100.0)).mesh);
}

// ---- extremes of place

TEST(Place, NoAtoms) {
  for (qses_method method : {QSES_METHOD_EXACT, QSES_METHOD_GRID}) {
    qses_settings s = settings();
    s.method = method;
    const Surface surface = compute(Atoms(), s);
    EXPECT_EQ(surface.vertex_count(), 0u);
    EXPECT_EQ(surface.mesh.triangle_count(), 0u);
    EXPECT_EQ(surface.report.area, 0);
    EXPECT_EQ(surface.report.volume, 0);
  }
}

TEST(Place, AStrayAtomCostsNothing) {
  for (double far : {20000.0, 500000.0}) {
    Atoms atoms = cluster(100, 11);
    const Surface alone = compute(atoms, settings());
    atoms.add(far, -0.7 * far, 0.3 * far, 1.7);
    // Rounding of float32 where the centred frame's coordinates are largest.
    const double rounding = far * 6e-8 * 2;
    Limits limits;
    limits.p99 = 1e-3 + rounding;
    limits.worst = 0.05 + 40 * rounding;
    limits.owner_tie = 1e-4 + 4 * rounding;
    const Surface surface = far < 1e5 ? checked_surface(atoms, settings(), limits) : compute(atoms, settings());
    check_connection(surface.mesh);
    EXPECT_LT(surface.report.host_bytes_peak, uint64_t(64) << 20);
    EXPECT_LT(surface.report.brick_count, 2 * alone.report.brick_count + 100);
    size_t of_stray = 0;
    for (uint32_t owner : surface.mesh.owners) of_stray += owner == 100 ? 1 : 0;
    EXPECT_GT(of_stray, 100u);
  }
}

TEST(Place, FarFromTheOrigin) {
  Limits limits;
  limits.p99 = 1e-3;
  limits.owner_tie = 4e-4;
  checked_surface(shifted(cluster(120, 12), 1000, -1000, 1000), settings(), limits);
  checked_surface(shifted(fullerene(), 1000, 900, -800), settings(), limits);
  checked_surface(shifted(lattice(2, 2.0, 1.7), -999.9, 1000, 0), settings(), limits);
  // Beyond, the rounding of float32 adds; what is promised about connection holds as before.
  const Surface far = compute(shifted(cluster(120, 12), 1e6 - 20, 0, -1e6 + 20), settings());
  check_connection(far.mesh);
}

// Lone atoms along a line so long that single precision is coarse at its ends. A lattice point that rounding moves into
// an inflated ball must not become a piece of its own, out where the probe's centre is.
TEST(Place, NoPiecesOutOfRounding) {
  for (double h : {0.3, 0.35, 0.5, 0.7}) {
    SCOPED_TRACE(h);
    Atoms atoms;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> along(-1, 1);
    for (int k = -750; k < 750; ++k) atoms.add(10 * k + along(random), along(random), along(random), 1.7);
    const Surface surface = compute(atoms, settings(h));
    check_connection(surface.mesh);
    EXPECT_EQ(mesh_checks::piece_count(surface.mesh), atoms.size());
    double worst = 0;
    for (size_t v = 0; v < surface.vertex_count(); ++v) {
      const Point c = point(atoms.center(surface.mesh.owners[v]));
      worst = std::max(worst, std::abs(exact_reference::length(point(surface.mesh.position(v)) - c) - 1.7));
    }
    EXPECT_LT(worst, 2e-3);
  }
}

// The lattice stands still in space: a molecule moved by whole spacings looks the same.
TEST(Place, TheLatticeIsAnchored) {
  const Atoms atoms = cluster(60, 13);
  const Surface here = compute(atoms, settings(0.5)), there = compute(shifted(atoms, 12, -8.5, 3), settings(0.5));
  ASSERT_EQ(here.vertex_count(), there.vertex_count());
  EXPECT_EQ(here.mesh.triangle_count(), there.mesh.triangle_count());
}

// Beyond 2^21 spacings from the middle float32 can't tell neighbouring lattice points apart well enough.
TEST(DegenerateCases, SpacingsTooFineForTheExtentAreRefused) {
  Atoms atoms;
  atoms.add(-100000, -100000, -100000, 1.7).add(100000, 100000, 100000, 1.7);
  const Context context;
  set_atoms(context, atoms);
  for (qses_method method : {QSES_METHOD_EXACT, QSES_METHOD_GRID}) {
    qses_settings s = settings(0.01);
    s.method = method;
    EXPECT_EQ(qses_compute(context, &s, nullptr), QSES_TOO_FINE);
    EXPECT_NE(std::string(qses_last_error()).find("0.048"), std::string::npos) << qses_last_error();
    s.spacing = 0.05f;
    EXPECT_EQ(mesh_checks::manifold_fault(compute(context, atoms, s).mesh), "");
  }
}

TEST(DegenerateCases, TinyAtomsFarApartAreQuick) {
  Atoms atoms;
  atoms.add(0, 0, 0, 1e-6).add(1000, 2000, 3000, 1e-4).add(1000, 2000, 3000.5, 1e-5);
  for (qses_surface kind : {QSES_SURFACE_VDW, QSES_SURFACE_SES})
    EXPECT_EQ(mesh_checks::manifold_fault(compute(atoms, settings(0.5, 1.4, kind)).mesh), "");
}

}  // namespace
