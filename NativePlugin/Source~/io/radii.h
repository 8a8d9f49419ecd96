// SPDX-License-Identifier: MIT
// Van der Waals radii by element, and by residue and atom.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <unordered_map>

#include "io/structure.h"

namespace quickses::io {

// Radii in Å by atomic number; deuterium is hydrogen, [0] is the radius of atoms of unknown element.
using RadiusTable = std::array<float, 119>;

struct Radii {
  RadiusTable by_element = {};
  // By "RESIDUE ATOM", either of which may be "*"; letters of ASCII in upper case.
  std::unordered_map<std::string, float> by_name;

  // The most specific of: residue and atom, the residue's atoms, atoms of that name, the element.
  float of(const AtomInfo &atom) const { return of_names(atom).value_or(by_element[atom.element]); }
  std::optional<float> of_names(const AtomInfo &atom) const;  // all but the last
};

// The set of the QuickSES program: O 1.52, C 1.70, N 1.55, H 1.20, S 1.80, P 1.80, others 1.40.
RadiusTable quickses_radii();

// Bondi 1964 (J. Phys. Chem. 68, 441); for main-group elements not in there, Mantina, Chamberlin, Valero, Cramer and
// Truhlar 2009 (J. Phys. Chem. A 113, 5806); others 2.00.
RadiusTable bondi_radii();

// "quickses" or "bondi": no file is read for it.
bool is_radius_set(const std::string &name);

// "quickses", "bondi", or the name of a text file with lines `ELEMENT radius` and `RESIDUE ATOM radius` (Å, above 0 and
// up to 100), `#` starting a comment. Names in any case. The element `*`, or `* *`, stands for all that the file does
// not name; without it those keep the quickses radius. As a residue `*` stands for any, as an atom for all of a
// residue. Of lines for the same the last holds. Throws Error (kInput), naming the line.
Radii find_radii(const std::string &name_or_path);

// Fills structure.radii from names and elements.
void assign_radii(Structure &structure, const Radii &radii);

// PQR and XYZR files say how large their atoms are.
bool has_own_radii(StructureFormat format);

// Fills the radii of all models from a set (see find_radii); empty: those of the file, or else the quickses set. Atoms
// of unknown element are warned of in file.warnings.
// Throws Error: kUsage (a set was asked for, but the file has radii of its own), kInput (as find_radii).
void assign_radii(StructureFile &file, const std::string &radius_set);

}  // namespace quickses::io
