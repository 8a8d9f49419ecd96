// SPDX-License-Identifier: MIT
// Lines of PDB files.
#include "io/pdb_lines.h"

#include "io/error.h"
#include "io/text.h"

namespace quickses::io {

PdbRecord pdb_record_of(std::string_view line) {
  char columns[6];
  for (size_t i = 0; i < 6; ++i) columns[i] = i < line.size() ? to_upper(line[i]) : ' ';
  const std::string_view name(columns, 6);
  // The serial number may begin in column 5 or 6, as Chimera writes it from 100000 on. "ATOMS" is a word.
  if (name.substr(0, 4) == "ATOM" && (name[4] < 'A' || name[4] > 'Z')) return PdbRecord::kAtom;
  if (name == "HETATM") return PdbRecord::kHetatm;
  if (name == "MODEL ") return PdbRecord::kModel;
  if (name == "ENDMDL" || name == "END   ") return PdbRecord::kEnd;
  if (name == "CRYST1") return PdbRecord::kCell;
  return name.substr(0, 4) == "TER " ? PdbRecord::kTer : PdbRecord::kOther;
}

bool begins_pdb(std::string_view line) {
  return is_one_of(line.substr(0, 6), {"HEADER", "TITLE ", "REMARK", "CRYST1", "MODEL ", "HETATM", "COMPND"}) ||
         (line.substr(0, 4) == "ATOM" && is_atom(pdb_record_of(line)));
}

void check_pdb_position(std::string_view line, const std::string &path, size_t number) {
  if (line.size() < kPdbPositionEnd)
    fail_input(at_line(path, number) + "the record ends before its coordinates (columns 31 to 54)");
}

void read_pdb_position(std::string_view line, const std::string &path, size_t number, double *xyz) {
  check_pdb_position(line, path, number);
  for (int axis = 0; axis < 3; ++axis) {
    const std::string_view field = line.substr(30 + 8 * axis, 8);
    if (!parse_number(field, xyz[axis]))
      fail_input(at_line(path, number) + "the " + "xyz"[axis] + " coordinate '" + std::string(trim(field)) +
                 "' is no number (columns " + std::to_string(31 + 8 * axis) + " to " + std::to_string(38 + 8 * axis) +
                 ")");
  }
}

}  // namespace quickses::io
