// SPDX-License-Identifier: MIT
// What residues are, in GRO files, which say nothing but names and places.
#include "io/residue_kinds.h"

#include <cstdio>
#include <string>
#include <vector>

#include "io/io_fixture.h"
#include "io/structure.h"

namespace quickses::io {
namespace {

struct Residue {
  const char *name;
  std::vector<const char *> atoms;
  double begin = 0;  // nm along x; atoms are 0.15 nm apart
};

Structure structure_of(const std::vector<Residue> &residues) {
  std::string lines;
  int atoms = 0, number = 0;
  for (const Residue &residue : residues) {
    ++number;
    double x = residue.begin;
    for (const char *atom : residue.atoms) {
      char line[64];
      std::snprintf(line, sizeof line, "%5d%-5s%5s%5d%8.3f%8.3f%8.3f\n", number, residue.name, atom, ++atoms, x, 0.0,
                    0.0);
      lines += line;
      x += 0.15;
    }
  }
  return parse_structure("t\n" + std::to_string(atoms) + "\n" + lines + "9 9 9\n", StructureFormat::kGro).models.at(0);
}

std::string kinds_of(const std::vector<Residue> &residues) {
  const Structure structure = structure_of(residues);
  const std::vector<uint32_t> numbers = residues_of(structure);
  std::string kinds;
  for (size_t i = 0; i < numbers.size(); ++i)
    if (i == 0 || numbers[i] != numbers[i - 1]) kinds += "LPNWI"[static_cast<int>(structure.atoms[i].kind)];
  return kinds;
}

const std::vector<const char *> kAminoAcid = {"N", "CA", "C"};
const std::vector<const char *> kNucleotide = {"P", "C1'", "C4'", "O3'"};

TEST(ResidueKinds, NamesUsedAgainAreToldByAtoms) {
  // Dehydroalanine and a chain of a lipid of Amber's; adenosine of Amber's and an inhibitor of neuraminidase.
  EXPECT_EQ(kinds_of({{"DHA", kAminoAcid}}), "P");
  EXPECT_EQ(kinds_of({{"DHA", {"C12", "O12", "C13", "H3R", "C14"}}}), "L");
  EXPECT_EQ(kinds_of({{"DAN", {"O5'", "C1'", "C4'"}}}), "N");
  EXPECT_EQ(kinds_of({{"DAN", {"C1", "O1A", "C2", "C4", "N5"}}}), "L");
  EXPECT_EQ(kinds_of({{"MSE", {"CA"}}, {"DA5", {"P"}}}), "PN");  // of one atom per residue
  EXPECT_EQ(kinds_of({{"ALA", {"CB", "HB1"}}, {"DA", {"N9", "C8"}}, {"ACE", {"CH3", "O"}}}), "PNP");
}

TEST(ResidueKinds, UnknownResiduesAreOfAChainIfABondJoinsThem) {
  EXPECT_EQ(kinds_of({{"XYZ", kAminoAcid}}), "L");
  EXPECT_EQ(kinds_of({{"XYZ", kAminoAcid, 0}, {"ALA", kAminoAcid, 0.43}}), "PP");
  EXPECT_EQ(kinds_of({{"ALA", kAminoAcid, 0}, {"XYZ", kAminoAcid, 0.43}}), "PP");
  EXPECT_EQ(kinds_of({{"ALA", kAminoAcid, 0}, {"XYZ", kAminoAcid, 0.51}, {"ALA", kAminoAcid, 2}}), "PLP");
  EXPECT_EQ(kinds_of({{"XYZ", kNucleotide}}), "L");
  EXPECT_EQ(kinds_of({{"DA", kNucleotide, 0}, {"XYZ", kNucleotide, 0.61}}), "NN");
  EXPECT_EQ(kinds_of({{"XYZ", {"P", "C1*", "C4*", "O3*"}, 0}, {"DA", kNucleotide, 0.61}}), "NN");
  // GTP and S-adenosylmethionine beside a protein.
  EXPECT_EQ(kinds_of({{"ALA", kAminoAcid},
                      {"GTP", {"PG", "PB", "PA", "C1'", "C4'", "O3'"}, 2},
                      {"SAM", {"N", "CA", "C", "C1'", "C4'", "O3'"}, 4}}),
            "PLL");
}

TEST(ResidueKinds, EndsOfProteinChainsAreBackbone) {
  for (const char *name : {"OC1", "OC2", "OT1", "OT2", "O1", "O2", "OXT", "H1", "H3", "HT1", "HN1", "HN3", "1H", "3H"})
    EXPECT_TRUE(is_backbone_name(ResidueKind::kProtein, name)) << name;
  for (const char *name : {"CB", "OG1", "HB1", "1HB", "OD1"})
    EXPECT_FALSE(is_backbone_name(ResidueKind::kProtein, name)) << name;
}

}  // namespace
}  // namespace quickses::io
