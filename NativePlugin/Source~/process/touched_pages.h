// SPDX-License-Identifier: MIT
// Memory of the host that is there already: large pages where it is much and the system has them, touched by several
// threads. To lock such pages for a GPU is quick, where cudaHostAlloc gets them one by one.
#pragma once

#include <cstddef>

namespace quickses {

// Source of GrowingBuffer, of whole pages.
struct TouchedPages {
  // Null where the machine has not four times as much to give: what is touched can't be refused any more.
  static void *acquire(size_t bytes);
  static void release(void *memory);
};

}  // namespace quickses
