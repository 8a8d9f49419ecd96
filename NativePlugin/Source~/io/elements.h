// SPDX-License-Identifier: MIT
// Elements of atoms whose file does not name them.
#pragma once

#include <string>

namespace gemmi {
enum class El : unsigned char;
}

namespace quickses::io {

// An element symbol as files write it: any case, spaces around, a charge behind ("Fe3+"). El::X where it is none.
gemmi::El parse_element(const std::string &symbol);

// The element of an atom from its names.
//   residue_name  such as "ALA"
//   atom_name     such as "CA"; if it is exactly the four columns 13 to 16 of a PDB record (" CA " or "CA  "), then in
//                 residues that are not known the column of the first letter decides, as the format says
// CA is carbon in an amino acid and calcium in residue CA; HG is hydrogen in SER and mercury in residue HG.
// El::X where the names tell nothing.
gemmi::El infer_element(const std::string &residue_name, const std::string &atom_name);

// Whether it is the name of what a water model of four or five sites has beside its atoms: MW (GROMACS), OM (CHARMM),
// EPW (Amber), LP1. To be asked of water only, in which it is all but names of O, H, D, C, N, P and S.
bool is_site_of_water(const std::string &atom_name);

}  // namespace quickses::io
