// SPDX-License-Identifier: MIT
// Threads that still compute while the process ends.
#pragma once

namespace quickses {

// From when the process ends, TBB is held: a thread that then found it let go, as it is while nobody computes, would
// start it anew by settings that the process has destroyed (oneTBB 2021.8 dies of that: "pure virtual method called").
// Any thread. Never fails loudly.
void hold_tbb_for_late_threads() noexcept;

}  // namespace quickses
