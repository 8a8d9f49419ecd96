// SPDX-License-Identifier: MIT
// gemmi's table knows the common residues of the PDB; names of molecular-dynamics packages are listed here; of other
// residues the atoms tell.
#include "io/residue_kinds.h"

#include "io/readers.h"  // before other gemmi headers: settles how gemmi formats numbers

#include <algorithm>
#include <gemmi/resinfo.hpp>
#include <initializer_list>

#include "io/structure.h"

namespace quickses::io {
namespace {

bool is_one_of(const std::string &word, std::initializer_list<const char *> list) {
  return std::any_of(list.begin(), list.end(), [&](const char *item) { return word == item; });
}

// AMBER, CHARMM and GROMACS: protonation states, and the ends of chains.
bool is_amino_acid_of_dynamics(const std::string &name) {
  if (is_one_of(name, {"HID",  "HIE",  "HIP",  "HSD",  "HSE",  "HSP",  "CYX",  "CYM",  "CYN",  "ASH",  "GLH",
                       "LYN",  "LSN",  "ARN",  "HISA", "HISB", "HISD", "HISE", "HISH", "HIS1", "HIS2", "CYS1",
                       "CYS2", "CYSH", "ASPH", "ASPP", "GLUH", "GLUP", "LYSH", "ARGN", "ILE1"}))
    return true;
  const bool has_end = name.size() == 4 && (name[0] == 'N' || name[0] == 'C');
  return has_end && (gemmi::find_tabulated_residue(name.substr(1)).is_amino_acid() ||
                     is_one_of(name.substr(1), {"HID", "HIE", "HIP", "CYX", "ASH", "GLH", "LYN"}));
}

bool is_cap(const std::string &name) { return is_one_of(name, {"ACE", "NME", "NMA", "NH2", "FOR"}); }

// ADE and the like of CHARMM; DA, RA, A, with 5, 3 or N of AMBER behind for the ends.
bool is_nucleotide_of_dynamics(std::string name) {
  if (is_one_of(name, {"ADE", "GUA", "CYT", "THY", "URA"})) return true;
  if (name.size() > 1 && is_one_of(name.substr(name.size() - 1), {"5", "3", "N"})) name.pop_back();
  if (name.size() == 2 && (name[0] == 'D' || name[0] == 'R')) name.erase(0, 1);
  return is_one_of(name, {"A", "C", "G", "T", "U"});
}

bool is_halogen(gemmi::El element) {
  return element == gemmi::El::F || element == gemmi::El::Cl || element == gemmi::El::Br || element == gemmi::El::I;
}

// The atoms of one residue, one after the other.
struct Residue {
  const AtomInfo *first, *last;

  bool has(const char *atom_name) const {
    return std::any_of(first, last, [&](const AtomInfo &atom) { return atom.name == atom_name; });
  }
  bool is_one_atom() const {  // maybe at several locations
    return std::all_of(first, last, [&](const AtomInfo &atom) { return atom.name == first->name; });
  }
};

ResidueKind kind_of(const Residue &residue) {
  const AtomInfo &atom = *residue.first;
  if (atom.water) return ResidueKind::kWater;
  const auto element = static_cast<gemmi::El>(atom.element);
  if (residue.is_one_atom() && (gemmi::is_metal(element) || is_halogen(element))) return ResidueKind::kIon;

  const auto entity = static_cast<gemmi::EntityType>(atom.entity);
  const bool in_chain = entity == gemmi::EntityType::Polymer;
  const bool is_apart = !in_chain && entity != gemmi::EntityType::Unknown;
  const std::string &name = atom.residue_name;
  const auto &known = gemmi::find_tabulated_residue(name);
  // An amino acid or nucleotide of the twenty-odd that is a HETATM record was bound or added as such, which gemmi takes
  // for granted too. A modified one is a part of a chain, unless the file says otherwise.
  const bool may_be_linked = in_chain || (!is_apart && !(atom.hetero && known.found() && known.is_standard()));
  if (may_be_linked) {
    if (known.is_amino_acid() || is_cap(name) || is_amino_acid_of_dynamics(name)) return ResidueKind::kProtein;
    if (known.is_nucleic_acid() || is_nucleotide_of_dynamics(name)) return ResidueKind::kNucleic;
  }
  if (!known.found() && (in_chain || (!is_apart && !atom.hetero))) {
    if (residue.has("CA") && ((residue.has("N") && residue.has("C")) || (in_chain && residue.is_one_atom())))
      return ResidueKind::kProtein;
    if (residue.has("C1'") && residue.has("C4'") && residue.has("O3'")) return ResidueKind::kNucleic;
    if (residue.has("C1*") && residue.has("C4*") && residue.has("O3*")) return ResidueKind::kNucleic;
  }
  return ResidueKind::kLigand;
}

}  // namespace

void find_residue_kinds(Structure &structure) {
  if (!structure.has_names) return;
  const std::vector<uint32_t> residues = residues_of(structure);
  AtomInfo *const atoms = structure.atoms.data();
  for (size_t first = 0, last = 0; first < residues.size(); first = last) {
    while (last < residues.size() && residues[last] == residues[first]) ++last;
    const ResidueKind kind = kind_of({atoms + first, atoms + last});
    for (size_t i = first; i < last; ++i) atoms[i].kind = kind;
  }
}

bool is_backbone_name(ResidueKind kind, const std::string &name) {
  if (kind == ResidueKind::kProtein)
    return is_one_of(name, {"N",  "CA", "C",  "O",  "OXT", "OT",  "OT1", "OT2", "O1",  "O2",  "H",  "HN", "D",
                            "H1", "H2", "H3", "HA", "HA1", "HA2", "HA3", "HT1", "HT2", "HT3", "DA", "HXT"});
  if (kind != ResidueKind::kNucleic) return false;
  if (name.find_first_of("'*") != std::string::npos) return true;  // of the sugar
  return is_one_of(name, {"P", "OP1", "OP2", "OP3", "O1P", "O2P", "O3P", "HOP2", "HOP3", "H5T", "H3T"});
}

}  // namespace quickses::io
