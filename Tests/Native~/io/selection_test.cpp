// SPDX-License-Identifier: MIT
// Selections by words and by CID: what each names, against what the file says, gemmi says, or counting by hand says.
#include "io/selection.h"

#include <gemmi/pdb.hpp>
#include <random>
#include <set>

#include "io/io_fixture.h"
#include "io/near_atoms.h"
#include "io/nearest_word.h"
#include "io/structure.h"
#include "io/text.h"

namespace quickses::io {
namespace {

using Indices = std::vector<uint32_t>;

// A modified amino acid in the chain (MSE), one that no table knows (XYZ), a cap; an amino acid as a ligand; a
// nucleotide, ions, water, a ligand of one atom; insertion codes, numbers below 0, locations, deuterium.
const char kPdb[] =
    "ATOM      1  C   ACE A  -2       0.000   0.000   0.000  1.00 10.00           C\n"
    "ATOM      2  N   ALA A  -1       1.000   0.000   0.000  1.00 10.00           N\n"
    "ATOM      3  CA AALA A  -1       2.000   0.000   0.000  0.60 20.00           C\n"
    "ATOM      4  CA BALA A  -1       2.000   0.500   0.000  0.40 30.00           C\n"
    "ATOM      5  CB  ALA A  -1       3.000   0.000   0.000  1.00 20.00           C\n"
    "ATOM      6  HA  ALA A  -1       4.000   0.000   0.000  1.00  5.00           H\n"
    "HETATM    7 SE   MSE A  52       5.000   0.000   0.000  1.00  5.00          SE\n"
    "HETATM    8  CA  MSE A  52       6.000   0.000   0.000  1.00  5.00           C\n"
    "ATOM      9  C   GLY A  52A      7.600   0.000   0.000  1.00  5.00           C\n"
    "ATOM     10  D   GLY A  52A      8.000   0.000   0.000  1.00  5.00           D\n"
    "HETATM   11  N   XYZ A  53       9.000   0.000   0.000  1.00  5.00           N\n"
    "HETATM   12  CA  XYZ A  53      10.000   0.000   0.000  1.00  5.00           C\n"
    "HETATM   13  C   XYZ A  53      11.000   0.000   0.000  1.00  5.00           C\n"
    "TER\n"
    "ATOM     14  P    DA B  12      20.000   0.000   0.000  1.00 40.00           P\n"
    "ATOM     15  C1'  DA B  12      21.000   0.000   0.000  1.00 40.00           C\n"
    "ATOM     16  N9   DA B  12      22.000   0.000   0.000  1.00 40.00           N\n"
    "TER\n"
    "HETATM   17 FE   HEM A 101      30.000   0.000   0.000  1.00 15.00          FE\n"
    "HETATM   18  NA  HEM A 101      31.000   0.000   0.000  1.00 15.00           N\n"
    "HETATM   19 CA    CA A 102      40.000   0.000   0.000  1.00 15.00          CA\n"
    "HETATM   20 CL    CL B 103      41.000   0.000   0.000  1.00 15.00          CL\n"
    "HETATM   21  N   GLY A 104      50.000   0.000   0.000  1.00 15.00           N\n"
    "HETATM   22  CA  GLY A 104      51.000   0.000   0.000  1.00 15.00           C\n"
    "HETATM   23 XE   XE  A 105      60.000   0.000   0.000  1.00 15.00          XE\n"
    "HETATM   24  S   SO4 B 106      70.000   0.000   0.000  1.00 15.00           S\n"
    "HETATM   25  O   HOH A 201      80.000   0.000   0.000  1.00 60.00           O\n"
    "HETATM   26  H1  HOH A 201      81.000   0.000   0.000  1.00 60.00           H\n"
    "END\n";

Structure parse(const std::string &text = kPdb, const ReadOptions &options = ReadOptions()) {
  return parse_structure(text, StructureFormat::kPdb, options).models.at(0);
}

// Numbers of the file, from 1, of the atoms that a selection names.
Indices numbers_of(const Structure &structure, const std::string &selection) {
  std::vector<uint8_t> mask(structure.atoms.size(), 7);
  const uint32_t count = select_atoms(structure, selection, mask.data());
  Indices numbers;
  for (size_t i = 0; i < mask.size(); ++i)
    if (mask[i]) numbers.push_back(structure.atoms[i].file_index + 1);
  EXPECT_EQ(numbers.size(), count) << selection;
  return numbers;
}

Indices select(const std::string &selection) { return numbers_of(parse(), selection); }

Indices kept_by(const std::string &selection, ReadOptions options = ReadOptions()) {
  options.selection = selection;
  return numbers_of(parse(kPdb, options), "");
}

const Indices kAll = {1, 2, 3, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26};

TEST(SelectionWords, NameKindsOfResidues) {
  EXPECT_EQ(select("all"), kAll);
  EXPECT_EQ(select(" \t "), kAll);
  EXPECT_EQ(select(u8"\u00a0\n"), kAll);
  EXPECT_EQ(select(u8"not\u00a0\u00a0water\u00a0"), select("not water"));
  EXPECT_EQ(select("none"), Indices{});
  EXPECT_EQ(select("protein"), (Indices{1, 2, 3, 5, 6, 7, 8, 9, 10, 11, 12, 13}));
  EXPECT_EQ(select("nucleic"), (Indices{14, 15, 16}));
  EXPECT_EQ(select("ligand"), (Indices{17, 18, 21, 22, 23, 24}));
  EXPECT_EQ(select("ions"), (Indices{19, 20}));
  EXPECT_EQ(select("water"), (Indices{25, 26}));
  EXPECT_EQ(select("solvent"), (Indices{25, 26}));
  EXPECT_EQ(select("hydrogen"), (Indices{6, 10, 26}));
  EXPECT_EQ(select("hetero"), (Indices{7, 8, 11, 12, 13, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26}));
  EXPECT_EQ(select("backbone"), (Indices{1, 2, 3, 6, 8, 9, 10, 11, 12, 13, 14, 15}));
  EXPECT_EQ(select("sidechain"), (Indices{5, 7, 16}));
}

TEST(SelectionWords, NameWhatTheFileCallsIt) {
  EXPECT_EQ(select("chain B"), (Indices{14, 15, 16, 20, 24}));
  EXPECT_EQ(select("chain B A"), kAll);
  EXPECT_EQ(select("chain B,A"), kAll);
  EXPECT_EQ(select("chain b"), Indices{});  // names are as in the file
  EXPECT_EQ(select("resname HEM"), (Indices{17, 18}));
  EXPECT_EQ(select("resn HEM CA"), (Indices{17, 18, 19}));
  EXPECT_EQ(select("name CA"), (Indices{3, 8, 12, 19, 22}));
  EXPECT_EQ(select("name CA C1'"), (Indices{3, 8, 12, 15, 19, 22}));
  EXPECT_EQ(select("element CA Fe se"), (Indices{7, 17, 19}));
  EXPECT_EQ(select("element H"), (Indices{6, 26}));
  EXPECT_EQ(select("element D"), (Indices{10}));
  EXPECT_EQ(select("resid 52"), (Indices{7, 8}));
  EXPECT_EQ(select("resi 52A"), (Indices{9, 10}));
  EXPECT_EQ(select("resid 52-53"), (Indices{7, 8, 9, 10, 11, 12, 13}));
  EXPECT_EQ(select("resid 52A-53"), (Indices{9, 10, 11, 12, 13}));
  EXPECT_EQ(select("resid -2--1"), (Indices{1, 2, 3, 5, 6}));
  EXPECT_EQ(select("resid -1-12"), (Indices{2, 3, 5, 6, 14, 15, 16}));
  EXPECT_EQ(select("resid -1 53,101"), (Indices{2, 3, 5, 6, 11, 12, 13, 17, 18}));
  EXPECT_EQ(select("index 0 4-6"), (Indices{1, 5, 6, 7}));
}

TEST(SelectionWords, Locations) {
  EXPECT_EQ(kept_by("altloc B"), (Indices{4}));
  EXPECT_EQ(kept_by("resid -1 and not altloc A"), (Indices{2, 4, 5, 6}));
  EXPECT_EQ(select("altloc B"), Indices{});  // it was left out when the file was read
}

TEST(SelectionWords, AreJoined) {
  EXPECT_EQ(select("not protein and hydrogen"), (Indices{26}));  // not before and before or
  EXPECT_EQ(select("water or protein and chain B"), (Indices{25, 26}));
  EXPECT_EQ(select("(water or protein) and chain B"), Indices{});
  EXPECT_EQ(select("not (water or protein or ligand)"), (Indices{14, 15, 16, 19, 20}));
  EXPECT_EQ(select("NOT(Water OR protein or LIGAND)"), (Indices{14, 15, 16, 19, 20}));
  EXPECT_EQ(select("not not ions"), (Indices{19, 20}));
  EXPECT_EQ(select("chain A and name CA and not (ligand or ions)"), (Indices{3, 8, 12}));
  EXPECT_EQ(select("same residue as name N9"), (Indices{14, 15, 16}));
  EXPECT_EQ(select("same residue as within 1.5 of resname HEM and element N"), (Indices{18}));
  EXPECT_EQ(select("same residue as (within 1.5 of resname HEM and element N)"), (Indices{17, 18}));
}

TEST(SelectionWords, NearOthers) {
  EXPECT_EQ(select("within 1 of index 4"), (Indices{3, 5, 6}));  // the distance itself is near
  EXPECT_EQ(select("within 0 of (HEM)"), (Indices{17, 18}));
  EXPECT_EQ(select("within 9.5 of (HEM)"), (Indices{15, 16, 17, 18, 19}));
  EXPECT_EQ(select("within 9.5 of (HEM) and not (HEM)"), (Indices{15, 16, 19}));
  EXPECT_EQ(select("within 10 of none"), Indices{});
  EXPECT_EQ(select("within 1e6 of ions"), kAll);
  // What filters leave out is there to be near to.
  ReadOptions no_hetero;
  no_hetero.hetero = false;
  EXPECT_EQ(kept_by("within 9 of (HEM)", no_hetero), (Indices{15, 16}));
}

TEST(SelectionWords, CidTermsAreOperands) {
  EXPECT_EQ(select("//A and water"), (Indices{25, 26}));
  EXPECT_EQ(select("//B//N9 or (HEM)/FE or [CL]"), (Indices{16, 17, 20}));
  EXPECT_EQ(select("(//B and nucleic)"), (Indices{14, 15, 16}));
  EXPECT_EQ(select("not (!HOH)"), (Indices{25, 26}));
  EXPECT_EQ(select("52-53 and (MSE)"), (Indices{7, 8}));
  EXPECT_EQ(select("//*//;b>45 and hydrogen"), (Indices{26}));
  EXPECT_EQ(select("10(MSE,GLY)-60 and hetero"), (Indices{7, 8}));
}

// A word alone, or alone in parentheses, was a chain or a residue name before there were words, and stays one.
TEST(SelectionWords, GiveWayToNamesOfTheFile) {
  std::string text = kPdb;
  EXPECT_EQ(numbers_of(parse(text), "(ALL)"), kAll);
  for (size_t at; (at = text.find("SO4")) != std::string::npos;) text.replace(at, 3, "ALL");  // allopyranose
  const Structure structure = parse(text);
  EXPECT_EQ(numbers_of(structure, "(ALL)"), (Indices{24}));
  EXPECT_EQ(numbers_of(structure, "not (ALL) and hetero and chain B"), (Indices{20}));
  EXPECT_EQ(numbers_of(structure, "(all)"), kAll);
  EXPECT_EQ(numbers_of(structure, "ALL"), kAll);  // no chain has this name

  const std::string loop =
      "data_a\nloop_\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n_atom_site.label_comp_id\n"
      "_atom_site.label_asym_id\n_atom_site.label_seq_id\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n";
  const Structure chains =
      parse_structure(loop + "1 C C1 ABC ions 1 0 0 0\n2 ZN ZN ZN B 2 9 0 0\n", StructureFormat::kMmcif).models.at(0);
  EXPECT_EQ(numbers_of(chains, "ions"), (Indices{1}));
  EXPECT_EQ(numbers_of(chains, "ions or none"), (Indices{2}));
  EXPECT_EQ(numbers_of(chains, "Ions"), (Indices{2}));
}

// gemmi, asked for its own atoms.
TEST(SelectionCid, IsWhatGemmiSays) {
  const gemmi::Structure theirs = gemmi::read_pdb_from_memory(kPdb, sizeof kPdb - 1, "theirs");
  for (const char *cid : {"*",
                          "/",
                          "//",
                          "/1",
                          "/2",
                          "//A",
                          "//!A",
                          "A",
                          "B",
                          "A,B",
                          "//A,B//O",
                          "//*/(GLY,HOH)",
                          "(GLY)",
                          "(!GLY)",
                          "(HEM)",
                          "(HEM)/FE",
                          "//A/-0",
                          "10-40",
                          "-60",
                          "52.A-53",
                          "52A-53",
                          "//A/52.*-52.*",
                          "//A/52-52.A",
                          "//B/12.C-99",
                          "//A/.",
                          "CA[C]",
                          "[CA]",
                          "[!H,C]",
                          "//*//:A",
                          "//*//CA:B",
                          "//*//;q=1",

                          "//*//;b<20;q>0.5",
                          "//*//; b<20",
                          "//*//;polymer",
                          "//*//;solvent",
                          "//*//;!polymer",
                          "A;b>15",
                          "//A/(GLY)/CA",
                          "(HEM).",
                          "//*/50(GLY)-60/CA",
                          "()",
                          "within",
                          "protein,water"}) {
    SCOPED_TRACE(cid);
    const gemmi::Selection selection(cid);
    std::set<uint32_t> expected;
    for (const gemmi::Model &model : theirs.models)
      if (selection.matches(model))
        for (const gemmi::Chain &chain : model.chains)
          if (selection.matches(chain))
            for (const gemmi::Residue &residue : chain.residues)
              if (selection.matches(residue))
                for (const gemmi::Atom &atom : residue.atoms)
                  if (selection.matches(atom)) expected.insert(static_cast<uint32_t>(atom.serial));
    if (selection.altlocs.all) expected.erase(4);  // the second location
    if (std::string(cid) == "within") continue;    // a word that wants more behind it: see below
    if (expected.empty())
      EXPECT_HAS(error_of(ErrorKind::kInput, [&] { kept_by(cid); }), "names none");
    else
      EXPECT_EQ(kept_by(cid), Indices(expected.begin(), expected.end()));
  }
}

TEST(SelectionWords, ErrorsPointAtTheWord) {
  const auto refused = [](const std::string &selection, std::initializer_list<const char *> parts) {
    SCOPED_TRACE(selection);
    const std::string message = error_of(ErrorKind::kUsage, [&] { kept_by(selection); });
    EXPECT_HAS(message, "the selection '" + excerpt_of(selection) + "' can't be understood");
    for (const char *part : parts) EXPECT_HAS(message, part);
    EXPECT_EQ(error_of(ErrorKind::kUsage, [&] { select(selection); }), message);
  };
  refused("protien and chain A", {"'protien'", "character 1 ", "did you mean 'protein'?"});
  refused("chain A and not hidrogen", {"'hidrogen'", "character 17 ", "did you mean 'hydrogen'?"});
  refused("watre", {"'watre'", "did you mean 'water'?"});
  refused("(watre or ions)", {"'watre'", "character 2 ", "did you mean 'water'?"});
  refused("HEM or water", {"'HEM'", "character 1 ", "resname HEM"});
  refused("water adn ions", {"'and' or 'or' is missing before 'adn'", "character 7"});
  refused("within five of ligand", {"'within' wants a distance", "'five'", "character 8"});
  refused("within -1 of ligand", {"distance", "'-1'"});
  refused("within 1e7 of ligand", {"distance"});
  refused("within nan of ligand", {"distance"});
  refused("within", {"distance", "within 5 of ligand"});
  refused("within 5 ligand", {"'of' is missing", "character 10"});
  refused("same residue ligand", {"'as' is missing", "character 14"});
  refused("chain", {"'chain' wants names"});
  refused("protein and name", {"'name' wants names", "name CA CB"});
  refused("chain A water", {"'and' or 'or' is missing before 'water'", "character 9"});
  refused("(protein or water", {"'(' is not closed", "character 1)"});
  refused("protein or (water and (ions)", {"'(' is not closed", "character 12)"});
  refused("protein) or water", {"')' closes no '('", "character 8"});
  refused("() or water", {"missing before ')'"});
  refused("protein and", {"missing at its end"});
  refused("and protein", {"missing before 'and'"});
  refused("resid 10-x", {"'10-x'", "character 7"});
  refused("resid 40-10", {"backwards"});
  refused("resid 99999999999", {"residue number"});
  refused("index -1", {"'-1'"});
  refused("index 5-2", {"backwards"});
  refused("element Qq", {"'Qq'"});
  refused("altloc AB", {"'AB'"});
  refused("not name \"CA\"", {"without quotation marks", "character 10"});
  refused("name 'CA CB'", {"without quotation marks", "character 6"});
  refused("chain A,\"B\"", {"without quotation marks"});
  refused("water and //[[", {"[["});
  refused(u8"chain \u00c4 \u00d6 and protien", {"'protien' at character 15 "});  // not bytes
  refused(u8"chain \u00c4 or (", {"'(' is not closed (at character 12)"});
  refused(std::string(2000, '(') + "all" + std::string(2000, ')'), {"in each other"});
  std::string nots;
  for (int k = 0; k < 1000; ++k) nots += "not ";
  refused(nots + "all", {"in each other"});
}

TEST(SelectionWords, WildcardsAreRefusedUnlessTheyAreNames) {
  for (const char *selection : {"not name H*", "name CA H*", "resname H?M", "chain *", "water or not chain A,?"})
    EXPECT_HAS(error_of(ErrorKind::kUsage, [&] { select(selection); }), "wildcards") << selection;
  std::string text = kPdb;
  text.replace(text.find("C1'"), 3, "C1*");
  EXPECT_EQ(numbers_of(parse(text), "name C1* N9"), (Indices{15, 16}));
}

TEST(SelectionWords, NothingNamedIsExplained) {
  const std::string message = error_of(ErrorKind::kInput, [] { kept_by("chain Q"); });
  for (const char *part : {"'chain Q' names none", "chains A and B", "protein, nucleic, ligand (HEM, GLY, XE and SO4)",
                           "ions (CA and CL)", "water", "//A"})
    EXPECT_HAS(message, part);
}

// ---- random trees of words, evaluated by hand

struct Tree {
  std::string text;
  std::vector<uint8_t> mask;
};

class Trees {
 public:
  explicit Trees(const Structure &structure) : structure_(structure) {}

  Tree make(int depth) {
    if (depth == 0 || pick(4) == 0) return leaf();
    Tree tree = make(depth - 1);
    switch (pick(3)) {
      case 0:
        for (uint8_t &named : tree.mask) named = !named;
        return {(pick(2) ? "not (" : "not  ( ") + tree.text + ")", tree.mask};
      case 1: {
        const int distance = 1 + pick(12);
        std::vector<uint8_t> near(tree.mask.size());
        for (size_t i = 0; i < near.size(); ++i)
          for (size_t j = 0; j < near.size(); ++j) {
            double square = 0;
            for (size_t axis = 0; axis < 3; ++axis) {
              const double difference = double(structure_.positions[3 * i + axis]) - structure_.positions[3 * j + axis];
              square += difference * difference;
            }
            if (tree.mask[j] && square <= distance * distance) near[i] = 1;
          }
        return {"within " + std::to_string(distance) + " of (" + tree.text + ")", near};
      }
      default: {
        const Tree other = make(depth - 1);
        const bool both = pick(2) == 0;
        for (size_t i = 0; i < tree.mask.size(); ++i)
          tree.mask[i] = both ? tree.mask[i] && other.mask[i] : tree.mask[i] || other.mask[i];
        return {"(" + tree.text + (both ? ") and (" : ") or (") + other.text + ")", tree.mask};
      }
    }
  }

 private:
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }

  Tree leaf() {
    const AtomInfo &some = structure_.atoms[static_cast<size_t>(pick(static_cast<int>(structure_.atoms.size())))];
    Tree tree;
    const auto fill = [&](const std::string &text, const std::function<bool(const AtomInfo &)> &condition) {
      tree.text = text;
      for (const AtomInfo &atom : structure_.atoms) tree.mask.push_back(condition(atom));
      return tree;
    };
    switch (pick(5)) {
      case 0:
        return fill("chain " + some.chain, [&](const AtomInfo &atom) { return atom.chain == some.chain; });
      case 1:
        return fill("resname " + some.residue_name,
                    [&](const AtomInfo &atom) { return atom.residue_name == some.residue_name; });
      case 2:
        return fill("name  " + some.name, [&](const AtomInfo &atom) { return atom.name == some.name; });
      case 3:
        return fill("hetero", [](const AtomInfo &atom) { return atom.hetero; });
      default:
        return fill("(" + some.residue_name + ")",
                    [&](const AtomInfo &atom) { return atom.residue_name == some.residue_name; });
    }
  }

  const Structure &structure_;
  std::mt19937 random_{20240607};
};

TEST(SelectionWords, RandomTrees) {
  const Structure structure = parse();
  Trees trees(structure);
  std::set<size_t> counts;
  for (int k = 0; k < 500; ++k) {
    const Tree tree = trees.make(4);
    std::vector<uint8_t> mask(structure.atoms.size());
    counts.insert(select_atoms(structure, tree.text, mask.data()));
    ASSERT_EQ(mask, tree.mask) << tree.text;
  }
  EXPECT_GT(counts.size(), 10u);
}

// Whatever is said, there is an answer or an error, and never a crash.
TEST(SelectionWords, RandomText) {
  const Structure structure = parse();
  const char *const kPieces[] = {"(",       ")",   " ",   "all",  "chain", "A",     "within",  "5",  "of",
                                 "not",     "and", "or",  "//",   "resi",  "10-40", "-",       "[",  "]",
                                 "*",       ";",   "b<5", "!",    "water", "same",  ".",       ":",  ",",
                                 "residue", "as",  "HEM", "\x01", "\xff",  "index", "element", "52A"};
  std::mt19937 random(7);
  std::vector<uint8_t> mask(structure.atoms.size());
  int understood = 0;
  for (int k = 0; k < 20000; ++k) {
    std::string text;
    for (unsigned n = random() % 12; n > 0; --n) text += kPieces[random() % (sizeof kPieces / sizeof *kPieces)];
    try {
      select_atoms(structure, text, mask.data());
      ++understood;
    } catch (const Error &error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUsage) << text;
    }
  }
  EXPECT_GT(understood, 1000);
}

// ---- what is near

TEST(AtomsNear, ByBruteForce) {
  std::mt19937 random(3);
  for (const double extent : {1.0, 30.0, 300.0, 9e5})
    for (const double distance : {0.0, 0.01, 1.0, 3.9, 5.0, 16.5, 70.0, 1000.0, 1e6}) {
      std::uniform_real_distribution<float> place(static_cast<float>(-extent), static_cast<float>(extent));
      std::vector<float> positions(3 * 500);
      std::vector<uint8_t> set(500), expected(500);
      for (float &x : positions) x = place(random);
      for (size_t i = 0; i < 500; ++i) set[i] = random() % 8 == 0;
      for (size_t i = 0; i < 50; ++i)  // some just there
        for (size_t axis = 0; axis < 3; ++axis)
          positions[3 * i + axis] = positions[3 * (i + 50) + axis] + (axis == 0 ? static_cast<float>(distance) : 0);
      for (size_t i = 0; i < 500; ++i)
        for (size_t j = 0; j < 500; ++j) {
          double square = 0;
          for (size_t axis = 0; axis < 3; ++axis) {
            const double difference = double(positions[3 * i + axis]) - double(positions[3 * j + axis]);
            square += difference * difference;
          }
          const bool far = std::fabs(positions[3 * i]) > 1e6f || std::fabs(positions[3 * j]) > 1e6f;
          if (set[j] && (i == j || (!far && square <= distance * distance))) expected[i] = 1;
        }
      EXPECT_EQ(atoms_near(positions, set, distance), expected) << extent << " " << distance;
    }
}

TEST(AtomsNear, FarAwayAndNothing) {
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> positions = {infinity, 0, 0, 0, 0, 0, 1, 0, 0};
  EXPECT_EQ(atoms_near(positions, {1, 0, 0}, 5), (std::vector<uint8_t>{1, 0, 0}));
  EXPECT_EQ(atoms_near(positions, {0, 1, 0}, 5), (std::vector<uint8_t>{0, 1, 1}));
  EXPECT_EQ(atoms_near({}, {}, 5), std::vector<uint8_t>());
  const std::vector<float> border = {1000000.5f, 0, 0, 1e6f, 0, 0, 999999.5f, 0, 0};
  EXPECT_EQ(atoms_near(border, {1, 0, 0}, 5), (std::vector<uint8_t>{1, 0, 0}));
  EXPECT_EQ(atoms_near(border, {0, 1, 0}, 5), (std::vector<uint8_t>{0, 1, 1}));
  EXPECT_EQ(atoms_near(border, {0, 0, 1}, 5), (std::vector<uint8_t>{0, 1, 1}));
}

TEST(NearestWord, IsTheOneThatWasMeant) {
  const std::vector<std::string> words = {"spacing", "surface", "slice", "steps", "color", "colors-only"};
  EXPECT_EQ(nearest_word("spacng", words), "spacing");
  EXPECT_EQ(nearest_word("Spacing", words), "spacing");
  EXPECT_EQ(nearest_word("psacing", words), "spacing");
  EXPECT_EQ(nearest_word("colour", words), "color");
  EXPECT_EQ(nearest_word("spac", words), "spacing");  // as it begins
  EXPECT_EQ(nearest_word("sl", words), "");
  EXPECT_EQ(nearest_word("probe", words), "");
  EXPECT_EQ(nearest_word("", words), "");
  EXPECT_EQ(nearest_word("spacing", {}), "");
  EXPECT_EQ(nearest_word(std::string(100000, 's'), words), "");
}

}  // namespace
}  // namespace quickses::io
