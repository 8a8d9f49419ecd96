// SPDX-License-Identifier: MIT
// PQR, XYZR and GRO files, and sites of water that are no atoms, which GRO files mostly have.
#include "io/elements.h"
#include "io/structure_fixture.h"

namespace quickses::io {
namespace {

using PlainReadersTest = IoTest;

TEST_F(PlainReadersTest, XyzrGivesPositionsAndRadii) {
  const Structure structure = only_model(
      write("a.xyzr", "# a comment\n1 2 3 1.5\n\n -4e0\t5 6  1.75 # behind\r\n7 8 9 0\n1 1 1 2 more words\n"));
  EXPECT_EQ(structure.positions, (std::vector<float>{1, 2, 3, -4, 5, 6, 1, 1, 1}));
  EXPECT_EQ(structure.radii, (std::vector<float>{1.5f, 1.75f, 2}));
  EXPECT_EQ(indices_of(structure), (Indices{0, 1, 3}));
  EXPECT_HAS(input_error(write("b.xyzr", "1 2 3 1\n1 2 3\n")), "line 2");
  EXPECT_HAS(input_error(write("c.xyzr", "1 2 3 -1\n")), "line 1");
  EXPECT_HAS(input_error(write("d.xyzr", "1 2 inf 1\n")), "line 1");
  EXPECT_HAS(input_error(write("e.xyzr", "# nothing\n")), "no atoms");
  EXPECT_HAS(input_error(write("f.xyzr", "1 2 3 0\n")), "radius 0");
  EXPECT_EQ(only_model(write("g.xyzr", "1 2 3 100\n")).radii, (std::vector<float>{100}));
  EXPECT_HAS(input_error(write("h.xyzr", "1 2 3 100.01\n")), "line 1: the radius '100.01' is not between 0 and 100");
  ReadOptions options;
  options.water = false;
  EXPECT_HAS(error_of(ErrorKind::kUsage, [&] { read_structure(path("a.xyzr"), options); }), "no names");
}

TEST_F(PlainReadersTest, PqrGivesNamesAndRadii) {
  const Structure structure =
      only_model(write("a.pqr",
                       "REMARK   1 PQR\nATOM      1  N   ALA     1       1.0 2.0 3.0  -0.3 1.55\n"
                       "ATOM      2  CA  ALA A   1       4.0 5.0 6.0  0.1 1.70\nTER\nEND\n"
                       "HETATM    3 CA    CA B  52A     -7.0 8.0 9.0  2.0 1.40\n"));
  EXPECT_EQ(structure.radii, (std::vector<float>{1.55f, 1.70f, 1.40f}));
  EXPECT_EQ(structure.positions[6], -7.0f);
  EXPECT_EQ(structure.atoms[1].element, 6);
  EXPECT_EQ(structure.atoms[2].element, 20);
  EXPECT_EQ(structure.atoms[2].chain, "B");
  EXPECT_HAS(input_error(write("b.pqr", "ATOM 1 N ALA 1 1.0 2.0\n")), "line 1");
  EXPECT_HAS(input_error(write("c.pqr", "ATOM 1 N ALA 1 1.0 2.0 3.0 0.5\n")), "line 1: expected ATOM");  // no radius
}

// As PDB2PQR writes it unless asked for blanks between: what fills its columns joins what is before it.
TEST_F(PlainReadersTest, PqrWordsThatColumnsJoin) {
  const Structure structure = only_model(write("a.pqr",
                                               "ATOM   9999 HD11NLEU A   1       1.000   2.000   3.000  0.1000 1.2000\n"
                                               "HETATM10000 CA    CA A1000    -110.000-120.000-130.000  2.0000 1.4000\n"
                                               "ATOM  10001  N   ALA B1000A     10.000-120.000   3.000 -0.3000 1.5500\n"
                                               "ATOM  10002  CA  ALA    12       1.000   2.000   3.000 -0.3000 1.7000\n"
                                               "HETATMS are no atoms\n"));
  EXPECT_EQ(structure.positions, (std::vector<float>{1, 2, 3, -110, -120, -130, 10, -120, 3, 1, 2, 3}));
  EXPECT_EQ(names_of(structure), (Names{"HD11", "CA", "N", "CA"}));
  EXPECT_EQ(structure.radii, (std::vector<float>{1.2f, 1.4f, 1.55f, 1.7f}));
  const AtomInfo &first = structure.atoms[0], &ion = structure.atoms[1], &inserted = structure.atoms[2],
                 &last = structure.atoms[3];
  EXPECT_EQ(first.residue_name + first.chain + std::to_string(first.residue_number), "NLEUA1");
  EXPECT_EQ(ion.chain + std::to_string(ion.residue_number), "A1000");
  EXPECT_TRUE(ion.hetero);
  EXPECT_EQ(inserted.chain + std::to_string(inserted.residue_number) + inserted.insertion_code, "B1000A");
  EXPECT_EQ(last.chain + std::to_string(last.residue_number), "12");
}

// Splitting all of them would take days.
TEST_F(PlainReadersTest, PqrWordsBehindTheRadiusAreNotRead) {
  std::string line = "ATOM 1 CA ALA A 1 1 2 3 0.1 1.5 ";
  for (int k = 0; k < 1000000; ++k) line += "1-1 ";
  const Structure structure = only_model(write("a.pqr", line + "\n"));
  EXPECT_EQ(structure.positions, (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(structure.radii, (std::vector<float>{1.5f}));
}

TEST_F(PlainReadersTest, PqrModelsAndInsertionCodes) {
  const auto atom = [](const char *number, int x) {
    return "ATOM 1 CA ALA A " + std::string(number) + " " + std::to_string(x) + " 0 0 0.1 1.5\n";
  };
  const std::string file = write("a.pqr", "MODEL        1\n" + atom("52", 1) + atom("52A", 2) +
                                              "ENDMDL\nMODEL        2\n" + atom("52", 3) + "ENDMDL\nEND\n");
  ReadOptions options;
  options.model = 2;
  EXPECT_EQ(only_model(file, options).positions, (std::vector<float>{3, 0, 0}));
  options.model = 0;
  EXPECT_EQ(read_structure(file, options).models.size(), 2u);
  options.model = 1;
  options.selection = "resid 52A";
  EXPECT_EQ(only_model(file, options).positions, (std::vector<float>{2, 0, 0}));
}

TEST_F(PlainReadersTest, AtomsOfRadiusZeroAreSaidToBeWhatIsLeftOut) {
  ReadOptions options;
  const std::string file = write("a.pqr", "ATOM 1 N ALA 1 1 2 3 0 0\n");
  EXPECT_HAS(input_error(file, options), "those of radius 0");
  options.water = false;
  EXPECT_HAS(input_error(file, options), "those of radius 0");
}

TEST_F(PlainReadersTest, GroIsReadInAngstrom) {
  const std::string text =
      "A title\n    2\n    1ALA     CA    1   0.125   1.000  -2.000\n    2SOL     OW    2   0.250   1.500   2.000\n"
      "   5.0   5.0   5.0\n";
  const Structure structure = only_model(write("a.gro", text));
  EXPECT_EQ(structure.positions, (std::vector<float>{1.25f, 10, -20, 2.5f, 15, 20}));
  EXPECT_EQ(structure.atoms[0].element, 6);
  EXPECT_TRUE(structure.atoms[1].is_water());
  const std::vector<std::string> warnings = read_structure(path("a.gro")).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_HAS(warnings[0], "the element of 2 atoms was missing");  // the format has none
  EXPECT_HAS(input_error(write("b.gro", text.substr(0, 59))), "cut off");
  const size_t end_of_second = text.rfind("\n", text.size() - 2);
  for (size_t less : {1, 9, 18})
    EXPECT_HAS(input_error(write("b.gro", text.substr(0, end_of_second - less) + text.substr(end_of_second))),
               "line 4: the line ends before its coordinates");
  for (const char *count : {"-1", "2.5", "", "two"})
    EXPECT_HAS(input_error(write("b.gro", "t\n" + std::string(count) + "\n 5 5 5\n")),
               "line 2: expected the number of atoms");
  // More decimals widen the columns.
  const Structure fine =
      only_model(write("c.gro", "t\n1\n    1ALA     CA    1   0.12500   1.00000  -2.00000\n 5 5 5\n"));
  EXPECT_EQ(fine.positions, (std::vector<float>{1.25f, 10, -20}));
  for (const char *end : {"\r\n\r\n\r\n\r\n", "\n\n \n\n", " \n\t\n\n"})
    EXPECT_EQ(only_model(write("d.gro", text + end)).positions, structure.positions);
}

// ---- sites of water that are no atoms

struct WaterCase {
  const char *atom;
  bool is_virtual;
};

class WaterSiteTest : public ::testing::TestWithParam<WaterCase> {};

TEST_P(WaterSiteTest, IsAnAtomIfItIsOxygenOrHydrogen) {
  const WaterCase &c = GetParam();
  EXPECT_EQ(is_site_of_water(c.atom), c.is_virtual) << "'" << c.atom << "'";
}

// TIP4P of GROMACS, Amber and CHARMM, TIP5P.
INSTANTIATE_TEST_SUITE_P(Models, WaterSiteTest,
                         ::testing::Values(WaterCase{"MW", true}, WaterCase{"EPW", true}, WaterCase{" OM ", true},
                                           WaterCase{"M", true}, WaterCase{"LP1", true}, WaterCase{"EP2", true},
                                           WaterCase{"OW", false}, WaterCase{"HW1", false}, WaterCase{" O  ", false},
                                           WaterCase{" D1 ", false}, WaterCase{"1H  ", false}, WaterCase{"C1", false},
                                           WaterCase{"N3", false}, WaterCase{" P  ", false}));

// Components of the PDB have names of water models: thymidine-3'-phosphate T3P, a lipid OPC.
TEST_F(PlainReadersTest, LigandsNamedAsWaterModelsKeepTheirAtoms) {
  const auto kept = [this](const std::string &residue, std::initializer_list<const char *> names) {
    std::string text = "t\n" + std::to_string(names.size()) + "\n";
    int count = 0;
    for (const char *name : names) {
      char line[64];
      ++count;
      std::snprintf(line, sizeof line, "    1%-5s%5s%5d%8.3f   0.000   0.000\n", residue.c_str(), name, count,
                    0.1 * count);
      text += line;
    }
    std::string result;
    const Structure structure = only_model(write("a.gro", text + "5 5 5\n"));
    for (const AtomInfo &atom : structure.atoms) {
      EXPECT_EQ(atom.is_water(), structure.atoms[0].is_water());
      result += (atom.is_water() ? "water " : "ligand ") + atom.name + " ";
    }
    return result;
  };
  EXPECT_EQ(kept("OPC", {"C1", "P", "MC"}), "ligand C1 ligand P ligand MC ");
  EXPECT_EQ(kept("T3P", {"O5'", "O4'"}), "ligand O5' ligand O4' ");
  EXPECT_EQ(kept("OPC", {"OW", "HW1", "HW2", "MW"}), "water OW water HW1 water HW2 ");
  EXPECT_EQ(kept("T3P", {"OH2", "H1", "OM"}), "water OH2 water H1 ");
  EXPECT_EQ(kept("HOH", {"O"}), "water O ");
  EXPECT_EQ(kept("LIG", {"O", "H1", "MW"}), "ligand O ligand H1 ligand MW ");
}

TEST_F(PlainReadersTest, SitesOfWaterThatAreNoAtomsAreLeftOut) {
  const std::string text =
      "TIP5P\n    6\n    1SOL     OW    1   0.000   0.000   0.000\n    1SOL    HW1    2   0.096   0.000   0.000\n"
      "    1SOL    HW2    3  -0.024   0.093   0.000\n    1SOL    LP1    4  -0.023  -0.033   0.057\n"
      "    1SOL    LP2    5  -0.023  -0.033  -0.057\n    2ALA     CA    6   1.000   0.000   0.000\n 5 5 5\n";
  const StructureFile file = read_structure(write("a.gro", text));
  EXPECT_EQ(indices_of(file.models.at(0)), (Indices{0, 1, 2, 5}));
  EXPECT_EQ(file.models[0].file_atom_count, 6u);  // as trajectories have
  ASSERT_EQ(file.warnings.size(), 2u);
  EXPECT_HAS(file.warnings[0], "4 atoms");
  EXPECT_HAS(file.warnings[1], "2 sites of water left out that are no atoms");
  ReadOptions options;
  options.selection = "name LP1";
  EXPECT_HAS(input_error(path("a.gro"), options), "sites that are no atoms");
  // Files with radii of their own say themselves what has a surface.
  EXPECT_EQ(only_model(write("a.pqr", "ATOM 1 MW SOL 1 1 2 3 -1.0 0.5\n")).atoms.size(), 1u);
}

}  // namespace
}  // namespace quickses::io
