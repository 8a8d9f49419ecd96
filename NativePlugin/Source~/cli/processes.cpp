// SPDX-License-Identifier: MIT
// One process that does everything itself.
#include "cli/processes.h"

#include <algorithm>
#include <thread>

namespace quickses::cli {

unsigned Processes::threads() const { return std::max(1u, std::thread::hardware_concurrency()); }

void Processes::agree(const Failure *failure) const {
  if (failure) throw Failure(*failure);
}

#if !defined(QUICKSES_HAS_MPI)
std::unique_ptr<Processes> start_processes(int *, char ***) { return std::make_unique<Processes>(); }
#endif

}  // namespace quickses::cli
