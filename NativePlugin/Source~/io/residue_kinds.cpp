// SPDX-License-Identifier: MIT
// gemmi's table knows the common residues of the PDB, and simulation_names.h those of molecular dynamics. But for the
// standard ones their atoms have to agree, since names are used again; of other residues atoms and bonds tell.
#include "io/residue_kinds.h"

#include "io/readers.h"  // before other gemmi headers: settles how gemmi formats numbers

#include <algorithm>
#include <cmath>
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

  const AtomInfo *find(const char *atom_name) const {  // null: it has none
    const AtomInfo *const atom =
        std::find_if(first, last, [&](const AtomInfo &some) { return some.name == atom_name; });
    return atom == last ? nullptr : atom;
  }
  bool has(const char *atom_name) const { return find(atom_name) != nullptr; }
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

// The residues of a structure, one after the other.
class ResidueSequence {
 public:
  explicit ResidueSequence(const Structure &structure) : structure_(structure) {
    const std::vector<uint32_t> numbers = residues_of(structure);
    const AtomInfo *const atoms = structure.atoms.data();
    for (size_t i = 0; i < numbers.size(); ++i) {
      if (i == 0 || numbers[i] != numbers[i - 1]) residues_.push_back({atoms + i, atoms + i});
      ++residues_.back().last;
    }
  }

  size_t count() const { return residues_.size(); }
  const Residue &operator[](size_t k) const { return residues_[k]; }

  // Whether a bond between such atoms joins the residue to the one before or behind it in the file.
  bool is_joined(size_t k, const char *end, const char *begin) const {
    return (k > 0 && are_bonded(residues_[k - 1].find(end), residues_[k].find(begin))) ||
           (k + 1 < count() && are_bonded(residues_[k].find(end), residues_[k + 1].find(begin)));
  }

 private:
  bool are_bonded(const AtomInfo *a, const AtomInfo *b) const {
    constexpr float kLongestBond = 2;  // Å; C-N has 1.3, O-P 1.6
    if (!a || !b) return false;
    const float *const p = structure_.positions.data() + 3 * (a - structure_.atoms.data());
    const float *const q = structure_.positions.data() + 3 * (b - structure_.atoms.data());
    return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) < kLongestBond;
  }

  const Structure &structure_;
  std::vector<Residue> residues_;
};

ResidueKind kind_of(const ResidueSequence &residues, size_t k) {
  const Residue &residue = residues[k];
  const AtomInfo &atom = *residue.first;
  if (is_water(residue)) return ResidueKind::kWater;
  const auto element = static_cast<gemmi::El>(atom.element);
  if (residue.is_one_atom() && (gemmi::is_metal(element) || is_halogen(element))) return ResidueKind::kIon;

  const auto entity = static_cast<gemmi::EntityType>(atom.entity);
  const bool in_chain = entity == gemmi::EntityType::Polymer;
  const bool is_apart = !in_chain && entity != gemmi::EntityType::Unknown;
  const std::string &name = atom.residue_name;
  const auto &known = gemmi::find_tabulated_residue(name);
  const bool is_standard = known.found() && known.is_standard();
  const bool has_alpha = residue.has("CA");
  const bool has_sugar = residue.has("C1'") || residue.has("C1*");
  // An amino acid or nucleotide of the twenty-odd that is a HETATM record was bound or added as such, which gemmi takes
  // for granted too. A modified one is a part of a chain, unless the file says otherwise.
  if (in_chain || (!is_apart && !(atom.hetero && is_standard))) {
    const SimulatedResidue simulated = find_simulated_residue(name);
    if (simulated.is_cap) return ResidueKind::kProtein;
    // HID and the like are standard ones by another name.
    if (simulated.amino_acid != '\0' || (known.is_amino_acid() && (is_standard || has_alpha)))
      return ResidueKind::kProtein;
    const bool is_phosphate_only = residue.is_one_atom() && residue.has("P");
    if ((known.is_nucleic_acid() || simulated.base != '\0') && (is_standard || has_sugar || is_phosphate_only))
      return ResidueKind::kNucleic;
  }
  if (!known.found() && (in_chain || (!is_apart && !atom.hetero))) {
    if (has_alpha && in_chain && residue.is_one_atom()) return ResidueKind::kProtein;
    if (has_alpha && residues.is_joined(k, "C", "N")) return ResidueKind::kProtein;
    if (has_sugar && (residues.is_joined(k, "O3'", "P") || residues.is_joined(k, "O3*", "P")))
      return ResidueKind::kNucleic;
  }
  return ResidueKind::kLigand;
}

}  // namespace

void find_residue_kinds(Structure &structure) {
  if (!structure.has_names) return;
  const ResidueSequence residues(structure);
  AtomInfo *const atoms = structure.atoms.data();
  for (size_t k = 0; k < residues.count(); ++k) {
    const ResidueKind kind = kind_of(residues, k);
    for (auto i = residues[k].first - atoms; i < residues[k].last - atoms; ++i) atoms[i].kind = kind;
  }
}

bool is_backbone_name(ResidueKind kind, const std::string &name) {
  if (kind == ResidueKind::kProtein)
    return is_one_of(name, {"N",   "CA",  "C",  "O",   "OXT", "OT",  "OT1", "OT2", "O1",  "O2", "OC1",
                            "OC2", "H",   "HN", "D",   "H1",  "H2",  "H3",  "1H",  "2H",  "3H", "HN1",
                            "HN2", "HN3", "HA", "HA1", "HA2", "HA3", "HT1", "HT2", "HT3", "DA", "HXT"});
  if (kind != ResidueKind::kNucleic) return false;
  if (name.find_first_of("'*") != std::string::npos) return true;  // of the sugar
  return is_one_of(name, {"P", "OP1", "OP2", "OP3", "O1P", "O2P", "O3P", "HOP2", "HOP3", "H5T", "H3T"});
}

}  // namespace quickses::io
