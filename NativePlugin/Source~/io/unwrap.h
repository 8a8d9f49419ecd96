// SPDX-License-Identifier: MIT
// Molecules made whole across periodic boundaries.
#pragma once

#include <cstdint>
#include <vector>

#include "io/box.h"

namespace quickses::io {

// Which atoms are bonded is taken from one frame; every frame then has each molecule in one piece, around its
// first atom, which stays where it is. Const members may be called from several threads at a time.
class Unwrapper {
 public:
  // elements: atom_count atomic numbers, 0 = unknown. positions: atom_count x 3, Å, finite. Neither is kept.
  // Two atoms are bonded if, in the box of this frame, nearest images of them are not farther apart than the sum of
  // their covalent radii (Cordero et al. 2008, Dalton Trans. 2832) + 0.4 Å. Beads of coarse-grained models are not
  // bonded in this sense.
  // Throws Error (kInput) if so many atoms lie on top of each other that these can't be molecules.
  Unwrapper(const uint8_t *elements, const float *positions, size_t atom_count, const Box &box);

  // Moves atoms by whole box vectors. In molecules that are bonded to their own images (crystals, sheets) some bonds
  // stay across the boundary, as they must.
  void apply(const Box &box, float *positions) const;

  size_t bond_count() const { return bond_count_; }
  size_t molecule_count() const { return molecule_count_; }  // single atoms count

 private:
  struct Link {
    uint32_t atom, parent;
  };
  std::vector<Link> links_;  // parents before their children
  size_t bond_count_ = 0;
  size_t molecule_count_ = 0;
};

}  // namespace quickses::io
