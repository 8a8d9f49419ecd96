// SPDX-License-Identifier: MIT
// Closed by construction: from whatever bricks one begins with, whatever the signs are and whatever is wrong with the
// features, no sign changes on the border of the set in the end, and the mesh is a closed manifold.
#include "surface/exact_fixture.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace {

using namespace exact_fixture;
using surface_fixture::Atoms;
using surface_fixture::cluster;
using surface_fixture::settings;

// ---- signs towards neighbours, against every lattice point

bool inside(const uint64_t *words, int x, int y, int z) {
  return words[leaf_of(x, y, z)] >> leaf_bit(x & 3, y & 3, z & 3) & 1;
}

bool is_next_to(int step, int coordinate) { return step == 0 || coordinate == (step < 0 ? 0 : kBrickEdge - 1); }

TEST(BorderSigns, AreThoseOfThePointsNextToEachNeighbour) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 400; ++trial) {
    uint64_t words[kLeavesPerBrick];
    const bool most = trial % 2 != 0;
    for (uint64_t &w : words) {  // few points of one sign
      w = ~uint64_t(0);
      for (int k = 0; k < trial % 9; ++k) w &= random();
      if (most) w = ~w;
    }
    const BorderSigns signs = border_signs(words);
    for (int k = 0; k < kNeighborhood; ++k) {
      const glm::ivec3 step = neighbor_step(k);
      bool any_inside = false, any_outside = false;
      for (int z = 0; z < kBrickEdge; ++z)
        for (int y = 0; y < kBrickEdge; ++y)
          for (int x = 0; x < kBrickEdge; ++x)
            if (is_next_to(step.x, x) && is_next_to(step.y, y) && is_next_to(step.z, z))
              (inside(words, x, y, z) ? any_inside : any_outside) = true;
      ASSERT_EQ(signs.inside >> k & 1, any_inside) << trial << ", neighbour " << k;
      ASSERT_EQ(signs.outside >> k & 1, any_outside) << trial << ", neighbour " << k;
    }
  }
}

TEST(BorderSigns, SharedNeighboursAreThoseNextToBoth) {
  for (int other = 0; other < kNeighborhood; ++other) {
    const glm::ivec3 step = neighbor_step(other);
    for (int k = 0; k < kNeighborhood; ++k) {
      const glm::ivec3 seen = step + neighbor_step(k);  // from here
      const bool next_to_both = glm::all(glm::lessThanEqual(glm::abs(seen), glm::ivec3(1)));
      const uint32_t expected = next_to_both ? 1u << (seen.x + 1 + 3 * (seen.y + 1) + 9 * (seen.z + 1)) : 0;
      ASSERT_EQ(shared_neighbors(1u << k, step), expected) << other << ", " << k;
    }
  }
}

// ---- growing sets over given signs

// Blobs and noise in the middle of a box of bricks, outside everywhere else.
class SignField {
 public:
  SignField(unsigned seed, double noise) : edge_(kBricks * kBrickEdge), inside_(size_t(edge_) * edge_ * edge_) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(10, edge_ - 10), radius(0.3, 9), share(0, 1);
    const int least = kBrickEdge + 1, most = edge_ - kBrickEdge - 2;
    for (int ball = 0; ball < 6; ++ball) {
      const double x0 = place(random), y0 = place(random), z0 = place(random), r = radius(random);
      for (int z = least; z <= most; ++z)
        for (int y = least; y <= most; ++y)
          for (int x = least; x <= most; ++x) {
            const double d2 = (x - x0) * (x - x0) + (y - y0) * (y - y0) + (z - z0) * (z - z0);
            if (d2 < r * r && share(random) >= noise) inside_[index(x, y, z)] = true;
          }
    }
  }
  bool at(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < edge_ && y < edge_ && z < edge_ && inside_[index(x, y, z)];
  }
  int edge() const { return edge_; }

  void evaluate(const BrickSet &bricks, uint64_t *signs) const {
    for (size_t b = 0; b < bricks.count; ++b) {
      const glm::ivec3 first = bricks.lattice.first_point(bricks.place(b));
      for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) signs[b * kLeavesPerBrick + size_t(leaf)] = 0;
      for (int z = 0; z < kBrickEdge; ++z)
        for (int y = 0; y < kBrickEdge; ++y)
          for (int x = 0; x < kBrickEdge; ++x)
            if (at(first.x + x, first.y + y, first.z + z))
              signs[b * kLeavesPerBrick + size_t(leaf_of(x, y, z))] |= uint64_t(1) << leaf_bit(x & 3, y & 3, z & 3);
    }
  }

  static constexpr int kBricks = 6;

 private:
  size_t index(int x, int y, int z) const {
    return size_t(x) + size_t(edge_) * (size_t(y) + size_t(edge_) * size_t(z));
  }
  int edge_;
  std::vector<bool> inside_;
};

struct ChosenBricks {
  const std::vector<uint64_t> *chosen;
  size_t size() const { return chosen->size(); }
  template <class Visit>
  void visit(size_t i, const RowRange &, const Visit &visit_brick) const {
    visit_brick((*chosen)[i], uint64_t(1));
  }
  double fewest(size_t) const { return 1; }
  uint64_t most_across() const { return 1; }
};

// box: bricks of the lattice along each axis; a large one makes the set sparse.
void grow_and_check(const SignField &field, const std::vector<glm::ivec3> &begin, int box) {
  CpuKernelExecutor executor(2);
  Lattice lattice{};
  lattice.spacing = 1.f;
  lattice.brick_count = glm::ivec3(box);
  std::vector<uint64_t> chosen;
  for (const glm::ivec3 &b : begin) chosen.push_back(lattice.linear(b));
  BrickSet bricks = collect_bricks(executor, ChosenBricks{&chosen}, lattice, "bricks");
  ASSERT_EQ(bricks.table == nullptr, box > 1000);
  const MarchingCubesTable &table = marching_cubes_table();
  MeshLayout layout{};
  MeshCounts counts{};
  std::vector<uint64_t> signs;
  for (int round = 0;; ++round) {
    ASSERT_LT(round, 3 * SignField::kBricks);
    signs.assign(size_t(bricks.count) * kLeavesPerBrick, 0);
    field.evaluate(bricks, signs.data());
    counts = lay_out_mesh(executor, bricks, signs.data(), table.triangle_count, &layout);
    if (layout.border_changes == 0) break;
    const BrickSet grown = grow_bricks(executor, bricks, layout.border);
    for (uint32_t b = 0; b < bricks.count; ++b) ASSERT_GE(grown.find(bricks.place(b)), 0) << "a brick was lost";
    bricks = grown;
  }

  // Every cell that reaches into an inactive brick has one sign at its corners in active ones.
  for (int z = -1; z < field.edge(); ++z)
    for (int y = -1; y < field.edge(); ++y)
      for (int x = -1; x < field.edge(); ++x) {
        int seen = 0;
        bool reaches_out = false;
        for (int c = 0; c < 8; ++c) {
          const glm::ivec3 p(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
          const bool active = bricks.find(glm::ivec3(p.x >> 3, p.y >> 3, p.z >> 3)) >= 0;
          reaches_out |= !active;
          if (active) seen |= field.at(p.x, p.y, p.z) ? 2 : 1;
        }
        ASSERT_FALSE(reaches_out && seen == 3) << x << " " << y << " " << z;
      }

  mesh_checks::Mesh mesh;
  mesh.positions.assign(3 * counts.vertices, 0.f);
  mesh.indices.assign(3 * counts.triangles, ~uint32_t(0));
  emit_triangles(executor, bricks, layout, BrickRange{0, bricks.count}, {table.triangle_count, table.edges, table.ring},
                 MeshView{mesh.positions.data(), nullptr, nullptr, nullptr, mesh.indices.data()});
  EXPECT_EQ(mesh_checks::manifold_fault(mesh), "");
}

TEST(BrickBorder, AnySetGrowsUntilTheMeshIsClosed) {
  std::mt19937 random(7);
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const SignField field(seed, seed % 3 == 0 ? 0.4 : 0.0);
    std::vector<glm::ivec3> begin;
    for (unsigned k = 0; k < 1 + seed % 5; ++k)
      begin.emplace_back(1 + static_cast<int>(random() % 4), 1 + static_cast<int>(random() % 4),
                         1 + static_cast<int>(random() % 4));
    grow_and_check(field, begin, SignField::kBricks);
    grow_and_check(field, begin, 5000);
  }
}

TEST(BrickBorder, OneBrickOfABallFindsTheWholeBall) {
  const SignField field(3, 0);
  for (int z = 1; z < 5; ++z)
    for (int y = 1; y < 5; ++y)
      for (int x = 1; x < 5; ++x) grow_and_check(field, {glm::ivec3(x, y, z)}, SignField::kBricks);
}

// ---- the whole method with features that are wrong

void check_mesh(const mesh_checks::Mesh &mesh, size_t atoms) {
  EXPECT_EQ(mesh_checks::manifold_fault(mesh), "");
  if (mesh.vertex_count() > 0) {
    EXPECT_LT(mesh_checks::worst_normal_length(mesh), 1e-5);
  }
  for (uint32_t owner : mesh.owners) ASSERT_LT(owner, atoms);
}

TEST(WrongFeatures, LostArcsLeaveTheMeshClosed) {
  const Atoms atoms = cluster(60, 5);
  for (float h : {0.35f, 0.7f, 1.5f})
    for (uint32_t steps : {0u, 1u, 3u}) {
      SCOPED_TRACE(testing::Message() << "spacing " << h << ", steps " << steps);
      qses_settings s = settings(static_cast<double>(h), 1.4);
      s.relaxation_steps = steps;
      ExactRun run(atoms, s);
      FeatureView f = run.features();
      f.arc_bounds.count = 0;
      check_mesh(run.mesh(f), atoms.size());
      EXPECT_GT(run.report.unplaced_vertices, 0u);
    }
}

TEST(WrongFeatures, AtomsTakenForBuriedLeaveTheMeshClosed) {
  const Atoms atoms = cluster(60, 5);
  uint64_t border_bricks = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    ExactRun run(atoms, settings(0.4, 1.4));
    FeatureView f = run.features();
    std::mt19937 random(seed);
    for (uint32_t i = 0; i < f.atoms.count; ++i)
      if (random() % 2) {
        const_cast<CapRange *>(f.cap_ranges)[i] = {0, kBuriedAtom};
        const_cast<uint8_t *>(f.exposed)[i] = 0;
      }
    if (seed % 2) f.arc_bounds.count = 0;
    check_mesh(run.mesh(f), atoms.size());
    border_bricks += run.report.border_bricks;
  }
  EXPECT_GT(border_bricks, 0u);
}

TEST(WrongFeatures, RightOnesNeedNoHelp) {
  for (qses_surface kind : {QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW})
    for (double h : {0.3, 0.5, 1.0, 2.0}) {
      SCOPED_TRACE(testing::Message() << "surface " << kind << ", spacing " << h);
      const Atoms atoms = cluster(200, 9);
      ExactRun run(atoms, settings(h, 1.4, kind));
      check_mesh(run.mesh(), atoms.size());
      EXPECT_EQ(run.report.border_bricks, 0u);
      EXPECT_EQ(run.report.unplaced_vertices, 0u);
    }
}

}  // namespace
