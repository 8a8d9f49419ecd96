// SPDX-License-Identifier: MIT
// A mesh as pages have it; page.js reads it.
#include <algorithm>
#include <cmath>
#include <string>

#include "render/look.h"
#include "render/page.h"
#include "render/page_text.h"

namespace quickses::render {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kMost16 = 65535, kMost8 = 127;

void put16(std::string &bytes, float part) {
  const auto number = static_cast<uint32_t>(std::lround(std::clamp(part, 0.f, 1.f) * kMost16));
  bytes.push_back(static_cast<char>(number & 255));
  bytes.push_back(static_cast<char>(number >> 8));
}

float sign_of(float v) { return v < 0 ? -1.f : 1.f; }

vec3 from_octahedron(vec2 e) {
  vec3 v(e, 1 - std::abs(e.x) - std::abs(e.y));
  if (v.z < 0) v = vec3((1 - std::abs(e.y)) * sign_of(e.x), (1 - std::abs(e.x)) * sign_of(e.y), v.z);
  return glm::normalize(v);
}

// The normal on an octahedron whose lower half is folded out [Cigolle et al. 2014]: of the four pairs of bytes around
// it, the nearest.
void put_normal(std::string &bytes, vec3 normal) {
  const float length = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
  vec2 e(0);
  if (length > 0) {
    e = vec2(normal) / length;
    if (normal.z < 0) e = vec2((1 - std::abs(e.y)) * sign_of(e.x), (1 - std::abs(e.x)) * sign_of(e.y));
  }
  const vec2 low = glm::floor(e * kMost8);
  vec2 best = low;
  float nearest = -2;
  for (int k = 0; k < 4; ++k) {
    const vec2 tried = glm::clamp(low + vec2(k & 1, k >> 1), -kMost8, kMost8);
    const float cosine = glm::dot(from_octahedron(tried / kMost8), normal);
    if (cosine > nearest) nearest = cosine, best = tried;
  }
  bytes.push_back(static_cast<char>(static_cast<int8_t>(best.x)));
  bytes.push_back(static_cast<char>(static_cast<int8_t>(best.y)));
}

// Seven bits each, the lowest first, the eighth says that there are more; the sign is the lowest of all.
void put_difference(std::string &bytes, int64_t difference) {
  uint64_t rest = static_cast<uint64_t>(difference < 0 ? -2 * difference - 1 : 2 * difference);
  for (; rest >= 128; rest >>= 7) bytes.push_back(static_cast<char>((rest & 127) | 128));
  bytes.push_back(static_cast<char>(rest));
}

std::string base64(const std::string &bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t three = 0;
    for (size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
    for (size_t k = 0; k < 4; ++k) text.push_back(i + k > bytes.size() ? '=' : kDigits[three >> (18 - 6 * k) & 63]);
  }
  return text;
}

vec3 position(const io::MeshView &mesh, size_t v) {
  return {mesh.positions[3 * v], mesh.positions[3 * v + 1], mesh.positions[3 * v + 2]};
}

}  // namespace

std::string page_mesh(const io::MeshView &mesh, vec3 middle, const std::string &label) {
  vec3 low(mesh.vertex_count ? 1e30f : 0), high(mesh.vertex_count ? -1e30f : 0);
  for (size_t v = 0; v < mesh.vertex_count; ++v) {
    low = glm::min(low, position(mesh, v));
    high = glm::max(high, position(mesh, v));
  }
  const vec3 span = glm::max(high - low, 1e-6f);
  std::string bytes;
  bytes.reserve(12 * size_t(mesh.vertex_count) + 6 * size_t(mesh.triangle_count));
  for (size_t v = 0; v < mesh.vertex_count; ++v) {
    const vec3 part = (position(mesh, v) - low) / span;
    for (int axis = 0; axis < 3; ++axis) put16(bytes, part[axis]);
  }
  for (size_t v = 0; v < mesh.vertex_count; ++v)
    put_normal(bytes, {mesh.normals[3 * v], mesh.normals[3 * v + 1], mesh.normals[3 * v + 2]});
  for (size_t v = 0; v < mesh.vertex_count; ++v) {
    for (size_t k = 0; k < 3; ++k) bytes.push_back(static_cast<char>(mesh.colors ? mesh.colors[4 * v + k] : kGrey));
    const float open = mesh.occlusion ? std::clamp(mesh.occlusion[v], 0.f, 1.f) : 1;
    bytes.push_back(static_cast<char>(std::lround(255 * open)));
  }
  int64_t before = 0;
  for (size_t i = 0; i < 3 * size_t(mesh.triangle_count); ++i) {
    put_difference(bytes, int64_t(mesh.indices[i]) - before);
    before = mesh.indices[i];
  }
  return "<script type=\"text/plain\" class=\"mesh\" data-label=\"" + escaped(label) + "\" data-vertices=\"" +
         std::to_string(mesh.vertex_count) + "\" data-triangles=\"" + std::to_string(mesh.triangle_count) +
         "\" data-low=\"" + numbers(low - middle) + "\" data-span=\"" + numbers(span) + "\">" + base64(bytes) +
         "</script>\n";
}

}  // namespace quickses::render
