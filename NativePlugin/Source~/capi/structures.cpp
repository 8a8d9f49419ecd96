// SPDX-License-Identifier: MIT
// The C API: structures from files and from memory.
#include "capi/choices.h"
#include "capi/structs.h"
#include "io/atom_colors.h"
#include "io/file_bytes.h"
#include "io/radii.h"
#include "io/structure.h"
#include "io/text.h"
#include "quickses/quickses.h"

#include <functional>
#include <memory>
#include <optional>

using quickses::check_atom_count;
using quickses::check_choice;
using quickses::guarded;
using quickses::invalid;
using quickses::own_choice;
using quickses::public_choice;
using quickses::read_struct;
using quickses::require;
using quickses::write_struct;
namespace io = quickses::io;

struct qses_structure {
  io::StructureFile file;  // with one model
  std::vector<uint32_t> file_indices;
  std::vector<uint32_t> residues;  // of each atom

  uint64_t memory = 0;  // bytes

  const io::Structure &model() const { return file.models.front(); }
};

namespace {

constexpr qses_structure_format kFormats[] = {QSES_STRUCTURE_PDB, QSES_STRUCTURE_MMCIF, QSES_STRUCTURE_PQR,
                                              QSES_STRUCTURE_XYZR, QSES_STRUCTURE_GRO};
constexpr qses_color_scheme kSchemes[] = {QSES_COLOR_UNIFORM, QSES_COLOR_ELEMENT,        QSES_COLOR_CHAIN,
                                          QSES_COLOR_RESIDUE, QSES_COLOR_HYDROPHOBICITY, QSES_COLOR_SEQUENCE};

io::ReadOptions read_options_of(const qses_structure_options &options) {
  check_choice("options.format", options.format, QSES_STRUCTURE_GRO);
  if (options.model < 1) invalid("options.model is " + std::to_string(options.model) + ": models count from 1");
  io::ReadOptions read;
  read.model = options.model;
  read.water = options.water != 0;
  read.hetero = options.hetero != 0;
  read.hydrogen = options.hydrogen != 0;
  if (options.selection) read.selection = options.selection;
  if (options.assembly) read.assembly = options.assembly;
  if (options.altloc) read.altloc = options.altloc;
  return read;
}

using Read = std::function<io::StructureFile(std::optional<io::StructureFormat>, const io::ReadOptions &)>;

void open_structure(const Read &read, const qses_structure_options *options, qses_structure **structure) {
  const qses_structure_options o = read_struct(options, qses_structure_options_init, "qses_structure_options");
  auto opened = std::make_unique<qses_structure>();
  const io::ReadOptions read_options = read_options_of(o);
  opened->file = read(own_choice<io::StructureFormat>(kFormats, o.format), read_options);
  io::assign_radii(opened->file, o.radii ? o.radii : "");
  for (const io::AtomInfo &atom : opened->model().atoms) opened->file_indices.push_back(atom.file_index);
  opened->residues = io::residues_of(opened->model());
  opened->memory = sizeof *opened - sizeof opened->file + io::memory_of(opened->file) +
                   (opened->file_indices.capacity() + opened->residues.capacity()) * sizeof(uint32_t);
  *structure = opened.release();
}

}  // namespace

extern "C" {

void qses_input_set_limit(uint64_t bytes) { io::set_input_limit(bytes); }

qses_status qses_structure_open(const char *path, const qses_structure_options *options, qses_structure **structure) {
  if (structure) *structure = nullptr;
  return guarded([&] {
    require(path, "path");
    require(structure, "structure");
    const Read read = [path](std::optional<io::StructureFormat> format, const io::ReadOptions &read_options) {
      return format ? io::read_structure(path, *format, read_options) : io::read_structure(path, read_options);
    };
    open_structure(read, options, structure);
  });
}

qses_status qses_structure_open_memory(const void *bytes, size_t size, const qses_structure_options *options,
                                       qses_structure **structure) {
  if (structure) *structure = nullptr;
  return guarded([&] {
    require(bytes, "bytes");
    require(structure, "structure");
    const Read read = [&](std::optional<io::StructureFormat> format, const io::ReadOptions &read_options) {
      return io::parse_structure(std::string(static_cast<const char *>(bytes), size), format, read_options);
    };
    open_structure(read, options, structure);
  });
}

void qses_structure_close(qses_structure *structure) {
  guarded([&] { delete structure; });
}

qses_status qses_structure_info(const qses_structure *structure, qses_structure_description *description) {
  return guarded([&] {
    require(structure, "structure");
    require(description, "description");
    const io::Structure &model = structure->model();
    qses_structure_description value;
    qses_structure_description_init(&value);
    value.format = public_choice(kFormats, structure->file.format);
    value.model = model.model;
    value.model_count = structure->file.model_count;
    value.atom_count = static_cast<uint32_t>(model.atoms.size());
    value.file_atom_count = model.file_atom_count;
    value.positions = model.positions.data();
    value.radii = model.radii.data();
    value.file_indices = structure->file_indices.data();
    value.file_elements = model.file_elements.data();
    value.warning_count = static_cast<uint32_t>(structure->file.warnings.size());
    value.memory = structure->memory;
    value.residues = structure->residues.data();
    write_struct(description, value, "qses_structure_description");
  });
}

qses_status qses_structure_atom(const qses_structure *structure, uint32_t k, qses_atom *atom) {
  return guarded([&] {
    require(structure, "structure");
    require(atom, "atom");
    const io::AtomInfo &from = quickses::pick(structure->model().atoms, k, "atom");
    qses_atom value;
    qses_atom_init(&value);
    value.name = from.name.c_str();
    value.residue_name = from.residue_name.c_str();
    value.chain = from.chain.c_str();
    value.residue_number = from.residue_number;
    value.is_hetero = from.hetero;
    value.is_water = from.is_water();
    value.is_hydrogen = from.hydrogen;
    value.element = from.element;
    value.insertion_code = from.insertion_code;
    write_struct(atom, value, "qses_atom");
  });
}

qses_status qses_structure_select(const qses_structure *structure, const char *selection, uint8_t *mask, size_t count,
                                  uint32_t *selected) {
  return guarded([&] {
    require(structure, "structure");
    require(selection, "selection");
    require(mask, "mask");
    const io::Structure &model = structure->model();
    check_atom_count(count, model.atoms.size(), "structure");
    const uint32_t found = io::select_atoms(model, selection, mask);
    if (selected) *selected = found;
  });
}

qses_status qses_structure_colors(const qses_structure *structure, qses_color_scheme scheme,
                                  const uint8_t uniform_rgba[4], uint8_t *rgba, size_t count) {
  return guarded([&] {
    require(structure, "structure");
    require(uniform_rgba, "uniform_rgba");
    require(rgba, "rgba");
    check_choice("scheme", scheme, QSES_COLOR_SEQUENCE);
    const io::ColorScheme chosen = *own_choice<io::ColorScheme>(kSchemes, scheme);
    check_atom_count(count, structure->model().atoms.size(), "structure");
    const io::Rgba uniform = {uniform_rgba[0], uniform_rgba[1], uniform_rgba[2], uniform_rgba[3]};
    io::color_atoms(structure->model(), chosen, uniform, rgba);
  });
}

qses_status qses_structure_warning(const qses_structure *structure, uint32_t k, const char **sentence) {
  return guarded([&] {
    require(structure, "structure");
    require(sentence, "sentence");
    *sentence = quickses::pick(structure->file.warnings, k, "warning").c_str();
  });
}

}  // extern "C"
