// SPDX-License-Identifier: MIT
// The C API: back ends, contexts, errors, atoms (sizes of structures: struct_size_test.cpp). What it promises, and what
// it says about every bad argument.
#include "capi/capi_fixture.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <thread>

#if defined(__linux__)
#include <sched.h>
#endif

namespace {

using namespace capi_fixture;

// ---- versions and back ends

TEST(Version, IsThatOfTheHeader) {
  EXPECT_EQ(qses_abi_version(), uint32_t(QSES_ABI_VERSION));
  int major = -1, minor = -1, patch = -1;
  EXPECT_EQ(std::sscanf(qses_version(), "%d.%d.%d", &major, &minor, &patch), 3);
  EXPECT_EQ(qses_version(), qses_version());  // static storage
}

TEST(BackendInfo, OfTheCpu) {
  qses_backend_description d = empty_description();
  ASSERT_EQ(qses_backend_info(QSES_BACKEND_CPU, &d), QSES_OK);
  EXPECT_EQ(d.available, 1);
  EXPECT_STREQ(d.reason, "");
  EXPECT_NE(std::string(d.device).find("CPU"), std::string::npos);
  EXPECT_GT(d.total_memory, uint64_t(1) << 20);
  EXPECT_GT(d.free_memory, 0u);
  EXPECT_LE(d.free_memory, d.total_memory);
  EXPECT_GE(d.processors, 1u);
}

#if defined(__linux__)
TEST(BackendInfo, CountsTheProcessorsThatTheThreadMayRunOn) {
  std::thread([] {
    cpu_set_t all, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
    CPU_ZERO(&one);
    for (int k = 0; k < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++k)
      if (CPU_ISSET(k, &all)) CPU_SET(k, &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    for (const qses_backend backend : {QSES_BACKEND_CPU, QSES_BACKEND_CUDA, QSES_BACKEND_AUTO}) {
      qses_backend_description d = empty_description();
      ASSERT_EQ(qses_backend_info(backend, &d), QSES_OK);
      EXPECT_EQ(d.processors, 1u);
    }
    // That many threads of a context work, also of one that may have more.
    qses_context_options options;
    qses_context_options_init(&options);
    options.backend = QSES_BACKEND_CPU;
    options.threads = 7;
    qses_context *context = nullptr;
    ASSERT_EQ(qses_context_create(&options, &context), QSES_OK);
    qses_backend_description d = empty_description();
    qses_backend used;
    ASSERT_EQ(qses_context_info(context, &used, &d), QSES_OK);
    EXPECT_NE(std::string(d.device).find(", 1 thread)"), std::string::npos) << d.device;
    qses_context_destroy(context);
  }).join();
}
#endif

TEST(BackendInfo, AutoIsOneOfTheOthersAndSaysWhy) {
  qses_backend_description cuda = empty_description(), chosen = cuda, cpu = cuda;
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
  expect_error(qses_backend_info(QSES_BACKEND_CPU, nullptr), QSES_INVALID_ARGUMENT, {"description", "NULL"});
  // (Numbers that name no back end: capi_c99_test.c.)
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

TEST(LastError, LongOnesAreCutBetweenLetters) {
  constexpr size_t kMost = 2047;
  const std::string letter = u8"\u00e4";
  for (const std::string begin : {"", "x"}) {
    std::string path = begin;
    while (path.size() < 2 * kMost) path += letter;
    qses_structure *structure = nullptr;
    ASSERT_EQ(qses_structure_open(path.c_str(), nullptr, &structure), QSES_FILE_ERROR);
    const std::string message = qses_last_error();
    EXPECT_EQ(message.size(), kMost - begin.size());
    EXPECT_EQ(message, "'" + path.substr(0, message.size() - 1));
  }
  std::string before;
  for (size_t size = kMost - 100; size < kMost + 50; ++size) {  // from those that just fit to those that just don't
    qses_structure *structure = nullptr;
    ASSERT_EQ(qses_structure_open(std::string(size, 'x').c_str(), nullptr, &structure), QSES_FILE_ERROR);
    const std::string message = qses_last_error();
    EXPECT_EQ(message.size(), std::min(kMost, before.empty() ? message.size() : before.size() + 1));
    before = message;
  }
  EXPECT_EQ(before.size(), kMost);
}

#if !defined(_WIN32)  // where memory of MinGW's thread_local objects, also of this one, is gone before they are
struct FailsAsItsThreadEnds {
  std::string *message;
  ~FailsAsItsThreadEnds() {
    qses_backend_info(QSES_BACKEND_CPU, nullptr);
    *message = qses_last_error();
  }
};

TEST(LastError, IsThereAsLongAsItsThread) {
  std::string message;
  std::thread([&] {
    thread_local FailsAsItsThreadEnds last{&message};
    (void)last;
    qses_compute(nullptr, nullptr, nullptr);  // after last was made, so what this makes is gone before last is
  }).join();
  EXPECT_NE(message.find("description"), std::string::npos);
}
#endif

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
  ASSERT_EQ(qses_context_create(nullptr, &context), QSES_OK) << qses_last_error();
  qses_backend backend = QSES_BACKEND_AUTO;
  qses_backend_description d = empty_description(), chosen = d;
  ASSERT_EQ(qses_context_info(context, &backend, &d), QSES_OK);
  ASSERT_EQ(qses_backend_info(QSES_BACKEND_AUTO, &chosen), QSES_OK);
  EXPECT_NE(backend, QSES_BACKEND_AUTO);
  EXPECT_STREQ(d.device, chosen.device);
  EXPECT_STREQ(d.reason, chosen.reason);
  EXPECT_EQ(qses_context_info(context, nullptr, nullptr), QSES_OK);
  EXPECT_EQ(d.struct_size, sizeof d);
  expect_error(qses_context_info(nullptr, &backend, &d), QSES_INVALID_ARGUMENT, {"context"});
  qses_context_destroy(context);
  qses_context_destroy(nullptr);
}

TEST(Create, TheCpuIsNamedWithTheThreadsOfTheContext) {
  for (const uint32_t threads : {1u, 4096u}) {
    const Context context(threads, 0, QSES_BACKEND_CPU);
    qses_backend_description d = empty_description();
    ASSERT_EQ(qses_context_info(context, nullptr, &d), QSES_OK);
    unsigned named = 0;
    ASSERT_EQ(std::sscanf(d.device, "CPU (%*[^,], %u thread", &named), 1) << d.device;
    EXPECT_GE(named, 1u);
    EXPECT_LE(named, std::min(threads, std::max(1u, std::thread::hardware_concurrency())));
  }
}

TEST(Create, CudaUnavailableSaysWhy) {
  qses_backend_description d = empty_description();
  ASSERT_EQ(qses_backend_info(QSES_BACKEND_CUDA, &d), QSES_OK);
  if (d.available) GTEST_SKIP() << "there is a CUDA device";
  EXPECT_STRNE(d.reason, "");
  qses_context_options o;
  qses_context_options_init(&o);
  o.backend = QSES_BACKEND_CUDA;
  qses_context *context = reinterpret_cast<qses_context *>(&o);
  expect_error(qses_context_create(&o, &context), QSES_BACKEND_UNAVAILABLE, {d.reason});
  EXPECT_EQ(context, nullptr);
}

TEST(Create, Errors) {
  qses_context_options o;
  qses_context_options_init(&o);
  expect_error(qses_context_create(&o, nullptr), QSES_INVALID_ARGUMENT, {"context"});
  const auto refused = [&](std::initializer_list<const char *> words) {
    qses_context *context = reinterpret_cast<qses_context *>(&o);
    expect_error(qses_context_create(&o, &context), QSES_INVALID_ARGUMENT, words);
    EXPECT_EQ(context, nullptr);
    qses_context_options_init(&o);
  };
  set_any(&o.backend, 17);
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

// ---- atoms

TEST_F(WithMesh, SetAtomsErrors) {
  const Atoms good = water();
  const auto bad = [&](Atoms atoms, std::initializer_list<const char *> words) {
    expect_error(qses_set_atoms(context_, atoms.positions.data(), 0, atoms.radii.data(), atoms.size()),
                 QSES_INVALID_ARGUMENT, words);
    expect_unharmed();
    expect_usable();  // with the atoms from before
    before_ = copy_surface(context_);
    ASSERT_EQ(qses_context_mesh(context_, &mesh_), QSES_OK);
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
  for (size_t stride : {~size_t{0} - 3, ~size_t{0} / 4 + 1})  // the first is -4, which steps backwards
    expect_error(qses_set_atoms(context_, xyz, stride, r, 3), QSES_INVALID_ARGUMENT,
                 {"stride is", std::to_string(stride).c_str(), "3 positions"});
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

TEST(Atoms, OneIsSingular) {
  const Context context;
  set_atoms(context, Atoms().add(0, 0, 0, 1));
  const float xyz[6] = {};
  const uint32_t index = 1;
  EXPECT_EQ(qses_set_positions(context, xyz, 0, 2), QSES_INVALID_ARGUMENT);
  EXPECT_STREQ(qses_last_error(), "count is 2 but the context has 1 atom");
  EXPECT_EQ(qses_set_positions_indexed(context, xyz, 0, 1, &index, 1), QSES_INVALID_ARGUMENT);
  EXPECT_STREQ(qses_last_error(), "indices[0] is 1 but there is 1 position");
  EXPECT_EQ(qses_set_positions_indexed(context, xyz, 0, size_t(1) << 31, &index, 1), QSES_INVALID_ARGUMENT);
  EXPECT_STREQ(qses_last_error(), "position_count is 2147483648: at most 2147483647 are possible");
}

TEST(LastError, NumbersDifferFromTheLimitThatTheyExceed) {
  const Context context;
  Atoms atoms = Atoms().add(0, 0, 0, 1);
  atoms.radii[0] = std::nextafter(100.f, kInf);
  EXPECT_EQ(qses_set_atoms(context, atoms.positions.data(), 0, atoms.radii.data(), 1), QSES_INVALID_ARGUMENT);
  EXPECT_STREQ(qses_last_error(), u8"radius of atom 0 is 100.00001: it must be above 0 and at most 100 \u00c5");
  atoms = Atoms().add(std::nextafter(1e6f, kInf), 0.1f, 0, 1);
  EXPECT_EQ(qses_set_atoms(context, atoms.positions.data(), 0, atoms.radii.data(), 1), QSES_INVALID_ARGUMENT);
  EXPECT_STREQ(qses_last_error(),
               u8"position of atom 0 is (1000000.06, 0.1, 0): coordinates must lie within 1e6 \u00c5 of the origin");
  set_atoms(context, Atoms().add(0, 0, 0, 1));
  qses_settings settings;
  qses_settings_init(&settings);
  settings.relaxation_steps = UINT32_MAX;
  EXPECT_EQ(qses_compute(context, &settings, nullptr), QSES_INVALID_ARGUMENT);
  EXPECT_STREQ(qses_last_error(), "settings.relaxation_steps is 4294967295: it must lie between 0 and 100");
  qses_settings_init(&settings);
  settings.gaussian_radius_scale = std::nextafter(0.05f, 0.f);
  EXPECT_EQ(qses_compute(context, &settings, nullptr), QSES_INVALID_ARGUMENT);
  EXPECT_STREQ(qses_last_error(), "settings.gaussian_radius_scale is 0.049999997: it must lie between 0.05 and 10");
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

TEST(Atoms, ThatAreRefusedChangeNothing) {
  const Context context;
  const Surface before = compute(context, water(), settings());
  std::vector<float> positions = water().positions;
  const std::vector<float> radii(3, 3.f);
  positions[4] = kNan;
  expect_error(qses_set_atoms(context, positions.data(), 0, radii.data(), 3), QSES_INVALID_ARGUMENT, {"atom 1"});
  expect_ok(qses_set_positions(context, water().positions.data(), 0, 3));
  const qses_settings s = settings();
  expect_ok(qses_compute(context, &s, nullptr));
  EXPECT_EQ(copy_surface(context).mesh.positions, before.mesh.positions);
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
  expect_error(qses_compute(context, nullptr, nullptr), QSES_NO_ATOMS, {"qses_set_atoms"});
  expect_error(qses_set_positions(context, a.positions.data(), 0, 3), QSES_NO_ATOMS, {"qses_set_atoms"});
  qses_mesh m = empty_mesh();
  qses_report r;
  qses_report_init(&r);
  expect_error(qses_context_mesh(context, &m), QSES_NO_RESULT, {});
  expect_error(qses_context_report(context, &r), QSES_NO_RESULT, {});
  set_atoms(context, a);
  expect_error(qses_context_mesh(context, &m), QSES_NO_RESULT, {});
  EXPECT_EQ(qses_compute(context, nullptr, nullptr), QSES_OK);
}

}  // namespace
