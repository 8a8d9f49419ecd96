// SPDX-License-Identifier: MIT
// PDB files: the columns of the format (wwPDB, version 3.3), and what programs write where it has no room.
#include "io/readers.h"  // first: settles how gemmi formats numbers

#include <algorithm>
#include <charconv>
#include <gemmi/resinfo.hpp>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "io/elements.h"
#include "io/error.h"
#include "io/pdb_lines.h"
#include "io/simulation_names.h"
#include "io/text.h"

namespace quickses::io {
namespace {

// Numbers from 10000 on in four columns. VMD writes them in base 16 and small letters, 2a00. Hybrid-36
// (cci.lbl.gov/hybrid_36) begins with a letter, A000 for 10000 to ZZZZ, and then from 1,223,056 on with a small one;
// what both could have written is taken for VMD's.
bool parse_letters(std::string_view digits, int &number) {
  constexpr int kLeast = 10'000, kOfLetters = 26 * 36 * 36 * 36;
  if (digits.size() != 4) return false;
  const auto all = [&](auto &&holds) { return std::all_of(digits.begin(), digits.end(), holds); };
  const auto is_between = [](char c, char first, char last) { return c >= first && c <= last; };
  const auto read = [&](int base) {
    std::from_chars(digits.data(), digits.data() + digits.size(), number, base);
    return true;
  };
  if (all([&](char c) { return is_digit(c) || is_between(c, 'a', 'f'); })) return read(16);
  if (is_digit(digits[0])) return false;
  const bool is_small = all([&](char c) { return is_digit(c) || is_between(c, 'a', 'z'); });
  if (!is_small && !all([&](char c) { return is_digit(c) || is_between(c, 'A', 'Z'); })) return false;
  read(36);
  number += kLeast - 10 * 36 * 36 * 36 + (is_small ? kOfLetters : 0);
  return true;
}

// An atom's record, blank behind its end. Columns count from 1, as in the format.
class AtomRecord {
 public:
  explicit AtomRecord(std::string_view line) {
    line = line.substr(0, kColumns);
    std::fill(std::begin(text_), std::end(text_), ' ');
    std::transform(line.begin(), line.end(), text_,
                   [](char c) { return c == '\0' || is_blank(c) ? ' ' : to_ascii(c); });
  }

  char column(size_t place) const { return text_[place - 1]; }
  std::string columns(size_t first, size_t last) const { return std::string(text_ + first - 1, text_ + last); }
  std::string word(size_t first, size_t last) const { return std::string(trim(columns(first, last))); }
  double number(size_t first, size_t last, double otherwise) const {
    double value = 0;
    return parse_number(columns(first, last), value) ? value : otherwise;
  }

  // The residue's name, chain and what there is in place of its number.
  std::string place() const { return columns(18, 27); }

  // From 10000 on, five digits and more reach into the column of the insertion code, which is a letter, or the four
  // columns have other digits. None where they are no number: of VMD's residues from 65536 on they are ****.
  gemmi::SeqId residue_number() const {
    const char *const first = text_ + 22, *const last = first + 4;
    if (std::all_of(first, last, is_digit) && is_digit(*last)) {
      gemmi::SeqId id(0, ' ');
      std::from_chars(first, std::find_if_not(last, static_cast<const char *>(text_ + 30), is_digit), *id.num);
      return id;
    }
    gemmi::SeqId id;
    id.icode = *last;
    const std::string digits = word(23, 26);
    int number = 0;
    if (parse_integer(digits, number) || parse_letters(digits, number)) id.num = number;
    return id;
  }

 private:
  static constexpr size_t kColumns = 80;
  char text_[kColumns];
};

// Column 21 is blank by the format. CHARMM, NAMD and Amber have the fourth letter of a residue's name there (TIP3,
// POPC, NALA), gemmi and Phenix the first one of a chain of two ("ALAAB" is in chain AB): then several amino acids and
// nucleotides of the PDB are before the same letter. One or two may be names that begin so, as CHARMM's CYSP and GLYM.
bool has_chains_of_two_letters(std::string_view text) {
  std::unordered_map<char, std::unordered_set<std::string>> residues;  // by the letter behind them
  std::string_view line;
  while (next_line(text, line)) {
    if (line.size() < 21 || is_blank(line[20]) || !is_atom(pdb_record_of(line))) continue;
    const AtomRecord record(line);
    const std::string residue = record.word(18, 20), name = record.word(18, 21);
    if (is_one_of(name, {"TIP3", "TIP4", "TIP5"})) return false;
    if (!gemmi::find_tabulated_residue(residue).is_standard() || find_simulated_residue(name).is_known()) continue;
    residues[record.column(21)].insert(residue);
  }
  return std::any_of(residues.begin(), residues.end(),
                     [](const auto &of_letter) { return of_letter.second.size() >= 3; });
}

class Reader {
 public:
  Reader(const std::string &path, int wanted) : path_(path), wanted_(wanted) {}

  RawFile run(std::string_view text) {
    has_chains_of_two_letters_ = has_chains_of_two_letters(text);
    file_.has_model_records = false;
    std::string_view line;
    while (next_line(text, line)) {
      ++line_number_;
      const PdbRecord record = pdb_record_of(line);
      if (is_atom(record)) {
        atom(line, record == PdbRecord::kHetatm);
      } else if (record == PdbRecord::kModel) {
        file_.has_model_records = true;
        int number = 0;
        const bool has_number = line.size() > 6 && parse_integer(line.substr(6), number);
        begin_model(has_number ? std::to_string(number) : "");
      } else if (record == PdbRecord::kEnd) {
        is_open_ = false;
      } else if (record == PdbRecord::kTer) {
        if (is_open_ && is_wanted()) end_polymer();
      }
    }
    return std::move(file_);
  }

 private:
  bool is_wanted() const { return wanted_ == 0 || wanted_ == file_.model_count; }

  void begin_model(const std::string &name) {
    ++file_.model_count;
    is_open_ = true;
    if (!is_wanted()) return;
    RawModel raw;
    raw.number = file_.model_count;
    raw.model.name = name.empty() ? std::to_string(file_.model_count) : name;
    file_.models.push_back(std::move(raw));
    chain_count_ = 0;
    ended_chains_.clear();
  }

  void atom(std::string_view line, bool is_hetero) {
    if (!is_open_) begin_model("");
    if (!is_wanted()) return;
    RawModel &raw = file_.models.back();
    double position[3];
    read_pdb_position(line, path_, line_number_, position);

    const AtomRecord record(line);
    const bool has_fourth_letter =
        !has_chains_of_two_letters_ && !is_blank(record.column(18)) && !is_blank(record.column(21));
    const size_t chain_column = has_fourth_letter ? 22 : 21;
    const std::string residue = record.word(18, chain_column - 1);
    gemmi::Atom atom;
    atom.name = record.word(13, 16);
    atom.altloc = record.column(17) == ' ' ? '\0' : record.column(17);
    atom.pos = gemmi::Position(position[0], position[1], position[2]);
    atom.occ = static_cast<float>(record.number(55, 60, 1));
    atom.b_iso = static_cast<float>(record.number(61, 66, 0));
    atom.element = element_of(record, residue);
    const gemmi::SeqId number = record.residue_number();
    const bool begins_residue = !number.num && begins_residue_without_number(record, atom);
    const std::string chain_name = record.word(chain_column, 22);
    gemmi::Residue &last =
        add_atom(raw, path_, {chain_name, residue, number, is_hetero, begins_residue}, std::move(atom));

    if (raw.model.chains.size() != chain_count_) {
      chain_count_ = raw.model.chains.size();
      polymer_end_ = 0;
      has_ended_ = ended_chains_.count(chain_name) != 0;
    }
    if (has_ended_ && is_hetero && last.atoms.size() == 1)
      last.entity_type = last.is_water() ? gemmi::EntityType::Water : gemmi::EntityType::NonPolymer;
  }

  // What is no number tells residues apart as it is; of many with the same **** a name that comes again does.
  bool begins_residue_without_number(const AtomRecord &record, const gemmi::Atom &atom) {
    const bool is_overflow = record.column(23) == '*';
    const bool is_repeated = is_overflow && atom.altloc == '\0' && names_in_residue_.count(atom.name) != 0;
    const bool begins = record.place() != place_ || is_repeated;
    place_ = record.place();
    if (begins) names_in_residue_.clear();
    if (is_overflow && atom.altloc == '\0') names_in_residue_.insert(atom.name);
    return begins;
  }

  // TER ends a polymer; HETATM records behind it are apart. ATOM records may be another polymer: Amber writes TER
  // behind every molecule, and no chains.
  void end_polymer() {
    if (chain_count_ == 0) return;
    gemmi::Chain &chain = file_.models.back().model.chains.back();
    const auto begin =
        std::find_if(chain.residues.begin() + static_cast<std::ptrdiff_t>(polymer_end_), chain.residues.end(),
                     [](const gemmi::Residue &residue) { return residue.entity_type == gemmi::EntityType::Unknown; });
    std::for_each(begin, chain.residues.end(),
                  [](gemmi::Residue &residue) { residue.entity_type = gemmi::EntityType::Polymer; });
    polymer_end_ = chain.residues.size();
    has_ended_ = true;
    ended_chains_.insert(chain.name);
  }

  gemmi::El element_of(const AtomRecord &record, const std::string &residue) {
    const std::string given = record.word(77, 78);
    gemmi::El element = parse_element(given);
    if (element != gemmi::El::X || given == "X") return element;
    element = infer_element(residue, record.columns(13, 16));
    if (element != gemmi::El::X) ++file_.inferred_elements;
    return element;
  }

  const std::string &path_;
  const int wanted_;
  RawFile file_;
  size_t line_number_ = 0;
  bool is_open_ = false;  // a model
  bool has_chains_of_two_letters_ = false;
  // Of the model: its chains so far, those that a TER ended, and of the last one whether it is one of them, and how
  // many of its residues are before the last TER.
  size_t chain_count_ = 0;
  std::unordered_set<std::string> ended_chains_;
  bool has_ended_ = false;
  size_t polymer_end_ = 0;
  // Of the last residue without a number: what there is instead, and the names of its atoms.
  std::string place_;
  std::unordered_set<std::string> names_in_residue_;
};

}  // namespace

RawFile read_pdb_text(const std::string &text, const std::string &path, int model) {
  return Reader(path, model).run(text);
}

}  // namespace quickses::io
