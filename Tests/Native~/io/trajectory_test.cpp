// SPDX-License-Identifier: MIT
// Trajectories: PDB files with several models, choice of the format, access from several threads.
#include <algorithm>
#include <cstdio>
#include <thread>

#include "io/netcdf_fixture.h"
#include "io/structure.h"

namespace quickses::io {
namespace {

std::string pdb_atoms(const Positions &positions) {
  std::string text;
  for (size_t i = 0; i < positions.size() / 3; ++i) {
    char line[96];
    std::snprintf(line, sizeof line, "%-6s%5d  CA  ALA A%4d    %8.3f%8.3f%8.3f  1.00  0.00           C\n",
                  i % 3 == 2 ? "HETATM" : "ATOM", static_cast<int>(i + 1), static_cast<int>(i + 1), positions[3 * i],
                  positions[3 * i + 1], positions[3 * i + 2]);
    text += line;
  }
  return text;
}

std::string pdb_model(int number, const Positions &positions) {
  return "MODEL     " + std::to_string(number) + "\n" + pdb_atoms(positions) + "TER\nENDMDL\n";
}

// As they come out of three decimals.
Positions rounded_positions(size_t atom_count, uint32_t seed) {
  Positions positions = random_positions(atom_count, seed);
  for (float &x : positions) x = static_cast<float>(std::nearbyint(static_cast<double>(x) * 1000) / 1000);
  return positions;
}

Trajectory open_pdb(const std::string &text) {
  return Trajectory::from_memory(text, TrajectoryFormat::kPdb, "test.pdb");
}

std::string pdb_error(const std::string &text) {
  return error_of(ErrorKind::kInput, [&] { open_pdb(text); });
}

class TrajectoryTest : public IoTest {};

// ---- PDB

TEST_F(TrajectoryTest, PdbModels) {
  std::string text = "HEADER    SOMETHING\n";
  std::vector<Positions> frames;
  for (uint32_t k = 0; k < 5; ++k) {
    frames.push_back(rounded_positions(7, k));
    text += pdb_model(static_cast<int>(k + 1), frames.back());
  }
  text += "END\n";
  for (const std::string &file : {write("a.pdb", text), write_gz("a.pdb.gz", text), write("a.ent", text)}) {
    const Trajectory trajectory = Trajectory::open(file);
    EXPECT_EQ(trajectory.format(), TrajectoryFormat::kPdb);
    ASSERT_EQ(trajectory.frame_count(), 5u);
    ASSERT_EQ(trajectory.atom_count(), 7u);
    EXPECT_FALSE(trajectory.incomplete());
    for (size_t k : {4, 0, 2, 1, 3}) EXPECT_EQ(frame_of(trajectory, k), frames[k]);
    EXPECT_FALSE(trajectory.box(0));
    EXPECT_FALSE(trajectory.time(0));
  }
}

// Frames hold the atom records of a model in their order, so that file_index of a structure points into them.
TEST_F(TrajectoryTest, PdbFramesMatchStructures) {
  std::string text;
  for (uint32_t k = 0; k < 3; ++k) text += pdb_atoms(rounded_positions(6, k)) + "END\n";
  const std::string file = write("a.pdb", text);
  ReadOptions options;
  options.model = 0;
  options.hetero = false;
  const StructureFile structures = read_structure(file, options);
  const Trajectory trajectory = Trajectory::open(file);
  ASSERT_EQ(trajectory.frame_count(), 3u);
  ASSERT_EQ(structures.models.size(), 3u);
  for (size_t k = 0; k < 3; ++k) {
    const Structure &structure = structures.models[k];
    ASSERT_EQ(structure.file_atom_count, trajectory.atom_count());
    ASSERT_EQ(structure.atoms.size(), 4u);
    const Positions frame = frame_of(trajectory, k);
    for (size_t i = 0; i < structure.atoms.size(); ++i)
      for (size_t axis = 0; axis < 3; ++axis)
        EXPECT_EQ(frame[3 * structure.atoms[i].file_index + axis], structure.positions[3 * i + axis]);
  }
}

TEST_F(TrajectoryTest, PdbCutAtEveryByte) {
  std::string text;
  std::vector<Positions> frames;
  std::vector<size_t> whole;  // from where on a frame is there: behind the coordinates of its last atom
  for (int k = 0; k < 3; ++k) {
    frames.push_back(rounded_positions(4, static_cast<uint32_t>(k)));
    text += pdb_model(k + 1, frames.back());
    whole.push_back(text.rfind("ATOM") + 54);
  }
  const size_t first_end = text.find("ENDMDL") + 7;
  for (size_t size = first_end; size < text.size(); ++size) {
    SCOPED_TRACE("cut after " + std::to_string(size) + " bytes");
    const Trajectory trajectory = open_pdb(text.substr(0, size));
    size_t count = 0;
    while (count < 3 && whole[count] <= size) ++count;
    ASSERT_EQ(trajectory.frame_count(), count);
    for (size_t k = 0; k < count; ++k) EXPECT_EQ(frame_of(trajectory, k), frames[k]);
    // Cut before the first letters of a model tell that it is one, nothing is missing.
    const size_t model = text.find("MODEL", text.find("ENDMDL", whole[count - 1]));
    EXPECT_EQ(trajectory.incomplete(), model != std::string::npos && size >= model + 5);
  }
  EXPECT_HAS(pdb_error(text.substr(0, 20)), "frame 0 is cut off");
  EXPECT_HAS(pdb_error(text.substr(0, 60)), "frame 0 is cut off");
}

TEST_F(TrajectoryTest, PdbErrors) {
  EXPECT_HAS(pdb_error("HEADER    NOTHING\nEND\n"), "'test.pdb': it has no atoms");
  EXPECT_HAS(pdb_error("MODEL 1\nENDMDL\n"), "frame 0 has no atoms");
  const Positions three = rounded_positions(3, 1), four = rounded_positions(4, 1);
  EXPECT_HAS(pdb_error(pdb_model(1, three) + pdb_model(2, four)), "frame 1 has 4 atoms, but frame 0 has 3");
  EXPECT_HAS(pdb_error(pdb_model(1, four) + pdb_model(2, three)), "frame 1 has 3 atoms, but frame 0 has 4");
  EXPECT_HAS(pdb_error(pdb_model(1, three) + pdb_model(2, rounded_positions(1, 1))),
             "frame 1 has 1 atom, but frame 0 has 3");
  EXPECT_HAS(pdb_error("ATOM      1  CA\n" + pdb_atoms(three)), "'test.pdb', line 1: ");
  const std::string atoms = pdb_atoms(three);
  EXPECT_HAS(pdb_error(atoms.substr(0, 51) + atoms.substr(atoms.find('\n'))), "columns 31 to 54");
  // The last line is short, but it is a line: nothing is cut off.
  EXPECT_HAS(pdb_error(atoms + "END\n" + atoms.substr(0, atoms.rfind("HETATM") + 50) + "\n"), "columns 31 to 54");
  EXPECT_EQ(frame_of(open_pdb("\xef\xbb\xbf" + atoms), 0), three);
  std::string mac = atoms;
  std::replace(mac.begin(), mac.end(), '\n', '\r');
  EXPECT_EQ(frame_of(open_pdb(mac), 0), three);

  std::string text = pdb_model(1, three) + pdb_model(2, three);
  text.replace(text.rfind("ATOM") + 30, 8, "  1.2z3 ");
  const Trajectory trajectory = open_pdb(text);
  EXPECT_EQ(frame_of(trajectory, 0), three);
  // MODEL, three atoms, TER and ENDMDL, MODEL, one atom; atoms 1 and 2 of a model are ATOM, the third is HETATM.
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { frame_of(trajectory, 1); }),
             "'test.pdb', line 9: the x coordinate '1.2z3' is no number");
}

TEST_F(TrajectoryTest, PdbBox) {
  const std::string atoms = pdb_atoms(rounded_positions(2, 1));
  const auto cryst1 = [](double a, double b, double c, double alpha, double beta, double gamma) {
    char line[96];
    std::snprintf(line, sizeof line, "CRYST1%9.3f%9.3f%9.3f%7.2f%7.2f%7.2f P 1           1\n", a, b, c, alpha, beta,
                  gamma);
    return std::string(line);
  };
  const Trajectory trajectory =
      open_pdb(cryst1(30, 40, 50, 90, 90, 90) + atoms + "END\n" + atoms + "END\n" + cryst1(60, 60, 60, 60, 60, 90) +
               atoms + "END\n" + cryst1(1, 1, 1, 90, 90, 90) + atoms + "END\n");
  ASSERT_EQ(trajectory.frame_count(), 4u);
  for (size_t k : {0, 1}) {
    ASSERT_TRUE(trajectory.box(k));
    EXPECT_EQ(trajectory.box(k)->vectors[1], (std::array<double, 3>{0, 40, 0}));
  }
  ASSERT_TRUE(trajectory.box(2));  // a rhombic dodecahedron: c = (30, 30, 42.426)
  EXPECT_NEAR(trajectory.box(2)->vectors[2][0], 30, 1e-9);
  EXPECT_NEAR(trajectory.box(2)->vectors[2][1], 30, 1e-9);
  EXPECT_NEAR(trajectory.box(2)->vectors[2][2], 60 / std::sqrt(2), 1e-9);
  EXPECT_FALSE(trajectory.box(3));
  const size_t second_line = atoms.find('\n') + 1;  // a record among atoms is that of the frames to come
  const Trajectory among = open_pdb(cryst1(30, 40, 50, 90, 90, 90) + atoms.substr(0, second_line) +
                                    cryst1(60, 60, 60, 90, 90, 90) + atoms.substr(second_line) + "END\n" + atoms);
  ASSERT_TRUE(among.box(0) && among.box(1));
  EXPECT_EQ(among.box(0)->vectors[0][0], 30);
  EXPECT_EQ(among.box(1)->vectors[0][0], 60);
}

TEST_F(TrajectoryTest, PdbMutantsAreSafe) {
  std::string text = "CRYST1   30.000   40.000   50.000  90.00  90.00  90.00 P 1           1\n";
  for (int k = 0; k < 3; ++k) text += pdb_model(k + 1, rounded_positions(3, static_cast<uint32_t>(k)));
  expect_mutants_are_safe({text}, TrajectoryFormat::kPdb, 5000);
}

// ---- all formats

struct Sample {
  std::string bytes;
  TrajectoryFormat format;
  const char *extension;
};

std::vector<Sample> samples(std::vector<Positions> &frames, size_t atom_count = 5, uint32_t frame_count = 3) {
  const DcdWriter dcd;
  const XtcWriter xtc;
  Sample dcd_file = {dcd.header(static_cast<int32_t>(atom_count)), TrajectoryFormat::kDcd, ".dcd"};
  Sample xtc_file = {"", TrajectoryFormat::kXtc, ".xtc"}, pdb_file = {"", TrajectoryFormat::kPdb, ".pdb"};
  Sample trr_file = {"", TrajectoryFormat::kTrr, ".trr"}, nc_file = {"", TrajectoryFormat::kNetcdf, ".nc"};
  for (uint32_t k = 0; k < frame_count; ++k) {
    frames.push_back(rounded_positions(atom_count, k));
    dcd_file.bytes += dcd.frame(frames.back(), k == 0);
    std::vector<int32_t> integers;
    for (float x : frames.back())
      integers.push_back(static_cast<int32_t>(std::nearbyint(static_cast<double>(x) * 1000)));
    XtcWriter fine;
    fine.precision = 10000;
    std::vector<float> nm;
    for (float x : frames.back()) nm.push_back(x / 10);
    xtc_file.bytes += atom_count <= 9 ? xtc.plain_frame(nm) : fine.packed_frame(integers);
    trr_file.bytes += TrrWriter().frame(frames.back());
    pdb_file.bytes += pdb_model(static_cast<int>(k + 1), frames.back());
  }
  nc_file.bytes = NetcdfWriter().file(frames);
  return {dcd_file, xtc_file, trr_file, nc_file, pdb_file};
}

void expect_frames(const Trajectory &trajectory, const std::vector<Positions> &frames) {
  ASSERT_EQ(trajectory.frame_count(), frames.size());
  for (size_t k = 0; k < frames.size(); ++k) {
    const Positions frame = frame_of(trajectory, k);
    ASSERT_EQ(frame.size(), frames[k].size());
    for (size_t i = 0; i < frame.size(); ++i) EXPECT_NEAR(frame[i], frames[k][i], 1e-5);
  }
}

TEST_F(TrajectoryTest, FormatByNameAndByContent) {
  std::vector<Positions> frames;
  for (const Sample &sample : samples(frames)) {
    const std::string extension = sample.extension;
    SCOPED_TRACE(extension);
    std::string upper = extension;
    for (char &c : upper) c = static_cast<char>(c == '.' ? c : c - 'a' + 'A');
    for (const std::string &file :
         {write("a" + extension, sample.bytes), write("b" + upper, sample.bytes),
          write_gz("c" + extension + ".gz", sample.bytes), write("d", sample.bytes), write_gz("e.bin", sample.bytes)}) {
      const Trajectory trajectory = Trajectory::open(file);
      EXPECT_EQ(trajectory.format(), sample.format);
      expect_frames(trajectory, frames);
    }
    expect_frames(Trajectory::open(write("f.pqr", sample.bytes), sample.format), frames);
    expect_frames(Trajectory::from_memory(sample.bytes, sample.format), frames);
  }
}

TEST_F(TrajectoryTest, FilesThatCanNotBeOpened) {
  const auto error = [](const std::string &file) {
    return error_of(ErrorKind::kInput, [&] { Trajectory::open(file); });
  };
  EXPECT_HAS(error(path("none.xtc")), path("none.xtc"));
  EXPECT_HAS(error(folder_.string()), "is a directory");
  EXPECT_HAS(error(write("empty.dcd", "")), "is empty");
  EXPECT_HAS(error(write("a.txt", "what is this")), "known are .dcd .xtc .trr .nc");
  EXPECT_HAS(error(write("one", "x")), "known are .dcd .xtc .trr .nc");
  std::vector<Positions> frames;
  const Sample xtc = samples(frames)[1];
  EXPECT_HAS(error(write("a.xtc.gz", xtc.bytes)), "is no gzip file");
  const std::string packed = slurp(write_gz("b.xtc.gz", xtc.bytes));
  EXPECT_HAS(error(write("c.xtc.gz", packed.substr(0, packed.size() / 2))), "cut off");
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { Trajectory::from_memory("", TrajectoryFormat::kXtc, "nothing"); }),
             "'nothing' is empty");
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { Trajectory::from_memory(packed.substr(0, 40), std::nullopt, "cut"); }),
             "'cut' is cut off");
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { Trajectory::from_memory("what is this", std::nullopt, "text"); }),
             "'text'");
}

TEST_F(TrajectoryTest, FramesOutOfRange) {
  std::vector<Positions> frames;
  for (const Sample &sample : samples(frames)) {
    const Trajectory trajectory = Trajectory::from_memory(sample.bytes, sample.format, "a.trj");
    float xyz[15];
    for (size_t frame : {size_t{3}, SIZE_MAX}) {
      EXPECT_HAS(error_of(ErrorKind::kUsage, [&] { trajectory.read_frame(frame, xyz); }),
                 "has no frame " + std::to_string(frame) + ": the last is 2");
      error_of(ErrorKind::kUsage, [&] { trajectory.box(frame); });
      error_of(ErrorKind::kUsage, [&] { trajectory.time(frame); });
    }
  }
}

// ---- files in a row

TEST_F(TrajectoryTest, FilesInARowAreNumberedThrough) {
  std::vector<Positions> frames, all;
  std::vector<std::string> files, file_of_frame;
  for (const Sample &sample : samples(frames)) {
    files.push_back(write("part" + std::to_string(files.size()) + sample.extension, sample.bytes));
    all.insert(all.end(), frames.begin(), frames.end());
    file_of_frame.insert(file_of_frame.end(), frames.size(), files.back());
  }
  const Trajectory trajectory = Trajectory::open_all(files);
  expect_frames(trajectory, all);
  EXPECT_FALSE(trajectory.incomplete());
  EXPECT_TRUE(trajectory.warnings().empty());
  EXPECT_EQ(trajectory.format(), Trajectory::open(files[0]).format());
  for (size_t k = 0; k < all.size(); ++k) EXPECT_EQ(trajectory.file_of(k), file_of_frame[k]);
  const std::string last = std::to_string(all.size() - 1);
  EXPECT_HAS(error_of(ErrorKind::kUsage, [&] { frame_of(trajectory, all.size()); }), ": the last is " + last);
  EXPECT_HAS(error_of(ErrorKind::kUsage, [&] { trajectory.file_of(SIZE_MAX); }), ": the last is " + last);
  EXPECT_HAS(error_of(ErrorKind::kUsage, [&] { Trajectory::open_all({}); }), "no trajectories");
}

TEST_F(TrajectoryTest, FilesInARowKeepTheirTimesAndBoxes) {
  const auto file = [&](const std::string &name, double time, double edge) {
    TrrWriter writer;
    writer.time = time;
    writer.box = {edge, 0, 0, 0, edge, 0, 0, 0, edge};
    return write(name, writer.frame(Positions{1, 2, 3}));
  };
  const Trajectory trajectory = Trajectory::open_all({file("a.trr", 8, 2), file("b.trr", 4, 3), file("c.trr", 16, 5)});
  const double times[] = {8, 4, 16}, edges[] = {20, 30, 50};
  for (size_t k : {2, 0, 1}) {
    EXPECT_EQ(trajectory.time(k), times[k]);
    ASSERT_TRUE(trajectory.box(k));
    EXPECT_EQ(trajectory.box(k)->vectors[0][0], edges[k]);
  }
}

TEST_F(TrajectoryTest, FilesInARowWithFaults) {
  const DcdWriter dcd;
  const Positions good = {1, 2, 3}, bad = {1, NAN, 3};
  const std::string whole = dcd.header(1) + dcd.frame(good, true) + dcd.frame(good, false);
  const std::string first = write("first.dcd", whole);
  const std::string cut = write("cut.dcd", whole.substr(0, whole.size() - 1));
  const std::string damaged = write("damaged.dcd", dcd.header(1) + dcd.frame(good, true) + dcd.frame(bad, false));
  const Trajectory trajectory = Trajectory::open_all({first, cut, damaged});
  ASSERT_EQ(trajectory.frame_count(), 5u);
  EXPECT_TRUE(trajectory.incomplete());
  ASSERT_EQ(trajectory.warnings().size(), 1u);
  EXPECT_HAS(trajectory.warnings()[0], cut + "': frame 1 is cut off");
  for (size_t k = 0; k < 4; ++k) EXPECT_EQ(frame_of(trajectory, k), good);
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { frame_of(trajectory, 4); }),
             damaged + "': frame 1: atom 1 has no finite");

  const std::string other = write("other.dcd", dcd.header(2) + dcd.frame({1, 2, 3, 4, 5, 6}, true));
  const std::string message = error_of(ErrorKind::kInput, [&] { Trajectory::open_all({first, cut, other}); });
  EXPECT_HAS(message, other + "' has 2 atoms, but '" + first + "' has 1");
  EXPECT_HAS(error_of(ErrorKind::kInput,
                      [&] {
                        Trajectory::open_all({other, first});
                      }),
             first + "' has 1 atom, but '" + other + "' has 2");
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { Trajectory::open_all({first, path("none.dcd")}); }), "none.dcd");
}

TEST_F(TrajectoryTest, FilesInARowThatCanNotBeUnwrapped) {
  constexpr size_t kAtoms = 5000;
  const Positions crowd(3 * kAtoms, 1.0f);
  TrrWriter without_box, with_box;
  with_box.box = {2, 0, 0, 0, 2, 0, 0, 0, 2};
  const std::string first = write("a.trr", without_box.frame(crowd) + without_box.frame(crowd));
  const std::string second = write("b.trr", without_box.frame(crowd) + with_box.frame(crowd));
  Trajectory trajectory = Trajectory::open_all({first, second});
  const std::vector<uint8_t> carbons(kAtoms, 6);
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { trajectory.unwrap(carbons.data()); }),
             "'" + second + "': frame 1: too many atoms lie on top of each other");
}

TEST_F(TrajectoryTest, FileThatShrinksWhileItIsOpen) {
  std::vector<Positions> frames;
  std::vector<Sample> files = samples(frames, 2000);
  for (size_t i : {0, 1, 2, 3}) {  // PDB files are in memory
    const std::string file = write(std::string("a") + files[i].extension, files[i].bytes);
    const Trajectory trajectory = Trajectory::open(file);
    std::filesystem::resize_file(file, files[i].bytes.size() / 2);
    Positions positions(3 * trajectory.atom_count());
    EXPECT_HAS(error_of(ErrorKind::kInput, [&] { trajectory.read_frame(2, positions.data()); }), "shorter");
    trajectory.read_frame(0, positions.data());
    EXPECT_NEAR(positions[0], frames[0][0], 1e-5);
  }
}

// What is written over a file that is open must not be taken for the frames that were there.
TEST_F(TrajectoryTest, FileThatIsWrittenOverWhileItIsOpen) {
  const auto error_after = [&](const std::string &name, const std::string &before, const std::string &after,
                               const std::function<void(const Trajectory &)> &read) {
    const std::string file = write(name, before);
    const Trajectory trajectory = Trajectory::open(file);
    write(name, after);
    return error_of(ErrorKind::kInput, [&] { read(trajectory); });
  };
  const auto read_frame = [](const Trajectory &trajectory) { frame_of(trajectory, 0); };
  const Positions four = rounded_positions(4, 1), nine = rounded_positions(9, 1);
  const std::vector<float> four_nm(12, 1.0f), nine_nm(27, 1.0f);
  const std::string plain = XtcWriter().plain_frame(four_nm), more = XtcWriter().plain_frame(nine_nm);
  std::vector<int32_t> many(60);
  for (size_t i = 0; i < many.size(); ++i) many[i] = static_cast<int32_t>(i * 7919 % 60000);
  const std::string packed = XtcWriter().packed_frame(many);
  ASSERT_GT(packed.size(), more.size());
  EXPECT_HAS(error_after("a.xtc", plain, more, read_frame), "frame 0 is damaged: its head has changed");
  EXPECT_HAS(error_after("a.xtc", packed, more + std::string(packed.size() - more.size(), ' '), read_frame),
             "frame 0 is damaged: its head has changed");
  TrrWriter moving;
  moving.has_velocities = true;
  const std::string trr = TrrWriter().frame(four);
  EXPECT_HAS(error_after("a.trr", trr, TrrWriter().frame(nine), read_frame), "its head has changed");
  EXPECT_HAS(error_after("a.trr", trr, moving.frame(4, {}), read_frame), "its head has changed");
  const DcdWriter dcd;
  const std::string with_cell = dcd.header(4) + dcd.frame(four, true, {30, 0, 40, 0, 0, 50});
  std::string without_cell = with_cell;
  without_cell.replace(dcd.header(4).size(), 4, std::string(4, ' '));
  EXPECT_HAS(error_after("a.dcd", with_cell, without_cell, [](const Trajectory &trajectory) { trajectory.box(0); }),
             "frame 0 is damaged");
}

TEST_F(TrajectoryTest, ManyThreads) {
  std::vector<Positions> frames;
  for (const Sample &sample : samples(frames, 500, 20)) {
    const std::string file = write(std::string("a") + sample.extension, sample.bytes);
    const Trajectory trajectory = Trajectory::open(file);
    ASSERT_EQ(trajectory.frame_count(), 20u);
    std::vector<size_t> wrong(4, 0);
    std::vector<std::thread> threads;
    for (size_t t = 0; t < 4; ++t)
      threads.emplace_back([&, t] {
        Positions positions(3 * trajectory.atom_count());
        for (size_t n = 0; n < 60; ++n) {
          const size_t k = (7 * n + 5 * t) % 20;
          trajectory.read_frame(k, positions.data());
          for (size_t i = 0; i < positions.size(); ++i) wrong[t] += std::abs(positions[i] - frames[k][i]) > 1e-4f;
          wrong[t] += trajectory.box(k).has_value();
        }
      });
    for (std::thread &thread : threads) thread.join();
    EXPECT_EQ(wrong, std::vector<size_t>(4, 0)) << sample.extension;
  }
}

}  // namespace
}  // namespace quickses::io
