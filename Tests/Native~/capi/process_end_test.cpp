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

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define QSES_TEST_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define QSES_TEST_SANITIZED
#endif
#endif

#if defined(__linux__) && !defined(QSES_TEST_SANITIZED)
// What is registered before any library begins is done after all of them have ended: the process lasts a little then,
// with the threads that it has. (Sanitizers themselves have not begun when it is registered.)
extern "C" int __cxa_atexit(void (*)(void *), void *, void *);
namespace {
void linger(void *) { std::this_thread::sleep_for(std::chrono::milliseconds(5)); }
void register_linger(int, char **, char **) { __cxa_atexit(linger, nullptr, nullptr); }
__attribute__((section(".preinit_array"), used)) void (*const first_of_all)(int, char **, char **) = register_linger;
}  // namespace
#endif

namespace {

constexpr int kProcesses = 60, kHelpers = 4;
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

[[noreturn]] void end_while_threads_compute(int threads, int ms) {
  for (int k = 0; k < threads; ++k) std::thread(compute_for_ever).detach();
  while (surfaces < threads) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(ms));
  ends = true;
  std::exit(0);
}

void end_processes(int threads) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";  // each is a fresh process: drivers do not survive a fork
  tested_backend();
  for (int k = 0; k < kProcesses; ++k)
    EXPECT_EXIT(end_while_threads_compute(threads, k % 10), testing::ExitedWithCode(0), "") << "process " << k;
}

TEST(ProcessEnd, DoesNotWaitForThreads) { end_processes(6); }

// Between two surfaces nobody computes: what they share is let go, and begun anew.
TEST(ProcessEnd, DoesNotWaitForAThread) { end_processes(1); }

}  // namespace
