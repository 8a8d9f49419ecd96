// SPDX-License-Identifier: MIT
// PDB files as programs write them where the format has no room: many atoms and residues, long names, no chains.
#include "io/io_fixture.h"
#include "io/structure.h"
#include "io/trajectory.h"

namespace quickses::io {
namespace {

StructureFile parse(const std::string &text, const ReadOptions &options = ReadOptions()) {
  return parse_structure(text, StructureFormat::kPdb, options, "test.pdb");
}

// "chain/number+code/name" of each atom's residue.
std::vector<std::string> residues_in(const std::string &text) {
  std::vector<std::string> residues;
  const StructureFile file = parse(text);
  for (const AtomInfo &atom : file.models.at(0).atoms)
    residues.push_back(atom.chain + "/" + std::to_string(atom.residue_number) +
                       (atom.insertion_code == ' ' ? "" : std::string(1, atom.insertion_code)) + "/" +
                       atom.residue_name);
  return residues;
}

using Words = std::vector<std::string>;

// ---- serial numbers

// https://www.cgl.ucsf.edu/chimera/docs/UsersGuide/tutorials/pdbintro.html: columns 6 to 11 of ATOM records.
const char kManyAtoms[] =
    "ATOM  99999  N   ALA A   9       1.000   0.000   0.000  1.00  0.00           N\n"
    "ATOM 100000  CA  ALA A   9       2.000   0.000   0.000  1.00  0.00           C\n"
    "ATOM1000000  C   ALA A   9       3.000   0.000   0.000  1.00  0.00           C\n"
    "HETATM99999  C1  LIG A  10       4.000   0.000   0.000  1.00  0.00           C\n"
    "HETATM100000 C2  LIG A  10       5.000   0.000   0.000  1.00  0.00           C\n"
    "ATOM  186a0  O   HOH A  11       6.000   0.000   0.000  1.00  0.00           O\n"
    "ATOM  A0000  O   HOH A  12       7.000   0.000   0.000  1.00  0.00           O\n"
    "ATOM  *****  O   HOH A  13       8.000   0.000   0.000  1.00  0.00           O\n"
    "ATOMS of other programs are none\n";

TEST(PdbSerialNumbers, OfAnyLengthAreThoseOfAtoms) {
  const Structure structure = parse(kManyAtoms).models.at(0);
  ASSERT_EQ(structure.atoms.size(), 8u);
  for (size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(structure.positions[3 * i], static_cast<float>(i + 1));
    EXPECT_EQ(structure.atoms[i].file_index, i);
    EXPECT_EQ(structure.atoms[i].hetero, i == 3 || i == 4) << i;
  }
  EXPECT_EQ(structure.atoms[1].name, "CA");
  EXPECT_EQ(structure.atoms[4].name, "C2");
}

TEST(PdbSerialNumbers, OfAnyLengthAreThoseOfAtomsInTrajectories) {
  const std::string frame = std::string(kManyAtoms) + "END\n";
  const Trajectory trajectory = Trajectory::from_memory(frame + frame, TrajectoryFormat::kPdb, "test.pdb");
  ASSERT_EQ(trajectory.atom_count(), 8u);
  EXPECT_EQ(trajectory.frame_count(), 2u);
}

TEST(PdbSerialNumbers, AFileMayBeginWithALongOne) {
  const std::string atom = "ATOM 100000  CA  ALA A   9       2.000   0.000   0.000  1.00  0.00           C\n";
  EXPECT_EQ(parse_structure(atom, std::nullopt).models.at(0).atoms.size(), 1u);
}

// ---- residue numbers

TEST(PdbResidueNumbers, OfMoreThanFourDigits) {
  EXPECT_EQ(residues_in("ATOM      1  CA  ALA A9999       1.000   0.000   0.000  1.00  0.00           C\n"
                        "ATOM      2  CA  ALA A10000      2.000   0.000   0.000  1.00  0.00           C\n"
                        "ATOM      3  CA  ALA A123456     3.000   0.000   0.000  1.00  0.00           C\n"
                        "ATOM      4  CA  ALA A1000A      4.000   0.000   0.000  1.00  0.00           C\n"
                        "ATOM      5  CA  ALA A  52A      5.000   0.000   0.000  1.00  0.00           C\n"
                        "ATOM      6  CA  ALA A -12       6.000   0.000   0.000  1.00  0.00           C\n"
                        "ATOM      7  CA  ALA AA000       7.000   0.000   0.000  1.00  0.00           C\n"
                        "ATOM      8  CA  ALA AA00Z       8.000   0.000   0.000  1.00  0.00           C\n"),
            (Words{"A/9999/ALA", "A/10000/ALA", "A/123456/ALA", "A/1000A/ALA", "A/52A/ALA", "A/-12/ALA", "A/10000/ALA",
                   "A/10035/ALA"}));
}

// A water of three atoms behind each other, with that in columns 23 to 26.
std::string water_at(const std::string &number) {
  std::string text;
  for (const char *name : {"OH2", "H1 ", "H2 "})
    text += "ATOM      1  " + std::string(name) + " TIP3W" + number +
            "       1.000   0.000   0.000  1.00  0.00      WT1   " + name[0] + "\n";
  return text;
}

TEST(PdbResidueNumbers, InBaseSixteenAsVmdWritesThem) {
  const auto number = [](const std::string &columns) {
    const AtomInfo atom = parse(water_at(columns)).models.at(0).atoms.at(0);
    return atom.has_residue_number() ? std::to_string(atom.residue_number) : "none";
  };
  EXPECT_EQ(number("271a"), "10010");
  EXPECT_EQ(number("2a00"), "10752");
  EXPECT_EQ(number("9fff"), "40959");
  EXPECT_EQ(number("a000"), "40960");
  EXPECT_EQ(number("ffff"), "65535");
  EXPECT_EQ(number("ZZZZ"), "1223055");  // hybrid-36
  EXPECT_EQ(number("a00z"), "1223091");
  EXPECT_EQ(number("zzzz"), "2436111");
  EXPECT_EQ(number("  -7"), "-7");
  for (const char *none : {"****", "2A00", "2g00", "Aa00", "    ", "  1x", " 2a0", "1-2 "})
    EXPECT_EQ(number(none), "none") << none;
}

TEST(PdbResidueNumbers, ThatAreNoneDoNotMergeResidues) {
  const auto residues = [](const std::string &text, const ReadOptions &options = ReadOptions()) {
    return residues_of(parse(text, options).models.at(0));
  };
  using Residues = std::vector<uint32_t>;
  EXPECT_EQ(residues(water_at("2a00") + water_at("2a01")), (Residues{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(residues(water_at("****") + water_at("****")), (Residues{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(residues(water_at("2g00") + water_at("2g01")), (Residues{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(residues(water_at("   0") + water_at("****")), (Residues{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(residues(water_at("    ") + water_at("    ")), Residues(6));  // nothing tells
  ReadOptions hydrogens;
  hydrogens.selection = "name H2";  // what told them apart is left out
  EXPECT_EQ(residues(water_at("****") + water_at("****"), hydrogens), (Residues{0, 1}));
  std::string alternatives = water_at("****");
  alternatives[16] = 'A';
  EXPECT_EQ(residues(alternatives + alternatives.substr(0, 81).replace(16, 1, "B")), (Residues{0, 0, 0}));
}

// Atoms of the residue before, which has another name, do not count as those of this one.
TEST(PdbResidueNumbers, ThatAreNoneDoNotSplitResidues) {
  std::string text;
  for (const char *atom_of : {"N   AAA", "C1  AAA", "C2  AAA", "C3  BBB", "C1  BBB", "C4  BBB"})
    text += "ATOM      1  " + std::string(atom_of) + " A****       1.000   0.000   0.000  1.00  0.00           C\n";
  EXPECT_EQ(residues_of(parse(text).models.at(0)), (std::vector<uint32_t>{0, 0, 0, 1, 1, 1}));
}

// ---- residue names of four letters, chains of two

TEST(PdbResidueNames, MayHaveFourLetters) {
  EXPECT_EQ(residues_in("ATOM      1  CA  GLY C   1       1.000   0.000   0.000  1.00  0.00      PROC\n"
                        "ATOM      2  CA  NALAA   2       2.000   0.000   0.000  1.00  0.00      PROC\n"
                        "ATOM      3  P   POPC    1       3.000   0.000   0.000  1.00  0.00      MEMB\n"
                        "ATOM      4  OH2 TIP3W4687       4.000   0.000   0.000  1.00  0.00      WT1 \n"
                        "ATOM      5  OH2 TIP3W10000      5.000   0.000   0.000  1.00  0.00      WT1 \n"
                        "ATOM      6 SOD  SOD I   1       6.000   0.000   0.000  1.00  0.00      ION \n"),
            (Words{"C/1/GLY", "A/2/NALA", "/1/POPC", "W/4687/TIP3", "W/10000/TIP3", "I/1/SOD"}));
}

TEST(PdbResidueNames, OfFourLettersTellElements) {
  const Structure structure = parse(
                                  "ATOM      1 HD11 NLEU    1       1.000   0.000   0.000\n"
                                  "ATOM      2  CA  NALA    2       2.000   0.000   0.000\n"
                                  "ATOM      3  OH2 TIP3W   3       3.000   0.000   0.000\n"
                                  "ATOM      4 CA   CGLY    4       4.000   0.000   0.000\n")
                                  .models.at(0);
  EXPECT_EQ(structure.atoms[0].element, 1);
  EXPECT_EQ(structure.atoms[1].element, 6);
  EXPECT_EQ(structure.atoms[2].element, 8);
  EXPECT_EQ(structure.atoms[3].element, 6);  // of glycine at the end of a chain, in the columns of calcium
  EXPECT_TRUE(structure.atoms[2].is_water());
  EXPECT_EQ(structure.atoms[1].kind, ResidueKind::kProtein);
}

// As gemmi and Phenix write them.
TEST(PdbChains, OfTwoLettersAreToldByResiduesOfThePdb) {
  EXPECT_EQ(residues_in("ATOM      1  P     AAA   1       1.000   0.000   0.000  1.00  0.00           P\n"
                        "ATOM      2  P    DAAB   2       2.000   0.000   0.000  1.00  0.00           P\n"
                        "ATOM      3  CA  ALAAC   3       3.000   0.000   0.000  1.00  0.00           C\n"
                        "HETATM    4  P   POPAD   4       4.000   0.000   0.000  1.00  0.00           P\n"
                        "ATOM      5  CA  ALA A   5       5.000   0.000   0.000  1.00  0.00           C\n"),
            (Words{"AA/1/A", "AB/2/DA", "AC/3/ALA", "AD/4/POP", "A/5/ALA"}));
}

std::string residue_at(const std::string &columns) {  // 18 to 22
  return "ATOM      1  CA  " + columns + "   1       1.000   0.000   0.000  1.00  0.00           C\n";
}

TEST(PdbChains, OfTwoLettersAreNotToldByOneNameThatBeginsAsAnAminoAcid) {
  // CHARMM's cysteine with palmitoyl and glycine with myristoyl, ends of chains of Amber.
  for (const char *name : {"CYSP", "CYSF", "GLYM", "ALAD", "NALA", "CHIE", "HISD"})
    EXPECT_EQ(residues_in(residue_at(std::string(name) + "A") + residue_at("ALA A") + residue_at("POPCM") +
                          residue_at("POPEM")),
              (Words{"A/1/" + std::string(name), "A/1/ALA", "M/1/POPC", "M/1/POPE"}));
  EXPECT_EQ(residues_in(residue_at("CYSPA") + residue_at("SERPA") + residue_at("THRPA") + residue_at("TIP3W")),
            (Words{"A/1/CYSP", "A/1/SERP", "A/1/THRP", "W/1/TIP3"}));
  // One-letter chains and a ligand beside them.
  EXPECT_EQ(residues_in(residue_at("ALA P") + residue_at("ALAAP") + residue_at("GLYAP") + residue_at("SERAP") +
                        residue_at("CYSPA") + residue_at("HEMAP")),
            (Words{"P/1/ALA", "AP/1/ALA", "AP/1/GLY", "AP/1/SER", "PA/1/CYS", "AP/1/HEM"}));
}

// ---- TER

std::string kinds_in(const std::string &text, int model = 1) {
  std::string kinds;
  ReadOptions options;
  options.model = model;
  const StructureFile file = parse(text, options);
  for (const AtomInfo &atom : file.models.at(0).atoms) {
    const char letter = "LPNWI"[static_cast<int>(atom.kind)];
    kinds += letter;
  }
  return kinds;
}

std::string atom(const std::string &record, const std::string &name, const std::string &residue, char chain,
                 int number) {
  char line[82];
  std::snprintf(line, sizeof line, "%-6s%5d  %-3s %3s %c%4d    %8.3f%8.3f%8.3f  1.00  0.00           %c\n",
                record.c_str(), number, name.c_str(), residue.c_str(), chain, number, number * 5.0, 0.0, 0.0, name[0]);
  return line;
}

TEST(PdbTer, BehindEveryMoleculeAsAmberWritesIt) {
  for (const char chain : {' ', 'A'}) {
    const auto one = [&](const char *name, const char *residue, int number) {
      return atom("ATOM", name, residue, chain, number);
    };
    EXPECT_EQ(kinds_in(one("CA", "ALA", 1) + "TER\n" + one("CA", "CYX", 2) + one("CA", "GLY", 3) + "TER\n" +
                       one("P", "DA5", 4) + one("P", "DA3", 5) + "TER\n" + one("C1", "LIG", 6) + "TER\n" +
                       one("O", "WAT", 7) + "TER\n" + one("O", "WAT", 8) + "TER\nEND\n"),
              "PPPNNLWW");
    EXPECT_EQ(kinds_in(one("CA", "ALA", 1) + "TER\n" + one("CA", "ALA", 2)), "PP");  // nothing ends the second one
  }
}

TEST(PdbTer, WhatIsBehindItInHetatmRecordsIsApart) {
  const std::string chain = atom("ATOM", "CA", "ALA", 'A', 1) + "TER\n";
  const std::string ligand = atom("HETATM", "CA", "GLY", 'A', 2);
  EXPECT_EQ(kinds_in(chain + ligand), "PL");
  EXPECT_EQ(kinds_in(chain + ligand + "TER\n"), "PL");
  EXPECT_EQ(kinds_in(chain + atom("ATOM", "CA", "ALA", 'B', 3) + "TER\n" + ligand), "PPL");
  // A modified amino acid in a second chain is not; a ligand before that chain is.
  EXPECT_EQ(kinds_in(chain + ligand + atom("ATOM", "CA", "ALA", 'A', 3) + atom("HETATM", "CA", "MSE", 'A', 4) +
                     atom("ATOM", "CA", "ALA", 'A', 5) + "TER\n"),
            "PLPPP");
}

TEST(PdbTer, CountsInItsModelOnly) {
  const std::string peptide = atom("HETATM", "CA", "MSE", 'A', 1) + atom("ATOM", "CA", "ALA", 'A', 2) +
                              atom("HETATM", "CA", "MSE", 'A', 3) + "TER\n" + atom("HETATM", "CA", "GLY", 'A', 4);
  const std::string text = "MODEL        1\n" + peptide + "ENDMDL\nMODEL        2\n" + peptide + "ENDMDL\n";
  ReadOptions all;
  all.model = 0;
  const StructureFile file = parse(text, all);
  ASSERT_EQ(file.models.size(), 2u);
  for (const Structure &model : file.models)
    for (size_t i = 0; i < 4; ++i)
      EXPECT_EQ(model.atoms.at(i).kind, i < 3 ? ResidueKind::kProtein : ResidueKind::kLigand)
          << "model " << model.model << ", atom " << i;
  EXPECT_EQ(kinds_in(text, 1), "PPPL");
  EXPECT_EQ(kinds_in(text, 2), "PPPL");
}

}  // namespace
}  // namespace quickses::io
