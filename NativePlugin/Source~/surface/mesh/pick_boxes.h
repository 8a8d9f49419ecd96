// SPDX-License-Identifier: MIT
// What makes it fast to find the triangle that a ray meets: boxes around runs of triangles, and around groups of runs.
// Triangles come in the order of their bricks, so runs of them are small in space.
#pragma once

#include "parallel/platform.h"

#include <cstddef>

namespace quickses {

constexpr size_t kRunTriangles = 64, kGroupRuns = 32;

struct Box {
  float low[3], high[3];
};

// In the memory of a mesh; null: it was not asked for.
struct PickBoxes {
  Box *runs = nullptr, *groups = nullptr;

  QSES_FN static size_t run_count(size_t triangles) { return (triangles + kRunTriangles - 1) / kRunTriangles; }
  QSES_FN static size_t group_count(size_t triangles) { return (run_count(triangles) + kGroupRuns - 1) / kGroupRuns; }
};

}  // namespace quickses
