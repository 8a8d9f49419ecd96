// SPDX-License-Identifier: MIT
// Any text as a selection of the atoms of a small structure.
#include "fuzz/fuzz.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

namespace fuzz {
namespace {

constexpr char kStructure[] =
    "ATOM      1  N   GLY A   1      17.047  14.099   3.625  1.00 13.79           N\n"
    "ATOM      2  CA AGLY A   1      16.967  12.784   4.338  0.60 10.80           C\n"
    "ATOM      3  CA BGLY A   1      16.867  12.684   4.238  0.40 10.80           C\n"
    "ATOM      4  H   GLY A   1      17.967  12.784   4.338  1.00 10.80           H\n"
    "ATOM      5  CB  ALA A  -2A     15.685  12.755   5.133  1.00  9.19           C\n"
    "ATOM      6  P    DG B   3      10.967   8.784   4.338  1.00 10.80           P\n"
    "HETATM    7 FE   HEM B 101      11.685   9.755   6.133  1.00  9.19          FE\n"
    "HETATM    8 ZN    ZN C   1       1.685   2.755   3.133  1.00  9.19          ZN\n"
    "HETATM    9  O   HOH C 201       3.685   4.755   3.133  1.00  9.19           O\n"
    "END\n";

qses_structure *open_structure() {
  qses_structure_options options;
  qses_structure_options_init(&options);
  options.format = QSES_STRUCTURE_PDB;
  options.selection = "altloc A B or all";
  qses_structure *structure = nullptr;
  require(succeeds(qses_structure_open_memory(kStructure, std::strlen(kStructure), &options, &structure), {}),
          "the structure is read");
  return structure;
}

}  // namespace

void try_selection(const uint8_t *data, size_t size) {
  static qses_structure *const structure = open_structure();
  static const uint32_t atoms = [] {
    qses_structure_description about;
    qses_structure_description_init(&about);
    require(succeeds(qses_structure_info(structure, &about), {}), "it is told of");
    return about.atom_count;
  }();
  const std::string text(reinterpret_cast<const char *>(data), size);
  std::vector<uint8_t> mask(atoms), others(atoms);
  uint32_t selected = 0, left = 0;
  if (!succeeds(qses_structure_select(structure, text.c_str(), mask.data(), mask.size(), &selected),
                {QSES_INVALID_ARGUMENT}))
    return;
  require(std::count(mask.begin(), mask.end(), 1) == static_cast<long>(selected), "as many as it says");
  // What is not selected is selected by its opposite. But single words have a meaning of their own in parentheses.
  if (text.find(' ') == std::string::npos || text.find('\0') != std::string::npos) return;
  if (!succeeds(qses_structure_select(structure, ("not (" + text + ")").c_str(), others.data(), others.size(), &left),
                {QSES_INVALID_ARGUMENT}))
    return;
  for (size_t k = 0; k < atoms; ++k) require(mask[k] + others[k] == 1, "either the one or the other");
}

}  // namespace fuzz
