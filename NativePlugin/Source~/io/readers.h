// SPDX-License-Identifier: MIT
// The readers behind read_structure: each turns the text of a file into gemmi models whose atoms carry, in `serial`,
// 1 + their place among the atom records of the model.
#pragma once

// gemmi formats numbers with the bundled stb_sprintf, which distributions take out; the C library does it as well.
#ifndef USE_STD_SNPRINTF
#define USE_STD_SNPRINTF
#endif
#include <gemmi/model.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace quickses::io {

struct RawModel {
  int number = 1;            // place in the file, from 1
  gemmi::Model model{"1"};   // its name is the number the file gives it
  uint32_t atom_count = 0;   // atom records
  std::vector<float> radii;  // atom_count of them where the format has radii, else empty
  bool has_names = true;     // false: XYZR
};

struct RawFile {
  int model_count = 0;
  bool has_model_records = true;
  std::vector<RawModel> models;  // those that were asked for
  size_t inferred_elements = 0;  // atoms of those models whose element was inferred
};

// model: place in the file, from 1; 0 = all. path is for messages only. All throw Error (kInput).
RawFile read_pdb_text(const std::string &text, const std::string &path, int model);
RawFile read_mmcif_text(const std::string &text, const std::string &path, int model);
RawFile read_pqr_text(const std::string &text, const std::string &path, int model);
RawFile read_xyzr_text(const std::string &text, const std::string &path);
RawFile read_gro_text(const std::string &text, const std::string &path, int model);

// Where an atom is in its model, in the words of the file.
struct AtomPlace {
  std::string_view chain, residue;
  gemmi::SeqId number;
  bool hetero = false;
  bool begins_residue = false;  // even if chain, residue and number are those of the atom before
};

// Appends an atom and gives its residue. Of the names only printable ASCII stays: they are written to terminals. Throws
// Error (kInput): more than kMostAtoms.
gemmi::Residue &add_atom(RawModel &raw, const std::string &path, const AtomPlace &place, gemmi::Atom atom);

// A residue number with a possible insertion code behind: "52A".
bool parse_residue_number(std::string_view word, gemmi::SeqId &id);

}  // namespace quickses::io
