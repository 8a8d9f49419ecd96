// SPDX-License-Identifier: MIT
#include "parallel/lasting_tbb.h"

#if !defined(QSES_CPU_SYSTEM_OWN)
#include <tbb/task_arena.h>

#include <atomic>
#include <cstdlib>
#include <exception>

namespace quickses {
namespace {

std::atomic<bool> process_ends{false};
// TBB is there before this library is, so that its settings go after this is called. (It only tells: a child that was
// forked while a thread held a lock would wait for it here.)
const int registered = std::atexit([] { process_ends = true; });

unsigned begin_tbb() noexcept {
  if (process_ends) return 1;
  try {
    static tbb::task_arena &held = *new tbb::task_arena;  // never destroyed
    held.initialize();
    return static_cast<unsigned>(held.max_concurrency());
  } catch (const std::exception &) {
    return 1;
  }
}

}  // namespace

unsigned threads_of_tbb() noexcept {
  static const unsigned threads = begin_tbb();
  return threads;
}

}  // namespace quickses
#endif
