// SPDX-License-Identifier: MIT
// Triangle meshes to files: which writer writes which.
#include "io/mesh_writer.h"

#include <iterator>

#include "io/error.h"
#include "io/file_path.h"
#include "io/mesh_formats.h"
#include "io/text.h"

namespace quickses::io {
namespace {

constexpr struct {
  const char *extension;
  MeshFormat format;
} kExtensions[] = {{".obj", MeshFormat::kObj}, {".ply", MeshFormat::kPly},  {".stl", MeshFormat::kStl},
                   {".glb", MeshFormat::kGlb}, {".off", MeshFormat::kOff},  {".vert", MeshFormat::kMsms},
                   {".png", MeshFormat::kPng}, {".html", MeshFormat::kHtml}};

}  // namespace

std::optional<MeshFormat> find_mesh_format(const std::string &path) {
  const std::string extension = lower_extension(path_of(path));
  for (const auto &entry : kExtensions)
    if (extension == entry.extension) return entry.format;
  return std::nullopt;
}

MeshFormat mesh_format_of(const std::string &path) {
  if (const std::optional<MeshFormat> format = find_mesh_format(path)) return *format;
  std::string known;
  for (const auto &entry : kExtensions) known += std::string(" ") + entry.extension;
  const std::string extension = lower_extension(path_of(path));
  const std::string what = extension.empty() ? "has no extension" : "has the unknown extension '" + extension + "'";
  fail_usage("the output file '" + path + "' " + what + "; known are" + known);
}

std::vector<std::string> mesh_files_of(const std::string &path) {
  std::filesystem::path name = path_of(path);
  if (lower_extension(name) != ".vert") return {path};
  return {path, utf8_of(name.replace_extension(".face"))};
}

bool is_shown(MeshFormat format) { return format == MeshFormat::kPng || format == MeshFormat::kHtml; }

bool has_normals(MeshFormat format) {
  return format == MeshFormat::kObj || format == MeshFormat::kPly || format == MeshFormat::kGlb || is_shown(format);
}

bool has_colors(MeshFormat format) { return format != MeshFormat::kStl && format != MeshFormat::kMsms; }

bool has_occlusion(MeshFormat format) {
  return is_shown(format) || format == MeshFormat::kPly || format == MeshFormat::kGlb;
}

bool has_repeated_vertices(MeshFormat format) { return format != MeshFormat::kObj && format != MeshFormat::kOff; }

bool has_alpha(const MeshView &mesh) {
  for (size_t i = 0; mesh.colors && i < mesh.vertex_count; ++i)
    if (mesh.colors[4 * i + 3] != 255) return true;
  return false;
}

void write_mesh(const std::string &path, const MeshView &mesh, MeshFormat format, bool text) {
  if (is_shown(format)) fail_usage("'" + path + "' is no file of a mesh");
  AtomicFile file(path);
  switch (format) {
    case MeshFormat::kObj:
      write_obj(file, mesh);
      break;
    case MeshFormat::kPly:
      (text ? write_ply_text : write_ply)(file, mesh);
      break;
    case MeshFormat::kStl:
      write_stl(file, mesh);
      break;
    case MeshFormat::kGlb:
      write_glb(file, mesh);
      break;
    case MeshFormat::kOff:
      write_off(file, mesh);
      break;
    case MeshFormat::kMsms: {
      AtomicFile faces(mesh_files_of(path).back());
      write_msms(file, faces, mesh);
      faces.finish();
      file.finish();
      faces.publish();
      file.publish();
      return;
    }
    case MeshFormat::kPng:
    case MeshFormat::kHtml:
      break;
  }
  file.commit();
}

}  // namespace quickses::io
