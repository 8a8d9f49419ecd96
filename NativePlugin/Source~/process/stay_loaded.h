// SPDX-License-Identifier: MIT
// Threads that outlive the work they did need their code.
#pragma once

namespace quickses {

// From now on the library that this code is in stays in the process: a host that unloads it, and loads it again, gets
// the same one. The thread that gives memory back (later_release.h) may end later than the contexts it
// was of, in code that would be gone; CUDA's driver knows of kernels and memory in it. Does nothing in a program. Any
// thread.
void stay_loaded();

}  // namespace quickses
