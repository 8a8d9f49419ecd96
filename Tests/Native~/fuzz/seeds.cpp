// SPDX-License-Identifier: MIT
#include "fuzz/seeds.h"

#include "fuzz/fuzz.h"
#include "io/netcdf_fixture.h"

#include <fstream>

namespace fuzz {
namespace {

using namespace quickses::io;

// Choices are read from the end; those that are 0 are the usual ones.
std::string with_choices(const std::string &file, int format, size_t others = 9) {
  return file + std::string(others, '\0') + static_cast<char>(format);
}

std::string first_lines(const std::string &path, int count) {
  std::ifstream in(path);
  std::string text, line;
  while (count-- > 0 && std::getline(in, line)) text += line + "\n";
  return text;
}

const char *const kPdb =
    "REMARK 350 BIOMOLECULE: 1\n"
    "REMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n"
    "REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000\n"
    "REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000\n"
    "REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000\n"
    "CRYST1   40.960   18.650   22.520  90.00  90.77  90.00 P 1 21 1      2\n"
    "MODEL        1\n"
    "ATOM      1  N  AGLY A   1      17.047  14.099   3.625  0.60 13.79           N\n"
    "ATOM      2  N  BGLY A   1      17.147  14.199   3.725  0.40 13.79           N\n"
    "ATOM      3 HG11 VAL A  -2A     16.967  12.784   4.338  1.00 10.80           H\n"
    "TER       4      VAL A  -2A\n"
    "HETATM    5 FE   HEM A 101      11.685   9.755   6.133  1.00  9.19          FE\n"
    "HETATM    6  O   HOH A 201       3.685   4.755   3.133  1.00  9.19           O1-\n"
    "ENDMDL\n"
    "MODEL        2\n"
    "ATOM      1  N   GLY A   1      16.047  13.099   3.625  1.00 13.79           N\n"
    "ENDMDL\n"
    "CONECT    1    2\n"
    "END\n";

const char *const kMmcif =
    "data_1ABC\nloop_\n_pdbx_struct_assembly_gen.assembly_id\n_pdbx_struct_assembly_gen.oper_expression\n"
    "_pdbx_struct_assembly_gen.asym_id_list\n1 '(1-2)(X0)' A\n"
    "loop_\n_pdbx_struct_oper_list.id\n_pdbx_struct_oper_list.matrix[1][1]\n_pdbx_struct_oper_list.matrix[2][2]\n"
    "_pdbx_struct_oper_list.matrix[3][3]\n_pdbx_struct_oper_list.vector[1]\n1 1 1 1 0\n2 1 1 1 5\nX0 1 1 1 9\n"
    "loop_\n_atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n"
    "_atom_site.label_alt_id\n_atom_site.label_comp_id\n_atom_site.label_asym_id\n_atom_site.label_seq_id\n"
    "_atom_site.pdbx_PDB_ins_code\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n"
    "_atom_site.occupancy\n_atom_site.B_iso_or_equiv\n_atom_site.auth_seq_id\n_atom_site.auth_asym_id\n"
    "_atom_site.pdbx_PDB_model_num\n"
    "ATOM 1 N N . MET A 1 ? 1.5 2.25 -3 1.0 20.0 1 A 1\nATOM 2 C \"C1'\" A MET A 1 ? 2.5 2.25 -3 0.5 20.0 1 A 1\n"
    "HETATM 3 ZN ZN . ZN B . ? 9 8 7 1.0 20.0 301 A 1\nATOM 4 N N . MET A 1 ? 1 2 3 1.0 20.0 1 A 2\n";

const char *const kPqr =
    "ATOM      1  N   GLY A   1      17.047  14.099   3.625 -0.3000 1.8500\n"
    "HETATM    2  O   HOH     2       3.685   4.755   3.133  0.0000 1.4000\n";

const char *const kXyzr = "# x y z radius\n1.0 2.0 3.0 1.5\n-1e1,4.25\t.5 2\n";

const char *const kGro =
    "made up, t= 1.50000 step= 10\n    3\n"
    "    1GLY      N    1   1.705   1.410   0.363  0.1000  0.2000 -0.3000\n"
    "    1GLY     CA    2   1.697   1.278   0.434  0.1000  0.2000 -0.3000\n"
    "    2SOL     OW    3   0.369   0.476   0.313  0.1000  0.2000 -0.3000\n"
    "   4.00000   4.00000   4.00000\n";

std::vector<std::string> structure_seeds() {
  std::vector<std::string> seeds;
  enum { kAuto, kPdbFormat, kMmcifFormat, kPqrFormat, kXyzrFormat, kGroFormat };
  const std::string crambin = first_lines(QUICKSES_TEST_DATA_DIR "/1CRN.pdb", 100);
  const std::pair<std::string, int> files[] = {{kPdb, kPdbFormat},   {crambin, kPdbFormat},  {kPdb, kAuto},
                                               {kMmcif, kAuto},      {kMmcif, kMmcifFormat}, {kPqr, kPqrFormat},
                                               {kXyzr, kXyzrFormat}, {kGro, kGroFormat}};
  for (const auto &[text, format] : files) seeds.push_back(with_choices(text, format));
  return seeds;
}

std::vector<std::string> trajectory_seeds() {
  std::vector<std::string> seeds;
  enum { kAuto, kDcd, kXtc, kPdbFrames, kTrr, kNetcdf };
  const size_t count = 5;
  const std::vector<Positions> frames = {random_positions(count, 1), random_positions(count, 2)};
  const std::vector<double> cell = {30, 90, 40, 90, 90, 50};
  const auto add = [&](const std::string &file, int format) { seeds.push_back(with_choices(file, format, 1)); };

  for (const bool big : {false, true}) {
    DcdWriter dcd;
    dcd.big_endian = big;
    dcd.announced = 2;
    add(dcd.header(count) + dcd.frame(frames[0], true) + dcd.frame(frames[1], false), kDcd);
    dcd.announces_cell = true;
    dcd.free_atoms = {1, 3};
    dcd.has_wide_markers = big;
    add(dcd.header(count) + dcd.frame(frames[0], true, cell) + dcd.frame(frames[1], false, cell), kDcd);
  }

  XtcWriter xtc;
  xtc.box = {4, 0, 0, 0, 4, 0, 0, 0, 4};
  std::vector<int32_t> places;
  for (int k = 0; k < 12; ++k) places.insert(places.end(), {k % 3, k / 2 % 3, k % 2});
  add(xtc.plain_frame(frames[0]), kXtc);
  add(xtc.packed_frame(places) + xtc.packed_frame(places), kXtc);
  xtc.groups = {{2, 0}, {1, 1}, {3, 0}, {2, 0}};
  xtc.magic = 2023;
  add(xtc.packed_frame(places), kXtc);

  for (const bool is_double : {false, true}) {
    TrrWriter trr;
    trr.is_double = is_double;
    trr.box = {4, 0, 0, 0, 4, 0, 0, 0, 4};
    trr.has_velocities = is_double;
    add(trr.frame(frames[0]) + trr.frame(frames[1]), kTrr);
  }

  for (const char version : {1, 2, 5}) {
    NetcdfWriter netcdf;
    netcdf.version = version;
    netcdf.has_box = netcdf.has_time = true;
    netcdf.layout = version == 1 ? NetcdfWriter::kFixed : NetcdfWriter::kRecords;
    netcdf.has_odd = version == 5;
    netcdf.scale = version == 2 ? 2 : 1;
    add(netcdf.file(frames), kNetcdf);
  }
  NetcdfWriter restart;
  restart.layout = NetcdfWriter::kRestart;
  restart.is_double = true;
  add(restart.file({frames[0]}), kAuto);
  add(kPdb, kPdbFrames);
  return seeds;
}

std::vector<std::string> selection_seeds() {
  std::vector<std::string> seeds;
  for (const char *text :
       {"protein and not chain A B", "within 5 of (name CA CB or resname HEM)", "same residue as element C FE",
        "resid -5-40 52A, 3", "index 0-3 7 and altloc A", "//A/1-2/CA[C]:A,B", "(HEM) or water", "not none, all",
        "/1/A,B/-2.A/*", "backbone or sidechain or nucleic or ligand or ions or hetero or solvent"})
    seeds.push_back(text);
  return seeds;
}

std::vector<std::string> surface_seeds() {
  std::vector<std::string> seeds;
  std::mt19937 random(1);
  for (size_t bytes = 20; bytes <= 110; bytes += 10) {
    std::string seed(bytes, '\0');
    for (char &c : seed) c = static_cast<char>(random());
    seeds.push_back(seed);
  }
  return seeds;
}

}  // namespace

std::vector<Target> targets() {
  return {{"structure", try_structure, structure_seeds()},
          {"trajectory", try_trajectory, trajectory_seeds()},
          {"selection", try_selection, selection_seeds()},
          {"surface", try_surface, surface_seeds()}};
}

}  // namespace fuzz
