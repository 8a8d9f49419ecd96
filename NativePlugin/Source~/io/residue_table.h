// SPDX-License-Identifier: MIT
// What is known about residues by their names in files of the PDB and of molecular dynamics.
#pragma once

#include <string>

namespace quickses::io {

enum class ResidueClass { kOther, kNonpolar, kPolar, kAcidic, kBasic, kPurine, kPyrimidine };

struct ResidueTraits {
  ResidueClass residue_class = ResidueClass::kOther;
  // Of amino acids, from -4.5 (arginine) to 4.5 (isoleucine): Kyte and Doolittle, J. Mol. Biol. 157, 105-132 (1982).
  float hydropathy = 0;

  bool is_amino_acid() const {
    return residue_class >= ResidueClass::kNonpolar && residue_class <= ResidueClass::kBasic;
  }
};

constexpr float kGreatestHydropathy = 4.5f;

// A modified residue counts as the one that it was made of, another protonation state as the usual one.
ResidueTraits traits_of(const std::string &residue_name);

}  // namespace quickses::io
