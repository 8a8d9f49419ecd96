// SPDX-License-Identifier: MIT
// Colours of atoms, and what is known about residues by their names.
#include "io/atom_colors.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <vector>

#include "io/io_fixture.h"
#include "io/residue_kinds.h"
#include "io/residue_table.h"
#include "io/structure.h"

namespace quickses::io {
namespace {

constexpr Rgba kUniform = {1, 2, 3, 4};

// An atom per entry: element, residue, chain, number.
struct Named {
  uint8_t element;
  const char *residue, *chain;
  int number;
};

std::vector<Rgba> colors_of(const std::vector<Named> &named, ColorScheme scheme) {
  Structure structure;
  for (const Named &from : named) {
    AtomInfo atom;
    atom.element = from.element;
    atom.name = "CA";
    atom.residue_name = from.residue;
    atom.chain = from.chain;
    atom.residue_number = from.number;
    structure.atoms.push_back(atom);
  }
  find_residue_kinds(structure);
  find_chain_places(structure);
  std::vector<Rgba> colors(named.size() + 1, Rgba{9, 9, 9, 9});
  color_atoms(structure, scheme, kUniform, colors[0].data());
  EXPECT_EQ(colors.back(), (Rgba{9, 9, 9, 9}));
  colors.pop_back();
  for (const Rgba &color : colors) EXPECT_EQ(color[3], color == kUniform ? 4 : 255);
  return colors;
}

int difference(Rgba a, Rgba b) {
  int sum = 0;
  for (int i = 0; i < 3; ++i) sum += std::abs(a[i] - b[i]);
  return sum;
}

// Table 2 of Kyte and Doolittle, 1982, from the most hydrophobic to the least.
constexpr struct {
  const char *name;
  float hydropathy;
} kKyteDoolittle[] = {{"ILE", 4.5f},  {"VAL", 4.2f},  {"LEU", 3.8f},  {"PHE", 2.8f},  {"CYS", 2.5f},
                      {"MET", 1.9f},  {"ALA", 1.8f},  {"GLY", -0.4f}, {"THR", -0.7f}, {"SER", -0.8f},
                      {"TRP", -0.9f}, {"TYR", -1.3f}, {"PRO", -1.6f}, {"HIS", -3.2f}, {"GLU", -3.5f},
                      {"GLN", -3.5f}, {"ASP", -3.5f}, {"ASN", -3.5f}, {"LYS", -3.9f}, {"ARG", -4.5f}};

TEST(ResidueTable, HydropathyIsKyteAndDoolittles) {
  for (const auto &entry : kKyteDoolittle) {
    EXPECT_TRUE(traits_of(entry.name).is_amino_acid()) << entry.name;
    EXPECT_EQ(traits_of(entry.name).hydropathy, entry.hydropathy) << entry.name;
  }
  for (const char *name : {"DA", "HOH", "HEM", "", "XYZ"}) EXPECT_FALSE(traits_of(name).is_amino_acid()) << name;
}

// As selections take it.
ResidueKind kind_of_residue(const char *name) {
  Structure structure;
  structure.atoms.resize(2);
  for (AtomInfo &atom : structure.atoms) atom.residue_name = name, atom.element = 6;
  structure.atoms[0].name = "CA";
  structure.atoms[1].name = "C1'";
  find_residue_kinds(structure);
  return structure.atoms[0].kind;
}

TEST(ResidueTable, OtherNamesOfTheSame) {
  const struct {
    const char *name;
    std::vector<const char *> others;
  } kSame[] = {
      {"CYS", {"CYX", "CYM", "CYS1", "CYS2", "CYSH", "NCYX", "SEC", "CSO", "OCS"}},
      {"ASP", {"ASH", "ASPH", "ASPP", "CASP"}},
      {"GLU", {"GLH", "GLUH", "GLUP", "NGLU", "PCA"}},
      {"HIS",
       {"HID", "HIE", "HIP", "HSD", "HSE", "HSP", "HISA", "HISB", "HISH", "HISD", "HISE", "HIS1", "HIS2", "CHID"}},
      {"LYS", {"LYN", "LSN", "LYSH", "PYL", "MLY", "M3L"}},
      {"ARG", {"ARGN", "ARN", "NARG"}},
      {"ALA", {"NALA", "CALA"}},
      {"ILE", {"ILE1"}},
      {"MET", {"MSE"}},
      {"PRO", {"HYP"}},
      {"SER", {"SEP"}},
      {"THR", {"TPO"}},
      {"TYR", {"PTR"}},
      {"A", {"DA", "RA", "A5", "A3", "DA5", "DA3", "RA5", "AN", "DAN", "ADE"}},
      {"G", {"DG", "RG", "G5", "DG3", "GUA", "I", "DI", "7MG"}},
      {"C", {"DC", "RC", "C3", "DC5", "CYT", "5CM"}},
      {"U", {"DT", "T", "RU", "U5", "DT3", "URA", "THY", "PSU", "H2U"}}};
  for (const auto &same : kSame)
    for (const char *other : same.others) {
      EXPECT_NE(traits_of(other).residue_class, ResidueClass::kOther) << other;
      EXPECT_EQ(traits_of(other).residue_class, traits_of(same.name).residue_class) << other;
      EXPECT_EQ(traits_of(other).hydropathy, traits_of(same.name).hydropathy) << other;
      const bool is_amino_acid = traits_of(other).is_amino_acid();
      EXPECT_EQ(kind_of_residue(other), is_amino_acid ? ResidueKind::kProtein : ResidueKind::kNucleic) << other;
    }
  for (const char *name : {"HOH", "HEM", "ZN", "UNK", "", "5", "DD5", "X", "D", "R"})
    EXPECT_EQ(traits_of(name).residue_class, ResidueClass::kOther) << name;
}

TEST(AtomColors, UniformIsOneColour) {
  EXPECT_EQ(colors_of({{6, "ALA", "A", 1}, {7, "GLY", "B", 2}}, ColorScheme::kUniform),
            (std::vector<Rgba>{kUniform, kUniform}));
}

TEST(AtomColors, ElementsHaveTheColoursOfJmol) {
  const std::vector<Rgba> colors = colors_of({{1, "", "", 0},
                                              {6, "", "", 0},
                                              {7, "", "", 0},
                                              {8, "", "", 0},
                                              {15, "", "", 0},
                                              {16, "", "", 0},
                                              {26, "", "", 0},
                                              {30, "", "", 0},
                                              {109, "", "", 0},
                                              {0, "", "", 0},
                                              {110, "", "", 0}},
                                             ColorScheme::kElement);
  EXPECT_EQ(colors, (std::vector<Rgba>{{255, 255, 255, 255},
                                       {144, 144, 144, 255},
                                       {48, 80, 248, 255},
                                       {255, 13, 13, 255},
                                       {255, 128, 0, 255},
                                       {255, 255, 48, 255},
                                       {224, 102, 51, 255},
                                       {125, 128, 176, 255},
                                       {235, 0, 38, 255},
                                       kUniform,
                                       kUniform}));
}

TEST(AtomColors, ChainsDiffer) {
  const char *const kChains[] = {"A", "B", "C", "D", "E", "F", "G", "H", "I", "J", "K", "L", "M", "N", "AA", "ab"};
  std::vector<Named> atoms;
  for (const char *chain : kChains) atoms.push_back({6, "ALA", chain, 1});
  atoms.push_back({6, "ALA", "A", 2});
  atoms.push_back({6, "ALA", "", 2});
  const std::vector<Rgba> colors = colors_of(atoms, ColorScheme::kChain);
  EXPECT_EQ(colors[16], colors[0]);
  EXPECT_EQ(colors[17], kUniform);
  for (size_t i = 0; i < 16; ++i)
    for (size_t k = 0; k < i; ++k) EXPECT_GT(difference(colors[i], colors[k]), 20) << i << " and " << k;
}

TEST(AtomColors, ResiduesHaveTheColourOfTheirClass) {
  const std::vector<Rgba> colors = colors_of({{6, "ASP", "A", 1},
                                              {6, "GLU", "A", 2},
                                              {6, "LYS", "A", 3},
                                              {6, "HID", "A", 4},
                                              {6, "LEU", "A", 5},
                                              {6, "SER", "A", 6},
                                              {6, "DA", "B", 1},
                                              {6, "U", "B", 2},
                                              {8, "HOH", "A", 7},
                                              {6, "HEM", "A", 8},
                                              {6, "DAN", "A", 9}},  // which has no C1', so that it is no adenosine
                                             ColorScheme::kResidue);
  EXPECT_EQ(colors[0], colors[1]);
  EXPECT_EQ(colors[2], colors[3]);
  EXPECT_GT(colors[0][0], 2 * colors[0][2]);  // red
  EXPECT_GT(colors[2][2], 2 * colors[2][0]);  // blue
  EXPECT_EQ(colors[8], kUniform);
  EXPECT_EQ(colors[9], kUniform);
  EXPECT_EQ(colors[10], kUniform);
  EXPECT_EQ(std::set<Rgba>(colors.begin(), colors.end()).size(), 7u);
}

TEST(AtomColors, HydrophobicityGoesFromBlueToRed) {
  std::vector<Named> atoms;
  for (const auto &entry : kKyteDoolittle) atoms.push_back({6, entry.name, "A", 1});
  atoms.push_back({8, "HOH", "A", 2});
  atoms.push_back({6, "DA", "A", 3});
  const std::vector<Rgba> colors = colors_of(atoms, ColorScheme::kHydrophobicity);
  const auto blue = [&](size_t i) { return colors[i][2] - colors[i][0]; };
  for (size_t i = 1; i < std::size(kKyteDoolittle); ++i) EXPECT_GE(blue(i), blue(i - 1)) << kKyteDoolittle[i].name;
  EXPECT_LT(blue(0), -200);
  EXPECT_GT(blue(19), 200);
  EXPECT_EQ(colors[20], kUniform);
  EXPECT_EQ(colors[21], kUniform);
}

TEST(AtomColors, SequenceGoesFromBlueToRedInEachChain) {
  std::vector<Named> atoms;
  for (int number = 1; number <= 5; ++number)
    for (int atom = 0; atom < 2; ++atom) atoms.push_back({6, "ALA", "A", 10 * number});
  atoms.push_back({8, "HOH", "A", 100});
  atoms.push_back({6, "DA", "B", 1});
  atoms.push_back({6, "DC", "B", 2});
  const std::vector<Rgba> colors = colors_of(atoms, ColorScheme::kSequence);
  EXPECT_GT(colors[0][2] - colors[0][0], 200);
  EXPECT_GT(colors[9][0] - colors[9][2], 200);
  EXPECT_EQ(colors[4][1], 255);  // midway
  for (size_t i = 0; i < 10; i += 2) EXPECT_EQ(colors[i], colors[i + 1]);
  EXPECT_EQ(std::set<Rgba>(colors.begin(), colors.begin() + 10).size(), 5u);
  EXPECT_EQ(colors[10], kUniform);
  EXPECT_EQ(colors[11], colors[0]);
  EXPECT_EQ(colors[12], colors[9]);
}

// A residue of which the table of classes knows nothing is one of the chain all the same.
TEST(AtomColors, SequenceCountsUnknownResidues) {
  std::vector<Named> known, unknown;
  const char *const kNames[] = {"ALA", "UNK", "GLX", "ALA", "ASX"};
  for (int number = 1; number <= 5; ++number) {
    known.push_back({6, "ALA", "A", number});
    unknown.push_back({6, kNames[number - 1], "A", number});
  }
  EXPECT_EQ(colors_of(unknown, ColorScheme::kSequence), colors_of(known, ColorScheme::kSequence));
}

std::vector<Rgba> colors_in(const StructureFile &file, ColorScheme scheme) {
  std::vector<Rgba> colors(file.models[0].atoms.size());
  color_atoms(file.models[0], scheme, kUniform, colors[0].data());
  return colors;
}

// Chains and places in them are those of the file, whatever is left out.
TEST(AtomColors, APartHasTheColoursOfTheWhole) {
  std::string text;
  for (const char chain : {'A', 'B', 'C'})
    for (int number = 1; number <= 6; ++number) {
      char line[96];
      std::snprintf(line, sizeof line, "%-6s%5d  CA  %s %c%4d    %8.3f%8.3f%8.3f  1.00  0.00           C\n",
                    number < 6 ? "ATOM" : "HETATM", number, number < 6 ? "ALA" : "MSE", chain, number, 3.0 * number,
                    10.0 * (chain - 'A'), 0.0);
      text += line;
    }
  ReadOptions part, without_hetero;
  part.selection = "chain B C and resid 2-4";
  without_hetero.hetero = false;
  const auto read = [&](const ReadOptions &options) { return parse_structure(text, StructureFormat::kPdb, options); };
  const StructureFile whole = read({});
  for (const ReadOptions &options : {part, without_hetero}) {
    const StructureFile some = read(options);
    ASSERT_LT(some.models[0].atoms.size(), whole.models[0].atoms.size());
    for (const ColorScheme scheme : {ColorScheme::kChain, ColorScheme::kSequence}) {
      const std::vector<Rgba> of_some = colors_in(some, scheme), of_whole = colors_in(whole, scheme);
      for (size_t i = 0; i < of_some.size(); ++i)
        EXPECT_EQ(of_some[i], of_whole[some.models[0].atoms[i].file_index]) << i;
    }
  }
}

TEST(AtomColors, WithoutNames) {
  for (const ColorScheme scheme : {ColorScheme::kElement, ColorScheme::kChain, ColorScheme::kResidue,
                                   ColorScheme::kHydrophobicity, ColorScheme::kSequence})
    EXPECT_EQ(colors_of({{0, "", "", 0}, {0, "", "", 0}}, scheme), (std::vector<Rgba>{kUniform, kUniform}));
}

}  // namespace
}  // namespace quickses::io
