// SPDX-License-Identifier: MIT
// quickses cavities INPUT: a table of the cavities of a surface, the largest first.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/csv.h"
#include "cli/engine.h"
#include "cli/input.h"
#include "cli/mesh_output.h"
#include "cli/progress.h"
#include "cli/report.h"
#include "cli/text_output.h"
#include "io/text.h"

namespace quickses::cli {
namespace {

struct Cavity {
  uint32_t id;  // the number of the component
  qses_component component;
  std::vector<uint32_t> atoms;  // of the structure, that line it
};

// What a cavity holds, Å³.
double volume_of(const Cavity &cavity) { return std::fabs(cavity.component.volume); }

std::vector<Cavity> find_cavities(const Engine &engine, const qses_mesh &mesh) {
  std::vector<uint32_t> starts, atoms;
  engine.find_component_atoms(mesh, &starts, &atoms);
  std::vector<Cavity> cavities;
  for (uint32_t k = 0; k < mesh.component_count; ++k)
    if (mesh.components[k].is_cavity)
      cavities.push_back({k, mesh.components[k], {atoms.begin() + starts[k], atoms.begin() + starts[k + 1]}});
  std::stable_sort(cavities.begin(), cavities.end(),
                   [](const Cavity &a, const Cavity &b) { return volume_of(a) > volume_of(b); });
  return cavities;
}

// The first atom of each residue that lines a cavity.
std::vector<uint32_t> lining_residues(const Cavity &cavity, const std::vector<uint32_t> &residues) {
  std::vector<uint32_t> first;
  for (const uint32_t atom : cavity.atoms)
    if (first.empty() || residues[atom] != residues[first.back()]) first.push_back(atom);
  return first;
}

// As A:ALA10, with its insertion code behind; chain and colon only if there is one.
std::string name_of_residue(const io::AtomInfo &atom) {
  std::string name = atom.chain.empty() ? "" : atom.chain + ":";
  name += atom.residue_name;
  if (atom.has_residue_number()) name += std::to_string(atom.residue_number);
  if (atom.insertion_code != ' ') name += atom.insertion_code;
  return name;
}

// With blanks between them. Of files without names: nothing.
std::string lining_names(const Cavity &cavity, const io::Structure &structure, const std::vector<uint32_t> &residues) {
  std::string names;
  if (!structure.has_names) return names;
  for (const uint32_t atom : lining_residues(cavity, residues))
    names += (names.empty() ? "" : " ") + name_of_residue(structure.atoms[atom]);
  return names;
}

std::string csv_table(const std::vector<Cavity> &cavities, const io::Structure &structure,
                      const std::vector<uint32_t> &residues) {
  std::string table = "component,volume_A3,area_A2,center_x_A,center_y_A,center_z_A,lining_atoms,lining_residues\n";
  for (const Cavity &cavity : cavities) {
    const qses_component &c = cavity.component;
    table += std::to_string(cavity.id) + "," + csv_number(volume_of(cavity), 4) + "," + csv_number(c.area, 4);
    for (const float x : c.center) table += "," + csv_number(static_cast<double>(x), 3);
    table +=
        "," + std::to_string(cavity.atoms.size()) + "," + csv_field(lining_names(cavity, structure, residues)) + "\n";
  }
  return table;
}

Json cavities_json(const std::vector<Cavity> &cavities, const io::Structure &structure,
                   const std::vector<uint32_t> &residues) {
  Json list = Json::array();
  for (const Cavity &cavity : cavities) {
    Json entry = component_json(cavity.id, cavity.component);
    entry.erase("cavity");
    entry["volume"] = volume_of(cavity);
    Json atoms = Json::array(), lining = Json::array();
    for (const uint32_t atom : cavity.atoms) atoms.push_back(structure.atoms[atom].file_index);
    for (const uint32_t first : lining_residues(cavity, residues)) {
      if (!structure.has_names) break;
      const io::AtomInfo &atom = structure.atoms[first];
      lining.push_back({{"chain", atom.chain},
                        {"residue_number", atom.has_residue_number() ? Json(atom.residue_number) : Json()},
                        {"insertion_code", atom.insertion_code == ' ' ? "" : std::string(1, atom.insertion_code)},
                        {"residue_name", atom.residue_name}});
    }
    entry["lining_atoms"] = atoms;
    entry["lining_residues"] = lining;
    list.push_back(entry);
  }
  return list;
}

void print_cavities(const Options &options, const std::vector<Cavity> &cavities, const io::Structure &structure,
                    const std::vector<uint32_t> &residues) {
  double volume = 0;
  for (const Cavity &cavity : cavities) volume += volume_of(cavity);
  char surface[96];
  std::snprintf(surface, sizeof surface, "%s surface, %sspacing %g Å", name_of(options.compute.surface),
                probe_text({options.compute.surface}, options.compute.probe).c_str(), options.compute.spacing);
  if (cavities.empty()) {
    std::printf("%s: no cavities (%s)\n", options.input.c_str(), surface);
    return;
  }
  std::printf("%s: %s, %.2f Å³ (%s)\n", options.input.c_str(),
              io::counted(cavities.size(), "cavity", "cavities").c_str(), volume, surface);
  std::printf("component  volume Å³    area Å²   centre x, y, z Å             lining residues\n");
  for (const Cavity &cavity : cavities) {
    const qses_component &c = cavity.component;
    std::printf("%9u %10.2f %10.2f  %9.2f %9.2f %9.2f  %s\n", cavity.id, volume_of(cavity), c.area,
                static_cast<double>(c.center[0]), static_cast<double>(c.center[1]), static_cast<double>(c.center[2]),
                lining_names(cavity, structure, residues).c_str());
  }
}

}  // namespace

void run_cavities(const Options &options) {
  check_text_output(options.csv);
  check_text_output(options.json);
  const Input input(options, options.quiet);
  const io::Structure &structure = input.file.models.front();

  Engine engine = start_engine(options.compute, options.quiet);
  qses_settings settings = settings_of(options.compute);
  settings.component_ids = 1;
  engine.set_atoms(structure, options.input);
  qses_mesh mesh;
  {
    ProgressBar bar(engine.context(), options.quiet);
    mesh = engine.compute(settings);
  }
  accept_surface(mesh);
  const std::vector<Cavity> cavities = find_cavities(engine, mesh);
  const std::vector<uint32_t> residues = io::residues_of(structure);
  if (!options.csv.empty()) write_text(options.csv, csv_table(cavities, structure, residues));
  if (!options.json.empty()) {
    Json json = report_head_json(input.options, structure, engine);
    json["cavities"] = cavities_json(cavities, structure, residues);
    json["time_ms"] = {{"read", input.read_ms}, {"compute", engine.report().compute_ms}};
    write_text(options.json, dump(json, false));
  }
  if (!options.quiet && !options.prints_data()) print_cavities(options, cavities, structure, residues);
}

}  // namespace quickses::cli
