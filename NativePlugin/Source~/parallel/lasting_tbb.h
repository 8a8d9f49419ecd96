// SPDX-License-Identifier: MIT
// TBB for as long as there is a process.
#pragma once

namespace quickses {

// How many threads TBB has, with the one that calls; 1: it must not be used. The first call begins it, and from then on
// it is held for good: where nobody holds it, as while nobody computes, it ends, and would be begun anew, by settings
// that are gone while the process ends (oneTBB 2021.8 dies of that: "pure virtual method called"). So it is not begun
// any more when the process ends, which waits for a thread that begins it just then; nor where that failed once, since
// a second attempt would wait for the first for ever. Any thread.
unsigned threads_of_tbb() noexcept;

// Whether TBB was begun by this process. Not in a forked child: what TBB's threads held as it forked (they look for
// work for a while after there was some) is held there for ever, so that it must not even be given up.
bool is_tbb_of_this_process() noexcept;

}  // namespace quickses
