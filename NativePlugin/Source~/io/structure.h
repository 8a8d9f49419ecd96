// SPDX-License-Identifier: MIT
// Molecular structures from files: PDB, mmCIF, PQR, XYZR, GRO, each also gzipped.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/residue_kinds.h"

namespace quickses::io {

enum class StructureFormat { kPdb, kMmcif, kPqr, kXyzr, kGro };

// What a file says about one atom. In XYZR files there are no names: the strings are empty.
struct AtomInfo {
  std::string name;
  std::string residue_name;
  std::string chain;
  int residue_number = 0;
  char insertion_code = ' ';
  uint8_t element = 0;      // atomic number; 0 = unknown; deuterium counts as hydrogen
  bool hetero = false;      // HETATM
  bool hydrogen = false;    // H or D
  uint32_t file_index = 0;  // 0-based place among the atom records of its model, before any filter

  // What selections ask for besides.
  float occupancy = 1;
  float b_factor = 0;
  char alternate_location = '\0';  // '\0' = none
  uint8_t entity = 0;              // gemmi's EntityType of the residue
  bool deuterium = false;
  uint32_t unnumbered_residue = 0;          // which of the residues without a number, from 1; 0: it has one
  ResidueKind kind = ResidueKind::kLigand;  // of the residue

  // Where it is in its model, before any filter: so colours of a part are those of the whole.
  uint32_t chain_place = 0;  // of its chain, in the order of the file
  float along_chain = -1;  // 0 to 1: of its residue among those of protein and nucleic in its chain; -1: it is neither

  bool has_residue_number() const { return unnumbered_residue == 0; }
  bool is_water() const { return kind == ResidueKind::kWater; }
  bool is_of_polymer() const { return kind == ResidueKind::kProtein || kind == ResidueKind::kNucleic; }
};

// The atoms of one model that were kept, in the order of the file.
struct Structure {
  int model = 1;                 // place of the model in the file, from 1
  std::string model_name;        // the number that the file gives it
  bool has_names = true;         // false: XYZR
  std::vector<AtomInfo> atoms;   // N
  std::vector<float> positions;  // N x 3, Å
  std::vector<float> radii;      // N, Å; filled for PQR and XYZR only, else see assign_radii
  uint32_t file_atom_count = 0;  // M, atom records of this model in the file
  // M atomic numbers, those of atoms that were left out too; 0 = unknown. What a trajectory needs to find molecules.
  std::vector<uint8_t> file_elements;
};

struct ReadOptions {
  int model = 1;          // place of the model in the file, from 1; 0 = all models
  bool water = true;      // false: waters are left out
  bool hetero = true;     // false: HETATM records are left out (waters mostly are such records too)
  bool hydrogen = true;   // false: hydrogen and deuterium are left out
  std::string selection;  // see selection.h, such as "protein and chain A" or "//A/10-40"; empty = everything
  std::string assembly;   // of PDB and mmCIF files: the name of a biological assembly; empty = the atoms of the file
  std::string altloc;     // which alternate locations are taken: see alternate_locations.h; empty = the first
};

struct StructureFile {
  std::string name;  // as given, for messages
  StructureFormat format = StructureFormat::kPdb;
  int model_count = 0;                // models in the file
  bool has_model_records = true;      // false: a PDB file in which END or ENDMDL alone end models
  std::vector<Structure> models;      // those that were asked for; each has at least one atom
  std::vector<std::string> warnings;  // sentences for the user
};

// Reads a file. The format follows from the name, and for names that tell nothing from the content (PDB or mmCIF).
// Of alternate locations those without a label and one label of each residue are kept, unless the selection asks for
// locations itself. Of an assembly, places in the file are places among its atoms. Elements that the file leaves out
// are inferred from residue and atom name, with one warning. In PDB files, END and ENDMDL both end a model. Atoms of
// radius 0 (PQR, XYZR) and sites of water models that are no atoms are left out with a warning. Throws Error: kInput
// (file, syntax, no atoms; the message has file and line), kUsage (selection; no such model, no such assembly; filters
// on a file without names).
StructureFile read_structure(const std::string &path, const ReadOptions &options = ReadOptions());
StructureFile read_structure(const std::string &path, StructureFormat format, const ReadOptions &options);

// The same from bytes in memory, gzipped or not. Without a format, the name and the content tell. name: for messages.
StructureFile parse_structure(const std::string &bytes, std::optional<StructureFormat> format,
                              const ReadOptions &options = ReadOptions(), const std::string &name = "structure");

// mask[i] becomes 1 for the atoms that a selection names, in the syntax of ReadOptions.selection, else 0; mask has room
// for all atoms of the structure. Gives their number. Throws Error (kUsage): the selection can't be understood, or the
// structure has no names.
uint32_t select_atoms(const Structure &structure, const std::string &text, uint8_t *mask);

// Which residue each atom is of, from 0. Neighbours of the same chain, residue number (or place in
// the file, if there is no number), insertion code and residue name are of one; where there are no names each atom is
// one by itself.
std::vector<uint32_t> residues_of(const Structure &structure);

// Sets chain_place and along_chain of the atoms, which are all of the model and have their kinds.
void find_chain_places(Structure &structure);

// Bytes of memory that it takes.
uint64_t memory_of(const StructureFile &file);

}  // namespace quickses::io
