// SPDX-License-Identifier: MIT
// Triangle meshes to files: OBJ, PLY, STL, GLB, OFF, MSMS.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace quickses::io {

// The last two show a mesh, and are written elsewhere (render/): a picture and a web page.
enum class MeshFormat { kObj, kPly, kStl, kGlb, kOff, kMsms, kPng, kHtml };

// A mesh in the caller's memory.
struct MeshView {
  uint32_t vertex_count = 0;
  uint32_t triangle_count = 0;
  const float *positions = nullptr;         // vertex_count x 3
  const float *normals = nullptr;           // vertex_count x 3, unit length
  const uint32_t *owners = nullptr;         // vertex_count, or null
  const uint8_t *patches = nullptr;         // vertex_count of qses_patch, or null
  const uint32_t *component_ids = nullptr;  // vertex_count, or null
  const uint8_t *colors = nullptr;          // vertex_count x 4, sRGB and alpha, or null
  const float *occlusion = nullptr;         // vertex_count, how open the surface is there, 0 to 1, or null
  const uint32_t *indices = nullptr;        // triangle_count x 3
  // Of the last repeated_count vertices: which one each stands for with a normal of its own, at the same place.
  const uint32_t *repeated = nullptr;
  uint32_t repeated_count = 0;
  std::string unit = "angstrom";  // of the positions, for readers of the file
  // What MSMS files tell besides.
  uint32_t atom_count = 0;
  float probe_radius = 0;
};

// The format that the extension of a file name stands for, or nothing.
std::optional<MeshFormat> find_mesh_format(const std::string &path);
// Throws Error (kUsage) that lists the known ones.
MeshFormat mesh_format_of(const std::string &path);

// The files that write_mesh makes under this name: itself first.
std::vector<std::string> mesh_files_of(const std::string &path);

// What files of a format can hold.
struct FormatTraits {
  const char *extension;
  MeshFormat format;
  bool is_shown;        // it shows a mesh and holds none that programs could read
  bool has_hard_edges;  // vertices have normals that light can break at
  bool has_colors;
  bool has_occlusion;
  bool has_repeated_vertices;  // one that is repeated is written like any other, with all it has; else its place once
};
const FormatTraits &format_traits_of(MeshFormat format);

// Writes a mesh. The file appears under its name when it is complete; after an error what was there before is
// unchanged. Throws Error (kOutput).
//   OBJ   v, vn, f a//b; every number in the fewest digits from which the float32 can be read back; no owners. A place
//         is written once, so that the mesh is closed by its numbers also where vertices are repeated. Colours are
//         three numbers from 0 to 1 behind the position: an extension that many programs read
//   PLY   binary little-endian, or text; float x y z nx ny nz, uchar red green blue (and alpha, where one is below
//         255), int owner, int component, uchar patch, float occlusion where there are any; uchar/uint vertex_indices
//   STL   binary; the plane's normal per triangle; vertices are repeated, no owners
//   GLB   binary glTF 2.0 in one file of 4 GiB at most; POSITION, NORMAL, COLOR_0 (linear, as glTF wants it), and as
//         float32 _ATOM, _COMPONENT (each if all numbers are below 2^24, which float32 can tell apart) and _OCCLUSION
//   OFF   text; a place is written once; COFF, with four numbers from 0 to 255 behind the position, where there are
//         colours; no normals
//   MSMS  text; the vertices x.vert and the triangles x.face, as MSMS 2.6 writes them but for the numbers of analytical
//         faces, which are 0, and six digits behind the point instead of three; needs owners and patches
// text: of PLY only. format: not one that is shown.
void write_mesh(const std::string &path, const MeshView &mesh, MeshFormat format, bool text = false);

}  // namespace quickses::io
