// SPDX-License-Identifier: MIT
// PDB files. gemmi reads the records; before that each model is cut out of the text and cleaned: coordinates that are
// no numbers are refused, elements are filled in, and serial numbers are replaced by the place in the file, because
// gemmi regroups atoms by chain and residue.
#include "io/readers.h"  // first: settles how gemmi formats numbers

#include <algorithm>
#include <gemmi/pdb.hpp>
#include <string_view>

#include "io/elements.h"
#include "io/error.h"
#include "io/pdb_lines.h"
#include "io/text.h"

namespace quickses::io {
namespace {

// Serial number in five columns: decimal, then base 36 from A0000 on (hybrid-36).
void write_serial(uint32_t serial, char *columns) {
  static const char kDigits[] = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ";
  const bool decimal = serial < 100'000;
  const uint32_t base = decimal ? 10 : 36;
  uint32_t rest = decimal ? serial : serial - 100'000 + 10 * 36 * 36 * 36 * 36;
  for (int i = 4; i >= 0; --i, rest /= base) columns[i] = rest == 0 && i != 4 ? ' ' : kDigits[rest % base];
}

struct ModelText {
  int number;
  std::string name;
  std::string text;
  uint32_t atom_count;
};

class Splitter {
 public:
  Splitter(const std::string &path, int wanted) : path_(path), wanted_(wanted) {}

  void run(std::string_view text) {
    std::string_view line;
    while (next_line(text, line)) {
      ++line_number_;
      const PdbRecord record = pdb_record_of(line);
      if (is_atom(record)) {
        atom(line, record == PdbRecord::kAtom ? "ATOM  " : "HETATM");
      } else if (record == PdbRecord::kModel) {
        int number = 0;
        const bool has_number = line.size() > 6 && parse_integer(line.substr(6), number);
        begin_model(has_number ? std::to_string(number) : "");
      } else if (record == PdbRecord::kEnd) {
        open_ = false;
      } else if (record == PdbRecord::kTer) {
        if (open_ && is_wanted()) models.back().text += "TER\n";
      }
    }
  }

  int model_count = 0;
  std::vector<ModelText> models;
  size_t inferred_elements = 0;

 private:
  bool is_wanted() const { return wanted_ == 0 || wanted_ == model_count; }

  void begin_model(const std::string &name) {
    ++model_count;
    open_ = true;
    if (is_wanted()) models.push_back({model_count, name.empty() ? std::to_string(model_count) : name, "", 0});
  }

  void atom(std::string_view line, const char *record) {
    if (!open_) begin_model("");
    if (!is_wanted()) return;
    double position[3];
    read_pdb_position(line, path_, line_number_, position);
    ModelText &model = models.back();
    if (++model.atom_count > kMostAtoms)
      fail_input("'" + path_ + "' has more than " + std::to_string(kMostAtoms) + " atoms in one model");

    char columns[79];
    std::fill(columns, columns + 78, ' ');
    std::copy_n(line.data(), std::min<size_t>(line.size(), 78), columns);
    for (char *c = columns; c != columns + 78; ++c) *c = *c == '\0' || *c == '\t' ? ' ' : to_ascii(*c);
    columns[78] = '\n';
    std::copy_n(record, 6, columns);
    write_serial(model.atom_count, columns + 6);
    write_element(columns);
    model.text.append(columns, sizeof columns);
  }

  void write_element(char *columns) {
    const std::string_view given = trim(std::string_view(columns + 76, 2));
    gemmi::El element = parse_element(std::string(given));
    if (element == gemmi::El::X && given != "X") {
      element = infer_element(std::string(columns + 17, 3), std::string(columns + 12, 4));
      ++inferred_elements;
    }
    const char *symbol = gemmi::element_uppercase_name(element);
    columns[76] = symbol[1] == '\0' ? ' ' : symbol[0];
    columns[77] = symbol[1] == '\0' ? symbol[0] : symbol[1];
  }

  const std::string &path_;
  const int wanted_;
  size_t line_number_ = 0;
  bool open_ = false;
};

}  // namespace

RawFile read_pdb_text(const std::string &text, const std::string &path, int model) {
  Splitter splitter(path, model);
  splitter.run(text);
  RawFile file;
  file.model_count = splitter.model_count;
  file.inferred_elements = splitter.inferred_elements;
  for (ModelText &part : splitter.models) {
    RawModel raw;
    raw.number = part.number;
    raw.atom_count = part.atom_count;
    if (part.atom_count != 0) {
      try {
        gemmi::Structure structure = gemmi::read_pdb_from_memory(part.text.data(), part.text.size(), path);
        raw.model = std::move(structure.models.at(0));
      } catch (const std::bad_alloc &) {
        throw;
      } catch (const std::exception &error) {
        fail_input("'" + path + "' can't be read as PDB: " + error.what());
      }
    }
    raw.model.name = part.name;
    part.text = std::string();
    file.models.push_back(std::move(raw));
  }
  return file;
}

}  // namespace quickses::io
