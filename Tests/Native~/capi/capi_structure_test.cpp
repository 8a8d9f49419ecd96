// SPDX-License-Identifier: MIT
// The C API: structures from files and from memory.
#include "capi/capi_fixture.h"
#include "io/io_fixture.h"

#include <string>

namespace {

using namespace capi_fixture;

// Seven atoms, one of them in two places, one hydrogen, one hetero atom, one water.
const char kPdb[] =
    "ATOM      1  N   ALA A   1       1.000   2.000   3.000  1.00  0.00           N\n"
    "ATOM      2  CA AALA A   1       2.400   2.000   3.000  0.50  0.00           C\n"
    "ATOM      3  CA BALA A   1       2.400   2.500   3.000  0.50  0.00           C\n"
    "ATOM      4  H   ALA A   1       0.500   2.800   3.000  1.00  0.00           H\n"
    "ATOM      5  O   GLY B  12C      5.000   2.000   3.000  1.00  0.00           O\n"
    "HETATM    6 ZN    ZN B  99       8.000   2.000   3.000  1.00  0.00          ZN\n"
    "HETATM    7  O   HOH B 101      11.000   2.000  -3.500  1.00  0.00           O\n"
    "END\n";

struct CloseStructure {
  void operator()(qses_structure *structure) const { qses_structure_close(structure); }
};
using StructurePointer = std::unique_ptr<qses_structure, CloseStructure>;

qses_structure_options read_options(qses_structure_format format = QSES_STRUCTURE_PDB) {
  qses_structure_options options;
  qses_structure_options_init(&options);
  options.format = format;
  return options;
}

StructurePointer open_text(const std::string &text, const qses_structure_options &options = read_options()) {
  qses_structure *structure = nullptr;
  expect_ok(qses_structure_open_memory(text.data(), text.size(), &options, &structure));
  return StructurePointer(structure);
}

qses_structure_description info_of(const StructurePointer &structure) {
  qses_structure_description info;
  qses_structure_description_init(&info);
  expect_ok(qses_structure_info(structure.get(), &info));
  return info;
}

qses_atom atom_of(const StructurePointer &structure, uint32_t k) {
  qses_atom atom;
  qses_atom_init(&atom);
  expect_ok(qses_structure_atom(structure.get(), k, &atom));
  return atom;
}

std::vector<uint32_t> indices_of(const qses_structure_description &info) {
  return {info.file_indices, info.file_indices + info.atom_count};
}

TEST(Structure, Atoms) {
  const StructurePointer structure = open_text(kPdb);
  const qses_structure_description info = info_of(structure);
  EXPECT_EQ(info.format, QSES_STRUCTURE_PDB);
  EXPECT_EQ(info.model, 1);
  EXPECT_EQ(info.model_count, 1);
  ASSERT_EQ(info.atom_count, 6u);  // the second place of CA is left out
  EXPECT_EQ(info.file_atom_count, 7u);
  EXPECT_EQ(indices_of(info), (std::vector<uint32_t>{0, 1, 3, 4, 5, 6}));
  EXPECT_EQ(std::vector<uint8_t>(info.file_elements, info.file_elements + 7),
            (std::vector<uint8_t>{7, 6, 6, 1, 8, 30, 8}));
  const std::vector<float> radii(info.radii, info.radii + 6);
  EXPECT_EQ(radii, (std::vector<float>{1.55f, 1.7f, 1.2f, 1.52f, 1.4f, 1.52f}));
  EXPECT_EQ(std::vector<float>(info.positions + 15, info.positions + 18), (std::vector<float>{11.f, 2.f, -3.5f}));

  const qses_atom oxygen = atom_of(structure, 3), zinc = atom_of(structure, 4), water = atom_of(structure, 5);
  EXPECT_STREQ(oxygen.name, "O");
  EXPECT_STREQ(oxygen.residue_name, "GLY");
  EXPECT_STREQ(oxygen.chain, "B");
  EXPECT_EQ(oxygen.residue_number, 12);
  EXPECT_EQ(oxygen.insertion_code, 'C');
  EXPECT_EQ(atom_of(structure, 0).insertion_code, ' ');
  EXPECT_EQ(zinc.element, 30);
  for (uint32_t i = 0; i < info.atom_count; ++i) {
    const qses_atom atom = atom_of(structure, i);
    EXPECT_EQ(atom.is_hetero, i >= 4);
    EXPECT_EQ(atom.is_water, i == 5);
    EXPECT_EQ(atom.is_hydrogen, i == 2);
  }
  EXPECT_STREQ(water.residue_name, "HOH");
}

TEST(Structure, Filters) {
  qses_structure_options options = read_options();
  options.water = 0;
  EXPECT_EQ(indices_of(info_of(open_text(kPdb, options))), (std::vector<uint32_t>{0, 1, 3, 4, 5}));
  options = read_options();
  options.hetero = 0;
  EXPECT_EQ(indices_of(info_of(open_text(kPdb, options))), (std::vector<uint32_t>{0, 1, 3, 4}));
  options.hydrogen = 0;
  EXPECT_EQ(indices_of(info_of(open_text(kPdb, options))), (std::vector<uint32_t>{0, 1, 4}));
  options.selection = "//B";
  const StructurePointer structure = open_text(kPdb, options);
  const qses_structure_description info = info_of(structure);
  EXPECT_EQ(indices_of(info), (std::vector<uint32_t>{4}));
  EXPECT_EQ(info.file_atom_count, 7u);
  EXPECT_EQ(info.file_elements[5], 30);  // also of atoms that were left out
}

TEST(Structure, Models) {
  const std::string atom = "ATOM      1  N   ALA A   1       1.000   2.000   3.000  1.00  0.00           N\n";
  const std::string text = "MODEL        1\n" + atom + "ENDMDL\nMODEL        2\n" + atom + atom + "ENDMDL\nEND\n";
  qses_structure_options options = read_options();
  options.model = 2;
  const StructurePointer structure = open_text(text, options);
  const qses_structure_description info = info_of(structure);
  EXPECT_EQ(info.model, 2);
  EXPECT_EQ(info.model_count, 2);
  EXPECT_EQ(info.atom_count, 2u);
}

TEST(Structure, RadiiOfTheFileAndOfSets) {
  const StructurePointer own = open_text("0 0 0 1.25\n3 0 0 2.5\n", read_options(QSES_STRUCTURE_XYZR));
  const qses_structure_description info = info_of(own);
  EXPECT_EQ(std::vector<float>(info.radii, info.radii + 2), (std::vector<float>{1.25f, 2.5f}));
  EXPECT_STREQ(atom_of(own, 0).name, "");
  EXPECT_STREQ(atom_of(own, 0).chain, "");
  EXPECT_EQ(info.file_elements[1], 0);
  qses_structure_options options = read_options();
  options.radii = "bondi";
  EXPECT_EQ(info_of(open_text(kPdb, options)).radii[4], 1.39f);  // zinc
}

TEST(Structure, Warnings) {
  const StructurePointer structure =
      open_text("ATOM      1  N   ALA A   1       1.000   2.000   3.000\nEND\n");  // no columns for the element
  ASSERT_EQ(info_of(structure).warning_count, 1u);
  const char *sentence = nullptr;
  ASSERT_EQ(qses_structure_warning(structure.get(), 0, &sentence), QSES_OK);
  EXPECT_NE(std::string(sentence).find("inferred"), std::string::npos);
  expect_error(qses_structure_warning(structure.get(), 1, &sentence), QSES_INVALID_ARGUMENT, {"k is 1"});
  expect_error(qses_structure_warning(structure.get(), 0, nullptr), QSES_INVALID_ARGUMENT, {"sentence", "NULL"});
}

using StructureFiles = quickses::io::IoTest;

TEST_F(StructureFiles, FilesAndMemoryGiveTheSame) {
  const std::string plain = write("a.pdb", kPdb), packed = write_gz("a.pdb.gz", kPdb), bare = write("a", kPdb);
  const std::string packed_bytes = quickses::io::slurp(packed);
  const qses_structure_description expected = info_of(open_text(kPdb));
  for (const std::string &path : {plain, packed, bare}) {
    qses_structure *opened = nullptr;
    ASSERT_EQ(qses_structure_open(path.c_str(), nullptr, &opened), QSES_OK) << qses_last_error();
    const StructurePointer structure(opened);
    EXPECT_EQ(info_of(structure).atom_count, expected.atom_count);
  }
  for (const auto format : {QSES_STRUCTURE_AUTO, QSES_STRUCTURE_PDB}) {
    EXPECT_EQ(info_of(open_text(packed_bytes, read_options(format))).atom_count, expected.atom_count);
    EXPECT_EQ(info_of(open_text(kPdb, read_options(format))).atom_count, expected.atom_count);
  }
  // A format that is given goes before the name.
  qses_structure *opened = nullptr;
  const qses_structure_options xyzr = read_options(QSES_STRUCTURE_XYZR);
  expect_error(qses_structure_open(plain.c_str(), &xyzr, &opened), QSES_FILE_ERROR, {"a.pdb", "line 1"});
}

TEST_F(StructureFiles, Errors) {
  qses_structure *structure = reinterpret_cast<qses_structure *>(this);
  expect_error(qses_structure_open(path("none.pdb").c_str(), nullptr, &structure), QSES_FILE_ERROR,
               {"none.pdb", "no such file"});
  EXPECT_EQ(structure, nullptr);
  expect_error(qses_structure_open(nullptr, nullptr, &structure), QSES_INVALID_ARGUMENT, {"path", "NULL"});
  expect_error(qses_structure_open("a.pdb", nullptr, nullptr), QSES_INVALID_ARGUMENT, {"structure", "NULL"});
  expect_error(qses_structure_open_memory(nullptr, 0, nullptr, &structure), QSES_INVALID_ARGUMENT, {"bytes", "NULL"});
  expect_error(qses_structure_open_memory("x", SIZE_MAX, nullptr, &structure), QSES_OUT_OF_MEMORY, {"memory"});

  const auto error = [&](qses_status status, std::initializer_list<const char *> words,
                         const qses_structure_options &options, const std::string &text = kPdb) {
    structure = reinterpret_cast<qses_structure *>(this);
    expect_error(qses_structure_open_memory(text.data(), text.size(), &options, &structure), status, words);
    EXPECT_EQ(structure, nullptr);
  };
  error(QSES_FILE_ERROR, {"empty"}, read_options(), "");
  error(QSES_FILE_ERROR, {"no atoms"}, read_options(), "END\n");
  error(QSES_FILE_ERROR, {"format"}, read_options(QSES_STRUCTURE_AUTO), "what is this");
  qses_structure_options options = read_options();
  options.model = 2;
  error(QSES_INVALID_ARGUMENT, {"1 model", "no model 2"}, options);
  options.model = 0;
  error(QSES_INVALID_ARGUMENT, {"options.model is 0"}, options);
  options = read_options();
  options.selection = "//[[";
  error(QSES_INVALID_ARGUMENT, {"selection", "//[["}, options);
  options.selection = "//Z";
  error(QSES_FILE_ERROR, {"filters"}, options);
  options = read_options();
  options.radii = "no_such_set";
  error(QSES_FILE_ERROR, {"no_such_set"}, options);
  options = read_options(QSES_STRUCTURE_XYZR);
  options.radii = "bondi";
  error(QSES_INVALID_ARGUMENT, {"radii"}, options, "0 0 0 1\n");
  options = read_options();
  set_any(&options.format, 6);
  error(QSES_INVALID_ARGUMENT, {"options.format is 6"}, options);
  options = read_options();
  options.struct_size = 0;
  error(QSES_INVALID_ARGUMENT, {"struct_size"}, options);

  qses_structure_description info;
  qses_structure_description_init(&info);
  expect_error(qses_structure_info(nullptr, &info), QSES_INVALID_ARGUMENT, {"structure", "NULL"});
  info.struct_size = 0;
  expect_error(qses_structure_info(open_text(kPdb).get(), &info), QSES_INVALID_ARGUMENT, {"struct_size"});
  const StructurePointer opened = open_text(kPdb);
  qses_atom atom;
  qses_atom_init(&atom);
  expect_error(qses_structure_atom(opened.get(), 6, &atom), QSES_INVALID_ARGUMENT, {"k is 6", "6 atoms"});
  expect_error(qses_structure_atom(opened.get(), 0, nullptr), QSES_INVALID_ARGUMENT, {"atom", "NULL"});
  expect_error(qses_structure_atom(nullptr, 0, &atom), QSES_INVALID_ARGUMENT, {"structure", "NULL"});
  qses_structure_close(nullptr);
  qses_structure_description_init(nullptr);
  qses_structure_options_init(nullptr);
}

TEST(Structure, OneIsSingular) {
  const StructurePointer structure = open_text("0 0 0 1\n", read_options(QSES_STRUCTURE_XYZR));
  qses_atom atom;
  qses_atom_init(&atom);
  EXPECT_EQ(qses_structure_atom(structure.get(), 1, &atom), QSES_INVALID_ARGUMENT);
  EXPECT_STREQ(qses_last_error(), "k is 1 but there is 1 atom");
  const char *sentence = nullptr;
  EXPECT_EQ(qses_structure_warning(structure.get(), 0, &sentence), QSES_INVALID_ARGUMENT);
  EXPECT_STREQ(qses_last_error(), "k is 0 but there are 0 warnings");
}

TEST(Devices, AreCounted) {
  uint32_t count = 99;
  ASSERT_EQ(qses_device_count(&count), QSES_OK);
  qses_backend_description cuda = empty_description();
  ASSERT_EQ(qses_backend_info(QSES_BACKEND_CUDA, &cuda), QSES_OK);
  if (cuda.available)
    EXPECT_GT(count, 0u);
  else
    EXPECT_LT(count, 99u);
  expect_error(qses_device_count(nullptr), QSES_INVALID_ARGUMENT, {"count", "NULL"});
}

}  // namespace
