// SPDX-License-Identifier: MIT
// Molecular structures from files: choice of the format, filters, alternate locations.
#include "io/structure.h"

#include "io/selection.h"  // first: settles how gemmi formats numbers

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "io/alternate_locations.h"
#include "io/assembly.h"
#include "io/elements.h"
#include "io/error.h"
#include "io/file_bytes.h"
#include "io/file_path.h"
#include "io/limits.h"
#include "io/pdb_lines.h"
#include "io/text.h"

namespace quickses::io {
namespace {

struct AtomRef {
  const gemmi::Chain *chain;
  const gemmi::Residue *residue;
  const gemmi::Atom *atom;
};

bool format_of_content(std::string_view text, StructureFormat &format) {
  std::string_view line;
  while (next_line(text, line)) {
    const std::string_view word = trim(line);
    if (word.empty() || word[0] == '#') continue;
    if (word.substr(0, 5) == "data_") {
      format = StructureFormat::kMmcif;
      return true;
    }
    format = StructureFormat::kPdb;
    return begins_pdb(line);
  }
  return false;
}

// What a server sends instead of a file that it does not have.
void refuse_web_page(const std::string &path, const std::string &text) {
  const size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos || text[begin] != '<') return;
  const std::string head = lowered(std::string_view(text).substr(begin, 1024));
  if (head.find("<!doctype html") != std::string::npos || head.find("<html") != std::string::npos)
    fail_input("'" + path +
               "' looks like a web page, not like a structure: the address that it was loaded from may be wrong");
}

StructureFormat find_format(const std::string &path, const std::string &text) {
  const std::string extension = lower_extension_of_content(path_of(path));
  if (extension == ".bcif" || extension == ".mmtf")
    fail_input("'" + path + "': " + (extension == ".bcif" ? "BinaryCIF" : "MMTF") +
               " files are not read; the mmCIF file of the same entry (.cif or .cif.gz) is");
  if (extension == ".pdb" || extension == ".ent" || extension == ".brk") return StructureFormat::kPdb;
  if (extension == ".cif" || extension == ".mmcif") return StructureFormat::kMmcif;
  if (extension == ".pqr") return StructureFormat::kPqr;
  if (extension == ".xyzr" || extension == ".xyzrn") return StructureFormat::kXyzr;
  if (extension == ".gro") return StructureFormat::kGro;
  StructureFormat format;
  if (!format_of_content(text, format))
    fail_input("'" + path + "': its name and content tell no format; known are .pdb .ent .brk .cif .mmcif .pqr .xyzr " +
               ".xyzrn .gro, each also as .gz; of others the format has to be given");
  return format;
}

RawFile read_raw(StructureFormat format, const std::string &text, const std::string &path, int model) {
  switch (format) {
    case StructureFormat::kPdb:
      return read_pdb_text(text, path, model);
    case StructureFormat::kMmcif:
      return read_mmcif_text(text, path, model);
    case StructureFormat::kPqr:
      return read_pqr_text(text, path, model);
    case StructureFormat::kXyzr:
      return read_xyzr_text(text, path);
    case StructureFormat::kGro:
      return read_gro_text(text, path, model);
  }
  fail_input("'" + path + "': unknown format");
}

std::vector<AtomRef> in_file_order(const gemmi::Model &model) {
  std::vector<AtomRef> refs;
  for (const gemmi::Chain &chain : model.chains)
    for (const gemmi::Residue &residue : chain.residues)
      for (const gemmi::Atom &atom : residue.atoms) refs.push_back({&chain, &residue, &atom});
  const auto by_place = [](const AtomRef &a, const AtomRef &b) { return a.atom->serial < b.atom->serial; };
  if (!std::is_sorted(refs.begin(), refs.end(), by_place)) std::sort(refs.begin(), refs.end(), by_place);
  return refs;
}

uint8_t atomic_number(const gemmi::Atom &atom) { return static_cast<uint8_t>(atom.element.atomic_number()); }

AtomInfo describe(const AtomRef &ref) {
  AtomInfo info;
  info.name = ref.atom->name;
  info.residue_name = ref.residue->name;
  info.chain = ref.chain->name;
  if (ref.residue->seqid.num) info.residue_number = *ref.residue->seqid.num;
  info.insertion_code = ref.residue->seqid.icode;
  info.element = atomic_number(*ref.atom);
  info.hetero = ref.residue->het_flag == 'H';
  info.hydrogen = ref.atom->element.is_hydrogen();
  info.file_index = static_cast<uint32_t>(ref.atom->serial - 1);
  info.occupancy = ref.atom->occ;
  info.b_factor = ref.atom->b_iso;
  info.alternate_location = ref.atom->altloc;
  info.entity = static_cast<uint8_t>(ref.residue->entity_type);
  info.deuterium = ref.atom->element == gemmi::El::D;
  return info;
}

struct Filter {
  const ReadOptions &options;
  const Selection selection;

  bool keep(const AtomInfo &info) const {
    if (!options.water && info.is_water()) return false;
    if (!options.hetero && info.hetero) return false;
    return options.hydrogen || !info.hydrogen;
  }

  bool is_any() const { return !options.water || !options.hetero || !options.hydrogen || !selection.is_everything(); }
};

bool is_near(double x) { return std::abs(x) <= kFarthest; }

[[noreturn]] void fail_far_away(const std::string &path, const AtomInfo &info) {
  fail_input("'" + path + "': atom " + std::to_string(info.file_index + 1) +
             (info.name.empty() ? "" : " (" + info.name + " of " + info.residue_name + ")") +
             " is more than 1,000,000 Å from the origin");
}

void check_options(const ReadOptions &options) {
  Selection selection(options.selection);
  AlternateLocations locations(options.altloc);
}

// Before a model is taken apart.
void build_assembly(RawFile &file, StructureFormat format, const std::string &text, const std::string &path,
                    const std::string &name) {
  if (name.empty() || file.models.empty()) return;
  if (format != StructureFormat::kPdb && format != StructureFormat::kMmcif)
    fail_usage("'" + path + "': only PDB and mmCIF files describe assemblies");
  const gemmi::Assembly assembly =
      format == StructureFormat::kPdb ? find_pdb_assembly(text, path, name) : find_mmcif_assembly(text, path, name);
  for (RawModel &raw : file.models)
    if (raw.atom_count != 0) build_assembly(assembly, raw, path);
}

// All atoms of the model but those at locations that are not taken.
Structure flatten(const RawModel &raw, const Filter &filter, std::string &warning) {
  Structure structure;
  structure.model = raw.number;
  structure.model_name = printable(raw.model.name);
  structure.has_names = raw.has_names;
  structure.file_atom_count = raw.atom_count;
  structure.file_elements.resize(raw.atom_count);
  const std::vector<AtomRef> refs = in_file_order(raw.model);
  structure.atoms.reserve(refs.size());
  structure.positions.reserve(3 * refs.size());
  AlternateLocations locations(filter.options.altloc);
  for (const AtomRef &ref : refs) locations.see(*ref.chain, *ref.residue, *ref.atom);
  const gemmi::Residue *last_unnumbered = nullptr;
  uint32_t unnumbered_count = 0;
  const bool takes_all = filter.selection.asks_for_locations();
  if (!takes_all) warning = locations.warning();
  for (const AtomRef &ref : refs) {
    structure.file_elements[static_cast<size_t>(ref.atom->serial - 1)] = atomic_number(*ref.atom);
    if (!takes_all && !locations.keep(*ref.chain, *ref.residue, *ref.atom)) continue;
    structure.atoms.push_back(describe(ref));
    if (!ref.residue->seqid.num && ref.residue != last_unnumbered) {
      last_unnumbered = ref.residue;
      ++unnumbered_count;
    }
    if (!ref.residue->seqid.num) structure.atoms.back().unnumbered_residue = unnumbered_count;
    for (double x : {ref.atom->pos.x, ref.atom->pos.y, ref.atom->pos.z})
      structure.positions.push_back(is_near(x) ? static_cast<float>(x) : std::numeric_limits<float>::infinity());
    if (!raw.radii.empty()) structure.radii.push_back(raw.radii[structure.atoms.back().file_index]);
  }
  find_residue_kinds(structure);
  find_chain_places(structure);
  return structure;
}

// What has no surface, whatever the filters.
struct NoAtoms {
  size_t radius_zero = 0, virtual_sites = 0;
};

// Leaves out what the filters and the selection do, and what has no surface, which is counted. The selection looks at
// all the atoms: what filters leave out may still be what others are near to.
void leave_out(Structure &structure, const Filter &filter, const std::string &path, const std::string &which,
               NoAtoms &no_atoms) {
  const bool selects = !filter.selection.is_everything();
  const std::vector<uint8_t> mask = selects ? filter.selection.select(structure) : std::vector<uint8_t>();
  if (selects && std::find(mask.begin(), mask.end(), 1) == mask.end())
    fail_input(
        "no atoms of " + which + "'" + path + "' are left after the filters: the selection '" +
        excerpt_of(filter.selection.text()) +
        "' names none (it may be words such as 'chain A and protein', or CID such as '//A'); the structure has " +
        contents_of(structure));
  size_t kept = 0;
  for (size_t i = 0; i < structure.atoms.size(); ++i) {
    AtomInfo &info = structure.atoms[i];
    if ((selects && !mask[i]) || !filter.keep(info)) continue;
    if (!structure.radii.empty()) {
      if (structure.radii[i] == 0) {
        ++no_atoms.radius_zero;
        continue;
      }
      structure.radii[kept] = structure.radii[i];
    } else if (info.is_water() && is_site_of_water(info.name)) {
      ++no_atoms.virtual_sites;
      continue;
    }
    for (size_t axis = 0; axis < 3; ++axis) {
      const float x = structure.positions[3 * i + axis];
      if (!is_near(x)) fail_far_away(path, info);
      structure.positions[3 * kept + axis] = x;
    }
    if (kept != i) structure.atoms[kept] = std::move(info);
    ++kept;
  }
  structure.atoms.resize(kept);
  structure.positions.resize(3 * kept);
  if (!structure.radii.empty()) structure.radii.resize(kept);
  if (kept == structure.atoms.capacity()) return;
  structure.atoms.shrink_to_fit();
  structure.positions.shrink_to_fit();
  structure.radii.shrink_to_fit();
}

// text: unpacked. path: as given, or any name for messages.
StructureFile parse_text(std::string text, const std::string &path, std::optional<StructureFormat> format,
                         const ReadOptions &options) {
  unify_text(text);
  refuse_web_page(path, text);
  const Filter filter{options, Selection(options.selection)};
  StructureFile file;
  file.name = path;
  file.format = format ? *format : find_format(path, text);
  RawFile raw_file = read_raw(file.format, text, path, options.model);
  file.model_count = raw_file.model_count;
  file.has_model_records = raw_file.has_model_records;
  if (file.model_count == 0) fail_input("'" + path + "' has no atoms");
  if (options.model < 0 || options.model > file.model_count)
    fail_usage("'" + path + "' has " + counted(static_cast<uint64_t>(file.model_count), "model") +
               ": there is no model " + std::to_string(options.model) +
               " (they are counted from 1, whatever numbers the file gives them)");

  build_assembly(raw_file, file.format, text, path, options.assembly);
  NoAtoms no_atoms;
  for (RawModel &raw : raw_file.models) {
    const std::string which = file.model_count == 1 ? "" : "model " + std::to_string(raw.number) + " of ";
    if (raw.atom_count == 0) fail_input(which + "'" + path + "' has no atoms");
    if (!raw.has_names && filter.is_any())
      fail_usage("'" + path + "' has no names, so nothing can be selected from it or left out");
    std::string warning;
    file.models.push_back(flatten(raw, filter, warning));
    if (!warning.empty() && file.models.size() == 1) file.warnings.push_back(which + "'" + path + "': " + warning);
    raw.model = gemmi::Model(raw.model.name);
    const NoAtoms before = no_atoms;
    leave_out(file.models.back(), filter, path, which, no_atoms);
    if (!file.models.back().atoms.empty()) continue;
    const char *const without = no_atoms.radius_zero > before.radius_zero ? "those of radius 0 were left out"
                                : no_atoms.virtual_sites > before.virtual_sites
                                    ? "sites that are no atoms were left out"
                                    : "";
    const std::string why =
        std::string(filter.is_any() ? "the filters" : "") + (filter.is_any() && *without ? ", and " : "") + without;
    fail_input("no atoms of " + which + "'" + path + "' are left after " + why);
  }
  if (raw_file.inferred_elements != 0)
    file.warnings.push_back("'" + path + "': the element of " + counted(raw_file.inferred_elements, "atom") +
                            " was missing and was inferred from residue and atom name");
  if (no_atoms.radius_zero != 0)
    file.warnings.push_back("'" + path + "': " + counted(no_atoms.radius_zero, "atom") + " of radius 0 left out");
  if (no_atoms.virtual_sites != 0)
    file.warnings.push_back("'" + path + "': " + counted(no_atoms.virtual_sites, "site") + " of water left out that " +
                            (no_atoms.virtual_sites == 1 ? "is no atom" : "are no atoms") + ", such as MW of TIP4P");
  return file;
}

}  // namespace

std::vector<uint32_t> residues_of(const Structure &structure) {
  const auto are_of_one = [](const AtomInfo &a, const AtomInfo &b) {
    return a.residue_number == b.residue_number && a.unnumbered_residue == b.unnumbered_residue &&
           a.insertion_code == b.insertion_code && a.residue_name == b.residue_name && a.chain == b.chain;
  };
  std::vector<uint32_t> residues(structure.atoms.size());
  for (size_t k = 1; k < residues.size(); ++k) {
    const bool is_same = structure.has_names && are_of_one(structure.atoms[k - 1], structure.atoms[k]);
    residues[k] = residues[k - 1] + (is_same ? 0 : 1);
  }
  return residues;
}

void find_chain_places(Structure &structure) {
  const std::vector<uint32_t> residues = residues_of(structure);
  std::unordered_map<std::string, uint32_t> chains;
  std::vector<uint32_t> lengths;                  // of the chains, in residues of protein and nucleic
  std::vector<uint32_t> places(residues.size());  // in their chains
  uint32_t last_residue = UINT32_MAX;
  for (size_t i = 0; i < residues.size(); ++i) {
    AtomInfo &atom = structure.atoms[i];
    atom.chain_place = chains.emplace(atom.chain, static_cast<uint32_t>(chains.size())).first->second;
    if (atom.chain_place == lengths.size()) lengths.push_back(0);
    if (!atom.is_of_polymer()) continue;
    uint32_t &length = lengths[atom.chain_place];
    if (residues[i] != last_residue) ++length;
    last_residue = residues[i];
    places[i] = length - 1;
  }
  for (size_t i = 0; i < residues.size(); ++i) {
    AtomInfo &atom = structure.atoms[i];
    if (!atom.is_of_polymer()) continue;
    const uint32_t steps = lengths[atom.chain_place] - 1;
    atom.along_chain = steps > 0 ? static_cast<float>(places[i]) / static_cast<float>(steps) : 0;
  }
}

uint64_t memory_of(const StructureFile &file) {
  // Short strings lie in the string itself.
  const auto outside = [](const std::string &text) {
    return text.capacity() <= std::string().capacity() ? 0 : text.capacity() + 1;
  };
  uint64_t bytes = sizeof file + outside(file.name);
  for (const Structure &model : file.models) {
    bytes += sizeof model + model.atoms.capacity() * sizeof(AtomInfo) + model.file_elements.capacity() +
             (model.positions.capacity() + model.radii.capacity()) * sizeof(float);
    for (const AtomInfo &atom : model.atoms)
      bytes += outside(atom.name) + outside(atom.residue_name) + outside(atom.chain);
  }
  for (const std::string &warning : file.warnings) bytes += sizeof warning + outside(warning);
  return bytes;
}

StructureFile read_structure(const std::string &path, const ReadOptions &options) {
  check_options(options);  // before a large file is read
  return parse_text(read_file_bytes(path), path, std::nullopt, options);
}

StructureFile read_structure(const std::string &path, StructureFormat format, const ReadOptions &options) {
  check_options(options);
  return parse_text(read_file_bytes(path), path, format, options);
}

StructureFile parse_structure(const std::string &bytes, std::optional<StructureFormat> format,
                              const ReadOptions &options, const std::string &name) {
  return parse_text(unpack_gzip(bytes, name), name, format, options);
}

}  // namespace quickses::io
