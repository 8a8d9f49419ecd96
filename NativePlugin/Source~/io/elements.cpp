// SPDX-License-Identifier: MIT
// Elements of atoms whose file does not name them.
#include "io/elements.h"

#include <gemmi/elem.hpp>
#include <gemmi/resinfo.hpp>

#include "io/simulation_names.h"
#include "io/text.h"

namespace quickses::io {
namespace {

using gemmi::El;

std::string upper_trimmed(const std::string &text) {
  const size_t first = text.find_first_not_of(' ');
  if (first == std::string::npos) return "";
  std::string word = text.substr(first, text.find_last_not_of(' ') - first + 1);
  for (char &c : word) c = to_upper(to_ascii(c));
  return word;
}

// The letters a name starts with, after any digits: "1HB2" gives HB.
std::string leading_letters(const std::string &name) {
  size_t begin = 0;
  while (begin < name.size() && !is_letter(name[begin])) ++begin;
  size_t end = begin;
  while (end < name.size() && is_letter(name[end])) ++end;
  return name.substr(begin, end - begin);
}

El single_letter_element(char letter) {
  const char symbol[2] = {letter, '\0'};
  return gemmi::find_element(symbol);
}

// Residues of which an ion is the only atom, under the names of the PDB (CA, ZN, FE2) and of CHARMM (SOD, CLA).
El ion_element(const std::string &residue, const std::string &atom) {
  static const struct {
    const char *name;
    El element;
  } kCharmmIons[] = {{"SOD", El::Na}, {"CLA", El::Cl}, {"POT", El::K},  {"CAL", El::Ca}, {"CES", El::Cs},
                     {"LIT", El::Li}, {"RUB", El::Rb}, {"BAR", El::Ba}, {"CAD", El::Cd}, {"ZN2", El::Zn}};
  if (residue == atom)
    for (const auto &ion : kCharmmIons)
      if (residue == ion.name) return ion.element;
  const std::string letters = leading_letters(residue);
  if (letters.empty() || letters != leading_letters(atom)) return El::X;
  // Other residues of one letter (A, C, G, U, I, N) are nucleotides.
  if (letters.size() == 1 && !is_one_of(letters, {"K", "F"})) return El::X;
  return letters.size() <= 2 ? gemmi::find_element(letters.c_str()) : El::X;
}

// Amino acids, nucleotides and water: residues made of H, C, N, O, P, S and Se only.
bool is_biopolymer_residue(const std::string &residue) {
  if (is_water_name(residue)) return true;
  const gemmi::ResidueInfo info = gemmi::find_tabulated_residue(residue);
  if (info.is_amino_acid() || info.is_nucleic_acid()) return true;
  return find_simulated_residue(residue).is_known();
}

// Two letters that start an atom name and are read as one element even where a column does not say so.
// CA, CD, CE, CO, NA, NE, OS, PA, PB, SB and the like are far more often a carbon, nitrogen... with a label.
bool is_certain_pair(const std::string &pair) {
  if (gemmi::find_element(pair.c_str()) == El::X) return false;
  if (is_one_of(pair, {"CL", "CU", "SI", "SE", "FE", "NI"})) return true;
  return !is_one_of(pair.substr(0, 1), {"C", "N", "O", "H", "S", "P", "F", "D"});
}

}  // namespace

gemmi::El parse_element(const std::string &symbol) {
  const std::string letters = leading_letters(upper_trimmed(symbol));
  return letters.empty() || letters.size() > 2 ? El::X : gemmi::find_element(letters.c_str());
}

bool is_site_of_water(const std::string &atom_name) {
  const std::string letters = leading_letters(upper_trimmed(atom_name));
  if (letters.empty()) return false;
  return letters == "OM" || !is_one_of(letters.substr(0, 1), {"O", "H", "D", "C", "N", "P", "S"});
}

gemmi::El infer_element(const std::string &residue_name, const std::string &atom_name) {
  const std::string residue = upper_trimmed(residue_name);
  const std::string name = upper_trimmed(atom_name);
  const std::string letters = leading_letters(name);
  if (letters.empty()) return El::X;

  const El ion = ion_element(residue, name);
  if (ion != El::X) return ion;

  if (is_biopolymer_residue(residue)) {
    if (letters.compare(0, 2, "SE") == 0) return El::Se;
    if (is_one_of(letters.substr(0, 1), {"H", "D", "C", "N", "O", "P", "S"})) return single_letter_element(letters[0]);
  }

  const std::string pair = letters.substr(0, 2);
  const bool has_columns = atom_name.size() == 4;
  const char first_column = has_columns ? atom_name[0] : '\0';
  const bool fills_columns = has_columns && name.size() == 4;
  // Right-justified in columns 13 and 14: a space or a digit first means an element of one letter.
  if (has_columns && (first_column == ' ' || is_digit(first_column))) {
    const El single = single_letter_element(letters[0]);
    if (single != El::X) return single;
  }
  if (pair.size() == 2) {
    if (letters[0] == 'H') return has_columns && !fills_columns && pair == "HG" ? El::Hg : El::H;
    // Names of four letters start in column 13 whatever their element is: only certain pairs count there.
    const El element = gemmi::find_element(pair.c_str());
    if (element != El::X && ((has_columns && !fills_columns) || is_certain_pair(pair))) return element;
  }
  return single_letter_element(letters[0]);
}

}  // namespace quickses::io
