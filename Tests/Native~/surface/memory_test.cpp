// SPDX-License-Identifier: MIT
// Memory budgets and estimates through the C API.
#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

#include <cstring>
#if defined(__linux__)
#include <malloc.h>
#endif

using namespace surface_fixture;

namespace {

// Copies of crambin side by side, some of them in contact.
Atoms crambins(int count) {
  const Atoms one = crambin();
  Atoms all;
  for (int k = 0; k < count; ++k) {
    const Atoms copy = k % 2 ? turned(one) : one;
    const Atoms at = shifted(copy, 24.0 * (k % 3), 22.0 * (k / 3 % 3), 31.0 * (k / 9));
    for (size_t i = 0; i < at.size(); ++i) {
      const auto c = at.center(i);
      all.add(c[0], c[1], c[2], static_cast<double>(at.radii[i]));
    }
  }
  return all;
}

void expect_close(uint64_t predicted, uint64_t actual, const std::string &what) {
  EXPECT_GE(static_cast<double>(predicted), 0.9 * static_cast<double>(actual)) << what;
  EXPECT_LE(static_cast<double>(predicted), 1.25 * static_cast<double>(actual)) << what;
}

struct Case {
  std::string name;
  Atoms atoms;
  qses_settings settings;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  const Atoms one = crambin(), many = crambins(12);
  const auto add = [&](const std::string &name, const Atoms &atoms, qses_settings s) {
    all.push_back({name, atoms, s});
  };
  add("one", one, settings(0.5));
  add("fine", one, settings(0.15));
  add("coarse", many, settings(2.0));
  add("many", many, settings(0.5));
  add("many, fine", many, settings(0.3));
  add("sas", many, settings(0.4, 1.4, QSES_SURFACE_SAS));
  add("wide probe", many, settings(0.5, 4.0));
  add("very wide probe", one, settings(0.4, 12.0));
  add("vdw", many, settings(0.4, 1.4, QSES_SURFACE_VDW));
  qses_settings s = settings(0.4);
  s.relaxation_steps = 3;
  add("relaxed", many, s);
  s = settings(0.4);
  s.vertex_layout = QSES_VERTICES_INTERLEAVED;
  s.texcoords = 1;
  s.patch_types = 1;
  add("all attributes", many, s);
  s.vertex_layout = QSES_VERTICES_COMPACT;
  s.relaxation_steps = 3;
  add("compact, relaxed", many, s);
  s = settings(0.4);
  s.components = 1;
  add("components", many, s);
  s.relaxation_steps = 3;
  add("components, relaxed", one, s);
  for (const qses_surface surface : {QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW})
    for (const double spacing : {0.3, 0.5, 1.0, 2.0}) {
      s = settings(spacing, 1.4, surface);
      s.creases = 1;
      const std::string name = " of surface " + std::to_string(surface) + " at " + std::to_string(spacing);
      add("creases" + name, spacing < 1 ? one : many, s);
      s.hard_edges = 1;
      add("hard edges" + name, one, s);
    }
  // Few atoms that a probe fits between have more creases than many that touch.
  const std::pair<std::string, Atoms> thin[] = {{"alpha carbons", alpha_carbons()},
                                                {"40 Å³", sparse(300, 40, 1)},
                                                {"64 Å³", sparse(300, 64, 2)},
                                                {"200 Å³", sparse(200, 200, 3)}};
  for (const auto &[name, atoms] : thin)
    for (const auto &[spacing, probe] : {std::pair(0.25, 1.4), {0.5, 1.4}, {0.5, 0.7}, {0.5, 3.0}}) {
      s = settings(spacing, probe);
      s.creases = 1;
      s.hard_edges = probe == 1.4;
      add("creases of " + name + " at " + std::to_string(spacing) + ", probe " + std::to_string(probe), atoms, s);
    }
  s = settings(0.5);
  s.method = QSES_METHOD_GRID;
  add("grid", many, s);
  const Atoms few = cluster(20, 1);
  add("few atoms, huge probe", few, settings(0.25, 28));
  s = settings(0.4, 28);
  s.method = QSES_METHOD_GRID;
  add("few atoms, huge probe, grid", few, s);
  return all;
}

// The views compare equal, byte for byte, in everything but where they are.
void expect_same_bytes(const qses_mesh &a, const qses_mesh &b, const std::string &what) {
  ASSERT_EQ(a.vertex_count, b.vertex_count) << what;
  ASSERT_EQ(a.triangle_count, b.triangle_count) << what;
  ASSERT_EQ(a.vertex_bytes, b.vertex_bytes) << what;
  const size_t v = a.vertex_count, t = a.triangle_count;
  const auto same = [&](const void *p, const void *q, size_t bytes) {
    ASSERT_EQ(p == nullptr, q == nullptr) << what;
    if (p) {
      ASSERT_EQ(std::memcmp(p, q, bytes), 0) << what;
    }
  };
  if (a.vertex_bytes) {
    same(a.positions, b.positions, v * a.vertex_bytes);
  } else {
    same(a.positions, b.positions, 12 * v);
    same(a.normals, b.normals, 12 * v);
  }
  same(a.colors, b.colors, 4 * v);
  same(a.texcoords, b.texcoords, 8 * v);
  same(a.owners, b.owners, 4 * v);
  same(a.patches, b.patches, v);
  same(a.indices, b.indices, 12 * t);
  for (int d = 0; d < 3; ++d) {
    EXPECT_EQ(a.bounds_min[d], b.bounds_min[d]) << what;
    EXPECT_EQ(a.bounds_max[d], b.bounds_max[d]) << what;
  }
}

}  // namespace

TEST(Estimate, IsNearTheTruth) {
  const Context context;
  for (const Case &c : cases()) {
    set_atoms(context, c.atoms);
    const qses_size_estimate e = estimate_of(context, c.settings);
    const qses_mesh mesh = compute_view(context, c.settings);
    const qses_report report = report_of(context);
    expect_close(e.vertices, mesh.vertex_count, c.name + ": vertices");
    expect_close(e.triangles, mesh.triangle_count, c.name + ": triangles");
    expect_close(e.mesh_bytes, report.mesh_bytes, c.name + ": mesh");
    expect_close(e.work_bytes, report.work_bytes_peak, c.name + ": work");
    EXPECT_EQ(e.fits, 1) << c.name;
    // The same again now that memory is there; only the scratch of crowded bricks is known better.
    expect_close(e.smallest_budget, estimate_of(context, c.settings).smallest_budget, c.name + ": budget");
    compute_view(context, c.settings);
    // A GPU's further frames do not wait for their counts: they take room for a sixteenth more of each, and for 64
    // bricks and leaves at least, of some 30 KB each at 2 Å.
    const double spare = tested_backend() == QSES_BACKEND_CPU ? 0 : 64 * 30e3;
    const double first = static_cast<double>(report.work_bytes_peak),
                 again = static_cast<double>(report_of(context).work_bytes_peak);
    EXPECT_GE(again, 0.9 * first) << c.name << ": work, again";
    EXPECT_LE(again, 1.25 * first + spare) << c.name << ": work, again";
  }
}

TEST(Estimate, AfterACancelledJob) {
  const Context context;
  set_atoms(context, crambins(12));
  const qses_settings s = settings(0.2);
  const qses_size_estimate before = estimate_of(context, s);
  for (int trial = 0; trial < 3; ++trial) {
    expect_ok(qses_begin(context, &s));
    expect_ok(qses_cancel(context));
    EXPECT_EQ(estimate_of(context, s).vertices, before.vertices);
  }
}

TEST(Estimate, LeavesTheLastMeshInPlace) {
  const Context context;
  set_atoms(context, crambin());
  const qses_mesh before = compute_view(context, settings(0.7));
  const std::vector<float> positions(before.positions, before.positions + 3 * size_t(before.vertex_count));
  estimate_of(context, settings(0.3));
  qses_mesh after;
  qses_mesh_init(&after);
  expect_ok(qses_context_mesh(context, &after));
  ASSERT_EQ(after.vertex_count, before.vertex_count);
  EXPECT_EQ(std::memcmp(after.positions, positions.data(), 4 * positions.size()), 0);
}

TEST(Estimate, CountsColors) {
  const Context context;
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  const qses_size_estimate plain = estimate_of(context, settings(0.5));
  const std::vector<uint8_t> colors(4 * atoms.size(), 200);
  expect_ok(qses_set_colors(context, colors.data(), atoms.size()));
  const qses_size_estimate colored = estimate_of(context, settings(0.5));
  EXPECT_EQ(colored.vertices, plain.vertices);
  EXPECT_GE(colored.mesh_bytes, plain.mesh_bytes + 4 * plain.vertices);
  const qses_mesh mesh = compute_view(context, settings(0.5));
  ASSERT_EQ(mesh.vertex_count, colored.vertices) << "so small a mesh is counted";
  EXPECT_EQ(report_of(context).mesh_bytes, colored.mesh_bytes);
}

TEST(Estimate, OfNothingIsNothing) {
  const Context context;
  qses_size_estimate e;
  qses_size_estimate_init(&e);
  EXPECT_EQ(qses_estimate(context, nullptr, &e), QSES_NO_ATOMS);
  expect_ok(qses_set_atoms(context, nullptr, 0, nullptr, 0));
  expect_ok(qses_estimate(context, nullptr, &e));
  EXPECT_EQ(e.vertices, 0u);
  EXPECT_EQ(e.mesh_bytes, 0u);
  EXPECT_EQ(e.fits, 1);
}

TEST(Budget, TheSmallestWorksAndGivesTheSameBytes) {
  const Context unbounded;
  for (const Case &c : cases()) {
    set_atoms(unbounded, c.atoms);
    const uint64_t smallest = estimate_of(unbounded, c.settings).smallest_budget;
    const qses_mesh expected = compute_view(unbounded, c.settings);
    const qses_report whole = report_of(unbounded);
    for (const uint64_t budget : {smallest, smallest + smallest / 4, 3 * smallest}) {
      const std::string what = c.name + ": " + std::to_string(budget) + " bytes";
      const Context context(2, budget);
      set_atoms(context, c.atoms);
      EXPECT_EQ(estimate_of(context, c.settings).fits, 1) << what;
      // Twice: the second time all memory is there.
      for (int round = 0; round < 2; ++round) {
        qses_mesh mesh;
        qses_mesh_init(&mesh);
        ASSERT_EQ(qses_compute(context, &c.settings, &mesh), QSES_OK) << what << ": " << qses_last_error();
        expect_same_bytes(mesh, expected, what);
      }
      const qses_report report = report_of(context);
      EXPECT_LE(report.work_bytes_peak, budget) << what;
      EXPECT_EQ(report.area, whole.area) << what;
      EXPECT_EQ(report.volume, whole.volume) << what;
    }
  }
}

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// Bytes that the process has from malloc. Contexts keep what they took, so it tells their peak.
uint64_t heap_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

TEST(Budget, IsKeptByTheHeap) {
  if (tested_backend() != QSES_BACKEND_CPU) GTEST_SKIP() << "the budget is of the device";
  for (const Case &c : cases()) {
    const Context unbounded(2);
    set_atoms(unbounded, c.atoms);
    const uint64_t budget = estimate_of(unbounded, c.settings).smallest_budget * 5 / 4;
    const uint64_t before = heap_bytes();
    const Context context(2, budget);
    set_atoms(context, c.atoms);
    for (int round = 0; round < 2; ++round) compute_view(context, c.settings);
    const qses_report report = report_of(context);
    const uint64_t beside = report.host_bytes_peak - report.work_bytes_peak;  // atoms and mesh
    constexpr uint64_t kHandles = 65536;
    EXPECT_LE(heap_bytes() - before, budget + beside + kHandles) << c.name;
  }
}
#endif

TEST(Budget, TheEstimateKnowsIt) {
  const Atoms atoms = crambins(12);
  const Context unbounded;
  set_atoms(unbounded, atoms);
  const uint64_t smallest = estimate_of(unbounded, settings(0.4)).smallest_budget;
  const Context context(2, smallest + smallest / 8);
  set_atoms(context, atoms);
  const qses_size_estimate e = estimate_of(context, settings(0.4));
  EXPECT_EQ(e.fits, 1);
  expect_close(e.smallest_budget, smallest, "smallest budget");
  compute_view(context, settings(0.4));
  expect_close(e.work_bytes, report_of(context).work_bytes_peak, "work");
}

// What can't be done is not said to fit, whether it is memory or numbers that are lacking.
TEST(Estimate, WithoutABudgetKnowsWhatTheMachineHas) {
  const Context context;
  set_atoms(context, crambins(12));
  EXPECT_EQ(estimate_of(context, settings(0.5)).fits, 1);
  EXPECT_EQ(estimate_of(context, settings(0.002)).fits, 0);
  Atoms apart;
  for (int k = 0; k < 400; ++k) apart.add(10.0 * (k % 20), 10.0 * (k / 20), 0, 1.7);
  set_atoms(context, apart);
  const qses_size_estimate e = estimate_of(context, settings(0.002, 1.4, QSES_SURFACE_VDW));
  EXPECT_GT(e.triangles, uint64_t(0xffffffff));
  EXPECT_EQ(e.fits, 0);
}

// Beads of coarse-grained models have more of the box around them to look into than atoms have.
TEST(Budget, OfOcclusionKnowsLargeBeads) {
  for (const double radius : {1.7, 5.0, 10.0, 20.0, 50.0}) {
    SCOPED_TRACE(radius);
    Atoms beads;
    for (int k = 0; k < 30; ++k) beads.add(1.5 * radius * (k % 5), 1.5 * radius * (k / 5), 0.1 * k, radius);
    qses_settings s = settings(0.25 * radius);
    s.occlusion = 1;
    const Context unbounded;
    set_atoms(unbounded, beads);
    const qses_size_estimate e = estimate_of(unbounded, s);
    compute_view(unbounded, s);
    EXPECT_GE(static_cast<double>(e.work_bytes), 0.9 * static_cast<double>(report_of(unbounded).work_bytes_peak));
    const Context context(2, e.smallest_budget);
    set_atoms(context, beads);
    EXPECT_EQ(qses_compute(context, &s, nullptr), QSES_OK) << qses_last_error();
  }
}

// Bytes that a refusal names.
double named_budget(const std::string &message) {
  const size_t about = message.find("about ");
  char unit = 0;
  double value = 0;
  if (about == std::string::npos || std::sscanf(message.c_str() + about, "about %lf %ciB", &value, &unit) != 2)
    ADD_FAILURE() << message;
  return value * (unit == 'K' ? 1024.0 : unit == 'M' ? 1048576.0 : 1073741824.0);
}

// After a refusal: does what it names do? A guess ("may") comes nearer with each try, until it is counted ("would").
bool follow_refusals(const Case &c, double *named, std::string *messages) {
  bool fits = false, was_guess = true;
  for (int tries = 0; tries < 4 && !fits && was_guess; ++tries) {
    const std::string message = qses_last_error();
    *messages += "\n" + message;
    *named = named_budget(message);
    was_guess = message.find("may do") != std::string::npos;
    const Context enough(2, static_cast<uint64_t>(*named));
    set_atoms(enough, c.atoms);
    fits = qses_compute(enough, &c.settings, nullptr) == QSES_OK;
  }
  return fits;
}

TEST(Budget, TooSmallIsRefusedWithOneThatWouldDo) {
  const Context unbounded;
  for (const Case &c : cases()) {
    set_atoms(unbounded, c.atoms);
    const uint64_t smallest = estimate_of(unbounded, c.settings).smallest_budget;
    for (const uint64_t budget : {uint64_t(1), smallest / 3, smallest / 3 * 2}) {
      const std::string what = c.name + ": " + std::to_string(budget) + " bytes of " + std::to_string(smallest);
      const Context context(2, budget);
      set_atoms(context, c.atoms);
      const qses_status status = qses_compute(context, &c.settings, nullptr);
      if (budget > smallest / 2 && status == QSES_OK) continue;  // it is only promised that the smallest works
      ASSERT_EQ(status, QSES_OUT_OF_MEMORY) << what;
      std::string messages;
      double named = 0;
      const bool fits = follow_refusals(c, &named, &messages);
      EXPECT_TRUE(fits) << what << ":" << messages << "\n" << qses_last_error();
      // What is known by then tells more where the budget is nearly enough.
      EXPECT_LE(named, (budget > smallest / 2 ? 2.0 : 3.0) * static_cast<double>(smallest) + 1e6)
          << what << ":" << messages;
      // The context that refused still works on something smaller.
      if (budget < 1000000) continue;
      Atoms atom;
      atom.add(0, 0, 0, 1.7);
      set_atoms(context, atom);
      EXPECT_EQ(qses_compute(context, nullptr, nullptr), QSES_OK) << what << ": " << qses_last_error();
    }
  }
}

// With many creases for its size.
Atoms creased_sheet() {
  Atoms sheet;
  for (int k = 0; k < 120; ++k) sheet.add(3.4 * (k % 12), 4.8 * (k / 12), 0, 1.7);
  return sheet;
}

// Room that a frame takes which knows how many splits there are: the first one lacks it behind its mesh, and is made
// again, as a whole.
TEST(Budget, OfAFrameThatKnowsItsSplitsDoesForTheFirst) {
  if (tested_backend() != QSES_BACKEND_CPU) GTEST_SKIP() << "a GPU takes room for frames that follow";
  for (const double spacing : {0.5, 1.0}) {
    SCOPED_TRACE(spacing);
    qses_settings s = settings(spacing);
    s.creases = 1;
    const Context unbounded(2);
    set_atoms(unbounded, creased_sheet());
    compute_view(unbounded, s);
    const qses_mesh expected = compute_view(unbounded, s);
    const uint64_t peak = report_of(unbounded).work_bytes_peak;
    const Context bounded(2, peak + peak / 20);
    set_atoms(bounded, creased_sheet());
    expect_same_bytes(compute_view(bounded, s), expected, "sheet");
    EXPECT_EQ(report_of(bounded).attempts, 2u);
    EXPECT_EQ(report_of(bounded).slice_count, 1u);
  }
}

// How much creases add to flat, regular or isolated atoms is a guess, until such a surface was made.
TEST(Budget, WhatCreasesAddIsKnownOnceItWasFound) {
  Atoms ions;
  for (int k = 0; k < 27; ++k) ions.add(9.0 * (k % 3), 9.0 * (k / 3 % 3), 9.0 * (k / 9), k % 2 ? 1.02 : 1.81);
  for (const auto &[name, atoms] :
       {std::pair<std::string, Atoms>("sheet", creased_sheet()), {"ions", ions}, {"lattice", lattice(6, 4.69, 1.7)}})
    for (const double spacing : {0.5, 1.0}) {
      Case c{name + " at " + std::to_string(spacing), atoms, settings(spacing)};
      c.settings.creases = c.settings.hard_edges = 1;
      const Context unbounded(2);
      set_atoms(unbounded, atoms);
      const qses_mesh expected = compute_view(unbounded, c.settings);
      const uint64_t smallest = estimate_of(unbounded, c.settings).smallest_budget;
      const Context bounded(2, smallest);
      set_atoms(bounded, atoms);
      qses_mesh mesh;
      qses_mesh_init(&mesh);
      ASSERT_EQ(qses_compute(bounded, &c.settings, &mesh), QSES_OK) << c.name << ": " << qses_last_error();
      expect_same_bytes(mesh, expected, c.name);
      EXPECT_LE(report_of(bounded).work_bytes_peak, smallest) << c.name;
      for (const uint64_t budget : {uint64_t(1), smallest / 2}) {
        const Context context(2, budget);
        set_atoms(context, atoms);
        ASSERT_EQ(qses_compute(context, &c.settings, nullptr), QSES_OUT_OF_MEMORY) << c.name;
        std::string messages;
        double named = 0;
        EXPECT_TRUE(follow_refusals(c, &named, &messages)) << c.name << ":" << messages << "\n" << qses_last_error();
      }
    }
}

TEST(Budget, LaddersAndFramesKeepIt) {
  const Atoms atoms = crambins(6);
  const Context unbounded;
  set_atoms(unbounded, atoms);
  const uint64_t budget = estimate_of(unbounded, settings(0.5)).smallest_budget * 5 / 4;
  const Context context(2, budget);
  set_atoms(context, atoms);
  for (int frame = 0; frame < 3; ++frame) {
    const Atoms moved = shifted(atoms, 0.1 * frame, 0, 0);
    expect_ok(qses_set_positions(context, moved.positions.data(), 0, moved.size()));
    const qses_settings s = settings(0.5);
    expect_ok(qses_begin(context, &s));
    expect_ok(qses_wait(context, -1, nullptr));
    qses_mesh mesh;
    qses_mesh_init(&mesh);
    ASSERT_EQ(qses_collect(context, &mesh), QSES_OK);
    EXPECT_EQ(mesh.level, 2u);
    EXPECT_LE(report_of(context).work_bytes_peak, budget);
    const Surface expected = compute(unbounded, moved, s);
    ASSERT_EQ(mesh.vertex_count, expected.vertex_count());
    EXPECT_EQ(std::memcmp(mesh.indices, expected.mesh.indices.data(), 12 * size_t(mesh.triangle_count)), 0);
  }
}
