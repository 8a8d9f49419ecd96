// SPDX-License-Identifier: MIT
#include "io/readers.h"

#include <algorithm>
#include <utility>

#include "io/error.h"
#include "io/limits.h"
#include "io/text.h"

namespace quickses::io {
namespace {

std::string as_ascii(std::string_view name) {
  std::string clean(name);
  std::transform(clean.begin(), clean.end(), clean.begin(), to_ascii);
  return clean;
}

}  // namespace

gemmi::Residue &add_atom(RawModel &raw, const std::string &path, const AtomPlace &place, gemmi::Atom atom) {
  if (raw.atom_count == kMostAtoms)
    fail_input("'" + path + "' has more than " + std::to_string(kMostAtoms) + " atoms in one model");
  std::vector<gemmi::Chain> &chains = raw.model.chains;
  const std::string chain = as_ascii(place.chain);
  if (chains.empty() || chains.back().name != chain) chains.emplace_back(chain);
  std::vector<gemmi::Residue> &residues = chains.back().residues;
  gemmi::ResidueId id;
  id.seqid = place.number;
  id.name = as_ascii(place.residue);
  if (place.begins_residue || residues.empty() || !residues.back().matches(id)) {
    residues.emplace_back(id);
    residues.back().het_flag = place.hetero ? 'H' : 'A';
  }
  atom.name = as_ascii(atom.name);
  atom.serial = static_cast<int>(++raw.atom_count);
  residues.back().atoms.push_back(std::move(atom));
  return residues.back();
}

bool parse_residue_number(std::string_view word, gemmi::SeqId &id) {
  char code = ' ';
  if (!word.empty() && is_letter(word.back())) {
    code = word.back();
    word.remove_suffix(1);
  }
  int number = 0;
  if (!parse_integer(word, number)) return false;
  id = gemmi::SeqId(number, code);
  return true;
}

}  // namespace quickses::io
