// SPDX-License-Identifier: MIT
// Which alternate locations are taken.
#include <cstdio>

#include "io/io_fixture.h"
#include "io/structure.h"

namespace quickses::io {
namespace {

using X = std::vector<float>;  // coordinates of atoms that were taken

std::string pdb_atom(const char *name, char altloc, const char *residue, char chain, int number, double x,
                     double occupancy = 1) {
  char line[96];
  std::snprintf(line, sizeof line, "ATOM      1 %-4s%c%3s %c%4d    %8.3f%8.3f%8.3f%6.2f%6.2f           C\n", name,
                altloc, residue, chain, number, x, 0.0, 0.0, occupancy, 0.0);
  return line;
}

StructureFile parse(const std::string &text, const std::string &altloc, const std::string &selection = "") {
  ReadOptions options;
  options.altloc = altloc;
  options.selection = selection;
  return parse_structure(text, StructureFormat::kPdb, options);
}

X taken(const std::string &text, const std::string &altloc, const std::string &selection = "") {
  const StructureFile file = parse(text, altloc, selection);
  X x;
  for (size_t i = 0; i < file.models.at(0).atoms.size(); ++i) x.push_back(file.models[0].positions[3 * i]);
  return x;
}

std::string locations() {
  return pdb_atom(" N  ", ' ', "ALA", 'A', 1, 1) + pdb_atom(" CA ", 'A', "ALA", 'A', 1, 2, 0.3) +
         pdb_atom(" CA ", 'B', "ALA", 'A', 1, 3, 0.7) + pdb_atom(" CB ", 'B', "ALA", 'A', 1, 4, 0.6) +
         pdb_atom(" CA ", 'A', "GLY", 'A', 2, 5, 0.5) + pdb_atom(" CA ", 'C', "GLY", 'A', 2, 6, 0.5) +
         pdb_atom(" CA ", 'B', "SER", 'B', 1, 7, 0.1) + pdb_atom(" CA ", 'A', "SER", 'B', 1, 8, 0.9);
}

TEST(AlternateLocations, AreChosen) {
  const auto of_all = [](const std::string &altloc, const std::string &selection = "") {
    return taken(locations(), altloc, selection);
  };
  EXPECT_EQ(of_all(""), (X{1, 2, 5, 7}));
  EXPECT_EQ(of_all("first"), (X{1, 2, 5, 7}));
  EXPECT_EQ(of_all("highest"), (X{1, 3, 4, 5, 8}));  // of two alike the first
  EXPECT_EQ(of_all("A"), (X{1, 2, 5, 8}));
  EXPECT_EQ(of_all("B"), (X{1, 3, 4, 5, 7}));  // GLY has none
  EXPECT_EQ(of_all("C"), (X{1, 2, 6, 7}));
  EXPECT_EQ(of_all("b"), (X{1, 2, 5, 7}));
  EXPECT_EQ(of_all("B", "resname GLY or name N"), (X{1, 5}));
  EXPECT_EQ(of_all("B", "altloc A"), (X{2, 5, 8}));  // who asks for locations finds all
  for (const char *wrong : {"AB", "Highest"}) EXPECT_HAS(error_of(ErrorKind::kUsage, [&] { of_all(wrong); }), wrong);
}

// A and B are one end of the residue, C and D the other: without one of each, atoms would be missing.
TEST(AlternateLocations, OfAtomsThatShareNoLabelAreChosenApart) {
  const std::string text = pdb_atom(" CA ", 'A', "SER", 'A', 1, 1, 0.4) + pdb_atom(" CA ", 'B', "SER", 'A', 1, 2, 0.6) +
                           pdb_atom(" OG ", 'C', "SER", 'A', 1, 3, 0.7) + pdb_atom(" OG ", 'D', "SER", 'A', 1, 4, 0.3) +
                           pdb_atom(" HG ", 'D', "SER", 'A', 1, 5, 0.3);
  EXPECT_EQ(taken(text, "first"), (X{1, 3}));
  EXPECT_EQ(taken(text, "highest"), (X{2, 3}));
  EXPECT_EQ(taken(text, "B"), (X{2, 3}));
  EXPECT_EQ(taken(text, "D"), (X{1, 4, 5}));
}

// What shares no label by itself does so by another atom.
TEST(AlternateLocations, OfAtomsThatAreJoinedByOthersAreChosenTogether) {
  const std::string text = pdb_atom(" CA ", 'A', "SER", 'A', 1, 1) + pdb_atom(" CA ", 'B', "SER", 'A', 1, 2) +
                           pdb_atom(" OG ", 'C', "SER", 'A', 1, 3) + pdb_atom(" OG ", 'D', "SER", 'A', 1, 4) +
                           pdb_atom(" CB ", 'B', "SER", 'A', 1, 5) + pdb_atom(" CB ", 'C', "SER", 'A', 1, 6);
  EXPECT_EQ(taken(text, "first"), X{1});
  EXPECT_EQ(taken(text, "D"), X{4});
}

// More atoms at a location don't make it likelier.
TEST(AlternateLocations, TheHighestIsThatOfTheGreatestMean) {
  const std::string text = pdb_atom(" CA ", 'A', "SER", 'A', 1, 1, 0.4) + pdb_atom(" CB ", 'A', "SER", 'A', 1, 2, 0.4) +
                           pdb_atom(" CA ", 'B', "SER", 'A', 1, 3, 0.6);
  EXPECT_EQ(taken(text, "highest"), X{3});
}

TEST(AlternateLocations, OfResiduesWithInsertionCodesAreChosenApart) {
  std::string inserted = pdb_atom(" CA ", 'B', "ALA", 'A', 1, 2);
  inserted[26] = 'A';  // residue 1A
  EXPECT_EQ(taken(pdb_atom(" CA ", 'A', "ALA", 'A', 1, 1) + inserted, "first"), (X{1, 2}));
}

// An ion or water, of which no atom has the name of the other's.
TEST(AlternateLocations, OfTwoResiduesAtOnePlaceAreAlternatives) {
  const std::string text = pdb_atom("ZN  ", 'A', " ZN", 'A', 1, 1, 0.4) + pdb_atom(" O  ", 'B', "HOH", 'A', 1, 2, 0.6);
  EXPECT_EQ(taken(text, "first"), X{1});
  EXPECT_EQ(taken(text, "highest"), X{2});
  EXPECT_EQ(taken(text, "B"), X{2});
}

TEST(AlternateLocations, ALabelThatNoResidueHasIsToldWithThoseThereAre) {
  const std::vector<std::string> warnings = parse(locations(), "D").warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_HAS(warnings[0], "no residue has the alternate location 'D'; there are A, B, C");
  const std::vector<std::string> of_none = parse(pdb_atom(" N  ", ' ', "ALA", 'A', 1, 1), "B").warnings;
  ASSERT_EQ(of_none.size(), 1u);
  EXPECT_HAS(of_none[0], "'B'; there are none");
  for (const char *choice : {"", "first", "highest", "C"}) EXPECT_TRUE(parse(locations(), choice).warnings.empty());
}

}  // namespace
}  // namespace quickses::io
