// SPDX-License-Identifier: MIT
// The checks of meshes must accept good meshes and find each kind of fault.
#include "surface/mesh_checks.h"
#include "surface/mesh_shapes.h"

#include <gtest/gtest.h>

#include <limits>

namespace {

using mesh_checks::manifold_fault;
using mesh_checks::Mesh;

TEST(MeshChecks, AcceptClosedShapes) {
  for (const Mesh &m :
       {mesh_shapes::tetrahedron(), mesh_shapes::cube(), mesh_shapes::octahedron(), mesh_shapes::sphere(3)}) {
    EXPECT_EQ(manifold_fault(m), "");
    EXPECT_GT(mesh_checks::signed_volume(m), 0.0);
    EXPECT_EQ(mesh_checks::piece_count(m), 1u);
  }
  EXPECT_EQ(manifold_fault(Mesh{}), "");
}

TEST(MeshChecks, FindAHole) {
  Mesh m = mesh_shapes::cube();
  m.indices.resize(m.indices.size() - 3);
  EXPECT_NE(manifold_fault(m).find("one triangle only"), std::string::npos) << manifold_fault(m);
}

TEST(MeshChecks, FindATriangleTurnedOver) {
  Mesh m = mesh_shapes::octahedron();
  std::swap(m.indices[1], m.indices[2]);
  EXPECT_NE(manifold_fault(m), "");
}

TEST(MeshChecks, FindATriangleThatIsThereTwice) {
  Mesh m = mesh_shapes::octahedron();
  for (int k = 0; k < 3; ++k) m.indices.push_back(m.indices[static_cast<size_t>(k)]);
  EXPECT_NE(manifold_fault(m).find("twice"), std::string::npos) << manifold_fault(m);
}

TEST(MeshChecks, FindTwoShapesThatShareAVertex) {
  Mesh m = mesh_shapes::octahedron(), other = mesh_shapes::octahedron();
  mesh_shapes::scale_and_move(other, 1, 2, 0, 0);
  mesh_shapes::append(m, other);
  EXPECT_EQ(manifold_fault(m), "");
  EXPECT_EQ(mesh_checks::piece_count(m), 2u);
  for (uint32_t &v : m.indices)
    if (v == 7) v = 0;  // (1, 0, 0) of both
  m.positions.erase(m.positions.begin() + 21, m.positions.begin() + 24);
  for (uint32_t &v : m.indices) v -= v > 7 ? 1 : 0;
  EXPECT_NE(manifold_fault(m).find("several fans"), std::string::npos) << manifold_fault(m);
}

TEST(MeshChecks, FindAVertexWithoutTriangles) {
  Mesh m = mesh_shapes::octahedron();
  m.positions.insert(m.positions.end(), {5, 5, 5});
  EXPECT_NE(manifold_fault(m).find("no triangle"), std::string::npos) << manifold_fault(m);
}

TEST(MeshChecks, FindBadNumbers) {
  Mesh m = mesh_shapes::octahedron();
  m.positions[4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(manifold_fault(m).find("not finite"), std::string::npos);
  m = mesh_shapes::octahedron();
  m.indices[2] = 6;
  EXPECT_NE(manifold_fault(m).find("names vertex 6"), std::string::npos);
  m.indices[2] = m.indices[1];
  EXPECT_NE(manifold_fault(m).find("twice"), std::string::npos);
}

}  // namespace
