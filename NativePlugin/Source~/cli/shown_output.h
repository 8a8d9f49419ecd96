// SPDX-License-Identifier: MIT
// Outputs that show a surface.
#pragma once

#include "cli/options.h"

namespace quickses::cli {

// Whether the output, if there is one, is a picture or a page, and whether it is a page: one file for all frames.
bool makes_shown(const Options &options);
bool makes_page(const Options &options);
// Whether the walls of cavities are left out of the mesh: they were not asked for, or nobody sees them.
bool has_outer_only(const Options &options);

}  // namespace quickses::cli
