// SPDX-License-Identifier: MIT
// Every function of the C API: what it promises, and what it says about every bad argument.
#include "surface_fixture.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <thread>

namespace {

using namespace surface_fixture;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

// The call failed with this status, and its sentence contains all these words.
void expect_error(qses_status status, qses_status expected, std::initializer_list<const char *> words) {
  EXPECT_EQ(status, expected) << qses_last_error();
  const std::string message = qses_last_error();
  EXPECT_FALSE(message.empty());
  for (const char *word : words) EXPECT_NE(message.find(word), std::string::npos) << '"' << message << "\" lacks " << word;
}

Atoms water() { return Atoms().add(0, 0, 0, 1.52).add(0.96, 0, 0, 1.2).add(-0.24, 0.93, 0, 1.2); }

qses_mesh empty_mesh() {
  qses_mesh m;
  qses_mesh_init(&m);
  return m;
}

// A context with a good mesh in it; the same() afterwards proves that an error has not touched it.
class WithMesh : public testing::Test {
 protected:
  WithMesh() {
    set_atoms(context_, water());
    const qses_settings s = settings();
    expect_ok(qses_compute(context_, &s, &mesh_));
    before_ = copy_surface(context_);
  }

  // Everything handed out before is as it was, and the context computes again.
  void expect_unharmed() {
    qses_mesh now = empty_mesh();
    ASSERT_EQ(qses_get_mesh(context_, &now), QSES_OK);
    EXPECT_EQ(now.positions, mesh_.positions);
    EXPECT_EQ(now.indices, mesh_.indices);
    const Surface after = copy_surface(context_);
    EXPECT_EQ(after.mesh.positions, before_.mesh.positions);
    EXPECT_EQ(after.mesh.normals, before_.mesh.normals);
    EXPECT_EQ(after.mesh.owners, before_.mesh.owners);
    EXPECT_EQ(after.mesh.indices, before_.mesh.indices);
    EXPECT_EQ(after.report.volume, before_.report.volume);
  }
  void expect_usable() {
    ASSERT_EQ(qses_compute(context_, nullptr, nullptr), QSES_OK) << qses_last_error();
    const Surface again = copy_surface(context_);
    EXPECT_EQ(again.mesh.positions, before_.mesh.positions);
    EXPECT_EQ(again.mesh.indices, before_.mesh.indices);
  }

  Context context_;
  qses_mesh mesh_ = empty_mesh();
  Surface before_;
};

// ---- versions and back ends

TEST(Version, IsThatOfTheHeader) {
  EXPECT_EQ(qses_abi_version(), uint32_t(QSES_ABI_VERSION));
  int major = -1, minor = -1, patch = -1;
  EXPECT_EQ(std::sscanf(qses_version(), "%d.%d.%d", &major, &minor, &patch), 3);
  EXPECT_EQ(qses_version(), qses_version());  // static storage
}

TEST(BackendInfo, OfTheCpu) {
  qses_backend_description d;
  std::memset(&d, 0xcc, sizeof d);
  ASSERT_EQ(qses_backend_info(QSES_BACKEND_CPU, &d), QSES_OK);
  EXPECT_EQ(d.available, 1);
  EXPECT_STREQ(d.reason, "");
  EXPECT_NE(std::string(d.device).find("CPU"), std::string::npos);
  EXPECT_GT(d.total_memory, uint64_t(1) << 20);
  EXPECT_GT(d.free_memory, 0u);
  EXPECT_LE(d.free_memory, d.total_memory);
}

TEST(BackendInfo, AutoIsOneOfTheOthersAndSaysWhy) {
  qses_backend_description cuda, chosen, cpu;
  ASSERT_EQ(qses_backend_info(QSES_BACKEND_CUDA, &cuda), QSES_OK);
  ASSERT_EQ(qses_backend_info(QSES_BACKEND_CPU, &cpu), QSES_OK);
  ASSERT_EQ(qses_backend_info(QSES_BACKEND_AUTO, &chosen), QSES_OK);
  EXPECT_EQ(chosen.available, 1);
  if (cuda.available) {
    EXPECT_STREQ(chosen.device, cuda.device);
    EXPECT_STREQ(chosen.reason, "");
  } else {
    EXPECT_STREQ(chosen.device, cpu.device);
    EXPECT_STREQ(chosen.reason, cuda.reason);
    EXPECT_STRNE(chosen.reason, "");
  }
}

TEST(BackendInfo, Errors) {
  qses_backend_description d{};
  expect_error(qses_backend_info(QSES_BACKEND_CPU, nullptr), QSES_INVALID_ARGUMENT, {"description", "NULL"});
  expect_error(qses_backend_info(static_cast<qses_backend>(3), &d), QSES_INVALID_ARGUMENT, {"backend", "3"});
  expect_error(qses_backend_info(static_cast<qses_backend>(-1), &d), QSES_INVALID_ARGUMENT, {"backend"});
}

// ---- errors

TEST(LastError, BelongsToTheThread) {
  expect_error(qses_compute(nullptr, nullptr, nullptr), QSES_INVALID_ARGUMENT, {"context"});
  const std::string mine = qses_last_error();
  std::string fresh = "?", other;
  std::thread([&] {
    fresh = qses_last_error();
    qses_backend_info(QSES_BACKEND_CPU, nullptr);
    other = qses_last_error();
  }).join();
  EXPECT_EQ(fresh, "");
  EXPECT_NE(other.find("description"), std::string::npos);
  EXPECT_EQ(mine, qses_last_error());
}

// ---- contexts

TEST(Create, DefaultsAreFilledIn) {
  qses_context_options o;
  std::memset(&o, 0xcc, sizeof o);
  qses_context_options_init(&o);
  EXPECT_EQ(o.struct_size, sizeof o);
  EXPECT_EQ(o.backend, QSES_BACKEND_AUTO);
  EXPECT_EQ(o.device, 0);
  EXPECT_EQ(o.threads, 0u);
  EXPECT_EQ(o.memory_budget, 0u);
  qses_context_options_init(nullptr);

  qses_context *context = nullptr;
  ASSERT_EQ(qses_create(nullptr, &context), QSES_OK) << qses_last_error();
  qses_backend backend = QSES_BACKEND_AUTO;
  qses_backend_description d{}, chosen{};
  ASSERT_EQ(qses_context_info(context, &backend, &d), QSES_OK);
  ASSERT_EQ(qses_backend_info(QSES_BACKEND_AUTO, &chosen), QSES_OK);
  EXPECT_NE(backend, QSES_BACKEND_AUTO);
  EXPECT_STREQ(d.device, chosen.device);
  EXPECT_STREQ(d.reason, chosen.reason);
  EXPECT_EQ(qses_context_info(context, nullptr, nullptr), QSES_OK);
  expect_error(qses_context_info(nullptr, &backend, &d), QSES_INVALID_ARGUMENT, {"context"});
  qses_destroy(context);
  qses_destroy(nullptr);
}

TEST(Create, CudaUnavailableSaysWhy) {
  qses_backend_description d{};
  ASSERT_EQ(qses_backend_info(QSES_BACKEND_CUDA, &d), QSES_OK);
  if (d.available) GTEST_SKIP() << "there is a CUDA device";
  EXPECT_STRNE(d.reason, "");
  qses_context_options o;
  qses_context_options_init(&o);
  o.backend = QSES_BACKEND_CUDA;
  qses_context *context = reinterpret_cast<qses_context *>(&o);
  expect_error(qses_create(&o, &context), QSES_BACKEND_UNAVAILABLE, {d.reason});
  EXPECT_EQ(context, nullptr);
}

TEST(Create, Errors) {
  qses_context_options o;
  qses_context_options_init(&o);
  expect_error(qses_create(&o, nullptr), QSES_INVALID_ARGUMENT, {"context"});
  const auto refused = [&](std::initializer_list<const char *> words) {
    qses_context *context = reinterpret_cast<qses_context *>(&o);
    expect_error(qses_create(&o, &context), QSES_INVALID_ARGUMENT, words);
    EXPECT_EQ(context, nullptr);
    qses_context_options_init(&o);
  };
  o.backend = static_cast<qses_backend>(17);
  refused({"backend", "17"});
  o.threads = 5000;
  refused({"threads", "5000"});
  o.struct_size = 0;
  refused({"struct_size"});
  o.struct_size = 3;
  refused({"struct_size"});
  o.struct_size = 0xffffffffu;
  refused({"struct_size"});
}

// ---- sizes of structures: callers may be older than the library, or newer

TEST(StructSize, ShorterStructuresKeepDefaults) {
  const Context context;
  set_atoms(context, water());
  qses_settings s = settings(0.3, 0.9);
  s.patch_types = 1;
  s.frame = 77;
  s.struct_size = offsetof(qses_settings, relaxation_steps);  // a caller who knows nothing of what follows
  s.relaxation_steps = 4000000000u;
  qses_mesh m = empty_mesh();
  ASSERT_EQ(qses_compute(context, &s, &m), QSES_OK) << qses_last_error();
  EXPECT_EQ(m.frame, 0u);
  EXPECT_EQ(m.patches, nullptr);
  const Surface given = copy_surface(context), expected = compute(water(), settings(0.3, 0.9));
  EXPECT_EQ(given.mesh.positions, expected.mesh.positions);
}

TEST(StructSize, ShorterMeshesAreFilledSoFar) {
  const Context context;
  set_atoms(context, water());
  qses_mesh m;
  std::memset(&m, 0xcc, sizeof m);
  const qses_mesh untouched = m;
  m.struct_size = offsetof(qses_mesh, normals);
  ASSERT_EQ(qses_compute(context, nullptr, &m), QSES_OK);
  EXPECT_EQ(m.struct_size, offsetof(qses_mesh, normals));
  EXPECT_GT(m.vertex_count, 0u);
  EXPECT_NE(m.positions, untouched.positions);
  EXPECT_EQ(m.normals, untouched.normals);
  EXPECT_EQ(m.bounds_max[2], untouched.bounds_max[2]);
  qses_report r;
  std::memset(&r, 0xcc, sizeof r);
  const uint64_t bricks = r.brick_count;
  r.struct_size = offsetof(qses_report, compute_ms);
  ASSERT_EQ(qses_get_report(context, &r), QSES_OK);
  EXPECT_GT(r.volume, 10.0);
  EXPECT_EQ(r.brick_count, bricks);
}

TEST(StructSize, LongerStructuresAreRead) {
  struct Newer {
    qses_settings known;
    uint32_t more[16];
  } newer;
  std::memset(&newer, 0xcc, sizeof newer);
  newer.known = settings(0.3);
  newer.known.struct_size = sizeof newer;
  struct NewerMesh {
    qses_mesh known;
    uint32_t more[16];
  } mesh;
  std::memset(&mesh, 0xcc, sizeof mesh);
  const uint32_t tail = mesh.more[0];
  mesh.known.struct_size = sizeof mesh;
  const Context context;
  set_atoms(context, water());
  ASSERT_EQ(qses_compute(context, &newer.known, &mesh.known), QSES_OK) << qses_last_error();
  EXPECT_EQ(mesh.known.vertex_count, compute(water(), settings(0.3)).vertex_count());
  EXPECT_EQ(mesh.known.struct_size, sizeof mesh);
  EXPECT_EQ(mesh.more[0], tail);
}

TEST_F(WithMesh, StructSizeErrors) {
  for (uint32_t size : {0u, 1u, 3u, 1000000u}) {
    qses_settings s = settings();
    s.struct_size = size;
    expect_error(qses_compute(context_, &s, nullptr), QSES_INVALID_ARGUMENT, {"settings", "struct_size"});
    qses_mesh m = empty_mesh();
    m.struct_size = size;
    expect_error(qses_compute(context_, nullptr, &m), QSES_INVALID_ARGUMENT, {"mesh", "struct_size"});
    expect_error(qses_get_mesh(context_, &m), QSES_INVALID_ARGUMENT, {"mesh", "struct_size"});
    qses_report r;
    qses_report_init(&r);
    r.struct_size = size;
    expect_error(qses_get_report(context_, &r), QSES_INVALID_ARGUMENT, {"report", "struct_size"});
    expect_unharmed();
  }
  expect_usable();
}

TEST(Init, FillsInAndIgnoresNull) {
  qses_settings s;
  std::memset(&s, 0xcc, sizeof s);
  qses_settings_init(&s);
  EXPECT_EQ(s.struct_size, sizeof s);
  EXPECT_EQ(s.surface, QSES_SURFACE_SES);
  EXPECT_EQ(s.method, QSES_METHOD_EXACT);
  EXPECT_EQ(s.probe_radius, 1.4f);
  EXPECT_EQ(s.spacing, 0.5f);
  EXPECT_EQ(s.relaxation_steps, 1u);
  EXPECT_EQ(s.slice_size, 0u);
  EXPECT_EQ(s.winding, QSES_WINDING_OUTWARD);
  EXPECT_EQ(s.patch_types, 0u);
  EXPECT_EQ(s.measure, 1u);
  EXPECT_EQ(s.frame, 0u);
  qses_mesh m;
  std::memset(&m, 0xcc, sizeof m);
  qses_mesh_init(&m);
  EXPECT_EQ(m.struct_size, sizeof m);
  EXPECT_EQ(m.vertex_count, 0u);
  EXPECT_EQ(m.positions, nullptr);
  qses_report r;
  std::memset(&r, 0xcc, sizeof r);
  qses_report_init(&r);
  EXPECT_EQ(r.struct_size, sizeof r);
  EXPECT_EQ(r.stage_count, 0u);
  qses_settings_init(nullptr);
  qses_mesh_init(nullptr);
  qses_report_init(nullptr);
}

// ---- atoms

TEST_F(WithMesh, SetAtomsErrors) {
  const Atoms good = water();
  const auto bad = [&](Atoms atoms, std::initializer_list<const char *> words) {
    expect_error(qses_set_atoms(context_, atoms.positions.data(), 0, atoms.radii.data(), atoms.size()),
                 QSES_INVALID_ARGUMENT, words);
    expect_unharmed();
    expect_usable();  // with the atoms from before
    before_ = copy_surface(context_);
    ASSERT_EQ(qses_get_mesh(context_, &mesh_), QSES_OK);
  };
  for (float value : {kNan, kInf, -kInf, 1.1e6f, -3e38f})
    for (size_t component : {3u, 4u, 5u}) {
      Atoms a = good;
      a.positions[component] = value;
      bad(a, {"position", "atom 1"});
    }
  for (float value : {kNan, kInf, -1.f, 0.f, -0.f, 100.5f}) {
    Atoms a = good;
    a.radii[2] = value;
    bad(a, {"radius", "atom 2"});
  }
  const float *xyz = good.positions.data(), *r = good.radii.data();
  expect_error(qses_set_atoms(nullptr, xyz, 0, r, 3), QSES_INVALID_ARGUMENT, {"context"});
  expect_error(qses_set_atoms(context_, nullptr, 0, r, 3), QSES_INVALID_ARGUMENT, {"positions", "NULL"});
  expect_error(qses_set_atoms(context_, xyz, 0, nullptr, 3), QSES_INVALID_ARGUMENT, {"radii", "NULL"});
  for (size_t stride : {1u, 4u, 8u, 11u, 13u, 18u})
    expect_error(qses_set_atoms(context_, xyz, stride, r, 1), QSES_INVALID_ARGUMENT,
                 {"stride", std::to_string(stride).c_str()});
  expect_error(qses_set_atoms(context_, xyz, 0, r, size_t(1) << 40), QSES_INVALID_ARGUMENT, {"count"});
  expect_unharmed();
  expect_usable();
}

TEST_F(WithMesh, SetPositionsErrors) {
  Atoms a = water();
  const float *xyz = a.positions.data();
  expect_error(qses_set_positions(nullptr, xyz, 0, 3), QSES_INVALID_ARGUMENT, {"context"});
  expect_error(qses_set_positions(context_, nullptr, 0, 3), QSES_INVALID_ARGUMENT, {"positions", "NULL"});
  expect_error(qses_set_positions(context_, xyz, 0, 2), QSES_INVALID_ARGUMENT, {"count", "2", "3"});
  expect_error(qses_set_positions(context_, xyz, 0, 4), QSES_INVALID_ARGUMENT, {"count", "4", "3"});
  expect_error(qses_set_positions(context_, xyz, 10, 3), QSES_INVALID_ARGUMENT, {"stride", "10"});
  for (float value : {kNan, kInf, 2e6f}) {
    a.positions[7] = value;
    expect_error(qses_set_positions(context_, xyz, 0, 3), QSES_INVALID_ARGUMENT, {"position", "atom 2"});
  }
  expect_unharmed();
  expect_usable();
}

TEST(Atoms, AreCopied) {
  const Context context;
  auto atoms = std::make_unique<Atoms>(water());
  set_atoms(context, *atoms);
  for (float &p : atoms->positions) p = kNan;
  atoms.reset();
  ASSERT_EQ(qses_compute(context, nullptr, nullptr), QSES_OK);
  EXPECT_EQ(copy_surface(context).mesh.positions, compute(water(), settings()).mesh.positions);
}

TEST(Atoms, WithAStride) {
  const Atoms a = water();
  const Surface expected = compute(a, settings());
  for (size_t stride : {12u, 16u, 28u}) {
    std::vector<float> spread(a.size() * stride / 4, kNan);
    for (size_t i = 0; i < a.size(); ++i) std::copy_n(&a.positions[3 * i], 3, &spread[i * stride / 4]);
    const Context context;
    ASSERT_EQ(qses_set_atoms(context, spread.data(), stride, a.radii.data(), a.size()), QSES_OK);
    ASSERT_EQ(qses_compute(context, nullptr, nullptr), QSES_OK);
    EXPECT_EQ(copy_surface(context).mesh.positions, expected.mesh.positions);
    ASSERT_EQ(qses_set_positions(context, spread.data(), stride, a.size()), QSES_OK);
    ASSERT_EQ(qses_compute(context, nullptr, nullptr), QSES_OK);
    EXPECT_EQ(copy_surface(context).mesh.positions, expected.mesh.positions);
  }
}

TEST(Atoms, NewPositionsKeepTheRadii) {
  const Context context;
  const Atoms first = cluster(80, 3), moved = turned(first, 4, 5, 6);
  set_atoms(context, first);
  ASSERT_EQ(qses_compute(context, nullptr, nullptr), QSES_OK);
  ASSERT_EQ(qses_set_positions(context, moved.positions.data(), 0, moved.size()), QSES_OK);
  ASSERT_EQ(qses_compute(context, nullptr, nullptr), QSES_OK);
  EXPECT_EQ(copy_surface(context).mesh.positions, compute(moved, settings()).mesh.positions);
}

TEST(Atoms, OfCountZero) {
  const Context context;
  ASSERT_EQ(qses_set_atoms(context, nullptr, 0, nullptr, 0), QSES_OK) << qses_last_error();
  qses_mesh m;
  std::memset(&m, 0xcc, sizeof m);
  m.struct_size = sizeof m;
  ASSERT_EQ(qses_compute(context, nullptr, &m), QSES_OK) << qses_last_error();
  EXPECT_EQ(m.vertex_count, 0u);
  EXPECT_EQ(m.triangle_count, 0u);
  for (int d = 0; d < 3; ++d) EXPECT_TRUE(m.bounds_min[d] == 0 && m.bounds_max[d] == 0);
  ASSERT_EQ(qses_set_positions(context, nullptr, 0, 0), QSES_OK) << qses_last_error();
  EXPECT_GT(compute(context, water(), settings()).vertex_count(), 0u);
}

TEST(Atoms, OfNoneGiven) {
  const Context context;
  const Atoms a = water();
  expect_error(qses_compute(context, nullptr, nullptr), QSES_NO_RESULT, {"qses_set_atoms"});
  expect_error(qses_set_positions(context, a.positions.data(), 0, 3), QSES_NO_RESULT, {"qses_set_atoms"});
  qses_mesh m = empty_mesh();
  qses_report r;
  qses_report_init(&r);
  expect_error(qses_get_mesh(context, &m), QSES_NO_RESULT, {});
  expect_error(qses_get_report(context, &r), QSES_NO_RESULT, {});
  set_atoms(context, a);
  expect_error(qses_get_mesh(context, &m), QSES_NO_RESULT, {});
  EXPECT_EQ(qses_compute(context, nullptr, nullptr), QSES_OK);
}

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
  s.surface = static_cast<qses_surface>(3);
  bad(s, {"surface", "3"});
  s.surface = static_cast<qses_surface>(-1);
  bad(s, {"surface"});
  s = settings();
  s.method = static_cast<qses_method>(2);
  bad(s, {"method", "2"});
  s = settings();
  s.winding = static_cast<qses_winding>(2);
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
  expect_error(qses_get_mesh(nullptr, &mesh_), QSES_INVALID_ARGUMENT, {"context"});
  expect_error(qses_get_mesh(context_, nullptr), QSES_INVALID_ARGUMENT, {"mesh"});
  qses_report r;
  qses_report_init(&r);
  expect_error(qses_get_report(nullptr, &r), QSES_INVALID_ARGUMENT, {"context"});
  expect_error(qses_get_report(context_, nullptr), QSES_INVALID_ARGUMENT, {"report"});
  expect_error(qses_enable_stage_times(nullptr, 1), QSES_INVALID_ARGUMENT, {"context"});
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
  s.frame = 0xffffffffu;
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
      s.frame = frame;
      s.measure = measure;
      qses_mesh m = empty_mesh();
      ASSERT_EQ(qses_compute(context, &s, &m), QSES_OK);
      EXPECT_EQ(m.frame, frame);
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
    EXPECT_NEAR(outward.report.volume, reversed.report.volume, 1e-3 * outward.report.volume);  // of the molecule either way
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

TEST(Report, StageTimes) {
  const Context context;
  ASSERT_EQ(qses_enable_stage_times(context, 1), QSES_OK);
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
  ASSERT_EQ(qses_enable_stage_times(context, 0), QSES_OK);
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
        ASSERT_EQ(qses_set_progress_callback(context,
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
