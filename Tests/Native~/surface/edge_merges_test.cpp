// SPDX-License-Identifier: MIT
// Merges of short edges: meshes made by hand, random ones that are folded everywhere, and the surfaces of atoms.
#include "surface/edge_merge_fixture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace edge_merge_fixture;

size_t pieces_and_handles(const mesh_checks::Mesh &mesh) {  // the same number for the same topology
  return mesh.vertex_count() + mesh.triangle_count() - 3 * mesh.triangle_count() / 2 + 1000 * piece_count(mesh);
}

// Two cones on a circle, which is the crease, whose vertices are at these angles.
CreasedSurface two_cones(const std::vector<double> &angles, double height = 0.5) {
  CreasedSurface s;
  const double length = std::hypot(1.0, height), across = height / length, along = 1 / length;
  const auto add = [&](double x, double y, double z, Point first, Point second) {
    for (double d : {x, y, z}) s.mesh.positions.push_back(static_cast<float>(d));
    for (int k = 0; k < 3; ++k) {
      const auto at = [&](const Point &p) { return static_cast<float>(k == 0 ? p.x : k == 1 ? p.y : p.z); };
      s.mesh.normals.push_back(at(first));
      s.second_normals.push_back(at(second));
    }
    s.on_crease.push_back(z == 0 ? 1 : 0);
  };
  for (const double a : angles)
    add(std::cos(a), std::sin(a), 0, {across * std::cos(a), across * std::sin(a), along},
        {across * std::cos(a), across * std::sin(a), -along});
  add(0, 0, height, {0, 0, 1}, {0, 0, 1});
  add(0, 0, -height, {0, 0, -1}, {0, 0, -1});
  const uint32_t n = static_cast<uint32_t>(angles.size());
  for (uint32_t k = 0; k < n; ++k)
    for (const uint32_t corner : {k, (k + 1) % n, n, (k + 1) % n, k, n + 1}) s.mesh.indices.push_back(corner);
  return s;
}

std::vector<double> even_angles(size_t n) {
  std::vector<double> angles;
  for (size_t k = 0; k < n; ++k)
    angles.push_back(2 * 3.14159265358979 * static_cast<double>(k) / static_cast<double>(n));
  return angles;
}

size_t faces_turned_inwards(const mesh_checks::Mesh &mesh) {  // of what is convex around the origin
  size_t turned = 0;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    Point middle{0, 0, 0};
    for (size_t k = 0; k < 3; ++k) middle = middle + point(mesh.position(mesh.indices[3 * t + k]));
    turned += exact_reference::dot(face_normal(mesh, t), middle) <= 0 ? 1 : 0;
  }
  return turned;
}

TEST(EdgeMerges, VerticesInTheWrongOrderBecomeOne) {
  std::vector<double> angles = even_angles(12);
  angles[4] = angles[3] - 0.1;
  const CreasedSurface folded = two_cones(angles);
  ASSERT_EQ(mesh_checks::manifold_fault(folded.mesh), "");
  ASSERT_GT(faces_turned_inwards(folded.mesh), 0u);
  size_t merges = 0;
  const mesh_checks::Mesh mesh = merged(folded, &merges);
  EXPECT_EQ(merges, 1u);
  EXPECT_EQ(mesh_checks::manifold_fault(mesh), "");
  EXPECT_EQ(faces_turned_inwards(mesh), 0u);
  EXPECT_EQ(pieces_and_handles(mesh), pieces_and_handles(folded.mesh));
}

TEST(EdgeMerges, SlimTrianglesGo) {
  std::vector<double> angles = even_angles(12);
  angles.insert(angles.begin() + 4, angles[3] + 0.02);
  size_t merges = 0;
  const mesh_checks::Mesh mesh = merged(two_cones(angles), &merges);
  EXPECT_EQ(merges, 1u);
  EXPECT_EQ(mesh_checks::manifold_fault(mesh), "");
}

TEST(EdgeMerges, WhatIsFineStays) {
  const CreasedSurface fine = two_cones(even_angles(12));
  size_t merges = 1;
  const mesh_checks::Mesh mesh = merged(fine, &merges);
  EXPECT_EQ(merges, 0u);
  EXPECT_EQ(mesh.positions, fine.mesh.positions);
  EXPECT_EQ(mesh.indices, fine.mesh.indices);
}

// Two cones, on one of which a vertex is next to one of the crease: three slim triangles instead of one.
CreasedSurface with_vertex_beside(size_t k, double height) {
  const std::vector<double> angles = even_angles(12);
  CreasedSurface s = two_cones(angles, height);
  const double a = angles[k] + 0.1, length = std::hypot(1.0, height), rim = 0.97;
  for (double d : {rim * std::cos(a), rim * std::sin(a), (1 - rim) * height})
    s.mesh.positions.push_back(static_cast<float>(d));
  for (double d : {height / length * std::cos(a), height / length * std::sin(a), 1 / length}) {
    s.mesh.normals.push_back(static_cast<float>(d));
    s.second_normals.push_back(static_cast<float>(d));
  }
  s.on_crease.push_back(0);
  const uint32_t first = static_cast<uint32_t>(k), next = (first + 1) % 12, top = 12, inner = 14;
  s.mesh.indices[6 * k + 2] = inner;
  for (const uint32_t corner : {next, top, inner, top, first, inner}) s.mesh.indices.push_back(corner);
  return s;
}

TEST(EdgeMerges, CreasesKeepTheirVertices) {
  for (size_t k = 0; k < 12; ++k) {
    SCOPED_TRACE(k);
    const CreasedSurface s = with_vertex_beside(k, 0.3);
    ASSERT_EQ(mesh_checks::manifold_fault(s.mesh), "");
    size_t merges = 0;
    const mesh_checks::Mesh mesh = merged(s, &merges);
    EXPECT_EQ(merges, 1u);
    EXPECT_TRUE(std::equal(s.mesh.positions.begin(), s.mesh.positions.begin() + 36, mesh.positions.begin()));
  }
}

// The edge to the tip would be farther from what bends between them, by its normals, than a tenth of the spacing.
TEST(EdgeMerges, NoEdgeLeavesTheSurface) {
  size_t merges = 1;
  merged(with_vertex_beside(3, 0.5), &merges);
  EXPECT_EQ(merges, 0u);
}

// The ends of its edges have three neighbours in common: a merge would leave two triangles on each other.
TEST(EdgeMerges, NoEdgeOfATriangularBipyramid) {
  size_t merges = 1;
  merged(two_cones({0, 0.1, 3.2}), &merges);
  EXPECT_EQ(merges, 0u);
}

TEST(EdgeMerges, LongEdgesStay) {
  // Slim since the cones are high; no two vertices are as near as half a spacing.
  size_t merges = 1;
  merged(two_cones(even_angles(12), 40), &merges);
  EXPECT_EQ(merges, 0u);
}

// Vertices moved about, so that everything is folded: the more merges, the more of them next to each other.
TEST(EdgeMerges, KeepRandomMeshesClosedAndTheirTopology) {
  size_t all = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const CreasedSurface s = random_folds(seed, 0.05f * static_cast<float>(seed % 6 + 1));
    size_t merges = 0, again = 0;
    const mesh_checks::Mesh mesh = merged(s, &merges), threaded = merged(s, &again, 4);
    EXPECT_EQ(mesh_checks::manifold_fault(mesh), "");
    EXPECT_EQ(pieces_and_handles(mesh), pieces_and_handles(s.mesh));
    EXPECT_EQ(merges, again);
    EXPECT_EQ(mesh.positions, threaded.positions);
    EXPECT_EQ(mesh.indices, threaded.indices);
    all += merges;
  }
  EXPECT_GT(all, 500u);
}

// Splits, moves of vertices and merges change no piece and no handle of a surface.
TEST(EdgeMerges, SurfacesHaveTheTopologyThatTheyHaveWithoutCreases) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    qses_settings s = settings(seed % 2 ? 0.5 : 0.35);
    s.creases = 0;
    const Surface plain = compute(cluster(40, seed), s);
    s.creases = 1;
    const Surface sharp = compute(cluster(40, seed), s);
    EXPECT_EQ(mesh_checks::manifold_fault(sharp.mesh), "");
    EXPECT_EQ(pieces_and_handles(sharp.mesh), pieces_and_handles(plain.mesh));
  }
}

}  // namespace
