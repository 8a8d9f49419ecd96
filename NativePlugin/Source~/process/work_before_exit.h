// SPDX-License-Identifier: MIT
// What a thread must not be in the midst of as the process ends: what needs what other libraries give up then; and what
// loads libraries, since a process of glibc 2.36 that ended meanwhile was seen to do so with 127 (dl-sort-maps.c).
#pragma once

#include "process/this_process.h"

#include <atomic>

namespace quickses {

// Work of one thread at a time. Lives as long as there is a process.
class WorkBeforeExit {
 public:
  // Calls work(), which must not throw; or does nothing, where the process ends.
  template <class Work>
  void run(const Work &work) noexcept {
    begun_in_ = this_process();
    if (!is_over_) work();
    begun_in_ = 0;
  }
  // From std::atexit(), by a function that was registered behind whatever the work needs: waits for it if it is under
  // way, and from then on it is not begun any more. (By no lock: a child that was forked meanwhile has no such thread,
  // and would wait for ever.)
  void end() noexcept;

 private:
  std::atomic<long> begun_in_{0};  // the process whose thread works; 0: none
  std::atomic<bool> is_over_{false};
};

}  // namespace quickses
