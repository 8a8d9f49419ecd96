// SPDX-License-Identifier: MIT
// Copies of a structure side by side, to see how time and memory grow with size.
#pragma once

#include "io/structure.h"

namespace quickses::cli {

// That many copies on a grid whose box is as nearly a cube as can be, around the origin, `gap` Å at least between the
// balls of one and those of the next. Copies are whole spacings apart, and so is the first from where the file has it:
// each lies in the lattice as the others do. One copy: the structure as it is. Spacing, as the library gets it, and gap
// are in Å. Throws Failure (kUsage): the copies reach farther than positions may.
io::Structure make_copies(io::Structure structure, unsigned copies, float spacing, double gap);

}  // namespace quickses::cli
