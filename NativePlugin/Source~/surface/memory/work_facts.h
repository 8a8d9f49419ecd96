// SPDX-License-Identifier: MIT
// What is known of the size of a computation while it runs.
#pragma once

#include <cstdint>

namespace quickses {

// Numbers of things, counted or predicted; 0: not known yet.
struct SurfaceSize {
  double bricks = 0, vertices = 0, triangles = 0;
  double leaves = 0;  // that own vertices
};

// How many atoms and arcs there are for bricks to look at.
struct CandidateCounts {
  double atoms = 0, arcs = 0;
};

struct WorkFacts {
  uint64_t atoms = 0, atom_cells = 0, arc_cells = 0;  // cells: entries of the grids' tables, 0 if they are sparse
  uint64_t caps = 0, arcs = 0;                        // of exposed atoms
  uint64_t brick_entries = 0;                         // of the table of bricks, 0 if the set is sparse
  SurfaceSize size{};
};

}  // namespace quickses
