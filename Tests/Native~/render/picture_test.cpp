// SPDX-License-Identifier: MIT
// What is drawn of a mesh. The form of the files is looked at by page_test.cpp, whole pictures by cli_picture_test.py.
#include "render/picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "render/drawn_mesh.h"

namespace quickses::render {
namespace {

using glm::vec2;
using glm::vec3;
using Color = std::array<uint8_t, 4>;

constexpr Color kRed{255, 0, 0, 255}, kGreen{0, 255, 0, 255}, kBlue{0, 0, 255, 255}, kWhite{255, 255, 255, 255},
    kGrey{130, 130, 130, 255};

// Triangles that face the eye, unless they are turned round.
struct Mesh : DrawnMesh {
  uint32_t vertex(vec3 at, Color color) {
    positions.insert(positions.end(), {at.x, at.y, at.z});
    normals.insert(normals.end(), {0, 0, 1});
    colors.insert(colors.end(), color.begin(), color.end());
    return static_cast<uint32_t>(positions.size() / 3 - 1);
  }
  void triangle(vec3 a, vec3 b, vec3 c, Color color) {
    for (const vec3 at : {a, b, c}) indices.push_back(vertex(at, color));
  }
  void square(vec2 low, vec2 high, float z, Color color) {
    const uint32_t a = vertex({low, z}, color), b = vertex({high.x, low.y, z}, color), c = vertex({high, z}, color),
                   d = vertex({low.x, high.y, z}, color);
    indices.insert(indices.end(), {a, b, c, a, c, d});
  }
};

PictureSettings settings_of(int width, int height, int samples) {
  PictureSettings settings;
  settings.width = width, settings.height = height, settings.samples = samples;
  return settings;
}

// So many pixels per Å, from so far away that nothing is smaller behind.
Camera camera_for(const PictureSettings &settings, float pixels_per_angstrom) {
  Camera camera;
  camera.distance = 1e6f;
  const vec2 size(settings.width, settings.height);
  camera.half = 0.5f * camera.enlargement() / pixels_per_angstrom * size;
  return camera;
}

const uint8_t *pixel(const Image &image, int x, int y) {
  return &image.rgba[4 * (static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x))];
}

int brightness(const Image &image, int x, int y) {
  const uint8_t *p = pixel(image, x, y);
  return p[0] + p[1] + p[2];
}

// The channel that all others are well below.
int channel(const uint8_t *rgba) {
  for (int k = 0; k < 3; ++k)
    if (rgba[k] > rgba[(k + 1) % 3] + 40 && rgba[k] > rgba[(k + 2) % 3] + 40) return k;
  return -1;
}

// A sample counts if its middle is in the triangle, wherever it lies: also of rows that are drawn apart.
TEST(Picture, TrianglesCoverTheSamplesInThem) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int n = 0; n < 60; ++n) {
    const int samples = 1 + n % 4;
    const PictureSettings settings = settings_of(60 + n, 150 - n, samples);
    glm::dvec2 p[3];
    for (glm::dvec2 &corner : p) corner = {50 * unit(random), 90 * unit(random)};
    double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
    if (area < 0) std::swap(p[1], p[2]), area = -area;
    Mesh mesh;
    mesh.triangle(vec3(p[0], 0), vec3(p[1], 0), vec3(p[2], 0), kWhite);
    const Image image = draw(mesh.view(), camera_for(settings, 1), vec3(0), settings);
    for (int y = 0; y < settings.height; ++y)
      for (int x = 0; x < settings.width; ++x) {
        int surely = 0, perhaps = 0;
        for (int s = 0; s < samples * samples; ++s) {
          const glm::dvec2 at(x + (s % samples + 0.5) / samples - 0.5 * settings.width,
                              0.5 * settings.height - (y + (s / samples + 0.5) / samples));
          double inside = 1e30;
          for (int k = 0; k < 3; ++k) {
            const glm::dvec2 a = p[k], side = p[(k + 1) % 3] - a;
            inside = std::min(inside, (side.x * (at.y - a.y) - side.y * (at.x - a.x)) / glm::length(side));
          }
          surely += inside > 0.01 ? 1 : 0, perhaps += inside > -0.01 ? 1 : 0;
        }
        const int covered = static_cast<int>(std::lround(pixel(image, x, y)[3] * samples * samples / 255.));
        ASSERT_GE(covered, surely) << n << ": " << x << " " << y;
        ASSERT_LE(covered, perhaps) << n << ": " << x << " " << y;
      }
  }
}

TEST(Picture, NeighboursLeaveNoGap) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(-1, 1);
  Mesh mesh;
  constexpr int kSide = 12;
  for (int i = 0; i <= kSide; ++i)
    for (int j = 0; j <= kSide; ++j) {
      const bool is_inside = i > 0 && i < kSide && j > 0 && j < kSide;
      const float x = static_cast<float>(i) + (is_inside ? 0.3f * unit(random) : 0),
                  y = static_cast<float>(j) + (is_inside ? 0.3f * unit(random) : 0);
      mesh.vertex(vec3(x - kSide / 2, y - kSide / 2, unit(random)), kWhite);
    }
  for (uint32_t i = 0; i < kSide; ++i)
    for (uint32_t j = 0; j < kSide; ++j) {
      const uint32_t a = i * (kSide + 1) + j, b = a + kSide + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
  for (const int samples : {1, 3, 16}) {
    const PictureSettings settings = settings_of(200, 200, samples);
    const Image image = draw(mesh.view(), camera_for(settings, 20), vec3(0), settings);
    for (int y = 0; y < 200; ++y)
      for (int x = 0; x < 200; ++x) ASSERT_EQ(pixel(image, x, y)[3], 255) << samples << ": " << x << " " << y;
  }
}

// Whichever comes first; what faces away is not seen.
TEST(Picture, TheNearestIsSeen) {
  const PictureSettings settings = settings_of(40, 40, 2);
  for (const bool swapped : {false, true}) {
    Mesh mesh;
    // Both reach through the other one: on the left red is in front.
    const vec3 red[] = {{-9, -9, 4}, {9, -9, -4}, {0, 12, 0}}, blue[] = {{-9, -9, -4}, {9, -9, 4}, {0, 12, 0}};
    if (!swapped) mesh.triangle(red[0], red[1], red[2], kRed);
    mesh.triangle(blue[0], blue[1], blue[2], kBlue);
    if (swapped) mesh.triangle(red[0], red[1], red[2], kRed);
    mesh.triangle({-9, -9, 20}, {0, 12, 20}, {9, -9, 20}, kGreen);
    const Image image = draw(mesh.view(), camera_for(settings, 2), vec3(0), settings);
    for (const int y : {18, 26, 34})
      for (const int x : {-3, -1, 1, 3}) EXPECT_EQ(channel(pixel(image, 20 + x, y)), x < 0 ? 0 : 2) << x << " " << y;
  }
}

// What is nearer is larger, as the distances say.
TEST(Picture, IsAPerspective) {
  const PictureSettings settings = settings_of(100, 100, 4);
  Camera camera = camera_for(settings, 2);
  camera.distance = 40;
  for (const float z : {-20.f, 0.f, 10.f}) {
    Mesh mesh;
    mesh.square(vec2(-8), vec2(8), z, kWhite);
    const Image image = draw(mesh.view(), camera, vec3(0), settings);
    double covered = 0;
    for (int x = 0; x < 100; ++x) covered += pixel(image, x, 50)[3] / 255.;
    EXPECT_NEAR(covered, 2 * 16 * 40 / (40 - z), 0.3);
  }
  // What is too near to the eye, or behind it, is ten times as large.
  for (const float z : {37.f, 45.f}) {
    Mesh mesh;
    mesh.square(vec2(-0.4f), vec2(0.4f), z, kWhite);
    const Image image = draw(mesh.view(), camera, vec3(0), settings);
    double covered = 0;
    for (int x = 0; x < 100; ++x) covered += pixel(image, x, 50)[3] / 255.;
    EXPECT_NEAR(covered, 2 * 0.8 * 10, 0.3);
  }
}

TEST(Picture, ColoursLieBetweenThoseOfTheCorners) {
  const PictureSettings settings = settings_of(60, 60, 1);
  Mesh mesh;
  mesh.indices = {mesh.vertex({-9, -9, 0}, kRed), mesh.vertex({9, -9, 0}, kGreen), mesh.vertex({0, 9, 0}, kBlue)};
  const Image image = draw(mesh.view(), camera_for(settings, 3), vec3(0), settings);
  EXPECT_EQ(channel(pixel(image, 8, 54)), 0);
  EXPECT_EQ(channel(pixel(image, 51, 54)), 1);
  EXPECT_EQ(channel(pixel(image, 30, 8)), 2);
  const uint8_t *middle = pixel(image, 30, 39), *side = pixel(image, 30, 55);
  EXPECT_NEAR(middle[0], middle[1], 25);
  EXPECT_NEAR(middle[1], middle[2], 25);
  EXPECT_NEAR(side[0], side[1], 25);
  EXPECT_GT(side[0], side[2] + 30);
  mesh.colors.clear();
  const Image plain = draw(mesh.view(), camera_for(settings, 3), vec3(0), settings);
  EXPECT_NEAR(pixel(plain, 30, 39)[0], pixel(plain, 30, 39)[2], 25) << "grey";
  EXPECT_GT(brightness(plain, 30, 39), 300);
}

// Of a triangle that was drawn before with all corners alike: one is darker now, the others hardly are.
void expect_dark_corner(const Image &before, const Image &image, uint32_t dark) {
  const int at[3][2] = {{8, 54}, {51, 54}, {30, 8}};
  for (uint32_t k = 0; k < 3; ++k) {
    const int darker = brightness(before, at[k][0], at[k][1]) - brightness(image, at[k][0], at[k][1]);
    if (k == dark) {
      EXPECT_GT(darker, 60);
    } else {
      EXPECT_LT(darker, 20);
    }
  }
}

// Towards the corner that is closed it grows darker; without occlusion all is open.
TEST(Picture, WhatIsClosedIsDark) {
  const PictureSettings settings = settings_of(60, 60, 1);
  for (uint32_t closed = 0; closed < 3; ++closed) {
    Mesh mesh;
    mesh.triangle({-9, -9, 0}, {9, -9, 0}, {0, 9, 0}, kWhite);
    const Image open = draw(mesh.view(), camera_for(settings, 3), vec3(0), settings);
    mesh.occlusion = {1, 1, 1};
    EXPECT_EQ(draw(mesh.view(), camera_for(settings, 3), vec3(0), settings).rgba, open.rgba);
    mesh.occlusion[closed] = 0;
    const Image image = draw(mesh.view(), camera_for(settings, 3), vec3(0), settings);
    expect_dark_corner(open, image, closed);
  }
}

// So is what looks away from the lamp.
TEST(Picture, NormalsLieBetweenThoseOfTheCorners) {
  const PictureSettings settings = settings_of(60, 60, 1);
  for (uint32_t turned = 0; turned < 3; ++turned) {
    Mesh mesh;
    mesh.triangle({-9, -9, 0}, {9, -9, 0}, {0, 9, 0}, kGrey);
    const Image straight = draw(mesh.view(), camera_for(settings, 3), vec3(0), settings);
    mesh.normals[3 * turned] = 0.58f, mesh.normals[3 * turned + 1] = -0.8f, mesh.normals[3 * turned + 2] = 0.1f;
    const Image image = draw(mesh.view(), camera_for(settings, 3), vec3(0), settings);
    expect_dark_corner(straight, image, turned);
  }
}

// A floor below a plate: it is dark where the plate takes the lamp, which stands on the left and above, away.
TEST(Picture, ShadowsFallAwayFromTheLamp) {
  const PictureSettings settings = settings_of(100, 100, 1);
  Mesh mesh;
  for (int i = -24; i < 24; ++i)
    for (int j = -24; j < 24; ++j) mesh.square(vec2(i, j), vec2(i + 1, j + 1), 0, kGrey);
  mesh.square(vec2(-4), vec2(4), 8, kGrey);
  const Image image = draw(mesh.view(), camera_for(settings, 2), vec3(0), settings);
  // By as much as it is higher: 5.6 Å to the right, 7.75 down.
  EXPECT_LT(brightness(image, 50 + 11, 50 + 15), brightness(image, 50 - 18, 50 - 20) - 60);
  EXPECT_NEAR(brightness(image, 50 + 18, 50 - 20), brightness(image, 50 - 18, 50 - 20), 10);
  EXPECT_NEAR(brightness(image, 50 - 18, 50 + 20), brightness(image, 50 - 18, 50 - 20), 10);
}

// What lies in front of something far behind has a dark border, what is behind and what is before nothing has none.
TEST(Picture, OutlinesAreDrawnOnWhatIsInFront) {
  for (const int samples : {1, 4}) {
    const PictureSettings settings = settings_of(100, 100, samples);
    Mesh mesh;
    mesh.square(vec2(-20), vec2(20), -30, kGrey);
    mesh.square(vec2(-10), vec2(10), 0, kGrey);
    mesh.occlusion.assign(8, 1);
    Image image = draw(mesh.view(), camera_for(settings, 2), vec3(0), settings);
    const int front = brightness(image, 50, 50), behind = brightness(image, 15, 15);
    for (const int place : {40, 50, 60})  // the border of the front is at 30 and 70
      for (const int border : {30, 69})
        for (const bool across : {false, true}) {
          const int on = across ? brightness(image, border, place) : brightness(image, place, border);
          EXPECT_LT(on, front - 60) << samples;
          EXPECT_NEAR(on, brightness(image, 30, 50), 3) << samples << ": one side is as dark as the other";
          const int inwards = border == 30 ? 33 : 66, outwards = border == 30 ? 28 : 71;
          EXPECT_NEAR(across ? brightness(image, inwards, place) : brightness(image, place, inwards), front, 2);
          if (border == 30) {  // where no shadow is
            EXPECT_NEAR(across ? brightness(image, outwards, 35) : brightness(image, 35, outwards), behind, 2);
          }
        }
    EXPECT_NEAR(brightness(image, 10, 15), behind, 2) << "before nothing";
  }
}

// Beyond the border of the picture there is nothing to fall off to.
TEST(Picture, BordersOfThePictureAreNoOutlines) {
  for (const int samples : {1, 3}) {
    const PictureSettings settings = settings_of(60, 60, samples);
    const Camera camera = camera_for(settings, 1);
    for (const float height : {0.f, 100.f}) {
      Mesh mesh;  // one half of it far in front
      mesh.square(vec2(-50), vec2(0, 50), 100 - height, kGrey);
      mesh.square(vec2(0, -50), vec2(50), height, kGrey);
      mesh.normals.assign(mesh.normals.size(), 0);
      for (size_t k = 2; k < mesh.normals.size(); k += 3) mesh.normals[k] = -1;  // in no light but the sky's
      const Image image = draw(mesh.view(), camera, vec3(0), settings);
      for (int k = 0; k < 60; ++k) {
        EXPECT_EQ(brightness(image, 59, k), brightness(image, 50, 30)) << k;
        EXPECT_EQ(brightness(image, 0, k), brightness(image, 10, 30)) << k;
        if (k < 28 || k > 31) {
          EXPECT_EQ(brightness(image, k, 0), brightness(image, k, 30)) << k;
          EXPECT_EQ(brightness(image, k, 59), brightness(image, k, 30)) << k;
        }
      }
    }
  }
}

// Rows are drawn in bands. With the mesh some pixels higher other rows are at their borders, and all looks the same.
TEST(Picture, BandsDoNotShow) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  Mesh mesh;
  for (int n = 0; n < 40; ++n) {  // plates, each of small triangles: some lie just beside a band
    const vec2 low(20 * unit(random), 20 * unit(random));
    const float z = 20 * unit(random), step = 0.2f + 0.1f * unit(random);
    for (int i = 0; i < 10; ++i)
      for (int j = 0; j < 10; ++j) mesh.square(low + step * vec2(i, j), low + step * vec2(i + 1, j + 1), z, kWhite);
  }
  for (const int samples : {1, 3, 16})
    for (const bool edges : {false, true}) {
      PictureSettings settings = settings_of(40, 160, samples);
      settings.edges = edges;
      settings.background = kGreen;
      constexpr float kScale = 4;
      const Camera camera = camera_for(settings, kScale);
      const Image image = draw(mesh.view(), camera, vec3(0), settings);
      for (const int shift : {1, 2, 3, 31}) {
        const Image other = draw(mesh.view(), camera, vec3(0, -static_cast<float>(shift) / kScale, 0), settings);
        int different = 0;
        for (int y = 1 + shift; y + 1 < 160; ++y)
          for (int x = 0; x < 40; ++x)
            different += std::abs(brightness(image, x, y) - brightness(other, x, y - shift)) > 12 ? 1 : 0;
        EXPECT_LT(different, 4) << samples << " " << edges << " " << shift;
      }
    }
}

TEST(Picture, LinesAreAlongTheSidesOfTriangles) {
  for (const int samples : {1, 4}) {
    PictureSettings settings = settings_of(60, 60, samples);
    Mesh mesh;
    mesh.square(vec2(-10), vec2(10), 0, kWhite);
    const Image plain = draw(mesh.view(), camera_for(settings, 3), vec3(0), settings);
    settings.edges = true;
    const Image lined = draw(mesh.view(), camera_for(settings, 3), vec3(0), settings);
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 60; ++x) {
        const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
        // The sides of the square, and the diagonal from the left below.
        const float away = std::min({px, 60 - px, py, 60 - py, std::abs(60 - py - px) * 0.7071f});
        const int darker = brightness(plain, x, y) - brightness(lined, x, y);
        if (away > 1.6f) {
          EXPECT_EQ(darker, 0) << x << " " << y;
        } else if (away < 0.2f) {
          EXPECT_GT(darker, 60) << x << " " << y;
        }
      }
  }
}

// A line between two rows of pixels is as dark in one as in the other: samples are looked at one by one.
TEST(Picture, LinesAreSmooth) {
  PictureSettings settings = settings_of(60, 60, 4);
  settings.edges = true;
  Mesh mesh;
  mesh.square(vec2(-10, -10), vec2(10, 0), 0, kGrey), mesh.square(vec2(-10, 0), vec2(10, 10), 0, kGrey);
  const Image image = draw(mesh.view(), camera_for(settings, 3), vec3(0), settings);
  for (const int x : {10, 20, 40}) {
    EXPECT_NEAR(brightness(image, x, 29), brightness(image, x, 30), 6);
    EXPECT_LT(brightness(image, x, 29), brightness(image, x, 26) - 30);
  }
}

// Of a pixel that several triangles share each gives its part.
TEST(Picture, TrianglesShareAPixel) {
  for (const int samples : {2, 4}) {
    const PictureSettings settings = settings_of(41, 41, samples);
    Mesh mesh;
    mesh.square(vec2(-10, -10), vec2(0, 10), 0, kRed), mesh.square(vec2(0, -10), vec2(10, 10), 0, kBlue);
    const Image image = draw(mesh.view(), camera_for(settings, 2), vec3(0), settings);
    const uint8_t *red = pixel(image, 10, 20), *both = pixel(image, 20, 20), *blue = pixel(image, 30, 20);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(both[k], 0.5 * (red[k] + blue[k]), 4);
    EXPECT_EQ(channel(red), 0);
    EXPECT_EQ(channel(blue), 2);
  }
}

// Half of each pixel at the border is covered: the background is mixed in, or the colour keeps its own and alpha tells.
TEST(Picture, BordersAreMixedWithTheBackground) {
  PictureSettings settings = settings_of(40, 40, 4);
  Mesh mesh;
  mesh.square(vec2(-5.25f), vec2(5.25f), 0, kWhite);
  const Camera camera = camera_for(settings, 2);  // from 9.5 to 30.5 pixels
  const Image open = draw(mesh.view(), camera, vec3(0), settings);
  settings.background = {10, 100, 200, 255};
  const Image mixed = draw(mesh.view(), camera, vec3(0), settings);
  const uint8_t *inside = pixel(open, 20, 20);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(pixel(open, 9, 20)[k], inside[k], 3) << "the alpha is not multiplied in";
    EXPECT_EQ(pixel(mixed, 20, 20)[k], inside[k]);
    EXPECT_EQ(pixel(mixed, 2, 2)[k], (*settings.background)[static_cast<size_t>(k)]);
    const double border = 0.5 * pixel(open, 9, 20)[k] + 0.5 * (*settings.background)[static_cast<size_t>(k)];
    EXPECT_NEAR(pixel(mixed, 9, 20)[k], border, 1.5);
    EXPECT_EQ(pixel(open, 2, 2)[k], 0);
  }
  EXPECT_EQ(inside[3], 255);
  EXPECT_NEAR(pixel(open, 9, 20)[3], 127.5, 1);
  EXPECT_NEAR(pixel(open, 9, 9)[3], 63.75, 1);
  EXPECT_EQ(pixel(open, 2, 2)[3], 0);
  for (const auto &at : {std::pair(20, 20), std::pair(9, 20), std::pair(2, 2)})
    EXPECT_EQ(pixel(mixed, at.first, at.second)[3], 255);
}

// The eye's axes turn places and normals alike: a picture of the mesh and the camera turned is the same.
TEST(Picture, TheCameraTurnsPlacesAndNormals) {
  const PictureSettings settings = settings_of(50, 50, 2);
  Mesh mesh;
  mesh.triangle({-9, -9, 4}, {9, -9, -4}, {0, 12, 0}, kRed);
  for (size_t v = 0; v < 3; ++v) {
    const vec3 n = glm::normalize(vec3(v == 0 ? -1 : 0.2f, v == 1 ? -1 : 0.4f, 1));
    for (size_t k = 0; k < 3; ++k) mesh.normals[3 * v + k] = n[static_cast<int>(k)];
  }
  Camera camera = camera_for(settings, 2);
  const Image image = draw(mesh.view(), camera, vec3(0), settings);
  const glm::mat3 turned(vec3(0, 1, 0), vec3(0, 0, 1), vec3(1, 0, 0));  // exact
  const vec3 middle(8, -16, 4);
  for (size_t v = 0; v < 3; ++v) {
    vec3 p(mesh.positions[3 * v], mesh.positions[3 * v + 1], mesh.positions[3 * v + 2]),
        n(mesh.normals[3 * v], mesh.normals[3 * v + 1], mesh.normals[3 * v + 2]);
    p = turned * p + middle, n = turned * n;
    for (size_t k = 0; k < 3; ++k)
      mesh.positions[3 * v + k] = p[static_cast<int>(k)], mesh.normals[3 * v + k] = n[static_cast<int>(k)];
  }
  camera.right = turned[0], camera.up = turned[1], camera.toward = turned[2];
  EXPECT_EQ(draw(mesh.view(), camera, middle, settings).rgba, image.rgba);
}

// However the triangles are numbered.
TEST(Picture, TheOrderOfTrianglesDoesNotMatter) {
  PictureSettings settings = settings_of(70, 70, 3);
  Mesh mesh;
  for (int i = -6; i < 6; ++i)
    for (int j = -6; j < 6; ++j) mesh.square(vec2(i, j), vec2(i + 1, j + 1), 0.1f * static_cast<float>(i * j), kWhite);
  const Image image = draw(mesh.view(), camera_for(settings, 5.3f), vec3(0), settings);
  settings.threads = 3;
  EXPECT_EQ(draw(mesh.view(), camera_for(settings, 5.3f), vec3(0), settings).rgba, image.rgba);
  const std::vector<uint32_t> before = mesh.indices;
  for (size_t k = 0; k < before.size(); ++k) mesh.indices[before.size() - 3 - k / 3 * 3 + k % 3] = before[k];
  const Image other = draw(mesh.view(), camera_for(settings, 5.3f), vec3(0), settings);
  int different = 0;
  for (size_t k = 0; k < image.rgba.size(); ++k) different += std::abs(image.rgba[k] - other.rgba[k]) > 4 ? 1 : 0;
  EXPECT_LT(different, 20);
}

}  // namespace
}  // namespace quickses::render
