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

constexpr FormatTraits kFormats[] = {
    // extension, format, shown, hard edges, colours, occlusion, repeated vertices
    {".obj", MeshFormat::kObj, false, true, true, false, false},
    {".ply", MeshFormat::kPly, false, true, true, true, true},
    {".stl", MeshFormat::kStl, false, false, false, false, true},
    {".glb", MeshFormat::kGlb, false, true, true, true, true},
    {".off", MeshFormat::kOff, false, false, true, false, false},
    {".vert", MeshFormat::kMsms, false, false, false, false, true},
    {".png", MeshFormat::kPng, true, true, true, true, true},
    {".html", MeshFormat::kHtml, true, true, true, true, true}};

}  // namespace

std::optional<MeshFormat> find_mesh_format(const std::string &path) {
  const std::string extension = lower_extension(path_of(path));
  for (const FormatTraits &entry : kFormats)
    if (extension == entry.extension) return entry.format;
  return std::nullopt;
}

MeshFormat mesh_format_of(const std::string &path) {
  if (const std::optional<MeshFormat> format = find_mesh_format(path)) return *format;
  std::string known;
  for (const FormatTraits &entry : kFormats) known += std::string(" ") + entry.extension;
  const std::string extension = lower_extension(path_of(path));
  const std::string what = extension.empty() ? "has no extension" : "has the unknown extension '" + extension + "'";
  fail_usage("the output file '" + path + "' " + what + "; known are" + known);
}

std::vector<std::string> mesh_files_of(const std::string &path) {
  std::filesystem::path name = path_of(path);
  if (lower_extension(name) != ".vert") return {path};
  return {path, utf8_of(name.replace_extension(".face"))};
}

const FormatTraits &format_traits_of(MeshFormat format) {
  const FormatTraits *found = kFormats;
  while (found->format != format) ++found;
  return *found;
}

bool has_alpha(const MeshView &mesh) {
  for (size_t i = 0; mesh.colors && i < mesh.vertex_count; ++i)
    if (mesh.colors[4 * i + 3] != 255) return true;
  return false;
}

void write_mesh(const std::string &path, const MeshView &mesh, MeshFormat format, bool text) {
  if (format_traits_of(format).is_shown) fail_usage("'" + path + "' is no file of a mesh");
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
      write_msms_vertices(file, mesh);
      file.finish();  // before the other is opened: both may be pipes that somebody reads one after the other
      AtomicFile faces(mesh_files_of(path).back());
      write_msms_faces(faces, mesh);
      faces.finish();
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
