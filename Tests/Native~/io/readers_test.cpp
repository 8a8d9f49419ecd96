// SPDX-License-Identifier: MIT
// What all readers of structures share. Names of atoms, residues and chains are written to terminals: whatever is in
// the file, they are printable ASCII.
#include "io/readers.h"  // first: settles how gemmi formats numbers

#include "io/limits.h"
#include "io/structure_fixture.h"

namespace quickses::io {
namespace {

void expect_printable(const std::string &text, StructureFormat format) {
  const Structure structure = parse_structure(text, format).models.at(0);
  for (const AtomInfo &atom : structure.atoms)
    for (const std::string &name : {atom.name, atom.residue_name, atom.chain})
      for (const char c : name) EXPECT_TRUE(c > ' ' && c <= '~') << name;
  for (const char c : structure.model_name) EXPECT_TRUE(c > ' ' && c <= '~') << structure.model_name;
}

TEST(Readers, NamesArePrintable) {
  expect_printable("ATOM      1 C\x1b\xff\x7f \x1b[2J\x07   1       0.000   0.000   0.000  1.00  0.00           C\n",
                   StructureFormat::kPdb);
  expect_printable(
      "ATOM 1 C\x1b \xff\x1b[2J \x9b"
      "A 1 0 0 0 0 1\n",
      StructureFormat::kPqr);
  expect_printable("t\n1\n    1\x1b[2J   C\x9b\xff    1   0.125   1.000  -2.000\n 5 5 5\n", StructureFormat::kGro);
  expect_printable(
      "data_x\nloop_\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n_atom_site.label_atom_id\n"
      "_atom_site.label_comp_id\n_atom_site.label_asym_id\n_atom_site.pdbx_PDB_model_num\n0 0 0 'C\t1' 'A\tB' '\tA' "
      "'\t1'\n",
      StructureFormat::kMmcif);
}

TEST(Readers, RefuseOneAtomTooMany) {
  RawModel raw;
  raw.atom_count = kMostAtoms - 1;
  add_atom(raw, "a.gro", {"A", "ALA", gemmi::SeqId(1, ' ')}, gemmi::Atom());
  EXPECT_EQ(raw.atom_count, kMostAtoms);
  EXPECT_HAS(error_of(ErrorKind::kInput,
                      [&] {
                        add_atom(raw, "a.gro", {"A", "ALA", gemmi::SeqId(1, ' ')}, gemmi::Atom());
                      }),
             "'a.gro' has more than 43770000 atoms");
}

}  // namespace
}  // namespace quickses::io
