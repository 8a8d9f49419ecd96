// SPDX-License-Identifier: MIT
#include "process/work_before_exit.h"

#include <chrono>
#include <thread>

namespace quickses {

// A thread says that it has begun before it asks whether all is over, and who ends says so before it asks for a thread:
// so one of them always sees the other.
void WorkBeforeExit::end() noexcept {
  is_over_ = true;
#if !defined(_WIN32)  // which ends all other threads first
  while (begun_in_ == this_process()) std::this_thread::sleep_for(std::chrono::microseconds(50));
#endif
}

}  // namespace quickses
