// SPDX-License-Identifier: MIT
// A process that ends while threads compute, begin and end: it does end, and with its own status.
#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <thread>

using namespace surface_fixture;

namespace {

constexpr int kThreads = 6, kProcesses = 60, kHelpers = 4;
std::atomic<int> surfaces{0};
std::atomic<bool> ends{false};

// What fails when the process ends already is nobody's loss.
void compute_once() {
  try {
    Context context(kHelpers);
    compute(context, Atoms().add(0, 0, 0, 1.7).add(2, 0, 0, 1.5), settings());
    ++surfaces;
  } catch (const std::exception &) {
    if (!ends) std::_Exit(1);
  }
}

// Each surface by a thread of its own, with which those that helped it end.
[[noreturn]] void compute_for_ever() {
  for (;;) std::thread(compute_once).join();
}

[[noreturn]] void end_while_threads_compute(int ms) {
  for (int k = 0; k < kThreads; ++k) std::thread(compute_for_ever).detach();
  while (surfaces < kThreads) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(ms));
  ends = true;
  std::exit(0);
}

TEST(ProcessEnd, DoesNotWaitForThreads) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";  // each is a fresh process: drivers do not survive a fork
  tested_backend();
  for (int k = 0; k < kProcesses; ++k)
    EXPECT_EXIT(end_while_threads_compute(k % 10), testing::ExitedWithCode(0), "") << "process " << k;
}

}  // namespace
