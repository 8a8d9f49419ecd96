// SPDX-License-Identifier: MIT
// Memory of the host that is there already: large pages where the system has them, touched by several threads. To lock
// such pages for a GPU is quick, where cudaHostAlloc gets them one by one.
#pragma once

#include <cstddef>

namespace quickses {

// Source of GrowingBuffer, of memory that is given to a GPU whole.
struct TouchedPages {
  static constexpr size_t kWorthIt = size_t(4) << 20;  // less is taken from elsewhere
  // Null where the machine has not four times as much to give: what is touched can't be refused any more.
  static void *acquire(size_t bytes);
  static void release(void *memory);
};

}  // namespace quickses
