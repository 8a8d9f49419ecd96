// SPDX-License-Identifier: MIT
// Which of an atom's alternate locations is taken.
#pragma once

#include "io/readers.h"  // before other gemmi headers: settles how gemmi formats numbers

#include <string>
#include <unordered_map>
#include <vector>

namespace quickses::io {

// Chooses one label per residue (by number: residues of two kinds may share a place). Labels that no atom of the
// residue has both of, as A and B at one end of it and C and D at the other, are no alternatives of each other: of both
// pairs one is chosen.
class AlternateLocations {
 public:
  // choice: "" or "first", the label met first; "highest", the one of the greatest mean occupancy, of several the
  // first; or a label, which is taken where a residue has it, and else the first. Throws Error (kUsage).
  explicit AlternateLocations(const std::string &choice);

  // All atoms are seen in the order of the file before one is kept.
  void see(const gemmi::Chain &chain, const gemmi::Residue &residue, const gemmi::Atom &atom);
  // Of atoms without a label always.
  bool keep(const gemmi::Chain &chain, const gemmi::Residue &residue, const gemmi::Atom &atom) const;

  // A sentence if the choice is a label that no residue has; empty otherwise.
  std::string warning() const;

 private:
  struct Location {
    char label;
    double occupancies;  // their sum
    size_t count;
    std::string residue;  // its name
    size_t group;         // the same number for alternatives of each other
  };
  using Locations = std::vector<Location>;  // of a residue, the first one first
  char chosen_of(const Locations &locations, size_t group) const;

  bool takes_highest_ = false;
  char wanted_ = '\0';  // a label; '\0' = none
  std::unordered_map<std::string, Locations> locations_;
  std::unordered_map<std::string, char> first_labels_;  // of each atom
};

}  // namespace quickses::io
