// SPDX-License-Identifier: MIT
#include "io/assembly.h"

#include <algorithm>
#include <array>
#include <gemmi/assembly.hpp>
#include <gemmi/cif.hpp>
#include <gemmi/numb.hpp>
#include <gemmi/pdb.hpp>
#include <map>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "io/error.h"
#include "io/limits.h"
#include "io/text.h"

namespace quickses::io {
namespace {

namespace cif = gemmi::cif;
using Operators = std::vector<gemmi::Assembly::Operator>;

constexpr size_t kMostOperators = 100'000;  // viruses have 60 per chain
constexpr double kSamePlace = 0.2;          // Å

[[noreturn]] void fail_unknown(const std::string &path, const std::string &name,
                               const std::vector<std::string> &names) {
  fail_usage("'" + path + "' has no assembly '" + excerpt_of(name) + "'; " +
             (names.empty() ? "it describes none"
                            : "there " + std::string(names.size() == 1 ? "is " : "are ") + list_of(names)));
}

[[noreturn]] void fail_large(const std::string &path, const std::string &name) {
  fail_input("'" + path + "': assembly " + name + " has more than " + std::to_string(kMostOperators) +
             " operations or " + std::to_string(kMostAtoms) + " atoms");
}

// ---- mmCIF: gemmi reads these tables too, but leaves out products of operations, such as (1-60)(61-88) of viruses

// "1,3,5-8"
std::vector<std::string> read_identifiers(const std::string &text, const std::string &path, const std::string &name) {
  std::vector<std::string> identifiers;
  for (const std::string &part : split(text, ',')) {
    const size_t dash = part.find('-');
    int first = 0, last = 0;
    const bool is_range = dash != std::string::npos && parse_integer(part.substr(0, dash), first) &&
                          parse_integer(part.substr(dash + 1), last) && first <= last;
    const auto add = [&](std::string identifier) {
      if (identifiers.size() >= kMostOperators) fail_large(path, name);
      identifiers.push_back(std::move(identifier));
    };
    if (!is_range) add(std::string(trim(part)));
    for (int64_t number = first; is_range && number <= last; ++number) add(std::to_string(number));
  }
  return identifiers;
}

// "1,2" or "(1-3)" or "(X0)(1-60)": of several parentheses the last is applied first. Not more than most of them.
Operators read_operators(const std::string &expression, const std::map<std::string, gemmi::Transform> &known,
                         size_t most, const std::string &path, const std::string &name) {
  if (trim(expression).empty() || expression == "?" || expression == ".")
    fail_input("'" + path + "': assembly " + name + " names no operation");
  Operators product(1);
  size_t at = 0;
  while (at < expression.size()) {
    const bool is_group = expression[at] == '(';
    const size_t end = is_group ? expression.find(')', at) : expression.find('(', at);
    if (is_group && end == std::string::npos)
      fail_input("'" + path + "': assembly " + name + ": '" + expression + "' lacks a ')'");
    const size_t begin = at + (is_group ? 1 : 0);
    const std::string list = expression.substr(begin, end == std::string::npos ? end : end - begin);
    at = end == std::string::npos ? expression.size() : end + (is_group ? 1 : 0);
    const std::vector<std::string> identifiers = read_identifiers(list, path, name);
    if (product.size() * identifiers.size() > most) fail_large(path, name);
    Operators longer;
    for (const auto &left : product)
      for (const std::string &identifier : identifiers) {
        const auto found = known.find(identifier);
        if (found == known.end())
          fail_input("'" + path + "': assembly " + name + " asks for operation '" + identifier +
                     "', which the file does not describe");
        longer.emplace_back();
        longer.back().transform = left.transform.combine(found->second);
      }
    product = std::move(longer);
  }
  return product;
}

std::map<std::string, gemmi::Transform> read_transforms(cif::Block &block, const std::string &path) {
  std::vector<std::string> tags = {"id"};
  for (const char *row : {"1", "2", "3"}) {
    for (const char *column : {"1", "2", "3"}) tags.push_back(std::string("matrix[") + row + "][" + column + "]");
    tags.push_back(std::string("vector[") + row + "]");
  }
  std::map<std::string, gemmi::Transform> transforms;
  for (cif::Table::Row row : block.find("_pdbx_struct_oper_list.", tags)) {
    gemmi::Transform &transform = transforms[row.str(0)];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 4; ++j) {
        const double value = cif::as_number(row[static_cast<size_t>(1 + 4 * i + j)]);
        if (!std::isfinite(value)) fail_input("'" + path + "': operation '" + row.str(0) + "' lacks a number");
        (j < 3 ? transform.mat[i][j] : transform.vec.at(i)) = value;
      }
  }
  return transforms;
}

gemmi::Assembly find_in_block(cif::Block &block, const std::string &path, const std::string &name) {
  const auto transforms = read_transforms(block, path);
  gemmi::Assembly assembly(name);
  std::vector<std::string> names;
  size_t left = kMostOperators;
  for (cif::Table::Row row :
       block.find("_pdbx_struct_assembly_gen.", {"assembly_id", "oper_expression", "asym_id_list"})) {
    if (std::find(names.begin(), names.end(), row.str(0)) == names.end()) names.push_back(row.str(0));
    if (row.str(0) != name) continue;
    assembly.generators.emplace_back();
    gemmi::Assembly::Gen &generator = assembly.generators.back();
    for (const std::string &chain : split(row.str(2), ',')) generator.subchains.emplace_back(trim(chain));
    generator.operators = read_operators(row.str(1), transforms, left, path, name);
    left -= generator.operators.size();
  }
  if (assembly.generators.empty()) fail_unknown(path, name, names);
  return assembly;
}

// ---- copies

// gemmi copies residues of one chain or subchain after the other; how many atoms will that be?
uint64_t count_atoms(const gemmi::Assembly &assembly, const gemmi::Model &model) {
  uint64_t count = 0;
  for (const gemmi::Assembly::Gen &generator : assembly.generators) {
    const std::unordered_set<std::string> chains(generator.chains.begin(), generator.chains.end());
    const std::unordered_set<std::string> subchains(generator.subchains.begin(), generator.subchains.end());
    uint64_t atoms = 0;
    for (const gemmi::Chain &chain : model.chains)
      for (const gemmi::Residue &residue : chain.residues)
        if (chains.count(chain.name) != 0 || subchains.count(residue.subchain) != 0) atoms += residue.atoms.size();
    count += atoms * generator.operators.size();
  }
  return count;
}

// Names of copies: A, A2, A3. What one operation makes of a chain has one name, also where an assembly lists parts of
// the chain one by one, as mmCIF files do.
class CopyNames {
 public:
  explicit CopyNames(const gemmi::Model &model) {
    for (const gemmi::Chain &chain : model.chains) used_.insert(chain.name);
  }

  const std::string &name(const std::string &chain, const gemmi::Transform &transform) {
    std::array<double, 12> numbers;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 4; ++j)
        numbers[static_cast<size_t>(4 * i + j)] = j < 3 ? transform.mat[i][j] : transform.vec.at(i);
    const auto [copy, is_new] = names_.try_emplace({chain, numbers});
    if (is_new) copy->second = new_name(chain);
    return copy->second;
  }

 private:
  std::string new_name(const std::string &chain) {
    int &count = counts_[chain];
    std::string name = chain;
    if (++count == 1) return name;
    while (!used_.insert(name = chain + std::to_string(count)).second) ++count;
    return name;
  }

  std::unordered_set<std::string> used_;
  std::unordered_map<std::string, int> counts_;
  std::map<std::pair<std::string, std::array<double, 12>>, std::string> names_;
};

gemmi::Model make_copies(const gemmi::Assembly &assembly, const gemmi::Model &model) {
  gemmi::Model copies(model.name);
  CopyNames names(model);
  for (const gemmi::Assembly::Gen &generator : assembly.generators)
    for (const gemmi::Assembly::Operator &oper : generator.operators) {
      gemmi::Assembly one(assembly.name);
      one.generators.push_back({generator.chains, generator.subchains, {oper}});
      // No stream or logger, whichever this version of gemmi writes its progress to.
      for (gemmi::Chain &chain : gemmi::make_assembly(one, model, gemmi::HowToNameCopiedChain::Dup, {}).chains) {
        chain.name = names.name(chain.name, oper.transform);
        copies.chains.push_back(std::move(chain));
      }
    }
  return copies;
}

// Atoms with the same serial number are copies of the same one.
void leave_out_doubles(gemmi::Model &model) {
  std::vector<gemmi::Atom *> atoms;
  for (gemmi::Chain &chain : model.chains)
    for (gemmi::Residue &residue : chain.residues)
      for (gemmi::Atom &atom : residue.atoms) atoms.push_back(&atom);
  std::vector<size_t> order(atoms.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](size_t i, size_t j) {
    const gemmi::Atom &a = *atoms[i], &b = *atoms[j];
    return std::make_tuple(a.serial, a.pos.x, i) < std::make_tuple(b.serial, b.pos.x, j);
  });
  // The first of them stays, and what was left out is not compared any more.
  std::vector<uint8_t> is_left_out(atoms.size());
  for (size_t k = 0; k < order.size(); ++k)
    for (size_t other = k + 1; other < order.size() && !is_left_out[order[k]]; ++other) {
      const gemmi::Atom &a = *atoms[order[k]], &b = *atoms[order[other]];
      if (a.serial != b.serial || b.pos.x - a.pos.x > kSamePlace) break;
      if (is_left_out[order[other]] || a.pos.dist(b.pos) >= kSamePlace) continue;
      is_left_out[std::max(order[k], order[other])] = 1;
    }
  for (size_t i = 0; i < atoms.size(); ++i)
    if (is_left_out[i]) atoms[i]->serial = 0;
  for (gemmi::Chain &chain : model.chains)
    for (gemmi::Residue &residue : chain.residues) {
      const auto is_double = [](const gemmi::Atom &atom) { return atom.serial == 0; };
      residue.atoms.erase(std::remove_if(residue.atoms.begin(), residue.atoms.end(), is_double), residue.atoms.end());
    }
}

}  // namespace

gemmi::Assembly find_pdb_assembly(const std::string &text, const std::string &path, const std::string &name) {
  std::string remarks;
  std::string_view rest = text, line;
  while (next_line(rest, line)) {
    if (line.substr(0, 10) != "REMARK 350") continue;
    std::string clean(line.substr(0, 80));
    for (char &c : clean) c = c == '\0' || is_blank(c) ? ' ' : to_ascii(c);
    clean.resize(80, ' ');
    remarks += clean + "\n";
  }
  std::vector<std::string> names;
  try {
    for (const gemmi::Assembly &assembly :
         gemmi::read_pdb_from_memory(remarks.data(), remarks.size(), path).assemblies) {
      if (assembly.name == name) return assembly;
      names.push_back(assembly.name);
    }
  } catch (const std::bad_alloc &) {
    throw;
  } catch (const std::exception &error) {
    fail_input("'" + path + "', REMARK 350: " + error.what());
  }
  fail_unknown(path, name, names);
}

gemmi::Assembly find_mmcif_assembly(const std::string &text, const std::string &path, const std::string &name) {
  cif::Document document;
  try {
    document = cif::read_memory(text.data(), text.size(), path.c_str());
  } catch (const std::bad_alloc &) {
    throw;
  } catch (const std::exception &error) {
    fail_input("'" + path + "' can't be read as mmCIF: " + error.what());
  }
  for (cif::Block &block : document.blocks)
    if (block.find("_atom_site.", {"Cartn_x"}).length() != 0) return find_in_block(block, path, name);
  fail_unknown(path, name, {});
}

void build_assembly(const gemmi::Assembly &assembly, RawModel &raw, const std::string &path) {
  const uint64_t count = count_atoms(assembly, raw.model);
  size_t operators = 0;
  for (const gemmi::Assembly::Gen &generator : assembly.generators) operators += generator.operators.size();
  if (count > kMostAtoms || operators > kMostOperators) fail_large(path, assembly.name);
  if (count == 0) fail_input("'" + path + "': assembly " + assembly.name + " is made of chains that have no atoms");
  raw.model.merge_chain_parts();  // PDB files have ligands and water of a chain behind other chains
  raw.model = make_copies(assembly, raw.model);
  leave_out_doubles(raw.model);
  int serial = 0;
  for (gemmi::Chain &chain : raw.model.chains)
    for (gemmi::Residue &residue : chain.residues)
      for (gemmi::Atom &atom : residue.atoms) atom.serial = ++serial;
  raw.atom_count = static_cast<uint32_t>(serial);
}

}  // namespace quickses::io
