// SPDX-License-Identifier: MIT
// Any bytes as a file of a structure, read with any options, which the last bytes name: the format is the very last.
#include "fuzz/fuzz.h"

#include <algorithm>
#include <string>
#include <vector>

namespace fuzz {
namespace {

using About = qses_structure_description;

void check_atoms(const qses_structure *structure, const About &about) {
  qses_atom atom;
  qses_atom_init(&atom);
  for (uint32_t k = 0; k < about.atom_count; ++k) {
    require(succeeds(qses_structure_atom(structure, k, &atom), {}), "every atom is told of");
    require(atom.name && atom.residue_name && atom.chain, "strings are never NULL");
    for (int axis = 0; axis < 3; ++axis) require(is_position(about.positions[3 * k + axis]), "a position");
    require(about.radii[k] > 0 && about.radii[k] <= 100, "a radius");
    require(about.file_indices[k] < about.file_atom_count, "a place in the file");
    require(k == 0 || about.file_indices[k] > about.file_indices[k - 1], "places in the file rise");
    const uint32_t before = k > 0 ? about.residues[k - 1] : 0;
    require(about.residues[k] == before || (k > 0 && about.residues[k] == before + 1), "residues rise by one");
  }
}

void check_colors(const qses_structure *structure, const About &about) {
  const uint8_t white[4] = {255, 255, 255, 255};
  std::vector<uint8_t> rgba(4 * size_t{about.atom_count});
  for (int scheme = QSES_COLOR_UNIFORM; scheme <= QSES_COLOR_SEQUENCE; ++scheme)
    succeeds(
        qses_structure_colors(structure, static_cast<qses_color_scheme>(scheme), white, rgba.data(), about.atom_count),
        {});
}

void check_selection(const qses_structure *structure, const About &about, const char *selection) {
  constexpr uint8_t kUntouched = 7;
  std::vector<uint8_t> mask(about.atom_count, kUntouched);
  uint32_t selected = 0;
  if (!succeeds(qses_structure_select(structure, selection, mask.data(), mask.size(), &selected),
                {QSES_INVALID_ARGUMENT})) {
    require(std::count(mask.begin(), mask.end(), kUntouched) == static_cast<long>(mask.size()), "a mask as it was");
    return;
  }
  require(std::count(mask.begin(), mask.end(), 1) == static_cast<long>(selected), "as many as it says");
  require(std::count(mask.begin(), mask.end(), 0) == static_cast<long>(mask.size() - selected), "0 for all others");
}

void check_warnings(const qses_structure *structure, const About &about) {
  for (uint32_t k = 0; k < about.warning_count; ++k) {
    const char *sentence = nullptr;
    require(succeeds(qses_structure_warning(structure, k, &sentence), {}) && sentence[0] != '\0', "a sentence");
  }
}

}  // namespace

void try_structure(const uint8_t *data, size_t size) {
  qses_input_set_limit(kInputLimit);
  Choices in(data, size);
  qses_structure_options options;
  qses_structure_options_init(&options);
  options.format = static_cast<qses_structure_format>(in.below(QSES_STRUCTURE_GRO + 1));
  const auto choose_selection = [&] {
    return in.among<const char *>({"", "protein", "not water and within 5 of (element C)", "//A/1-9",
                                   "same residue as name CA", "resid -5-40 52A", "altloc A or hydrogen or index 0-7",
                                   "(HEM) and not //B"});
  };
  options.selection = choose_selection();
  const char *const asked = choose_selection();
  options.assembly = in.among<const char *>({nullptr, "1", "2", ""});
  options.altloc = in.among<const char *>({nullptr, "highest", "A", "B"});
  options.model = in.among({1, 2, 0, -1});
  options.water = !in.yes();
  options.hetero = !in.yes();
  options.hydrogen = !in.yes();

  const std::vector<uint8_t> file = in.rest();
  qses_structure *structure = nullptr;
  if (!succeeds(qses_structure_open_memory(file.data(), file.size(), &options, &structure),
                {QSES_INVALID_ARGUMENT, QSES_FILE_ERROR})) {
    require(structure == nullptr, "none after a failure");
    return;
  }
  About about;
  qses_structure_description_init(&about);
  require(succeeds(qses_structure_info(structure, &about), {}) && about.atom_count > 0, "at least one atom");
  check_atoms(structure, about);
  check_colors(structure, about);
  check_selection(structure, about, asked);
  check_warnings(structure, about);
  qses_structure_close(structure);
}

}  // namespace fuzz
