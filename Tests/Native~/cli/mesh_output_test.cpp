// SPDX-License-Identifier: MIT
// The program writes closed meshes only: what it takes for closed, and that nothing is written of what is not.
#include "cli/mesh_output.h"

#include <map>
#include <random>
#include <vector>

#include "cli/exit_code.h"
#include "cli/mesh_check.h"
#include "io/io_fixture.h"
#include "surface/mesh_shapes.h"

namespace quickses::cli {
namespace {

using io::contains;
using io::slurp;
using mesh_shapes::Mesh;

// One owner, atom 0; normals are of no interest here.
struct Surface {
  explicit Surface(const Mesh &given) : mesh(given) {
    normals.resize(mesh.positions.size());
    owners.resize(mesh.vertex_count());
    qses_mesh_init(&view);
    view.vertex_count = static_cast<uint32_t>(mesh.vertex_count());
    view.triangle_count = static_cast<uint32_t>(mesh.triangle_count());
    view.positions = mesh.positions.data();
    view.normals = normals.data();
    view.owners = owners.data();
    view.indices = mesh.indices.data();
  }

  const Mesh mesh;
  std::vector<float> normals;
  std::vector<uint32_t> owners;
  qses_mesh view;
};

bool is_closed(const Mesh &mesh) { return cli::is_closed(Surface(mesh).view); }

// Two tips above and below a ring: vertices with many neighbours.
Mesh bipyramid(uint32_t ring) {
  Mesh m;
  m.positions.resize(3 * (ring + 2));
  const uint32_t top = ring, bottom = ring + 1;
  for (uint32_t i = 0; i < ring; ++i) {
    const uint32_t next = (i + 1) % ring;
    for (uint32_t v : {i, next, top, next, i, bottom}) m.indices.push_back(v);
  }
  return m;
}

std::vector<Mesh> closed_meshes() {
  return {Mesh(),         mesh_shapes::tetrahedron(), mesh_shapes::cube(), mesh_shapes::sphere(3), bipyramid(9),
          bipyramid(1000)};
}

TEST(IsClosed, ClosedMeshes) {
  for (const Mesh &mesh : closed_meshes()) EXPECT_TRUE(is_closed(mesh)) << mesh.triangle_count();
}

TEST(IsClosed, PiecesThatShareNoMoreThanAVertex) {
  Mesh mesh = mesh_shapes::tetrahedron();
  const uint32_t other[] = {0, 4, 5, 6};  // a second one, at the same first vertex
  for (size_t i = 0; i < 12; ++i) mesh.indices.push_back(other[mesh.indices[i]]);
  mesh.positions.resize(3 * 7);
  EXPECT_TRUE(is_closed(mesh));
}

TEST(IsClosed, AHoleATurnedAndADoubleTriangle) {
  for (const Mesh &mesh : closed_meshes())
    for (size_t t = 0; t < mesh.triangle_count(); t += 1 + mesh.triangle_count() / 7) {
      const auto triangle = mesh.indices.begin() + 3 * static_cast<ptrdiff_t>(t);
      Mesh hole = mesh, turned = mesh, twice = mesh;
      hole.indices.erase(hole.indices.begin() + (triangle - mesh.indices.begin()),
                         hole.indices.begin() + (triangle - mesh.indices.begin()) + 3);
      std::swap(turned.indices[3 * t], turned.indices[3 * t + 1]);
      twice.indices.insert(twice.indices.end(), triangle, triangle + 3);
      EXPECT_FALSE(is_closed(hole));
      EXPECT_FALSE(is_closed(turned));
      EXPECT_FALSE(is_closed(twice));
    }
}

TEST(IsClosed, WholeMeshesTwiceAndEdgesOfFourTriangles) {
  for (const Mesh &mesh : closed_meshes()) {
    if (mesh.triangle_count() == 0) continue;
    Mesh twice = mesh;  // every edge both ways, but two times each
    twice.indices.insert(twice.indices.end(), mesh.indices.begin(), mesh.indices.end());
    EXPECT_FALSE(is_closed(twice));
  }
  Mesh mesh = mesh_shapes::tetrahedron();
  const uint32_t other[] = {0, 1, 4, 5};  // shares the edge 0-1
  for (size_t i = 0; i < 12; ++i) mesh.indices.push_back(other[mesh.indices[i]]);
  mesh.positions.resize(3 * 6);
  EXPECT_FALSE(is_closed(mesh));
}

TEST(IsClosed, WithVerticesThatStandForOthers) {
  Mesh mesh = mesh_shapes::tetrahedron();
  mesh.positions.insert(mesh.positions.end(), mesh.positions.begin() + 3, mesh.positions.begin() + 9);
  bool first = true;
  for (uint32_t &v : mesh.indices) {  // a corner at vertex 1 and one at vertex 2
    if (v == 1 && first) v = 4, first = false;
    if (v == 2) v = 5;
  }
  Surface surface(mesh);
  EXPECT_FALSE(cli::is_closed(surface.view));
  const uint32_t repeated[] = {1, 2}, others[] = {2, 1};
  surface.view.repeated = repeated;
  surface.view.repeated_count = 2;
  EXPECT_TRUE(cli::is_closed(surface.view));
  surface.view.repeated = others;
  EXPECT_FALSE(cli::is_closed(surface.view));
}

TEST(IsClosed, TrianglesThatAreNone) {
  Mesh mesh = mesh_shapes::tetrahedron();
  for (uint32_t v : {0u, 1u, 1u}) mesh.indices.push_back(v);  // its edges 0-1 and 1-0 would fit
  EXPECT_FALSE(is_closed(mesh));
  mesh = mesh_shapes::tetrahedron();
  for (uint32_t &v : mesh.indices)
    if (v == 3) v = 4;  // there are four vertices
  EXPECT_FALSE(is_closed(mesh));
}

// By the definition: every directed edge once, and its reverse once.
bool is_closed_by_map(const Mesh &mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (size_t i = 0; i < mesh.indices.size(); ++i) ++edges[{mesh.indices[i], mesh.indices[i % 3 == 2 ? i - 2 : i + 1]}];
  for (const auto &[edge, count] : edges) {
    const auto reverse = edges.find({edge.second, edge.first});
    if (edge.first == edge.second || count != 1 || reverse == edges.end() || reverse->second != 1) return false;
  }
  return true;
}

TEST(IsClosed, AsTheDefinitionSaysForRandomTriangles) {
  std::mt19937 random(1);
  size_t closed = 0;
  for (int k = 0; k < 200000; ++k) {
    Mesh mesh;
    mesh.positions.resize(3 * 4);
    for (int i = 0; i < 12; ++i) mesh.indices.push_back(random() % 4);
    ASSERT_EQ(is_closed(mesh), is_closed_by_map(mesh)) << k;
    closed += is_closed(mesh);
  }
  EXPECT_GT(closed, 0u);
}

class AcceptSurface : public io::IoTest {
 protected:
  AcceptSurface() { structure_.atoms.resize(1); }
  io::Structure structure_;
  Options options_;
};

TEST_F(AcceptSurface, OfAnOpenMeshNothingIsWritten) {
  Mesh open = mesh_shapes::cube();
  open.indices.resize(open.indices.size() - 3);
  const Surface surface(open);
  write("old.obj", "old");
  for (const std::string &name : {path("a.obj"), path("b.ply"), path("c.stl"), path("old.obj"), std::string()}) {
    try {
      MeshOutput(options_, structure_).accept(name, surface.view, nullptr);
      ADD_FAILURE() << name;
    } catch (const Failure &failure) {
      EXPECT_EQ(failure.code(), 4);
      EXPECT_HAS(failure.what(), "not closed");
    }
  }
  EXPECT_EQ(file_count(), 1u);
  EXPECT_EQ(slurp(path("old.obj")), "old");
}

TEST_F(AcceptSurface, AClosedMeshIsWritten) {
  const Surface surface(mesh_shapes::cube());
  MeshOutput(options_, structure_).accept("", surface.view, nullptr);
  EXPECT_EQ(file_count(), 0u);
  MeshOutput(options_, structure_).accept(path("a.stl"), surface.view, nullptr);
  EXPECT_EQ(slurp(path("a.stl")).size(), 84u + 50 * 12);
}

}  // namespace
}  // namespace quickses::cli
