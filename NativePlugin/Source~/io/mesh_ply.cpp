// SPDX-License-Identifier: MIT
// Meshes as PLY, binary and as text.
#include <string>

#include "io/mesh_formats.h"
#include "io/mesh_rows.h"

namespace quickses::io {
namespace {

std::string header_of(const MeshView &mesh, const char *format, bool alpha) {
  std::string header = std::string("ply\nformat ") + format + " 1.0\n";
  header += "comment QuickSES molecular surface, lengths in " + mesh.unit + "\n";
  header += "element vertex " + std::to_string(mesh.vertex_count) + "\n";
  for (const char *name : {"x", "y", "z", "nx", "ny", "nz"}) header += std::string("property float ") + name + "\n";
  if (mesh.colors) {
    for (const char *name : {"red", "green", "blue"}) header += std::string("property uchar ") + name + "\n";
    if (alpha) header += "property uchar alpha\n";
  }
  if (mesh.owners) header += "property int owner\n";
  if (mesh.component_ids) header += "property int component\n";
  if (mesh.patches) header += "property uchar patch\n";
  if (mesh.occlusion) header += "property float occlusion\n";
  header += "element face " + std::to_string(mesh.triangle_count) + "\n";
  return header + "property list uchar uint vertex_indices\nend_header\n";
}

}  // namespace

void write_ply(AtomicFile &file, const MeshView &mesh) {
  const bool alpha = has_alpha(mesh);
  file.write(header_of(mesh, "binary_little_endian", alpha));
  const int channels = mesh.colors ? (alpha ? 4 : 3) : 0;
  put_rows(file, mesh.vertex_count, 48, [&](char *out, size_t i) {
    out = put_binary(out, mesh.positions + 3 * i);
    out = put_binary(out, mesh.normals + 3 * i);
    for (int channel = 0; channel < channels; ++channel) *out++ = static_cast<char>(mesh.colors[4 * i + channel]);
    if (mesh.owners) out = put_binary(out, mesh.owners[i]);
    if (mesh.component_ids) out = put_binary(out, mesh.component_ids[i]);
    if (mesh.patches) *out++ = static_cast<char>(mesh.patches[i]);
    if (mesh.occlusion) out = put_binary(out, mesh.occlusion[i]);
    return out;
  });
  put_rows(file, mesh.triangle_count, 16, [&](char *out, size_t t) {
    *out++ = 3;
    for (int corner = 0; corner < 3; ++corner) out = put_binary(out, mesh.indices[3 * t + corner]);
    return out;
  });
}

void write_ply_text(AtomicFile &file, const MeshView &mesh) {
  const bool alpha = has_alpha(mesh);
  file.write(header_of(mesh, "ascii", alpha));
  const int channels = mesh.colors ? (alpha ? 4 : 3) : 0;
  const auto put = [](char *out, auto value) {
    out = put_text(out, value);
    *out++ = ' ';
    return out;
  };
  put_rows(file, mesh.vertex_count, 14 * kMaxNumber, [&](char *out, size_t i) {
    for (int axis = 0; axis < 3; ++axis) out = put(out, mesh.positions[3 * i + axis]);
    for (int axis = 0; axis < 3; ++axis) out = put(out, mesh.normals[3 * i + axis]);
    for (int channel = 0; channel < channels; ++channel) out = put(out, uint32_t{mesh.colors[4 * i + channel]});
    if (mesh.owners) out = put(out, mesh.owners[i]);
    if (mesh.component_ids) out = put(out, mesh.component_ids[i]);
    if (mesh.patches) out = put(out, uint32_t{mesh.patches[i]});
    if (mesh.occlusion) out = put(out, mesh.occlusion[i]);
    out[-1] = '\n';
    return out;
  });
  put_rows(file, mesh.triangle_count, 4 * kMaxNumber, [&](char *out, size_t t) {
    out = put(out, uint32_t{3});
    for (int corner = 0; corner < 3; ++corner) out = put(out, mesh.indices[3 * t + corner]);
    out[-1] = '\n';
    return out;
  });
}

}  // namespace quickses::io
