// SPDX-License-Identifier: MIT
// A process that ends while threads compute, begin and end: it does end, and with its own status.
#include "process/forked_child.h"
#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <system_error>
#include <thread>

using namespace surface_fixture;

#if defined(__SANITIZE_THREAD__)
// Helpers that have ended, but whose context had not joined them yet as the process ended, are no fault here.
extern "C" const char *__tsan_default_options() { return "report_thread_leaks=0"; }
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
  for (;;) try {
      std::thread(compute_once).join();
    } catch (const std::system_error &) {  // the machine has none to give just now
      std::this_thread::yield();
    }
}

[[noreturn]] void end_while_threads_compute(int threads, int ms) {
  for (int k = 0; k < threads; ++k) std::thread(compute_for_ever).detach();
  while (surfaces < threads) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(ms));
  ends = true;
  std::exit(0);
}

#if !defined(_WIN32)
const char kPdb[] = "HETATM    1 FE   HEM A   1       1.000   2.000   3.000  1.00  0.00          FE\nEND\n";
const char kMmcif[] =
    "data_x\nloop_\n_atom_site.type_symbol\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\nC 1 2 3\n";
std::atomic<int> structures{0};

[[noreturn]] void read_for_ever() {
  for (;; ++structures)
    for (const std::string text : {kPdb, kMmcif}) {
      qses_structure_options options;
      qses_structure_options_init(&options);
      options.selection = "all and not (resname ALA or water)";
      qses_structure *structure = nullptr;
      if (qses_structure_open_memory(text.data(), text.size(), &options, &structure) != QSES_OK) std::_Exit(1);
      qses_structure_close(structure);
    }
}

[[noreturn]] void end_while_structures_are_read() {
  for (int k = 0; k < 4; ++k) std::thread(read_for_ever).detach();
  while (structures < 100) std::this_thread::yield();
  std::exit(0);
}
#endif

class ProcessEnd : public testing::Test {
 protected:
  // Each is a fresh process: drivers do not survive a fork.
  void SetUp() override { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
};

void end_processes(int threads) {
  tested_backend();
  for (int k = 0; k < kProcesses; ++k)
    EXPECT_EXIT(end_while_threads_compute(threads, k % 10), testing::ExitedWithCode(0), "") << "process " << k;
}

TEST_F(ProcessEnd, DoesNotWaitForThreads) { end_processes(6); }

// Between two surfaces nobody computes.
TEST_F(ProcessEnd, DoesNotWaitForAThread) { end_processes(1); }

// The first surface, in a context that was made in time or in one that was not, is made while the process ends.
[[noreturn]] void end_before_the_first_surface(bool has_context, int ms) {
  static Context *const early = has_context ? new Context(kHelpers) : nullptr;  // never destroyed
  for (int k = 0; k < 3; ++k)
    std::thread([k, ms] {
      while (!ends) std::this_thread::yield();
      std::this_thread::sleep_for(std::chrono::milliseconds(ms));
      try {
        if (early && k == 0) compute(*early, Atoms().add(0, 0, 0, 1.7).add(2, 0, 0, 1.5), settings());
        compute_once();
      } catch (const std::exception &) {
      }
    }).detach();
  ends = true;
  std::exit(0);
}

TEST_F(ProcessEnd, BeforeTheFirstSurface) {
  tested_backend();
  for (int k = 0; k < kProcesses; ++k)
    EXPECT_EXIT(end_before_the_first_surface(k % 2 == 0, k / 2 % 6), testing::ExitedWithCode(0), "") << "process " << k;
}

#if defined(QSES_TEST_FORKS)
// Threads of the parent hold whatever they hold as it forks; the child ends all the same.
[[noreturn]] void fork_while_a_thread_computes(int first_surfaces) {
  std::thread(compute_for_ever).detach();
  while (surfaces < first_surfaces) std::this_thread::yield();
  for (int k = 0; k < 400; ++k)
    if (!forked_child_ends([] {})) {
      std::fprintf(stderr, "child %d\n", k);
      std::_Exit(1);
    }
  std::_Exit(0);
}

TEST_F(ProcessEnd, OfForkedChildren) {
  if (tested_backend() != QSES_BACKEND_CPU) GTEST_SKIP() << "drivers do not survive a fork";
  for (const int first_surfaces : {20, 0})
    EXPECT_EXIT(fork_while_a_thread_computes(first_surfaces), testing::ExitedWithCode(0), "") << first_surfaces;
}

// Forked while nothing runs, a child may compute, also in what its parent made, and give that up.
[[noreturn]] void compute_in_forked_children() {
  const auto positions_of = [](Context &context) { return compute(context, crambin(), settings()).mesh.positions; };
  auto context = std::make_unique<Context>(kHelpers);
  const auto expected = positions_of(*context);
  for (int k = 0; k < 100; ++k) {  // the parent's threads wait awake for a while
    const bool ends = forked_child_ends([&] {
      Context own(kHelpers);
      if (positions_of(own) != expected || positions_of(*context) != expected) std::_Exit(1);
      context.reset();
    });
    if (!ends || positions_of(*context) != expected) std::_Exit(1);
  }
  std::_Exit(0);
}

TEST_F(ProcessEnd, ForkedChildrenMayCompute) {
  if (tested_backend() != QSES_BACKEND_CPU) GTEST_SKIP() << "drivers do not survive a fork";
  EXPECT_EXIT(compute_in_forked_children(), testing::ExitedWithCode(0), "");
}
#endif

#if !defined(_WIN32)  // Wine ends the threads first, also in the midst of what they do to its heap
TEST_F(ProcessEnd, StructuresMayBeReadMeanwhile) {
  for (int k = 0; k < kProcesses / 3; ++k)
    EXPECT_EXIT(end_while_structures_are_read(), testing::ExitedWithCode(0), "") << "process " << k;
}
#endif

}  // namespace
