// SPDX-License-Identifier: MIT
// Numbers through the C API: where they come from, areas per atom, delivery NONE, jobs, kept meshes, estimates.
#include "capi/kept_mesh_fixture.h"

#include <cmath>
#include <numeric>

namespace {

using namespace kept_mesh_fixture;

const qses_surface kSurfaces[] = {QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW};

qses_settings with_areas(qses_surface surface, qses_delivery delivery = QSES_DELIVERY_HOST) {
  qses_settings s = settings(0.7, 1.4, surface);
  s.atom_areas = 1;
  s.delivery = delivery;
  return s;
}

std::vector<double> areas_of(const qses_mesh &m) {
  return std::vector<double>(m.atom_areas, m.atom_areas + m.atom_count);
}
double sum_of(const std::vector<double> &values) { return std::accumulate(values.begin(), values.end(), 0.0); }

void expect_same_numbers(const qses_report &a, const qses_report &b) {
  EXPECT_EQ(a.area, b.area);
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.measured_by, b.measured_by);
}

TEST(Measures, SayWhereTheyComeFrom) {
  const Context context;
  set_atoms(context, crambin());
  qses_settings s = settings(0.7);
  compute_view(context, s);
  qses_report report = report_of(context);
  EXPECT_EQ(report.measured_by, QSES_MEASURED_BY_NORMALS);
  EXPECT_GT(report.area, report.triangle_area);
  EXPECT_NEAR(report.area, report.triangle_area, 0.03 * report.area);
  EXPECT_NEAR(report.volume, report.triangle_volume, 0.01 * report.volume);
  const Surface mesh = copy_surface(context);
  EXPECT_NEAR(report.triangle_area, mesh_checks::area(mesh.mesh), 1e-9 * report.area);
  EXPECT_NEAR(report.triangle_volume, mesh_checks::signed_volume(mesh.mesh), 1e-9 * report.volume);

  for (qses_surface surface : {QSES_SURFACE_SAS, QSES_SURFACE_VDW}) {
    s.surface = surface;
    compute_view(context, s);
    report = report_of(context);
    EXPECT_EQ(report.measured_by, QSES_MEASURED_BY_ATOMS);
    EXPECT_NEAR(report.triangle_area, mesh_checks::area(copy_surface(context).mesh), 1e-9 * report.area);
    EXPECT_NEAR(report.area, report.triangle_area, 0.2 * report.area);
  }
  // A probe that makes no difference: the surface is that of the atoms, which know.
  s.probe_radius = 0.01f;
  compute_view(context, s);
  report = report_of(context);
  s.surface = QSES_SURFACE_SES;
  compute_view(context, s);
  expect_same_numbers(report_of(context), report);

  s = settings(0.7);
  s.method = QSES_METHOD_GRID;
  compute_view(context, s);
  report = report_of(context);
  EXPECT_EQ(report.measured_by, QSES_MEASURED_BY_TRIANGLES);
  EXPECT_EQ(report.area, report.triangle_area);
  EXPECT_EQ(report.volume, report.triangle_volume);
  s.measure = 0;
  compute_view(context, s);
  report = report_of(context);
  EXPECT_EQ(report.measured_by, QSES_MEASURED_BY_NOTHING);
  EXPECT_EQ(report.area, 0);
  EXPECT_EQ(report.triangle_area, 0);
}

// The numbers are those of the exact normals, also where those of the mesh are rounded or reversed.
TEST(Measures, SameInAllLayoutsAndWindings) {
  const Context context;
  set_atoms(context, cluster(150, 3));
  for (qses_surface surface : kSurfaces) {
    qses_settings s = with_areas(surface);
    const std::vector<double> areas = areas_of(compute_view(context, s));
    const qses_report report = report_of(context);
    for (qses_vertex_layout layout : {QSES_VERTICES_SEPARATE, QSES_VERTICES_INTERLEAVED, QSES_VERTICES_COMPACT})
      for (qses_winding winding : {QSES_WINDING_OUTWARD, QSES_WINDING_REVERSED}) {
        s.vertex_layout = layout;
        s.winding = winding;
        const std::vector<double> same = areas_of(compute_view(context, s));
        ASSERT_EQ(same.size(), areas.size());
        for (size_t i = 0; i < areas.size(); ++i) EXPECT_NEAR(same[i], areas[i], 1e-7) << layout << winding;
        const qses_report other = report_of(context);
        EXPECT_NEAR(other.area, report.area, 1e-12 * report.area);
        EXPECT_NEAR(other.volume, report.volume, 1e-12 * report.volume);
      }
  }
}

TEST(AtomAreas, AddUpToTheArea) {
  const Context context;
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  for (qses_surface surface : kSurfaces) {
    qses_mesh m = compute_view(context, settings(0.7, 1.4, surface));
    EXPECT_EQ(m.atom_areas, nullptr);
    EXPECT_EQ(m.atom_count, 0u);
    m = compute_view(context, with_areas(surface));
    ASSERT_EQ(m.atom_count, atoms.size());
    const std::vector<double> areas = areas_of(m);
    const double area = report_of(context).area;
    EXPECT_NEAR(sum_of(areas), area, 1e-7 * area);
    // An atom has area where it has vertices, give or take what is smaller than a triangle.
    std::vector<size_t> vertices(atoms.size());
    for (size_t v = 0; v < m.vertex_count; ++v) ++vertices[m.owners[v]];
    for (size_t i = 0; i < atoms.size(); ++i) {
      EXPECT_GE(areas[i], 0);
      EXPECT_TRUE(vertices[i] <= 20 || areas[i] > 1) << i;
      EXPECT_TRUE(areas[i] <= 2 || vertices[i] > 0) << i;
      EXPECT_TRUE(surface != QSES_SURFACE_SES || vertices[i] > 0 || areas[i] == 0) << i;
    }
  }
  qses_settings s = with_areas(QSES_SURFACE_SES);
  s.method = QSES_METHOD_GRID;
  expect_error(qses_compute(context, &s, nullptr), QSES_INVALID_ARGUMENT, {"settings.atom_areas", "GRID"});
}

TEST(AtomAreas, AreTheSameWhereTheSurfaceIsNotMeasured) {
  const Context context;
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  for (qses_surface surface : {QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW, QSES_SURFACE_GAUSSIAN})
    for (qses_delivery delivery : {QSES_DELIVERY_HOST, QSES_DELIVERY_NONE}) {
      qses_settings s = with_areas(surface, delivery);
      const std::vector<double> measured = areas_of(compute_view(context, s));
      EXPECT_EQ(measured.size(), atoms.size());
      s.measure = 0;
      EXPECT_EQ(areas_of(compute_view(context, s)), measured) << surface << delivery;
      EXPECT_EQ(report_of(context).measured_by, QSES_MEASURED_BY_NOTHING);
      EXPECT_EQ(report_of(context).area, 0);
    }
}

// A third of each triangle to each corner's owner, against the mesh that came.
TEST(AtomAreas, OfTheSesAreThoseOfItsTriangles) {
  const Context context;
  const Atoms atoms = cluster(80, 12);
  set_atoms(context, atoms);
  const qses_mesh m = compute_view(context, with_areas(QSES_SURFACE_SES));
  std::vector<double> expected(atoms.size());
  for (size_t t = 0; t < m.triangle_count; ++t) {
    const uint32_t *const c = m.indices + 3 * t;
    double u[3], v[3];
    for (int d = 0; d < 3; ++d) {
      u[d] = static_cast<double>(m.positions[3 * c[1] + d]) - static_cast<double>(m.positions[3 * c[0] + d]);
      v[d] = static_cast<double>(m.positions[3 * c[2] + d]) - static_cast<double>(m.positions[3 * c[0] + d]);
    }
    const double area =
        0.5 * std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
    for (int k = 0; k < 3; ++k) expected[m.owners[c[k]]] += area / 3;
  }
  for (size_t i = 0; i < atoms.size(); ++i)
    EXPECT_NEAR(m.atom_areas[i], expected[i], 0.1 * expected[i] + 0.03) << i;  // bent ones are a little larger
}

TEST(AtomAreas, OfTheWholeSurfaceWhereAtomsAreHidden) {
  const Context context;
  const Atoms atoms = cluster(120, 7);
  set_atoms(context, atoms);
  for (qses_surface surface : kSurfaces) {
    expect_ok(qses_set_visible(context, nullptr, atoms.size()));
    const std::vector<double> whole = areas_of(compute_view(context, with_areas(surface)));
    const qses_report report = report_of(context);
    const std::vector<uint8_t> visible = some_visible(atoms.size(), 3);
    expect_ok(qses_set_visible(context, visible.data(), atoms.size()));
    EXPECT_EQ(areas_of(compute_view(context, with_areas(surface))), whole);
    expect_same_numbers(report_of(context), report);
    EXPECT_GT(report_of(context).hidden_triangles, 0u);
    EXPECT_EQ(areas_of(compute_view(context, with_areas(surface, QSES_DELIVERY_NONE))), whole);
    expect_same_numbers(report_of(context), report);
  }
}

TEST(AtomAreas, SameWhateverTheMemoryAndTheThreads) {
  const Atoms atoms = cluster(400, 21);
  for (qses_surface surface : kSurfaces) {
    const Context context;
    set_atoms(context, atoms);
    const qses_settings s = with_areas(surface);
    const std::vector<double> areas = areas_of(compute_view(context, s));
    for (unsigned threads : {1u, 3u}) {
      const Context unbounded(threads);
      set_atoms(unbounded, atoms);
      const qses_size_estimate estimate = estimate_of(unbounded, s);
      for (uint64_t budget : {uint64_t(0), estimate.smallest_budget / 4 * 5, 2 * estimate.smallest_budget}) {
        const Context other(threads, budget);
        set_atoms(other, atoms);
        EXPECT_EQ(areas_of(compute_view(other, s)), areas) << surface << " " << threads << " " << budget;
      }
    }
  }
}

// ---- delivery NONE

TEST(DeliveryNone, GivesTheNumbersOfTheMesh) {
  const Context context;
  set_atoms(context, crambin());
  for (qses_surface surface : kSurfaces) {
    const qses_mesh made = compute_view(context, with_areas(surface));
    const uint32_t vertices = made.vertex_count, triangles = made.triangle_count;
    const std::vector<double> areas = areas_of(made);
    const qses_report report = report_of(context);
    const qses_mesh m = compute_view(context, with_areas(surface, QSES_DELIVERY_NONE));
    EXPECT_EQ(areas_of(m), areas);
    expect_same_numbers(report_of(context), report);
    EXPECT_EQ(report_of(context).mesh_bytes, 0u);
    const bool has_mesh = surface == QSES_SURFACE_SES;
    EXPECT_EQ(m.vertex_count, has_mesh ? vertices : 0);
    EXPECT_EQ(m.triangle_count, has_mesh ? triangles : 0);
    EXPECT_EQ(report_of(context).triangle_area, has_mesh ? report.triangle_area : 0);
    EXPECT_EQ(report_of(context).brick_count > 0, has_mesh);
    for (const void *array : {static_cast<const void *>(m.positions), static_cast<const void *>(m.normals),
                              static_cast<const void *>(m.owners), static_cast<const void *>(m.indices)})
      EXPECT_EQ(array, nullptr);
  }
}

TEST(DeliveryNone, MakesComponentsIfAskedFor) {
  const Context context;
  set_atoms(context, crambin());
  for (qses_surface surface : kSurfaces) {
    qses_settings s = with_areas(surface);
    s.components = 1;
    const qses_mesh made = compute_view(context, s);
    const std::vector<qses_component> expected(made.components, made.components + made.component_count);
    s.delivery = QSES_DELIVERY_NONE;
    const qses_mesh m = compute_view(context, s);
    ASSERT_EQ(m.component_count, expected.size());
    ASSERT_GT(m.component_count, 0u);
    for (size_t k = 0; k < expected.size(); ++k) {
      EXPECT_EQ(m.components[k].triangles, expected[k].triangles);
      EXPECT_EQ(m.components[k].area, expected[k].area);
      EXPECT_EQ(m.components[k].volume, expected[k].volume);
    }
    EXPECT_EQ(m.positions, nullptr);
  }
}

TEST(DeliveryNone, CanNotBeKeptOrCollectedOnTheDevice) {
  const Context context;
  const Kept kept;
  set_atoms(context, water());
  for (qses_surface surface : kSurfaces) {
    compute_view(context, with_areas(surface, QSES_DELIVERY_NONE));
    expect_error(qses_keep(context, kept), QSES_INVALID_ARGUMENT, {"NONE"});
    EXPECT_EQ(kept.view().vertex_count, 0u);
    qses_mesh still = empty_mesh();
    expect_ok(qses_context_mesh(context, &still));
    EXPECT_EQ(still.atom_count, 3u);
  }
  qses_device_mesh mesh;
  qses_device_mesh_init(&mesh);
  compute_view(context, with_areas(QSES_SURFACE_SES, QSES_DELIVERY_NONE));
  expect_error(qses_collect_device(context, &mesh), QSES_INVALID_ARGUMENT, {"settings.delivery"});
}

TEST(DeliveryNone, OfNoAtoms) {
  const Context context;
  set_atoms(context, Atoms());
  for (qses_surface surface : kSurfaces) {
    const qses_mesh m = compute_view(context, with_areas(surface, QSES_DELIVERY_NONE));
    EXPECT_EQ(m.atom_count, 0u);
    EXPECT_EQ(m.atom_areas, nullptr);
    EXPECT_EQ(report_of(context).area, 0);
  }
}

// Frame after frame in a job with levels; each level of SAS and VDW has the same numbers.
TEST(DeliveryNone, InJobs) {
  const Context context, plain;
  const Atoms frames[] = {cluster(90, 1), cluster(91, 2), cluster(92, 3)};
  for (qses_surface surface : kSurfaces)
    for (const Atoms &atoms : frames) {
      set_atoms(context, atoms);
      set_atoms(plain, atoms);
      const qses_settings s = with_areas(surface, QSES_DELIVERY_NONE);
      expect_ok(qses_begin(context, &s));
      expect_ok(qses_wait(context, -1, nullptr));
      qses_mesh m = empty_mesh();
      expect_ok(qses_collect(context, &m));
      EXPECT_EQ(m.level, m.level_count - 1);
      EXPECT_EQ(areas_of(m), areas_of(compute_view(plain, s)));
      expect_same_numbers(report_of(context), report_of(plain));
    }
}

TEST(DeliveryNone, IsEstimated) {
  const Context context;
  set_atoms(context, crambin());
  for (qses_surface surface : kSurfaces) {
    const qses_settings s = with_areas(surface, QSES_DELIVERY_NONE);
    const qses_size_estimate estimate = estimate_of(context, s);
    EXPECT_EQ(estimate.mesh_bytes, 0u);
    EXPECT_EQ(estimate.vertices > 0, surface == QSES_SURFACE_SES);
    EXPECT_GT(estimate.smallest_budget, 0u);
    const qses_mesh m = compute_view(context, s);
    const double work = static_cast<double>(report_of(context).work_bytes_peak);
    EXPECT_NEAR(static_cast<double>(estimate.work_bytes), work, 0.25 * work) << surface;
    EXPECT_NEAR(static_cast<double>(estimate.vertices), static_cast<double>(m.vertex_count), 0.1 * m.vertex_count);
    const Context small(2, estimate.smallest_budget);
    set_atoms(small, crambin());
    EXPECT_EQ(areas_of(compute_view(small, s)).size(), crambin().size()) << surface;
  }
}

// Its surface is much smaller than that of its inflated ball.
TEST(SmallestBudget, DoesForAnAtomAndALargeProbe) {
  const Atoms atom = Atoms().add(0, 0, 0, 1.5);
  for (const double probe : {3.0, 10.0, 30.0}) {
    const qses_settings s = settings(0.3, probe);
    const Context any(1);
    set_atoms(any, atom);
    qses_size_estimate estimate = estimate_of(any, s);
    const Context small(1, estimate.smallest_budget);
    set_atoms(small, atom);
    expect_ok(qses_estimate(small, &s, &estimate));
    EXPECT_EQ(estimate.fits, 1);
    EXPECT_EQ(compute(small, atom, s).mesh.positions, compute(any, atom, s).mesh.positions) << probe;
  }
}

// ---- lifetime

TEST(AtomAreas, LiveAsLongAsTheMesh) {
  std::vector<double> expected;
  const Kept kept;
  {
    const Context context;
    set_atoms(context, cluster(70, 8));
    const qses_mesh m = compute_view(context, with_areas(QSES_SURFACE_SES));
    expected = areas_of(m);
    expect_ok(qses_keep(context, kept));
    set_atoms(context, cluster(200, 9));
    for (int k = 0; k < 4; ++k) compute_view(context, with_areas(QSES_SURFACE_SAS));
    EXPECT_EQ(areas_of(kept.view()), expected);
  }
  EXPECT_EQ(areas_of(kept.view()), expected);
  qses_report report;
  qses_report_init(&report);
  expect_ok(qses_kept_mesh_report(kept, &report));
  EXPECT_NEAR(sum_of(expected), report.area, 1e-7 * report.area);
}

TEST(AtomAreas, OfACollectedLevelStayWhileOthersAreMade) {
  const Context context;
  set_atoms(context, cluster(70, 8));
  const qses_settings s = with_areas(QSES_SURFACE_SAS);
  expect_ok(qses_begin(context, &s));
  expect_ok(qses_wait(context, -1, nullptr));
  qses_mesh m = empty_mesh();
  expect_ok(qses_collect(context, &m));
  const std::vector<double> before = areas_of(m);
  set_atoms(context, cluster(300, 9));
  for (int k = 0; k < 3; ++k) {
    expect_ok(qses_begin(context, &s));
    expect_ok(qses_wait(context, -1, nullptr));
    EXPECT_EQ(areas_of(m), before);
  }
}

// Where no mesh is made no spacing is too fine, so that memory is all that can be wanting.
TEST(DeliveryNone, HasNoSpacingToBlame) {
  Atoms atoms = cluster(3000, 1);
  atoms.add(1e5, 0, 0, 1.5);
  const Context context, tight(2, 1 << 18);
  qses_settings s = settings(0.001, 1.4, QSES_SURFACE_VDW);
  s.delivery = QSES_DELIVERY_NONE;
  set_atoms(context, atoms);
  set_atoms(tight, atoms);
  qses_size_estimate estimate;
  qses_size_estimate_init(&estimate);
  expect_ok(qses_compute(context, &s, nullptr));
  expect_error(qses_compute(tight, &s, nullptr), QSES_OUT_OF_MEMORY, {"budget"});
  expect_error(qses_estimate(tight, &s, &estimate), QSES_OUT_OF_MEMORY, {"budget"});
}

}  // namespace
