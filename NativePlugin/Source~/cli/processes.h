// SPDX-License-Identifier: MIT
// The processes that share the frames of a trajectory: this one alone or, under MPI, many (mpi_processes.cpp).
#pragma once

#include <memory>

#include "cli/exit_code.h"
#include "cli/frame_ledger.h"

namespace quickses::cli {

// This process alone. Members are called from the main thread.
class Processes {
 public:
  virtual ~Processes() = default;

  virtual int rank() const { return 0; }
  virtual int count() const { return 1; }
  virtual int local_rank() const { return 0; }  // among those on the same machine
  virtual unsigned threads() const;             // this process's share of the processors it may run on
  virtual uint64_t sum(uint64_t value) const { return value; }
  bool is_first() const { return rank() == 0; }

  // Every process calls it, with its failure or null. If any has failed, the failure of the first of them is thrown in
  // all of them, so that they end together and it can be told once.
  virtual void agree(const Failure *failure) const;

  // Where the workers of a process other than the first get their frames. Null in the first, which has the ledger.
  virtual std::unique_ptr<FrameSupply> remote_supply() { return nullptr; }
  // In the first process: hands frames of the ledger to the others until all have said that they are done. If it can't
  // go on, all processes are ended: the others wait for its answers.
  virtual void serve(FrameLedger &) {}
  // In the others, after their workers are done.
  virtual void say_done() {}
};

// Call it once, before anything else. Throws Failure.
std::unique_ptr<Processes> start_processes(int *argc, char ***argv);

}  // namespace quickses::cli
