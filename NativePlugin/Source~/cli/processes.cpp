// SPDX-License-Identifier: MIT
// One process that does everything itself.
#include "cli/processes.h"

#include "quickses/quickses.h"

#include <algorithm>

namespace quickses::cli {

unsigned Processes::threads() const {
  qses_backend_description cpu;
  qses_backend_description_init(&cpu);
  qses_backend_info(QSES_BACKEND_CPU, &cpu);
  return std::max(1u, cpu.processors);
}

void Processes::agree(const Failure *failure) const {
  if (failure) throw Failure(*failure);
}

#if !defined(QUICKSES_HAS_MPI)
std::unique_ptr<Processes> start_processes(int *, char ***) { return std::make_unique<Processes>(); }
#endif

}  // namespace quickses::cli
