// SPDX-License-Identifier: MIT
#include "parallel/lasting_tbb.h"

#if !defined(QSES_CPU_SYSTEM_OWN)
#include "parallel/work_before_exit.h"

#include <tbb/task_arena.h>

#include <cstdlib>
#include <exception>

namespace quickses {
namespace {

WorkBeforeExit beginning;
// TBB is there before this library is, so that its settings go after this is called.
const int registered = std::atexit([] { beginning.end(); });

unsigned begin_tbb() noexcept {
  unsigned threads = 1;
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

}  // namespace quickses
#endif
