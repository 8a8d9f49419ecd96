// SPDX-License-Identifier: MIT
// Biological assemblies of PDB and mmCIF files.
#include "io/assembly.h"

#include <cstdio>
#include <map>
#include <vector>

#include "io/io_fixture.h"
#include "io/structure.h"

namespace quickses::io {
namespace {

using Names = std::vector<std::string>;

std::string pdb_atom(const char *name, char altloc, const char *residue, char chain, int number, double x, double y,
                     double occupancy = 1) {
  char line[96];
  std::snprintf(line, sizeof line, "ATOM      1 %-4s%c%3s %c%4d    %8.3f%8.3f%8.3f%6.2f%6.2f           C\n", name,
                altloc, residue, chain, number, x, y, 0.0, occupancy, 0.0);
  return line;
}

// Assembly 1: chain A, and a copy of it turned by half a turn around z; chain B as it is. Assembly 2: chain B alone.
const char kRemark[] =
    "REMARK 350 BIOMOLECULE: 1\n"
    "REMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n"
    "REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000\n"
    "REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000\n"
    "REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000\n"
    "REMARK 350   BIOMT1   2 -1.000000  0.000000  0.000000        0.00000\n"
    "REMARK 350   BIOMT2   2  0.000000 -1.000000  0.000000        0.00000\n"
    "REMARK 350   BIOMT3   2  0.000000  0.000000  1.000000        7.00000\n"
    "REMARK 350 APPLY THE FOLLOWING TO CHAINS: B\n"
    "REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000\n"
    "REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000\n"
    "REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000\n"
    "REMARK 350 BIOMOLECULE: 2\n"
    "REMARK 350 APPLY THE FOLLOWING TO CHAINS: B\n"
    "REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000\n"
    "REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000\n"
    "REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000\n";

std::string pdb_file() {
  return kRemark + pdb_atom(" CA ", ' ', "ALA", 'A', 1, 1, 2) + pdb_atom(" CB ", ' ', "ALA", 'B', 1, 5, 5) +
         pdb_atom(" CA ", ' ', "GLY", 'A', 2, 3, 4) + "END\n";
}

Structure parse(const std::string &text, const ReadOptions &options, StructureFormat format = StructureFormat::kPdb) {
  return parse_structure(text, format, options).models.at(0);
}

ReadOptions assembly_named(const std::string &name) {
  ReadOptions options;
  options.assembly = name;
  return options;
}

Names chains_of(const Structure &structure) {
  Names chains;
  for (const AtomInfo &atom : structure.atoms) chains.push_back(atom.chain);
  return chains;
}

TEST(Assembly, OfPdbFiles) {
  const Structure structure = parse(pdb_file(), assembly_named("1"));
  EXPECT_EQ(chains_of(structure), (Names{"A", "A", "A2", "A2", "B"}));
  EXPECT_EQ(structure.positions, (std::vector<float>{1, 2, 0, 3, 4, 0, -1, -2, 7, -3, -4, 7, 5, 5, 0}));
  EXPECT_EQ(structure.file_atom_count, 5u);
  EXPECT_EQ(structure.file_elements, std::vector<uint8_t>(5, 6));
  for (uint32_t i = 0; i < 5; ++i) EXPECT_EQ(structure.atoms[i].file_index, i);
  EXPECT_EQ(parse(pdb_file(), assembly_named("2")).positions, (std::vector<float>{5, 5, 0}));
  EXPECT_EQ(parse(pdb_file(), ReadOptions()).atoms.size(), 3u);
}

TEST(Assembly, SelectionsLookAtTheCopies) {
  ReadOptions options = assembly_named("1");
  options.selection = "chain A2 and name CA";
  const Structure structure = parse(pdb_file(), options);
  EXPECT_EQ(structure.positions, (std::vector<float>{-1, -2, 7, -3, -4, 7}));
  EXPECT_EQ(structure.atoms[0].file_index, 2u);
}

// PDB files have the ligands and the water of all chains behind the last one: in copies they are beside their chain.
TEST(Assembly, LigandsBehindOtherChains) {
  std::string text = pdb_file();
  std::string ligand = pdb_atom(" C1 ", ' ', "LIG", 'A', 9, 9, 9);
  ligand.replace(0, 6, "HETATM");
  text.insert(text.find("END"), ligand);
  const Structure structure = parse(text, assembly_named("1"));
  EXPECT_EQ(structure.positions,
            (std::vector<float>{1, 2, 0, 3, 4, 0, 9, 9, 0, -1, -2, 7, -3, -4, 7, -9, -9, 7, 5, 5, 0}));
  EXPECT_EQ(chains_of(structure), (Names{"A", "A", "A", "A2", "A2", "A2", "B"}));
}

// Also where one operation moves several chains.
TEST(Assembly, ChainsComeOneByOne) {
  std::string remark = kRemark;
  remark.replace(remark.find("CHAINS: A"), 9, "CHAINS: A, B");
  const std::string atoms = pdb_atom(" CA ", ' ', "ALA", 'A', 1, 1, 2) + pdb_atom(" CB ", ' ', "ALA", 'B', 1, 5, 5) +
                            pdb_atom(" C1 ", ' ', "LIG", 'A', 9, 9, 9);
  const Structure structure =
      parse(remark.substr(0, remark.find("REMARK 350   BIOMT1   2")) + atoms, assembly_named("1"));
  EXPECT_EQ(structure.positions, (std::vector<float>{1, 2, 0, 9, 9, 0, 5, 5, 0}));
  EXPECT_EQ(chains_of(structure), (Names{"A", "A", "B"}));
}

TEST(Assembly, OfEachModel) {
  const std::string text = kRemark + ("MODEL        1\n" + pdb_atom(" CA ", ' ', "ALA", 'A', 1, 1, 2)) +
                           "ENDMDL\nMODEL        2\n" + pdb_atom(" CA ", ' ', "ALA", 'A', 1, 8, 9) + "ENDMDL\n";
  ReadOptions options = assembly_named("1");
  options.model = 0;
  const StructureFile file = parse_structure(text, StructureFormat::kPdb, options);
  ASSERT_EQ(file.models.size(), 2u);
  EXPECT_EQ(file.models[0].positions, (std::vector<float>{1, 2, 0, -1, -2, 7}));
  EXPECT_EQ(file.models[1].positions, (std::vector<float>{8, 9, 0, -8, -9, 7}));
}

TEST(Assembly, AtomsOnAnAxisAreThereOnce) {
  std::string remark = kRemark;
  remark.replace(remark.find("7.00000"), 7, "0.00000");
  const Structure structure =
      parse(remark + pdb_atom(" CA ", ' ', "ALA", 'A', 1, 0.05, 0) + pdb_atom(" CB ", ' ', "ALA", 'A', 1, 2, 0),
            assembly_named("1"));
  EXPECT_EQ(structure.positions, (std::vector<float>{0.05f, 0, 0, 2, 0, 0, -2, 0, 0}));
  EXPECT_EQ(structure.file_atom_count, 3u);
}

TEST(Assembly, AtomsBesideAnAxisAreThereTwice) {
  std::string remark = kRemark;
  remark.replace(remark.find("7.00000"), 7, "0.00000");
  const Structure structure = parse(remark + pdb_atom(" CA ", ' ', "ALA", 'A', 1, 0.05, 0.11), assembly_named("1"));
  EXPECT_EQ(structure.positions, (std::vector<float>{0.05f, 0.11f, 0, -0.05f, -0.11f, 0}));
}

// Only copies of the same atom are one.
TEST(Assembly, DifferentAtomsAtOnePlaceStay) {
  const Structure structure =
      parse(kRemark + pdb_atom(" CA ", ' ', "ALA", 'B', 1, 1, 2) + pdb_atom(" CB ", ' ', "ALA", 'B', 1, 1.05, 2),
            assembly_named("2"));
  EXPECT_EQ(structure.positions, (std::vector<float>{1, 2, 0, 1.05f, 2, 0}));
}

// Wherever they are, the first of two stays; what was left out leaves out no other.
TEST(Assembly, OfCopiesAtOnePlaceTheFirstStays) {
  struct Shift {
    double x, y;
  };
  const auto kept = [](const std::vector<Shift> &shifts, const std::vector<size_t> &expected) {
    std::string remark = "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n";
    for (size_t k = 0; k < shifts.size(); ++k)
      for (int row = 1; row <= 3; ++row) {
        char line[96];
        std::snprintf(line, sizeof line, "REMARK 350   BIOMT%d%4d%10.6f%10.6f%10.6f%15.5f\n", row,
                      static_cast<int>(k) + 1, row == 1 ? 1. : 0., row == 2 ? 1. : 0., row == 3 ? 1. : 0.,
                      row == 1   ? shifts[k].x
                      : row == 2 ? shifts[k].y
                                 : 0.);
        remark += line;
      }
    const Structure structure = parse(remark + pdb_atom(" CA ", ' ', "ALA", 'A', 1, 0, 0), assembly_named("1"));
    std::vector<float> places;
    for (const size_t k : expected)
      places.insert(places.end(), {static_cast<float>(shifts[k].x), static_cast<float>(shifts[k].y), 0});
    EXPECT_EQ(structure.positions, places);
  };
  kept({{0, 0}, {0.15, 0}}, {0});
  kept({{0, 0}, {-0.15, 0}}, {0});
  kept({{0, 0}, {0.25, 0}}, {0, 1});
  kept({{0, 0}, {0, 0.25}}, {0, 1});
  kept({{0, 0}, {5, 0}, {0.1, 0}}, {0, 1});
  kept({{0, 0}, {0.15, 0}, {0.3, 0}}, {0, 2});
  kept({{0, 0}, {0.15, 0.05}, {0.05, 0.2}}, {0, 2});
  kept({{0.1, -0.15}, {0, 0}, {0.12, 0.15}}, {0, 2});
}

// Pairs of them would not fit into memory.
TEST(Assembly, ManyCopiesAtOnePlaceAreOne) {
  std::string remark = "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n";
  for (int k = 1; k <= 9999; ++k)
    for (int row = 1; row <= 3; ++row) {
      char line[96];
      std::snprintf(line, sizeof line, "REMARK 350   BIOMT%d%4d%10.6f%10.6f%10.6f%15.5f\n", row, k, row == 1 ? 1. : 0.,
                    row == 2 ? 1. : 0., row == 3 ? 1. : 0., 0.);
      remark += line;
    }
  const Structure structure = parse(remark + pdb_atom(" CA ", ' ', "ALA", 'A', 1, 1, 2), assembly_named("1"));
  EXPECT_EQ(structure.positions, (std::vector<float>{1, 2, 0}));
  EXPECT_EQ(chains_of(structure), Names{"A"});
}

// ---- mmCIF

std::string cif_file(const std::string &expression) {
  std::string text =
      "data_a\nloop_\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n_atom_site.label_comp_id\n"
      "_atom_site.label_asym_id\n_atom_site.auth_asym_id\n_atom_site.label_seq_id\n_atom_site.Cartn_x\n"
      "_atom_site.Cartn_y\n_atom_site.Cartn_z\n"
      "1 C CA ALA A X 1 1 2 3\n2 ZN ZN ZN B X . 0 0 5\n"
      "loop_\n_pdbx_struct_assembly_gen.assembly_id\n_pdbx_struct_assembly_gen.oper_expression\n"
      "_pdbx_struct_assembly_gen.asym_id_list\n";
  text += "1 '" + expression + "' A\nPAU P A,B\n";
  text += "loop_\n_pdbx_struct_oper_list.id\n";
  for (int i = 1; i <= 3; ++i) {
    for (int j = 1; j <= 3; ++j) {
      char tag[64];
      std::snprintf(tag, sizeof tag, "_pdbx_struct_oper_list.matrix[%d][%d]\n", i, j);
      text += tag;
    }
    text += "_pdbx_struct_oper_list.vector[" + std::to_string(i) + "]\n";
  }
  // The identity; shifts by 10 along x, and by 20; a quarter turn around z.
  return text +
         "1 1 0 0 0 0 1 0 0 0 0 1 0\n2 1 0 0 10 0 1 0 0 0 0 1 0\n3 1 0 0 20 0 1 0 0 0 0 1 0\nP 0 -1 0 0 1 0 0 0 0 0 1 "
         "0\n";
}

TEST(Assembly, OfMmcifFiles) {
  const auto positions = [](const std::string &expression) {
    return parse(cif_file(expression), assembly_named("1"), StructureFormat::kMmcif).positions;
  };
  using Positions = std::vector<float>;
  EXPECT_EQ(positions("1"), (Positions{1, 2, 3}));
  EXPECT_EQ(positions("1,3"), (Positions{1, 2, 3, 21, 2, 3}));
  EXPECT_EQ(positions("(1-3)"), (Positions{1, 2, 3, 11, 2, 3, 21, 2, 3}));
  EXPECT_EQ(positions("(3-3)"), (Positions{21, 2, 3}));
  EXPECT_EQ(positions("(1-2,P)"), (Positions{1, 2, 3, 11, 2, 3, -2, 1, 3}));
  // Of products the right one is applied first: (2)(P) turns, then shifts; (P)(2) shifts, then turns.
  EXPECT_EQ(positions("(2)(P)"), (Positions{8, 1, 3}));
  EXPECT_EQ(positions("(P)(2)"), (Positions{-2, 11, 3}));
  EXPECT_EQ(positions("(1,2)(1,3)"), (Positions{1, 2, 3, 21, 2, 3, 11, 2, 3, 31, 2, 3}));
  EXPECT_EQ(positions("( 1 , 3 )"), (Positions{1, 2, 3, 21, 2, 3}));
  EXPECT_EQ(chains_of(parse(cif_file("1,P"), assembly_named("1"), StructureFormat::kMmcif)), (Names{"X", "X2"}));
  const Structure structure = parse(cif_file("1"), assembly_named("PAU"), StructureFormat::kMmcif);
  EXPECT_EQ(structure.positions, (Positions{-2, 1, 3, 0, 0, 5}));
  EXPECT_EQ(chains_of(structure), (Names{"X", "X"}));
  std::string spaces = cif_file("1");
  spaces.replace(spaces.find("P A,B"), 5, "P ' A , B '");
  EXPECT_EQ(parse(spaces, assembly_named("PAU"), StructureFormat::kMmcif).positions, structure.positions);
  const std::string without_atoms = "data_b\n_entry.id b\n";
  EXPECT_EQ(parse(without_atoms + cif_file("1"), assembly_named("PAU"), StructureFormat::kMmcif).positions,
            structure.positions);
}

TEST(Assembly, ACopyHasTheNameOfNoOtherChain) {
  std::string text = cif_file("1,2");
  text.replace(text.find("B X ."), 5, "B X2 .");
  text.insert(text.find("PAU P"), "1 1 B\n");
  EXPECT_EQ(chains_of(parse(text, assembly_named("1"), StructureFormat::kMmcif)), (Names{"X", "X3", "X2"}));
}

// mmCIF files list the protein and the ligands of one chain apart, in one row or in several.
TEST(Assembly, PartsOfAChainMovedAlikeAreOneChain) {
  std::string text = cif_file("1,2");
  text.insert(text.find("PAU P"), "1 1,2,3 B\n");
  const Structure structure = parse(text, assembly_named("1"), StructureFormat::kMmcif);
  EXPECT_EQ(structure.positions, (std::vector<float>{1, 2, 3, 11, 2, 3, 0, 0, 5, 10, 0, 5, 20, 0, 5}));
  EXPECT_EQ(chains_of(structure), (Names{"X", "X2", "X", "X2", "X3"}));
}

TEST(Assembly, Errors) {
  const auto usage = [](const std::string &text, const std::string &name, StructureFormat format) {
    return error_of(ErrorKind::kUsage, [&] { parse(text, assembly_named(name), format); });
  };
  EXPECT_HAS(usage(pdb_file(), "3", StructureFormat::kPdb), "no assembly '3'; there are 1 and 2");
  std::string of_two_rows = cif_file("1");
  of_two_rows.insert(of_two_rows.find("PAU P"), "1 1 B\n");
  EXPECT_HAS(usage(of_two_rows, "3", StructureFormat::kMmcif), "no assembly '3'; there are 1 and PAU");
  EXPECT_HAS(usage(pdb_atom(" CA ", ' ', "ALA", 'A', 1, 1, 2), "1", StructureFormat::kPdb), "describes none");
  EXPECT_HAS(usage("ATOM 1 CA ALA 1 0 0 0 0.5 1.5\n", "1", StructureFormat::kPqr), "only PDB and mmCIF");
  const auto input = [](const std::string &expression) {
    return error_of(ErrorKind::kInput,
                    [&] { parse(cif_file(expression), assembly_named("1"), StructureFormat::kMmcif); });
  };
  EXPECT_HAS(input("7"), "operation '7'");
  EXPECT_HAS(input("(1)(7)"), "operation '7'");
  EXPECT_HAS(input("P-3"), "operation 'P-3'");
  EXPECT_HAS(input("3-1"), "operation '3-1'");
  EXPECT_HAS(input("(1-999999999)"), "more than");
  EXPECT_HAS(input("(1,2,3)(1,2,3)(1,2,3)(1,2,3)(1,2,3)(1,2,3)(1,2,3)(1,2,3)(1,2,3)(1,2,3)(1,2,3)(1,2,3)"),
             "more than");
  // Of all rows together, before they are made.
  std::string rows = cif_file("1");
  std::string more;
  for (int k = 0; k < 500; ++k) more += "1 (1-3)(1-3)(1-3)(1-3)(1-3)(1-3)(1-3)(1-3)(1-3)(1-3) A\n";
  rows.insert(rows.find("PAU P"), more);
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { parse(rows, assembly_named("1"), StructureFormat::kMmcif); }),
             "more than 100000 operations");
  std::string three = cif_file("1");  // the third row is not even looked at
  const std::string most = "1 (1-3)(1-3)(1-3)(1-3)(1-3)(1-3)(1-3)(1-3)(1-3)(1-3) A\n";
  std::string large = cif_file("1");  // of more atoms than are taken, before any is copied
  large.insert(large.find("PAU P"), most);
  const std::string atom = "1 C CA ALA A X 1 1 2 3\n";
  std::string atoms;
  for (int k = 0; k < 1000; ++k) atoms += atom;
  large.insert(large.find(atom), atoms);
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { parse(large, assembly_named("1"), StructureFormat::kMmcif); }),
             "43770000 atoms");
  three.insert(three.find("PAU P"), most + most + "1 7 A\n");
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { parse(three, assembly_named("1"), StructureFormat::kMmcif); }),
             "more than 100000 operations");
  std::string many;
  for (int k = 0; k < 100001; ++k) many += "1,";
  EXPECT_HAS(input("(" + many + "1-999999999)"), "more than");
  input("(1");
  input("()");
  EXPECT_HAS(input(" "), "names no operation");
  EXPECT_HAS(input("?"), "names no operation");
  EXPECT_HAS(input("."), "names no operation");
  std::string unknown = cif_file("1");
  unknown.replace(unknown.find("\n2 1 0 0 10"), 11, "\n2 1 0 0 ? ");
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { parse(unknown, assembly_named("1"), StructureFormat::kMmcif); }),
             "operation '2' lacks a number");
  // Of a PDB file, too; their numbers need not be told apart.
  std::string remarks = "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n";
  for (int k = 0; k <= 100000; ++k)
    for (int row = 1; row <= 3; ++row)
      remarks += "REMARK 350   BIOMT" + std::to_string(row) + "   1  1.000000  0.000000  0.000000        0.00000\n";
  remarks += pdb_atom(" CA ", ' ', "ALA", 'A', 1, 1, 2);
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { parse(remarks, assembly_named("1")); }), "more than 100000 operations");
  std::string other = kRemark;
  other += pdb_atom(" CA ", ' ', "ALA", 'C', 1, 1, 2);
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { parse(other, assembly_named("1")); }),
             "made of chains that have no atoms");
}

// Editors and programs that wrote a file again may have left out trailing blanks, and put others or zeros between
// words.
TEST(Assembly, RemarksNeedNotHaveAllTheirColumns) {
  const std::string atoms = pdb_file().substr(sizeof kRemark - 1);
  const std::vector<float> expected = parse(kRemark + atoms, assembly_named("1")).positions;
  const auto replaced = [](std::string text, const std::string &what, const std::string &with) {
    for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
      text.replace(at, what.size(), with);
    return text;
  };
  const std::string kZero(1, '\0');
  for (const std::string &remark :
       {replaced(kRemark, "        0.00000\n", "\n"),  // no shift
        replaced(kRemark, "0.00000\n", "0.00000" + std::string(60, ' ') + "further columns\n"),
        replaced(kRemark, "\n", "\r\n"), replaced(kRemark, "  1.000000", "\t\f1.000000"),
        replaced(kRemark, " 1.000000", kZero + "1.000000"),
        "REMARK 350\n" + replaced(kRemark, "\n", "\nREMARK 350\n")}) {
    EXPECT_EQ(parse(remark + atoms, assembly_named("1")).positions, expected) << remark;
    EXPECT_EQ(parse(remark + atoms, assembly_named("2")).positions, (std::vector<float>{5, 5, 0})) << remark;
  }
}

// Up to the last column, and whatever blanks are between them.
TEST(Assembly, ListsOfChains) {
  const std::string identity =
      "REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000\n"
      "REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000\n"
      "REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000\n";
  const std::string begin = "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: ";
  std::string atoms;
  for (const char chain : {'A', 'B', 'C'}) atoms += pdb_atom(" CA ", ' ', "ALA", chain, 1, chain - 'A', 0);
  std::string wide(38, ' ');
  wide.replace(0, 2, "A,"), wide.replace(36, 2, ",C");
  const std::string zero = std::string("A,") + '\0' + "C";
  for (const std::string &list : {std::string("A, C"), std::string("A,\tC"), std::string("A,\vC\t"), zero, wide}) {
    const Structure structure = parse(begin + list + "\n" + identity + atoms, assembly_named("1"));
    EXPECT_EQ(chains_of(structure), (Names{"A", "C"})) << list;
  }
  const Structure structure =
      parse(begin + "A\nREMARK 350                    AND CHAINS: C\n" + identity + atoms, assembly_named("1"));
  EXPECT_EQ(chains_of(structure), (Names{"A", "C"}));
}

// What they are called may not steer a terminal that shows the error.
TEST(Assembly, NamesInErrorsArePlain) {
  std::string remark = kRemark;
  remark.replace(remark.find("MOLECULE: 2"), 11, "MOLECULE: \x1b[31m\xc3\xa9");
  const std::string message = error_of(
      ErrorKind::kUsage, [&] { parse(remark + pdb_atom(" CA ", ' ', "ALA", 'A', 1, 1, 2), assembly_named("3")); });
  EXPECT_HAS(message, "there are 1 and ?[31m??");
}

// No more than that, but so many: as one list, or as a product of lists.
TEST(Assembly, MayHaveAsManyOperationsAsItSays) {
  std::string list;
  for (int k = 1; k < 100000; ++k) list += "1,";
  std::string product;
  for (int k = 0; k < 5; ++k) product += "(1,1,1,1,1,1,1,1,1,1)";
  for (const std::string &expression : {list + "1", product})
    EXPECT_EQ(parse(cif_file(expression), assembly_named("1"), StructureFormat::kMmcif).positions,
              (std::vector<float>{1, 2, 3}));
}

// Damaged remarks give an answer or an error.
TEST(Assembly, DamagedRemarks) {
  const std::string atoms = pdb_atom(" CA ", ' ', "ALA", 'A', 1, 1, 2);
  unsigned random = 1;
  for (int k = 0; k < 3000; ++k) {
    std::string remark = kRemark;
    for (int n = 0; n < 3; ++n) {
      random = random * 1664525 + 1013904223;
      remark[(random >> 8) % remark.size()] = static_cast<char>(random >> 24);
    }
    try {
      parse(remark + "\n" + atoms, assembly_named("1"));
    } catch (const Error &) {
    }
  }
}

}  // namespace
}  // namespace quickses::io
