// SPDX-License-Identifier: MIT
// Work that would take minutes or hours ends soon after it is told to, whatever stage it is in.
#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

#if defined(_WIN32)
#include <windows.h>
#else
#include <ctime>
#endif

#include <atomic>
#include <chrono>
#include <thread>

using namespace surface_fixture;

namespace {

// What the process has computed so far, on all processors together: it does not matter for how long the machine stands
// still.
std::chrono::milliseconds computed() {
#if defined(_WIN32)
  const auto of = [](const FILETIME &time) {
    return (uint64_t(time.dwHighDateTime) << 32 | time.dwLowDateTime) / 10000;
  };
  FILETIME begin, end, kernel, user;
  GetProcessTimes(GetCurrentProcess(), &begin, &end, &kernel, &user);
  return std::chrono::milliseconds(of(kernel) + of(user));
#else
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return std::chrono::milliseconds(1000 * time.tv_sec + time.tv_nsec / 1000000);
#endif
}

// Far more than it takes, far less than the work would.
constexpr int64_t kSoonMs = 2000;

struct Case {
  const char *name;
  Atoms atoms;
  qses_settings settings;
};

Atoms crowd(size_t count, double edge, double radius) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(0, edge);
  Atoms atoms;
  for (size_t i = 0; i < count; ++i) atoms.add(place(random), place(random), place(random), radius);
  return atoms;
}

std::vector<Case> cases() {
  // An H200 takes less than 300 ms for a hundred steps at 0.08 Å.
  const double fine = tested_backend() == QSES_BACKEND_CUDA ? 0.05 : 0.08;
  std::vector<Case> all = {
      {"three atoms of which each visits a million bricks", crowd(3, 3, 1.7), settings(0.1, 100)},
      {"everybody is everybody's neighbour", crowd(60000, 60, 1.7), settings(0.5, 100)},
      {"many arcs at a brick", crowd(3000, 30, 1.7), settings(0.1, 40)},
      {"the grid method with a cube of 200 lattice points", crowd(3000, 60, 1.7), settings(0.1, 10)},
      {"many steps", crowd(20000, 62, 1.7), settings(fine)},
  };
  all[3].settings.method = QSES_METHOD_GRID;
  all[4].settings.relaxation_steps = 100;
  for (Case &c : all) c.settings.level_count = 0;
  return all;
}

// Cancels after a while, again and again, since a cancel that comes before the call does nothing.
template <class Call>
void expect_cancelled(qses_context *context, int milliseconds, const Call &call) {
  std::atomic<bool> done{false};
  qses_status status = QSES_OK;
  std::thread working([&] {
    status = call();
    done = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  const auto start = computed();
  while (!done) {
    qses_cancel(context);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  working.join();
  EXPECT_LT((computed() - start).count(), kSoonMs);
  EXPECT_EQ(status, QSES_CANCELLED);
}

class Cancel : public testing::TestWithParam<int> {};

TEST_P(Cancel, EndsAComputeSoon) {
  for (const Case &c : cases())
    for (unsigned threads : {1u, 2u}) {
      SCOPED_TRACE(c.name);
      const Context context(threads);
      set_atoms(context, c.atoms);
      expect_cancelled(context, GetParam(), [&] { return qses_compute(context, &c.settings, nullptr); });
      EXPECT_EQ(mesh_checks::manifold_fault(compute(context, cluster(50, 1), settings(1.0)).mesh), "");
    }
}

TEST_P(Cancel, EndsAJobAndDestroyDoesNotWaitForIt) {
  for (const Case &c : cases()) {
    SCOPED_TRACE(c.name);
    auto start = computed();
    {
      const Context context;
      set_atoms(context, c.atoms);
      expect_ok(qses_begin(context, &c.settings));
      std::this_thread::sleep_for(std::chrono::milliseconds(GetParam()));
      start = computed();
    }
    EXPECT_LT((computed() - start).count(), kSoonMs);
  }
}

INSTANTIATE_TEST_SUITE_P(AtOnceAndLater, Cancel, testing::Values(0, 30, 300));

// The only long thing an estimate does is to find the features.
TEST(CancelOfAnEstimate, EndsItSoon) {
  const Context context;
  set_atoms(context, crowd(100000, 60, 1.7));
  qses_size_estimate estimate;
  qses_size_estimate_init(&estimate);
  const qses_settings s = settings(0.5, 100);
  for (int milliseconds : {0, 100})
    expect_cancelled(context, milliseconds, [&] { return qses_estimate(context, &s, &estimate); });
  set_atoms(context, cluster(50, 1));
  EXPECT_EQ(qses_estimate(context, nullptr, &estimate), QSES_OK);
  EXPECT_GT(estimate.vertices, 0u);
}

TEST(CancelOfAnEstimate, ThatWaitsForAJob) {
  const Context context;
  set_atoms(context, crowd(60000, 60, 1.7));
  const qses_settings s = settings(0.5, 100);
  expect_ok(qses_begin(context, &s));
  qses_size_estimate estimate;
  qses_size_estimate_init(&estimate);
  expect_cancelled(context, 20, [&] { return qses_estimate(context, &s, &estimate); });
  EXPECT_EQ(qses_wait(context, -1, nullptr), QSES_OK);
}

}  // namespace
