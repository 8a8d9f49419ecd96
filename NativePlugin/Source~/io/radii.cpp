// SPDX-License-Identifier: MIT
// Van der Waals radii by element, and by residue and atom.
#include "io/radii.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <gemmi/elem.hpp>
#include <string_view>
#include <utility>

#include "io/elements.h"
#include "io/error.h"
#include "io/file_bytes.h"
#include "io/file_path.h"
#include "io/limits.h"
#include "io/readers.h"
#include "io/text.h"

namespace quickses::io {
namespace {

struct ElementRadius {
  gemmi::El element;
  float radius;
};

std::string name_of(std::string_view residue, std::string_view atom) { return raised(residue) + ' ' + raised(atom); }

Radii read_radii(const std::string &path) {
  std::string text = read_file_bytes(path);
  unify_text(text);
  Radii radii;
  radii.by_element = quickses_radii();
  std::array<bool, std::tuple_size<RadiusTable>::value> named = {};
  float others = 0;
  std::string_view rest = text, line;
  std::vector<std::string_view> words;
  for (size_t number = 1; next_line(rest, line); ++number) {
    split_words(line.substr(0, line.find('#')), words);
    if (words.empty()) continue;
    if (words.size() != 2 && words.size() != 3)
      fail_input(at_line(path, number) + "expected an element and its radius, or a residue, an atom and its radius");
    double number_there = 0;
    const float radius = parse_number(words.back(), number_there) ? static_cast<float>(number_there) : 0.f;
    if (!(radius > 0) || radius > kLargestRadius)
      fail_input(at_line(path, number) + "the radius '" + std::string(words.back()) +
                 "' is no number above 0 and up to 100 Å");
    if (words[0] == "*" && (words.size() == 2 || words[1] == "*")) {
      others = radius;
      continue;
    }
    if (words.size() == 3) {
      radii.by_name[name_of(words[0], words[1])] = radius;
      continue;
    }
    const std::string symbol(words[0]);
    // "C1" is an atom whose residue was forgotten.
    const bool has_digit = std::any_of(symbol.begin(), symbol.end(), is_digit);
    const gemmi::Element element(has_digit ? gemmi::El::X : parse_element(symbol));
    if (element == gemmi::El::X && raised(symbol) != "X")
      fail_input(at_line(path, number) + "'" + symbol + "' is no element");
    radii.by_element[element.atomic_number()] = radius;
    named[element.atomic_number()] = true;
  }
  if (others > 0)
    for (size_t i = 0; i < named.size(); ++i)
      if (!named[i]) radii.by_element[i] = others;
  return radii;
}

}  // namespace

RadiusTable quickses_radii() {
  using gemmi::El;
  RadiusTable table;
  table.fill(1.40f);
  for (const ElementRadius &entry : std::initializer_list<ElementRadius>{
           {El::H, 1.20f}, {El::C, 1.70f}, {El::N, 1.55f}, {El::O, 1.52f}, {El::P, 1.80f}, {El::S, 1.80f}})
    table[static_cast<size_t>(entry.element)] = entry.radius;
  return table;
}

RadiusTable bondi_radii() {
  using gemmi::El;
  static const ElementRadius kBondi[] = {
      {El::H, 1.20f},  {El::He, 1.40f}, {El::Li, 1.82f}, {El::C, 1.70f},  {El::N, 1.55f},  {El::O, 1.52f},
      {El::F, 1.47f},  {El::Ne, 1.54f}, {El::Na, 2.27f}, {El::Mg, 1.73f}, {El::Si, 2.10f}, {El::P, 1.80f},
      {El::S, 1.80f},  {El::Cl, 1.75f}, {El::Ar, 1.88f}, {El::K, 2.75f},  {El::Ni, 1.63f}, {El::Cu, 1.40f},
      {El::Zn, 1.39f}, {El::Ga, 1.87f}, {El::As, 1.85f}, {El::Se, 1.90f}, {El::Br, 1.85f}, {El::Kr, 2.02f},
      {El::Pd, 1.63f}, {El::Ag, 1.72f}, {El::Cd, 1.58f}, {El::In, 1.93f}, {El::Sn, 2.17f}, {El::Te, 2.06f},
      {El::I, 1.98f},  {El::Xe, 2.16f}, {El::Pt, 1.75f}, {El::Au, 1.66f}, {El::Hg, 1.55f}, {El::Tl, 1.96f},
      {El::Pb, 2.02f}, {El::U, 1.86f}};
  static const ElementRadius kMantina[] = {{El::Be, 1.53f}, {El::B, 1.92f},  {El::Al, 1.84f}, {El::Ca, 2.31f},
                                           {El::Ge, 2.11f}, {El::Rb, 3.03f}, {El::Sr, 2.49f}, {El::Sb, 2.06f},
                                           {El::Cs, 3.43f}, {El::Ba, 2.68f}, {El::Bi, 2.07f}, {El::Po, 1.97f},
                                           {El::At, 2.02f}, {El::Rn, 2.20f}, {El::Fr, 3.48f}, {El::Ra, 2.83f}};
  RadiusTable table;
  table.fill(2.00f);
  for (const ElementRadius &entry : kMantina) table[static_cast<size_t>(entry.element)] = entry.radius;
  for (const ElementRadius &entry : kBondi) table[static_cast<size_t>(entry.element)] = entry.radius;
  return table;
}

bool is_radius_set(const std::string &name) { return name == "quickses" || name == "bondi"; }

std::optional<float> Radii::of_names(const AtomInfo &atom) const {
  if (by_name.empty()) return std::nullopt;
  const std::pair<std::string_view, std::string_view> names[] = {
      {atom.residue_name, atom.name}, {atom.residue_name, "*"}, {"*", atom.name}};
  for (const auto &[residue, name] : names)
    if (const auto found = by_name.find(name_of(residue, name)); found != by_name.end()) return found->second;
  return std::nullopt;
}

Radii find_radii(const std::string &name_or_path) {
  if (name_or_path == "quickses") return {quickses_radii(), {}};
  if (name_or_path == "bondi") return {bondi_radii(), {}};
  std::error_code error;
  if (!std::filesystem::exists(path_of(name_or_path), error))
    fail_input("'" + name_or_path + "' is neither a set of radii (quickses, bondi) nor a file");
  return read_radii(name_or_path);
}

void assign_radii(Structure &structure, const Radii &radii) {
  structure.radii.clear();
  structure.radii.reserve(structure.atoms.size());
  for (const AtomInfo &atom : structure.atoms) structure.radii.push_back(radii.of(atom));
}

bool has_own_radii(StructureFormat format) {
  return format == StructureFormat::kPqr || format == StructureFormat::kXyzr;
}

void assign_radii(StructureFile &file, const std::string &radius_set) {
  if (has_own_radii(file.format)) {
    if (!radius_set.empty()) fail_usage("radii: the file has radii of its own, so none can be chosen");
    return;
  }
  const Radii radii = find_radii(radius_set.empty() ? "quickses" : radius_set);
  size_t unknown = 0;
  for (Structure &structure : file.models) {
    assign_radii(structure, radii);
    unknown +=
        static_cast<size_t>(std::count_if(structure.atoms.begin(), structure.atoms.end(), [&](const AtomInfo &atom) {
          return atom.element == 0 && !radii.of_names(atom);
        }));
  }
  if (unknown == 0) return;
  char radius[32];
  std::snprintf(radius, sizeof radius, "%.2f", static_cast<double>(radii.by_element[0]));
  file.warnings.push_back("'" + file.name + "': the element of " + counted(unknown, "atom") +
                          " is unknown; the radius of such atoms is " + radius + " Å");
}

}  // namespace quickses::io
