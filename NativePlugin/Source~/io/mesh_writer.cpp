// SPDX-License-Identifier: MIT
// Triangle meshes to files: OBJ, binary PLY, binary STL.
#include "io/mesh_writer.h"

#include <charconv>
#include <cmath>
#include <cstring>

#include "io/atomic_file.h"
#include "io/error.h"
#include "io/file_path.h"
#include "io/text.h"

namespace quickses::io {
namespace {

// What to_chars needs at most for a float (-1.17549435e-38) or a 32-bit number, with room for a separator.
constexpr size_t kMaxNumber = 24;

char *put(char *out, float value) { return std::to_chars(out, out + kMaxNumber, value).ptr; }
char *put(char *out, uint32_t value) { return std::to_chars(out, out + kMaxNumber, value).ptr; }

// Little-endian bytes on any machine; compilers make one store of it.
char *put_binary(char *out, uint32_t value) {
  for (int i = 0; i < 4; ++i) *out++ = static_cast<char>(value >> (8 * i));
  return out;
}

char *put_binary(char *out, float value) {
  uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return put_binary(out, bits);
}

char *put_binary(char *out, const float *vector) {
  for (int axis = 0; axis < 3; ++axis) out = put_binary(out, vector[axis]);
  return out;
}

void put_obj_vectors(AtomicFile &file, const char *keyword, const float *vectors, uint32_t count) {
  const size_t keyword_size = std::strlen(keyword);
  for (size_t i = 0; i < count; ++i) {
    char *const begin = file.reserve(keyword_size + 3 * kMaxNumber);
    char *out = begin;
    std::memcpy(out, keyword, keyword_size);
    out += keyword_size;
    for (int axis = 0; axis < 3; ++axis) {
      *out++ = ' ';
      out = put(out, vectors[3 * i + axis]);
    }
    *out++ = '\n';
    file.advance(out - begin);
  }
}

void write_obj(AtomicFile &file, const MeshView &mesh) {
  file.write("# QuickSES molecular surface, lengths in angstrom\n");
  const uint32_t places = mesh.vertex_count - mesh.repeated_count;
  put_obj_vectors(file, "v", mesh.positions, places);
  put_obj_vectors(file, "vn", mesh.normals, mesh.vertex_count);
  for (size_t t = 0; t < mesh.triangle_count; ++t) {
    char *const begin = file.reserve(6 * kMaxNumber);
    char *out = begin;
    *out++ = 'f';
    for (int corner = 0; corner < 3; ++corner) {
      *out++ = ' ';
      const uint32_t vertex = mesh.indices[3 * t + corner];
      out = put(out, (vertex < places ? vertex : mesh.repeated[vertex - places]) + 1);  // OBJ counts from 1
      *out++ = '/';
      *out++ = '/';
      out = put(out, vertex + 1);
    }
    *out++ = '\n';
    file.advance(out - begin);
  }
}

void write_ply(AtomicFile &file, const MeshView &mesh) {
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  header += "comment QuickSES molecular surface, lengths in angstrom\n";
  header += "element vertex " + std::to_string(mesh.vertex_count) + "\n";
  for (const char *name : {"x", "y", "z", "nx", "ny", "nz"}) header += std::string("property float ") + name + "\n";
  if (mesh.owners) header += "property int owner\n";
  if (mesh.component_ids) header += "property int component\n";
  if (mesh.patches) header += "property uchar patch\n";
  header += "element face " + std::to_string(mesh.triangle_count) + "\n";
  header += "property list uchar uint vertex_indices\nend_header\n";
  file.write(header);
  for (size_t i = 0; i < mesh.vertex_count; ++i) {
    char *const begin = file.reserve(36);
    char *out = put_binary(begin, mesh.positions + 3 * i);
    out = put_binary(out, mesh.normals + 3 * i);
    if (mesh.owners) out = put_binary(out, mesh.owners[i]);
    if (mesh.component_ids) out = put_binary(out, mesh.component_ids[i]);
    if (mesh.patches) *out++ = static_cast<char>(mesh.patches[i]);
    file.advance(out - begin);
  }
  for (size_t t = 0; t < mesh.triangle_count; ++t) {
    char *const begin = file.reserve(16);
    char *out = begin;
    *out++ = 3;
    for (int corner = 0; corner < 3; ++corner) out = put_binary(out, mesh.indices[3 * t + corner]);
    file.advance(out - begin);
  }
}

void write_stl(AtomicFile &file, const MeshView &mesh) {
  char header[84] = "QuickSES molecular surface, binary STL, lengths in angstrom";
  put_binary(header + 80, mesh.triangle_count);
  file.write(header, sizeof header);
  for (size_t t = 0; t < mesh.triangle_count; ++t) {
    const float *corners[3];
    for (int corner = 0; corner < 3; ++corner)
      corners[corner] = mesh.positions + 3 * size_t(mesh.indices[3 * t + corner]);
    double u[3], v[3];
    for (int axis = 0; axis < 3; ++axis) {
      u[axis] = double(corners[1][axis]) - corners[0][axis];
      v[axis] = double(corners[2][axis]) - corners[0][axis];
    }
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    const double scale = length > 0 ? 1 / length : 0;
    char *const begin = file.reserve(50);
    char *out = begin;
    for (double component : n) out = put_binary(out, static_cast<float>(component * scale));
    for (const float *corner : corners) out = put_binary(out, corner);
    *out++ = 0;
    *out++ = 0;
    file.advance(out - begin);
  }
}

}  // namespace

MeshFormat mesh_format_of(const std::string &path) {
  const std::string extension = lower_extension(path_of(path));
  if (extension == ".obj") return MeshFormat::kObj;
  if (extension == ".ply") return MeshFormat::kPly;
  if (extension == ".stl") return MeshFormat::kStl;
  const std::string what = extension.empty() ? "has no extension" : "has the unknown extension '" + extension + "'";
  fail_usage("the output file '" + path + "' " + what + "; known are .obj .ply .stl");
}

void write_mesh(const std::string &path, const MeshView &mesh, MeshFormat format) {
  AtomicFile file(path);
  switch (format) {
    case MeshFormat::kObj:
      write_obj(file, mesh);
      break;
    case MeshFormat::kPly:
      write_ply(file, mesh);
      break;
    case MeshFormat::kStl:
      write_stl(file, mesh);
      break;
  }
  file.commit();
}

}  // namespace quickses::io
