// SPDX-License-Identifier: MIT
#include "parallel/lasting_tbb.h"

#if !defined(QSES_CPU_SYSTEM_OWN)
#include "parallel/this_process.h"
#include "parallel/work_before_exit.h"

#include <tbb/task_arena.h>

#include <atomic>
#include <cstdlib>
#include <exception>

namespace quickses {
namespace {

WorkBeforeExit beginning;
std::atomic<long> begun_by{0};  // a process
// TBB is there before this library is, so that its settings go after this is called.
const int registered = std::atexit([] { beginning.end(); });

unsigned begin_tbb() noexcept {
  unsigned threads = 1;
  begun_by = this_process();
  beginning.run([&] {
    try {
      static tbb::task_arena &held = *new tbb::task_arena;  // never destroyed
      held.initialize();
      threads = static_cast<unsigned>(held.max_concurrency());
    } catch (const std::exception &) {
    }
  });
  return threads;
}

}  // namespace

unsigned threads_of_tbb() noexcept {
  static const unsigned threads = begin_tbb();
  return threads;
}

bool is_tbb_of_this_process() noexcept { return begun_by == this_process(); }

}  // namespace quickses
#endif
