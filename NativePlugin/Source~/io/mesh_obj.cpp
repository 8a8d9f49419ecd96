// SPDX-License-Identifier: MIT
// Meshes as Wavefront OBJ.
#include <algorithm>

#include "io/mesh_formats.h"
#include "io/mesh_rows.h"

namespace quickses::io {
namespace {

char *put_vector(char *out, const char *keyword, const float *vector) {
  while (*keyword != '\0') *out++ = *keyword++;
  for (int axis = 0; axis < 3; ++axis) {
    *out++ = ' ';
    out = put_text(out, vector[axis]);
  }
  return out;
}

// 0 to 1 for each byte, in three digits, which tell all of them apart.
class UnitTexts {
 public:
  UnitTexts() {
    for (int i = 0; i < 256; ++i)
      ends_[i] = std::to_chars(texts_[i], texts_[i] + kMost, i / 255.0, std::chars_format::fixed, 3).ptr;
  }

  char *put(char *out, uint8_t value) const { return std::copy<const char *>(texts_[value], ends_[value], out); }

 private:
  static constexpr size_t kMost = 8;
  char texts_[256][kMost];
  const char *ends_[256];
};

void put_colored_positions(AtomicFile &file, const MeshView &mesh) {
  const UnitTexts units;
  put_rows(file, place_count(mesh), 8 * kMaxNumber, [&](char *out, size_t i) {
    out = put_vector(out, "v", mesh.positions + 3 * i);
    for (int channel = 0; channel < 3; ++channel) {
      *out++ = ' ';
      out = units.put(out, mesh.colors[4 * i + channel]);
    }
    *out++ = '\n';
    return out;
  });
}

void put_vectors(AtomicFile &file, const char *keyword, const float *vectors, uint32_t count) {
  put_rows(file, count, 4 * kMaxNumber, [&](char *out, size_t i) {
    out = put_vector(out, keyword, vectors + 3 * i);
    *out++ = '\n';
    return out;
  });
}

}  // namespace

void write_obj(AtomicFile &file, const MeshView &mesh) {
  file.write("# QuickSES molecular surface, lengths in " + mesh.unit + "\n");
  if (mesh.colors)
    put_colored_positions(file, mesh);
  else
    put_vectors(file, "v", mesh.positions, place_count(mesh));
  put_vectors(file, "vn", mesh.normals, mesh.vertex_count);
  put_rows(file, mesh.triangle_count, 6 * kMaxNumber, [&](char *out, size_t t) {
    *out++ = 'f';
    for (int corner = 0; corner < 3; ++corner) {
      *out++ = ' ';
      const uint32_t vertex = mesh.indices[3 * t + corner];
      out = put_text(out, place_of(mesh, vertex) + 1);  // OBJ counts from 1
      *out++ = '/';
      *out++ = '/';
      out = put_text(out, vertex + 1);
    }
    *out++ = '\n';
    return out;
  });
}

}  // namespace quickses::io
