// SPDX-License-Identifier: MIT
// Lines of PDB files, read alike for structures and for trajectories.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace quickses::io {

enum class PdbRecord { kAtom, kHetatm, kModel, kEnd, kTer, kCell, kOther };

// By the first six columns, in any case; serial numbers of ATOM records may reach into them. kEnd: ENDMDL or END.
PdbRecord pdb_record_of(std::string_view line);
inline bool is_atom(PdbRecord record) { return record == PdbRecord::kAtom || record == PdbRecord::kHetatm; }

// Whether a PDB file may begin with this line.
bool begins_pdb(std::string_view line);

// The coordinates of an atom, in Å: columns 31 to 54, all of them, since of a number that was cut off a part would be a
// number too. Throw Error (kInput) naming the file and the line.
constexpr size_t kPdbPositionEnd = 54;
void check_pdb_position(std::string_view line, const std::string &path, size_t number);  // whether they are there
void read_pdb_position(std::string_view line, const std::string &path, size_t number, double *xyz);

}  // namespace quickses::io
