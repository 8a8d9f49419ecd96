// SPDX-License-Identifier: MIT
// Threads of contexts with qses_context_options.background stand back; the caller's does not.
#include "capi/capi_fixture.h"

#if defined(__linux__)
#include <dirent.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

#include <map>

using namespace capi_fixture;

namespace {

#if defined(__linux__)

// How nice the threads of this process are, by their numbers.
std::map<long, int> nice_of_threads() {
  std::map<long, int> found;
  DIR *const tasks = opendir("/proc/self/task");
  while (const dirent *entry = tasks ? readdir(tasks) : nullptr) {
    const long thread = std::atol(entry->d_name);
    if (thread > 0) found[thread] = getpriority(PRIO_PROCESS, static_cast<id_t>(thread));
  }
  if (tasks) closedir(tasks);
  return found;
}

// Threads that are nicer than the calling one, after a job and a computation. How nice that is stays.
size_t nicer_threads(bool background, uint32_t threads) {
  const long self = syscall(SYS_gettid);
  const int before = nice_of_threads()[self];
  qses_context_options options;
  qses_context_options_init(&options);
  options.backend = QSES_BACKEND_CPU;
  options.threads = threads;
  options.background = background ? 1 : 0;
  qses_context *context = nullptr;
  expect_ok(qses_context_create(&options, &context));
  set_atoms(context, cluster(2000, 2));
  expect_ok(qses_begin(context, nullptr));
  expect_ok(qses_wait(context, -1, nullptr));
  expect_ok(qses_compute(context, nullptr, nullptr));
  std::map<long, int> now = nice_of_threads();
  qses_context_destroy(context);
  EXPECT_EQ(now[self], before);
  size_t nicer = 0;
  for (const auto &thread : now) {
    nicer += thread.second > before ? 1 : 0;
    EXPECT_LE(thread.second, before + 10) << "helpers that a thread started which stands back do so once";
  }
  return nicer;
}

TEST(Background, OnlyWhereItIsAskedForAndNotForTheCaller) {
  if (getpriority(PRIO_PROCESS, 0) > 0) GTEST_SKIP() << "this process stands back already";
  EXPECT_EQ(nicer_threads(false, 2), 0u);
  EXPECT_EQ(nicer_threads(true, 1), 1u);  // the job's
  EXPECT_GE(nicer_threads(true, 2), 1u);  // and its helpers as far as they came to work
}

#endif

// The mesh is the same.
TEST(Background, ChangesNoByte) {
  const Atoms atoms = crambin();
  const Context usual;
  const Surface expected = compute(usual, atoms, settings());
  qses_context_options options;
  qses_context_options_init(&options);
  options.backend = tested_backend();
  options.background = 1;
  qses_context *context = nullptr;
  expect_ok(qses_context_create(&options, &context));
  const Surface found = compute(context, atoms, settings());
  qses_context_destroy(context);
  EXPECT_EQ(found.mesh.positions, expected.mesh.positions);
  EXPECT_EQ(found.mesh.indices, expected.mesh.indices);
}

}  // namespace
