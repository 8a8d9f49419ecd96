// SPDX-License-Identifier: MIT
// Runs of items: in memory, and by their numbers.
#pragma once

#include "parallel/platform.h"

namespace quickses {

template <class T>
struct Span {
  T *data = nullptr;
  size_t size = 0;
  QSES_FN T &operator[](size_t i) const { return data[i]; }
  QSES_FN T *begin() const { return data; }
  QSES_FN T *end() const { return data + size; }
};

// The items begin, ..., end - 1.
struct ItemRun {
  uint32_t begin, end;
};

}  // namespace quickses
