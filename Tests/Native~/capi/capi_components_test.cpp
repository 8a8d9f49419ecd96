// SPDX-License-Identifier: MIT
// Components through the C API: closed forms, sums, hidden atoms, budgets, lifetime.
#include "capi/capi_fixture.h"
#include "io/trajectory_frames.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using namespace capi_fixture;

const double kPi = std::acos(-1.0);
double ball(double radius) { return 4 * kPi / 3 * radius * radius * radius; }

qses_settings with_components(qses_settings s = settings()) {
  s.components = 1;
  return s;
}

std::vector<qses_component> components_of(const qses_mesh &m) {
  return {m.components, m.components + m.component_count};
}

std::vector<qses_component> components_of(qses_context *context, const qses_settings &s) {
  return components_of(compute_view(context, s));
}

// Equal to the last bit: sums of integers.
void expect_same(const std::vector<qses_component> &a, const std::vector<qses_component> &b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].triangles, b[k].triangles) << k;
    EXPECT_EQ(a[k].area, b[k].area) << k;
    EXPECT_EQ(a[k].volume, b[k].volume) << k;
    EXPECT_EQ(a[k].is_cavity, b[k].is_cavity) << k;
    for (int d = 0; d < 3; ++d) {
      EXPECT_EQ(a[k].center[d], b[k].center[d]) << k;
      EXPECT_EQ(a[k].bounds_min[d], b[k].bounds_min[d]) << k;
      EXPECT_EQ(a[k].bounds_max[d], b[k].bounds_max[d]) << k;
    }
  }
}

// The mesh is the whole surface, or what is left of it.
void expect_to_add_up(const std::vector<qses_component> &components, const qses_mesh &mesh, const qses_report &report) {
  uint64_t triangles = 0;
  double area = 0, volume = 0;
  for (const qses_component &c : components) {
    EXPECT_GT(c.area, 0);
    EXPECT_TRUE(c.area < 1 || (c.volume < 0) == (c.is_cavity != 0)) << c.volume;
    triangles += c.triangles;
    area += c.area;
    volume += c.volume;
  }
  EXPECT_EQ(triangles, uint64_t(mesh.triangle_count) + report.hidden_triangles);
  if (report.measured_by == QSES_MEASURED_BY_ATOMS) {  // which know better
    EXPECT_NEAR(area, report.triangle_area, 0.4 * report.triangle_area);
    return;
  }
  EXPECT_NEAR(area, report.area, 1e-11 * report.area);
  EXPECT_NEAR(volume, report.volume, 1e-11 * report.area * 100);  // of tetrahedra that are larger than the molecule
}

// Atoms all over a sphere.
Atoms shell(int count, double radius, double atom) {
  Atoms atoms;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1) / static_cast<double>(count), turn = kPi * (3 - std::sqrt(5.0)) * i;
    const double r = radius * std::sqrt(1 - z * z);
    atoms.add(r * std::cos(turn), r * std::sin(turn), radius * z, atom);
  }
  return atoms;
}

// Atoms that do not touch each other.
Atoms block_of_ions() {
  Atoms atoms;
  for (int k = 0; k < 343; ++k) atoms.add(5.3 * (k % 7), 5.1 * (k / 7 % 7), 4.9 * (k / 49), 1.2 + 0.1 * (k % 5));
  return atoms;
}

TEST(Components, OnlyIfAskedFor) {
  const Context context;
  set_atoms(context, water());
  qses_mesh m = compute_view(context, settings());
  EXPECT_EQ(m.component_count, 0u);
  EXPECT_EQ(m.components, nullptr);
  m = compute_view(context, with_components());
  EXPECT_EQ(m.component_count, 1u);
  m = compute_view(context, settings());
  EXPECT_EQ(m.component_count, 0u);
  EXPECT_EQ(m.components, nullptr);
}

TEST(Components, OfNoAtomsAreNone) {
  const Context context;
  expect_ok(qses_set_atoms(context, nullptr, 0, nullptr, 0));
  const qses_mesh m = compute_view(context, with_components());
  EXPECT_EQ(m.component_count, 0u);
  EXPECT_EQ(m.components, nullptr);
}

TEST(Components, OfFarSpheres) {
  const double radii[3] = {1.5, 2.5, 4};
  const Context context;
  set_atoms(context, Atoms().add(-40, 0, 0, radii[0]).add(0, 30, 5, radii[1]).add(30, -20, 900, radii[2]));
  for (const qses_surface surface : {QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW})
    for (const qses_winding winding : {QSES_WINDING_OUTWARD, QSES_WINDING_REVERSED}) {
      qses_settings s = with_components(settings(0.2, 1.4, surface));
      s.winding = winding;
      qses_mesh m = compute_view(context, s);
      std::vector<qses_component> found = components_of(m);
      ASSERT_EQ(found.size(), 3u);
      expect_to_add_up(found, m, report_of(context));
      // Vertices lie on the spheres; which one comes first is up to the lattice.
      double first_vertex[3];
      for (int d = 0; d < 3; ++d) first_vertex[d] = static_cast<double>(m.positions[d]);
      const double add = surface == QSES_SURFACE_SAS ? 1.4 : 0;
      const double to_first = std::hypot(first_vertex[0] + 40, first_vertex[1], first_vertex[2]) - radii[0] - add;
      EXPECT_EQ(std::fabs(to_first) < 0.1, found[0].volume < ball(radii[0] + add) * 1.001);
      std::sort(found.begin(), found.end(), [](const auto &a, const auto &b) { return a.area < b.area; });
      for (int k = 0; k < 3; ++k) {
        const double radius = radii[k] + add, area = 4 * kPi * radius * radius;
        EXPECT_NEAR(found[k].volume, ball(radius), 5e-4 * ball(radius));
        EXPECT_NEAR(found[k].area, area, 5e-4 * area);
        EXPECT_EQ(found[k].is_cavity, 0);
      }
    }
}

// Many steps at a coarse spacing leave next to nothing of a small atom, some of it inside out.
TEST(Components, ThatAreTurnedInsideOutAreNoCavities) {
  const Context context;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> somewhere(0, 2);
  qses_settings s = with_components(settings(2));
  s.relaxation_steps = 10;
  int inside_out[2] = {0, 0};
  for (int k = 0; k < 80; ++k) {
    const double x = somewhere(random), y = somewhere(random), z = somewhere(random);
    set_atoms(context, Atoms().add(x, y, z, 1.2));
    s.winding = k % 2 ? QSES_WINDING_REVERSED : QSES_WINDING_OUTWARD;
    for (const qses_component &c : components_of(context, s)) EXPECT_EQ(c.is_cavity, 0) << x << " " << y << " " << z;
    inside_out[k % 2] += report_of(context).triangle_volume < 0 ? 1 : 0;
  }
  for (const int n : inside_out) EXPECT_GT(n, 0);
}

TEST(Components, OfAHollowShell) {
  const double radius = 7, atom = 1.7;
  const Context context;
  const Atoms atoms = shell(700, radius, atom);
  // No point of the sphere is farther than this from an atom: the Fibonacci lattice's cells are not quite square.
  const double reach = 1.2 * std::sqrt(4 * kPi * radius * radius / 700);
  const double dent = std::sqrt(atom * atom - reach * reach / 2);
  set_atoms(context, atoms);
  for (const qses_method method : {QSES_METHOD_EXACT, QSES_METHOD_GRID})
    for (const qses_winding winding : {QSES_WINDING_OUTWARD, QSES_WINDING_REVERSED}) {
      qses_settings s = with_components(settings(0.4));
      s.method = method;
      s.winding = winding;
      s.relaxation_steps = method == QSES_METHOD_GRID ? 0 : 1;
      const qses_mesh m = compute_view(context, s);
      const std::vector<qses_component> found = components_of(m);
      ASSERT_EQ(found.size(), 2u);
      expect_to_add_up(found, m, report_of(context));
      EXPECT_EQ(found[0].is_cavity, 0);  // the first vertex is the outermost
      EXPECT_EQ(found[1].is_cavity, 1);
      const double slack = method == QSES_METHOD_GRID ? 0.2 : 0.03;  // Å; half a voxel
      EXPECT_LT(found[0].volume, ball(radius + atom + slack));
      EXPECT_GT(found[0].volume, ball(radius + dent - slack));
      EXPECT_GT(-found[1].volume, ball(radius - atom - slack));
      EXPECT_LT(-found[1].volume, ball(radius - dent + slack));
    }
}

TEST(Components, AddUpToTheReport) {
  const Context context;
  const Atoms protein = crambin(), ions = block_of_ions();
  for (const Atoms *atoms : {&protein, &ions}) {
    set_atoms(context, *atoms);
    for (const double spacing : {0.25, 0.5, 1.0, 2.0})
      for (const qses_surface surface : {QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW}) {
        qses_settings s = with_components(settings(spacing, 1.4, surface));
        s.vertex_layout = spacing < 1 ? QSES_VERTICES_INTERLEAVED : QSES_VERTICES_SEPARATE;
        const qses_mesh m = compute_view(context, s);
        const std::vector<qses_component> outward = components_of(m);
        expect_to_add_up(outward, m, report_of(context));
        EXPECT_FALSE(outward.empty());
        s.winding = QSES_WINDING_REVERSED;
        s.measure = 0;
        expect_same(components_of(context, s), outward);
      }
    // Measured along its triangles, and along its normals.
    qses_settings grid = with_components(), gaussian = with_components();
    grid.method = QSES_METHOD_GRID;
    gaussian.surface = QSES_SURFACE_GAUSSIAN;
    for (qses_settings s : {grid, gaussian}) {
      const qses_mesh m = compute_view(context, s);
      const qses_report report = report_of(context);
      expect_to_add_up(components_of(m), m, report);
      s.components = 0;
      compute_view(context, s);
      EXPECT_NEAR(report_of(context).area, report.area, 1e-11 * report.area);
    }
  }
  EXPECT_GT(components_of(context, with_components(settings(0.5, 1.4, QSES_SURFACE_VDW))).size(), 300u);
}

TEST(Components, AreThoseOfTheWholeSurfaceWhereAtomsAreHidden) {
  const Context context;
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  for (const qses_method method : {QSES_METHOD_EXACT, QSES_METHOD_GRID}) {
    qses_settings s = with_components();
    s.method = method;
    expect_ok(qses_set_visible(context, nullptr, atoms.size()));
    const std::vector<qses_component> whole = components_of(context, s);
    for (const size_t hidden : {atoms.size() / 2, atoms.size()}) {
      std::vector<uint8_t> visible(atoms.size(), 1);
      std::fill_n(visible.begin(), hidden, uint8_t(0));
      expect_ok(qses_set_visible(context, visible.data(), visible.size()));
      const qses_mesh m = compute_view(context, s);
      expect_same(components_of(m), whole);
      expect_to_add_up(components_of(m), m, report_of(context));
      EXPECT_GT(report_of(context).hidden_triangles, 0u);
    }
  }
}

// Pieces of the work, and a mesh that leaves the GPU piece by piece and is looked at by the CPU: the same numbers.
TEST(Components, AreTheSameWithSlicesAndBudgets) {
  const Atoms atoms = cluster(2500, 8);
  std::vector<uint8_t> visible(atoms.size(), 1);
  std::fill_n(visible.begin(), 700, uint8_t(0));
  const Context unbounded;
  for (const bool masked : {false, true})
    for (const qses_method method : {QSES_METHOD_EXACT, QSES_METHOD_GRID}) {
      const auto prepare = [&](qses_context *context) {
        set_atoms(context, atoms);
        if (masked) expect_ok(qses_set_visible(context, visible.data(), visible.size()));
      };
      qses_settings s = with_components(settings(0.4));
      s.method = method;
      prepare(unbounded);
      const std::vector<qses_component> expected = components_of(unbounded, s);
      const qses_size_estimate e = estimate_of(unbounded, s);
      ASSERT_FALSE(expected.empty());
      qses_settings sliced = s;
      sliced.slice_size = 16;
      expect_same(components_of(unbounded, sliced), expected);
      // Up to where the mesh fits, but not all that goes with it.
      for (const uint64_t more : {uint64_t(0), e.mesh_bytes / 4, e.mesh_bytes, e.mesh_bytes + e.mesh_bytes / 8,
                                  e.mesh_bytes * 2, e.mesh_bytes * 4}) {
        const Context context(2, e.smallest_budget + more);
        prepare(context);
        for (int round = 0; round < 2; ++round) {
          const qses_mesh m = compute_view(context, s);
          expect_same(components_of(m), expected);
          expect_to_add_up(components_of(m), m, report_of(context));
          EXPECT_LE(report_of(context).work_bytes_peak, e.smallest_budget + more);
        }
      }
    }
}

TEST(Components, LiveAsLongAsTheMesh) {
  const Context context;
  const Atoms atoms = cluster(400, 9);
  set_atoms(context, atoms);
  const qses_mesh held = begin_and_collect(context, with_components());
  const std::vector<qses_component> before = components_of(held);
  ASSERT_FALSE(before.empty());
  for (int k = 0; k < 4; ++k) {
    // Far more components than before.
    set_atoms(context, block_of_ions());
    const qses_settings s = with_components(settings(0.5 + 0.1 * k, 1.4, QSES_SURFACE_VDW));
    expect_ok(qses_begin(context, &s));
    expect_ok(qses_wait(context, -1, nullptr));
    expect_same(components_of(held), before);
  }
  qses_mesh next = empty_mesh();
  expect_ok(qses_collect(context, &next));
  EXPECT_GT(next.component_count, 300u);
}

TEST(Components, OfEveryLevelOfAJob) {
  const Context context;
  set_atoms(context, crambin());
  qses_settings s = with_components(settings(0.5));
  expect_ok(qses_begin(context, &s));
  uint32_t levels = 0;
  for (int32_t finished = 0; !finished || levels == 0;) {
    expect_ok(qses_wait(context, 0.1, &finished));
    qses_mesh m = empty_mesh();
    if (qses_collect(context, &m) != QSES_OK) continue;
    ++levels;
    ASSERT_GT(m.component_count, 0u);
    expect_to_add_up(components_of(m), m, report_of(context));
  }
}

}  // namespace
