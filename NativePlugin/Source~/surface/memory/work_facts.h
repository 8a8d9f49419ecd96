// SPDX-License-Identifier: MIT
// What is known of the size of a computation: counted while it runs, or predicted. Plans are chosen by it.
#pragma once

#include <cstdint>

namespace quickses {

// Numbers of things; 0: not known yet.
struct SurfaceSize {
  double bricks = 0, vertices = 0, triangles = 0;
  double leaves = 0;  // that own vertices
};

// What splits of creases found, of this mesh or one like it; see ExpectedSplits.
struct FoundSplits {
  double added = 0, near = 0, crest = 0;
  bool lacked_room = false;  // behind the mesh
};

struct WorkFacts {
  uint64_t atoms = 0;
  uint64_t caps = 0, arcs = 0;  // of exposed atoms
  bool knows_arcs = false;      // there may be none
  // Of arcs, if creases of probes are asked for: turns of those whose circle is smaller than the probe, so that its
  // torus would go through its own axis; and Å of all.
  double spindle_turns = 0, arc_length = 0;
  FoundSplits found{};
  uint64_t brick_entries = 0, brick_visits = 0;  // of the table of bricks, 0 if the set is sparse; listed visits
  uint64_t occlusion_bricks = 0;                 // 0: not known
  SurfaceSize size{};
};

}  // namespace quickses
