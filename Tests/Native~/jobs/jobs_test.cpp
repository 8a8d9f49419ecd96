// SPDX-License-Identifier: MIT
// Jobs through the C API: levels, replacing, cancelling, and memory that is handed over.
#include "jobs/jobs_fixture.h"

#include <atomic>
#include <chrono>
#include <cstring>
#include <limits>
#include <thread>
#include <utility>

using namespace jobs_fixture;

namespace {

mesh_checks::Mesh copy(const qses_mesh &m) {
  mesh_checks::Mesh mesh;
  mesh.positions.assign(m.positions, m.positions + 3 * size_t(m.vertex_count));
  mesh.normals.assign(m.normals, m.normals + 3 * size_t(m.vertex_count));
  mesh.owners.assign(m.owners, m.owners + m.vertex_count);
  mesh.indices.assign(m.indices, m.indices + 3 * size_t(m.triangle_count));
  return mesh;
}

// Cancels again and again. Whatever is computed stands still until it was cancelled.
class Cancels {
 public:
  void place_in(qses_context *context) {
    context_ = context;
    expect_ok(qses_set_progress_callback(context, wait_for_the_next, this));
  }
  void cancel() {
    expect_ok(qses_cancel(context_));
    ++count_;
  }

 private:
  static void wait_for_the_next(void *cancels, double) {
    const Cancels &self = *static_cast<Cancels *>(cancels);
    const int before = self.count_;
    while (self.count_ < before + 2) std::this_thread::yield();  // one of them may have been before this
  }
  qses_context *context_ = nullptr;
  std::atomic<int> count_{0};
};

TEST(Jobs, CancelEndsAComputeThatWaitsForAJob) {
  Cancels cancels;
  const Context context;
  set_atoms(context, block(20));
  cancels.place_in(context);
  begin(context, settings(0.2));
  std::atomic<bool> entered{false}, has_ended{false};
  qses_status status = QSES_OK;
  std::thread other([&] {
    const qses_settings s = settings(0.2);
    entered = true;
    status = qses_compute(context, &s, nullptr);
    has_ended = true;
  });
  while (!entered) std::this_thread::yield();
  // Compute waits for the job by then, or computes itself. Either is to be ended; if it has not even begun, the next
  // cancel does it.
  do {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    cancels.cancel();
  } while (!has_ended);
  other.join();
  EXPECT_EQ(status, QSES_CANCELLED);
  expect_ok(qses_set_progress_callback(context, nullptr, nullptr));
  const qses_settings s = settings(2.0);
  EXPECT_EQ(qses_compute(context, &s, nullptr), QSES_OK);
}

TEST(Jobs, WaitTakesAnyTime) {
  const Context context;
  set_atoms(context, crambin());
  for (const double milliseconds : {1e9, 1e13, 1e300, static_cast<double>(INFINITY)}) {
    begin(context, settings(0.4));
    int32_t finished = 0;
    expect_ok(qses_wait(context, milliseconds, &finished));
    EXPECT_EQ(finished, 1) << milliseconds;
  }
}

TEST(Jobs, LevelsComeFromCoarseToFine) {
  const Context context;
  const Atoms atoms = cluster(3000, 5);
  set_atoms(context, atoms);
  EXPECT_EQ(poll(context).state, QSES_JOB_IDLE);
  begin(context, settings(0.5), 7);
  int last = -1;
  float spacing = 100;
  while (last < 2) {
    const qses_mesh m = next_level(context);
    ASSERT_EQ(m.level_count, 3u);
    ASSERT_GT(static_cast<int>(m.level), last);
    EXPECT_LT(m.spacing, spacing);
    EXPECT_EQ(m.tag, 7u);
    EXPECT_EQ(mesh_checks::manifold_fault(copy(m)), "");
    last = static_cast<int>(m.level);
    spacing = m.spacing;
  }
  EXPECT_EQ(spacing, 0.5f);
  wait_for_all(context);
  const qses_progress p = poll(context);
  EXPECT_EQ(p.state, QSES_JOB_FINISHED);
  EXPECT_EQ(p.fraction, 1.f);
  EXPECT_EQ(p.levels_finished, 3u);
  EXPECT_EQ(p.mesh_ready, 0);
}

TEST(Jobs, EachLevelIsTheSurfaceComputedAtItsSpacing) {
  const Context context;
  const Atoms atoms = crambin();
  qses_settings s = settings(0.5);
  for (uint32_t count : {0u, 1u, 2u}) {
    s.level_count = count;
    s.levels[0] = count == 1 ? 1.f : 2.f;
    set_atoms(context, atoms);
    begin(context, s);
    wait_for_all(context);
    qses_mesh m;
    qses_mesh_init(&m);
    expect_ok(qses_collect(context, &m));
    EXPECT_EQ(m.level, count);
    const mesh_checks::Mesh finest = copy(m);
    EXPECT_EQ(mesh_checks::manifold_fault(finest), "");
    const Surface alone = compute(context, atoms, s);
    EXPECT_EQ(finest.indices, alone.mesh.indices);
    EXPECT_EQ(finest.positions, alone.mesh.positions);
  }
}

TEST(Jobs, FramesFasterThanLevelsNeverStarveThePicture) {
  const Context context;
  Atoms atoms = cluster(4000, 11);
  set_atoms(context, atoms);
  uint32_t frame = 0, collected = 0;
  std::pair<uint32_t, uint32_t> last{0, 0};  // job and level
  qses_mesh m;
  while (collected < 5) {
    ++frame;
    ASSERT_LT(frame, 100000000u);
    expect_ok(qses_set_positions(context, atoms.positions.data(), 0, atoms.size()));
    begin(context, settings(0.4), frame);
    qses_mesh_init(&m);
    if (qses_collect(context, &m) != QSES_OK) continue;
    ++collected;
    EXPECT_GT(std::pair(m.tag, m.level), last);
    EXPECT_LE(m.tag, frame);
    last = {m.tag, m.level};
  }
  wait_for_all(context);
  qses_mesh_init(&m);
  if (qses_collect(context, &m) != QSES_NOTHING_NEW) {
    EXPECT_GT(std::pair(m.tag, m.level), last);
  }
  expect_ok(qses_context_mesh(context, &m));
  EXPECT_EQ(m.tag, frame);
  EXPECT_EQ(m.level + 1, m.level_count);
  EXPECT_EQ(poll(context).state, QSES_JOB_FINISHED);
}

TEST(Jobs, AJobComputesTheAtomsOfItsBegin) {
  const Context context;
  const Atoms here = cluster(500, 2), there = shifted(here, 64, 0, 0);
  set_atoms(context, here);
  begin(context, settings(0.5), 1);
  expect_ok(qses_set_positions(context, there.positions.data(), 0, there.size()));
  wait_for_all(context);
  qses_mesh m;
  qses_mesh_init(&m);
  expect_ok(qses_collect(context, &m));
  EXPECT_LT(m.bounds_max[0], 40.f);
  begin(context, settings(0.5), 2);
  wait_for_all(context);
  expect_ok(qses_collect(context, &m));
  EXPECT_GT(m.bounds_min[0], 30.f);
}

TEST(Jobs, CollectedMemoryStaysWhileOthersAreComputed) {
  const Context context;
  const Atoms atoms = cluster(1500, 9);
  set_atoms(context, atoms);
  begin(context, settings(0.5));
  wait_for_all(context);
  qses_mesh held;
  qses_mesh_init(&held);
  expect_ok(qses_collect(context, &held));
  const mesh_checks::Mesh before = copy(held);
  for (int k = 0; k < 3; ++k) {
    const Atoms moved = shifted(atoms, 3 + k, 0, 0);
    expect_ok(qses_set_positions(context, moved.positions.data(), 0, moved.size()));
    begin(context, settings(0.5));
    wait_for_all(context);
  }
  const mesh_checks::Mesh after = copy(held);
  EXPECT_EQ(before.positions, after.positions);
  EXPECT_EQ(before.indices, after.indices);
}

TEST(Jobs, CancelEndsTheJobAndTheContextGoesOn) {
  for (const bool has_begun : {false, true}) {
    Gate gate;
    const Context context;
    set_atoms(context, block(31));
    gate.place_in(context);
    begin(context, settings(0.25), 1);
    if (has_begun) gate.wait_until_reached();
    std::thread other([&] { qses_cancel(context); });
    other.join();
    gate.open();
    wait_for_all(context);
    const qses_progress p = poll(context);
    EXPECT_EQ(p.state, QSES_JOB_CANCELLED);
    EXPECT_LT(p.levels_finished, p.level_count);
    const Surface small = compute(context, cluster(50, 1), settings(1.0));
    EXPECT_EQ(mesh_checks::manifold_fault(small.mesh), "");
  }
}

TEST(Jobs, CancelEndsACompute) {
  Gate gate;
  const Context context;
  set_atoms(context, block(31));
  gate.place_in(context);
  qses_status status = QSES_OK;
  std::thread computing([&] {
    const qses_settings s = settings(0.2);
    status = qses_compute(context, &s, nullptr);
  });
  gate.wait_until_reached();
  EXPECT_EQ(poll(context).state, QSES_JOB_RUNNING);
  expect_ok(qses_cancel(context));
  gate.open();
  computing.join();
  EXPECT_EQ(status, QSES_CANCELLED);
}

TEST(Jobs, DestroyDuringAJobJoinsIt) {
  for (int k = 0; k < 5; ++k) {
    const Context context;
    set_atoms(context, block(27));
    begin(context, settings(0.25));
  }
}

TEST(Jobs, ErrorsOfAJobBelongToTheJob) {
  const Context context(2, 2 << 20);
  set_atoms(context, cluster(5000, 4));
  begin(context, settings(0.3));
  wait_for_all(context);
  const qses_progress p = poll(context);
  EXPECT_EQ(p.state, QSES_JOB_FAILED);
  EXPECT_EQ(p.status, QSES_OUT_OF_MEMORY);
  EXPECT_NE(std::string(p.message), "");
}

TEST(Jobs, ProgressNeverFalls) {
  const Context context;
  set_atoms(context, cluster(8000, 6));
  begin(context, settings(0.3));
  float last = 0;
  for (;;) {
    const qses_progress p = poll(context);
    ASSERT_GE(p.fraction, last);
    ASSERT_LE(p.fraction, 1.f);
    last = p.fraction;
    if (p.state != QSES_JOB_RUNNING) break;
  }
  EXPECT_EQ(last, 1.f);
}

TEST(Jobs, AFrameBudgetGivesOneLevel) {
  const Context context;
  const Atoms atoms = cluster(800, 3);
  set_atoms(context, atoms);
  qses_settings s = settings(0.5);  // levels 2, 1, 0.5
  for (const float budget : {1e-3f, 60000.f}) {
    s.frame_budget_ms = budget;
    const Surface finest = compute(context, atoms, s);  // qses_compute knows no budget
    EXPECT_EQ(mesh_checks::manifold_fault(finest.mesh), "");
    for (uint32_t frame = 0; frame < 4; ++frame) {
      begin(context, s, frame);
      EXPECT_EQ(poll(context).level_count, 1u);
      wait_for_all(context);
      const qses_progress p = poll(context);
      EXPECT_EQ(p.state, QSES_JOB_FINISHED);
      EXPECT_EQ(p.levels_finished, 1u);
      EXPECT_EQ(p.level_count, 1u);
      EXPECT_EQ(p.fraction, 1.f);
      qses_mesh m;
      qses_mesh_init(&m);
      expect_ok(qses_collect(context, &m));
      EXPECT_EQ(m.tag, frame);
      EXPECT_EQ(m.level_count, 3u);
      // A budget that nothing keeps to, and one that everything does: what was learnt with the first still holds.
      const uint32_t expected = budget < 1 ? 0 : 2;
      EXPECT_EQ(m.level, expected);
      EXPECT_EQ(m.spacing, expected == 2 ? 0.5f : 2.f);
      EXPECT_EQ(copy(m).indices == finest.mesh.indices, expected == 2);
      EXPECT_EQ(qses_collect(context, &m), QSES_NOTHING_NEW);
    }
  }
  // Other atoms: nothing is known about them.
  set_atoms(context, cluster(801, 3));
  begin(context, s);
  wait_for_all(context);
  EXPECT_EQ(collected(context).level, 0u);
}

// The levels of frames within a budget that everything fits into, once a first frame has told so.
class LevelsOfFrames {
 public:
  explicit LevelsOfFrames(const Context &context) : context_(context) { settings_.frame_budget_ms = 60000; }

  void add(const qses_settings &s) {
    const auto start = std::chrono::steady_clock::now();
    begin(context_, s);
    wait_for_all(context_);
    const bool took_long = std::chrono::steady_clock::now() - start > std::chrono::seconds(2);
    qses_mesh m;
    qses_mesh_init(&m);
    expect_ok(qses_collect(context_, &m));
    levels_.push_back(m.level);
    if (m.level == 0 && took_long) stood_still_ = true;
  }
  const qses_settings &settings_of_all() const { return settings_; }
  const std::vector<uint32_t> &levels() const { return levels_; }
  // The machine did in a coarse frame, so that finer ones seem to cost more than fits.
  bool stood_still() const { return stood_still_; }

 private:
  const Context &context_;
  qses_settings settings_ = settings(0.5);
  std::vector<uint32_t> levels_;
  bool stood_still_ = false;
};

// What a course of frames is given, in a context of its own; once more while the machine stands still.
template <class Course>
std::vector<uint32_t> levels_of(const Course &course) {
  for (int attempt = 0; attempt < 20; ++attempt) {
    const Context context;
    LevelsOfFrames frames(context);
    course(context, &frames);
    if (!frames.stood_still()) return frames.levels();
  }
  return {};
}

TEST(Jobs, SettingsThatChangeWhatALevelCostsBeginAnew) {
  const auto twice_after_each_change = [](qses_context *context, LevelsOfFrames *frames) {
    set_atoms(context, cluster(300, 3));
    qses_settings s = frames->settings_of_all();
    const auto add_two = [&] {
      for (int k = 0; k < 2; ++k) frames->add(s);
    };
    add_two();
    s.occlusion = 1;
    add_two();
    s.surface = QSES_SURFACE_GAUSSIAN;
    add_two();
    s.gaussian_radius_scale = 1.2f;
    add_two();
    s.gaussian_isovalue = 0.8f;
    add_two();
  };
  EXPECT_EQ(levels_of(twice_after_each_change), (std::vector<uint32_t>{0, 2, 0, 2, 0, 2, 0, 2, 0, 2}));
}

TEST(Jobs, SeriesThatShareAContextEachKeepTheirLevel) {
  const auto two_molecules = [](qses_context *context, LevelsOfFrames *frames) {
    const Atoms molecules[2] = {cluster(300, 3), cluster(900, 4)};
    qses_settings s = frames->settings_of_all();
    const auto add_frame_of = [&](const Atoms &atoms) {
      set_atoms(context, atoms);
      frames->add(s);
    };
    for (int frame = 0; frame < 4; ++frame)
      for (uint32_t k : {0u, 1u}) {
        s.series = 4000000000u * k;
        add_frame_of(molecules[k]);
      }
    s.series = 0;
    for (const size_t k : {0, 1, 0}) add_frame_of(molecules[k]);
  };
  // Within one series every change of the atoms begins anew.
  EXPECT_EQ(levels_of(two_molecules), (std::vector<uint32_t>{0, 0, 2, 2, 2, 2, 2, 2, 2, 0, 0}));
}

TEST(Jobs, BadRequestsAreRefusedAtOnce) {
  const Context context;
  qses_settings s = settings();
  EXPECT_EQ(qses_begin(context, &s), QSES_NO_ATOMS);
  set_atoms(context, cluster(10, 1));
  s.levels[0] = 1.f;
  s.levels[1] = 2.f;
  s.level_count = 2;
  EXPECT_EQ(qses_begin(context, &s), QSES_INVALID_ARGUMENT);
  EXPECT_STREQ(qses_last_error(), "settings.levels[1] is 2: it must be below settings.levels[0], which is 1");
  s.levels[1] = 1.f;  // once more the same
  EXPECT_EQ(qses_begin(context, &s), QSES_INVALID_ARGUMENT);
  s.levels[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(qses_begin(context, &s), QSES_INVALID_ARGUMENT);
  EXPECT_STREQ(qses_last_error(), "settings.levels[1] is nan: it must lie between 0.001 and 100 Å");
  s.level_count = QSES_MAX_LEVELS + 1;
  EXPECT_EQ(qses_begin(context, &s), QSES_INVALID_ARGUMENT);
  for (const float budget :
       {-1.f, 60001.f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    s = settings();
    s.frame_budget_ms = budget;
    EXPECT_EQ(qses_begin(context, &s), QSES_INVALID_ARGUMENT);
    EXPECT_NE(std::string(qses_last_error()).find("frame_budget_ms"), std::string::npos);
    EXPECT_EQ(qses_compute(context, &s, nullptr), QSES_INVALID_ARGUMENT);
  }
  qses_mesh m;
  qses_mesh_init(&m);
  EXPECT_EQ(qses_collect(context, &m), QSES_NOTHING_NEW);
  EXPECT_EQ(qses_collect(context, nullptr), QSES_INVALID_ARGUMENT);
  EXPECT_EQ(qses_poll(context, nullptr), QSES_INVALID_ARGUMENT);
}

TEST(Jobs, PositionsCanBeGathered) {
  const Context context;
  const Atoms atoms = cluster(300, 8);
  std::vector<float> all(3 * 1000, 1e5f);
  std::vector<uint32_t> indices(atoms.size());
  for (size_t i = 0; i < atoms.size(); ++i) {
    indices[i] = static_cast<uint32_t>(999 - 3 * i);
    std::memcpy(&all[3 * indices[i]], &atoms.positions[3 * i], 12);
  }
  set_atoms(context, atoms);
  const Surface direct = compute(context, atoms, settings());
  expect_ok(qses_set_positions_indexed(context, all.data(), 0, 1000, indices.data(), indices.size()));
  const qses_settings s = settings();
  expect_ok(qses_compute(context, &s, nullptr));
  EXPECT_EQ(copy_surface(context).mesh.positions, direct.mesh.positions);
  indices[5] = 1000;
  EXPECT_EQ(qses_set_positions_indexed(context, all.data(), 0, 1000, indices.data(), indices.size()),
            QSES_INVALID_ARGUMENT);
  EXPECT_NE(std::string(qses_last_error()).find("indices[5]"), std::string::npos);
}

}  // namespace
