// SPDX-License-Identifier: MIT
// What residues are. Every residue is of exactly one kind.
#pragma once

#include <cstdint>
#include <string>

namespace quickses::io {

struct Structure;

enum class ResidueKind : uint8_t {
  kLigand,   // whatever is none of the others: ligands, sugars, lipids, polyatomic ions such as sulphate
  kProtein,  // amino acids, modified ones and caps of chains too
  kNucleic,  // nucleotides, modified ones too
  kWater,    // by its name, if its atoms are those of water
  kIon,      // one atom, of a metal or a halogen
};

// Fills AtomInfo.kind of a structure that has all atoms of its residues, after the choice of alternate locations.
void find_residue_kinds(Structure &structure);

// Whether an atom of that name in an amino acid or a nucleotide belongs to the chain's backbone, hydrogens included; of
// nucleotides phosphate and sugar. What does not is the side chain, or the base.
bool is_backbone_name(ResidueKind kind, const std::string &atom_name);

}  // namespace quickses::io
