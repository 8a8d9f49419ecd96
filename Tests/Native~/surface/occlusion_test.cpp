// SPDX-License-Identifier: MIT
// Ambient occlusion of vertices, against rays through the mesh.
#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

using namespace surface_fixture;

namespace {

constexpr double kPi = 3.14159265358979;

qses_settings lit(qses_settings s) {
  s.occlusion = 1;
  return s;
}

struct Lit {
  Surface surface;
  std::vector<float> openness;
};

Lit light(qses_context *context, const Atoms &atoms, const qses_settings &s) {
  set_atoms(context, atoms);
  const qses_mesh m = compute_view(context, lit(s));
  Lit out;
  for (uint32_t v = 0; v < m.vertex_count; ++v) {
    out.openness.push_back(m.texcoords[2 * v]);
    EXPECT_EQ(m.texcoords[2 * v + 1], 1.f);
  }
  out.surface = copy_surface(context);
  return out;
}
Lit light(const Atoms &atoms, const qses_settings &s, unsigned threads = 2) {
  const Context context(threads);
  return light(context, atoms, s);
}

void expect_in_range(const std::vector<float> &openness) {
  for (float open : openness) ASSERT_TRUE(open >= 0.f && open <= 1.f) << open;
}

double mean(const std::vector<float> &values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// The part of 256 rays, as many in each part of the sky as light comes from there, that meet no triangle within 20 Å.
double openness_by_rays(const qses_kept_mesh *kept, const float *position, const float *normal) {
  constexpr int kRays = 256;
  const double n[3] = {normal[0], normal[1], normal[2]};
  const int flat = std::fabs(n[0]) < 0.9 ? 0 : 1;
  double u[3], v[3], length = 0;
  for (int d = 0; d < 3; ++d) u[d] = (d == flat ? 1.0 : 0.0) - n[flat] * n[d];
  for (double c : u) length += c * c;
  for (double &c : u) c /= std::sqrt(length);
  for (int d = 0; d < 3; ++d) v[d] = n[(d + 1) % 3] * u[(d + 2) % 3] - n[(d + 2) % 3] * u[(d + 1) % 3];
  int open = 0;
  for (int k = 0; k < kRays; ++k) {
    const double across2 = (k + 0.5) / kRays, across = std::sqrt(across2), up = std::sqrt(1 - across2);
    const double angle = kPi * (3 - std::sqrt(5.0)) * k;
    float origin[3], direction[3];
    for (int d = 0; d < 3; ++d) {
      origin[d] = static_cast<float>(position[d] + 0.05 * n[d]);
      direction[d] = static_cast<float>(across * (std::cos(angle) * u[d] + std::sin(angle) * v[d]) + up * n[d]);
    }
    qses_hit hit;
    qses_hit_init(&hit);
    expect_ok(qses_kept_mesh_pick(kept, origin, direction, nullptr, 0, &hit));
    if (!hit.found || hit.distance > 20.f) ++open;
  }
  return static_cast<double>(open) / kRays;
}

struct Agreement {
  double error = 0, correlation = 0;
};

Agreement compare_with_rays(const Atoms &atoms, qses_settings s, size_t vertices) {
  const Context context;
  set_atoms(context, atoms);
  s.pickable = 1;
  compute_view(context, lit(s));
  qses_kept_mesh *kept = nullptr;
  expect_ok(qses_kept_mesh_create(&kept));
  expect_ok(qses_keep(context, kept));
  qses_mesh m;
  qses_mesh_init(&m);
  expect_ok(qses_kept_mesh_view(kept, &m));
  const size_t step = std::max<size_t>(1, m.vertex_count / vertices);
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0, error = 0;
  for (size_t v = 0; v < m.vertex_count; v += step) {
    const double rays = openness_by_rays(kept, m.positions + 3 * v, m.normals + 3 * v), own = m.texcoords[2 * v];
    n += 1, a += own, b += rays, aa += own * own, bb += rays * rays, ab += own * rays, error += std::fabs(own - rays);
  }
  qses_kept_mesh_destroy(kept);
  return {error / n, (n * ab - a * b) / std::sqrt((n * aa - a * a) * (n * bb - b * b))};
}

// Atoms 2 Å apart in a square of a plane.
void add_plate(Atoms *atoms, int half, double z) {
  for (int x = -half; x <= half; ++x)
    for (int y = -half; y <= half; ++y) atoms->add(2 * x, 2 * y, z, 1.7);
}

// Atoms on a sphere, so dense that no probe gets through.
Atoms hollow_ball(double radius) {
  Atoms atoms;
  const int count = static_cast<int>(4 * kPi * radius * radius / 2);
  for (int k = 0; k < count; ++k) {
    const double z = 1 - (2 * k + 1.0) / count, across = std::sqrt(1 - z * z), angle = kPi * (3 - std::sqrt(5.0)) * k;
    atoms.add(radius * across * std::cos(angle), radius * across * std::sin(angle), radius * z, 1.7);
  }
  return atoms;
}

}  // namespace

TEST(Occlusion, IsWhatRaysFind) {
  for (const float spacing : {0.5f, 1.f}) {
    const Agreement found = compare_with_rays(crambin(), settings(spacing), 1000);
    std::printf("spacing %g: mean error %.4f, correlation %.4f\n", spacing, found.error, found.correlation);
    EXPECT_LE(found.error, 0.05);
    EXPECT_GE(found.correlation, 0.95);
  }
}

TEST(Occlusion, LeavesALoneAtomInTheLight) {
  const Lit one = light(Atoms().add(3, -7, 11, 1.7), settings());
  for (float open : one.openness) EXPECT_GE(open, 0.95f);
}

TEST(Occlusion, DarkensWhatIsClosedIn) {
  const Atoms ball = hollow_ball(9);
  const Lit shell = light(ball, settings());
  std::vector<float> inner, outer;
  for (size_t v = 0; v < shell.openness.size(); ++v) {
    const float *const p = &shell.surface.mesh.positions[3 * v];
    (std::hypot(p[0], p[1], p[2]) < 9 ? inner : outer).push_back(shell.openness[v]);
  }
  ASSERT_GT(inner.size(), 500u);
  EXPECT_LE(*std::max_element(inner.begin(), inner.end()), 0.01f) << "no light comes into a cavity";
  EXPECT_GE(mean(outer), 0.85);
}

// However small the part of an atom is that it fills by itself.
TEST(Occlusion, DarkensWhatAGaussianSurfaceClosesIn) {
  Atoms box;  // of atoms 2.5 Å apart, without the 27 in the middle
  for (int k = 0; k < 7 * 7 * 7; ++k) {
    const int x = k % 7 - 3, y = k / 7 % 7 - 3, z = k / 49 - 3;
    if (std::max({std::abs(x), std::abs(y), std::abs(z)}) > 1) box.add(2.5 * x, 2.5 * y, 2.5 * z, 1.7);
  }
  for (const float isovalue : {0.5f, 0.9f, 1.f, 1.3f}) {
    SCOPED_TRACE(isovalue);
    qses_settings s = settings(0.5, 1.4, QSES_SURFACE_GAUSSIAN);
    s.gaussian_isovalue = isovalue;
    const Lit lit_box = light(box, s);
    std::vector<float> inner, outer;
    for (size_t v = 0; v < lit_box.openness.size(); ++v) {
      const float *const p = &lit_box.surface.mesh.positions[3 * v];
      (std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])}) < 5 ? inner : outer)
          .push_back(lit_box.openness[v]);
    }
    ASSERT_GT(inner.size(), 100u);
    EXPECT_LE(*std::max_element(inner.begin(), inner.end()), 0.01f) << "no light comes into a cavity";
    EXPECT_GE(mean(outer), 0.6);
    expect_in_range(lit_box.openness);
  }
}

TEST(Occlusion, DarkensTheGapBetweenTwoPlates) {
  Atoms plates;
  add_plate(&plates, 9, -5);
  add_plate(&plates, 9, 5);
  const Lit gap = light(plates, settings());
  std::vector<float> inside, outside;
  for (size_t v = 0; v < gap.openness.size(); ++v) {
    const float *const p = &gap.surface.mesh.positions[3 * v];
    if (std::hypot(p[0], p[1]) > 4) continue;
    (std::fabs(p[2]) < 5 ? inside : outside).push_back(gap.openness[v]);
  }
  // What shines in from the edge all around is taken for brighter than it is: two moments know no slits (rays find
  // .11).
  EXPECT_LE(mean(inside), 0.25);
  EXPECT_GE(mean(outside), 0.85);
}

TEST(Occlusion, IsTheSameHoweverTheWorkIsDone) {
  const Atoms atoms = cluster(400, 5);
  const Lit reference = light(atoms, settings());
  EXPECT_EQ(light(atoms, settings(), 1).openness, reference.openness) << "one thread";
  qses_settings sliced = settings();
  sliced.slice_size = 16;
  EXPECT_EQ(light(atoms, sliced).openness, reference.openness) << "in slices";
  const Context poor(2, uint64_t(6) << 20);
  EXPECT_EQ(light(poor, atoms, settings()).openness, reference.openness) << "with a budget";
  for (const qses_vertex_layout layout : {QSES_VERTICES_INTERLEAVED, QSES_VERTICES_COMPACT}) {
    qses_settings other = lit(settings());
    other.vertex_layout = layout;
    const Context context;
    set_atoms(context, atoms);
    const qses_mesh m = compute_view(context, other);
    ASSERT_EQ(m.vertex_count, reference.openness.size());
    for (uint32_t v = 0; v < m.vertex_count; ++v) ASSERT_EQ(m.texcoords[2 * v], reference.openness[v]) << layout;
  }
}

TEST(Occlusion, ChangesNothingElse) {
  const Atoms atoms = cluster(200, 9);
  for (const bool creased : {false, true}) {
    qses_settings s = settings();
    s.creases = s.hard_edges = creased;
    const Surface plain = compute(atoms, s), with_light = light(atoms, s).surface;
    EXPECT_EQ(plain.mesh.positions, with_light.mesh.positions);
    EXPECT_EQ(plain.mesh.normals, with_light.mesh.normals);
    EXPECT_EQ(plain.mesh.indices, with_light.mesh.indices);
    EXPECT_EQ(plain.report.area, with_light.report.area);
  }
}

TEST(Occlusion, LeavesTheSecondTextureCoordinateToTheAtoms) {
  const Atoms atoms = cluster(60, 3);
  const Context context;
  set_atoms(context, atoms);
  std::vector<float> uv;
  for (size_t i = 0; i < atoms.size(); ++i) uv.insert(uv.end(), {7.f, static_cast<float>(i)});
  expect_ok(qses_set_texcoords(context, uv.data(), atoms.size()));
  const qses_mesh m = compute_view(context, lit(settings()));
  ASSERT_GT(m.vertex_count, 0u);
  for (uint32_t v = 0; v < m.vertex_count; ++v) {
    ASSERT_LE(m.texcoords[2 * v], 1.f);
    ASSERT_EQ(m.texcoords[2 * v + 1], static_cast<float>(m.owners[v]));
  }
}

TEST(Occlusion, OfHiddenAtomsGoesOn) {
  const Atoms atoms = cluster(200, 4);
  const Lit whole = light(atoms, settings());
  std::vector<uint8_t> visible(atoms.size(), 1);
  for (size_t i = 0; i < atoms.size(); ++i) visible[i] = atoms.center(i)[0] < 0 ? 1 : 0;
  const Context context;
  set_atoms(context, atoms);
  expect_ok(qses_set_visible(context, visible.data(), visible.size()));
  const qses_mesh m = compute_view(context, lit(settings()));
  ASSERT_GT(m.vertex_count, 0u);
  ASSERT_LT(m.vertex_count, whole.openness.size());
  size_t k = 0;  // vertices keep their order
  for (uint32_t v = 0; v < m.vertex_count; ++v, ++k) {
    while (k < whole.openness.size() && !std::equal(m.positions + 3 * v, m.positions + 3 * v + 3,
                                                    whole.surface.mesh.positions.begin() + long(3 * k)))
      ++k;
    ASSERT_LT(k, whole.openness.size());
    ASSERT_EQ(m.texcoords[2 * v], whole.openness[k]);
  }
}

TEST(Occlusion, OfAnyKindOfSurfaceIsInRange) {
  std::mt19937 random(11);
  for (unsigned seed = 0; seed < 12; ++seed) {
    Atoms atoms = cluster(20 + seed * 9, seed);
    if (seed % 3 == 1) atoms.add(3e4, -2e4, 1e4, 1.5);  // far away: most of the box is empty
    if (seed % 4 == 2) atoms.add(5, 5, 5, 40);          // a giant
    if (seed % 4 == 3) atoms.add(12, 0, 0, 1e-3);       // a speck
    for (const qses_surface surface : {QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW}) {
      const double probe = seed % 5 == 0 ? 0.0 : 0.4 * (1 + random() % 12);
      expect_in_range(light(atoms, settings(1.5, probe, surface)).openness);
    }
    qses_settings grid = settings(1);
    grid.method = QSES_METHOD_GRID;
    expect_in_range(light(atoms, grid).openness);
  }
  EXPECT_TRUE(light(Atoms(), settings()).openness.empty());
}

// Atoms of a gas need up to 27 bricks each: the forecast knows.
TEST(Occlusion, FitsIntoTheSmallestBudgetOfAnEstimate) {
  std::mt19937 random(12);
  for (const int count : {200, 1000}) {
    Atoms gas;
    const double edge = std::cbrt(8640.0 * count);
    for (int k = 0; k < count; ++k) {
      double at[3];
      for (double &x : at) x = edge * static_cast<double>(random()) / 4294967296.0;
      gas.add(at[0], at[1], at[2], 1.7);
    }
    for (const qses_surface surface : {QSES_SURFACE_SES, QSES_SURFACE_SAS}) {
      const qses_settings s = lit(settings(1.5, 1.4, surface));
      const Context context(2);
      set_atoms(context, gas);
      const qses_size_estimate estimate = estimate_of(context, s);
      const Context small(2, estimate.smallest_budget);
      set_atoms(small, gas);
      qses_mesh mesh;
      qses_mesh_init(&mesh);
      EXPECT_EQ(qses_compute(small, &s, &mesh), QSES_OK) << count << ": " << qses_last_error();
    }
  }
}

// What is 50,000 Å away takes no light, whatever it does to the tables.
TEST(Occlusion, IsNotChangedByAStrayAtom) {
  Atoms atoms = cluster(150, 8);
  const Lit near_by = light(atoms, settings());
  atoms.add(50000, 0, 0, 1.5);
  const Lit with_stray = light(atoms, settings());
  std::vector<float> openness;
  for (size_t v = 0; v < with_stray.openness.size(); ++v)
    if (with_stray.surface.mesh.owners[v] < 150) openness.push_back(with_stray.openness[v]);
  EXPECT_NEAR(mean(openness), mean(near_by.openness), 0.01);
}

// All levels of a job have it, and a frame that is like the one before.
TEST(Occlusion, ComesWithEveryLevelAndFrame) {
  Atoms atoms = cluster(150, 2);
  const Context context;
  set_atoms(context, atoms);
  const qses_settings s = lit(settings());
  for (int frame = 0; frame < 3; ++frame) {
    expect_ok(qses_begin(context, &s));
    expect_ok(qses_wait(context, -1, nullptr));
    qses_mesh m;
    qses_mesh_init(&m);
    expect_ok(qses_collect(context, &m));
    const std::vector<float> alone = light(atoms, settings()).openness;
    ASSERT_EQ(m.vertex_count, alone.size());
    for (uint32_t v = 0; v < m.vertex_count; ++v) ASSERT_EQ(m.texcoords[2 * v], alone[v]) << frame;
    for (float &x : atoms.positions) x += 0.03f;
    expect_ok(qses_set_positions(context, atoms.positions.data(), 0, atoms.size()));
  }
}
