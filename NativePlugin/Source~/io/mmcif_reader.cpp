// SPDX-License-Identifier: MIT
// mmCIF files, also those of other programs, which leave out columns. gemmi reads the syntax; the model is built here,
// as gemmi insists on more columns and looks for each residue among all those of its chain.
#include "io/readers.h"  // first: settles how gemmi formats numbers

#include <gemmi/cif.hpp>
#include <gemmi/enumstr.hpp>
#include <gemmi/numb.hpp>
#include <unordered_map>

#include "io/elements.h"
#include "io/error.h"
#include "io/text.h"

namespace quickses::io {
namespace {

namespace cif = gemmi::cif;

enum Column {  // those that must be there are first, as gemmi wants it
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

// The first of two values that is there, without quotes.
std::string first_there(cif::Table::Row &row, Column first, Column second, const char *otherwise) {
  return row.has2(first) ? row.str(first) : row.has2(second) ? row.str(second) : otherwise;
}

double number_in(cif::Table::Row &row, Column column, double otherwise) {
  return row.has(column) ? cif::as_number(row[column], otherwise) : otherwise;
}

char letter_in(cif::Table::Row &row, Column column, char otherwise) {
  return row.has(column) ? cif::as_char(row[column], otherwise) : otherwise;
}

class TableReader {
 public:
  TableReader(cif::Block &source, const std::string &path, int wanted) : path_(path), wanted_(wanted) {
    for (cif::Table::Row row : source.find("_entity.", {"id", "type"}))
      entities_[row.str(0)] = gemmi::entity_type_from_string(row.str(1));
    size_t row_number = 0;
    for (cif::Table::Row row : source.find("_atom_site.", column_names())) add(row, ++row_number);
    file.model_count = static_cast<int>(places_.size());
  }

  RawFile file;

 private:
  void add(cif::Table::Row &row, size_t row_number) {
    const std::string model = row.has2(kModel) ? row.str(kModel) : "1";
    if (row_number == 1 || model != model_) begin_model(model);
    if (!raw_) return;
    const auto fail = [&](const std::string &what) {
      fail_input("'" + path_ + "', atom " + std::to_string(row_number) + " of _atom_site: the " + what);
    };
    for (Column axis : {kX, kY, kZ})
      if (!cif::is_numb(row[axis]))
        fail(std::string(1, "xyz"[axis - kX]) + " coordinate '" + row[axis] + "' is no number");
    // The author's names where there are some, as PDB files have them.
    const std::string residue = first_there(row, kAuthResidue, kLabelResidue, "UNK");
    const std::string chain = first_there(row, kAuthChain, kLabelChain, "A");
    gemmi::SeqId number;
    const std::string digits = first_there(row, kAuthNumber, kLabelNumber, "");
    if (!digits.empty() && !parse_residue_number(digits, number))
      fail("residue number '" + digits + "' is no whole number, or too large");
    if (number.icode == ' ') number.icode = letter_in(row, kInsertion, ' ');
    gemmi::Atom atom;
    atom.name = first_there(row, kAuthAtom, kLabelAtom, "X");
    atom.altloc = letter_in(row, kAltLoc, '\0');
    atom.element = element_of(row, residue, atom.name);
    atom.pos = gemmi::Position(cif::as_number(row[kX]), cif::as_number(row[kY]), cif::as_number(row[kZ]));
    atom.occ = static_cast<float>(number_in(row, kOccupancy, 1));
    atom.b_iso = static_cast<float>(number_in(row, kBFactor, 0));
    const bool hetero = row.has2(kGroup) && to_upper(row.str(kGroup)[0]) == 'H';
    gemmi::Residue &last = add_atom(*raw_, path_, {chain, residue, number, hetero}, std::move(atom));
    if (last.atoms.size() != 1) return;
    last.subchain = first_there(row, kLabelChain, kAuthChain, "A");  // what assemblies name
    const auto entity = entities_.find(row.has2(kEntity) ? row.str(kEntity) : "");
    if (entity != entities_.end()) last.entity_type = entity->second;
  }

  // Or goes on with it, where rows of models alternate.
  void begin_model(const std::string &name) {
    model_ = name;
    const auto [found, is_new] = places_.emplace(name, places_.size());
    const size_t place = found->second;
    const bool is_wanted = wanted_ == 0 || place + 1 == static_cast<size_t>(wanted_);
    raw_ = nullptr;
    if (!is_wanted) return;
    if (is_new) {
      file.models.emplace_back();
      file.models.back().number = static_cast<int>(place) + 1;
      file.models.back().model.name = name;
    }
    raw_ = wanted_ == 0 ? &file.models[place] : &file.models.front();
  }

  gemmi::El element_of(cif::Table::Row &row, const std::string &residue, const std::string &atom) {
    const std::string given = row.has2(kSymbol) ? row.str(kSymbol) : "";
    gemmi::El element = parse_element(given);
    if (element != gemmi::El::X || given == "X") return element;
    element = infer_element(residue, atom);
    if (element != gemmi::El::X) ++file.inferred_elements;
    return element;
  }

  const std::string &path_;
  const int wanted_;
  std::unordered_map<std::string, gemmi::EntityType> entities_;
  std::unordered_map<std::string, size_t> places_;  // of the models
  std::string model_;                               // the name of the current one
  RawModel *raw_ = nullptr;                         // the current one; null: it is not wanted
};

}  // namespace

RawFile read_mmcif_text(const std::string &text, const std::string &path, int model) {
  try {
    cif::Document document = cif::read_memory(text.data(), text.size(), path.c_str());
    for (cif::Block &block : document.blocks) {
      TableReader table(block, path, model);
      if (table.file.model_count != 0) return std::move(table.file);  // the first block with atoms is the structure
    }
    fail_input("'" + path + "' has no atoms: nowhere in it has _atom_site Cartn_x, Cartn_y and Cartn_z");
  } catch (const Error &) {
    throw;
  } catch (const std::bad_alloc &) {
    throw;
  } catch (const std::exception &error) {
    fail_input("'" + path + "' can't be read as mmCIF: " + error.what());
  }
}

}  // namespace quickses::io
