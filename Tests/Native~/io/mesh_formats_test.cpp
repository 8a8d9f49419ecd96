// SPDX-License-Identifier: MIT
// Mesh writers: colours, and the formats besides plain OBJ, PLY and STL, read back by code of the tests' own.
#include <cmath>
#include <csignal>
#include <cstring>
#include <limits>
#include <sstream>
#include <vector>

#if !defined(_WIN32)
#include <sys/resource.h>
#endif

#include "io/io_fixture.h"
#include "io/mesh_writer.h"

namespace quickses::io {
namespace {

class MeshFormatsTest : public IoTest {};

// A tetrahedron of which vertex 0 is there a second time, for the last triangle.
struct Tetrahedron {
  std::vector<float> positions = {1.0f / 3, 0.1f,         -2.0f / 7, 1e-7f, 123.456789f, 16777216.0f, -0.0f,    1,
                                  3e-39f,   -98765.4321f, 5,         7,     1.0f / 3,    0.1f,        -2.0f / 7};
  std::vector<float> normals = {0.6f, 0.8f, 0,         0,           0.70710678f, 0.70710678f, -1, 0,
                                0,    0,    -1.0f / 3, 0.94280905f, 0,           0,           1};
  std::vector<uint32_t> owners = {0, 7, 100000, 3, 0};
  std::vector<uint32_t> component_ids = {0, 5, 1, 70000, 0};
  std::vector<uint8_t> patches = {0, 1, 2, 1, 0};
  std::vector<uint8_t> colors = {0,   128, 255, 255, 10, 20,  30, 255, 1,   254,
                                 127, 255, 240, 13,  0,  255, 0,  128, 255, 255};
  std::vector<float> occlusion = {0, 0.25f, 1.0f / 3, 1, 0.5f};
  std::vector<uint32_t> indices = {0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 4};
  std::vector<uint32_t> repeated = {0};

  MeshView view() const {
    MeshView view;
    view.vertex_count = 5;
    view.triangle_count = 4;
    view.positions = positions.data();
    view.normals = normals.data();
    view.owners = owners.data();
    view.indices = indices.data();
    view.repeated = repeated.data();
    view.repeated_count = 1;
    view.atom_count = 100001;
    view.probe_radius = 1.4f;
    return view;
  }

  MeshView full_view() const {
    MeshView full = view();
    full.colors = colors.data();
    full.component_ids = component_ids.data();
    full.patches = patches.data();
    full.occlusion = occlusion.data();
    return full;
  }
};

template <typename T>
T take(const std::string &bytes, size_t &at) {  // the tests' machines are little-endian
  T value;
  EXPECT_LE(at + sizeof value, bytes.size());
  std::memcpy(&value, bytes.data() + at, sizeof value);
  at += sizeof value;
  return value;
}

std::vector<std::vector<std::string>> words_of(const std::string &text) {
  std::vector<std::vector<std::string>> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    lines.emplace_back();
    for (std::string word; words >> word;) lines.back().push_back(word);
  }
  return lines;
}

float number(const std::string &word) {
  size_t read = 0;
  const float value = std::stof(word, &read);
  EXPECT_EQ(read, word.size()) << word;
  return value;
}

TEST_F(MeshFormatsTest, ObjHasColoursBehindThePosition) {
  Tetrahedron mesh;
  mesh.positions[8] = 3;  // stof refuses denormal numbers
  write_mesh(path("a.obj"), mesh.full_view(), MeshFormat::kObj);
  size_t vertex = 0;
  for (const auto &line : words_of(slurp(path("a.obj")))) {
    if (line[0] != "v") continue;
    ASSERT_EQ(line.size(), 7u);
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(number(line[1 + axis]), mesh.positions[3 * vertex + axis]);
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_EQ(std::lround(255 * number(line[4 + channel])), mesh.colors[4 * vertex + channel]);
    ++vertex;
  }
  EXPECT_EQ(vertex, 4u);
}

TEST_F(MeshFormatsTest, ObjTellsAllBytesOfAColourApart) {
  const std::vector<float> vectors(3 * 256);
  std::vector<uint8_t> colors;
  for (int i = 0; i < 256; ++i) colors.insert(colors.end(), {uint8_t(i), uint8_t(255 - i), 0, 255});
  MeshView view;
  view.vertex_count = 256;
  view.positions = view.normals = vectors.data();
  view.colors = colors.data();
  write_mesh(path("a.obj"), view, MeshFormat::kObj);
  int i = 0;
  for (const auto &line : words_of(slurp(path("a.obj")))) {
    if (line[0] != "v") continue;
    EXPECT_EQ(std::lround(255 * number(line[4])), i);
    EXPECT_EQ(std::lround(255 * number(line[5])), 255 - i);
    ++i;
  }
  EXPECT_EQ(i, 256);
}

// Names and types of a PLY file's properties of vertices, and where its numbers begin.
struct PlyHeader {
  std::string format;
  std::vector<std::string> properties;
  size_t end;
};

PlyHeader header_of(const std::string &bytes) {
  PlyHeader header;
  header.end = bytes.find("end_header\n") + 11;
  bool of_vertex = false;
  for (const auto &line : words_of(bytes.substr(0, header.end))) {
    if (line[0] == "format") header.format = line[1];
    if (line[0] == "element") of_vertex = line[1] == "vertex";
    if (line[0] == "property" && of_vertex) header.properties.push_back(line[1] + " " + line[2]);
  }
  return header;
}

TEST_F(MeshFormatsTest, PlyHasColoursAndAllTheRest) {
  for (const bool opaque : {true, false}) {
    Tetrahedron mesh;
    if (!opaque) mesh.colors[7] = 100;
    write_mesh(path("a.ply"), mesh.full_view(), MeshFormat::kPly);
    const std::string bytes = slurp(path("a.ply"));
    const PlyHeader header = header_of(bytes);
    std::vector<std::string> expected = {"float x",  "float y",   "float z",     "float nx",  "float ny",
                                         "float nz", "uchar red", "uchar green", "uchar blue"};
    if (!opaque) expected.push_back("uchar alpha");
    expected.insert(expected.end(), {"int owner", "int component", "uchar patch", "float occlusion"});
    EXPECT_EQ(header.properties, expected);
    size_t at = header.end;
    for (size_t i = 0; i < 5; ++i) {
      at += 24;
      for (size_t channel = 0; channel < (opaque ? 3 : 4); ++channel)
        EXPECT_EQ(take<uint8_t>(bytes, at), mesh.colors[4 * i + channel]);
      EXPECT_EQ(take<uint32_t>(bytes, at), mesh.owners[i]);
      EXPECT_EQ(take<uint32_t>(bytes, at), mesh.component_ids[i]);
      EXPECT_EQ(take<uint8_t>(bytes, at), mesh.patches[i]);
      EXPECT_EQ(take<float>(bytes, at), mesh.occlusion[i]);
    }
    EXPECT_EQ(bytes.size(), at + 4 * 13);
  }
}

TEST_F(MeshFormatsTest, PlyAsTextSaysTheSame) {
  for (const bool opaque : {true, false}) {
    Tetrahedron mesh;
    mesh.positions[8] = 3;
    if (!opaque) mesh.colors[7] = 100;
    write_mesh(path("a.ply"), mesh.full_view(), MeshFormat::kPly, true);
    write_mesh(path("b.ply"), mesh.full_view(), MeshFormat::kPly);
    const std::string text = slurp(path("a.ply"));
    const PlyHeader header = header_of(text);
    EXPECT_EQ(header.format, "ascii");
    EXPECT_EQ(header.properties, header_of(slurp(path("b.ply"))).properties);
    const auto lines = words_of(text.substr(header.end));
    ASSERT_EQ(lines.size(), 9u);
    for (size_t i = 0; i < 5; ++i) {
      std::vector<float> row(&mesh.positions[3 * i], &mesh.positions[3 * i] + 3);
      row.insert(row.end(), &mesh.normals[3 * i], &mesh.normals[3 * i] + 3);
      for (size_t channel = 0; channel < (opaque ? 3 : 4); ++channel) row.push_back(mesh.colors[4 * i + channel]);
      row.insert(row.end(),
                 {float(mesh.owners[i]), float(mesh.component_ids[i]), float(mesh.patches[i]), mesh.occlusion[i]});
      ASSERT_EQ(lines[i].size(), row.size());
      for (size_t k = 0; k < row.size(); ++k) EXPECT_EQ(number(lines[i][k]), row[k]);
    }
    for (size_t t = 0; t < 4; ++t) {
      ASSERT_EQ(lines[5 + t].size(), 4u);
      EXPECT_EQ(lines[5 + t][0], "3");
      for (int corner = 0; corner < 3; ++corner)
        EXPECT_EQ(std::stoul(lines[5 + t][1 + corner]), mesh.indices[3 * t + corner]);
    }
  }
}

TEST_F(MeshFormatsTest, OffHasPlacesOnce) {
  Tetrahedron mesh;
  mesh.positions[8] = 3;
  for (const bool colored : {false, true}) {
    write_mesh(path("a.off"), colored ? mesh.full_view() : mesh.view(), MeshFormat::kOff);
    auto lines = words_of(slurp(path("a.off")));
    ASSERT_EQ(lines.size(), 3u + 4 + 4);
    EXPECT_EQ(lines[0], std::vector<std::string>{colored ? "COFF" : "OFF"});
    EXPECT_EQ(lines[1][0], "#");
    EXPECT_EQ(lines[2], (std::vector<std::string>{"4", "4", "0"}));
    for (size_t i = 0; i < 4; ++i) {
      ASSERT_EQ(lines[3 + i].size(), colored ? 7u : 3u);
      for (size_t axis = 0; axis < 3; ++axis) EXPECT_EQ(number(lines[3 + i][axis]), mesh.positions[3 * i + axis]);
      for (size_t channel = 0; colored && channel < 4; ++channel)
        EXPECT_EQ(lines[3 + i][3 + channel], std::to_string(mesh.colors[4 * i + channel]));
    }
    EXPECT_EQ(lines[7], (std::vector<std::string>{"3", "0", "1", "2"}));
    EXPECT_EQ(lines[10], (std::vector<std::string>{"3", "2", "3", "0"}));  // 4 stands for 0
  }
}

TEST_F(MeshFormatsTest, MsmsIsAPairOfFiles) {
  EXPECT_EQ(mesh_files_of("a/b.vert"), (std::vector<std::string>{"a/b.vert", "a/b.face"}));
  EXPECT_EQ(mesh_files_of("a/b.ply"), (std::vector<std::string>{"a/b.ply"}));
  // A corner of a cube, of area 3/2 + sqrt(3)/2.
  const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  Tetrahedron mesh;
  MeshView view = mesh.view();
  view.vertex_count = 4;
  view.repeated_count = 0;
  mesh.indices[11] = 0;
  view.positions = positions.data();
  view.patches = mesh.patches.data();
  write_mesh(path("a.vert"), view, MeshFormat::kMsms);
  EXPECT_EQ(file_count(), 2u);
  const auto vertices = words_of(slurp(path("a.vert"))), faces = words_of(slurp(path("a.face")));
  ASSERT_EQ(vertices.size(), 3u + 4);
  ASSERT_EQ(faces.size(), 3u + 4);
  for (const auto &lines : {vertices, faces}) {
    EXPECT_EQ(lines[0][0], "#");
    EXPECT_EQ(lines[1][0][0], '#');
    EXPECT_EQ(lines[2][0], "4");
    EXPECT_EQ(lines[2][1], "100001");
    EXPECT_NEAR(number(lines[2][2]), 4 / (1.5 + std::sqrt(3.0) / 2), 0.006);
    EXPECT_EQ(number(lines[2][3]), 1.4f);
  }
  const char *const kKinds[] = {"3", "1", "2", "1"};  // contact, toroidal, reentrant, toroidal
  for (size_t i = 0; i < 4; ++i) {
    const auto &line = vertices[3 + i];
    ASSERT_EQ(line.size(), 9u);
    for (size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(number(line[axis]), positions[3 * i + axis]);
      EXPECT_NEAR(number(line[3 + axis]), mesh.normals[3 * i + axis], 1e-6);
    }
    EXPECT_EQ(line[7], std::to_string(mesh.owners[i] + 1));
    EXPECT_EQ(line[8], kKinds[i]);
  }
  const char *const kFaceKinds[] = {"1", "1", "1", "1"};  // of three kinds; two toroidal corners; the same; three kinds
  for (size_t t = 0; t < 4; ++t) {
    const auto &line = faces[3 + t];
    ASSERT_EQ(line.size(), 5u);
    for (size_t corner = 0; corner < 3; ++corner)
      EXPECT_EQ(line[corner], std::to_string(mesh.indices[3 * t + corner] + 1));
    EXPECT_EQ(line[3], kFaceKinds[t]);
  }
  mesh.patches = {0, 0, 2, 2, 2};
  view.patches = mesh.patches.data();
  write_mesh(path("a.vert"), view, MeshFormat::kMsms);
  const auto again = words_of(slurp(path("a.face")));
  for (size_t t = 0; t < 4; ++t) EXPECT_EQ(again[3 + t][3], (std::vector<std::string>{"3", "3", "2", "2"})[t]);
}

#if !defined(_WIN32)
// Neither file gets its name before both are written to the end.
TEST_F(MeshFormatsTest, MsmsThatTheDiskHasNoRoomForChangesNothing) {
  Tetrahedron mesh;
  write("a.vert", "old");
  write("a.face", "old");
  rlimit before, small;
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  small = before;
  small.rlim_cur = 250;  // the faces fit, the vertices do not
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string error =
      error_of(ErrorKind::kOutput, [&] { write_mesh(path("a.vert"), mesh.full_view(), MeshFormat::kMsms); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_HAS(error, "a.vert");
  EXPECT_EQ(slurp(path("a.vert")), "old");
  EXPECT_EQ(slurp(path("a.face")), "old");
  EXPECT_EQ(file_count(), 2u);
}
#endif

TEST_F(MeshFormatsTest, MsmsOfNothing) {
  write_mesh(path("a.vert"), MeshView(), MeshFormat::kMsms);
  for (const char *name : {"a.vert", "a.face"}) EXPECT_HAS(slurp(path(name)), "\n0 0 0.00 0.00\n");
}

TEST_F(MeshFormatsTest, MsmsWritesBothFilesOrNone) {
  Tetrahedron mesh;
  write("a.vert", "old");
  std::filesystem::create_directory(path("a.face"));  // where no file can be
  EXPECT_HAS(error_of(ErrorKind::kOutput, [&] { write_mesh(path("a.vert"), mesh.full_view(), MeshFormat::kMsms); }),
             "a.face");
  EXPECT_EQ(slurp(path("a.vert")), "old");
  EXPECT_EQ(file_count(), 2u);
}

// The chunks of a GLB file.
struct Glb {
  std::string json, binary;
};

Glb read_glb(const std::string &bytes) {
  size_t at = 0;
  EXPECT_EQ(take<uint32_t>(bytes, at), 0x46546C67u);  // "glTF"
  EXPECT_EQ(take<uint32_t>(bytes, at), 2u);
  EXPECT_EQ(take<uint32_t>(bytes, at), bytes.size());
  Glb glb;
  const uint32_t json_size = take<uint32_t>(bytes, at);
  EXPECT_EQ(json_size % 4, 0u);
  EXPECT_EQ(take<uint32_t>(bytes, at), 0x4E4F534Au);  // "JSON"
  glb.json = bytes.substr(at, json_size);
  at += json_size;
  if (at == bytes.size()) return glb;
  const uint32_t binary_size = take<uint32_t>(bytes, at);
  EXPECT_EQ(take<uint32_t>(bytes, at), 0x004E4942u);  // "BIN"
  glb.binary = bytes.substr(at);
  EXPECT_EQ(glb.binary.size(), binary_size);
  return glb;
}

// The JSON itself, and that it fits to the arrays, is looked at by cli_mesh_test.py, which has a parser.
TEST_F(MeshFormatsTest, GlbKeepsEveryBit) {
  const Tetrahedron mesh;
  MeshView view = mesh.full_view();
  write_mesh(path("a.glb"), view, MeshFormat::kGlb);
  const Glb glb = read_glb(slurp(path("a.glb")));
  size_t at = 0;
  for (const float position : mesh.positions) EXPECT_EQ(take<float>(glb.binary, at), position);
  for (const float component : mesh.normals) EXPECT_EQ(take<float>(glb.binary, at), component);
  for (size_t i = 0; i < 20; ++i) {
    const uint8_t value = take<uint8_t>(glb.binary, at);
    if (i % 4 == 3) {
      EXPECT_EQ(value, 255);
      continue;
    }
    // Back by the curve of sRGB; the linear byte is half a step off at most.
    const auto to_srgb = [](double linear) {
      return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    };
    const double low = 255 * to_srgb(std::max(0.0, (value - 0.5) / 255)), high = 255 * to_srgb((value + 0.5) / 255);
    EXPECT_GE(mesh.colors[i], low - 0.01);
    EXPECT_LE(mesh.colors[i], high + 0.01);
  }
  for (const uint32_t owner : mesh.owners) EXPECT_EQ(take<float>(glb.binary, at), float(owner));
  for (const uint32_t id : mesh.component_ids) EXPECT_EQ(take<float>(glb.binary, at), float(id));
  for (const float value : mesh.occlusion) EXPECT_EQ(take<float>(glb.binary, at), value);
  for (const uint32_t index : mesh.indices) EXPECT_EQ(take<uint32_t>(glb.binary, at), index);
  EXPECT_EQ(at, glb.binary.size());
  for (const char *part : {"\"COLOR_0\":2", "\"_ATOM\":3", "\"_COMPONENT\":4", "\"_OCCLUSION\":5", "\"indices\":6"})
    EXPECT_HAS(glb.json, part);
  EXPECT_EQ(glb.json.find("BLEND"), std::string::npos);
}

TEST_F(MeshFormatsTest, GlbLeavesOutNumbersThatFloatsCanNotTellApart) {
  Tetrahedron mesh;
  mesh.owners[3] = (1 << 24) - 1;
  write_mesh(path("a.glb"), mesh.view(), MeshFormat::kGlb);
  EXPECT_HAS(read_glb(slurp(path("a.glb"))).json, "_ATOM");
  mesh.owners[3] = 1 << 24;
  write_mesh(path("a.glb"), mesh.view(), MeshFormat::kGlb);
  EXPECT_EQ(read_glb(slurp(path("a.glb"))).json.find("_ATOM"), std::string::npos);
}

TEST_F(MeshFormatsTest, GlbHasNormalsOfUnitLength) {
  Tetrahedron mesh;
  mesh.normals[0] = 6;  // of length 6.05, then 0, then infinite
  mesh.normals[6] = 0;
  mesh.normals[9] = std::numeric_limits<float>::infinity();
  write_mesh(path("a.glb"), mesh.view(), MeshFormat::kGlb);
  const Glb glb = read_glb(slurp(path("a.glb")));
  size_t at = 5 * 12;
  for (int i = 0; i < 5; ++i) {
    const float x = take<float>(glb.binary, at), y = take<float>(glb.binary, at), z = take<float>(glb.binary, at);
    EXPECT_NEAR(std::sqrt(x * x + y * y + z * z), 1, 1e-6) << i;
    if (i == 0) {
      EXPECT_NEAR(x / y, 6 / 0.8, 1e-4);
    }
  }
}

TEST_F(MeshFormatsTest, GlbSaysWhereColoursAreNotOpaque) {
  Tetrahedron mesh;
  mesh.colors[7] = 254;
  write_mesh(path("a.glb"), mesh.full_view(), MeshFormat::kGlb);
  EXPECT_HAS(read_glb(slurp(path("a.glb"))).json, "\"alphaMode\":\"BLEND\"");
}

TEST_F(MeshFormatsTest, GlbOfNothingHasNoMesh) {
  write_mesh(path("a.glb"), MeshView(), MeshFormat::kGlb);
  const Glb glb = read_glb(slurp(path("a.glb")));
  EXPECT_EQ(glb.binary, "");
  EXPECT_HAS(glb.json, "\"scenes\"");
  EXPECT_EQ(glb.json.find("mesh"), std::string::npos);
}

TEST_F(MeshFormatsTest, GlbOfMoreThanItCanHoldIsRefused) {
  const Tetrahedron mesh;
  MeshView view = mesh.view();
  view.vertex_count = 100'000'000;  // 28 bytes each, and 12 per triangle
  view.triangle_count = 130'000'000;
  const std::string message = error_of(ErrorKind::kOutput, [&] { write_mesh(path("a.glb"), view, MeshFormat::kGlb); });
  for (const char *part : {"a.glb", "4158 MiB", "4 GiB", ".ply"}) EXPECT_HAS(message, part);
  view.vertex_count = 0;  // there must be room for what is said about the arrays, too
  view.triangle_count = (UINT32_MAX - 1000) / 12;
  EXPECT_HAS(error_of(ErrorKind::kOutput, [&] { write_mesh(path("a.glb"), view, MeshFormat::kGlb); }), "4095 MiB");
  EXPECT_EQ(file_count(), 0u);
}

TEST_F(MeshFormatsTest, TheUnitIsTold) {
  const Tetrahedron mesh;
  MeshView view = mesh.full_view();
  for (const char *unit : {"angstrom", "angstrom times 0.5"}) {
    view.unit = unit;
    for (const auto &[name, format] : {std::pair("a.obj", MeshFormat::kObj), std::pair("a.ply", MeshFormat::kPly),
                                       std::pair("a.stl", MeshFormat::kStl), std::pair("a.off", MeshFormat::kOff),
                                       std::pair("a.vert", MeshFormat::kMsms)}) {
      write_mesh(path(name), view, format);
      EXPECT_HAS(slurp(path(name)), std::string("lengths in ") + unit);
    }
    write_mesh(path("a.glb"), view, MeshFormat::kGlb);
    EXPECT_HAS(read_glb(slurp(path("a.glb"))).json, std::string("\"unit\":\"") + unit + "\"");
  }
}

TEST_F(MeshFormatsTest, LargeArraysAreWhole) {
  constexpr uint32_t kCount = 300'000;
  std::vector<float> positions, normals;
  for (uint32_t i = 0; i < kCount; ++i) {
    for (int axis = 0; axis < 3; ++axis) positions.push_back(float(3 * i + axis) * 0.37f);
    normals.insert(normals.end(), {0, 1, 0});
  }
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i + 2 < kCount; ++i) indices.insert(indices.end(), {i, i + 1, i + 2});
  MeshView view;
  view.vertex_count = kCount;
  view.triangle_count = kCount - 2;
  view.positions = positions.data();
  view.normals = normals.data();
  view.indices = indices.data();
  write_mesh(path("a.glb"), view, MeshFormat::kGlb);
  const Glb glb = read_glb(slurp(path("a.glb")));
  ASSERT_EQ(glb.binary.size(), 4 * (positions.size() + normals.size() + indices.size()));
  EXPECT_EQ(std::memcmp(glb.binary.data(), positions.data(), 4 * positions.size()), 0);
  EXPECT_EQ(std::memcmp(glb.binary.data() + 4 * positions.size(), normals.data(), 4 * normals.size()), 0);
  EXPECT_EQ(std::memcmp(glb.binary.data() + 8 * positions.size(), indices.data(), 4 * indices.size()), 0);
}

}  // namespace
}  // namespace quickses::io
