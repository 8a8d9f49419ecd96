// SPDX-License-Identifier: MIT
#include "io/selection.h"

#include <algorithm>
#include <climits>
#include <new>

#include "io/error.h"
#include "io/structure.h"

namespace quickses::io {
namespace {

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
    if (info.has_residue_number) place.num = info.residue_number;
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

}  // namespace

std::unique_ptr<gemmi::Selection> parse_selection(const std::string &cid) {
  if (cid.empty()) return nullptr;
  try {
    auto selection = std::make_unique<gemmi::Selection>(cid);
    // "//A/12" is residue 12; gemmi before 0.6 takes it for "//A/12-", all from 12 on.
    const bool has_range = cid.find('-') < cid.find(';');
    if (!has_range && selection->from_seqid.seqnum != INT_MIN) selection->to_seqid = selection->from_seqid;
    return selection;
  } catch (const std::bad_alloc &) {
    throw;
  } catch (const std::exception &error) {
    fail_usage("the selection '" + cid + "' can't be understood: " + error.what());
  }
}

uint32_t select_atoms(const Structure &structure, const std::string &cid, uint8_t *mask) {
  const std::unique_ptr<gemmi::Selection> selection = parse_selection(cid);
  const size_t count = structure.atoms.size();
  if (!selection) {
    std::fill(mask, mask + count, uint8_t{1});
    return static_cast<uint32_t>(count);
  }
  if (!structure.has_names) fail_usage("the structure has no names, so nothing can be selected from it");
  std::fill(mask, mask + count, uint8_t{0});
  if (!selection->matches(gemmi::Model(structure.model_name))) return 0;
  Matcher matcher(*selection);
  uint32_t selected = 0;
  for (size_t i = 0; i < count; ++i)
    if (matcher.matches(structure.atoms[i])) {
      mask[i] = 1;
      ++selected;
    }
  return selected;
}

}  // namespace quickses::io
