// SPDX-License-Identifier: MIT
// The C API: computing, memory, meshes, reports, progress, threads.
#include "capi/capi_fixture.h"

#include <atomic>
#include <cmath>
#include <filesystem>
#include <set>
#include <thread>

namespace {

using namespace capi_fixture;

// ---- computing

TEST_F(WithMesh, ComputeErrors) {
  const auto bad = [&](const qses_settings &s, std::initializer_list<const char *> words) {
    qses_mesh m = empty_mesh();
    expect_error(qses_compute(context_, &s, &m), QSES_INVALID_ARGUMENT, words);
    EXPECT_EQ(m.vertex_count, 0u);
    expect_unharmed();
  };
  qses_settings s = settings();
  for (float spacing : {0.f, -1.f, kNan, kInf, 0.0009f, 100.1f}) {
    s.spacing = spacing;
    bad(s, {"spacing"});
  }
  s = settings();
  for (float probe : {-0.1f, kNan, kInf, 100.1f}) {
    s.probe_radius = probe;
    bad(s, {"probe_radius"});
  }
  s = settings();
  set_any(&s.surface, 4);
  bad(s, {"surface", "4"});
  set_any(&s.surface, -1);
  bad(s, {"surface", "-1"});
  s = settings();
  set_any(&s.method, 2);
  bad(s, {"method", "2"});
  s = settings();
  set_any(&s.winding, 2);
  bad(s, {"winding", "2"});
  s = settings();
  s.relaxation_steps = 101;
  bad(s, {"relaxation_steps", "101"});
  s = settings();
  for (uint32_t slice : {1u, 7u}) {
    s.slice_size = slice;
    bad(s, {"slice_size"});
  }
  s = settings();
  s.method = QSES_METHOD_GRID;
  s.surface = QSES_SURFACE_SAS;
  bad(s, {"method", "GRID"});
  s.surface = QSES_SURFACE_VDW;
  bad(s, {"method", "GRID"});
  s.surface = QSES_SURFACE_SES;
  s.patch_types = 1;
  bad(s, {"patch_types"});
  expect_error(qses_compute(nullptr, nullptr, nullptr), QSES_INVALID_ARGUMENT, {"context"});
  expect_error(qses_context_mesh(nullptr, &mesh_), QSES_INVALID_ARGUMENT, {"context"});
  expect_error(qses_context_mesh(context_, nullptr), QSES_INVALID_ARGUMENT, {"mesh"});
  qses_report r;
  qses_report_init(&r);
  expect_error(qses_context_report(nullptr, &r), QSES_INVALID_ARGUMENT, {"context"});
  expect_error(qses_context_report(context_, nullptr), QSES_INVALID_ARGUMENT, {"report"});
  expect_error(qses_set_stage_times(nullptr, 1), QSES_INVALID_ARGUMENT, {"context"});
  expect_error(qses_set_progress_callback(nullptr, nullptr, nullptr), QSES_INVALID_ARGUMENT, {"context"});
  expect_unharmed();
  expect_usable();
}

// Settings at the ends of their ranges are no errors.
TEST(Compute, EndsOfTheRanges) {
  const Context context;
  set_atoms(context, water());
  qses_settings s = settings(100, 100);
  s.relaxation_steps = 100;
  EXPECT_EQ(qses_compute(context, &s, nullptr), QSES_OK) << qses_last_error();
  s = settings(0.5, 0);
  s.slice_size = 8;
  s.relaxation_steps = 0;
  EXPECT_EQ(qses_compute(context, &s, nullptr), QSES_OK) << qses_last_error();
  s.slice_size = 0xffffffffu;
  s.tag = 0xffffffffu;
  EXPECT_EQ(qses_compute(context, &s, nullptr), QSES_OK) << qses_last_error();
}

TEST_F(WithMesh, AMeshStaysUntilTheNextOneSucceeds) {
  const std::vector<float> kept(mesh_.positions, mesh_.positions + 3 * size_t(mesh_.vertex_count));
  qses_settings s = settings(-1);
  EXPECT_NE(qses_compute(context_, &s, nullptr), QSES_OK);
  set_atoms(context_, cluster(60, 1));  // no computation yet
  EXPECT_EQ(kept, std::vector<float>(mesh_.positions, mesh_.positions + kept.size()));
  expect_unharmed();
}

TEST_F(WithMesh, ATooFineSpacingOfTooManyVertices) {
  // Gigabytes are refused by the budget long before 32 bits run out.
  const Context small(2, uint64_t(64) << 20);
  Atoms big;
  big.add(0, 0, 0, 100);
  set_atoms(small, big);
  const qses_settings s = settings(0.001, 0);
  const qses_status status = qses_compute(small, &s, nullptr);
  EXPECT_TRUE(status == QSES_OUT_OF_MEMORY || status == QSES_TOO_FINE) << status;
  EXPECT_NE(std::string(qses_last_error()), "");
  EXPECT_GT(compute(small, water(), settings()).vertex_count(), 0u);
}

TEST(Delivery, OfTheCpuIsHostMemory) {
  const Context context(1);
  set_atoms(context, crambin());
  qses_settings s = settings();
  for (const qses_delivery delivery : {QSES_DELIVERY_DEVICE, QSES_DELIVERY_BOTH, static_cast<qses_delivery>(4)}) {
    s.delivery = delivery;
    expect_error(qses_compute(context, &s, nullptr), QSES_INVALID_ARGUMENT, {"settings.delivery"});
  }
  qses_device_mesh mesh;
  qses_device_mesh_init(&mesh);
  expect_error(qses_collect_device(context, &mesh), QSES_NO_RESULT, {"computed"});
  s.delivery = QSES_DELIVERY_HOST;
  ASSERT_EQ(qses_compute(context, &s, nullptr), QSES_OK);
  expect_error(qses_collect_device(context, &mesh), QSES_INVALID_ARGUMENT, {"DEVICE or BOTH"});
  expect_error(qses_collect_device(context, nullptr), QSES_INVALID_ARGUMENT, {"mesh"});
}

// Also where there is nothing to be on the device.
TEST(Delivery, OfAnEmptyMeshIsWhereItWasWanted) {
  const Context context(1);
  set_atoms(context, Atoms());
  qses_device_mesh mesh;
  qses_device_mesh_init(&mesh);
  for (const qses_delivery delivery : {QSES_DELIVERY_HOST, QSES_DELIVERY_NONE}) {
    qses_settings s = settings();
    s.delivery = delivery;
    ASSERT_EQ(qses_compute(context, &s, nullptr), QSES_OK);
    expect_error(qses_collect_device(context, &mesh), QSES_INVALID_ARGUMENT, {"DEVICE or BOTH"});
  }
}

// Who asks for it in the wrong place has lost neither what is new nor what is held.
TEST(Delivery, WhatIsNotOnTheDeviceCanStillBeCollected) {
  const Context context(1);
  const qses_settings s = settings();
  set_atoms(context, crambin());
  qses_mesh held = empty_mesh(), collected = empty_mesh();
  expect_ok(qses_compute(context, &s, &held));
  const std::vector<float> positions(held.positions, held.positions + 3 * held.vertex_count);
  const auto is_unchanged = [&] { return std::equal(positions.begin(), positions.end(), held.positions); };

  set_atoms(context, water());
  const auto run = [&] {
    expect_ok(qses_begin(context, &s));
    expect_ok(qses_wait(context, -1, nullptr));
  };
  run();
  qses_device_mesh mesh;
  qses_device_mesh_init(&mesh);
  expect_error(qses_collect_device(context, &mesh), QSES_INVALID_ARGUMENT, {"DEVICE or BOTH"});
  run();  // into whatever memory was given up
  EXPECT_TRUE(is_unchanged());
  expect_ok(qses_collect(context, &collected));
  EXPECT_LT(collected.vertex_count, held.vertex_count);
}

TEST(Memory, ATooSmallBudgetIsRefusedAndLeavesTheContextUsable) {
  const Context context(2, uint64_t(3) << 20);
  const Surface small = compute(context, water(), settings());
  ASSERT_GT(small.vertex_count(), 0u);
  const Atoms large = cluster(1500, 2);
  set_atoms(context, large);
  const qses_settings fine = settings(0.2);
  for (int repeat = 0; repeat < 3; ++repeat) {
    qses_mesh m = empty_mesh();
    expect_error(qses_compute(context, &fine, &m), QSES_OUT_OF_MEMORY, {" 3.0 MiB"});  // and what it needs
    EXPECT_EQ(m.vertex_count, 0u);
    EXPECT_EQ(copy_surface(context).mesh.positions, small.mesh.positions);
  }
  EXPECT_EQ(compute(context, water(), settings()).mesh.positions, small.mesh.positions);
}

TEST(Memory, TheReportKeepsToTheBudget) {
  const Atoms atoms = cluster(600, 2);
  const Surface free_run = compute(atoms, settings());
  const uint64_t budget = free_run.report.work_bytes_peak + (uint64_t(1) << 20);
  const Context context(2, budget);
  const Surface bounded = compute(context, atoms, settings());
  EXPECT_LE(bounded.report.work_bytes_peak, budget);
  EXPECT_GT(bounded.report.work_bytes_peak, 0u);
  EXPECT_EQ(bounded.mesh.positions, free_run.mesh.positions);
}

TEST(Mesh, HasTheFrameAndTheBounds) {
  const Context context;
  set_atoms(context, turned(cluster(50, 9), 7, -8, 9));
  for (uint32_t frame : {0u, 5u, 4294967295u})
    for (uint32_t measure : {0u, 1u}) {
      qses_settings s = settings();
      s.tag = frame;
      s.measure = measure;
      qses_mesh m = empty_mesh();
      ASSERT_EQ(qses_compute(context, &s, &m), QSES_OK);
      EXPECT_EQ(m.tag, frame);
      for (int d = 0; d < 3; ++d) {
        float low = kInf, high = -kInf;
        for (uint32_t v = 0; v < m.vertex_count; ++v) {
          low = std::min(low, m.positions[3 * v + static_cast<uint32_t>(d)]);
          high = std::max(high, m.positions[3 * v + static_cast<uint32_t>(d)]);
        }
        EXPECT_EQ(m.bounds_min[d], low);
        EXPECT_EQ(m.bounds_max[d], high);
      }
    }
}

TEST(Mesh, ReversedWindingTurnsTrianglesOnly) {
  const Atoms atoms = cluster(70, 12);
  for (qses_method method : {QSES_METHOD_EXACT, QSES_METHOD_GRID}) {
    qses_settings s = settings();
    s.method = method;
    const Surface outward = compute(atoms, s);
    s.winding = QSES_WINDING_REVERSED;
    const Surface reversed = compute(atoms, s);
    EXPECT_EQ(outward.mesh.positions, reversed.mesh.positions);
    EXPECT_EQ(outward.mesh.normals, reversed.mesh.normals);
    EXPECT_EQ(outward.mesh.owners, reversed.mesh.owners);
    ASSERT_EQ(outward.mesh.indices.size(), reversed.mesh.indices.size());
    for (size_t k = 0; k < outward.mesh.indices.size(); k += 3) {
      ASSERT_EQ(outward.mesh.indices[k], reversed.mesh.indices[k]);
      ASSERT_EQ(outward.mesh.indices[k + 1], reversed.mesh.indices[k + 2]);
      ASSERT_EQ(outward.mesh.indices[k + 2], reversed.mesh.indices[k + 1]);
    }
    EXPECT_GT(outward.report.volume, 0);
    // Of the molecule either way.
    EXPECT_NEAR(outward.report.volume, reversed.report.volume, 1e-3 * outward.report.volume);
    EXPECT_EQ(outward.report.area, reversed.report.area);
  }
}

TEST(Mesh, PatchesOnlyWhenAskedFor) {
  const Context context;
  set_atoms(context, cluster(60, 3));
  qses_settings s = settings();
  qses_mesh m = empty_mesh();
  ASSERT_EQ(qses_compute(context, &s, &m), QSES_OK);
  EXPECT_EQ(m.patches, nullptr);
  s.patch_types = 1;
  ASSERT_EQ(qses_compute(context, &s, &m), QSES_OK);
  ASSERT_NE(m.patches, nullptr);
  size_t number[3] = {};
  for (uint32_t v = 0; v < m.vertex_count; ++v) {
    ASSERT_LE(m.patches[v], QSES_PATCH_REENTRANT);
    ++number[m.patches[v]];
  }
  for (size_t n : number) EXPECT_GT(n, 10u);
}

// ---- report, stage times, progress

TEST(Report, SaysWhatWasDone) {
  const Context context;
  const Surface s = compute(context, cluster(200, 5), settings());
  EXPECT_GE(s.report.mesh_bytes, s.vertex_count() * 28 + s.mesh.triangle_count() * 12);
  EXPECT_LT(s.report.mesh_bytes, s.vertex_count() * 29 + s.mesh.triangle_count() * 12 + 4096);
  EXPECT_GT(s.report.work_bytes_peak, 0u);
  EXPECT_GE(s.report.host_bytes_peak, s.report.mesh_bytes + s.report.work_bytes_peak);
  EXPECT_GT(s.report.brick_count, 10u);
  EXPECT_EQ(s.report.slice_count, 1u);
  EXPECT_GT(s.report.compute_ms, 0.0);
  EXPECT_EQ(s.report.stage_count, 0u);
}

// Whether there is surface/.../NAME.h, or NAME_cpu.h and NAME_cuda.cuh.
bool is_file_of_the_surface(const std::string &name) {
  const std::filesystem::path root(QUICKSES_TEST_DATA_DIR "/../../NativePlugin/Source~/surface");
  for (const auto &entry : std::filesystem::recursive_directory_iterator(root)) {
    const std::string stem = entry.path().stem().string();
    if (stem == name || stem == name + "_cpu") return true;
  }
  return false;
}

TEST(Report, StagesAreCalledAsTheirFiles) {
  const Context context;
  const Atoms atoms = cluster(200, 5);
  set_atoms(context, atoms);
  std::vector<uint8_t> visible(atoms.size(), 1);
  visible[0] = 0;
  ASSERT_EQ(qses_set_visible(context, visible.data(), visible.size()), QSES_OK);
  ASSERT_EQ(qses_set_stage_times(context, 1), QSES_OK);
  for (qses_method method : {QSES_METHOD_EXACT, QSES_METHOD_GRID}) {
    qses_settings s = settings();
    s.method = method;
    s.components = method == QSES_METHOD_EXACT;
    s.hard_edges = 1;
    ASSERT_EQ(qses_compute(context, &s, nullptr), QSES_OK);
    const qses_report report = report_of(context);
    std::set<std::string> names;
    for (uint32_t k = 0; k < report.stage_count; ++k) names.insert(report.stages[k].name);
    EXPECT_EQ(names.size(), report.stage_count) << "a name twice";
    std::set<std::string> expected = {"neighbor_grid", "bricks",       "marching_cubes", "projection",
                                      "relaxation",    "visible_mask", "appearance",     "mesh_memory"};
    if (method == QSES_METHOD_EXACT) expected.insert("hard_edges");
    if (method == QSES_METHOD_EXACT) expected.insert({"solvent_features", "exact_ses", "thin_walls", "components"});
    if (method == QSES_METHOD_GRID) expected.insert({"grid_ses", "measure"});
    EXPECT_EQ(names, expected);
    for (const std::string &name : names) EXPECT_TRUE(is_file_of_the_surface(name)) << name;
  }
}

TEST(Report, StageTimes) {
  const Context context;
  ASSERT_EQ(qses_set_stage_times(context, 1), QSES_OK);
  for (int repeat = 0; repeat < 2; ++repeat) {
    const Surface s = compute(context, cluster(200, 5), settings());
    ASSERT_GT(s.report.stage_count, 3u);
    ASSERT_LE(s.report.stage_count, uint32_t(QSES_MAX_STAGES));
    double sum = 0;
    std::string names;
    for (uint32_t k = 0; k < s.report.stage_count; ++k) {
      EXPECT_GE(s.report.stages[k].milliseconds, 0.0);
      sum += s.report.stages[k].milliseconds;
      names += std::string(s.report.stages[k].name) + " ";
    }
    EXPECT_LE(sum, s.report.compute_ms * 1.001 + 0.01);
    EXPECT_EQ(names.find("neighbor_grid "), 0u) << names;
    EXPECT_NE(names.find("solvent_features "), std::string::npos) << names;
  }
  ASSERT_EQ(qses_set_stage_times(context, 0), QSES_OK);
  EXPECT_EQ(compute(context, water(), settings()).report.stage_count, 0u);
}

TEST(Progress, RisesFromNoneToAll) {
  struct Record {
    std::vector<double> fractions;
    std::thread::id thread;
  };
  for (qses_method method : {QSES_METHOD_EXACT, QSES_METHOD_GRID})
    for (uint32_t slice : {0u, 8u, 16u})
      for (uint32_t steps : {0u, 1u, 5u}) {
        SCOPED_TRACE(testing::Message() << "method " << method << " slice " << slice << " steps " << steps);
        Record record;
        const Context context;
        set_atoms(context, cluster(500, 5));
        ASSERT_EQ(qses_set_progress_callback(
                      context,
                      [](void *to, double fraction) {
                        auto *r = static_cast<Record *>(to);
                        r->fractions.push_back(fraction);
                        r->thread = std::this_thread::get_id();
                      },
                      &record),
                  QSES_OK);
        qses_settings s = settings();
        s.method = method;
        s.slice_size = slice;
        s.relaxation_steps = steps;
        ASSERT_EQ(qses_compute(context, &s, nullptr), QSES_OK);
        EXPECT_GT(record.fractions.size(), 5u);
        EXPECT_LT(record.fractions.size(), 500u);
        EXPECT_GE(record.fractions.front(), 0.0);
        EXPECT_LT(record.fractions.front(), 0.5);
        EXPECT_EQ(record.fractions.back(), 1.0);
        for (size_t k = 1; k < record.fractions.size(); ++k) EXPECT_GT(record.fractions[k], record.fractions[k - 1]);
        EXPECT_EQ(record.thread, std::this_thread::get_id());
        // The second computation starts over; NULL ends it.
        record.fractions.clear();
        ASSERT_EQ(qses_compute(context, &s, nullptr), QSES_OK);
        ASSERT_FALSE(record.fractions.empty());
        EXPECT_LT(record.fractions.front(), 0.5);
        record.fractions.clear();
        ASSERT_EQ(qses_set_progress_callback(context, nullptr, nullptr), QSES_OK);
        ASSERT_EQ(qses_compute(context, &s, nullptr), QSES_OK);
        EXPECT_TRUE(record.fractions.empty());
      }
}

// ---- threads

TEST(Threads, ManyContextsAtOnce) {
  std::vector<Atoms> inputs;
  std::vector<Surface> expected;
  for (unsigned k = 0; k < 6; ++k) {
    inputs.push_back(cluster(60 + 30 * k, k));
    expected.push_back(compute(inputs.back(), settings()));
  }
  std::atomic<int> different{0};
  std::vector<std::thread> threads;
  for (unsigned k = 0; k < 6; ++k)
    threads.emplace_back([&, k] {
      const Context context(1 + k % 3);
      for (int repeat = 0; repeat < 5; ++repeat) {
        const size_t i = (k + static_cast<size_t>(repeat)) % inputs.size();
        const Surface s = compute(context, inputs[i], settings());
        if (s.mesh.positions != expected[i].mesh.positions || s.mesh.indices != expected[i].mesh.indices) ++different;
        qses_settings bad = settings(-1.0 - k);
        if (qses_compute(context, &bad, nullptr) != QSES_INVALID_ARGUMENT) ++different;
        if (std::string(qses_last_error()).find("-" + std::to_string(k + 1)) == std::string::npos) ++different;
      }
    });
  for (std::thread &t : threads) t.join();
  EXPECT_EQ(different, 0);
}

TEST(Threads, AContextMayMoveFromThreadToThread) {
  const Context context;
  const Atoms atoms = cluster(100, 3);
  std::thread([&] { set_atoms(context, atoms); }).join();
  std::thread([&] { expect_ok(qses_compute(context, nullptr, nullptr)); }).join();
  EXPECT_EQ(copy_surface(context).mesh.positions, compute(atoms, settings()).mesh.positions);
}

}  // namespace
