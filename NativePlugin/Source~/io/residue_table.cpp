// SPDX-License-Identifier: MIT
// What is known about residues by their names in files of the PDB and of molecular dynamics.
#include "io/residue_table.h"

#include <gemmi/resinfo.hpp>

#include "io/simulation_names.h"
#include "io/text.h"

namespace quickses::io {
namespace {

// Of the letters of sequences.
ResidueTraits amino_acid(char letter) {
  switch (letter) {
    case 'A':
      return {ResidueClass::kNonpolar, 1.8f};
    case 'G':
      return {ResidueClass::kNonpolar, -0.4f};
    case 'I':
      return {ResidueClass::kNonpolar, 4.5f};
    case 'L':
      return {ResidueClass::kNonpolar, 3.8f};
    case 'M':
      return {ResidueClass::kNonpolar, 1.9f};
    case 'F':
      return {ResidueClass::kNonpolar, 2.8f};
    case 'P':
      return {ResidueClass::kNonpolar, -1.6f};
    case 'W':
      return {ResidueClass::kNonpolar, -0.9f};
    case 'V':
      return {ResidueClass::kNonpolar, 4.2f};
    case 'N':
    case 'Q':
      return {ResidueClass::kPolar, -3.5f};
    case 'C':
    case 'U':  // selenocysteine
      return {ResidueClass::kPolar, 2.5f};
    case 'S':
      return {ResidueClass::kPolar, -0.8f};
    case 'T':
      return {ResidueClass::kPolar, -0.7f};
    case 'Y':
      return {ResidueClass::kPolar, -1.3f};
    case 'D':
    case 'E':
      return {ResidueClass::kAcidic, -3.5f};
    case 'R':
      return {ResidueClass::kBasic, -4.5f};
    case 'H':
      return {ResidueClass::kBasic, -3.2f};
    case 'K':
    case 'O':  // pyrrolysine
      return {ResidueClass::kBasic, -3.9f};
    default:
      return {};
  }
}

ResidueTraits nucleotide(char letter) {
  switch (letter) {
    case 'A':
    case 'G':
    case 'I':
      return {ResidueClass::kPurine, 0};
    case 'C':
    case 'T':
    case 'U':
      return {ResidueClass::kPyrimidine, 0};
    default:
      return {};
  }
}

}  // namespace

ResidueTraits traits_of(const std::string &name) {
  // Before gemmi, which knows the names of the PDB: there, HSE is homoserine.
  const SimulatedResidue simulated = find_simulated_residue(name);
  if (simulated.amino_acid != '\0') return amino_acid(simulated.amino_acid);
  const gemmi::ResidueInfo info = gemmi::find_tabulated_residue(name);
  const char letter = to_upper(info.one_letter_code);  // a small one marks a modified residue
  if (info.is_amino_acid()) return amino_acid(letter);
  return nucleotide(info.is_nucleic_acid() ? letter : simulated.base);
}

}  // namespace quickses::io
