// SPDX-License-Identifier: MIT
// Selections of atoms: by words ("protein and not chain B"), by gemmi's CID syntax ("//A/10-40"), or both together. The
// grammar is in Documentation~/command-line.md.
#pragma once

#include "io/readers.h"  // before other gemmi headers: settles how gemmi formats numbers

#include <cstdint>
#include <gemmi/select.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace quickses::io {

struct Structure;

// A residue number with its insertion code, ' ' for none. As in files, 52 comes before 52A.
using ResiduePlace = std::pair<int, char>;

// A node of the tree that a selection is parsed into.
struct SelectionTerm {
  enum class Kind {
    kAll,
    kNone,
    kProtein,
    kNucleic,
    kLigand,
    kIons,
    kWater,
    kHydrogen,
    kHetero,
    kBackbone,
    kSidechain,
    kChains,          // names
    kResidueNames,    // names
    kResidueNumbers,  // places
    kAtomNames,       // names
    kElements,        // elements
    kLocations,       // names, of one letter each
    kIndices,         // indices
    kCid,             // cid
    kNot,             // of operands[0]
    kAnd,             // of all operands
    kOr,              // of all operands
    kWithin,          // distance from operands[0]
    kSameResidue,     // as operands[0]
    kLoneName,        // a chain, names[0], if there is one, else operands[0] if that is there
    kLoneResidue,     // a residue name, names[0], if there is one, else operands[0]
  };

  SelectionTerm(Kind what = Kind::kAll) : kind(what) {}

  Kind kind;
  std::vector<SelectionTerm> operands;
  std::vector<std::string> names;
  std::vector<std::pair<ResiduePlace, ResiduePlace>> places;  // from the first to the last
  std::vector<std::pair<int, int>> indices;                   // the same
  std::vector<gemmi::El> elements;
  double distance = 0;  // Å
  std::shared_ptr<const gemmi::Selection> cid;
};

class Selection {
 public:
  // Throws Error (kUsage): the text can't be understood.
  explicit Selection(std::string text);

  // Nothing but blanks.
  bool is_everything() const { return text_.empty(); }
  // Whether it asks for alternate locations, so that all are to be there when it looks.
  bool asks_for_locations() const;
  const std::string &text() const { return text_; }

  // One byte per atom, 0 or 1. The structure has names. Throws Error (kUsage): a word alone that is neither a chain of
  // the structure nor a word of selections, but nearly one.
  std::vector<uint8_t> select(const Structure &structure) const;

 private:
  std::string text_;
  SelectionTerm root_;
};

// What there is to be selected, for those who selected nothing: "chains A and B, with protein,
// ligand (HEM) and water".
std::string contents_of(const Structure &structure);

}  // namespace quickses::io
