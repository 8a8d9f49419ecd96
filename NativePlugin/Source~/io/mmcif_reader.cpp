// SPDX-License-Identifier: MIT
// mmCIF files. gemmi reads the syntax and builds the model; in between, the atom table is copied with the columns that
// gemmi insists on, so that files of other programs, which leave some out, can be read too.
#include "io/readers.h"  // first: settles how gemmi formats numbers

#include <algorithm>
#include <gemmi/cif.hpp>
#include <gemmi/mmcif.hpp>
#include <gemmi/numb.hpp>
#include <unordered_map>

#include "io/elements.h"
#include "io/error.h"
#include "io/text.h"

namespace quickses::io {
namespace {

namespace cif = gemmi::cif;

enum Column {  // gemmi wants one that must be there first
  kX,
  kY,
  kZ,
  kGroup,
  kSymbol,
  kLabelAtom,
  kAuthAtom,
  kAltLoc,
  kLabelResidue,
  kAuthResidue,
  kLabelChain,
  kAuthChain,
  kEntity,
  kLabelNumber,
  kAuthNumber,
  kInsertion,
  kOccupancy,
  kBFactor,
  kModel
};

std::vector<std::string> column_names() {
  return {"Cartn_x",
          "Cartn_y",
          "Cartn_z",
          "?group_PDB",
          "?type_symbol",
          "?label_atom_id",
          "?auth_atom_id",
          "?label_alt_id",
          "?label_comp_id",
          "?auth_comp_id",
          "?label_asym_id",
          "?auth_asym_id",
          "?label_entity_id",
          "?label_seq_id",
          "?auth_seq_id",
          "?pdbx_PDB_ins_code",
          "?occupancy",
          "?B_iso_or_equiv",
          "?pdbx_PDB_model_num"};
}

std::string value_or(cif::Table::Row &row, Column column, const char *otherwise) {
  return row.has2(column) ? row[column] : otherwise;
}

// The author's name where there is one, as PDB files have it, else the label.
std::string first_of(cif::Table::Row &row, Column author, Column label, const char *otherwise) {
  return row.has2(author) ? row[author] : value_or(row, label, otherwise);
}

// The block of one model, as gemmi wants it.
struct ModelBlock {
  std::string name;
  cif::Block block{"model"};
  uint32_t atom_count = 0;
};

class TableReader {
 public:
  TableReader(cif::Block &source, const std::string &path, int wanted) : path_(path), wanted_(wanted) {
    cif::Table table = source.find("_atom_site.", column_names());
    size_t row_number = 0;
    for (cif::Table::Row row : table) add(row, ++row_number);
    cif::Table entities = source.find("_entity.", {"id", "type"});
    for (ModelBlock &model : models) {
      cif::Loop &loop = model.block.init_loop("_entity.", {"id", "type"});
      for (cif::Table::Row row : entities) loop.add_row({row[0], row[1]});
    }
  }

  std::vector<ModelBlock> models;  // all of the file; those not wanted stay without rows
  size_t inferred_elements = 0;

 private:
  void add(cif::Table::Row &row, size_t row_number) {
    const std::string name = row.has2(kModel) ? row.str(kModel) : "1";
    if (models.empty() || models[current_].name != name) {
      const auto found = index_.emplace(name, models.size());
      current_ = found.first->second;
      if (found.second) {
        models.emplace_back();
        models.back().name = name;
        models.back().block.init_loop(
            "_atom_site.", {"id", "group_PDB", "type_symbol", "label_atom_id", "label_alt_id", "label_comp_id",
                            "label_asym_id", "label_entity_id", "label_seq_id", "pdbx_PDB_ins_code", "Cartn_x",
                            "Cartn_y", "Cartn_z", "occupancy", "B_iso_or_equiv", "auth_seq_id", "auth_asym_id"});
      }
    }
    if (wanted_ != 0 && static_cast<size_t>(wanted_) != current_ + 1) return;
    for (Column axis : {kX, kY, kZ})
      if (!cif::is_numb(row[axis]))
        fail_input("'" + path_ + "', atom " + std::to_string(row_number) + " of _atom_site: the " + "xyz"[axis - kX] +
                   " coordinate '" + row[axis] + "' is no number");
    const std::string number = first_of(row, kAuthNumber, kLabelNumber, "?");
    const std::string label_number = value_or(row, kLabelNumber, "?");
    for (const std::string &text : {number, label_number}) check_residue_number(text, row_number);
    ModelBlock &model = models[current_];
    std::vector<std::string> &values = model.block.items.front().loop.values;
    std::string residue = first_of(row, kAuthResidue, kLabelResidue, "UNK");
    std::transform(residue.begin(), residue.end(), residue.begin(), to_ascii);
    const std::string atom = first_of(row, kAuthAtom, kLabelAtom, "X");
    const std::string chain = first_of(row, kLabelChain, kAuthChain, "A");
    values.push_back(std::to_string(++model.atom_count));
    values.push_back(value_or(row, kGroup, "ATOM"));
    values.push_back(element_symbol(row, residue, atom));
    values.push_back(atom);
    values.push_back(value_or(row, kAltLoc, "."));
    values.push_back(residue);
    values.push_back(chain);
    values.push_back(value_or(row, kEntity, "?"));
    values.push_back(label_number);
    values.push_back(value_or(row, kInsertion, "?"));
    for (Column axis : {kX, kY, kZ}) values.push_back(row[axis]);
    values.push_back(value_or(row, kOccupancy, "1"));
    values.push_back(value_or(row, kBFactor, "0"));
    values.push_back(number);
    values.push_back(row.has2(kAuthChain) ? row[kAuthChain] : chain);
  }

  // gemmi finds what is no number, but not what an int can't hold.
  void check_residue_number(const std::string &text, size_t row_number) const {
    constexpr ptrdiff_t kMostDigits = 9;
    if (std::count_if(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; }) > kMostDigits)
      fail_input("'" + path_ + "', atom " + std::to_string(row_number) + " of _atom_site: the residue number '" + text +
                 "' has more than 9 digits");
  }

  std::string element_symbol(cif::Table::Row &row, const std::string &residue, const std::string &atom) {
    const std::string given = row.has2(kSymbol) ? row.str(kSymbol) : "";
    gemmi::El element = parse_element(given);
    if (element == gemmi::El::X && given != "X") {
      element = infer_element(cif::as_string(residue), cif::as_string(atom));
      if (element != gemmi::El::X) ++inferred_elements;
    }
    return gemmi::element_name(element);
  }

  const std::string &path_;
  const int wanted_;
  size_t current_ = 0;
  std::unordered_map<std::string, size_t> index_;
};

}  // namespace

RawFile read_mmcif_text(const std::string &text, const std::string &path, int model) {
  try {
    RawFile file;
    std::vector<ModelBlock> parts;
    {
      cif::Document document = cif::read_memory(text.data(), text.size(), path.c_str());
      for (cif::Block &block : document.blocks) {
        TableReader table(block, path, model);
        if (table.models.empty()) continue;
        file.inferred_elements = table.inferred_elements;
        parts = std::move(table.models);
        break;  // the first block with atoms is the structure
      }
    }
    file.model_count = static_cast<int>(parts.size());
    for (size_t i = 0; i < parts.size(); ++i) {
      if (parts[i].atom_count == 0) continue;
      RawModel raw;
      raw.number = static_cast<int>(i) + 1;
      raw.atom_count = parts[i].atom_count;
      gemmi::Structure structure = gemmi::make_structure_from_block(parts[i].block);
      raw.model = std::move(structure.models.at(0));
      raw.model.name = parts[i].name;
      parts[i].block = cif::Block();
      file.models.push_back(std::move(raw));
    }
    return file;
  } catch (const Error &) {
    throw;
  } catch (const std::bad_alloc &) {
    throw;
  } catch (const std::exception &error) {
    fail_input("'" + path + "' can't be read as mmCIF: " + error.what());
  }
}

}  // namespace quickses::io
