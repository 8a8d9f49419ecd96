// SPDX-License-Identifier: MIT
// Parallel systems end the process, or half of their work, when the machine refuses them a thread. So it is asked
// first.
#pragma once

namespace quickses {

// How many threads, up to the number wanted, can be started besides those there are: tried out.
unsigned count_startable_threads(unsigned wanted);

}  // namespace quickses
