// SPDX-License-Identifier: MIT
#include "parallel/late_threads.h"

#if !defined(QSES_CPU_SYSTEM_OWN)
#include <tbb/task_arena.h>

#include <cstdlib>
#include <exception>

namespace quickses {
namespace {

void hold_tbb() {
  try {
    static tbb::task_arena &held = *new tbb::task_arena;  // never destroyed
    held.initialize();
  } catch (const std::exception &) {  // no memory: late threads will not come far either
  }
}

}  // namespace

void hold_tbb_for_late_threads() noexcept {
  // TBB's settings are older than any arena, and so are destroyed after this.
  static const int registered = std::atexit(hold_tbb);
  (void)registered;
}

}  // namespace quickses
#endif
