// SPDX-License-Identifier: MIT
// Radii from a file: by element, residue and atom.
#include "io/radii.h"
#include "io/io_fixture.h"

namespace quickses::io {
namespace {

class RadiiTest : public IoTest {
 protected:
  Radii read(const std::string &text) const { return find_radii(write("radii.txt", text)); }
};

float radius_of(const Radii &radii, const char *residue, const char *atom, uint8_t element = 6) {
  AtomInfo info;
  info.residue_name = residue;
  info.name = atom;
  info.element = element;
  return radii.of(info);
}

TEST_F(RadiiTest, Elements) {
  const Radii radii = read("# mine\nC 2.5\nzn 1.1 # zinc\nx 1.7 # unknown\n");
  EXPECT_EQ(radii.by_element[6], 2.5f);
  EXPECT_EQ(radii.by_element[30], 1.1f);
  EXPECT_EQ(radii.by_element[0], 1.7f);
  EXPECT_EQ(radii.by_element[8], 1.52f);
  for (const char *others : {"C 2.5\n* 1.0\n", "* * 1.0\nC 2.5\n"}) {
    const Radii all = read(others);
    EXPECT_EQ(all.by_element[6], 2.5f);
    EXPECT_EQ(all.by_element[8], 1.0f);
    EXPECT_TRUE(all.by_name.empty());
  }
}

// Whatever the order of the lines.
TEST_F(RadiiTest, TheMostSpecificLineHolds) {
  const char *const lines[] = {"ALA CB 2.1\n", "ALA * 2.2\n", "* CB 2.3\n", "C 2.4\n", "* 2.5\n"};
  const std::string forwards = std::string(lines[0]) + lines[1] + lines[2] + lines[3] + lines[4];
  const std::string backwards = std::string(lines[4]) + lines[3] + lines[2] + lines[1] + lines[0];
  for (const std::string &text : {forwards, backwards}) {
    const Radii radii = read(text);
    EXPECT_EQ(radius_of(radii, "ALA", "CB"), 2.1f);
    EXPECT_EQ(radius_of(radii, "ALA", "CA"), 2.2f);
    EXPECT_EQ(radius_of(radii, "ALA", "N", 7), 2.2f);
    EXPECT_EQ(radius_of(radii, "GLY", "CB"), 2.3f);
    EXPECT_EQ(radius_of(radii, "GLY", "CA"), 2.4f);
    EXPECT_EQ(radius_of(radii, "GLY", "N", 7), 2.5f);
    EXPECT_EQ(radius_of(radii, "", "", 0), 2.5f);
  }
}

TEST_F(RadiiTest, NamesInAnyCaseAndWithSigns) {
  const Radii radii = read("ala cb 2.1\nA O5' 1.1\nA O5* 1.2\nCL- CL- 1.9\n  *\tOXT\t1.3   # the end\r\n");
  EXPECT_EQ(radius_of(radii, "ALA", "CB"), 2.1f);
  EXPECT_EQ(radius_of(radii, "Ala", "Cb"), 2.1f);
  EXPECT_EQ(radius_of(radii, "A", "O5'", 8), 1.1f);
  EXPECT_EQ(radius_of(radii, "A", "O5*", 8), 1.2f);  // a star is only by itself for all
  EXPECT_EQ(radius_of(radii, "CL-", "CL-", 17), 1.9f);
  EXPECT_EQ(radius_of(radii, "GLY", "OXT", 8), 1.3f);
  EXPECT_EQ(radius_of(radii, "A", "O4'", 8), 1.52f);
}

TEST_F(RadiiTest, OfLinesForTheSameTheLastHolds) {
  const Radii radii = read("C 1\nC 2\nALA CB 3\nALA CB 4\n* 5\n* * 6\n");
  EXPECT_EQ(radii.by_element[6], 2.0f);
  EXPECT_EQ(radius_of(radii, "ALA", "CB"), 4.0f);
  EXPECT_EQ(radii.by_element[7], 6.0f);
}

TEST_F(RadiiTest, ReachTheAtomsOfAStructure) {
  const std::string pdb = write("a.pdb",
                                "ATOM      1  N   ALA A   1       0.000   0.000   0.000  1.00  0.00           N\n"
                                "ATOM      2  CB  ALA A   1       5.000   0.000   0.000  1.00  0.00           C\n"
                                "HETATM    3  O   HOH A   2       9.000   0.000   0.000  1.00  0.00           O\n");
  StructureFile file = read_structure(pdb);
  assign_radii(file, write("r.txt", "HOH * 1.7\nALA CB 2.0\n"));
  EXPECT_EQ(file.models[0].radii, (std::vector<float>{1.55f, 2.0f, 1.7f}));
}

TEST_F(RadiiTest, AtomsOfUnknownElementAreCounted) {
  const std::string pdb = write("a.pdb",
                                "ATOM      1  N   ALA A   1       0.000   0.000   0.000  1.00  0.00           N\n"
                                "HETATM    2  X1  UNX A   2       5.000   0.000   0.000  1.00  0.00           X\n"
                                "HETATM    3  X2  UNX A   3       9.000   0.000   0.000  1.00  0.00           X\n");
  const auto warnings_with = [&](const std::string &set) {
    StructureFile file = read_structure(pdb);
    assign_radii(file, set);
    return file.warnings;
  };
  ASSERT_EQ(warnings_with("bondi").size(), 1u);
  EXPECT_HAS(warnings_with("bondi")[0],
             "a.pdb': the element of 2 atoms is unknown; the radius of such atoms is 2.00 Å");
  EXPECT_HAS(warnings_with("")[0], "1.40 Å");
  EXPECT_HAS(warnings_with(write("one.txt", "UNX X1 3\nX 1.1\n")).at(0),
             "1 atom is unknown; the radius of such atoms is 1.10");
  EXPECT_TRUE(warnings_with(write("all.txt", "UNX * 3\n")).empty());
}

TEST_F(RadiiTest, ErrorsNameFileAndLine) {
  const struct {
    const char *text;
    const char *part;
  } kBad[] = {{"C 1.7\nQq 1\n", "bad.txt', line 2: 'Qq' is no element"},
              {"C1 2.5\n", "bad.txt', line 1: 'C1' is no element"},
              {"C\n", "bad.txt', line 1: expected an element and its radius, or a residue, an atom and its radius"},
              {"ALA CB 1 2\n", "bad.txt', line 1: expected"},
              {"C 0\n", "line 1: the radius '0'"},
              {"\nC x\n", "line 2: the radius 'x'"},
              {"ALA CB x\n", "line 1: the radius 'x'"},
              {"ALA CB -1\n", "line 1: the radius '-1'"},
              {"\n\nALA * 101\n", "line 3: the radius '101'"},
              {"* 1e-50\n", "line 1: the radius '1e-50'"},
              {"* * nan\n", "line 1: the radius 'nan'"}};
  for (const auto &bad : kBad)
    EXPECT_HAS(error_of(ErrorKind::kInput, [&] { find_radii(write("bad.txt", bad.text)); }), bad.part);
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { find_radii(path("none.txt")); }), "bondi");
}

}  // namespace
}  // namespace quickses::io
