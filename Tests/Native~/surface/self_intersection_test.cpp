// SPDX-License-Identifier: MIT
// No two triangles of a surface pass through each other: decided by CGAL with exact predicates (Polygon Mesh
// Processing, self_intersections).
#include "surface/exact_fixture.h"
#include "surface/surface_checks.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <iterator>
#include <utility>

namespace {

using namespace surface_checks;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polyhedron = CGAL::Surface_mesh<Kernel::Point_3>;

size_t self_intersecting_pairs(const Surface &surface) {
  Polyhedron mesh;
  std::vector<Polyhedron::Vertex_index> vertices;
  const auto &p = surface.mesh.positions;
  for (size_t k = 0; k < p.size(); k += 3)
    vertices.push_back(mesh.add_vertex({double(p[k]), double(p[k + 1]), double(p[k + 2])}));
  const auto &t = surface.mesh.indices;
  for (size_t k = 0; k < t.size(); k += 3)
    EXPECT_NE(mesh.add_face(vertices[t[k]], vertices[t[k + 1]], vertices[t[k + 2]]), Polyhedron::null_face()) << k / 3;
  std::vector<std::pair<Polyhedron::Face_index, Polyhedron::Face_index>> pairs;
  CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(pairs));
  return pairs.size();
}

// What finds none must find some where there are.
TEST(SelfIntersections, AreFoundWhereTwoSpheresOverlap) {
  Surface two = compute(Atoms().add(0, 0, 0, 1.5).add(20, 0, 0, 1.5), settings());
  EXPECT_EQ(self_intersecting_pairs(two), 0u);
  for (size_t k = 0; k < two.mesh.positions.size(); k += 3)
    if (two.mesh.positions[k] > 10) two.mesh.positions[k] -= 19;
  EXPECT_GT(self_intersecting_pairs(two), 0u);
}

TEST(SelfIntersections, NoneInSurfacesOfSmallSets) {
  // The grooves of the VDW surface are narrower than the lattice: Documentation~/algorithm.md, Creases.
  for (const qses_surface surface : {QSES_SURFACE_SES, QSES_SURFACE_SAS})
    for (const bool creases : {false, true})
      for (unsigned seed = 1; seed <= 10; ++seed) {
        qses_settings s = settings(0.5, 1.4, surface);
        s.creases = creases;
        SCOPED_TRACE(testing::Message() << "surface " << surface << " creases " << creases << " seed " << seed);
        EXPECT_EQ(self_intersecting_pairs(compute(cluster(12, seed), s)), 0u);
      }
}

// Vertices of narrow grooves and channels are where marching cubes has them, which does not intersect itself.
TEST(SelfIntersections, NoneInTheSasOfAProteinWithCreases) {
  qses_settings s = settings(0.5, 1.4, QSES_SURFACE_SAS);
  s.creases = 1;
  EXPECT_EQ(self_intersecting_pairs(compute(crambin(), s)), 0u);
}

}  // namespace
