// SPDX-License-Identifier: MIT
// Which threads compute, and how they stand to those of the program around the library.
#pragma once

namespace quickses {

struct WorkerThreads {
  WorkerThreads(unsigned count_, bool in_background_ = false) : count(count_), in_background(in_background_) {}
  unsigned count;      // with the one that calls; 0: one per hardware thread
  bool in_background;  // those that are the library's stand back behind threads of normal priority
};

// How many there are for this process; at least 1.
unsigned hardware_threads() noexcept;

// How many processors the calling thread, and what it starts, may run on, and are given time on; at least 1. A part of
// one counts as one.
unsigned processors() noexcept;

// From now on the calling thread, one of the library's, stands back. Never fails loudly.
void stand_back() noexcept;

}  // namespace quickses
