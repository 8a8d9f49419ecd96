// SPDX-License-Identifier: MIT
// Which atoms a selection names: its tree, evaluated from the leaves on, a byte per atom.
#include "io/selection.h"

#include <algorithm>
#include <cstddef>

#include "io/error.h"
#include "io/near_atoms.h"
#include "io/selection_parser.h"
#include "io/structure.h"
#include "io/text.h"

namespace quickses::io {
namespace {

using Kind = SelectionTerm::Kind;
using Mask = std::vector<uint8_t>;

// Asks a selection for one atom after the other. gemmi looks at chains, residues and atoms of its own kind: these are
// three of them that are filled again and again. Neighbours mostly are of one residue, which is asked for once.
class Matcher {
 public:
  explicit Matcher(const gemmi::Selection &selection) : selection_(selection) {}

  bool matches(const AtomInfo &info) {
    if (!chain_is_known_ || info.chain != chain_.name) {
      chain_.name = info.chain;
      chain_matches_ = selection_.matches(chain_);
      chain_is_known_ = true;
    }
    return chain_matches_ && residue_matches(info) && atom_matches(info);
  }

 private:
  bool residue_matches(const AtomInfo &info) {
    gemmi::SeqId place;
    if (info.has_residue_number()) place.num = info.residue_number;
    place.icode = info.insertion_code;
    const auto kind = static_cast<gemmi::EntityType>(info.entity);
    if (!residue_is_known_ || !(residue_.seqid.num == place.num) || residue_.seqid.icode != place.icode ||
        residue_.entity_type != kind || residue_.name != info.residue_name) {
      residue_.seqid = place;
      residue_.entity_type = kind;
      residue_.name = info.residue_name;
      residue_matches_ = selection_.matches(residue_);
      residue_is_known_ = true;
    }
    return residue_matches_;
  }

  bool atom_matches(const AtomInfo &info) {
    atom_.name = info.name;
    atom_.element = info.deuterium ? gemmi::El::D : static_cast<gemmi::El>(info.element);
    atom_.altloc = info.alternate_location;
    atom_.occ = info.occupancy;
    atom_.b_iso = info.b_factor;
    return selection_.matches(atom_);
  }

  const gemmi::Selection &selection_;
  gemmi::Chain chain_{""};
  gemmi::Residue residue_;
  gemmi::Atom atom_;
  bool chain_is_known_ = false, chain_matches_ = false;
  bool residue_is_known_ = false, residue_matches_ = false;
};

bool has(const std::vector<std::string> &names, const std::string &name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

class Evaluation {
 public:
  explicit Evaluation(const Structure &structure) : structure_(structure) {}

  // Calls itself; the rest is done by functions of their own, so that its frames are small: callers may have little
  // stack.
  Mask select(const SelectionTerm &term) const {
    switch (term.kind) {
      case Kind::kNot:
      case Kind::kAnd:
      case Kind::kOr:
      case Kind::kWithin:
      case Kind::kSameResidue: {
        Mask mask = select(term.operands[0]);
        for (size_t k = 1; k < term.operands.size(); ++k) join(term.kind, mask, select(term.operands[k]));
        if (term.kind == Kind::kNot)
          for (uint8_t &named : mask) named = !named;
        if (term.kind == Kind::kWithin) mask = atoms_near(structure_.positions, mask, term.distance);
        if (term.kind == Kind::kSameResidue) widen_to_residues(mask);
        return mask;
      }
      default:
        return leaf(term);
    }
  }

 private:
  static void join(Kind kind, Mask &mask, const Mask &other) {
    for (size_t i = 0; i < mask.size(); ++i) mask[i] = kind == Kind::kAnd ? mask[i] & other[i] : mask[i] | other[i];
  }

  [[gnu::noinline]] Mask leaf(const SelectionTerm &term) const {
    switch (term.kind) {
      case Kind::kCid:
        return cid(*term.cid);
      case Kind::kLoneName: {
        const Mask chain = where([&](const AtomInfo &atom) { return atom.chain == term.names[0]; });
        if (is_any(chain)) return chain;
        if (!term.operands.empty()) return select(term.operands[0]);
        check_lone_word(term.names[0]);
        return chain;
      }
      case Kind::kLoneResidue: {
        const Mask residue = where([&](const AtomInfo &atom) { return atom.residue_name == term.names[0]; });
        return is_any(residue) ? residue : select(term.operands[0]);
      }
      default:
        check_wildcards(term);
        return where([&](const AtomInfo &atom) { return matches(term, atom); });
    }
  }

  // * and ? are parts of names: the sugars of nucleotides had C1* before they had C1'.
  void check_wildcards(const SelectionTerm &term) const {
    for (const std::string &name : term.names) {
      if (name.find_first_of("*?") == std::string::npos) continue;
      SelectionTerm alone(term.kind);
      alone.names = {name};
      if (std::none_of(structure_.atoms.begin(), structure_.atoms.end(),
                       [&](const AtomInfo &atom) { return matches(alone, atom); }))
        fail_usage("nothing has the name '" + excerpt_of(name) +
                   "': selections know no wildcards; several names are put side by side, as in 'name CA CB', and " +
                   "elements have a word of their own, as in 'element H'");
    }
  }

  template <class Condition>
  Mask where(const Condition &condition) const {
    Mask mask(structure_.atoms.size());
    std::transform(structure_.atoms.begin(), structure_.atoms.end(), mask.begin(), condition);
    return mask;
  }

  static bool is_any(const Mask &mask) { return std::find(mask.begin(), mask.end(), 1) != mask.end(); }

  Mask cid(const gemmi::Selection &selection) const {
    if (!selection.matches(gemmi::Model(structure_.model_name))) return Mask(structure_.atoms.size());
    Matcher matcher(selection);
    return where([&](const AtomInfo &atom) { return matcher.matches(atom); });
  }

  [[gnu::noinline]] void widen_to_residues(Mask &mask) const {
    const std::vector<uint32_t> residues = residues_of(structure_);
    for (size_t first = 0, last = 0; first < mask.size(); first = last) {
      bool is_named = false;
      for (; last < mask.size() && residues[last] == residues[first]; ++last) is_named |= mask[last] != 0;
      std::fill(mask.begin() + static_cast<ptrdiff_t>(first), mask.begin() + static_cast<ptrdiff_t>(last), is_named);
    }
  }

  // Of the terms that look at one atom only.
  static bool matches(const SelectionTerm &term, const AtomInfo &atom) {
    const bool is_chain_atom = atom.is_of_polymer();
    switch (term.kind) {
      case Kind::kAll:
        return true;
      case Kind::kProtein:
        return atom.kind == ResidueKind::kProtein;
      case Kind::kNucleic:
        return atom.kind == ResidueKind::kNucleic;
      case Kind::kLigand:
        return atom.kind == ResidueKind::kLigand;
      case Kind::kIons:
        return atom.kind == ResidueKind::kIon;
      case Kind::kWater:
        return atom.kind == ResidueKind::kWater;
      case Kind::kHydrogen:
        return atom.hydrogen;
      case Kind::kHetero:
        return atom.hetero;
      case Kind::kBackbone:
        return is_chain_atom && is_backbone_name(atom.kind, atom.name);
      case Kind::kSidechain:
        return is_chain_atom && !is_backbone_name(atom.kind, atom.name);
      case Kind::kChains:
        return has(term.names, atom.chain);
      case Kind::kResidueNames:
        return has(term.names, atom.residue_name);
      case Kind::kAtomNames:
        return has(term.names, atom.name);
      case Kind::kLocations:
        return atom.alternate_location != '\0' && has(term.names, std::string(1, atom.alternate_location));
      case Kind::kElements: {
        const gemmi::El element = atom.deuterium ? gemmi::El::D : static_cast<gemmi::El>(atom.element);
        return std::find(term.elements.begin(), term.elements.end(), element) != term.elements.end();
      }
      case Kind::kResidueNumbers: {
        const ResiduePlace place(atom.residue_number, atom.insertion_code);
        return atom.has_residue_number() && std::any_of(term.places.begin(), term.places.end(), [&](const auto &range) {
                 return range.first <= place && place <= range.second;
               });
      }
      case Kind::kIndices:
        return std::any_of(term.indices.begin(), term.indices.end(), [&](const auto &range) {
          const auto index = static_cast<int64_t>(atom.file_index);
          return range.first <= index && index <= range.second;
        });
      default:
        return false;
    }
  }

  const Structure &structure_;
};

bool asks_for_locations_in(const SelectionTerm &term) {
  return term.kind == Kind::kLocations || (term.cid && !term.cid->altlocs.all) ||
         std::any_of(term.operands.begin(), term.operands.end(), asks_for_locations_in);
}

void add_once(std::vector<std::string> &names, const std::string &name) {
  if ((names.empty() || names.back() != name) && !has(names, name)) names.push_back(name);
}

}  // namespace

Selection::Selection(std::string text) {
  // It may have several lines, as where it comes from a file, and the blanks of web pages and word processors.
  const std::string unbroken = "\xc2\xa0";
  for (size_t at = text.find(unbroken); at != std::string::npos; at = text.find(unbroken, at))
    text.replace(at, unbroken.size(), " ");
  std::replace_if(
      text.begin(), text.end(), [](char c) { return is_blank(c) || c == '\n'; }, ' ');
  text_ = trim(text);
  if (!text_.empty()) root_ = parse_selection(text_);
}

bool Selection::asks_for_locations() const { return asks_for_locations_in(root_); }

std::vector<uint8_t> Selection::select(const Structure &structure) const { return Evaluation(structure).select(root_); }

std::string contents_of(const Structure &structure) {
  std::vector<std::string> chains, ligands, ions, kinds;
  bool has_kind[5] = {};
  for (const AtomInfo &atom : structure.atoms) {
    add_once(chains, atom.chain);
    has_kind[static_cast<int>(atom.kind)] = true;
    if (atom.kind == ResidueKind::kLigand) add_once(ligands, atom.residue_name);
    if (atom.kind == ResidueKind::kIon) add_once(ions, atom.residue_name);
  }
  if (has_kind[static_cast<int>(ResidueKind::kProtein)]) kinds.push_back("protein");
  if (has_kind[static_cast<int>(ResidueKind::kNucleic)]) kinds.push_back("nucleic");
  if (!ligands.empty()) kinds.push_back("ligand (" + list_of(ligands) + ")");
  if (!ions.empty()) kinds.push_back("ions (" + list_of(ions) + ")");
  if (has_kind[static_cast<int>(ResidueKind::kWater)]) kinds.push_back("water");
  const bool no_chains = chains.size() == 1 && chains[0].empty();
  return (no_chains ? "no chains" : (chains.size() == 1 ? "chain " : "chains ") + list_of(chains)) + ", with " +
         list_of(kinds);
}

uint32_t select_atoms(const Structure &structure, const std::string &text, uint8_t *mask) {
  const Selection selection(text);
  const size_t count = structure.atoms.size();
  if (selection.is_everything()) {
    std::fill(mask, mask + count, uint8_t{1});
    return static_cast<uint32_t>(count);
  }
  if (!structure.has_names) fail_usage("the structure has no names, so nothing can be selected from it");
  const std::vector<uint8_t> named = selection.select(structure);
  std::copy(named.begin(), named.end(), mask);
  return static_cast<uint32_t>(std::count(named.begin(), named.end(), uint8_t{1}));
}

}  // namespace quickses::io
