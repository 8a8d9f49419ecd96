// SPDX-License-Identifier: MIT
// Readers and radii, on small files that the tests write themselves.
#include <algorithm>
#include <cstdio>
#include <gemmi/elem.hpp>
#include <sstream>
#include <vector>

#include "io/elements.h"
#include "io/radii.h"
#include "io/structure_fixture.h"

namespace quickses::io {
namespace {

// One record of a PDB file. name: the four columns 13 to 16.
std::string pdb_atom(const std::string &name, char altloc, const std::string &residue, char chain, int number, float x,
                     const std::string &element = "", bool hetero = false, int serial = 1) {
  char line[96];
  std::snprintf(line, sizeof line, "%-6s%5d %-4s%c%3s %c%4d    %8.3f%8.3f%8.3f%6.2f%6.2f          %2s\n",
                hetero ? "HETATM" : "ATOM", serial, name.c_str(), altloc, residue.c_str(), chain, number, x, 2.0, 3.0,
                1.0, 0.0, element.c_str());
  return line;
}

// ---- elements

std::string element_symbol(gemmi::El element) { return gemmi::element_name(element); }

struct ElementCase {
  const char *residue;
  const char *atom;
  const char *element;
};

class ElementTest : public ::testing::TestWithParam<ElementCase> {};

TEST_P(ElementTest, IsInferredFromNames) {
  const ElementCase &c = GetParam();
  EXPECT_EQ(element_symbol(infer_element(c.residue, c.atom)), c.element) << c.residue << " '" << c.atom << "'";
}

INSTANTIATE_TEST_SUITE_P(
    Proteins, ElementTest,
    ::testing::Values(ElementCase{"ALA", " CA ", "C"}, ElementCase{"ALA", "CA  ", "C"}, ElementCase{"ALA", "CA", "C"},
                      ElementCase{"CYS", " SG ", "S"}, ElementCase{"SER", " HG ", "H"}, ElementCase{"SER", "HG", "H"},
                      ElementCase{"SER", "HG  ", "H"}, ElementCase{"LEU", "HD11", "H"}, ElementCase{"LEU", "1HD1", "H"},
                      ElementCase{"ASN", " ND2", "N"}, ElementCase{"HIS", " NE2", "N"}, ElementCase{"GLN", "NE2", "N"},
                      ElementCase{"GLU", " OE1", "O"}, ElementCase{"TRP", " CE2", "C"}, ElementCase{"GLY", " OXT", "O"},
                      ElementCase{"PHE", " CD1", "C"}, ElementCase{"HSD", "CE1", "C"}, ElementCase{"HID", "ND1", "N"},
                      ElementCase{"MSE", "SE  ", "Se"}, ElementCase{"MSE", "SE", "Se"}, ElementCase{"MET", " SD ", "S"},
                      ElementCase{"ALA", " D  ", "D"}));

INSTANTIATE_TEST_SUITE_P(NucleotidesAndWater, ElementTest,
                         ::testing::Values(ElementCase{"DA", " P  ", "P"}, ElementCase{"DG", " C5'", "C"},
                                           ElementCase{"U", "H5''", "H"}, ElementCase{"C", " O1P", "O"},
                                           ElementCase{"C", "C2", "C"}, ElementCase{"U", "N1", "N"},
                                           ElementCase{"ADE", "N9", "N"}, ElementCase{"HOH", " O  ", "O"},
                                           ElementCase{"SOL", "OW", "O"}, ElementCase{"SOL", "HW1", "H"},
                                           ElementCase{"TIP3", "OH2", "O"}));

INSTANTIATE_TEST_SUITE_P(
    IonsAndLigands, ElementTest,
    ::testing::Values(ElementCase{"CA", "CA  ", "Ca"}, ElementCase{"CA", "CA", "Ca"}, ElementCase{"HG", "HG  ", "Hg"},
                      ElementCase{"HG", "HG", "Hg"}, ElementCase{"ZN", "ZN", "Zn"}, ElementCase{"FE2", "FE", "Fe"},
                      ElementCase{"NA", "NA", "Na"}, ElementCase{"NA+", "NA+", "Na"}, ElementCase{"CL-", "CL-", "Cl"},
                      ElementCase{"K", " K  ", "K"}, ElementCase{"SOD", "SOD", "Na"}, ElementCase{"CLA", "CLA", "Cl"},
                      ElementCase{"CAL", "CAL", "Ca"}, ElementCase{"POT", "POT", "K"}, ElementCase{"CD", "CD", "Cd"},
                      ElementCase{"HEM", "FE  ", "Fe"}, ElementCase{"HEM", " CHA", "C"},
                      ElementCase{"HEM", " NA ", "N"}, ElementCase{"HEM", "NA", "N"}, ElementCase{"LIG", " CA ", "C"},
                      ElementCase{"LIG", "CA  ", "Ca"}, ElementCase{"LIG", "CL1 ", "Cl"},
                      ElementCase{"LIG", "BR  ", "Br"}, ElementCase{"LIG", " F1 ", "F"},
                      ElementCase{"LIG", "C10A", "C"}, ElementCase{"LIG", "CAA1", "C"}, ElementCase{"LIG", "HG11", "H"},
                      ElementCase{"MMC", "HG  ", "Hg"}, ElementCase{"LIG", " HG ", "H"},
                      ElementCase{"LIG", "1H  ", "H"}, ElementCase{"ATP", " PG ", "P"}, ElementCase{"ATP", "PG", "P"},
                      ElementCase{"SO4", "S", "S"}, ElementCase{"LIG", "12", "X"}, ElementCase{"LIG", "", "X"},
                      ElementCase{"CA", "CA2", "Ca"}));

TEST(Elements, SymbolsAreReadInAnyCaseAndWithCharges) {
  EXPECT_EQ(element_symbol(parse_element("FE")), "Fe");
  EXPECT_EQ(element_symbol(parse_element(" C")), "C");
  EXPECT_EQ(element_symbol(parse_element("Zn2+")), "Zn");
  EXPECT_EQ(element_symbol(parse_element("d")), "D");
  EXPECT_EQ(element_symbol(parse_element("Qq")), "X");
  EXPECT_EQ(element_symbol(parse_element("")), "X");
}

// ---- PDB

TEST_F(IoTest, PdbGivesWhatItsColumnsSay) {
  const std::string file = write("a.pdb", "HEADER    TEST\n" + pdb_atom(" N  ", ' ', "GLY", 'A', 7, -1.25f, "N") +
                                              "TER\n" + pdb_atom("ZN  ", ' ', " ZN", 'B', 901, 9.5f, "ZN", true) +
                                              pdb_atom(" O  ", ' ', "HOH", 'B', 902, 1.5f, "O", true) + "END\n");
  const StructureFile result = read_structure(file);
  EXPECT_EQ(result.model_count, 1);
  EXPECT_TRUE(result.warnings.empty());
  const Structure &structure = result.models.at(0);
  ASSERT_EQ(structure.atoms.size(), 3u);
  EXPECT_EQ(structure.positions, (std::vector<float>{-1.25f, 2, 3, 9.5f, 2, 3, 1.5f, 2, 3}));
  EXPECT_TRUE(structure.radii.empty());
  const AtomInfo &zinc = structure.atoms[1];
  EXPECT_EQ(zinc.name, "ZN");
  EXPECT_EQ(zinc.residue_name, "ZN");
  EXPECT_EQ(zinc.chain, "B");
  EXPECT_EQ(zinc.residue_number, 901);
  EXPECT_EQ(zinc.element, 30);
  EXPECT_TRUE(zinc.hetero);
  EXPECT_FALSE(zinc.is_water());
  EXPECT_FALSE(structure.atoms[0].hetero);
  EXPECT_TRUE(structure.atoms[2].is_water());
}

TEST_F(IoTest, BundledStructureHasAllItsAtoms) {
  const Structure structure = only_model(std::string(QUICKSES_TEST_DATA_DIR) + "/1CRN.pdb");
  ASSERT_EQ(structure.atoms.size(), 327u);
  EXPECT_FLOAT_EQ(structure.positions[0], 17.047f);
  EXPECT_FLOAT_EQ(structure.positions[1], 14.099f);
  EXPECT_FLOAT_EQ(structure.positions[2], 3.625f);
  for (size_t i = 0; i < structure.atoms.size(); ++i) EXPECT_EQ(structure.atoms[i].file_index, i);
}

TEST_F(IoTest, ElementsOfTheBundledStructureAreInferredAsTheFileHasThem) {
  const std::string original = std::string(QUICKSES_TEST_DATA_DIR) + "/1CRN.pdb";
  std::istringstream lines(slurp(original));
  std::string stripped, line;
  while (std::getline(lines, line)) stripped += (line.compare(0, 4, "ATOM") == 0 ? line.substr(0, 66) : line) + "\n";
  const StructureFile inferred = read_structure(write("stripped.pdb", stripped));
  ASSERT_EQ(inferred.warnings.size(), 1u);
  EXPECT_HAS(inferred.warnings[0], "327 atoms");
  const Structure given = only_model(original);
  ASSERT_EQ(inferred.models[0].atoms.size(), given.atoms.size());
  for (size_t i = 0; i < given.atoms.size(); ++i)
    EXPECT_EQ(inferred.models[0].atoms[i].element, given.atoms[i].element) << given.atoms[i].name;
}

TEST_F(IoTest, IndicesFollowTheFileWhereChainsAreInterleaved) {
  // gemmi gathers residues by chain; serial numbers may repeat.
  const std::string file =
      write("a.pdb", pdb_atom(" N  ", ' ', "GLY", 'A', 1, 0, "N") + pdb_atom(" C  ", ' ', "GLY", 'A', 2, 1, "C") +
                         pdb_atom(" O  ", ' ', "GLY", 'A', 1, 2, "O") + pdb_atom(" N  ", ' ', "GLY", 'B', 1, 3, "N") +
                         pdb_atom(" S  ", ' ', "CYS", 'A', 3, 4, "S"));
  const Structure structure = only_model(file);
  EXPECT_EQ(names_of(structure), (Names{"N", "C", "O", "N", "S"}));
  EXPECT_EQ(indices_of(structure), (Indices{0, 1, 2, 3, 4}));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(structure.positions[3 * i], float(i));
}

TEST_F(IoTest, IndicesSurviveMoreAtomsThanFiveDecimalDigitsCount) {
  std::string text;
  constexpr int kCount = 100'200;
  for (int i = 0; i < kCount; ++i)
    text += pdb_atom(" C  ", ' ', "ALA", char('A' + i / 9000), i % 9000, float(i % 1000), "C");
  const Structure structure = only_model(write("big.pdb", text));
  ASSERT_EQ(structure.atoms.size(), size_t(kCount));
  for (int i = 0; i < kCount; ++i) {
    ASSERT_EQ(structure.atoms[i].file_index, uint32_t(i));
    ASSERT_EQ(structure.positions[3 * i], float(i % 1000));
  }
}

TEST_F(IoTest, FirstAlternateLocationIsKept) {
  const std::string file =
      write("a.pdb", pdb_atom(" N  ", ' ', "SER", 'A', 1, 0, "N") + pdb_atom(" CA ", 'B', "SER", 'A', 1, 1, "C") +
                         pdb_atom(" CA ", 'A', "SER", 'A', 1, 2, "C") + pdb_atom(" OG ", 'A', "SER", 'A', 1, 3, "O") +
                         pdb_atom(" OG ", 'B', "SER", 'A', 1, 4, "O") + pdb_atom(" CA ", 'A', "GLY", 'A', 2, 5, "C") +
                         pdb_atom(" CA ", 'B', "GLY", 'A', 2, 6, "C") +
                         // two kinds of residue at one place
                         pdb_atom(" CB ", 'A', "SER", 'A', 3, 7, "C") + pdb_atom(" CB ", 'B', "THR", 'A', 3, 8, "C"));
  EXPECT_EQ(indices_of(only_model(file)), (Indices{0, 1, 4, 5, 7}));
  ReadOptions options;
  options.selection = "*:A";  // asked for by name
  EXPECT_EQ(indices_of(only_model(file, options)), (Indices{2, 3, 5, 7}));
}

TEST_F(IoTest, FiltersKeepTheIndicesOfTheFile) {
  const std::string file =
      write("a.pdb", pdb_atom(" O  ", ' ', "HOH", 'A', 1, 0, "O", true) + pdb_atom(" N  ", ' ', "GLY", 'A', 2, 1, "N") +
                         pdb_atom(" H  ", ' ', "GLY", 'A', 2, 2, "H") + pdb_atom(" D  ", ' ', "GLY", 'A', 2, 3, "D") +
                         pdb_atom("MG  ", ' ', " MG", 'B', 3, 4, "MG", true));
  ReadOptions no_water, no_hetero, no_hydrogen, chain;
  no_water.water = false;
  no_hetero.hetero = false;
  no_hydrogen.hydrogen = false;
  chain.selection = "//B";
  EXPECT_EQ(indices_of(only_model(file, no_water)), (Indices{1, 2, 3, 4}));
  EXPECT_EQ(indices_of(only_model(file, no_hetero)), (Indices{1, 2, 3}));
  EXPECT_EQ(indices_of(only_model(file, no_hydrogen)), (Indices{0, 1, 4}));
  EXPECT_EQ(indices_of(only_model(file, chain)), (Indices{4}));
  EXPECT_EQ(only_model(file, chain).file_atom_count, 5u);
  chain.selection = "//C";
  EXPECT_HAS(input_error(file, chain), "filters");
  chain.selection = "//A/[[";
  EXPECT_HAS(error_of(ErrorKind::kUsage, [&] { read_structure(file, chain); }), "//A/[[");
}

TEST_F(IoTest, ModelsAreCountedFromOne) {
  const std::string atom = pdb_atom(" N  ", ' ', "GLY", 'A', 1, 1, "N");
  const std::string two = atom + pdb_atom(" C  ", ' ', "GLY", 'A', 1, 2, "C");
  // With MODEL records, with END between frames, and with ENDMDL alone.
  for (const std::string &text : {"MODEL        1\n" + atom + "ENDMDL\nMODEL        1\n" + two + "ENDMDL\nEND\n",
                                  atom + "END\n" + two + "END\n", atom + "ENDMDL\n" + two}) {
    const std::string file = write("m.pdb", text);
    ReadOptions options;
    EXPECT_EQ(read_structure(file, options).model_count, 2);
    EXPECT_EQ(only_model(file, options).atoms.size(), 1u);
    options.model = 2;
    EXPECT_EQ(only_model(file, options).model, 2);
    EXPECT_EQ(indices_of(only_model(file, options)), (Indices{0, 1}));
    options.model = 0;
    EXPECT_EQ(read_structure(file, options).models.size(), 2u);
    options.model = 3;
    EXPECT_HAS(error_of(ErrorKind::kUsage, [&] { read_structure(file, options); }), "2 models");
  }
}

TEST_F(IoTest, BadPdbRecordsAreNamedByLine) {
  const std::string good = pdb_atom(" N  ", ' ', "GLY", 'A', 1, 1, "N");
  std::string bad = good;
  bad.replace(38, 8, "********");
  std::string message = input_error(write("a.pdb", good + bad));
  EXPECT_HAS(message, "line 2");
  EXPECT_HAS(message, "********");
  message = input_error(write("b.pdb", good + good + "ATOM      3  C   GLY A   1     1.0\n"));
  EXPECT_HAS(message, "line 3");
  bad.replace(38, 8, "     nan");
  EXPECT_HAS(input_error(write("c.pdb", bad)), "no number");
  // "3.000" cut off after its first digit would be a number too.
  EXPECT_HAS(input_error(write("d.pdb", good + good.substr(0, 51))), "columns 31 to 54");
}

// ---- mmCIF

const char kCifHead[] =
    "data_TEST\n_entry.id TEST\n#\nloop_\n_atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n"
    "_atom_site.label_atom_id\n_atom_site.label_alt_id\n_atom_site.label_comp_id\n_atom_site.label_asym_id\n"
    "_atom_site.label_entity_id\n_atom_site.label_seq_id\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n"
    "_atom_site.occupancy\n_atom_site.B_iso_or_equiv\n_atom_site.auth_seq_id\n_atom_site.auth_asym_id\n"
    "_atom_site.pdbx_PDB_model_num\n";

TEST_F(IoTest, MmcifGivesWhatItsTableSays) {
  const std::string file = write("a.cif", std::string(kCifHead) +
                                              "ATOM 10 C CA . GLY A 1 1 1.5 2.5 3.5 1 10 27 X 1\n"
                                              "ATOM 11 O \"O5'\" A DA A 1 2 4 5 6 1 10 28 X 1\n"
                                              "ATOM 12 O \"O5'\" B DA A 1 2 7 5 6 1 10 28 X 1\n"
                                              "HETATM 7 CA CA . CA B 2 . 8 5 6 1 10 301 X 1\n"
                                              "ATOM 10 C CA . GLY A 1 1 1.5 2.5 3.5 1 10 27 X 2\n#\n");
  const StructureFile result = read_structure(file);
  EXPECT_EQ(result.model_count, 2);
  const Structure &structure = result.models.at(0);
  EXPECT_EQ(names_of(structure), (Names{"CA", "O5'", "CA"}));
  EXPECT_EQ(indices_of(structure), (Indices{0, 1, 3}));
  EXPECT_EQ(structure.file_atom_count, 4u);
  EXPECT_EQ(structure.positions[0], 1.5f);
  EXPECT_EQ(structure.atoms[0].element, 6);
  EXPECT_EQ(structure.atoms[2].element, 20);
  EXPECT_EQ(structure.atoms[0].chain, "X");
  EXPECT_EQ(structure.atoms[0].residue_number, 27);
  EXPECT_TRUE(structure.atoms[2].hetero);
  ReadOptions options;
  options.model = 2;
  EXPECT_EQ(indices_of(only_model(file, options)), (Indices{0}));
}

TEST_F(IoTest, MmcifWithoutOptionalColumnsIsRead) {
  const std::string file = write("small.cif",
                                 "data_x\nloop_\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n"
                                 "_atom_site.label_atom_id\n_atom_site.label_comp_id\n1 2 3 CA ALA\n4 5 6 CA CA\n");
  const StructureFile result = read_structure(file);
  ASSERT_EQ(result.models.at(0).atoms.size(), 2u);
  EXPECT_EQ(result.models[0].atoms[0].element, 6);
  EXPECT_EQ(result.models[0].atoms[1].element, 20);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_HAS(result.warnings[0], "2 atoms");
}

TEST_F(IoTest, BadMmcifIsRefused) {
  EXPECT_HAS(input_error(write("a.cif", "data_x\nloop_\n_atom_site.id\n_atom_site.Cartn_x\n1 2 3\n")), "mmCIF");
  EXPECT_HAS(input_error(write("b.cif", "data_x\n_entry.id x\n")), "no atoms");
  EXPECT_HAS(input_error(write("c.cif", std::string(kCifHead) + "ATOM 10 C CA . GLY A 1 1 ? 2.5 3.5 1 10 27 X 1\n")),
             "no number");
}

TEST_F(IoTest, ResidueNumbersBelowZeroAndBeyondAllBounds) {
  const std::string pdb =
      pdb_atom(" N  ", ' ', "GLY", 'A', -7, 1, "N") + pdb_atom(" C  ", ' ', "GLY", 'A', -998, 2, "C");
  EXPECT_EQ(only_model(write("a.pdb", pdb)).atoms.at(0).residue_number, -7);
  EXPECT_EQ(only_model(write("a.pdb", pdb)).atoms.at(1).residue_number, -998);  // -999 is no number to gemmi
  const auto cif = [](const std::string &label, const std::string &author) {
    return std::string(kCifHead) + "ATOM 10 C CA . GLY A 1 " + label + " 1 2 3 1 10 " + author + " X 1\n";
  };
  EXPECT_EQ(only_model(write("a.cif", cif("1", "-999999999"))).atoms.at(0).residue_number, -999999999);
  for (const char *number : {"9999999999", "-99999999999", "99999999999999999999A"})
    EXPECT_HAS(input_error(write("b.cif", cif("1", number))),
               "atom 1 of _atom_site: the residue number '" + std::string(number));
  // Which is not asked for where there is the author's.
  EXPECT_EQ(only_model(write("c.cif", cif("9999999999", "1"))).atoms.at(0).residue_number, 1);
}

TEST_F(IoTest, MessagesQuoteNothingThatSteersATerminal) {
  const std::string message = input_error(write("a.xyzr", "1 2 \x1b[2J\x07\x7fx 1\n"));
  EXPECT_HAS(message, "'?[2J??x'");
  const std::string letters = input_error(write("b.xyzr", "1 2 \u00c5\u00c5 1\n"));
  EXPECT_HAS(letters, "'\u00c5\u00c5'");
  EXPECT_HAS(input_error(write("d.xyzr",
                               "1 2 \xc2\x9b"
                               "2Jx 1\n")),
             "'??2Jx'");
  std::string many;
  for (int i = 0; i < 100000; ++i) many += "\u00c5";
  EXPECT_LE(input_error(write("c.xyzr", "1 2 " + many + " 1\n")).size(), 8000u);
}

TEST_F(IoTest, FormatIsFoundInTheContentWhereTheNameTellsNothing) {
  EXPECT_EQ(only_model(write("1abc.pdb1", pdb_atom(" N  ", ' ', "GLY", 'A', 1, 1, "N"))).atoms.size(), 1u);
  const std::string cif = std::string("# comment\n") + kCifHead + "ATOM 10 C CA . GLY A 1 1 1 2 3 1 10 27 X 1\n";
  EXPECT_EQ(only_model(write("structure", cif)).atoms.size(), 1u);
  EXPECT_HAS(input_error(write("notes.txt", "Dear diary\n")), ".cif");
}

// ---- files

TEST_F(IoTest, FilesThatCanNotBeReadAreNamed) {
  EXPECT_HAS(input_error(path("nowhere.pdb")), "no such file");
  EXPECT_HAS(input_error(folder_.string()), "directory");
  EXPECT_HAS(input_error(write("empty.pdb", "")), "empty");
  EXPECT_HAS(input_error(write("bare.pdb", "HEADER    NOTHING\nEND\n")), "no atoms");
}

TEST_F(IoTest, GzipIsRead) {
  const std::string one = pdb_atom(" N  ", ' ', "GLY", 'A', 1, 1, "N");
  EXPECT_EQ(only_model(write_gz("a.pdb.gz", one)).atoms.size(), 1u);
  write_gz("b.pdb.gz", one);
  EXPECT_EQ(only_model(write_gz("b.pdb.gz", pdb_atom(" C  ", ' ', "GLY", 'A', 1, 2, "C"), true)).atoms.size(), 2u);
  EXPECT_HAS(input_error(write("c.pdb.gz", one)), "gzip");
  EXPECT_HAS(input_error(write_gz("d.pdb.gz", "")), "is empty");
  EXPECT_HAS(input_error(write_gz("d.xyzr.gz", "")), "is empty");
  EXPECT_HAS(input_error(write_gz("e.pdb.gz", slurp(path("a.pdb.gz")))),
             "e.pdb.gz' is gzip data that was packed twice");
}

TEST_F(IoTest, EveryCutGzipIsRefused) {
  std::string text;
  for (int i = 0; i < 200; ++i) text += pdb_atom(" C  ", ' ', "GLY", 'A', i, float(i * i % 977), "C");
  const std::string packed = slurp(write_gz("whole.pdb.gz", text));
  ASSERT_EQ(only_model(path("whole.pdb.gz")).atoms.size(), 200u);
  // Also where only the checksum is missing, and the text decoded so far is complete.
  for (size_t size = 1; size < packed.size(); size += size + 40 < packed.size() ? 37 : 1)
    EXPECT_HAS(input_error(write("cut.pdb.gz", packed.substr(0, size))), "cut off") << size;
  std::string damaged = packed;
  damaged[packed.size() - 6] ^= 1;  // in the checksum
  EXPECT_HAS(input_error(write("damaged.pdb.gz", damaged)), "damaged");
}

// As Macs had them.
TEST_F(IoTest, LinesMayEndWithCarriageReturns) {
  const auto mac = [](std::string text) {
    std::replace(text.begin(), text.end(), '\n', '\r');
    return text;
  };
  const std::string atom = pdb_atom(" N  ", ' ', "GLY", 'A', 1, 1, "N");
  EXPECT_EQ(only_model(write("a.pdb", mac("HEADER    X\n" + atom + atom + "END\n"))).atoms.size(), 2u);
  EXPECT_EQ(only_model(write("a", mac(atom + atom))).atoms.size(), 2u);
  EXPECT_EQ(only_model(write("a.xyzr", "1 2 3 1\r4 5 6 1\r")).atoms.size(), 2u);
  EXPECT_EQ(find_radii(write("r.txt", "C 1\rN 2")).by_element[7], 2.0f);
}

// Editors of Windows begin a text with it.
TEST_F(IoTest, AByteOrderMarkIsNoPartOfTheText) {
  const std::string mark = "\xef\xbb\xbf", pdb = pdb_atom(" N  ", ' ', "GLY", 'A', 1, 1, "N");
  EXPECT_EQ(only_model(write("a.pdb", mark + pdb + pdb)).atoms.size(), 2u);
  EXPECT_EQ(only_model(write("a", mark + pdb)).atoms.size(), 1u);
  EXPECT_EQ(only_model(write("a.pqr", mark + "ATOM 1 N ALA 1 1 2 3 0 1\n")).atoms.size(), 1u);
  EXPECT_EQ(only_model(write("a.xyzr", mark + "1 2 3 1\n")).atoms.size(), 1u);
  EXPECT_EQ(only_model(write("a.cif", mark + kCifHead + "ATOM 10 C CA . GLY A 1 1 1 2 3 1 10 27 X 1\n")).atoms.size(),
            1u);
  EXPECT_HAS(input_error(write("b.pdb", mark + "<html><body>gone</body></html>")), "web page");
}

// As where PowerShell leads the output of another program to a file.
TEST_F(IoTest, TextMayBeUtf16) {
  const std::string pdb = "REMARK \xe4\r\n" + pdb_atom(" N  ", ' ', "GLY", 'A', 1, 1, "N");
  for (const bool is_big : {false, true}) {
    const auto wide = [is_big](const std::string &text) {
      std::string bytes = is_big ? "\xfe\xff" : "\xff\xfe";
      for (const char c : text) bytes += is_big ? std::string{'\0', c} : std::string{c, '\0'};
      return bytes;
    };
    const Structure structure = only_model(write("a.pdb", wide(pdb + pdb)));
    EXPECT_EQ(structure.atoms.size(), 2u);
    EXPECT_EQ(structure.atoms.front().residue_name, "GLY");
    EXPECT_EQ(only_model(write("a", wide(pdb))).atoms.size(), 1u);
    EXPECT_EQ(only_model(write_gz("a.pdb.gz", wide(pdb))).atoms.size(), 1u);
    EXPECT_EQ(only_model(write("a.xyzr", wide("1 2 3 1\r\n4 5 6 1\r\n"))).atoms.size(), 2u);
    EXPECT_EQ(only_model(write("cut.xyzr", wide("1 2 3 1\n") + "x")).atoms.size(), 1u);
    EXPECT_EQ(only_model(write("a.cif", wide(std::string(kCifHead) + "ATOM 10 C CA . GLY A 1 1 1 2 3 1 10 27 X 1\n")))
                  .atoms.size(),
              1u);
    EXPECT_EQ(find_radii(write("r.txt", wide("C 1\nN 2\n"))).by_element[7], 2.0f);
    EXPECT_HAS(input_error(write("b.pdb", wide("<html></html>"))), "web page");
    EXPECT_HAS(input_error(write("b.pdb", wide(""))), "no atoms");
  }
}

// ---- radii

float radius_of(const RadiusTable &table, int atomic_number) { return table.at(atomic_number); }

TEST_F(IoTest, RadiiOfThePaperAreTheDefault) {
  const RadiusTable table = find_radii("quickses").by_element;
  EXPECT_EQ(radius_of(table, 8), 1.52f);
  EXPECT_EQ(radius_of(table, 6), 1.70f);
  EXPECT_EQ(radius_of(table, 7), 1.55f);
  EXPECT_EQ(radius_of(table, 1), 1.20f);
  EXPECT_EQ(radius_of(table, 16), 1.80f);
  EXPECT_EQ(radius_of(table, 15), 1.80f);
  for (int other : {0, 2, 9, 12, 17, 20, 26, 30, 34, 118}) EXPECT_EQ(radius_of(table, other), 1.40f) << other;
}

TEST_F(IoTest, BondiRadii) {
  const RadiusTable table = find_radii("bondi").by_element;
  EXPECT_EQ(radius_of(table, 1), 1.20f);
  EXPECT_EQ(radius_of(table, 9), 1.47f);
  EXPECT_EQ(radius_of(table, 17), 1.75f);
  EXPECT_EQ(radius_of(table, 30), 1.39f);
  EXPECT_EQ(radius_of(table, 20), 2.31f);
  EXPECT_EQ(radius_of(table, 26), 2.00f);
}

TEST_F(IoTest, DeuteriumHasTheRadiusOfHydrogen) {
  Structure structure = only_model(
      write("a.pdb", pdb_atom(" D  ", ' ', "GLY", 'A', 1, 1, "D") + pdb_atom("XX  ", ' ', "UNX", 'A', 2, 2, " X")));
  assign_radii(structure, find_radii("quickses"));
  EXPECT_EQ(structure.radii, (std::vector<float>{1.20f, 1.40f}));
}

}  // namespace
}  // namespace quickses::io
