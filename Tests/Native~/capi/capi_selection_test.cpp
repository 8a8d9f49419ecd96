// SPDX-License-Identifier: MIT
// The C API: which atoms of a structure a selection names.
#include "capi/capi_fixture.h"

#include <cstddef>
#include <cstdio>
#include <numeric>
#include <string>

namespace {

using namespace capi_fixture;

// Residues with and without insertion codes, two places of an atom, occupancies, deuterium, a ligand, water; the chain
// of the first atoms comes again behind the second chain; numbers below 0.
const char kPdb[] =
    "MODEL        7\n"
    "ATOM      1  N   ALA A  -1       1.000   2.000   3.000  1.00 10.00           N\n"
    "ATOM      2  CA AALA A  -1       2.400   2.000   3.000  0.60 20.00           C\n"
    "ATOM      3  CA BALA A  -1       2.400   2.500   3.000  0.40 30.00           C\n"
    "ATOM      4  D   ALA A   1       0.500   2.800   3.000  1.00  5.00           D\n"
    "ATOM      5  H   ALA A   1       0.500   3.800   3.000  0.00  5.00           H\n"
    "ATOM      6  O   GLY B  12C      5.000   2.000   3.000  1.00 40.00           O\n"
    "ATOM      7  O   GLY B  12       5.000   4.000   3.000  1.00 50.00           O\n"
    "TER\n"
    "HETATM    8 ZN    ZN B  99       8.000   2.000   3.000  1.00 15.00          ZN\n"
    "HETATM    9  O   HOH A 101      11.000   2.000  -3.500  1.00 60.00           O\n"
    "ENDMDL\n"
    "END\n";

struct CloseStructure {
  void operator()(qses_structure *structure) const { qses_structure_close(structure); }
};
using StructurePointer = std::unique_ptr<qses_structure, CloseStructure>;

StructurePointer open_text(const std::string &text, qses_structure_format format = QSES_STRUCTURE_PDB,
                           const char *selection = nullptr) {
  qses_structure_options options;
  qses_structure_options_init(&options);
  options.format = format;
  options.selection = selection;
  qses_structure *structure = nullptr;
  EXPECT_EQ(qses_structure_open_memory(text.data(), text.size(), &options, &structure), QSES_OK) << qses_last_error();
  return StructurePointer(structure);
}

qses_structure_description info_of(const StructurePointer &structure) {
  qses_structure_description info;
  qses_structure_description_init(&info);
  expect_ok(qses_structure_info(structure.get(), &info));
  return info;
}

// File indices of the atoms that a selection names.
std::vector<uint32_t> select(const StructurePointer &structure, const char *selection) {
  const qses_structure_description info = info_of(structure);
  std::vector<uint8_t> mask(info.atom_count, 7);
  uint32_t selected = 99;
  EXPECT_EQ(qses_structure_select(structure.get(), selection, mask.data(), mask.size(), &selected), QSES_OK)
      << selection << ": " << qses_last_error();
  std::vector<uint32_t> named;
  for (uint32_t k = 0; k < info.atom_count; ++k) {
    EXPECT_LE(mask[k], 1) << k;
    if (mask[k] == 1) named.push_back(info.file_indices[k]);
  }
  EXPECT_EQ(named.size(), selected);
  return named;
}

using Indices = std::vector<uint32_t>;

TEST(Selection, NamesAtoms) {
  const StructurePointer structure = open_text(kPdb);
  EXPECT_EQ(select(structure, ""), (Indices{0, 1, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(select(structure, "*"), (Indices{0, 1, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(select(structure, "//A"), (Indices{0, 1, 3, 4, 8}));
  EXPECT_EQ(select(structure, "//!A"), (Indices{5, 6, 7}));
  EXPECT_EQ(select(structure, "//A,B//O"), (Indices{5, 6, 8}));
  EXPECT_EQ(select(structure, "//*/(GLY,HOH)"), (Indices{5, 6, 8}));
  EXPECT_EQ(select(structure, "//*/(!HOH)"), (Indices{0, 1, 3, 4, 5, 6, 7}));
  EXPECT_EQ(select(structure, "//A/1-10"), (Indices{3, 4}));
  EXPECT_EQ(select(structure, "//B/12.C"), (Indices{5}));
  EXPECT_EQ(select(structure, "//B/12"), (Indices{6}));
  EXPECT_EQ(select(structure, "//B/12.*"), (Indices{5, 6}));
  EXPECT_EQ(select(structure, "//B/12.C-"), (Indices{5, 7}));
  EXPECT_EQ(select(structure, "//B/12;b>-1"), (Indices{6}));
  EXPECT_EQ(select(open_text(kPdb, QSES_STRUCTURE_PDB, "//A/1"), ""), (Indices{3, 4}));
  EXPECT_EQ(select(structure, "//*//CA[C]:A"), (Indices{1}));
  EXPECT_EQ(select(structure, "[D]"), (Indices{3}));
  EXPECT_EQ(select(structure, "[H]"), (Indices{4}));
  EXPECT_EQ(select(structure, "//*//;q<0.7"), (Indices{1, 4}));
  EXPECT_EQ(select(structure, "//*//;b>45"), (Indices{6, 8}));
  EXPECT_EQ(select(structure, "/7/A//N"), (Indices{0}));
  EXPECT_EQ(select(structure, "/1/A//N"), Indices{});  // the file calls its model 7
  EXPECT_EQ(select(structure, "//Z"), Indices{});
}

TEST(Selection, NamesAtomsByWords) {
  const StructurePointer structure = open_text(kPdb);
  EXPECT_EQ(select(structure, "protein and chain A"), (Indices{0, 1, 3, 4}));
  EXPECT_EQ(select(structure, "ions or water"), (Indices{7, 8}));
  EXPECT_EQ(select(structure, "within 3.7 of (ZN) or //A//N"), (Indices{0, 5, 6, 7}));
  EXPECT_EQ(select(structure, "resid -5-1 12C"), (Indices{0, 1, 3, 4, 5}));
  EXPECT_EQ(select(structure, "ligand"), Indices{});
  EXPECT_EQ(select(open_text(kPdb, QSES_STRUCTURE_PDB, "not protein"), ""), (Indices{7, 8}));
}

TEST(Selection, KindsAreThoseOfTheWholeFile) {
  // One atom of the residue is left, a metal, which does not make it an ion.
  std::string text = kPdb;
  text.replace(text.find("TER\n"), 4,
               "HETATM    8 FE   HEM B  50       8.000   9.000   3.000  1.00 15.00          FE\n"
               "HETATM    8  NA  HEM B  50       8.000   9.000   5.000  1.00 15.00           N\n");
  EXPECT_EQ(select(open_text(text, QSES_STRUCTURE_PDB, "[FE]"), "ions"), Indices{});
  EXPECT_EQ(select(open_text(text, QSES_STRUCTURE_PDB, "[FE]"), "ligand"), (Indices{7}));
}

// What the filter keeps is what a selection names afterwards.
TEST(Selection, NamesWhatTheFilterKeeps) {
  const StructurePointer structure = open_text(kPdb);
  for (const char *cid :
       {"//A",           "//!A",          "B",           "//*/(ALA)", "//A/-0",           "//A/.",
        "//B/12.*",      "//B/12-12.C",   "//B/12.C-99", "//A/1",     "//A/0-1",          "/7//",
        "//*//[!H,C]",   "//*//O[O]",     "//*//:A",     "//*//;q=1", "//*//;b<20;q>0.5", "//*//;polymer",
        "//*//;solvent", "//*//;!polymer"}) {
    SCOPED_TRACE(cid);
    qses_structure_options options;
    qses_structure_options_init(&options);
    options.format = QSES_STRUCTURE_PDB;
    options.selection = cid;
    qses_structure *opened = nullptr;
    const qses_status status = qses_structure_open_memory(kPdb, sizeof kPdb - 1, &options, &opened);
    const StructurePointer filtered(opened);
    if (status == QSES_OK) {
      EXPECT_EQ(select(structure, cid), select(filtered, ""));
      EXPECT_EQ(select(filtered, cid), select(filtered, ""));
    } else {
      EXPECT_EQ(select(structure, cid), Indices{}) << qses_last_error();  // no atom would be left
    }
  }
}

TEST(Selection, OfAnAssemblyAndOfLocations) {
  std::string text = "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n";
  for (int operation = 1; operation <= 2; ++operation)
    for (int row = 1; row <= 3; ++row) {
      char line[96];
      std::snprintf(line, sizeof line, "REMARK 350   BIOMT%d%4d%10.6f%10.6f%10.6f     %10.5f\n", row, operation,
                    row == 1 ? 1.0 : 0.0, row == 2 ? 1.0 : 0.0, row == 3 ? 1.0 : 0.0,
                    row == 1 ? 100.0 * (operation - 1) : 0.0);
      text += line;
    }
  text += kPdb;
  qses_structure_options options;
  qses_structure_options_init(&options);
  EXPECT_EQ(options.assembly, nullptr);
  EXPECT_EQ(options.altloc, nullptr);
  options.format = QSES_STRUCTURE_PDB;
  options.assembly = "1";
  options.altloc = "B";
  qses_structure *opened = nullptr;
  ASSERT_EQ(qses_structure_open_memory(text.data(), text.size(), &options, &opened), QSES_OK) << qses_last_error();
  const StructurePointer structure(opened);
  const qses_structure_description info = info_of(structure);
  EXPECT_EQ(info.file_atom_count, 12u);  // twice chain A, which has six records
  EXPECT_EQ(select(structure, ""), (Indices{0, 2, 3, 4, 5, 6, 8, 9, 10, 11}));
  EXPECT_EQ(select(structure, "chain A2 and name CA"), (Indices{8}));
  EXPECT_EQ(info.positions[3 * 6], 102.4f);
  EXPECT_EQ(info.positions[3 * 6 + 1], 2.5f);  // the location B
  options.assembly = "2";
  expect_error(qses_structure_open_memory(text.data(), text.size(), &options, &opened), QSES_INVALID_ARGUMENT,
               {"assembly '2'", "there is 1"});
  options.assembly = nullptr;
  options.altloc = "lowest";
  expect_error(qses_structure_open_memory(text.data(), text.size(), &options, &opened), QSES_INVALID_ARGUMENT,
               {"'lowest'", "highest"});
  // A caller that was compiled with a header that ended before them.
  options.struct_size = offsetof(qses_structure_options, assembly);
  ASSERT_EQ(qses_structure_open_memory(text.data(), text.size(), &options, &opened), QSES_OK) << qses_last_error();
  EXPECT_EQ(info_of(StructurePointer(opened)).file_atom_count, 9u);
}

TEST(Selection, OnlyFindsWhatWasKept) {
  const StructurePointer some = open_text(kPdb, QSES_STRUCTURE_PDB, "//A");
  EXPECT_EQ(select(some, "//B"), Indices{});
  EXPECT_EQ(select(some, "//*//O"), (Indices{8}));
}

TEST(Selection, Errors) {
  const StructurePointer structure = open_text(kPdb);
  std::vector<uint8_t> mask(8, 7);
  const auto refused = [&](const char *selection, std::initializer_list<const char *> words) {
    expect_error(qses_structure_select(structure.get(), selection, mask.data(), mask.size(), nullptr),
                 QSES_INVALID_ARGUMENT, words);
    EXPECT_EQ(mask, std::vector<uint8_t>(8, 7));
  };
  refused("//[[", {"selection", "//[[", "understood"});
  refused("//A/(ALA", {"//A/(ALA", "understood"});
  refused("//*//[Qq]", {"//*//[Qq]", "element"});
  refused("//A/10-x", {"//A/10-x"});
  refused("protien or water", {"'protien' at character 1 ", "did you mean 'protein'?"});
  refused(nullptr, {"selection", "NULL"});
  // However long it is, what is wrong with it is told.
  std::string many = "chain A";
  for (int k = 0; k < 1000; ++k) many += " or chain \xc3\x84";
  refused((many + " or").c_str(), {"'chain A or ", " ... ", " or'", "something is missing at its end"});
  refused(("protein and " + std::string(5000, 'x')).c_str(), {"xxx ... xxx", "is no word of selections; is it a name"});
  const auto select_all = [&](size_t count) {
    return qses_structure_select(structure.get(), "", mask.data(), count, nullptr);
  };
  expect_error(select_all(7), QSES_INVALID_ARGUMENT, {"count is 7", "8 atoms"});
  expect_error(select_all(9), QSES_INVALID_ARGUMENT, {"count is 9", "8 atoms"});
  expect_error(qses_structure_select(structure.get(), "", nullptr, 8, nullptr), QSES_INVALID_ARGUMENT,
               {"mask", "NULL"});
  expect_error(qses_structure_select(nullptr, "", mask.data(), 8, nullptr), QSES_INVALID_ARGUMENT,
               {"structure", "NULL"});
  EXPECT_EQ(mask, std::vector<uint8_t>(8, 7));
  expect_ok(select_all(8));
  EXPECT_EQ(mask, std::vector<uint8_t>(8, 1));
}

TEST(Selection, FilesWithoutNames) {
  const StructurePointer structure = open_text("0 0 0 1.25\n3 0 0 2.5\n", QSES_STRUCTURE_XYZR);
  EXPECT_EQ(select(structure, ""), (Indices{0, 1}));
  uint8_t mask[2] = {7, 7};
  expect_error(qses_structure_select(structure.get(), "//A", mask, 2, nullptr), QSES_INVALID_ARGUMENT, {"no names"});
  EXPECT_EQ(mask[0], 7);
}

TEST(Selection, ResiduesOfAtoms) {
  const StructurePointer structure = open_text(kPdb);
  const uint32_t *residues = info_of(structure).residues;
  EXPECT_EQ(Indices(residues, residues + 8), (Indices{0, 0, 1, 1, 2, 3, 4, 5}));
  const StructurePointer nameless = open_text("0 0 0 1.25\n3 0 0 2.5\n", QSES_STRUCTURE_XYZR);
  residues = info_of(nameless).residues;
  EXPECT_EQ(Indices(residues, residues + 2), (Indices{0, 1}));
}

TEST(Selection, MemoryIsTold) {
  std::string many;
  for (int i = 0; i < 1000; ++i)
    many += "ATOM      1  N   ALA A   1       1.000   2.000   3.000  1.00 10.00           N\n";
  const qses_structure_description few = info_of(open_text(kPdb)), more = info_of(open_text(many));
  // Positions, radii, index, element; names are three strings.
  EXPECT_GT(more.memory, 1000 * (3 * 4 + 4 + 4 + 1 + 3 * sizeof(char *)));
  EXPECT_LT(more.memory, 1000 * 1000u);
  EXPECT_GT(few.memory, 0u);
  EXPECT_LT(few.memory, more.memory);
}

}  // namespace
