// SPDX-License-Identifier: MIT
// gemmi's table knows the common residues of the PDB, and simulation_names.h those of molecular dynamics; of other
// residues the atoms tell.
#include "io/residue_kinds.h"

#include "io/readers.h"  // before other gemmi headers: settles how gemmi formats numbers

#include <algorithm>
#include <gemmi/resinfo.hpp>

#include "io/elements.h"
#include "io/simulation_names.h"
#include "io/structure.h"
#include "io/text.h"

namespace quickses::io {
namespace {

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

// One oxygen, hydrogens and sites of water models: of T3P and OPC, thymidine-3'-phosphate and a lipid are residues too.
bool is_water(const Residue &residue) {
  if (!is_water_name(residue.first->residue_name)) return false;
  const AtomInfo *oxygen = nullptr;  // maybe at several locations
  return std::all_of(residue.first, residue.last, [&](const AtomInfo &atom) {
    if (atom.hydrogen || is_site_of_water(atom.name)) return true;
    if (!oxygen) oxygen = &atom;
    return atom.element == static_cast<uint8_t>(gemmi::El::O) && atom.name == oxygen->name;
  });
}

ResidueKind kind_of(const Residue &residue) {
  const AtomInfo &atom = *residue.first;
  if (is_water(residue)) return ResidueKind::kWater;
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
    const SimulatedResidue simulated = find_simulated_residue(name);
    if (known.is_amino_acid() || simulated.is_cap || simulated.amino_acid != '\0') return ResidueKind::kProtein;
    if (known.is_nucleic_acid() || simulated.base != '\0') return ResidueKind::kNucleic;
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
