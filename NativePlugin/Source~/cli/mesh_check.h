// SPDX-License-Identifier: MIT
// Whether a mesh is closed: the library promises it, and the program looks before it writes anything.
#pragma once

#include "quickses/quickses.h"

namespace quickses::cli {

// True if every directed edge occurs once and its reverse once: closed, with one orientation. Vertices that stand for
// others are taken for those.
bool is_closed(const qses_mesh &mesh);

}  // namespace quickses::cli
