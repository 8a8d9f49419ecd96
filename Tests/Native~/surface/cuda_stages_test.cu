// SPDX-License-Identifier: MIT
// The stages of the exact surface on the GPU against a brute force over all atoms, on easy and on nasty inputs.
#include "surface/cuda_stages.cuh"
#include "surface/edge_ring.h"
#include "surface/mesh_checks.h"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

namespace {

using namespace quickses;
using namespace quickses::test;

CudaExecutor *device() {
  static const CudaDevice description = describe_cuda_device(0);
  if (!description.available) return nullptr;
  static CudaExecutor executor(0);
  return &executor;
}

#define REQUIRE_DEVICE() \
  if (!device()) GTEST_SKIP() << "skipped: no CUDA device (" << describe_cuda_device(0).reason << ")"

Molecule random_molecule(size_t n, float spread, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> at(-spread, spread), radius(1.2f, 1.8f);
  Molecule m;
  for (size_t k = 0; k < n; ++k) m.atoms.push_back({glm::vec3(at(random), at(random), at(random)), radius(random)});
  return m;
}

Molecule crambin() {
  Molecule m;
  std::ifstream file(std::string(QUICKSES_TEST_DATA_DIR) + "/1CRN.pdb");
  for (std::string line; std::getline(file, line);) {
    if (line.compare(0, 6, "ATOM  ") != 0 && line.compare(0, 6, "HETATM") != 0) continue;
    const char element = line[13];
    const float radius = element == 'O' ? 1.52f : element == 'C' ? 1.7f : element == 'N' ? 1.55f : 1.8f;
    m.atoms.push_back(
        {glm::vec3(std::stof(line.substr(30, 8)), std::stof(line.substr(38, 8)), std::stof(line.substr(46, 8))),
         radius});
  }
  return m;
}

// A block of atoms much denser than matter: every one has hundreds of neighbours.
Molecule dense_block() {
  Molecule m;
  for (int x = 0; x < 7; ++x)
    for (int y = 0; y < 7; ++y)
      for (int z = 0; z < 7; ++z) m.atoms.push_back({glm::vec3(0.9f * x, 0.91f * y, 0.89f * z), 1.5f});
  return m;
}

// A circle between two large atoms that twelve small ones cut into twelve arcs.
Molecule beaded_ring() {
  Molecule m;
  m.atoms.push_back({glm::vec3(0.f, 0.f, -1.f), 1.8f});
  m.atoms.push_back({glm::vec3(0.f, 0.f, 1.f), 1.8f});
  const float radius = std::sqrt(4.f - 1.f);
  for (int k = 0; k < 12; ++k) {
    const float a = 0.1f + 0.5236f * k;
    m.atoms.push_back({glm::vec3(radius * std::cos(a), radius * std::sin(a), 0.01f * k), 0.1f});
  }
  return m;
}

struct FindBorderSigns {
  const uint64_t *words;
  BorderSigns *signs;
  QSES_HOST_DEVICE void operator()(size_t b) const { signs[b] = border_signs(words + b * kLeavesPerBrick); }
};

double distance_to(const std::vector<Arc> &arcs, Point x) {
  double best = 1e30;
  for (const Arc &a : arcs) {
    const Vec3<float> y = nearest_on_arc(a, Vec3<float>(float(x.x), float(x.y), float(x.z))).position;
    best = std::min(best, length(x - Point{y.x, y.y, y.z}));
  }
  return best;
}

Point point_of(const Arc &a, double share) {  // -1 ... 1 from end to end
  const double half = std::atan2(double(a.sin_half), double(a.cos_half)), angle = share * half;
  const double full = a.cos_half <= -1.f ? share * 3.14159265358979 : angle;
  return to_point(a.center) +
         (to_point(a.middle) * std::cos(full) + to_point(a.side) * std::sin(full)) * double(a.radius);
}

// The arcs are the exposed parts of all circles: none lies in a ball, and none is missing.
void check_arcs(const StageResult &r, const ExactBoundary &exact) {
  const SurfaceParameters parameters{r.options.probe, r.options.depth, r.options.spacing, 0.f};
  double length = 0, exact_length = 0;
  for (const Arc &a : r.arcs) {
    const double half = a.cos_half <= -1.f ? 3.14159265358979 : std::atan2(double(a.sin_half), double(a.cos_half));
    length += 2 * half * a.radius;
    for (double share : {-1.0, 0.0, 1.0}) ASSERT_NEAR(exact.depth(point_of(a, share)), 0.0, 5e-4);
    ASSERT_LE(arc_bound(a).radius, parameters.max_arc_bound() + 1e-3f);
  }
  for (const ExactArc &a : exact.arcs()) {
    exact_length += (a.end - a.begin) * a.radius;
    if ((a.end - a.begin) * a.radius < 2e-3) continue;  // too short to be told from rounding
    for (double share : {0.01, 0.3, 0.5, 0.99})
      ASSERT_LT(distance_to(r.arcs, a.at(a.begin + share * (a.end - a.begin))), 3e-3);
  }
  EXPECT_NEAR(length, exact_length, 1e-3 * exact_length + 2e-3);
}

// Every lattice point of every brick.
void check_signs(const StageResult &r, const ExactBoundary &exact) {
  const Lattice &lattice = r.lattice;
  const double depth = r.options.depth;
  size_t wrong = 0, close = 0, total = 0;
  for (size_t b = 0; b < r.bricks.size(); ++b) {
    const glm::ivec3 first = lattice.first_point(unpack_place(r.bricks[b]));
    for (int z = 0; z < kBrickEdge; ++z)
      for (int y = 0; y < kBrickEdge; ++y)
        for (int x = 0; x < kBrickEdge; ++x) {
          const Vec3<float> p = lattice.position(first.x + x, first.y + y, first.z + z);
          const Point q{p.x, p.y, p.z};
          const double in_ball = exact.depth(q);
          double field = in_ball - 0.0;  // with depth 0 the sign is that of the union
          if (depth > 0 && in_ball > 0)
            field = in_ball > depth ? in_ball - depth : exact.distance(q, depth + 1) - depth;
          const bool inside = r.signs[b * kLeavesPerBrick + leaf_of(x, y, z)] >> leaf_bit(x & 3, y & 3, z & 3) & 1;
          ++total;
          if (std::fabs(field) < 3e-4)
            ++close;
          else if (inside != (field > 0) && ++wrong < 5)
            ADD_FAILURE() << "point " << q.x << " " << q.y << " " << q.z << " field " << field << " inside " << inside;
        }
  }
  EXPECT_EQ(wrong, 0u) << "of " << total;
  EXPECT_GT(total, 0u);
  EXPECT_LT(close, total / 100 + 10);
}

void check_mesh(const StageResult &r, const ExactBoundary &exact, double tolerance, size_t stride) {
  ASSERT_GT(r.counts.triangles, 0u);
  mesh_checks::Mesh mesh;
  mesh.positions = r.positions;
  mesh.normals = r.normals;
  mesh.indices = r.indices;
  mesh.owners = r.owners;
  EXPECT_EQ(mesh_checks::manifold_fault(mesh), "");
  const double depth = r.options.depth;
  const Lattice &l = r.lattice;
  std::vector<uint32_t> place(r.order.size());
  for (size_t k = 0; k < r.order.size(); ++k) place[r.order[k]] = static_cast<uint32_t>(k);
  size_t off = 0, foreign = 0, checked = 0;
  for (size_t v = 0; v < r.owners.size(); v += stride) {
    const Point x{r.positions[3 * v] - l.center_x, r.positions[3 * v + 1] - l.center_y,
                  r.positions[3 * v + 2] - l.center_z};
    const double distance = depth > 0 ? exact.distance(x, depth + 1) : std::fabs(exact.depth(x));
    off += std::fabs(distance - depth) > tolerance ? 1 : 0;
    ASSERT_LT(r.owners[v], r.order.size());
    const Sphere &owner = r.atoms[place[r.owners[v]]];
    foreign += owner.radius - length(x - to_point(owner.center)) < exact.depth(x) - 1e-3 ? 1 : 0;
    const double n = std::hypot(r.normals[3 * v], r.normals[3 * v + 1], r.normals[3 * v + 2]);
    ASSERT_NEAR(n, 1.0, 1e-4);
    ++checked;
  }
  EXPECT_LE(off, checked / 500) << "of " << checked << " vertices are not on the surface";
  EXPECT_EQ(foreign, 0u) << "of " << checked << " vertices have an owner that is not nearest";
}

void check_all(const Molecule &molecule, const StageOptions &options, double tolerance = 1e-3, size_t stride = 3) {
  const StageResult r = run_stages(*device(), molecule, options);
  const ExactBoundary exact(r.atoms);
  check_arcs(r, exact);
  check_signs(r, exact);
  check_mesh(r, exact, tolerance, stride);
}

StageOptions options(float spacing, float probe = 1.4f, float depth = -1.f) {
  StageOptions o;
  o.spacing = spacing;
  o.probe = probe;
  o.depth = depth < 0.f ? probe : depth;
  return o;
}

TEST(CudaStages, RandomMolecules) {
  REQUIRE_DEVICE();
  for (unsigned seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    check_all(random_molecule(60, 7.f, seed), options(0.7f));
  }
}

TEST(CudaStages, Protein) {
  REQUIRE_DEVICE();
  check_all(crambin(), options(1.f), 1e-3, 7);
}

TEST(CudaStages, Spacings) {
  REQUIRE_DEVICE();
  const Molecule few = random_molecule(5, 2.f, 11), many = random_molecule(150, 10.f, 12);
  check_all(few, options(0.1f), 1e-3, 101);
  check_all(many, options(2.f), 1e-2, 1);
  check_all(many, options(5.f), 1e-2, 1);
  check_all(random_molecule(30, 3.f, 13), options(0.25f), 1e-3, 31);
}

TEST(CudaStages, SpacingBeyondTheMolecule) {
  REQUIRE_DEVICE();
  const StageResult r = run_stages(*device(), random_molecule(20, 4.f, 3), options(100.f));
  mesh_checks::Mesh mesh;
  mesh.positions = r.positions;
  mesh.indices = r.indices;
  if (r.counts.triangles > 0) EXPECT_EQ(mesh_checks::manifold_fault(mesh), "");
  check_signs(r, ExactBoundary(r.atoms));
}

TEST(CudaStages, OtherSurfaces) {
  REQUIRE_DEVICE();
  const Molecule m = random_molecule(60, 6.f, 21);
  check_all(m, options(0.6f, 1.4f, 0.f));  // solvent-accessible
  check_all(m, options(0.6f, 0.f, 0.f));   // van der Waals
  check_all(m, options(0.6f, 3.f));
  check_all(m, options(0.4f, 0.5f));
}

TEST(CudaStages, SmallInputs) {
  REQUIRE_DEVICE();
  Molecule one{{{glm::vec3(3.f, -2.f, 100.f), 1.7f}}};
  check_all(one, options(0.5f));
  // Apart so far that the probe just cannot pass between them.
  Molecule two{{{glm::vec3(0.f), 1.7f}, {glm::vec3(5.8f, 0.f, 0.f), 1.7f}}};
  check_all(two, options(0.5f), 1e-3, 1);
  check_all(two, options(0.2f), 1e-3, 7);
  Molecule twins{{{glm::vec3(0.f), 1.7f}, {glm::vec3(0.f), 1.7f}, {glm::vec3(0.1f, 0.f, 0.f), 1.2f}}};
  check_all(twins, options(0.5f));
}

TEST(CudaStages, MoreNeighborsThanSharedMemoryHolds) {
  REQUIRE_DEVICE();
  const Molecule m = dense_block();
  check_all(m, options(0.5f), 1e-3, 11);
  check_all(m, options(2.f), 1e-2, 1);
}

TEST(CudaStages, MoreArcsOfACircleThanALaneHolds) {
  REQUIRE_DEVICE();
  const StageResult r = run_stages(*device(), beaded_ring(), options(0.2f, 0.2f));
  const ExactBoundary exact(r.atoms);
  size_t arcs = 0;
  for (const ExactArc &a : exact.arcs()) arcs += length(a.center) < 1e-6 ? 1 : 0;
  ASSERT_EQ(arcs, 12u);
  check_arcs(r, exact);
  check_signs(r, exact);
  check_mesh(r, exact, 1e-3, 3);
}

TEST(CudaStages, StrayAtom) {
  REQUIRE_DEVICE();
  Molecule m = random_molecule(40, 5.f, 5);
  m.atoms.push_back({glm::vec3(20000.f, 3.f, -1.f), 1.7f});
  const StageResult r = run_stages(*device(), m, options(0.5f));
  EXPECT_LT(device()->arena().held(), uint64_t(256) << 20);
  const ExactBoundary exact(r.atoms);
  mesh_checks::Mesh mesh;
  mesh.positions = r.positions;
  mesh.indices = r.indices;
  EXPECT_EQ(mesh_checks::manifold_fault(mesh), "");
  // 10,000 Å from the origin of the centred frame a float is good to 1e-3 Å.
  check_mesh(r, exact, 2e-2, 3);
}

// Vertices start where the table of marching cubes puts them, worked out point by point.
TEST(CudaStages, StartsOfVertices) {
  REQUIRE_DEVICE();
  CudaExecutor &executor = *device();
  const Molecule m = random_molecule(80, 8.f, 31);
  const StageOptions o = options(0.5f);
  const StageResult r = run_stages(executor, m, o);
  const DeviceTable table(executor);
  CudaStageTimer timer(executor);
  const DeviceStages s = run_device_stages(executor, table, timer, m.atoms.data(), m.atoms.size(), bounds_of(m), o);
  CudaCandidates candidates;
  CudaRooms rooms;
  const BrickRange all{0, s.bricks.count};
  const SliceSizes sizes = slice_sizes(executor, s.bricks, s.layout, all);
  const VertexStarts from{true, nullptr, table.view.ring, &s.layout.totals->unplaced};
  const gpu::VertexJob job =
      gpu::open_vertices(executor, {s.features, s.bricks, all, rooms, candidates}, {s.layout, sizes, from, s.mesh});
  gpu::prepare_vertices(executor, job, sizes.leaves, candidates.longest_row);
  const std::vector<float> starts = to_host(executor, s.mesh.positions, s.counts.vertices * 3);

  const BrickSet bricks{r.lattice, r.bricks.data(), nullptr, static_cast<uint32_t>(r.bricks.size())};
  size_t vertex = 0;
  for (size_t b = 0; b < r.bricks.size(); ++b) {
    const glm::ivec3 place = unpack_place(r.bricks[b]);
    for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf)
      for (int axis = 0; axis < kAxes; ++axis)
        for (int bit = 0; bit < 64; ++bit) {
          const glm::ivec3 p(4 * (leaf & 1) + (bit & 3), 4 * (leaf >> 1 & 1) + (bit >> 2 & 3),
                             4 * (leaf >> 2) + (bit >> 4));
          const int second_axis = axis == 0 ? 1 : 0, third_axis = axis == 2 ? 1 : 2;
          bool known = true;
          const auto inside = [&](int along, int second, int third) {
            glm::ivec3 q = p;
            q[axis] += along;
            q[second_axis] += second;
            q[third_axis] += third;
            const int k = bricks.find(place + glm::ivec3(q.x >> 3, q.y >> 3, q.z >> 3));
            known &= k >= 0;
            return k >= 0 && (r.signs[static_cast<size_t>(k) * kLeavesPerBrick + leaf_of(q.x & 7, q.y & 7, q.z & 7)] >>
                                  leaf_bit(q.x & 3, q.y & 3, q.z & 3) &
                              1) != 0;
          };
          const bool low = inside(0, 0, 0);
          if (low == inside(1, 0, 0) || !known) continue;
          float move[3];
          ring_displacement(edge_ring(inside, axis), &move[0], &move[1], &move[2]);
          ASSERT_TRUE(known);
          move[axis] += vertex_start(low);
          const glm::ivec3 first = r.lattice.first_point(place) + p;
          for (int d = 0; d < 3; ++d)
            ASSERT_NEAR(starts[3 * vertex + d], (first[d] + move[d]) * o.spacing, 1e-4) << "vertex " << vertex;
          ++vertex;
        }
  }
  EXPECT_EQ(vertex, s.counts.vertices);
}

TEST(CudaStages, SameBytesEveryTimeAndInSlices) {
  REQUIRE_DEVICE();
  const Molecule m = crambin();
  StageOptions o = options(0.5f);
  const StageResult first = run_stages(*device(), m, o);
  for (uint32_t per_slice : {0u, 0u, 0u, 100u, 7u}) {
    SCOPED_TRACE(per_slice);
    o.bricks_per_slice = per_slice;
    const StageResult again = run_stages(*device(), m, o);
    ASSERT_EQ(first.arcs.size(), again.arcs.size());
    EXPECT_EQ(std::memcmp(first.arcs.data(), again.arcs.data(), first.arcs.size() * sizeof(Arc)), 0);
    EXPECT_EQ(first.signs, again.signs);
    ASSERT_EQ(first.positions.size(), again.positions.size());
    EXPECT_EQ(std::memcmp(first.positions.data(), again.positions.data(), first.positions.size() * 4), 0);
    EXPECT_EQ(std::memcmp(first.normals.data(), again.normals.data(), first.normals.size() * 4), 0);
    EXPECT_EQ(first.owners, again.owners);
    EXPECT_EQ(first.patches, again.patches);
    EXPECT_EQ(first.indices, again.indices);
  }
}

// Edges are walked by a warp each where they are few, by 8 lanes where they are more, and by 4 where they are many and
// spacings not wide; from 1 Å on, what they look at is chosen twice. Walls are the same to the last one.
TEST(CudaStages, WallsAreThoseOfFewAndOfManyEdges) {
  REQUIRE_DEVICE();
  const Molecule one = crambin();
  Molecule many;
  for (int copy = 0; copy < 125; ++copy)
    for (const Sphere &a : one.atoms)
      many.atoms.push_back({a.center + 48.f * glm::vec3(copy % 5, copy / 5 % 5, copy / 25), a.radius});
  CudaExecutor &executor = *device();
  const DeviceTable table(executor);
  CudaStageTimer timer(executor);
  for (float spacing : {0.5f, 1.f, 1.3f, 3.f}) {
    SCOPED_TRACE(spacing);
    const DeviceStages s = run_device_stages(executor, table, timer, many.atoms.data(), many.atoms.size(),
                                             bounds_of(many), options(spacing));
    const uint32_t count = s.bricks.count;
    const auto marks_in_slices = [&](uint32_t slices) {
      const auto mark = executor.arena().mark();
      Span<uint64_t> marks = executor.allocate_zeros<uint64_t>(s.signs.size);
      CudaRooms rooms;
      for (uint32_t k = 0; k < slices; ++k) {
        CudaCandidates own;
        const BrickRange slice{count * k / slices, count * (k + 1) / slices};
        Backend<CudaExecutor>::mark_thin_walls(executor, {s.features, s.bricks, slice, rooms, own}, s.signs.data,
                                               marks.data);
      }
      std::vector<uint64_t> found = to_host(executor, marks.data, marks.size);
      executor.arena().rewind(mark);
      return found;
    };
    const std::vector<uint64_t> at_once = marks_in_slices(1);
    int walls = 0;
    for (uint64_t word : at_once) walls += popcount64(word);
    EXPECT_GT(walls, 100);
    EXPECT_EQ(at_once, marks_in_slices(6));
    EXPECT_EQ(at_once, marks_in_slices(60));
  }
}

// Compilers have got this wrong: ptxas 11.8 took (~word & 0xffff) != 0 for (word & 0xffff) != 0.
TEST(CudaStages, BorderSignsAreThoseOfTheHost) {
  REQUIRE_DEVICE();
  constexpr size_t kBricks = 4096;
  std::mt19937_64 random(3);
  std::vector<uint64_t> words(kBricks * kLeavesPerBrick);
  for (size_t k = 0; k < words.size(); ++k) {
    const uint64_t few = random() & random() & random() & random(), one = uint64_t(1) << random() % 64;
    const uint64_t kinds[] = {few, ~few, one, ~one, 0, ~uint64_t(0), random()};
    words[k] = kinds[k / kLeavesPerBrick % 3 == 0 ? k / kLeavesPerBrick % 7 : random() % 7];
  }
  CudaExecutor &executor = *device();
  const auto mark = executor.arena().mark();
  Span<uint64_t> on_device = executor.allocate<uint64_t>(words.size());
  Span<BorderSigns> found = executor.allocate<BorderSigns>(kBricks);
  executor.upload(on_device.data, words.data(), words.size());
  executor.for_each(kBricks, FindBorderSigns{on_device.data, found.data});
  std::vector<BorderSigns> signs(kBricks);
  executor.download(signs.data(), found.data, kBricks);
  executor.wait();
  executor.arena().rewind(mark);
  for (size_t b = 0; b < kBricks; ++b) {
    const BorderSigns expected = border_signs(&words[b * kLeavesPerBrick]);
    ASSERT_EQ(signs[b].inside, expected.inside) << b;
    ASSERT_EQ(signs[b].outside, expected.outside) << b;
  }
}

}  // namespace
