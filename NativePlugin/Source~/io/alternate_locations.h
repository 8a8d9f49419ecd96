// SPDX-License-Identifier: MIT
// Which of an atom's alternate locations is taken.
#pragma once

#include "io/readers.h"  // before other gemmi headers: settles how gemmi formats numbers

#include <string>
#include <unordered_map>
#include <vector>

namespace quickses::io {

// Chooses one label per residue (by number: residues of two kinds may share a place).
class AlternateLocations {
 public:
  // choice: "" or "first", the label met first; "highest", the one of the greatest mean occupancy, of several the
  // first; or a label, which is taken where a residue has it, and else the first. Throws Error (kUsage).
  explicit AlternateLocations(const std::string &choice);

  // All atoms are seen in the order of the file before one is kept.
  void see(const gemmi::Chain &chain, const gemmi::Residue &residue, const gemmi::Atom &atom);
  // Of atoms without a label always.
  bool keep(const gemmi::Chain &chain, const gemmi::Residue &residue, const gemmi::Atom &atom) const;

 private:
  struct Location {
    char label;
    double occupancies;  // their sum
    size_t count;
  };
  char chosen_of(const std::vector<Location> &locations) const;

  bool takes_highest_ = false;
  char wanted_ = '\0';                                                // a label; '\0' = none
  std::unordered_map<std::string, std::vector<Location>> locations_;  // of each residue, the first one first
};

}  // namespace quickses::io
