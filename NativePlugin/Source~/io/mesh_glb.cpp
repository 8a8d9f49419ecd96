// SPDX-License-Identifier: MIT
// Meshes as GLB: glTF 2.0 in one binary file. The arrays of the mesh go to it as they are, one after the other, so that
// no copy of a large mesh is needed.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "io/error.h"
#include "io/mesh_formats.h"
#include "io/mesh_rows.h"

namespace quickses::io {
namespace {

// Numbers of the specification (those of OpenGL).
constexpr uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr int kUnsignedByte = 5121, kUnsignedInt = 5125, kFloat = 5126, kVertices = 34962, kIndices = 34963;
constexpr uint32_t kChunkHeader = 8, kFileHeader = 12;

// An array of the file: a view of its one buffer and the accessor that tells what is in there.
struct Array {
  std::string attribute;  // empty: the indices
  const char *type;
  int component;
  uint64_t count, bytes;
  std::function<void(AtomicFile &)> write;
  std::string more;  // of the accessor
};

struct Box {
  std::array<float, 3> min, max;
};

Box box_of(const MeshView &mesh) {
  Box box;
  std::copy_n(mesh.positions, 3, box.min.begin());
  box.max = box.min;
  for (size_t i = 1; i < mesh.vertex_count; ++i)
    for (size_t axis = 0; axis < 3; ++axis) {
      box.min[axis] = std::min(box.min[axis], mesh.positions[3 * i + axis]);
      box.max[axis] = std::max(box.max[axis], mesh.positions[3 * i + axis]);
    }
  return box;
}

std::string text_of(const std::array<float, 3> &vector) {
  std::string text;
  for (const float number : vector) {
    char digits[kMaxNumber];
    text += (text.empty() ? "[" : ",") + std::string(digits, put_text(digits, number));
  }
  return text + "]";
}

// Vertices have no attributes of 32-bit integers in glTF. float32 is exact up to here.
bool fit_in_floats(const uint32_t *numbers, uint32_t count) {
  constexpr uint32_t kFirstThatDoesNot = 1 << 24;
  return numbers && std::all_of(numbers, numbers + count, [](uint32_t number) { return number < kFirstThatDoesNot; });
}

// glTF wants unit length; float32 normals are that, but for places where a surface has none.
void put_normals(AtomicFile &file, const MeshView &mesh) {
  constexpr float kTolerance = 1e-3f;
  put_rows(file, mesh.vertex_count, 12, [&](char *out, size_t i) {
    const float *const normal = mesh.normals + 3 * i;
    const float square = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
    if (std::abs(square - 1) <= kTolerance) return put_binary(out, normal);
    const double length = std::hypot(double(normal[0]), double(normal[1]), double(normal[2]));
    const bool has_direction = length > 0 && std::isfinite(length);
    for (int axis = 0; axis < 3; ++axis)
      out = put_binary(out, has_direction ? static_cast<float>(normal[axis] / length) : (axis == 2 ? 1.0f : 0.0f));
    return out;
  });
}

// Colours of vertices are linear in glTF: the curve of sRGB (IEC 61966-2-1) taken off.
std::array<uint8_t, 256> linear_of_srgb() {
  std::array<uint8_t, 256> table;
  for (size_t i = 0; i < table.size(); ++i) {
    const double value = static_cast<double>(i) / 255;
    const double linear = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
    table[i] = static_cast<uint8_t>(std::lround(255 * linear));
  }
  return table;
}

void put_colors(AtomicFile &file, const MeshView &mesh) {
  const std::array<uint8_t, 256> linear = linear_of_srgb();
  put_rows(file, mesh.vertex_count, 4, [&](char *out, size_t i) {
    const uint8_t *const color = mesh.colors + 4 * i;
    for (int k = 0; k < 3; ++k) *out++ = static_cast<char>(linear[color[k]]);
    *out++ = static_cast<char>(color[3]);
    return out;
  });
}

// In the order of the file; for as long as the mesh is there.
std::vector<Array> arrays_of(const MeshView &mesh) {
  const size_t count = mesh.vertex_count, corners = 3 * size_t(mesh.triangle_count);
  std::vector<Array> arrays;
  const auto add = [&](const char *name, const char *type, int component, size_t rows, size_t row_bytes,
                       std::function<void(AtomicFile &)> write, const std::string &more) {
    arrays.push_back({name, type, component, rows, uint64_t{rows} * row_bytes, std::move(write), more});
  };
  const Box box = box_of(mesh);
  add(
      "POSITION", "VEC3", kFloat, count, 12,
      [&mesh](AtomicFile &file) { put_numbers(file, mesh.positions, 3 * size_t(mesh.vertex_count)); },
      ",\"min\":" + text_of(box.min) + ",\"max\":" + text_of(box.max));
  add(
      "NORMAL", "VEC3", kFloat, count, 12, [&mesh](AtomicFile &file) { put_normals(file, mesh); }, "");
  if (mesh.colors)
    add(
        "COLOR_0", "VEC4", kUnsignedByte, count, 4, [&mesh](AtomicFile &file) { put_colors(file, mesh); },
        ",\"normalized\":true");
  const auto add_numbers = [&](const char *name, const auto *numbers) {
    const auto put = [numbers](char *out, size_t i) { return put_binary(out, static_cast<float>(numbers[i])); };
    add(
        name, "SCALAR", kFloat, count, 4, [=](AtomicFile &file) { put_rows(file, count, 4, put); }, "");
  };
  if (fit_in_floats(mesh.owners, mesh.vertex_count)) add_numbers("_ATOM", mesh.owners);
  if (fit_in_floats(mesh.component_ids, mesh.vertex_count)) add_numbers("_COMPONENT", mesh.component_ids);
  if (mesh.occlusion) add_numbers("_OCCLUSION", mesh.occlusion);
  add(
      "", "SCALAR", kUnsignedInt, corners, 4,
      [=, &mesh](AtomicFile &file) { put_numbers(file, mesh.indices, corners); }, "");
  return arrays;
}

// At most, and without a look at the arrays.
uint64_t bytes_for(const MeshView &mesh) {
  const uint64_t numbers = 6 + (mesh.colors != nullptr) + (mesh.owners != nullptr) + (mesh.component_ids != nullptr) +
                           (mesh.occlusion != nullptr);
  return 4 * (numbers * mesh.vertex_count + 3 * uint64_t{mesh.triangle_count});
}

// What it says is all ours, names and numbers: nothing that JSON would have to escape.
std::string json_of(const MeshView &mesh, const std::vector<Array> &arrays) {
  const std::string asset = "{\"asset\":{\"version\":\"2.0\",\"generator\":\"QuickSES for Unity " QUICKSES_VERSION
                            "\",\"extras\":{\"unit\":\"" +
                            mesh.unit + "\"}},\"scene\":0,";
  if (arrays.empty()) return asset + "\"scenes\":[{\"name\":\"surface\"}]}";  // glTF has no meshes without vertices
  std::string attributes, accessors, views;
  uint64_t offset = 0;
  for (size_t k = 0; k < arrays.size(); ++k) {
    const Array &array = arrays[k];
    const std::string number = std::to_string(k), comma = k == 0 ? "" : ",";
    const bool are_indices = array.attribute.empty();
    if (!are_indices) attributes += comma + "\"" + array.attribute + "\":" + number;
    accessors += comma + "{\"bufferView\":" + number + ",\"componentType\":" + std::to_string(array.component) +
                 ",\"count\":" + std::to_string(array.count) + ",\"type\":\"" + array.type + "\"" + array.more + "}";
    views += comma + "{\"buffer\":0,\"byteOffset\":" + std::to_string(offset) +
             ",\"byteLength\":" + std::to_string(array.bytes) +
             ",\"target\":" + std::to_string(are_indices ? kIndices : kVertices) + "}";
    offset += array.bytes;
  }
  const char *const blend = has_alpha(mesh) ? "\"alphaMode\":\"BLEND\"," : "";
  return asset + "\"scenes\":[{\"name\":\"surface\",\"nodes\":[0]}],\"nodes\":[{\"name\":\"surface\",\"mesh\":0}]," +
         "\"materials\":[{\"name\":\"surface\"," + blend +
         "\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.5},\"doubleSided\":false}]," +
         "\"meshes\":[{\"name\":\"surface\",\"primitives\":[{\"attributes\":{" + attributes +
         "},\"indices\":" + std::to_string(arrays.size() - 1) + ",\"material\":0,\"mode\":4}]}],\"accessors\":[" +
         accessors + "],\"bufferViews\":[" + views + "],\"buffers\":[{\"byteLength\":" + std::to_string(offset) + "}]}";
}

}  // namespace

void write_glb(AtomicFile &file, const MeshView &mesh) {
  constexpr uint64_t kMostBytes = UINT32_MAX, kRoomForJson = 1 << 14;
  if (const uint64_t bytes = bytes_for(mesh); bytes > kMostBytes - kRoomForJson)
    fail_output("'" + file.path() + "' can't be written: its mesh takes " + std::to_string(bytes >> 20) +
                " MiB, and a GLB file has 4 GiB at most; a larger spacing would do, or .ply");
  std::vector<Array> arrays;
  if (mesh.triangle_count > 0) arrays = arrays_of(mesh);
  uint64_t bytes = 0;
  for (const Array &array : arrays) bytes += array.bytes;
  std::string json = json_of(mesh, arrays);
  json.resize((json.size() + 3) / 4 * 4, ' ');  // chunks begin at multiples of four
  const uint64_t binary = arrays.empty() ? 0 : kChunkHeader + bytes;
  const auto put_words = [&](std::initializer_list<uint64_t> words) {
    put_rows(file, words.size(), 4,
             [&](char *out, size_t i) { return put_binary(out, static_cast<uint32_t>(words.begin()[i])); });
  };
  put_words({kMagic, kVersion, kFileHeader + kChunkHeader + json.size() + binary, json.size(), kJsonChunk});
  file.write(json);
  if (arrays.empty()) return;
  put_words({bytes, kBinaryChunk});
  for (const Array &array : arrays) array.write(file);
}

}  // namespace quickses::io
