// SPDX-License-Identifier: MIT
// Triangles cut along the borders of colours, of spheres whose owners are looked up by brute force.
#include "io/color_borders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <set>

#include "surface/mesh_shapes.h"

namespace quickses::io {
namespace {

using mesh_shapes::Mesh;

uint32_t color_of(const MeshView &mesh, uint32_t vertex) {
  uint32_t color;
  std::memcpy(&color, mesh.colors + 4 * size_t(vertex), sizeof color);
  return color;
}

// A mesh whose vertices belong to the nearest of some spheres; every third sphere has the same colour.
struct Painted {
  Painted(const Mesh &shape, uint32_t sphere_count, unsigned seed)
      : positions(shape.positions), indices(shape.indices) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> coordinate(-1, 1), radius(0.05f, 0.4f);
    for (uint32_t k = 0; k < sphere_count; ++k) {
      for (int axis = 0; axis < 3; ++axis) centers.push_back(coordinate(random));
      radii.push_back(radius(random));
    }
    for (size_t i = 0; i < positions.size() / 3; ++i) {
      const double length = std::hypot(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
      for (size_t axis = 0; axis < 3; ++axis) normals.push_back(static_cast<float>(positions[3 * i + axis] / length));
      give(nearest(&positions[3 * i]));
      occlusion.push_back(positions[3 * i]);  // linear along every edge
    }
  }

  void give(uint32_t owner) {
    owners.push_back(owner);
    const auto kind = static_cast<uint8_t>(owner % 3);
    colors.insert(colors.end(), {kind, static_cast<uint8_t>(100 + kind), 7, 255});
  }

  double distance(uint32_t sphere, const float *x) const {
    const float *const c = &centers[3 * size_t(sphere)];
    return std::hypot(double(x[0]) - c[0], double(x[1]) - c[1], double(x[2]) - c[2]) - radii[sphere];
  }

  uint32_t nearest(const float *x) const {
    uint32_t best = 0;
    for (uint32_t k = 1; k < radii.size(); ++k)
      if (distance(k, x) < distance(best, x)) best = k;
    return best;
  }

  MeshView view() const {
    MeshView view;
    view.vertex_count = static_cast<uint32_t>(positions.size() / 3);
    view.triangle_count = static_cast<uint32_t>(indices.size() / 3);
    view.positions = positions.data();
    view.normals = normals.data();
    view.owners = owners.data();
    view.colors = colors.data();
    view.occlusion = occlusion.data();
    view.indices = indices.data();
    view.repeated = repeated.data();
    view.repeated_count = static_cast<uint32_t>(repeated.size());
    view.unit = "furlong";
    return view;
  }

  OwnedMesh cut() const { return cut_at_color_borders(view(), {owners.data(), centers.data(), radii.data()}); }

  std::vector<float> positions, normals, occlusion, centers, radii;
  std::vector<uint32_t> indices, owners, repeated;
  std::vector<uint8_t> colors;
};

uint32_t place_of(const MeshView &mesh, uint32_t vertex) {
  const uint32_t places = mesh.vertex_count - mesh.repeated_count;
  return vertex < places ? vertex : mesh.repeated[vertex - places];
}

bool is_closed(const MeshView &mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (size_t t = 0; t < mesh.triangle_count; ++t)
    for (size_t k = 0; k < 3; ++k)
      ++edges[{place_of(mesh, mesh.indices[3 * t + k]), place_of(mesh, mesh.indices[3 * t + (k + 1) % 3])}];
  return std::all_of(edges.begin(), edges.end(), [&](const auto &entry) {
    const auto reverse = edges.find({entry.first.second, entry.first.first});
    return entry.second == 1 && reverse != edges.end() && reverse->second == 1;
  });
}

// Area, and volume.
std::array<double, 2> measure(const MeshView &mesh) {
  std::array<double, 2> sums = {0, 0};
  for (size_t t = 0; t < mesh.triangle_count; ++t) {
    double p[3][3];
    for (size_t k = 0; k < 3; ++k)
      for (size_t axis = 0; axis < 3; ++axis) p[k][axis] = mesh.positions[3 * size_t(mesh.indices[3 * t + k]) + axis];
    double u[3], v[3];
    for (size_t axis = 0; axis < 3; ++axis) {
      u[axis] = p[1][axis] - p[0][axis];
      v[axis] = p[2][axis] - p[0][axis];
    }
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    sums[0] += std::hypot(n[0], n[1], n[2]) / 2;
    sums[1] += (n[0] * p[0][0] + n[1] * p[0][1] + n[2] * p[0][2]) / 6;
  }
  return sums;
}

// What must hold whatever the owners are.
void check(const MeshView &before, const MeshView &after) {
  EXPECT_TRUE(is_closed(after));
  for (size_t t = 0; t < after.triangle_count; ++t)
    for (size_t k = 1; k < 3; ++k)
      ASSERT_EQ(color_of(after, after.indices[3 * t + k]), color_of(after, after.indices[3 * t])) << t;
  // New triangles lie on the old ones and cover them once: folded ones would add to the area.
  for (size_t k = 0; k < 2; ++k) EXPECT_NEAR(measure(after)[k], measure(before)[k], 1e-5 * measure(before)[0]);
  std::set<std::pair<uint32_t, uint32_t>> seen;  // each colour of a place once
  for (uint32_t i = 0; i < after.vertex_count; ++i) {
    const float *const n = after.normals + 3 * size_t(i);
    EXPECT_NEAR(std::hypot(n[0], n[1], n[2]), 1, 1e-5);
    EXPECT_EQ(after.occlusion[i], after.occlusion[i]);
    EXPECT_NEAR(after.occlusion[i], after.positions[3 * size_t(i)], 1e-5);
    const uint32_t place = place_of(after, i);
    EXPECT_LT(place, after.vertex_count - after.repeated_count);
    for (size_t axis = 0; axis < 3; ++axis)
      EXPECT_EQ(after.positions[3 * size_t(i) + axis], after.positions[3 * size_t(place) + axis]);
    EXPECT_TRUE(before.repeated_count > 0 || seen.insert({place, color_of(after, i)}).second);
  }
  std::set<uint32_t> used(after.indices, after.indices + 3 * size_t(after.triangle_count));
  EXPECT_EQ(used.size(), after.vertex_count);
}

TEST(ColorBorders, OfSpheres) {
  for (const uint32_t spheres : {2u, 3u, 10u, 60u})
    for (unsigned seed = 1; seed <= 5; ++seed) {
      SCOPED_TRACE(std::to_string(spheres) + " spheres, seed " + std::to_string(seed));
      const Painted painted(mesh_shapes::sphere(4), spheres, seed);
      const OwnedMesh cut = painted.cut();
      const MeshView view = cut.view();
      check(painted.view(), view);
      EXPECT_EQ(view.unit, "furlong");
      // Where two colours meet, their spheres are equally near, but for cuts that were moved away from the ends of an
      // edge, and for places in the middle of three.
      std::map<uint32_t, std::set<uint32_t>> owners_of_place;
      for (uint32_t i = 0; i < view.vertex_count; ++i) owners_of_place[place_of(view, i)].insert(view.owners[i]);
      size_t borders = 0, exact = 0;
      for (const auto &[place, owners] : owners_of_place) {
        if (owners.size() != 2) continue;
        const float *const x = view.positions + 3 * size_t(place);
        const double difference = painted.distance(*owners.begin(), x) - painted.distance(*owners.rbegin(), x);
        EXPECT_LT(std::abs(difference), 0.02);
        exact += std::abs(difference) < 1e-5;
        ++borders;
      }
      EXPECT_GE(exact, borders * 9 / 10);
      EXPECT_TRUE(borders > 0 || spheres < 10);
    }
}

TEST(ColorBorders, ThreeColoursMeetWhereTheirSpheresAreEquallyNear) {
  Mesh shape;  // two triangles, back to back
  shape.positions = {1, 0, 0.5f, -0.5f, 0.9f, 0.5f, -0.5f, -0.9f, 0.5f};
  shape.indices = {0, 1, 2, 0, 2, 1};
  Painted painted(shape, 1, 1);
  painted.centers = {2, 0, 0, -1, 2, 0, -1, -2, 0};
  painted.radii = {0.5f, 0.6f, 0.4f};
  painted.owners.clear();
  painted.colors.clear();
  for (uint32_t k = 0; k < 3; ++k) painted.give(k);
  const OwnedMesh cut = painted.cut();
  const MeshView view = cut.view();
  check(painted.view(), view);
  EXPECT_EQ(view.triangle_count, 12u);
  std::map<uint32_t, std::set<uint32_t>> owners_of_place;
  for (uint32_t i = 0; i < view.vertex_count; ++i) owners_of_place[place_of(view, i)].insert(view.owners[i]);
  size_t middles = 0;
  for (const auto &[place, owners] : owners_of_place) {
    const float *const x = view.positions + 3 * size_t(place);
    for (const uint32_t owner : owners)
      EXPECT_NEAR(painted.distance(owner, x), painted.distance(*owners.begin(), x), 1e-6);
    middles += owners.size() == 3;
  }
  EXPECT_EQ(middles, 2u);
}

TEST(ColorBorders, OwnersThatAreNotTheNearest) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Painted painted(mesh_shapes::sphere(3), 12, seed);
    painted.owners.clear();
    painted.colors.clear();
    std::mt19937 random(seed);
    for (size_t i = 0; i < painted.positions.size() / 3; ++i) painted.give(random() % 12);
    check(painted.view(), painted.cut().view());
  }
}

TEST(ColorBorders, VerticesThatAreRepeatedAlready) {
  Painted painted(mesh_shapes::sphere(3), 20, 3);
  // The corners of some triangles, each for itself, with normals of their own and another owner.
  for (size_t t = 0; t < painted.indices.size() / 3; t += 5)
    for (size_t k = 0; k < 3; ++k) {
      uint32_t &corner = painted.indices[3 * t + k];
      if (corner >= painted.positions.size() / 3 - painted.repeated.size()) continue;
      painted.repeated.push_back(corner);
      for (size_t axis = 0; axis < 3; ++axis) painted.positions.push_back(painted.positions[3 * size_t(corner) + axis]);
      painted.normals.insert(painted.normals.end(), {0, 0, 1});
      painted.occlusion.push_back(painted.occlusion[corner]);
      painted.give((painted.owners[corner] + 1) % 20);
      corner = static_cast<uint32_t>(painted.positions.size() / 3 - 1);
    }
  // Places that only repeated vertices are left of are used by nobody, and make no matter here.
  const std::set<uint32_t> used(painted.indices.begin(), painted.indices.end());
  ASSERT_EQ(used.size(), painted.positions.size() / 3);
  check(painted.view(), painted.cut().view());
}

TEST(ColorBorders, OneColourIsLeftAsItIs) {
  const Painted painted(mesh_shapes::sphere(3), 1, 1);
  const OwnedMesh cut = painted.cut();
  EXPECT_EQ(cut.positions, painted.positions);
  EXPECT_EQ(cut.normals, painted.normals);
  EXPECT_EQ(cut.indices, painted.indices);
  EXPECT_EQ(cut.owners, painted.owners);
  EXPECT_EQ(cut.colors, painted.colors);
  EXPECT_EQ(cut.occlusion, painted.occlusion);
  EXPECT_TRUE(cut.repeated.empty() && cut.patches.empty() && cut.component_ids.empty());
  EXPECT_EQ(cut.view().patches, nullptr);
}

}  // namespace
}  // namespace quickses::io
