// SPDX-License-Identifier: MIT
// The same input gives the same bytes, whatever the number of threads, the slices or the calls before; and the order of
// the atoms and the processor's instruction set do not change the surface.
#include "surface/exact_fixture.h"
#include "surface/surface_checks.h"

#include <algorithm>
#include <cfenv>
#include <cstring>
#include <map>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace {

using namespace surface_checks;

struct Case {
  const char *name;
  Atoms atoms;
  qses_settings settings;
};

std::vector<Case> cases() {
  const Atoms molecule = cluster(400, 21);
  std::vector<Case> all = {{"SES", molecule, settings()},
                           {"SAS", molecule, settings(0.5, 1.4, QSES_SURFACE_SAS)},
                           {"VDW", molecule, settings(0.5, 1.4, QSES_SURFACE_VDW)},
                           {"three steps", molecule, settings()},
                           {"coarse", molecule, settings(3.0, 1.0)},
                           {"grid", molecule, settings()},
                           {"stray", molecule, settings()}};
  for (Case &c : all) c.settings.patch_types = 1;
  all[3].settings.relaxation_steps = 3;
  all[5].settings.method = QSES_METHOD_GRID;
  all[5].settings.patch_types = 0;
  all[6].atoms.add(9000, 0, -7000, 1.5);
  return all;
}

TEST(SameBytes, OfRepeatedCalls) {
  for (const Case &c : cases()) {
    SCOPED_TRACE(c.name);
    const Context context;
    const Surface first = compute(context, c.atoms, c.settings);
    ASSERT_GT(first.vertex_count(), 200u);
    expect_same_bytes(first, compute(context, c.atoms, c.settings));
    // Something else in between: larger, then nothing.
    compute(context, cluster(700, 22), settings(0.4));
    compute(context, Atoms(), settings());
    expect_same_bytes(first, compute(context, c.atoms, c.settings));
    expect_same_bytes(first, compute(c.atoms, c.settings));
  }
}

TEST(SameBytes, WithAnyNumberOfThreads) {
  for (const Case &c : cases()) {
    SCOPED_TRACE(c.name);
    const Surface one = compute(c.atoms, c.settings, 1);
    for (unsigned threads : {2u, 4u, 7u}) {
      SCOPED_TRACE(threads);
      const Context context(threads);
      for (int repeat = 0; repeat < 3; ++repeat) expect_same_bytes(one, compute(context, c.atoms, c.settings));
    }
  }
}

TEST(SameBytes, OfJobs) {
  const std::vector<std::vector<float>> ladders = {{}, {2, 1}, {1.5f, 0.7f}, {4, 2, 1, 0.6f}, {3}};
  for (Case &c : cases()) {
    // Away from the origin, where a frame of its own would show.
    const Atoms atoms = shifted(c.atoms, 31.7, -103.3, 57.9);
    for (const std::vector<float> &ladder : ladders) {
      SCOPED_TRACE(testing::Message() << c.name << ", levels: " << ladder.size());
      std::copy(ladder.begin(), ladder.end(), c.settings.levels);
      c.settings.level_count = static_cast<uint32_t>(ladder.size());
      const Context context;
      const Surface alone = compute(context, atoms, c.settings);
      ASSERT_GT(alone.vertex_count(), 200u);
      expect_same_bytes(finest_of_job(context, atoms, c.settings), alone);
    }
  }
}

// A frame budget that nothing fits gives the coarsest level: that of the ladder, and of a computation of its own.
TEST(SameBytes, OfLevelsThatAreChosen) {
  const Atoms atoms = shifted(cluster(400, 21), 31.7, -103.3, 57.9);
  const Context context;
  qses_settings s = settings(0.5);
  s.frame_budget_ms = 0.001f;
  const Surface chosen = finest_of_job(context, atoms, s);
  s.frame_budget_ms = 0;
  s.spacing = 2;
  ASSERT_GT(chosen.vertex_count(), 200u);
  expect_same_bytes(chosen, compute(context, atoms, s));
}

// The environment of the calling thread, put back at the end.
class CallersFloats {
 public:
  explicit CallersFloats(int rounding, bool flush) {
    std::fegetenv(&before_);
    std::fesetround(rounding);
#if defined(__SSE2__)
    if (flush) _mm_setcsr(_mm_getcsr() | 0x8040);  // denormals are taken for zero, and made zero
#else
    (void)flush;
#endif
  }
  ~CallersFloats() { std::fesetenv(&before_); }
  CallersFloats(const CallersFloats &) = delete;
  CallersFloats &operator=(const CallersFloats &) = delete;

 private:
  std::fenv_t before_;
};

unsigned float_mode() {
#if defined(__SSE2__)
  return _mm_getcsr() & ~0x3fu;  // without the flags of what has happened
#else
  return 0;
#endif
}

TEST(SameBytes, InAnyRoundingMode) {
  for (Case &c : cases()) {
    SCOPED_TRACE(c.name);
    c.settings.components = 1;
    const Surface usual = compute(c.atoms, c.settings);
    const Surface alone = compute(c.atoms, c.settings, 1);
    struct Mode {
      int rounding;
      bool flush;
    };
    for (const Mode &mode :
         {Mode{FE_UPWARD, false}, Mode{FE_DOWNWARD, true}, Mode{FE_TOWARDZERO, false}, Mode{FE_TONEAREST, true}}) {
      SCOPED_TRACE(mode.rounding);
      const CallersFloats floats(mode.rounding, mode.flush);
      const unsigned before = float_mode();
      // Threads of the library that are started now take over what they find.
      const Context context(4), one(1);
      expect_same_bytes(compute(context, c.atoms, c.settings), usual);
      expect_same_bytes(compute(one, c.atoms, c.settings), alone);
      expect_same_bytes(finest_of_job(context, c.atoms, c.settings), usual);
      EXPECT_EQ(std::fegetround(), mode.rounding);
      EXPECT_EQ(float_mode(), before);
    }
  }
}

TEST(SameBytes, InSlices) {
  for (const Case &c : cases()) {
    SCOPED_TRACE(c.name);
    const Surface whole = compute(c.atoms, c.settings);
    EXPECT_EQ(whole.report.slice_count, 1u);
    for (uint32_t slice : {8u, 16u, 37u, 64u}) {
      SCOPED_TRACE(slice);
      qses_settings s = c.settings;
      s.slice_size = slice;
      const Surface sliced = compute(c.atoms, s);
      expect_same_bytes(whole, sliced);
      EXPECT_EQ(sliced.report.brick_count, whole.report.brick_count);
      const uint64_t bricks = std::max<uint64_t>(1, uint64_t(slice) * slice * slice / 512);
      EXPECT_EQ(sliced.report.slice_count, (whole.report.brick_count + bricks - 1) / bricks);
    }
  }
}

TEST(SameBytes, WithAProgressCallback) {
  for (const Case &c : cases()) {
    SCOPED_TRACE(c.name);
    const Context context;
    int calls = 0;
    ASSERT_EQ(qses_set_progress_callback(
                  context, [](void *n, double) { ++*static_cast<int *>(n); }, &calls),
              QSES_OK);
    expect_same_bytes(compute(c.atoms, c.settings), compute(context, c.atoms, c.settings));
    EXPECT_GT(calls, 0);
  }
}

TEST(SameBytes, WithStageTimesAndWithoutMeasures) {
  const Case c = cases()[0];
  const Surface plain = compute(c.atoms, c.settings);
  const Context context;
  ASSERT_EQ(qses_set_stage_times(context, 1), QSES_OK);
  expect_same_bytes(plain, compute(context, c.atoms, c.settings));
  qses_settings s = c.settings;
  s.measure = 0;
  Surface unmeasured = compute(context, c.atoms, s);
  EXPECT_EQ(unmeasured.report.area, 0);
  EXPECT_EQ(unmeasured.report.volume, 0);
  unmeasured.report = plain.report;
  expect_same_bytes(plain, unmeasured);
}

TEST(SameBytes, WithAMemoryBudget) {
  const Case c = cases()[0];
  const Surface plain = compute(c.atoms, c.settings);
  // Half as much again as was needed at most.
  const Context context(2, plain.report.work_bytes_peak * 3 / 2 + (uint64_t(1) << 20));
  expect_same_bytes(plain, compute(context, c.atoms, c.settings));
  expect_same_bytes(plain, compute(context, c.atoms, c.settings));
}

// ---- the order of the atoms

// Vertices of both meshes with the same signs on the lattice are the same up to rounding; their numbers depend on the
// lattice only.
TEST(OrderOfAtoms, DoesNotMatter) {
  for (const Atoms &atoms : {cluster(300, 23), crambin()}) {
    std::vector<size_t> order(atoms.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), std::mt19937(7));
    Atoms shuffled;
    for (size_t i : order) {
      const auto c = atoms.center(i);
      shuffled.add(c[0], c[1], c[2], static_cast<double>(atoms.radii[i]));
    }
    for (qses_surface kind : {QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW}) {
      const Surface a = compute(atoms, settings(0.5, 1.4, kind)), b = compute(shuffled, settings(0.5, 1.4, kind));
      ASSERT_EQ(a.vertex_count(), b.vertex_count());
      EXPECT_EQ(a.mesh.indices, b.mesh.indices);
      size_t moved = 0, other_owner = 0;
      for (size_t v = 0; v < a.vertex_count(); ++v) {
        const Point x = point(a.mesh.position(v)), y = point(b.mesh.position(v));
        moved += exact_reference::length(x - y) > 1e-4 ? 1 : 0;
        const size_t i = a.mesh.owners[v], j = order[b.mesh.owners[v]];
        if (i == j) continue;
        ++other_owner;
        const double of_i = exact_reference::length(x - point(atoms.center(i))) - static_cast<double>(atoms.radii[i]);
        const double of_j = exact_reference::length(x - point(atoms.center(j))) - static_cast<double>(atoms.radii[j]);
        ASSERT_NEAR(of_i, of_j, 1e-4);
      }
      // A start on a bisector of two places may go either way.
      EXPECT_LE(moved, a.vertex_count() / 1000);
      EXPECT_LE(other_owner, a.vertex_count() / 200);
    }
  }
}

// ---- the instruction sets

TEST(InstructionSets, GiveTheSameSurface) {
  using exact_fixture::ExactRun;
  using quickses::cpu_kernels;
  const quickses::CpuKernels &base_kernels = *quickses::usable_cpu_kernels()[0];
  if (&base_kernels == &cpu_kernels()) GTEST_SKIP() << "this processor or build has one set of kernels only";
  for (const Atoms &atoms : {cluster(300, 24), crambin()})
    for (qses_surface kind : {QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW}) {
      SCOPED_TRACE(testing::Message() << atoms.size() << " atoms, surface " << kind);
      const qses_settings s = settings(0.5, 1.4, kind);
      ExactRun base_run(atoms, s, 2, base_kernels), best_run(atoms, s, 2, cpu_kernels());
      Surface base, best;
      base.mesh = base_run.mesh();
      best.mesh = best_run.mesh();
      const auto count = [](size_t n) { return static_cast<double>(n); };
      EXPECT_NEAR(count(base.vertex_count()), count(best.vertex_count()), 12);
      EXPECT_NEAR(count(base.mesh.triangle_count()), count(best.mesh.triangle_count()), 24);
      const Boundary boundary(atoms, boundary_probe(s));
      for (const Surface *f : {&base, &best}) {
        check_connection(f->mesh);
        check_owners(atoms, f->mesh, {});
        check_distances(s, f->mesh, boundary, {});
        check_normals(atoms, s, *f, boundary, {});
      }
      // Most vertices are the same ones.
      std::map<std::array<long, 3>, size_t> places;
      const auto key = [](const std::array<double, 3> &p, double grid) {
        return std::array<long, 3>{std::lround(p[0] / grid), std::lround(p[1] / grid), std::lround(p[2] / grid)};
      };
      for (size_t v = 0; v < base.vertex_count(); ++v) ++places[key(base.mesh.position(v), 0.01)];
      size_t found = 0;
      for (size_t v = 0; v < best.vertex_count(); ++v) found += places.count(key(best.mesh.position(v), 0.01));
      EXPECT_GT(found, best.vertex_count() * 99 / 100);
    }
}

// However many points they take at a time, what is near each of them decides about it; and in lattices, where many
// balls meet in a point, rounding does, the same way.
TEST(InstructionSets, NewerOnesGiveTheSameBytes) {
  using exact_fixture::ExactRun;
  const auto sets = quickses::usable_cpu_kernels();
  if (sets.size < 3) GTEST_SKIP() << "this processor or build has no set of kernels beyond AVX2";
  for (const Atoms &atoms :
       {cluster(300, 24), cluster(120, 7), crambin(), lattice(4, 3.95, 1.7), lattice(4, 4, 1.9), lattice(3, 4.6, 1.9)})
    for (qses_surface kind : {QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW})
      for (double spacing : {0.35, 0.5, 1.3, 3.0})
        for (double probe : {0.4, 1.4, 4.0}) {
          if (kind == QSES_SURFACE_VDW && probe != 1.4) continue;
          const qses_settings s = settings(spacing, probe, kind);
          ExactRun avx2_run(atoms, s, 2, *sets[1]);
          const mesh_checks::Mesh avx2 = avx2_run.mesh();
          for (size_t k = 2; k < sets.size; ++k) {
            SCOPED_TRACE(testing::Message() << sets[k]->name << ", " << atoms.size() << " atoms, surface " << kind
                                            << ", spacing " << spacing << ", probe " << probe);
            ExactRun run(atoms, s, 2, *sets[k]);
            const mesh_checks::Mesh mesh = run.mesh();
            ASSERT_EQ(mesh.indices, avx2.indices);
            ASSERT_EQ(mesh.positions, avx2.positions);
            ASSERT_EQ(mesh.normals, avx2.normals);
            ASSERT_EQ(mesh.owners, avx2.owners);
          }
        }
}

}  // namespace
