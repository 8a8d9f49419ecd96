// SPDX-License-Identifier: MIT
// Text formats of one line per atom: XYZR, PQR (words, which PDB2PQR puts in columns, so that wide ones join) and GRO
// (GROMACS, nm).
#include "io/readers.h"  // first: settles how gemmi formats numbers

#include <algorithm>
#include <string_view>

#include "io/elements.h"
#include "io/error.h"
#include "io/limits.h"
#include "io/text.h"

namespace quickses::io {
namespace {

double number_at_line(std::string_view text, const char *what, const std::string &path, size_t line) {
  double value = 0;
  if (!parse_number(text, value))
    fail_input(at_line(path, line) + what + " '" + std::string(trim(text)) + "' is no number");
  return value;
}

float radius_at_line(std::string_view text, const std::string &path, size_t line) {
  const double radius = number_at_line(text, "the radius", path, line);
  if (radius < 0 || radius > kLargestRadius)
    fail_input(at_line(path, line) + "the radius '" + std::string(trim(text)) + "' is not between 0 and 100 Å");
  return static_cast<float>(radius);
}

const char *axis_name(int axis) {
  static const char *const kNames[] = {"the x coordinate", "the y coordinate", "the z coordinate"};
  return kNames[axis];
}

// What an atom's line of a PQR file says.
struct PqrLine {
  bool is_hetero;
  std::vector<std::string_view> words;  // serial name residue [chain] number x y z charge radius
};

// Splits a line into words, and words that columns have joined: the record and a long serial number, names of four
// letters each, a chain and a number of four digits, coordinates by the sign. False if it is no atom's.
bool split_pqr_line(std::string_view line, PqrLine &out) {
  line = trim(line);
  size_t begin = 0;
  for (const char *record : {"ATOM", "HETATM"})
    if (const std::string_view name = record; line.substr(0, name.size()) == name) begin = name.size();
  if (begin == 0 || (begin < line.size() && !is_blank(line[begin]) && !is_digit(line[begin]))) return false;
  out.is_hetero = line[0] == 'H';
  split_words(line.substr(begin), out.words);
  std::vector<std::string_view> &words = out.words;
  const auto split_at = [&](size_t k, size_t place) {
    words.insert(words.begin() + static_cast<std::ptrdiff_t>(k) + 1, words[k].substr(place));
    words[k] = words[k].substr(0, place);
  };
  constexpr size_t kMostWords = 10;  // what is behind them is not read
  for (size_t k = 3; k < std::min(words.size(), kMostWords); ++k)
    for (size_t sign = 1; sign < words[k].size(); ++sign)
      if (words[k][sign] == '-' && is_digit(words[k][sign - 1])) {
        split_at(k, sign);
        break;
      }
  if (words.size() > 1 && words.size() < 10 && words[1].size() == 8) split_at(1, 4);
  gemmi::SeqId number;
  if (words.size() == 9 && words[3].size() > 1 && is_letter(words[3][0]) &&
      parse_residue_number(words[3].substr(1), number))
    split_at(3, 1);
  return true;
}

}  // namespace

RawFile read_xyzr_text(const std::string &text, const std::string &path) {
  RawFile file;
  RawModel raw;
  raw.has_names = false;
  std::string_view rest = text, line;
  std::vector<std::string_view> words;
  for (size_t number = 1; next_line(rest, line); ++number) {
    split_words(line.substr(0, line.find('#')), words);
    if (words.empty()) continue;
    if (words.size() < 4) fail_input(at_line(path, number) + "expected x y z radius");
    gemmi::Atom atom;
    atom.pos.x = number_at_line(words[0], axis_name(0), path, number);
    atom.pos.y = number_at_line(words[1], axis_name(1), path, number);
    atom.pos.z = number_at_line(words[2], axis_name(2), path, number);
    raw.radii.push_back(radius_at_line(words[3], path, number));
    add_atom(raw, path, {"", "", gemmi::SeqId(0, ' ')}, std::move(atom));
  }
  file.model_count = raw.atom_count != 0;
  if (raw.atom_count != 0) file.models.push_back(std::move(raw));
  return file;
}

// Models begin with MODEL and end with ENDMDL; atoms outside begin one. Atoms may follow END.
RawFile read_pqr_text(const std::string &text, const std::string &path, int model) {
  RawFile file;
  bool is_open = false, is_wanted = false;
  const auto begin_model = [&] {
    is_open = true;
    ++file.model_count;
    is_wanted = model == 0 || model == file.model_count;
    if (!is_wanted) return;
    file.models.emplace_back();
    file.models.back().number = file.model_count;
    file.models.back().model.name = std::to_string(file.model_count);
  };
  std::string_view rest = text, line;
  PqrLine atom_line;
  for (size_t number = 1; next_line(rest, line); ++number) {
    if (line.substr(0, 6) == "ENDMDL") is_open = false;
    if (trim(line.substr(0, 6)) == "MODEL") begin_model();
    if (!split_pqr_line(line, atom_line)) continue;
    if (!is_open) begin_model();
    if (!is_wanted) continue;
    const std::vector<std::string_view> &words = atom_line.words;
    if (words.size() < 9)
      fail_input(at_line(path, number) + "expected ATOM serial name residue [chain] number x y z charge radius");
    const bool has_chain = words.size() > 9;
    const std::string_view chain = has_chain ? words[3] : "";
    const std::string_view *field = words.data() + (has_chain ? 4 : 3);
    gemmi::SeqId residue_number;
    if (!parse_residue_number(field[0], residue_number))
      fail_input(at_line(path, number) + "the residue number '" + std::string(field[0]) + "' is no number");
    gemmi::Atom atom;
    atom.name = std::string(words[1]);
    atom.pos.x = number_at_line(field[1], axis_name(0), path, number);
    atom.pos.y = number_at_line(field[2], axis_name(1), path, number);
    atom.pos.z = number_at_line(field[3], axis_name(2), path, number);
    atom.element = infer_element(std::string(words[2]), atom.name);  // PQR has no elements: nothing to warn of
    RawModel &raw = file.models.back();
    raw.radii.push_back(radius_at_line(field[5], path, number));
    add_atom(raw, path, {chain, words[2], residue_number, atom_line.is_hetero}, std::move(atom));
  }
  return file;
}

RawFile read_gro_text(const std::string &text, const std::string &path, int model) {
  RawFile file;
  std::string_view rest = text, line;
  size_t number = 0;
  for (;;) {  // frames: title, number of atoms, atoms, box
    ++number;
    if (!next_line(rest, line)) break;
    if (trim(line).empty() && rest.find_first_not_of(" \t\r\n\v\f") == std::string_view::npos) break;
    ++number;
    int count = 0;
    if (!next_line(rest, line) || !parse_integer(line, count) || count < 0)
      fail_input(at_line(path, number) + "expected the number of atoms");
    ++file.model_count;
    const bool wanted = model == 0 || model == file.model_count;
    RawModel raw;
    raw.number = file.model_count;
    raw.model.name = std::to_string(file.model_count);
    size_t width = 0;  // of a coordinate: the distance between decimal points, as GROMACS itself reads it
    for (int i = 0; i < count; ++i) {
      ++number;
      if (!next_line(rest, line))
        fail_input("'" + path + "' is cut off: it ends after " + std::to_string(i) + " of " +
                   counted(static_cast<uint64_t>(count), "atom"));
      if (!wanted) continue;
      if (width == 0) {
        const size_t first = line.find('.', 20);
        const size_t second = first == std::string_view::npos ? first : line.find('.', first + 1);
        if (second == std::string_view::npos) fail_input(at_line(path, number) + "expected three coordinates");
        width = second - first;
      }
      if (line.size() < 20 + 3 * width) fail_input(at_line(path, number) + "the line ends before its coordinates");
      int residue_number = 0;
      if (!parse_integer(line.substr(0, 5), residue_number))
        fail_input(at_line(path, number) + "the residue number '" + std::string(trim(line.substr(0, 5))) +
                   "' is no number");
      gemmi::Atom atom;
      const std::string residue(trim(line.substr(5, 5)));
      atom.name = std::string(trim(line.substr(10, 5)));
      atom.pos.x = 10 * number_at_line(line.substr(20, width), axis_name(0), path, number);
      atom.pos.y = 10 * number_at_line(line.substr(20 + width, width), axis_name(1), path, number);
      atom.pos.z = 10 * number_at_line(line.substr(20 + 2 * width, width), axis_name(2), path, number);
      // Four letters would be taken for the columns of PDB.
      atom.element = infer_element(residue, atom.name.size() == 4 ? atom.name + " " : atom.name);
      if (atom.element != gemmi::El::X) ++file.inferred_elements;
      add_atom(raw, path, {"", residue, gemmi::SeqId(residue_number, ' ')}, std::move(atom));
    }
    ++number;
    if (!next_line(rest, line)) fail_input("'" + path + "' is cut off: the line of the box is missing");
    if (wanted) file.models.push_back(std::move(raw));
  }
  return file;
}

}  // namespace quickses::io
