// SPDX-License-Identifier: MIT
// Meshes of pages, read back as render/page.h describes them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "render/drawn_mesh.h"
#include "render/page.h"

namespace quickses::render {
namespace {

using glm::vec3;

struct Mesh : DrawnMesh {
  void add(vec3 position, vec3 normal) {
    positions.insert(positions.end(), {position.x, position.y, position.z});
    normals.insert(normals.end(), {normal.x, normal.y, normal.z});
  }
};

std::string attribute(const std::string &text, const std::string &name) {
  const size_t begin = text.find(name + "=\"") + name.size() + 2;
  return text.substr(begin, text.find('"', begin) - begin);
}

std::vector<float> numbers_of(const std::string &text) {
  std::istringstream stream(text);
  std::vector<float> numbers;
  for (float number; stream >> number;) numbers.push_back(number);
  return numbers;
}

std::vector<uint8_t> bytes_of(const std::string &page) {
  const size_t begin = page.find('>') + 1;
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/",
                    text = page.substr(begin, page.find('<', begin) - begin);
  EXPECT_EQ(text.size() % 4, 0u);
  std::vector<uint8_t> bytes;
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text.substr(0, text.find('='))) {
    bits = bits << 6 | static_cast<uint32_t>(digits.find(c)), count += 6;
    if (count >= 8) bytes.push_back(static_cast<uint8_t>(bits >> (count -= 8)));
  }
  EXPECT_EQ((bytes.size() + 2) / 3 * 4, text.size());
  return bytes;
}

vec3 unit_of(uint8_t x, uint8_t y) {
  const glm::dvec2 e(static_cast<int8_t>(x) / 127., static_cast<int8_t>(y) / 127.);
  glm::dvec3 v(e.x, e.y, 1 - std::abs(e.x) - std::abs(e.y));
  if (v.z < 0) v.x = std::copysign(1 - std::abs(e.y), e.x), v.y = std::copysign(1 - std::abs(e.x), e.y);
  return vec3(v / glm::length(v));
}

// Of a mesh of points with these normals.
std::vector<vec3> written_normals(const std::vector<vec3> &normals) {
  Mesh mesh;
  for (const vec3 normal : normals) mesh.add(vec3(1, 2, 3), normal);
  const std::vector<uint8_t> bytes = bytes_of(page_mesh(mesh.view(), vec3(0), ""));
  EXPECT_EQ(bytes.size(), 12 * normals.size());
  std::vector<vec3> written;
  for (size_t v = 0; v < normals.size(); ++v)
    written.push_back(unit_of(bytes[6 * normals.size() + 2 * v], bytes[6 * normals.size() + 2 * v + 1]));
  return written;
}

// Also where the octahedron is folded.
TEST(PageMesh, NormalsAreThoseOfTheNearestPairOfBytes) {
  std::mt19937 random(1);
  std::normal_distribution<float> any;
  std::vector<vec3> normals;
  for (int n = 0; n < 300; ++n) {
    vec3 v(any(random), any(random), any(random));
    if (n % 3 == 1) v[n % 9 / 3] *= 1e-3f;
    if (n % 3 == 2) v.z = -std::abs(v.z) * 0.02f;
    normals.push_back(glm::normalize(v));
  }
  const std::vector<vec3> written = written_normals(normals);
  for (size_t v = 0; v < normals.size(); ++v) {
    float nearest = -1;
    for (int x = -127; x <= 127; ++x)
      for (int y = -127; y <= 127; ++y)
        nearest = std::max(nearest, glm::dot(unit_of(static_cast<uint8_t>(x), static_cast<uint8_t>(y)), normals[v]));
    const auto degrees = [](float cosine) { return glm::degrees(std::acos(std::min(1.f, cosine))); };
    EXPECT_LT(degrees(glm::dot(written[v], normals[v])), degrees(nearest) + 0.15f) << v;
  }
}

TEST(PageMesh, NormalsAlongTheAxesAreExact) {
  std::vector<vec3> axes;
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {1.f, -1.f}) {
      vec3 v(0);
      v[axis] = sign;
      axes.push_back(v);
    }
  const std::vector<vec3> written = written_normals(axes);
  for (size_t k = 0; k < axes.size(); ++k) EXPECT_LT(glm::length(written[k] - axes[k]), 1e-6f) << k;
  EXPECT_NEAR(glm::length(written_normals({vec3(0)})[0]), 1, 1e-6) << "where there is none, any";
}

TEST(PageMesh, PositionsAreRoundedToTheNearest) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(-1, 1);
  const vec3 middle(3, -4, 5);
  Mesh mesh;
  for (int n = 0; n < 200; ++n) mesh.add(vec3(9 * unit(random), 700 * unit(random), 2.5f), vec3(0, 0, 1));
  const std::string page = page_mesh(mesh.view(), middle, "<a & \"b\">");
  EXPECT_EQ(attribute(page, "data-label").find_first_of("<>\""), std::string::npos);
  EXPECT_EQ(attribute(page, "data-vertices"), "200");
  EXPECT_EQ(attribute(page, "data-triangles"), "0");
  const std::vector<float> low = numbers_of(attribute(page, "data-low")),
                           span = numbers_of(attribute(page, "data-span"));
  ASSERT_EQ(low.size(), 3u);
  ASSERT_EQ(span.size(), 3u);
  EXPECT_GT(span[2], 0) << "flat as it is";
  const std::vector<uint8_t> bytes = bytes_of(page);
  for (size_t k = 0; k < mesh.positions.size(); ++k) {
    const size_t axis = k % 3;
    const float step = span[axis] / 65535,
                at = low[axis] + step * static_cast<float>(bytes[2 * k] + 256 * bytes[2 * k + 1]);
    EXPECT_NEAR(at + middle[static_cast<int>(axis)], mesh.positions[k], 0.51f * step + 1e-4f) << k;
  }
}

TEST(PageMesh, ColoursAndOpenness) {
  Mesh mesh;
  for (int n = 0; n < 5; ++n) mesh.add(vec3(n, 0, 0), vec3(0, 0, 1));
  const std::vector<uint8_t> plain = bytes_of(page_mesh(mesh.view(), vec3(0), ""));
  for (size_t v = 0; v < 5; ++v) {
    EXPECT_EQ(plain[40 + 4 * v + 3], 255) << "open where nothing is known";
    EXPECT_EQ(plain[40 + 4 * v], plain[40 + 4 * v + 1]) << "grey";
    EXPECT_EQ(plain[40 + 4 * v], plain[40 + 4 * v + 2]);
    EXPECT_GT(plain[40 + 4 * v], 100);
  }
  mesh.occlusion = {0, 1, 0.4975f, 1.01f, -0.01f};
  for (uint8_t k = 0; k < 20; ++k) mesh.colors.push_back(static_cast<uint8_t>(7 * k));
  const std::vector<uint8_t> bytes = bytes_of(page_mesh(mesh.view(), vec3(0), ""));
  const uint8_t open[] = {0, 255, 127, 255, 0};
  for (size_t v = 0; v < 5; ++v) {
    for (size_t k = 0; k < 3; ++k) EXPECT_EQ(bytes[40 + 4 * v + k], mesh.colors[4 * v + k]);
    EXPECT_EQ(bytes[40 + 4 * v + 3], open[v]) << v;
  }
}

// Numbers that are near to the one before take a byte, others as many as they need; the length is any.
TEST(PageMesh, TrianglesAreDifferences) {
  std::mt19937 random(3);
  for (size_t triangles : {0u, 1u, 2u, 3u, 500u}) {
    Mesh mesh;
    for (size_t k = 0; k < 3 * triangles; ++k) {
      static constexpr uint32_t kSome[] = {0, 63, 64, 127, 128, 8191, 8192, 16384, 4294967295u, 1, 0, 2147483648u};
      mesh.indices.push_back(k % 3 == 0 ? static_cast<uint32_t>(random()) : kSome[random() % 12]);
    }
    const std::vector<uint8_t> bytes = bytes_of(page_mesh(mesh.view(), vec3(0), ""));
    std::vector<uint32_t> read;
    uint64_t number = 0;
    int shift = 0;
    int64_t before = 0;
    for (const uint8_t byte : bytes) {
      number |= uint64_t(byte & 127u) << shift;
      shift += 7;
      if (byte & 128u) continue;
      before += number & 1 ? -static_cast<int64_t>((number + 1) / 2) : static_cast<int64_t>(number / 2);
      read.push_back(static_cast<uint32_t>(before));
      number = 0, shift = 0;
    }
    EXPECT_EQ(shift, 0);
    EXPECT_EQ(read, mesh.indices);
  }
  Mesh near;
  near.indices = {0, 63, 0, 64, 1, 2};
  EXPECT_EQ(bytes_of(page_mesh(near.view(), vec3(0), "")).size(), 7u) << "differences of -64 to 63 take a byte";
}

// No number of a page may be infinite: page.js could not read it.
TEST(PageMesh, AnEmptyMeshHasNoSize) {
  const std::string page = page_mesh(io::MeshView(), vec3(1, 2, 3), "a");
  EXPECT_EQ(numbers_of(attribute(page, "data-low")), (std::vector<float>{-1, -2, -3}));
  for (const float span : numbers_of(attribute(page, "data-span"))) {
    EXPECT_GE(span, 0);
    EXPECT_LT(span, 1e-3f);
  }
  EXPECT_TRUE(bytes_of(page).empty());
}

}  // namespace
}  // namespace quickses::render
