// SPDX-License-Identifier: MIT
// Meshes as the pair of files that MSMS writes: Sanner, Olson and Spehner, Biopolymers 38, 305-320 (1996), and the
// manual page of MSMS 2.6.
#include <cmath>
#include <string>

#include "io/mesh_formats.h"
#include "io/mesh_rows.h"

namespace quickses::io {
namespace {

// MSMS's numbers of qses_patch: contact, toroidal, reentrant.
constexpr uint32_t kKinds[] = {3, 1, 2};

// Of a triangle: that of most of its corners. Where all three differ, it lies on the toroidal patch, since that is
// between the others.
uint32_t kind_of(const MeshView &mesh, size_t t) {
  uint32_t kinds[3];
  for (int corner = 0; corner < 3; ++corner) kinds[corner] = kKinds[mesh.patches[mesh.indices[3 * t + corner]]];
  if (kinds[0] == kinds[1] || kinds[0] == kinds[2]) return kinds[0];
  return kinds[1] == kinds[2] ? kinds[1] : 1;
}

// Vertices per square of the unit.
double density_of(const MeshView &mesh) {
  double area = 0;
  for (size_t t = 0; t < mesh.triangle_count; ++t) {
    const float *const a = mesh.positions + 3 * size_t(mesh.indices[3 * t]);
    const float *const b = mesh.positions + 3 * size_t(mesh.indices[3 * t + 1]);
    const float *const c = mesh.positions + 3 * size_t(mesh.indices[3 * t + 2]);
    double u[3], v[3];
    for (int axis = 0; axis < 3; ++axis) {
      u[axis] = double(b[axis]) - a[axis];
      v[axis] = double(c[axis]) - a[axis];
    }
    area += std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2;
  }
  return area > 0 ? mesh.vertex_count / area : 0;
}

// The three lines before the numbers; what: "vertices" or "faces", noun: as MSMS names their number.
std::string header_of(const MeshView &mesh, const char *what, const char *noun, uint32_t count) {
  const auto fixed = [](double value) {
    char text[400];  // the largest double has 309 digits before the point
    return std::string(text, std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, 2).ptr);
  };
  return std::string("# QuickSES molecular surface, ") + what + ", lengths in " + mesh.unit + "\n#" + noun +
         " #sphere density probe_r\n" + std::to_string(count) + " " + std::to_string(mesh.atom_count) + " " +
         fixed(density_of(mesh)) + " " + fixed(mesh.probe_radius) + "\n";
}

char *put_fixed(char *out, float value) {
  // The largest float takes 39 digits, a sign and six behind the point.
  out = std::to_chars(out, out + 48, value, std::chars_format::fixed, 6).ptr;
  *out++ = ' ';
  return out;
}

}  // namespace

void write_msms_vertices(AtomicFile &file, const MeshView &mesh) {
  file.write(header_of(mesh, "vertices", "vertex", mesh.vertex_count));
  put_rows(file, mesh.vertex_count, 6 * 50 + 3 * kMaxNumber, [&](char *out, size_t i) {
    for (int axis = 0; axis < 3; ++axis) out = put_fixed(out, mesh.positions[3 * i + axis]);
    for (int axis = 0; axis < 3; ++axis) out = put_fixed(out, mesh.normals[3 * i + axis]);
    *out++ = '0';
    *out++ = ' ';
    out = put_text(out, mesh.owners[i] + 1);
    *out++ = ' ';
    out = put_text(out, kKinds[mesh.patches[i]]);
    *out++ = '\n';
    return out;
  });
}

void write_msms_faces(AtomicFile &file, const MeshView &mesh) {
  file.write(header_of(mesh, "faces", "faces", mesh.triangle_count));
  put_rows(file, mesh.triangle_count, 5 * kMaxNumber, [&](char *out, size_t t) {
    for (int corner = 0; corner < 3; ++corner) {
      out = put_text(out, mesh.indices[3 * t + corner] + 1);
      *out++ = ' ';
    }
    out = put_text(out, kind_of(mesh, t));
    *out++ = ' ';
    *out++ = '0';
    *out++ = '\n';
    return out;
  });
}

}  // namespace quickses::io
