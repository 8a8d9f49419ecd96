// SPDX-License-Identifier: MIT
// Which process this is: a forked child has none of its parent's threads, and must not wait for one.
#pragma once

#if !defined(_WIN32)
#include <unistd.h>
#endif

namespace quickses {

inline long this_process() noexcept {
#if defined(_WIN32)
  return 1;  // it is not forked
#else
  return getpid();
#endif
}

}  // namespace quickses
