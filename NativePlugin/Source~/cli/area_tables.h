// SPDX-License-Identifier: MIT
// Areas per atom and per residue as CSV files.
#pragma once

#include <string>
#include <vector>

#include "cli/options.h"
#include "cli/text_output.h"
#include "io/structure.h"

namespace quickses::cli {

// How much of a surface belongs to each atom of a structure, Å².
struct AtomAreas {
  qses_surface surface;
  std::vector<double> areas;
};

// Those that come with a mesh, or none if they were not asked for.
std::vector<AtomAreas> areas_of(qses_surface surface, const qses_mesh &mesh);

// Lines of both tables; of one that is not asked for, none.
struct AreaRows {
  std::string per_atom, per_residue;
};

// first: what the first columns say (see AreaTables); nothing where there are none.
// The tables are those that the options ask for.
AreaRows make_area_rows(const Options &options, const std::string &first, const io::Structure &structure,
                        const std::vector<AtomAreas> &surfaces);

// The first columns of a structure's rows that are not of a trajectory.
std::string first_columns(const Options &options, const io::Structure &structure);

// Throws Failure (kUsage) if a table of residues is asked for and the file does not tell them.
void check_has_residues(const Options &options, const io::Structure &structure);

// The files, or those of them that the options ask for.
class AreaTables {
 public:
  // The first column is "frame" of a trajectory; "input" of several structures, then "model" of all models of a file;
  // else there is none.
  AreaTables(const Options &options, const std::vector<qses_surface> &surfaces);

  void write(const AreaRows &rows);
  void finish();

 private:
  void begin();

  TextOutput per_atom_, per_residue_;
  AreaRows headers_;
  bool has_begun_ = false;
};

}  // namespace quickses::cli
