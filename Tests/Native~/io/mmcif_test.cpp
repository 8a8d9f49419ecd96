// SPDX-License-Identifier: MIT
// mmCIF files: entities, models, and how much of them there may be.
#include "io/structure_fixture.h"

namespace quickses::io {
namespace {

// Rows of _atom_site with these columns, beside the coordinates.
std::string table_of(const std::vector<const char *> &columns) {
  std::string text = "data_x\nloop_\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n";
  for (const char *column : columns) text += "_atom_site." + std::string(column) + "\n";
  return text;
}

StructureFile parse(const std::string &text, const ReadOptions &options = ReadOptions()) {
  return parse_structure(text, StructureFormat::kMmcif, options, "test.cif");
}

ReadOptions of_model(int model) {
  ReadOptions options;
  options.model = model;
  return options;
}

// Solvated systems, which PDB files are too narrow for. Comparing each residue with all of its chain would take
// minutes.
TEST(Mmcif, AChainOfManyResidues) {
  constexpr int kCount = 400000;
  std::string text = table_of({"auth_seq_id"});
  for (int k = 1; k <= kCount; ++k) text += "0 0 0 " + std::to_string(k) + "\n";
  const Structure structure = parse(text).models.at(0);
  ASSERT_EQ(structure.atoms.size(), static_cast<size_t>(kCount));
  EXPECT_EQ(structure.atoms.back().residue_number, kCount);
}

// A table of entities for each of the models would take gigabytes.
TEST(Mmcif, ManyModelsAndEntities) {
  constexpr int kCount = 10000;
  std::string text = table_of({"pdbx_PDB_model_num"});
  for (int k = 1; k <= kCount; ++k) text += std::to_string(k) + " 0 0 " + std::to_string(k) + "\n";
  text += "loop_\n_entity.id\n_entity.type\n";
  for (int k = 1; k <= kCount; ++k) text += std::to_string(k) + " polymer\n";
  const StructureFile file = parse(text, of_model(kCount));
  EXPECT_EQ(file.model_count, kCount);
  EXPECT_EQ(file.models.at(0).positions, (std::vector<float>{kCount, 0, 0}));
}

TEST(Mmcif, RowsOfModelsMayAlternate) {
  const std::string text = table_of({"pdbx_PDB_model_num"}) + "1 0 0 7\n2 0 0 3\n3 0 0 7\n";
  const StructureFile file = parse(text, of_model(0));
  ASSERT_EQ(file.models.size(), 2u);
  EXPECT_EQ(file.models[0].model_name, "7");
  EXPECT_EQ(file.models[0].positions, (std::vector<float>{1, 0, 0, 3, 0, 0}));
  EXPECT_EQ(file.models[1].positions, (std::vector<float>{2, 0, 0}));
  EXPECT_EQ(parse(text, of_model(2)).models.at(0).model, 2);
}

TEST(Mmcif, EntitiesTellResiduesOfAChainFromOthers) {
  const Structure structure = parse(table_of({"group_PDB", "label_atom_id", "label_comp_id", "label_asym_id",
                                              "auth_asym_id", "auth_seq_id", "label_entity_id"}) +
                                    "0 0 0 HETATM CA ALA A X 1 1\n"
                                    "9 0 0 HETATM CA ALA B X 2 2\n"
                                    "18 0 0 HETATM CA ALA C X 3 ?\n"
                                    "loop_\n_entity.id\n_entity.type\n1 polymer\n2 non-polymer\n")
                                  .models.at(0);
  EXPECT_EQ(structure.atoms.at(0).kind, ResidueKind::kProtein);
  EXPECT_EQ(structure.atoms.at(1).kind, ResidueKind::kLigand);
  EXPECT_EQ(structure.atoms.at(2).kind, ResidueKind::kLigand);
  EXPECT_EQ(structure.atoms.at(2).chain, "X");
}

TEST(Mmcif, InsertionCodesHaveAColumnOrAreBehindTheNumber) {
  const Structure structure =
      parse(table_of({"auth_seq_id", "pdbx_PDB_ins_code"}) + "0 0 0 52 A\n1 0 0 52B ?\n2 0 0 52 ?\n3 0 0 ? ?\n")
          .models.at(0);
  std::string codes;
  for (const AtomInfo &atom : structure.atoms) codes += atom.insertion_code;
  EXPECT_EQ(codes, "AB  ");
  EXPECT_EQ(structure.atoms[1].residue_number, 52);
  EXPECT_FALSE(structure.atoms[3].has_residue_number());
  EXPECT_HAS(error_of(ErrorKind::kInput, [] { parse(table_of({"auth_seq_id"}) + "0 0 0 1\n0 0 0 first\n"); }),
             "atom 2 of _atom_site: the residue number 'first'");
}

// As files of ligands, of small molecules and of reflections.
TEST(Mmcif, FilesWithoutCoordinatesSayWhatIsMissing) {
  for (const std::string text :
       {"data_ATP\nloop_\n_chem_comp_atom.atom_id\n_chem_comp_atom.model_Cartn_x\nPG 1\n",
        "data_x\nloop_\n_atom_site_label\n_atom_site_fract_x\nC1 0.5\n", "data_r1abcsf\n_cell.length_a 5\n",
        "data_x\nloop_\n_atom_site.id\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n1 2 3\n"})
    EXPECT_HAS(error_of(ErrorKind::kInput, [&] { parse(text); }),
               "'test.cif' has no atoms: nowhere in it has _atom_site Cartn_x, Cartn_y and Cartn_z");
}

}  // namespace
}  // namespace quickses::io
