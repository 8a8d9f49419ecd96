// SPDX-License-Identifier: MIT
// Marching cubes: the generated table, and meshes of random signs, which are the hardest input there is.
#include "surface/edge_ring.h"
#include "surface/mesh_checks.h"

#include "surface/cpu/exact_ses_cpu.h"
#include "surface/stages/marching_cubes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>

namespace {

using namespace quickses;

// Corners of an edge of the cell.
std::array<int, 2> corners_of(int edge) {
  const int low = edge_origin_x(edge) | edge_origin_y(edge) << 1 | edge_origin_z(edge) << 2;
  return {low, low | 1 << edge_axis(edge)};
}

bool inside(int cell_case, int corner) { return (cell_case >> corner & 1) != 0; }

using Segment = std::array<int, 2>;

// Directed sides of the case's triangles that no other triangle of the cell passes the other way.
std::set<Segment> rim(int cell_case) {
  const MarchingCubesTable &table = marching_cubes_table();
  std::set<Segment> sides;
  for (int t = 0; t < table.triangle_count[cell_case]; ++t)
    for (int k = 0; k < 3; ++k) {
      const Segment side = {table.edges[cell_case][3 * t + k], table.edges[cell_case][3 * t + (k + 1) % 3]};
      EXPECT_TRUE(sides.insert(side).second) << "case " << cell_case << " passes a side twice";
    }
  std::set<Segment> open;
  for (const Segment &s : sides)
    if (!sides.count({s[1], s[0]})) open.insert(s);
  return open;
}

// The face of the cell with coordinate `axis` 0 or 1 that holds both edges; -1 if there is none.
bool on_face(int edge, int axis, int side) {
  const std::array<int, 2> c = corners_of(edge);
  return (c[0] >> axis & 1) == side && (c[1] >> axis & 1) == side;
}

TEST(Table, HasAVertexOnEveryCutEdgeAndNowhereElse) {
  const MarchingCubesTable &table = marching_cubes_table();
  for (int code = 0; code < kCellCases; ++code) {
    ASSERT_LE(table.triangle_count[code], kMostCaseTriangles);
    std::set<int> used(table.edges[code], table.edges[code] + 3 * table.triangle_count[code]);
    for (int e = 0; e < kCellEdges; ++e) {
      const std::array<int, 2> c = corners_of(e);
      ASSERT_EQ(used.count(e) == 1, inside(code, c[0]) != inside(code, c[1])) << "case " << code << " edge " << e;
    }
  }
  EXPECT_EQ(table.triangle_count[0], 0);
  EXPECT_EQ(table.triangle_count[255], 0);
}

// Every open side of a case lies in one face of the cell, and the neighbour beyond that face, whatever its other
// corners, passes it the other way.
TEST(Table, ClosesAcrossFaces) {
  std::vector<std::set<Segment>> rims;
  for (int code = 0; code < kCellCases; ++code) rims.push_back(rim(code));
  for (int code = 0; code < kCellCases; ++code)
    for (const Segment &s : rims[static_cast<size_t>(code)]) {
      int faces = 0;
      for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) faces += on_face(s[0], axis, side) && on_face(s[1], axis, side) ? 1 : 0;
      ASSERT_EQ(faces, 1) << "case " << code;
    }
  for (int axis = 0; axis < 3; ++axis) {
    const auto of_face = [&](int code, int side) {
      std::set<Segment> found;
      for (const Segment &s : rims[static_cast<size_t>(code)])
        if (on_face(s[0], axis, side) && on_face(s[1], axis, side)) found.insert(s);
      return found;
    };
    // Across the face an edge has the number it has on the neighbour's opposite face.
    const auto beyond = [&](int edge) {
      const std::array<int, 2> c = corners_of(edge);
      for (int e = 0; e < kCellEdges; ++e) {
        const std::array<int, 2> d = corners_of(e);
        if (d[0] == (c[0] ^ 1 << axis) && d[1] == (c[1] ^ 1 << axis)) return e;
      }
      return -1;
    };
    const auto signs_of_face = [&](int code, int side) {
      int signs = 0;
      for (int corner = 0, k = 0; corner < 8; ++corner)
        if ((corner >> axis & 1) == side) signs |= (code >> corner & 1) << k++;
      return signs;
    };
    size_t pairs = 0;
    for (int a = 0; a < kCellCases; ++a)
      for (int b = 0; b < kCellCases; ++b) {
        if (signs_of_face(a, 1) != signs_of_face(b, 0)) continue;
        ++pairs;
        std::set<Segment> expected;
        for (const Segment &s : of_face(a, 1)) expected.insert({beyond(s[1]), beyond(s[0])});
        ASSERT_EQ(of_face(b, 0), expected) << "cases " << a << " and " << b << " along axis " << axis;
      }
    EXPECT_EQ(pairs, 16u * 16 * 16);
  }
}

// The normal of each triangle's polygon points from inside corners to outside ones: for one inside corner exactly.
TEST(Table, FacesOutward) {
  const MarchingCubesTable &table = marching_cubes_table();
  for (int corner = 0; corner < 8; ++corner)
    for (bool inverted : {false, true}) {
      const int code = inverted ? 255 & ~(1 << corner) : 1 << corner;
      ASSERT_EQ(table.triangle_count[code], 1);
      double p[3][3], center[3];
      for (int k = 0; k < 3; ++k) {
        const std::array<int, 2> c = corners_of(table.edges[code][k]);
        for (int d = 0; d < 3; ++d) p[k][d] = 0.5 * ((c[0] >> d & 1) + (c[1] >> d & 1));
      }
      for (int d = 0; d < 3; ++d) center[d] = p[0][d] - (corner >> d & 1);
      double u[3], v[3];
      for (int d = 0; d < 3; ++d) u[d] = p[1][d] - p[0][d], v[d] = p[2][d] - p[0][d];
      const double along = center[0] * (u[1] * v[2] - u[2] * v[1]) + center[1] * (u[2] * v[0] - u[0] * v[2]) +
                           center[2] * (u[0] * v[1] - u[1] * v[0]);
      EXPECT_TRUE(inverted ? along < 0 : along > 0) << "case " << code;
    }
}

TEST(Leaves, ShiftsAndBits) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const uint64_t w = random(), next = random();
    for (int z = 0; z < 4; ++z)
      for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
          const auto bit = [](uint64_t word, int i, int j, int k) { return word >> leaf_bit(i, j, k) & 1; };
          ASSERT_EQ(bit(shift_x(w, next), x, y, z), x < 3 ? bit(w, x + 1, y, z) : bit(next, 0, y, z));
          ASSERT_EQ(bit(shift_y(w, next), x, y, z), y < 3 ? bit(w, x, y + 1, z) : bit(next, x, 0, z));
          ASSERT_EQ(bit(shift_z(w, next), x, y, z), z < 3 ? bit(w, x, y, z + 1) : bit(next, x, y, 0));
        }
  }
}

// ---- meshes of given signs

// A block of active bricks, the outermost lattice points outside.
class Block {
 public:
  Block(int bricks, double share, unsigned seed, bool table) : edge_(bricks * kBrickEdge), executor_(2) {
    std::mt19937 random(seed);
    std::bernoulli_distribution in(share);
    inside_.resize(static_cast<size_t>(edge_) * edge_ * edge_);
    for (int z = 0; z < edge_; ++z)
      for (int y = 0; y < edge_; ++y)
        for (int x = 0; x < edge_; ++x) {
          const int m = edge_ - 1;
          inside_[index(x, y, z)] = x > 0 && y > 0 && z > 0 && x < m && y < m && z < m && in(random);
        }
    lattice_.spacing = 1.f;
    lattice_.first_brick = glm::ivec3(0);
    lattice_.brick_count = glm::ivec3(bricks + 2, bricks + 1, bricks + 3);  // some of the table is not active
    for (int z = 0; z < bricks; ++z)
      for (int y = 0; y < bricks; ++y)
        for (int x = 0; x < bricks; ++x) places_.push_back(pack_place(glm::ivec3(x, y, z)));
    table_.assign(lattice_.table_size(), -1);
    for (size_t b = 0; b < places_.size(); ++b)
      table_[lattice_.linear(unpack_place(places_[b]))] = static_cast<int32_t>(b);
    bricks_ = {lattice_, places_.data(), table ? table_.data() : nullptr, static_cast<uint32_t>(places_.size())};
    signs_.assign(places_.size() * kLeavesPerBrick, 0);
    for (int z = 0; z < edge_; ++z)
      for (int y = 0; y < edge_; ++y)
        for (int x = 0; x < edge_; ++x)
          if (inside_[index(x, y, z)])
            signs_[size_t(brick_of(x, y, z)) * kLeavesPerBrick + size_t(leaf_of(x & 7, y & 7, z & 7))] |=
                uint64_t(1) << leaf_bit(x & 3, y & 3, z & 3);
    counts_ = lay_out_mesh(executor_, bricks_, signs_.data(), marching_cubes_table().triangle_count, &layout_);
  }

  bool inside(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < edge_ && y < edge_ && z < edge_ && inside_[index(x, y, z)];
  }
  int edge() const { return edge_; }
  const MeshCounts &counts() const { return counts_; }

  // Number of the vertex between a point and the next one along an axis.
  uint32_t vertex(int x, int y, int z, int axis) const {
    return vertex_number(layout_, brick_of(x, y, z), leaf_of(x & 7, y & 7, z & 7), axis, leaf_bit(x & 3, y & 3, z & 3));
  }

  // What a set of kernels counts is what was laid out, by whichever set.
  void expect_counts_of(const CpuKernels &kernels) {
    const size_t masks = size_t(bricks_.count) * kBrickMasks;
    const std::vector<uint64_t> crossing(layout_.crossing, layout_.crossing + masks);
    const std::vector<uint16_t> ranks(layout_.vertex_rank, layout_.vertex_rank + masks);
    std::fill_n(layout_.crossing, masks, 0);
    std::fill_n(layout_.vertex_rank, masks, uint16_t(0));
    for (uint32_t b = 0; b < bricks_.count; ++b) {
      const BrickTotals own = kernels.count_brick(bricks_, layout_, b, marching_cubes_table().triangle_count);
      ASSERT_EQ(own.vertices, layout_.base[b + 1].vertices - layout_.base[b].vertices);
      ASSERT_EQ(own.triangles, layout_.base[b + 1].triangles - layout_.base[b].triangles);
      ASSERT_EQ(own.leaves, layout_.base[b + 1].leaves - layout_.base[b].leaves);
    }
    ASSERT_TRUE(std::equal(crossing.begin(), crossing.end(), layout_.crossing));
    ASSERT_TRUE(std::equal(ranks.begin(), ranks.end(), layout_.vertex_rank));
  }

  mesh_checks::Mesh mesh(const CpuKernels &kernels, bool reversed = false) {
    CpuKernelExecutor executor(2, kernels);
    mesh_checks::Mesh m;
    m.positions.assign(3 * counts_.vertices, NAN);
    m.indices.assign(3 * counts_.triangles, ~uint32_t(0));
    const MarchingCubesTable &t = marching_cubes_table();
    emit_triangles(executor, bricks_, layout_, BrickRange{0, bricks_.count}, {t.triangle_count, t.edges, t.ring},
                   MeshView{m.positions.data(), nullptr, nullptr, nullptr, m.indices.data(), reversed});
    for_each_cut([&](int x, int y, int z, int axis) {
      float *p = &m.positions[3 * size_t(vertex(x, y, z, axis))];
      p[0] = static_cast<float>(x), p[1] = static_cast<float>(y), p[2] = static_cast<float>(z);
      p[axis] += vertex_start(inside(x, y, z));
    });
    return m;
  }

  template <class Visit>
  void for_each_cut(const Visit &visit) const {
    for (int z = 0; z < edge_; ++z)
      for (int y = 0; y < edge_; ++y)
        for (int x = 0; x < edge_; ++x)
          for (int axis = 0; axis < 3; ++axis)
            if (inside(x, y, z) != inside(x + (axis == 0), y + (axis == 1), z + (axis == 2))) visit(x, y, z, axis);
  }

 private:
  size_t index(int x, int y, int z) const { return static_cast<size_t>(x + edge_ * (y + edge_ * z)); }
  int brick_of(int x, int y, int z) const { return table_[lattice_.linear(glm::ivec3(x >> 3, y >> 3, z >> 3))]; }

  int edge_;
  CpuExecutor executor_;
  std::vector<uint8_t> inside_;
  Lattice lattice_{};
  std::vector<uint64_t> places_;
  std::vector<int32_t> table_;
  BrickSet bricks_{};
  std::vector<uint64_t> signs_;
  MeshLayout layout_{};
  MeshCounts counts_{};
};

struct Noise {
  int bricks;
  double share;
  unsigned seed;
};
const Noise kNoises[] = {{1, 0.5, 1}, {2, 0.02, 2}, {4, 0.5, 3}, {4, 0.15, 4}, {3, 0.85, 5}, {2, 1.0, 6}};

TEST(Leaves, CasesOfEightCellsAreThoseOfEach) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    LeafWords words;
    for (uint64_t &word : words.at) word = random() & random();
    const LeafWords corners = cell_corners(words);
    for (int bit = 0; bit < 64; ++bit)
      ASSERT_EQ(static_cast<int>(cell_cases(corners, bit & ~7) >> (8 * (bit & 7)) & 0xff), cell_case(corners, bit));
  }
  const MarchingCubesTable &table = marching_cubes_table();
  EXPECT_EQ(table.triangle_count[0], 0);  // what count_leaf() relies on
  EXPECT_EQ(table.triangle_count[kCellCases - 1], 0);
  EXPECT_EQ(*std::max_element(table.triangle_count, table.triangle_count + kCellCases), kMostCaseTriangles);
}

TEST(Noise, VerticesAreNumberedOnceByBrickLeafAxisAndBit) {
  for (const Noise &n : kNoises)
    for (bool table : {true, false}) {
      const Block block(n.bricks, n.share, n.seed, table);
      struct Place {
        std::array<int, 9> order;  // brick z y x, leaf, axis, bit z y x
        uint32_t number;
      };
      std::vector<Place> places;
      block.for_each_cut([&](int x, int y, int z, int axis) {
        places.push_back({{z >> 3, y >> 3, x >> 3, leaf_of(x & 7, y & 7, z & 7), axis, z & 3, y & 3, x & 3, 0},
                          block.vertex(x, y, z, axis)});
      });
      ASSERT_EQ(places.size(), block.counts().vertices);
      std::sort(places.begin(), places.end(), [](const Place &a, const Place &b) { return a.order < b.order; });
      for (size_t k = 0; k < places.size(); ++k) ASSERT_EQ(places[k].number, k);
    }
}

TEST(Noise, MeshesAreClosedManifolds) {
  for (const Noise &n : kNoises)
    for (const CpuKernels *kernels : usable_cpu_kernels())
      for (bool table : {true, false}) {
        SCOPED_TRACE(testing::Message() << n.bricks << " bricks, " << n.share << " inside, " << kernels->name);
        Block block(n.bricks, n.share, n.seed, table);
        ASSERT_NO_FATAL_FAILURE(block.expect_counts_of(*kernels));
        const mesh_checks::Mesh mesh = block.mesh(*kernels);
        ASSERT_GT(mesh.triangle_count(), 100u);
        EXPECT_EQ(mesh_checks::manifold_fault(mesh), "");
        EXPECT_GT(mesh_checks::signed_volume(mesh), 0);
        EXPECT_EQ(mesh.indices, Block(n.bricks, n.share, n.seed, !table).mesh(*usable_cpu_kernels()[0]).indices);
        const mesh_checks::Mesh reversed = block.mesh(*kernels, true);
        EXPECT_EQ(mesh_checks::manifold_fault(reversed), "");
        EXPECT_NEAR(mesh_checks::signed_volume(reversed), -mesh_checks::signed_volume(mesh),
                    1e-6 * static_cast<double>(mesh.triangle_count()));
      }
}

// Triangles lie in the cells of their three edges: none is longer than a cell's diagonal.
TEST(Noise, TrianglesStayInTheirCells) {
  Block block(3, 0.4, 9, true);
  const mesh_checks::Mesh mesh = block.mesh(cpu_kernels());
  for (size_t t = 0; t < mesh.triangle_count(); ++t)
    for (int d = 0; d < 3; ++d) {
      float low = 1e9f, high = -1e9f;
      for (size_t k = 0; k < 3; ++k) {
        const float p = mesh.positions[3 * mesh.indices[3 * t + k] + static_cast<size_t>(d)];
        low = std::min(low, p), high = std::max(high, p);
      }
      ASSERT_LE(std::ceil(high) - std::floor(low), 1.f);
    }
}

// The table of the first relaxation step against the triangles of the mesh: the mean of the other corners of all
// triangles around a vertex, less the vertex, times the weight.
TEST(Noise, RelaxationTableEqualsTheRing) {
  for (double share : {0.5, 0.1, 0.9}) {
    Block block(3, share, 11, true);
    const mesh_checks::Mesh mesh = block.mesh(cpu_kernels());
    std::vector<std::array<double, 4>> sums(mesh.vertex_count(), {0, 0, 0, 0});
    for (size_t t = 0; t < mesh.triangle_count(); ++t)
      for (size_t k = 0; k < 3; ++k) {
        const size_t v = mesh.indices[3 * t + k];
        for (size_t other = 1; other < 3; ++other) {
          const auto p = mesh.position(mesh.indices[3 * t + (k + other) % 3]), q = mesh.position(v);
          for (size_t d = 0; d < 3; ++d) sums[v][d] += p[d] - q[d];
          sums[v][3] += 1;
        }
      }
    double longest = 0;
    block.for_each_cut([&](int x, int y, int z, int axis) {
      const auto sign_near = [&](int along, int second, int third) {
        int p[3] = {x, y, z};
        p[axis] += along;
        p[axis == 0 ? 1 : 0] += second;
        p[axis == 2 ? 1 : 2] += third;
        return block.inside(p[0], p[1], p[2]);
      };
      float moved[3];
      ring_displacement(edge_ring(sign_near, axis), &moved[0], &moved[1], &moved[2]);
      const std::array<double, 4> &s = sums[block.vertex(x, y, z, axis)];
      for (size_t d = 0; d < 3; ++d) {
        // Starts are rounded to 1/128 of the spacing.
        ASSERT_NEAR(static_cast<double>(moved[d]), static_cast<double>(kRelaxationWeight) * s[d] / s[3], 0.006);
        longest = std::max(longest, std::abs(static_cast<double>(moved[d])));
      }
    });
    EXPECT_GT(longest, 0.1);
  }
}

}  // namespace
