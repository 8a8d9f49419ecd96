// SPDX-License-Identifier: MIT
// A hint for those who did not think of the water in their file.
#pragma once

#include "cli/options.h"
#include "io/structure.h"

namespace quickses::cli {

// One line on standard error if water is part of the surface and no flag chose among the atoms.
void hint_at_water(const Options &options, const io::Structure &structure);

}  // namespace quickses::cli
