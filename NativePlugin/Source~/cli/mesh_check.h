// SPDX-License-Identifier: MIT
// Facts about a mesh, found from its triangles alone.
#pragma once

#include <cstdint>
#include <vector>

#include "quickses/quickses.h"

namespace quickses::cli {

// True if every directed edge occurs once and its reverse once: closed, with one orientation.
bool is_closed(const qses_mesh &mesh);

struct Component {
  uint32_t triangles = 0;
  double area = 0;    // Å²
  double volume = 0;  // Å³; negative: a cavity
};

// Pieces connected through shared vertices, the largest area first.
std::vector<Component> find_components(const qses_mesh &mesh);

}  // namespace quickses::cli
