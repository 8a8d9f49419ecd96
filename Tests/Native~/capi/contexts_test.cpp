// SPDX-License-Identifier: MIT
// Many contexts at once: what each of them computes is what it computes alone.
#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

#include <functional>
#include <thread>

using namespace surface_fixture;

namespace {

struct Task {
  Atoms atoms;
  qses_settings settings;
};

// Different molecules, and different settings.
std::vector<Task> make_tasks() {
  std::vector<Task> tasks;
  const auto add = [&](const Atoms &atoms, const qses_settings &s) { tasks.push_back({atoms, s}); };
  add(crambin(), settings(0.5));
  add(turned(crambin(), 20, -30, 10), settings(0.7, 1.4, QSES_SURFACE_SAS));
  add(cluster(400, 1), settings(0.4, 1.0));
  add(cluster(1500, 2), settings(1.0, 1.4, QSES_SURFACE_VDW));
  add(cluster(40, 3), settings(0.3, 3.0));
  add(Atoms().add(0, 0, 0, 1.5), settings(0.5));
  add(cluster(700, 4), settings(0.6));
  tasks.back().settings.relaxation_steps = 4;
  tasks.back().settings.patch_types = 1;
  tasks.back().settings.winding = QSES_WINDING_REVERSED;
  add(cluster(500, 5), settings(0.6));
  tasks.back().settings.method = QSES_METHOD_GRID;
  return tasks;
}

void expect_same(const Surface &found, const Surface &expected) {
  EXPECT_EQ(found.mesh.positions, expected.mesh.positions);
  EXPECT_EQ(found.mesh.normals, expected.mesh.normals);
  EXPECT_EQ(found.mesh.owners, expected.mesh.owners);
  EXPECT_EQ(found.mesh.indices, expected.mesh.indices);
  EXPECT_EQ(found.patches, expected.patches);
  EXPECT_EQ(found.report.area, expected.report.area);
  EXPECT_EQ(found.report.volume, expected.report.volume);
}

// The finest level of a job.
Surface compute_by_job(qses_context *context, const Task &task) {
  set_atoms(context, task.atoms);
  expect_ok(qses_begin(context, &task.settings));
  expect_ok(qses_wait(context, -1, nullptr));
  qses_mesh m;
  qses_mesh_init(&m);
  expect_ok(qses_collect(context, &m));
  return copy_surface(context);
}

void run_in_threads(size_t count, const std::function<void(size_t)> &work) {
  std::vector<std::thread> threads;
  for (size_t k = 0; k < count; ++k)
    threads.emplace_back([&work, k] {
      try {
        work(k);
      } catch (const std::exception &e) {
        ADD_FAILURE() << "thread " << k << ": " << e.what();
      }
    });
  for (std::thread &thread : threads) thread.join();
}

TEST(Contexts, EightInEightThreadsGiveTheBytesOfOne) {
  const std::vector<Task> tasks = make_tasks();
  ASSERT_EQ(tasks.size(), 8u);
  std::vector<Surface> expected;
  {
    const Context alone(1);
    for (const Task &task : tasks) expected.push_back(compute(alone, task.atoms, task.settings));
  }
  for (const Surface &surface : expected) ASSERT_GT(surface.vertex_count(), 0u);
  run_in_threads(tasks.size(), [&](size_t k) {
    const Context context(2);
    for (size_t round = 0; round < 6; ++round) {
      const size_t which = (k + 3 * round) % tasks.size();  // every context meets several molecules and settings
      const Surface found = round % 2 == 0 ? compute(context, tasks[which].atoms, tasks[which].settings)
                                           : compute_by_job(context, tasks[which]);
      SCOPED_TRACE(which);
      expect_same(found, expected[which]);
    }
  });
}

TEST(Contexts, ComeAndGoWhileOthersCompute) {
  const Task task = {cluster(300, 6), settings(0.7)};
  const Surface expected = compute(task.atoms, task.settings);
  run_in_threads(8, [&](size_t k) {
    for (size_t round = 0; round < 5; ++round) {
      const Context context(static_cast<unsigned>(1 + (k + round) % 4));
      expect_same(compute(context, task.atoms, task.settings), expected);
    }
  });
}

// One context for many small surfaces, as of ligands or chains: nothing of one shows in the next.
TEST(Contexts, ManySmallSurfacesOnOne) {
  const Context context;
  const Atoms all = crambin();
  for (size_t first = 0; first + 60 <= all.size(); first += 30) {
    Atoms some;
    for (size_t i = first; i < first + 60; ++i) {
      const auto c = all.center(i);
      some.add(c[0], c[1], c[2], static_cast<double>(all.radii[i]));
    }
    const Surface found = compute(context, some, settings());
    EXPECT_EQ(mesh_checks::manifold_fault(found.mesh), "");
    expect_same(found, compute(some, settings()));
  }
}

}  // namespace
