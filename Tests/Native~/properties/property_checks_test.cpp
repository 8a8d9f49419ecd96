// SPDX-License-Identifier: MIT
// The property tests' own checks: closed forms against quadrature, insides of meshes, and that every kind of fault is
// seen in a surface that has it.
#include "properties/property_shrink.h"

#include <gtest/gtest.h>

namespace {

using namespace properties;

// Area and volume of a solid of revolution, by many conical frustums.
template <class Profile>
Measures revolved(double from, double to, Profile profile) {
  Measures m;
  constexpr int kSteps = 400000;
  double before = profile(from);
  for (int k = 1; k <= kSteps; ++k) {
    const double now = profile(from + (to - from) * k / kSteps), step = (to - from) / kSteps;
    if (before > 0 || now > 0) m.area += pi() * (before + now) * std::hypot(step, now - before);
    m.volume += pi() * step * (before * before + before * now + now * now) / 3;
    before = now;
  }
  return m;
}

TEST(ClosedForms, AreThoseOfTheProfile) {
  const double p = 1.4;
  // Overlapping atoms, a waist, a spindle, one that only just is one, a small atom beside a large one.
  const double pairs[][3] = {{1.7, 1.52, 2.1},   {1.7, 1.2, 4.5}, {1.7, 1.52, 5.8},
                             {1.7, 1.52, 5.555}, {3, 0.2, 4.1},   {3, 0.2, 3.05}};
  for (const auto &[r1, r2, d] : pairs) {
    SCOPED_TRACE(testing::Message() << r1 << " " << r2 << " " << d);
    const double a = r1 + p, b = r2 + p, along = (d * d + a * a - b * b) / (2 * d);
    const double around = std::sqrt(a * a - along * along);
    const double x1 = along * r1 / a, x2 = d - (d - along) * r2 / b;
    const auto sphere = [](double r, double x) { return std::sqrt(std::max(0.0, r * r - x * x)); };
    const Measures ses = revolved(-r1, d + r2, [&](double x) {
      if (x < x1) return sphere(r1, x);
      if (x > x2) return sphere(r2, x - d);
      return std::max(0.0, around - sphere(p, x - along));
    });
    const Measures closed = measures_of_ses(r1, r2, d, p, 0.5);
    EXPECT_NEAR(closed.area, ses.area, 2e-4 * ses.area);
    EXPECT_NEAR(closed.volume, ses.volume, 1e-5 * ses.volume);
    const Measures both = revolved(-a, d + b, [&](double x) { return std::max(sphere(a, x), sphere(b, x - d)); });
    const Measures of_union = measures_of_union(a, b, d, 0.5);
    EXPECT_NEAR(of_union.area, both.area, 2e-4 * both.area);
    EXPECT_NEAR(of_union.volume, both.volume, 1e-5 * both.volume);
  }
  EXPECT_NEAR(measures_of_ses(1.7, 1.5, 6.1, p, 0.5).volume, 4 * pi() / 3 * (1.7 * 1.7 * 1.7 + 1.5 * 1.5 * 1.5), 1e-9);
  EXPECT_NEAR(measures_of_ses(1.7, 0.5, 1.1, p, 0.5).area, 4 * pi() * 1.7 * 1.7, 1e-9);
}

// What a surface may be off by falls with the square of the spacing, or that of its ridges.
TEST(ClosedForms, LeaveLittlePlay) {
  for (double h : {0.4, 0.2, 0.1}) {
    Measures m;
    add_ball(m, 3, h);
    EXPECT_LT(m.chord_volume, 0.4 * h * h * m.volume);
    EXPECT_LT(measures_of_ses(1.7, 1.52, 2.1, 1.4, h).chord_volume, 0.8 * h * h * m.volume);
  }
}

class Faults : public testing::Test {
 protected:
  Faults() {
    case_.settings = surface_fixture::settings(0.4);
    case_.settings.components = 1;
    case_.atoms.add(0, 0, 0, 1.7).add(2.4, 0.3, 0, 1.52).add(0.5, 2.2, 0.4, 1.55);
    const Context context(1, 0, QSES_BACKEND_CPU);
    surface_fixture::set_atoms(context, case_.atoms);
    qses_mesh mesh;
    qses_mesh_init(&mesh);
    surface_fixture::expect_ok(qses_compute(context, &case_.settings, &mesh));
    good_ = result_of(mesh, surface_fixture::report_of(context));
  }

  Fault fault_of(const Result &r) const {
    Verdict v;
    const ExactSurface exact(case_);
    check_connection(r, v);
    if (v.good()) check_bounds(r, v);
    if (v.good()) check_measures(case_, r, v);
    if (v.good()) check_owners(case_, r, v);
    if (v.good()) check_distances(case_, r, exact, v);
    if (v.good()) check_edges(case_, r, v);
    if (v.good()) check_sides(case_, r, exact, v);
    return v.fault;
  }

  // With everything that follows from positions and triangles as if the library had meant them.
  Fault fault_of_moved(Result r) const {
    mesh_checks::Mesh &mesh = r.surface.mesh;
    for (size_t d = 0; d < 3; ++d) r.low[d] = r.high[d] = mesh.positions[d];
    for (size_t k = 0; k < mesh.positions.size(); ++k) {
      r.low[k % 3] = std::min(r.low[k % 3], mesh.positions[k]);
      r.high[k % 3] = std::max(r.high[k % 3], mesh.positions[k]);
    }
    qses_report &report = r.surface.report;
    report.triangle_area = report.area = r.components[0].area = mesh_checks::area(mesh);
    report.triangle_volume = report.volume = r.components[0].volume = mesh_checks::signed_volume(mesh);
    return fault_of(r);
  }

  Case case_;
  Result good_;
};

TEST_F(Faults, AreNotSeenWhereThereAreNone) {
  EXPECT_EQ(fault_of(good_), Fault::kNone);
  EXPECT_EQ(fault_of_moved(good_), Fault::kNone);
}

TEST_F(Faults, OfConnection) {
  Result r = good_;
  r.surface.mesh.indices.resize(r.surface.mesh.indices.size() - 3);
  EXPECT_EQ(fault_of(r), Fault::kOpen);
  r = good_;
  r.surface.mesh.positions[7] = std::nanf("");
  EXPECT_EQ(fault_of(r), Fault::kNotFinite);
  r = good_;
  r.surface.mesh.normals[7] *= 1.5f;
  EXPECT_EQ(fault_of(r), Fault::kNormals);
}

TEST_F(Faults, OfNumbers) {
  Result r = good_;
  r.low[1] -= 1e-3f;
  EXPECT_EQ(fault_of(r), Fault::kBounds);
  r = good_;
  r.surface.report.triangle_volume *= 1.001;
  EXPECT_EQ(fault_of(r), Fault::kReport);
  r = good_;
  r.surface.report.area = std::nan("");
  EXPECT_EQ(fault_of(r), Fault::kNotFinite);
  r = good_;
  r.components[0].triangles -= 1;
  EXPECT_EQ(fault_of(r), Fault::kComponents);
  r = good_;
  r.components[0].volume *= 1.001;
  EXPECT_EQ(fault_of(r), Fault::kComponents);
  r = good_;
  for (uint32_t &owner : r.surface.mesh.owners) owner = owner == 2 ? 1 : owner;
  EXPECT_EQ(fault_of(r), Fault::kOwners);
  r = good_;
  r.surface.mesh.owners[5] = 3;
  EXPECT_EQ(fault_of(r), Fault::kOwners);
}

// Farther along its normal than it should be, by a little more than is allowed.
TEST_F(Faults, OfPlace) {
  for (double away : {0.025, -0.025}) {
    Result r = good_;
    for (size_t k = 0; k < r.surface.mesh.positions.size(); ++k)
      r.surface.mesh.positions[k] += static_cast<float>(away) * r.surface.mesh.normals[k];
    Verdict v;
    check_distances(case_, r, ExactSurface(case_), v);
    EXPECT_EQ(v.fault, Fault::kOffSurface) << away;
    EXPECT_NEAR(v.error, 0.025, 1e-3);
  }
  // A normal that is right for another vertex.
  Result r = good_;
  for (size_t k = 0; k < 3; ++k) r.surface.mesh.normals[k] *= -1;
  EXPECT_EQ(fault_of(r), Fault::kOffSurface);
  // Two vertices that lie where others do: on the surface, with the others' normals and owners, but stretched.
  r = good_;
  const size_t last = r.surface.vertex_count() - 1;
  for (size_t k = 0; k < 3; ++k) {
    r.surface.mesh.positions[k] = r.surface.mesh.positions[3 * last + k];
    r.surface.mesh.normals[k] = r.surface.mesh.normals[3 * last + k];
  }
  r.surface.mesh.owners[0] = r.surface.mesh.owners[last];
  EXPECT_EQ(fault_of_moved(r), Fault::kStretched);
}

// The surface of two of the three atoms, as if the third were not there.
TEST_F(Faults, OfAnAtomThatIsMissing) {
  Case c = case_;
  c.atoms.add(8, 0, 0, 1.8);
  Verdict v;
  check_sides(c, good_, ExactSurface(c), v);
  EXPECT_EQ(v.fault, Fault::kMisplaced);
  c.atoms = Atoms().add(0, 0, 0, 1.7).add(2.4, 0.3, 0, 1.52);
  v = Verdict();
  check_closed_form(c, good_, v);
  EXPECT_EQ(v.fault, Fault::kClosedForm);
}

TEST_F(Faults, OfBytes) {
  Result r = good_;
  EXPECT_EQ(difference(good_, r), nullptr);
  r.surface.mesh.positions[4] = stepped(r.surface.mesh.positions[4], 1);
  EXPECT_STREQ(difference(good_, r), "positions");
}

TEST_F(Faults, WindingsTellInsideFromOutside) {
  const Windings windings(good_.surface.mesh);
  EXPECT_EQ(windings.at({0, 0, 0}), 1);
  EXPECT_EQ(windings.at({2.4, 0.3, 0}), 1);
  for (const Point &d : exact_reference::fibonacci_directions(50)) EXPECT_EQ(windings.at(8.0 * d), 0);
  // Where a ray passes through a vertex, it passes one triangle all the same.
  for (size_t v = 0; v < good_.surface.vertex_count(); v += 7) {
    const Point ray{0.3194, 0.7717, 0.5496};
    EXPECT_EQ(windings.at(point(good_.surface.mesh.position(v)) - 20.0 * ray), 0);
  }
}

// A set is a seed's, and sets are what they are called.
TEST(Generators, GiveTheSameSetAgain) {
  for (uint64_t seed = 1; seed < 200; ++seed) {
    const Case a = make_case(seed), b = make_case(seed);
    ASSERT_EQ(a.atoms.positions, b.atoms.positions);
    ASSERT_EQ(a.atoms.radii, b.atoms.radii);
    ASSERT_EQ(std::memcmp(&a.settings, &b.settings, sizeof a.settings), 0);
    for (float r : a.atoms.radii) ASSERT_TRUE(r >= 1e-4f && r <= 100.f);
    ASSERT_LE(largest_coordinate(a.atoms), 1e6);
  }
}

TEST(Generators, StepsAreNeighbours) {
  EXPECT_EQ(stepped(1.5f, 1), std::nextafter(1.5f, 2.f));
  EXPECT_EQ(stepped(1.5f, -1), std::nextafter(1.5f, 0.f));
  EXPECT_EQ(stepped(-1.5f, 1), std::nextafter(-1.5f, 0.f));
  EXPECT_EQ(stepped(0.1f, 10000) - 0.1f, 10000 * (std::nextafter(0.1f, 1.f) - 0.1f));
}

}  // namespace
