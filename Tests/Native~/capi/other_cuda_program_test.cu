// SPDX-License-Identifier: MIT
// Beside another user of CUDA in the process: neither disturbs the other. What a cudaDeviceReset by it means is an
// error, not a crash.
#include "surface/surface_fixture.h"

#include "capi/other_cuda_program.h"
#include "parallel/cuda_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

using namespace surface_fixture;

namespace {

#define REQUIRE_DEVICE() \
  if (!quickses::describe_cuda_device(0).available) GTEST_SKIP() << "no CUDA device"

struct Context {
  explicit Context(qses_backend backend) {
    qses_context_options options;
    qses_context_options_init(&options);
    options.backend = backend;
    expect_ok(qses_context_create(&options, &handle));
  }
  ~Context() { qses_context_destroy(handle); }
  Context(const Context &) = delete;
  Context &operator=(const Context &) = delete;

  qses_context *handle = nullptr;
};

Surface compute(qses_context *context, const Atoms &atoms) {
  const qses_settings s = settings(0.5);
  set_atoms(context, atoms);
  expect_ok(qses_compute(context, &s, nullptr));
  return copy_surface(context);
}

bool are_same(const Surface &a, const Surface &b) {
  return a.mesh.positions == b.mesh.positions && a.mesh.normals == b.mesh.normals && a.mesh.owners == b.mesh.owners &&
         a.mesh.indices == b.mesh.indices;
}

TEST(OtherCudaProgram, StartsFirst) {
  REQUIRE_DEVICE();
  ASSERT_TRUE(other_start());
  ASSERT_STREQ(other_work(), "");
  const Context context(QSES_BACKEND_CUDA);
  ASSERT_STREQ(other_work(), "");
  const Surface first = compute(context.handle, crambin());
  ASSERT_GT(first.mesh.indices.size(), 0u);
  for (int round = 0; round < 5; ++round) {
    ASSERT_STREQ(other_work(), "");
    EXPECT_TRUE(are_same(compute(context.handle, crambin()), first));
  }
  ASSERT_STREQ(other_work(), "");
  other_end();
  EXPECT_TRUE(are_same(compute(context.handle, crambin()), first));
}

TEST(OtherCudaProgram, StartsLaterAndOutlivesOurContexts) {
  REQUIRE_DEVICE();
  {
    const Context context(QSES_BACKEND_CUDA);
    const Surface first = compute(context.handle, crambin());
    ASSERT_TRUE(other_start());
    ASSERT_STREQ(other_work(), "");
    EXPECT_TRUE(are_same(compute(context.handle, crambin()), first));
  }
  ASSERT_STREQ(other_work(), "");
  const Context again(QSES_BACKEND_CUDA);
  EXPECT_GT(compute(again.handle, crambin()).mesh.indices.size(), 0u);
  ASSERT_STREQ(other_work(), "");
  other_end();
}

TEST(OtherCudaProgram, WorksAtTheSameTime) {
  REQUIRE_DEVICE();
  ASSERT_TRUE(other_start());
  const Context context(QSES_BACKEND_CUDA);
  const Atoms atoms = cluster(1500, 2);
  const Surface alone = compute(context.handle, atoms);
  std::atomic<int> different{0}, computing{3};
  std::vector<std::thread> threads;
  for (int t = 0; t < 3; ++t)
    threads.emplace_back([&] {
      const Context own(QSES_BACKEND_CUDA);
      for (int round = 0; round < 10; ++round) different += are_same(compute(own.handle, atoms), alone) ? 0 : 1;
      --computing;
    });
  std::string what;
  while (computing > 0 && what.empty()) what = other_work();
  for (std::thread &thread : threads) thread.join();
  EXPECT_EQ(what, "");
  EXPECT_STREQ(other_work(), "");
  EXPECT_EQ(different, 0);
  other_end();
}

// In a process of its own. A cudaDeviceReset takes away what our contexts have on the device; how many surfaces are
// computed before and tried after it. A warm context asks the driver for little.
void reset_under_our_feet(int before, int after, bool other_goes_on) {
  const auto demand = [](bool holds, const char *what) {
    if (holds) return;
    std::fprintf(stderr, "not so: %s (%s)\n", what, qses_last_error());
    std::_Exit(1);
  };
  demand(other_start(), "the other program starts");
  qses_context_options options;
  qses_context_options_init(&options);
  options.backend = QSES_BACKEND_CUDA;
  qses_context *context = nullptr;
  demand(qses_context_create(&options, &context) == QSES_OK, "a context is made");
  const Atoms atoms = cluster(200, 1);
  demand(qses_set_atoms(context, atoms.positions.data(), 0, atoms.radii.data(), atoms.size()) == QSES_OK, "atoms");
  qses_mesh mesh;
  qses_mesh_init(&mesh);
  for (int k = 0; k < before; ++k) demand(qses_compute(context, nullptr, &mesh) == QSES_OK, "a surface is computed");
  demand(mesh.vertex_count > 0, "there is a mesh");
  const std::vector<float> positions(mesh.positions, mesh.positions + 3 * mesh.vertex_count);
  demand(other_reset(), "the device is reset");
  if (other_goes_on) demand(other_start() && !other_work()[0], "the other program goes on");
  for (int k = 0; k < after; ++k) {
    const qses_status status = qses_compute(context, nullptr, nullptr);
    std::fprintf(stderr, "after the reset: status %d, %s\n", status, qses_last_error());
    demand(status != QSES_OK && qses_last_error()[0] != 0, "the context says that it has ended");
  }
  demand(std::equal(positions.begin(), positions.end(), mesh.positions), "the last mesh is still there");
  qses_context_destroy(context);
  context = nullptr;
  options.backend = QSES_BACKEND_CPU;
  demand(qses_context_create(&options, &context) == QSES_OK, "a context on the CPU is made");
  demand(qses_set_atoms(context, atoms.positions.data(), 0, atoms.radii.data(), atoms.size()) == QSES_OK, "atoms");
  demand(qses_compute(context, nullptr, nullptr) == QSES_OK, "the CPU computes");
  qses_context_destroy(context);
  options.backend = QSES_BACKEND_CUDA;
  const qses_status status = qses_context_create(&options, &context);
  demand(status == QSES_BACKEND_UNAVAILABLE, "a new context with CUDA is refused");
  std::_Exit(0);
}

TEST(OtherCudaProgramDeathTest, ResetIsAnErrorAndNoCrash) {
  if (quickses::count_cuda_devices() == 0) GTEST_SKIP() << "no CUDA device";
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  for (const bool other_goes_on : {false, true})
    for (const int before : {1, 2, 3})
      for (const int after : {0, 1, 2})
        EXPECT_EXIT(reset_under_our_feet(before, after, other_goes_on), ::testing::ExitedWithCode(0),
                    after ? "after the reset" : "")
            << before << " surfaces before, " << after << " after, " << (other_goes_on ? "the other goes on" : "");
}

}  // namespace
