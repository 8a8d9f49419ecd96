// SPDX-License-Identifier: MIT
// Each level of a ladder is what it is by itself, however the frames before it were, and whether or not the levels are
// made beside each other.
#include "capi/atoms_in.h"
#include "surface/engine.h"
#include "surface/levels.h"
#include "surface/surface_checks.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <iterator>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace {

using namespace surface_checks;

std::unique_ptr<quickses::SurfaceEngine> make_engine(uint64_t memory_budget = 0) {
  const quickses::WorkerThreads threads(2);
#if defined(QUICKSES_HAS_CUDA)
  if (tested_backend() == QSES_BACKEND_CUDA) return quickses::make_cuda_engine(0, threads, memory_budget);
#endif
  return quickses::make_cpu_engine(threads, memory_budget);
}

// Keeps all levels, and may stop the computation when so many of them are finished.
class Levels : public quickses::LevelSink {
 public:
  std::vector<quickses::FinishedMesh> meshes;
  std::vector<double> reached;  // how far the computation was when each of them was finished
  size_t stop_behind = ~size_t(0);
  std::atomic<bool> stop{false};

  // Was more than one of them begun before the first was finished? Memory is given back before that.
  bool were_beside() const { return given_back_ > 1; }

  size_t times_prepared = 0, times_given_back = 0;
  std::vector<double> steps;  // all that it told of how far it was

  void prepared(double) override { ++times_prepared; }
  void give_back() override {
    ++times_given_back;
    if (meshes.empty()) ++given_back_;
  }
  void finished(quickses::FinishedMesh mesh) override {
    meshes.push_back(std::move(mesh));
    reached.push_back(last_);
    if (meshes.size() == stop_behind) stop = true;
  }
  void advance(double fraction) override {
    EXPECT_GE(fraction, last_);
    last_ = fraction;
    steps.push_back(fraction);
  }
  const std::atomic<bool> &stop_flag() const override { return stop; }

 private:
  size_t given_back_ = 0;  // until the first was finished
  double last_ = 0;
};

std::shared_ptr<quickses::AtomSet> atoms_of(quickses::SurfaceEngine &engine, const Atoms &atoms) {
  auto set = engine.make_atoms(atoms.size());
  set->bounds = quickses::copy_atoms(atoms.positions.data(), 0, atoms.radii.data(), atoms.size(), set->atoms, nullptr);
  set->bounds.radii = quickses::check_radii(atoms.radii.data(), atoms.size());
  return set;
}

void compute(quickses::SurfaceEngine &engine, const Atoms &atoms, const qses_settings &s, Levels *levels) {
  const quickses::Levels ladder = quickses::levels_of(s);
  engine.compute(*atoms_of(engine, atoms), quickses::Appearance{}, s, {ladder.spacings, ladder.count}, *levels);
}

template <class T>
void expect_equal(const T *a, const T *b, size_t n, const char *what) {
  ASSERT_EQ(a == nullptr, b == nullptr) << what;
  if (a && n > 0) {
    EXPECT_EQ(std::memcmp(a, b, n * sizeof(T)), 0) << what;
  }
}

void expect_same(const quickses::FinishedMesh &a, const quickses::FinishedMesh &b) {
  const qses_mesh &p = a.on_host, &q = b.on_host;
  ASSERT_EQ(p.vertex_count, q.vertex_count);
  ASSERT_EQ(p.triangle_count, q.triangle_count);
  EXPECT_EQ(p.spacing, q.spacing);
  const size_t v = p.vertex_count;
  if (p.vertex_bytes > 0) {
    expect_equal(reinterpret_cast<const char *>(p.positions), reinterpret_cast<const char *>(q.positions),
                 v * p.vertex_bytes, "vertices");
  } else {
    expect_equal(p.positions, q.positions, 3 * v, "positions");
    expect_equal(p.normals, q.normals, 3 * v, "normals");
    expect_equal(p.owners, q.owners, v, "owners");
    expect_equal(p.component_ids, q.component_ids, v, "component_ids");
  }
  expect_equal(p.indices, q.indices, 3 * size_t(p.triangle_count), "indices");
  ASSERT_EQ(p.component_count, q.component_count);
  for (uint32_t k = 0; k < p.component_count; ++k) EXPECT_EQ(p.components[k].volume, q.components[k].volume);
  ASSERT_EQ(p.atom_count, q.atom_count);
  expect_equal(p.atom_areas, q.atom_areas, p.atom_count, "atom_areas");
  for (int d = 0; d < 3; ++d) {
    EXPECT_EQ(p.bounds_min[d], q.bounds_min[d]);
    EXPECT_EQ(p.bounds_max[d], q.bounds_max[d]);
  }
  const qses_report &r = a.report, &s = b.report;
  EXPECT_EQ(r.area, s.area);
  EXPECT_EQ(r.volume, s.volume);
  EXPECT_EQ(r.triangle_area, s.triangle_area);
  EXPECT_EQ(r.brick_count, s.brick_count);
  EXPECT_EQ(r.unplaced_vertices, s.unplaced_vertices);
  EXPECT_EQ(r.mesh_bytes, s.mesh_bytes);
  EXPECT_EQ(r.measured_by, s.measured_by);
}

// The levels as a first frame has them: one after the other. They are made where they are not there yet.
using Alone = std::vector<quickses::FinishedMesh>;
void expect_as_by_themselves(const Levels &found, const Atoms &atoms, const qses_settings &s, Alone *alone) {
  if (alone->empty()) {
    Levels levels;
    compute(*make_engine(), atoms, s, &levels);
    EXPECT_FALSE(levels.were_beside());
    *alone = std::move(levels.meshes);
  }
  ASSERT_LE(found.meshes.size(), alone->size());
  for (size_t k = 0; k < found.meshes.size(); ++k) {
    SCOPED_TRACE("level " + std::to_string(k));
    expect_same(found.meshes[k], (*alone)[k]);
  }
}

using Change = void (*)(qses_settings *);
const Change kChanges[] = {
    [](qses_settings *) {},
    [](qses_settings *s) { s->measure = 0; },
    [](qses_settings *s) { s->relaxation_steps = 3; },
    [](qses_settings *s) { s->creases = 1; },
    [](qses_settings *s) { s->hard_edges = 1; },
    [](qses_settings *s) { s->components = s->component_ids = 1; },
    [](qses_settings *s) { s->atom_areas = 1; },
    [](qses_settings *s) { s->pickable = 1; },
    [](qses_settings *s) { s->outer_only = 1; },
    [](qses_settings *s) { s->occlusion = 1; },
    [](qses_settings *s) { s->vertex_layout = QSES_VERTICES_INTERLEAVED; },
    [](qses_settings *s) { s->vertex_layout = QSES_VERTICES_COMPACT; },
    [](qses_settings *s) { s->surface = QSES_SURFACE_SAS; },
    [](qses_settings *s) { s->method = QSES_METHOD_GRID; },
    [](qses_settings *s) {
      s->level_count = 4;
      const float levels[] = {3.f, 2.f, 1.5f, 0.8f};
      std::copy(levels, levels + 4, s->levels);
    },
};

// However long they take.
class LadderLevels : public testing::Test {
 protected:
  void SetUp() override { quickses::short_ladder = 1e9; }
  void TearDown() override {
    quickses::short_ladder = usual_;
    quickses::first_alone = usual_first_;
  }
  static void let_first_go_alone(bool alone) { quickses::first_alone = alone ? 0 : 1e9; }

 private:
  const double usual_ = quickses::short_ladder, usual_first_ = quickses::first_alone;
};

TEST_F(LadderLevels, AreAsByThemselves) {
  const Atoms molecule = cluster(400, 5);
  size_t beside = 0;
  for (size_t k = 0; k < std::size(kChanges); ++k) {
    SCOPED_TRACE("change " + std::to_string(k));
    let_first_go_alone(k % 2 != 0);
    qses_settings s = settings();
    kChanges[k](&s);
    const auto engine = make_engine();
    std::map<double, Alone> alone;
    for (const double factor : {1.0, 1.0, 1.0, 1.0, 1.003, 1.01, 2.5, 2.5, 0.02, 1.0, 1.0, 1.0}) {
      SCOPED_TRACE("factor " + std::to_string(factor));
      const Atoms atoms = scaled(molecule, factor);
      Levels levels;
      compute(*engine, atoms, s, &levels);
      EXPECT_EQ(levels.meshes.size(), quickses::levels_of(s).count);
      beside += levels.were_beside() ? 1 : 0;
      expect_as_by_themselves(levels, atoms, s, &alone[factor]);
    }
  }
  if (tested_backend() == QSES_BACKEND_CUDA) {
    EXPECT_GT(beside, 60u);
  }
}

// The finest goes out slab by slab, and attends to the others meanwhile; also when they are given up in the midst of
// it.
TEST_F(LadderLevels, BesideAFinestOneInSlabs) {
  if (tested_backend() != QSES_BACKEND_CUDA) GTEST_SKIP() << "a CPU makes no slabs";
  const Atoms atoms = cluster(6000, 8);
  const qses_settings s = settings(0.11);  // more than a million vertices
  for (bool first_alone : {true, false}) {
    SCOPED_TRACE(first_alone);
    let_first_go_alone(first_alone);
    const auto engine = make_engine();
    Alone alone;
    size_t in_slabs = 0;
    for (int frame = 0; frame < 8; ++frame) {
      Levels levels;
      if (frame >= 4) levels.stop_behind = static_cast<size_t>(frame) % 2 + 1;
      try {
        compute(*engine, atoms, s, &levels);
        EXPECT_LT(frame, 4);
      } catch (const quickses::Cancelled &) {
        EXPECT_EQ(levels.meshes.size(), levels.stop_behind);
      }
      expect_as_by_themselves(levels, atoms, s, &alone);
      if (frame < 4 && levels.were_beside()) in_slabs += levels.meshes.back().report.slice_count > 1 ? 1 : 0;
    }
    EXPECT_GE(in_slabs, 2u);
  }
}

// Where their spacings divide the coarsest one, all levels have the lattice of their spacing alone. The frame is that
// of the coarsest, so that the others are the same but for rounding.
TEST_F(LadderLevels, ThatDivideTheCoarsestAreThoseOfTheirSpacing) {
  const Atoms atoms = shifted(cluster(400, 5), 11.3, -21.7, 37.9);
  qses_settings s = settings(0.5);
  s.level_count = 2;
  s.levels[0] = 2.f;
  s.levels[1] = 1.f;
  const auto engine = make_engine();
  Levels levels;
  compute(*engine, atoms, s, &levels);
  ASSERT_EQ(levels.meshes.size(), 3u);
  for (const quickses::FinishedMesh &level : levels.meshes) {
    const qses_mesh &of_ladder = level.on_host;
    SCOPED_TRACE(of_ladder.spacing);
    qses_settings of_level = s;
    of_level.level_count = 0;
    of_level.spacing = of_ladder.spacing;
    Levels alone;
    compute(*engine, atoms, of_level, &alone);
    ASSERT_EQ(alone.meshes.size(), 1u);
    if (of_ladder.spacing == s.levels[0]) expect_same(level, alone.meshes[0]);
    const qses_mesh &m = alone.meshes[0].on_host;
    ASSERT_EQ(of_ladder.vertex_count, m.vertex_count);
    ASSERT_EQ(of_ladder.triangle_count, m.triangle_count);
    expect_equal(of_ladder.indices, m.indices, 3 * size_t(m.triangle_count), "indices");
    for (size_t k = 0; k < 3 * size_t(m.vertex_count); ++k)
      EXPECT_NEAR(of_ladder.positions[k], m.positions[k], 1e-3f) << k;
  }
}

// A level has as large a part of the work as it has of the lattice points at the surface.
TEST_F(LadderLevels, TellHowFarTheyAre) {
  if (tested_backend() != QSES_BACKEND_CPU) GTEST_SKIP() << "a GPU makes them beside each other";
  const Atoms atoms = cluster(400, 5);
  const qses_settings s = settings(0.5);  // behind levels of 2 and 1
  Levels levels;
  compute(*make_engine(), atoms, s, &levels);
  ASSERT_EQ(levels.reached.size(), 3u);
  const double total = 1 / 4. + 1 + 4;
  EXPECT_NEAR(levels.reached[0], 0.25 / total, 1e-6);
  EXPECT_NEAR(levels.reached[1], 1.25 / total, 1e-6);
  EXPECT_NEAR(levels.reached[2], 1, 1e-6);
  ASSERT_FALSE(levels.steps.empty());
  EXPECT_EQ(levels.steps.front(), 0) << "it begins at the beginning";
  for (const double reached : levels.reached)  // what it does in each level is told as it goes on
    EXPECT_GE(std::count_if(levels.steps.begin(), levels.steps.end(), [&](double f) { return f < reached; }), 3);
  EXPECT_TRUE(std::any_of(levels.steps.begin(), levels.steps.end(), [&](double f) {
    return f > levels.reached[0] + 0.01 && f < levels.reached[1] - 0.01;
  })) << "within the second level";
  EXPECT_TRUE(std::any_of(levels.steps.begin(), levels.steps.end(), [&](double f) {
    return f > levels.reached[1] + 0.1 && f < levels.reached[2] - 0.1;
  })) << "within the third";
}

// Levels that are given up leave nothing behind.
TEST_F(LadderLevels, MayBeGivenUpAtAnyMoment) {
  const Atoms molecule = cluster(400, 6);
  std::mt19937 random(11);
  size_t cancelled = 0;
  for (const Change change : {kChanges[0], kChanges[3], kChanges[11]}) {
    qses_settings s = settings();
    change(&s);
    const auto engine = make_engine();
    std::map<int, Alone> alone;
    for (int frame = 0; frame < 60; ++frame) {
      let_first_go_alone(frame % 2 != 0);
      const Atoms atoms = scaled(molecule, 1.0 + 0.002 * (frame % 5));
      Levels levels;
      std::thread other;
      if (frame % 3 == 1) {
        levels.stop_behind = random() % 3;
        if (levels.stop_behind == 0) levels.stop = true;
      } else if (frame % 3 == 2) {
        other = std::thread([&levels, delay = random() % 600] {
          std::this_thread::sleep_for(std::chrono::microseconds(delay));
          levels.stop = true;
        });
      }
      try {
        compute(*engine, atoms, s, &levels);
        EXPECT_EQ(levels.meshes.size(), 3u);
      } catch (const quickses::Cancelled &) {
        ++cancelled;
        EXPECT_NE(frame % 3, 0);
      }
      if (other.joinable()) other.join();
      expect_as_by_themselves(levels, atoms, s, &alone[frame % 5]);
    }
  }
  EXPECT_GT(cancelled, 20u);
}

// However often the plan was refused memory, each level comes once, and the next frame does no work twice.
TEST(LadderLevelsWithABudget, AreHandedOutOnce) {
  if (tested_backend() != QSES_BACKEND_CPU) GTEST_SKIP() << "the budget is of the device";
  const Atoms atoms = cluster(400, 5);
  qses_settings s = settings(0.3);
  const std::unique_ptr<quickses::SurfaceEngine> unbounded = make_engine();
  const std::atomic<bool> stop{false};
  const uint64_t smallest =
      unbounded->estimate(*atoms_of(*unbounded, atoms), quickses::Appearance{}, s, stop).smallest_budget;
  Alone alone;
  uint64_t tried_again = 0;
  for (const double factor : {1.0, 1.05, 1.1, 1.2, 1.35, 1.5, 2.0}) {
    SCOPED_TRACE(testing::Message() << factor << " of " << smallest << " bytes");
    const auto engine = make_engine(static_cast<uint64_t>(factor * static_cast<double>(smallest)));
    for (int frame = 0; frame < 2; ++frame) {
      Levels levels;
      compute(*engine, atoms, s, &levels);
      ASSERT_EQ(levels.meshes.size(), 3u);
      EXPECT_EQ(levels.times_prepared, 1u);
      uint64_t attempts = 0;
      for (const quickses::FinishedMesh &mesh : levels.meshes) {
        EXPECT_GE(mesh.report.attempts, 1u);
        attempts += mesh.report.attempts;
        EXPECT_LE(mesh.report.work_bytes_peak, factor * static_cast<double>(smallest));
      }
      if (frame == 1) {
        EXPECT_EQ(attempts, 3u) << "what did for the frame before does for this one";
      }
      EXPECT_GE(levels.times_given_back, 3u) << "before each level";
      tried_again += attempts - 3;
      if (alone.empty()) {
        Levels apart;
        compute(*unbounded, atoms, s, &apart);
        alone = std::move(apart.meshes);
      }
      for (size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(levels.meshes[k].on_host.spacing, alone[k].on_host.spacing);
        ASSERT_EQ(levels.meshes[k].on_host.vertex_count, alone[k].on_host.vertex_count);
        expect_equal(levels.meshes[k].on_host.indices, alone[k].on_host.indices,
                     3 * size_t(alone[k].on_host.triangle_count), "indices");
      }
    }
  }
  EXPECT_GT(tried_again, 0u) << "nothing was refused: nothing was tested";
}

TEST(LevelsOfSettings, AreThoseAboveTheSpacingAndTheSpacing) {
  qses_settings s = settings(0.5);
  s.level_count = 4;
  const float levels[] = {4.f, 2.f, 0.5f, 0.25f};
  std::copy(levels, levels + 4, s.levels);
  quickses::Levels expected;
  for (const float spacing : {4.f, 2.f, 0.5f}) expected.add(spacing);
  EXPECT_TRUE(quickses::levels_of(s) == expected);
  quickses::Levels other = expected;
  other.spacings[1] = 3.f;
  EXPECT_FALSE(other == expected);
  other = expected;
  other.add(0.25f);
  EXPECT_FALSE(expected == other);
  EXPECT_FALSE(other == expected);
  s.level_count = 0;
  EXPECT_EQ(quickses::levels_of(s).count, 1u);
}

// Spacings are rounded: one that is a multiple but for that divides all the same.
TEST(LevelsOfSettings, HaveTheFrameOfTheCoarsestThatAllDivide) {
  const auto frame = [](std::initializer_list<double> spacings) {
    quickses::Levels levels;
    for (const double spacing : spacings) levels.add(static_cast<float>(spacing));
    return quickses::frame_spacing(levels);
  };
  for (const double fine : {0.5, 0.1, 0.3, 0.07, 0.013})
    for (int times = 1; times <= 1000; ++times) {
      const float coarse = static_cast<float>(times * fine);
      ASSERT_EQ(frame({times * fine, fine}), coarse) << times << " times " << fine;
      if (times < 300) {
        ASSERT_EQ(frame({(times + 0.01) * fine, fine}), static_cast<float>(fine)) << times << " times " << fine;
      }
    }
  EXPECT_EQ(frame({2, 1, 0.5}), 2.f);
  EXPECT_EQ(frame({2, 0.8, 0.5}), 0.5f) << "one between does not divide";
  EXPECT_EQ(frame({0.7}), 0.7f);
}

}  // namespace
