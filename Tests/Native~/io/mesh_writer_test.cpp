// SPDX-License-Identifier: MIT
// Mesh writers: what they wrote is read back by code of the tests' own.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <sstream>
#include <vector>

#include "io/atomic_file.h"
#include "io/io_fixture.h"
#include "io/mesh_writer.h"

#if defined(__linux__)
#include <fcntl.h>
#include <unistd.h>
#endif

namespace quickses::io {
namespace {

namespace fs = std::filesystem;

class MeshWriterTest : public IoTest {};

// A tetrahedron with coordinates that short decimals can't say.
struct Tetrahedron {
  std::vector<float> positions = {1.0f / 3,    0.1f,         -2.0f / 7, 1e-7f,
                                  123.456789f, 16777217.0f,  -0.0f,     std::nextafter(1.0f, 2.0f),
                                  3e-39f,      -98765.4321f, 5,         std::numeric_limits<float>::min()};
  std::vector<float> normals = {0.6f, 0.8f, 0, 0, 0.70710678f, 0.70710678f, -1, 0, 0, 0, -1.0f / 3, 0.94280905f};
  std::vector<uint32_t> owners = {0, 7, 100000, 3};
  std::vector<uint32_t> component_ids = {0, 5, 1, 70000};
  std::vector<uint8_t> patches = {0, 1, 2, 1};
  std::vector<uint32_t> indices = {0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0};

  MeshView view() const {
    MeshView view;
    view.vertex_count = 4;
    view.triangle_count = 4;
    view.positions = positions.data();
    view.normals = normals.data();
    view.owners = owners.data();
    view.indices = indices.data();
    return view;
  }
};

template <typename T>
T take(const std::string &bytes, size_t &position) {  // the tests' machines are little-endian
  T value;
  std::memcpy(&value, bytes.data() + position, sizeof value);
  position += sizeof value;
  return value;
}

TEST_F(MeshWriterTest, ObjKeepsEveryBit) {
  const Tetrahedron mesh;
  write_mesh(path("a.obj"), mesh.view(), MeshFormat::kObj);
  std::istringstream lines(slurp(path("a.obj")));
  std::vector<float> positions, normals;
  std::vector<uint32_t> indices;
  std::string line;
  while (std::getline(lines, line)) {
    if (line[0] == '#') continue;
    unsigned f[6];
    char a[64], b[64], c[64], rest;
    if (std::sscanf(line.c_str(), "v %63s %63s %63s %c", a, b, c, &rest) == 3) {
      for (const char *text : {a, b, c}) positions.push_back(std::strtof(text, nullptr));
    } else if (std::sscanf(line.c_str(), "vn %63s %63s %63s %c", a, b, c, &rest) == 3) {
      for (const char *text : {a, b, c}) normals.push_back(std::strtof(text, nullptr));
    } else if (std::sscanf(line.c_str(), "f %u//%u %u//%u %u//%u %c", f, f + 1, f + 2, f + 3, f + 4, f + 5, &rest) ==
               6) {
      for (int corner = 0; corner < 3; ++corner) {
        EXPECT_EQ(f[2 * corner], f[2 * corner + 1]);
        indices.push_back(f[2 * corner] - 1);
      }
    } else {
      ADD_FAILURE() << line;
    }
  }
  ASSERT_EQ(positions.size(), mesh.positions.size());
  EXPECT_EQ(std::memcmp(positions.data(), mesh.positions.data(), positions.size() * sizeof(float)), 0);
  EXPECT_EQ(normals, mesh.normals);
  EXPECT_EQ(indices, mesh.indices);
}

TEST_F(MeshWriterTest, ObjHasThePlaceOfARepeatedVertexOnce) {
  Tetrahedron mesh;
  mesh.indices[11] = 4;  // for vertex 0
  mesh.positions.insert(mesh.positions.end(), mesh.positions.begin(), mesh.positions.begin() + 3);
  mesh.normals.insert(mesh.normals.end(), {0, 0, 1});
  MeshView view = mesh.view();
  const uint32_t repeated = 0;
  view.vertex_count = 5;
  view.repeated = &repeated;
  view.repeated_count = 1;
  write_mesh(path("a.obj"), view, MeshFormat::kObj);
  const std::string text = slurp(path("a.obj"));
  const auto has = [&](const char *line) { return text.find(line) != std::string::npos; };
  size_t positions = 0, normals = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    positions += line.compare(0, 2, "v ") == 0;
    normals += line.compare(0, 3, "vn ") == 0;
  }
  EXPECT_EQ(positions, 4u);
  EXPECT_EQ(normals, 5u);
  EXPECT_TRUE(has("vn 0 0 1\n"));
  EXPECT_TRUE(has("f 1//1 2//2 3//3\n"));
  EXPECT_TRUE(has("f 3//3 4//4 1//5\n"));
}

TEST_F(MeshWriterTest, PlyKeepsEveryBit) {
  const Tetrahedron mesh;
  for (const int kind : {0, 1, 2, 3}) {
    const bool with_patches = kind % 2 != 0, with_components = kind > 1;
    MeshView view = mesh.view();
    if (with_patches) view.patches = mesh.patches.data();
    if (with_components) view.component_ids = mesh.component_ids.data();
    write_mesh(path("a.ply"), view, MeshFormat::kPly);
    const std::string bytes = slurp(path("a.ply"));
    const std::string end = "end_header\n";
    size_t at = bytes.find(end);
    ASSERT_NE(at, std::string::npos);
    std::string header = bytes.substr(0, at);
    header.erase(header.find("comment"), header.find("element vertex") - header.find("comment"));
    EXPECT_EQ(header, std::string("ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
                                  "property float y\nproperty float z\nproperty float nx\nproperty float ny\n"
                                  "property float nz\nproperty int owner\n") +
                          (with_components ? "property int component\n" : "") +
                          (with_patches ? "property uchar patch\n" : "") +
                          "element face 4\nproperty list uchar uint vertex_indices\n");
    at += end.size();
    for (int i = 0; i < 4; ++i) {
      float vertex[6];
      for (float &number : vertex) number = take<float>(bytes, at);
      EXPECT_EQ(std::memcmp(vertex, &mesh.positions[3 * i], 12), 0);
      EXPECT_EQ(std::memcmp(vertex + 3, &mesh.normals[3 * i], 12), 0);
      EXPECT_EQ(take<uint32_t>(bytes, at), mesh.owners[i]);
      if (with_components) {
        EXPECT_EQ(take<uint32_t>(bytes, at), mesh.component_ids[i]);
      }
      if (with_patches) {
        EXPECT_EQ(take<uint8_t>(bytes, at), mesh.patches[i]);
      }
    }
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(take<uint8_t>(bytes, at), 3);
      for (int corner = 0; corner < 3; ++corner) EXPECT_EQ(take<uint32_t>(bytes, at), mesh.indices[3 * i + corner]);
    }
    EXPECT_EQ(at, bytes.size());
  }
}

TEST_F(MeshWriterTest, StlRepeatsCornersUnderThePlanesNormal) {
  const std::vector<float> positions = {0, 0, 0, 2, 0, 0, 0, 3, 0};
  const std::vector<uint32_t> indices = {0, 1, 2};
  MeshView view;
  view.vertex_count = 3;
  view.triangle_count = 1;
  view.positions = view.normals = positions.data();
  view.indices = indices.data();
  write_mesh(path("a.stl"), view, MeshFormat::kStl);
  const std::string bytes = slurp(path("a.stl"));
  ASSERT_EQ(bytes.size(), 84u + 50u);
  EXPECT_NE(bytes.substr(0, 5), "solid");  // that would announce text
  size_t at = 80;
  EXPECT_EQ(take<uint32_t>(bytes, at), 1u);
  for (float expected : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 2.f, 0.f, 0.f, 0.f, 3.f, 0.f})
    EXPECT_EQ(take<float>(bytes, at), expected);
  EXPECT_EQ(take<uint16_t>(bytes, at), 0);
  const std::vector<uint32_t> flat = {0, 1, 1};  // has none, which is said by zeros
  view.indices = flat.data();
  write_mesh(path("a.stl"), view, MeshFormat::kStl);
  const std::string without = slurp(path("a.stl"));
  at = 84;
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(take<float>(without, at), 0);
}

TEST_F(MeshWriterTest, MeshesLargerThanTheBufferAreWhole) {
  constexpr uint32_t kCount = 200'000;
  std::vector<float> positions, normals(3 * kCount, 0.5f);
  for (uint32_t i = 0; i < 3 * kCount; ++i) positions.push_back(float(i) * 0.37f);
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i + 2 < kCount; ++i) indices.insert(indices.end(), {i, i + 1, i + 2});
  MeshView view;
  view.vertex_count = kCount;
  view.triangle_count = kCount - 2;
  view.positions = positions.data();
  view.normals = normals.data();
  view.indices = indices.data();
  write_mesh(path("a.ply"), view, MeshFormat::kPly);
  const std::string bytes = slurp(path("a.ply"));
  size_t at = bytes.find("end_header\n") + 11;
  ASSERT_EQ(bytes.size(), at + 24 * size_t(kCount) + 13 * size_t(kCount - 2));
  for (uint32_t i = 0; i < kCount; ++i) {
    for (int axis = 0; axis < 3; ++axis) ASSERT_EQ(take<float>(bytes, at), positions[3 * i + axis]);
    at += 12;
  }
  for (uint32_t i = 0; i < kCount - 2; ++i) {
    ++at;
    for (int corner = 0; corner < 3; ++corner) ASSERT_EQ(take<uint32_t>(bytes, at), indices[3 * i + corner]);
  }
}

TEST_F(MeshWriterTest, MeshFormatFollowsTheExtension) {
  EXPECT_EQ(mesh_format_of("a.b/c.OBJ"), MeshFormat::kObj);
  EXPECT_EQ(mesh_format_of("c.ply"), MeshFormat::kPly);
  EXPECT_EQ(mesh_format_of("c.stl"), MeshFormat::kStl);
  EXPECT_EQ(mesh_format_of("c.glb"), MeshFormat::kGlb);
  EXPECT_EQ(mesh_format_of("c.off"), MeshFormat::kOff);
  EXPECT_EQ(mesh_format_of("c.vert"), MeshFormat::kMsms);
  EXPECT_EQ(mesh_format_of("c.PNG"), MeshFormat::kPng);
  EXPECT_EQ(mesh_format_of("c.html"), MeshFormat::kHtml);
  for (const char *name : {"c.xyz", "c", "obj"}) {
    const std::string message = error_of(ErrorKind::kUsage, [&] { mesh_format_of(name); });
    for (const char *known : {".obj", ".ply", ".stl", ".glb", ".off", ".vert"}) EXPECT_HAS(message, known);
  }
}

TEST_F(MeshWriterTest, WritingReplacesTheFileAtOnceAndLeavesNothingElse) {
  const std::string target = write("a.obj", "old");
  write_mesh(target, Tetrahedron().view(), MeshFormat::kObj);
  EXPECT_NE(slurp(target), "old");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(MeshWriterTest, AFileThatIsNotFinishedNeverShows) {
  const std::string target = write("a.obj", "old");
  {
    AtomicFile file(target);
    file.write(std::string(3 << 20, 'x'));
    EXPECT_EQ(slurp(target), "old");
  }
  EXPECT_EQ(slurp(target), "old");
  EXPECT_EQ(file_count(), 1u);
  check_writable(target);
  check_writable(path("new.obj"));
  EXPECT_EQ(slurp(target), "old");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(MeshWriterTest, PlacesThatCanNotBeWrittenAreNamed) {
  const auto error_at = [](const std::string &target) {
    const std::string message = error_of(ErrorKind::kOutput, [&] { check_writable(target); });
    EXPECT_HAS(message, target);
    return message;
  };
  EXPECT_HAS(error_at(path("none/a.obj")), "folder");
  fs::create_directory(path("d.obj"));
  EXPECT_HAS(error_at(path("d.obj")), "directory");
  write("file", "");
  error_at(path("file/a.obj"));
}

#if defined(__linux__)
TEST_F(MeshWriterTest, AFullDiskIsReported) {
  const Tetrahedron mesh;
  for (MeshFormat format : {MeshFormat::kObj, MeshFormat::kPly, MeshFormat::kStl, MeshFormat::kGlb, MeshFormat::kOff})
    EXPECT_HAS(error_of(ErrorKind::kOutput, [&] { write_mesh("/dev/full", mesh.view(), format); }), "/dev/full");
  for (const size_t size : {size_t{1}, AtomicFile::kBufferSize, AtomicFile::kBufferSize + 1})
    EXPECT_HAS(error_of(ErrorKind::kOutput,
                        [&] {
                          AtomicFile file("/dev/full");
                          file.write(std::string(size, 'x'));
                          file.commit();
                        }),
               "/dev/full");
}

// Another machine, or a process that was killed and had the same number, as those of containers often have.
TEST_F(MeshWriterTest, TemporaryFilesOfOthersStay) {
  const auto name_of = [](int number) {
    return ".quickses-" + std::to_string(getpid()) + "-" + std::to_string(number) + ".tmp";
  };
  constexpr int kMany = 400;  // more than this program has made by now
  for (int k = 0; k < kMany; ++k) write(name_of(k), "other");
  write_mesh(path("a.obj"), Tetrahedron().view(), MeshFormat::kObj);
  EXPECT_HAS(slurp(path("a.obj")), "QuickSES");
  for (int k = 0; k < kMany; ++k) ASSERT_EQ(slurp(path(name_of(k))), "other");
  EXPECT_EQ(file_count(), kMany + 1u);
}

// What a link of the system leads to may have no name any more.
TEST_F(MeshWriterTest, AFileWithoutANameIsWrittenDirectly) {
  const std::string name = write("a.txt", "");
  const int descriptor = open(name.c_str(), O_RDWR);
  ASSERT_GE(descriptor, 0);
  fs::remove(name);
  AtomicFile file("/proc/thread-self/fd/" + std::to_string(descriptor));
  file.write("content");
  file.commit();
  char bytes[16] = {};
  EXPECT_EQ(pread(descriptor, bytes, sizeof bytes, 0), 7);
  EXPECT_STREQ(bytes, "content");
  close(descriptor);
  EXPECT_EQ(file_count(), 0u);
}

TEST_F(MeshWriterTest, LinksStayLinks) {
  write("target.obj", "old");
  fs::create_symlink("target.obj", path("link.obj"));
  write_mesh(path("link.obj"), Tetrahedron().view(), MeshFormat::kObj);
  EXPECT_TRUE(fs::is_symlink(path("link.obj")));
  EXPECT_NE(slurp(path("target.obj")), "old");
}
#endif

}  // namespace
}  // namespace quickses::io
