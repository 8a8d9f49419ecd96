// SPDX-License-Identifier: MIT
// What is drawn: a mesh from a PLY file that quickses wrote, and the atoms of the PDB file it was made of, for colours.
#pragma once

#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace render {

struct Vec {
  float x = 0, y = 0, z = 0;
};
inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator*(Vec a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline Vec operator*(Vec a, Vec b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline float dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline Vec unit(Vec a) { return a * (1.f / std::sqrt(std::max(dot(a, a), 1e-30f))); }

struct Mesh {
  std::vector<Vec> positions, normals;
  std::vector<int32_t> owners;
  std::vector<uint32_t> indices;
  Vec center;
  float radius = 0;  // of a ball around all vertices
};

// Binary PLY with x y z nx ny nz owner per vertex, in that order, and triangles.
inline Mesh read_ply(const std::string &path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("can't open '" + path + "'");
  size_t vertices = 0, triangles = 0;
  std::string line, properties;
  while (std::getline(file, line) && line != "end_header") {
    if (line.rfind("element vertex ", 0) == 0) vertices = std::stoul(line.substr(15));
    if (line.rfind("element face ", 0) == 0) triangles = std::stoul(line.substr(13));
    if (line.rfind("property ", 0) == 0) properties += line.substr(9) + ";";
  }
  if (properties != "float x;float y;float z;float nx;float ny;float nz;int owner;list uchar uint vertex_indices;")
    throw std::runtime_error("'" + path + "' is no PLY file with positions, normals and owners as quickses writes it");
  std::vector<char> bytes(28 * vertices + 13 * triangles);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    throw std::runtime_error("'" + path + "' is too short");
  Mesh mesh;
  mesh.positions.resize(vertices), mesh.normals.resize(vertices), mesh.owners.resize(vertices);
  Vec low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
  for (size_t v = 0; v < vertices; ++v) {
    const char *p = bytes.data() + 28 * v;
    std::memcpy(&mesh.positions[v], p, 12);
    std::memcpy(&mesh.normals[v], p + 12, 12);
    std::memcpy(&mesh.owners[v], p + 24, 4);
    const Vec &q = mesh.positions[v];
    low = {std::min(low.x, q.x), std::min(low.y, q.y), std::min(low.z, q.z)};
    high = {std::max(high.x, q.x), std::max(high.y, q.y), std::max(high.z, q.z)};
  }
  mesh.indices.resize(3 * triangles);
  for (size_t t = 0; t < triangles; ++t)
    std::memcpy(&mesh.indices[3 * t], bytes.data() + 28 * vertices + 13 * t + 1, 12);
  mesh.center = (low + high) * 0.5f;
  for (const Vec &q : mesh.positions) mesh.radius = std::max(mesh.radius, dot(q - mesh.center, q - mesh.center));
  mesh.radius = std::sqrt(mesh.radius);
  return mesh;
}

struct Atom {
  Vec center;
  float radius;
  char chain;
  bool hetero;
  std::string element;
};

// The default radii of quickses.
inline float radius_of(const std::string &element) {
  static const std::map<std::string, float> radii = {{"O", 1.52f}, {"C", 1.70f}, {"N", 1.55f},
                                                     {"H", 1.20f}, {"S", 1.80f}, {"P", 1.80f}};
  const auto found = radii.find(element);
  return found == radii.end() ? 1.40f : found->second;
}

// The atoms of a PDB file's first model, compressed or not, in the order of the file.
inline std::vector<Atom> read_atoms(const std::string &path) {
  gzFile file = gzopen(path.c_str(), "rb");
  if (!file) throw std::runtime_error("can't open '" + path + "'");
  std::vector<Atom> atoms;
  char line[256];
  while (gzgets(file, line, sizeof line) && std::strncmp(line, "ENDMDL", 6) != 0) {
    if ((std::strncmp(line, "ATOM  ", 6) != 0 && std::strncmp(line, "HETATM", 6) != 0) || std::strlen(line) < 78)
      continue;
    const std::string text(line), element = text.substr(text[76] == ' ' ? 77 : 76, text[76] == ' ' ? 1 : 2);
    const Vec center{std::stof(text.substr(30, 8)), std::stof(text.substr(38, 8)), std::stof(text.substr(46, 8))};
    atoms.push_back({center, radius_of(element), line[21], line[0] == 'H', element});
  }
  gzclose(file);
  return atoms;
}

inline Vec from_srgb(uint32_t rgb) {
  const auto linear = [](uint32_t byte) {
    const float v = static_cast<float>(byte) / 255.f;
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
  };
  return {linear(rgb >> 16 & 255), linear(rgb >> 8 & 255), linear(rgb & 255)};
}

// One colour per atom: "chain" (the palette in turn; with run > 1 each colour serves that many chains, darker and
// lighter by turns; hetero atoms are grey), "element", or one colour for all as RRGGBB.
inline std::vector<Vec> color_atoms(const std::vector<Atom> &atoms, const std::string &scheme, size_t run) {
  static const std::vector<uint32_t> palette = {0x5e93b8, 0xdca850, 0x7fab7a, 0xc4736a, 0x9384b0, 0x6fb3ad, 0xcf95ae};
  static const std::map<std::string, uint32_t> elements = {{"C", 0xd3cdc2}, {"N", 0x6489bd}, {"O", 0xc96f64},
                                                           {"S", 0xdcb450}, {"P", 0xd38f4c}, {"H", 0xe6e3de}};
  constexpr uint32_t kGrey = 0xbdb8b0;
  std::map<char, size_t> chains;
  for (const Atom &atom : atoms) chains.emplace(atom.chain, chains.size());
  std::vector<Vec> colors;
  for (const Atom &atom : atoms) {
    if (scheme == "chain") {
      const size_t chain = chains[atom.chain];
      const Vec color = from_srgb(atom.hetero ? kGrey : palette[chain / run % palette.size()]);
      colors.push_back(run > 1 && chain % run % 2 == 1 && !atom.hetero ? color * 0.55f : color);
    } else if (scheme == "element") {
      const auto found = elements.find(atom.element);
      colors.push_back(from_srgb(found == elements.end() ? kGrey : found->second));
    } else {
      colors.push_back(from_srgb(static_cast<uint32_t>(std::stoul(scheme, nullptr, 16))));
    }
  }
  return colors;
}

}  // namespace render
