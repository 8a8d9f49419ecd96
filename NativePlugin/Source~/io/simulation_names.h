// SPDX-License-Identifier: MIT
// Names that Amber, CHARMM and GROMACS give to residues and the PDB does not: of protonation states, of cysteines in
// bridges, of the ends of chains and strands, of caps, of water.
#pragma once

#include <string>

namespace quickses::io {

struct SimulatedResidue {
  char amino_acid = '\0';  // the usual one's letter in sequences; '\0': it is none
  char base = '\0';        // A, C, G, T or U
  bool is_cap = false;

  bool is_known() const { return amino_acid != '\0' || base != '\0' || is_cap; }
};

// Names in capitals.
SimulatedResidue find_simulated_residue(const std::string &name);

// Of water in the PDB and of water models. Some are of ligands of the PDB too: T3P, OPC.
bool is_water_name(const std::string &name);

}  // namespace quickses::io
