// SPDX-License-Identifier: MIT
// Areas per atom and per residue as CSV files.
#include "cli/area_tables.h"

#include "cli/csv.h"
#include "cli/exit_code.h"

namespace quickses::cli {
namespace {

constexpr int kDigits = 6;  // so that a table adds up to its total

std::string residue_fields(const io::Structure &structure, const io::AtomInfo &atom) {
  if (!structure.has_names) return ",,,";
  return csv_field(atom.chain) + "," + (atom.has_residue_number() ? std::to_string(atom.residue_number) : "") + "," +
         csv_field(atom.insertion_code == ' ' ? "" : std::string(1, atom.insertion_code)) + "," +
         csv_field(atom.residue_name);
}

std::string atom_rows(const std::string &first, const io::Structure &structure,
                      const std::vector<AtomAreas> &surfaces) {
  std::string rows;
  for (size_t i = 0; i < structure.atoms.size(); ++i) {
    const io::AtomInfo &atom = structure.atoms[i];
    if (!first.empty()) rows += first + ",";
    rows += std::to_string(atom.file_index) + "," + residue_fields(structure, atom) + "," + csv_field(atom.name) + "," +
            csv_number(static_cast<double>(structure.radii[i]), 3);
    for (const AtomAreas &surface : surfaces) rows += "," + csv_number(surface.areas[i], kDigits);
    rows += "\n";
  }
  return rows;
}

std::string residue_rows(const std::string &first, const io::Structure &structure,
                         const std::vector<AtomAreas> &surfaces) {
  const std::vector<uint32_t> residues = io::residues_of(structure);
  std::string rows;
  for (size_t begin = 0, end; begin < residues.size(); begin = end) {
    for (end = begin; end < residues.size() && residues[end] == residues[begin];) ++end;
    if (!first.empty()) rows += first + ",";
    rows += residue_fields(structure, structure.atoms[begin]);
    for (const AtomAreas &surface : surfaces) {
      double sum = 0;
      for (size_t i = begin; i < end; ++i) sum += surface.areas[i];
      rows += "," + csv_number(sum, kDigits);
    }
    rows += "\n";
  }
  return rows;
}

}  // namespace

std::vector<AtomAreas> areas_of(qses_surface surface, const qses_mesh &mesh) {
  if (!mesh.atom_areas) return {};
  return {{surface, std::vector<double>(mesh.atom_areas, mesh.atom_areas + mesh.atom_count)}};
}

AreaRows make_area_rows(const Options &options, const std::string &first, const io::Structure &structure,
                        const std::vector<AtomAreas> &surfaces) {
  AreaRows rows;
  if (!options.per_atom.empty()) rows.per_atom = atom_rows(first, structure, surfaces);
  if (!options.per_residue.empty()) rows.per_residue = residue_rows(first, structure, surfaces);
  return rows;
}

std::string first_columns(const Options &options, const io::Structure &structure) {
  const std::string input = options.has_several_inputs() ? csv_field(options.input) : "";
  const std::string model = options.read.model == 0 ? std::to_string(structure.model) : "";
  return input + (input.empty() || model.empty() ? "" : ",") + model;
}

void check_has_residues(const Options &options, const io::Structure &structure) {
  if (!options.per_residue.empty() && !structure.has_names)
    throw Failure(kUsage, "--per-residue: '" + options.input + "' does not tell residues");
}

AreaTables::AreaTables(const Options &options, const std::vector<qses_surface> &surfaces)
    : per_atom_(options.per_atom), per_residue_(options.per_residue) {
  std::string first = options.trajectories.empty() ? "" : "frame,";
  if (options.has_several_inputs()) first += "input,";
  if (options.read.model == 0) first += "model,";
  const std::string residue = "chain,residue_number,insertion_code,residue_name";
  std::string areas;
  for (const qses_surface surface : surfaces) areas += std::string(",") + name_of(surface) + "_area_A2";
  if (!options.per_atom.empty()) headers_.per_atom = first + "atom," + residue + ",atom_name,radius_A" + areas + "\n";
  if (!options.per_residue.empty()) headers_.per_residue = first + residue + areas + "\n";
}

// Not before something is known: after an error nothing was printed.
void AreaTables::begin() {
  if (has_begun_) return;
  has_begun_ = true;
  per_atom_.write(headers_.per_atom);
  per_residue_.write(headers_.per_residue);
}

void AreaTables::write(const AreaRows &rows) {
  begin();
  per_atom_.write(rows.per_atom);
  per_residue_.write(rows.per_residue);
}

void AreaTables::finish() {
  begin();
  per_atom_.finish();
  per_residue_.finish();
}

}  // namespace quickses::cli
