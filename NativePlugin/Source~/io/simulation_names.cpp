// SPDX-License-Identifier: MIT
// Names that Amber, CHARMM and GROMACS give to residues.
#include "io/simulation_names.h"

#include <gemmi/resinfo.hpp>

#include "io/text.h"

namespace quickses::io {
namespace {

char letter_of_state(const std::string &name) {
  static const struct {
    const char *name;
    char letter;
  } kNames[] = {{"CYX", 'C'},  {"CYM", 'C'},  {"CYN", 'C'},  {"CYS1", 'C'}, {"CYS2", 'C'}, {"CYSH", 'C'}, {"ASH", 'D'},
                {"ASPH", 'D'}, {"ASPP", 'D'}, {"GLH", 'E'},  {"GLUH", 'E'}, {"GLUP", 'E'}, {"ARN", 'R'},  {"ARGN", 'R'},
                {"HID", 'H'},  {"HIE", 'H'},  {"HIP", 'H'},  {"HSD", 'H'},  {"HSE", 'H'},  {"HSP", 'H'},  {"HISA", 'H'},
                {"HISB", 'H'}, {"HISD", 'H'}, {"HISE", 'H'}, {"HISH", 'H'}, {"HIS1", 'H'}, {"HIS2", 'H'}, {"ILE1", 'I'},
                {"LYN", 'K'},  {"LSN", 'K'},  {"LYSH", 'K'}};
  for (const auto &entry : kNames)
    if (name == entry.name) return entry.letter;
  return '\0';
}

// At an end of a chain, Amber puts N or C before the name: NALA, CHID.
char amino_acid_of(const std::string &name) {
  if (const char letter = letter_of_state(name)) return letter;
  if (name.size() != 4 || (name[0] != 'N' && name[0] != 'C')) return '\0';
  const std::string inner = name.substr(1);
  if (const char letter = letter_of_state(inner)) return letter;
  const gemmi::ResidueInfo info = gemmi::find_tabulated_residue(inner);
  return info.is_amino_acid() ? to_upper(info.one_letter_code) : '\0';
}

// ADE and the like of CHARMM; A, DA and RA, with 5, 3 or N of Amber behind at the ends of a strand and for a single
// one.
char base_of(std::string name) {
  if (is_one_of(name, {"ADE", "GUA", "CYT", "THY", "URA"})) return name[0];
  if (name.size() > 1 && is_one_of(name.substr(name.size() - 1), {"5", "3", "N"})) name.pop_back();
  if (name.size() == 2 && (name[0] == 'D' || name[0] == 'R')) name.erase(0, 1);
  return is_one_of(name, {"A", "C", "G", "T", "U"}) ? name[0] : '\0';
}

}  // namespace

SimulatedResidue find_simulated_residue(const std::string &name) {
  return {amino_acid_of(name), base_of(name), is_one_of(name, {"ACE", "NME", "NMA", "NH2", "FOR"})};
}

bool is_water_name(const std::string &name) {
  return is_one_of(name, {"HOH", "DOD", "WAT", "H2O",  "SOL", "TIP", "TP3", "TIP3", "TIP4", "TIP5",
                          "T3P", "T4P", "SPC", "SPCE", "OPC", "HHO", "OHH", "OH2",  "TP4",  "TP5"});
}

}  // namespace quickses::io
