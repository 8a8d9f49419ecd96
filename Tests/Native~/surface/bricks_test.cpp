// SPDX-License-Identifier: MIT
// Active bricks and signs of the exact method against a brute force over every lattice point of the box.
#include "surface/exact_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace {

using namespace exact_fixture;
using surface_fixture::Atoms;
using surface_fixture::cluster;
using surface_fixture::settings;

// The lattice of a run as a dense array with a point to spare on every side: f < 0 inside, in double precision.
class DenseField {
 public:
  DenseField(const ExactRun &run, const Atoms &atoms) {
    const qses_settings &s = run.settings;
    const double probe = s.surface == QSES_SURFACE_VDW ? 0.0 : static_cast<double>(s.probe_radius);
    const double depth = s.surface == QSES_SURFACE_SES ? probe : 0.0;
    const exact_reference::Boundary boundary(atoms, probe);
    const double h = static_cast<double>(s.spacing), reach = static_cast<double>(run.parameters.max_radius);
    for (int d = 0; d < 3; ++d) {
      low_[d] = static_cast<int>(std::floor((static_cast<double>(run.low[d]) - reach) / h)) - 2;
      size_[d] = static_cast<int>(std::ceil((static_cast<double>(run.high[d]) + reach) / h)) + 2 - low_[d] + 1;
    }
    f_.resize(size_t(size_[0]) * size_t(size_[1]) * size_t(size_[2]));
    for (int z = 0; z < size_[2]; ++z)
      for (int y = 0; y < size_[1]; ++y)
        for (int x = 0; x < size_[0]; ++x) {
          const Point p = run.to_caller(h * (x + low_[0]), h * (y + low_[1]), h * (z + low_[2]));
          f_[index(x, y, z)] = depth > 0 ? depth - boundary.nearest(p).distance : -boundary.depth(p);
        }
  }

  size_t index(int x, int y, int z) const {
    return size_t(x) + size_t(size_[0]) * (size_t(y) + size_t(size_[1]) * size_t(z));
  }
  double at(int x, int y, int z) const { return f_[index(x, y, z)]; }  // from 0
  int low(int d) const { return low_[d]; }
  int size(int d) const { return size_[d]; }

 private:
  int low_[3], size_[3];
  std::vector<double> f_;
};

// Number of the active brick of a lattice point, and its bit there.
struct PlaceInBrick {
  int brick, leaf, bit;
};
PlaceInBrick place_of(const BrickSet &bricks, int x, int y, int z) {
  const glm::ivec3 place = glm::ivec3(x >> 3, y >> 3, z >> 3) - bricks.lattice.first_brick;
  return {bricks.find(place), leaf_of(x & 7, y & 7, z & 7), leaf_bit(x & 3, y & 3, z & 3)};
}

void check_lattice(const Atoms &atoms, const qses_settings &s, bool dense_table = true) {
  for (const CpuKernels *kernels : usable_cpu_kernels()) {
    SCOPED_TRACE(testing::Message() << kernels->name << ", " << atoms.size() << " atoms, spacing " << s.spacing
                                    << ", probe " << s.probe_radius << ", surface " << s.surface);
    ExactRun run(atoms, s, 2, *kernels);
    const FeatureView features = run.features();
    const BrickSet bricks = find_bricks(run.executor, features, run.lattice);
    ASSERT_EQ(bricks.table != nullptr, dense_table);
    for (uint32_t b = 0; b < bricks.count; ++b) {
      ASSERT_EQ(bricks.find(bricks.place(b)), static_cast<int>(b));
      ASSERT_TRUE(b == 0 || bricks.places[b - 1] < bricks.places[b]);
      ASSERT_TRUE(b == 0 || run.lattice.linear(bricks.place(b - 1)) < run.lattice.linear(bricks.place(b)));
    }
    // Several at once, also where there is none: just outside of the box of bricks.
    for (const glm::ivec3 &corner : {glm::ivec3(0), run.lattice.brick_count - glm::ivec3(1), bricks.place(0)}) {
      const auto around = [&](int k) { return corner + neighbor_step(k); };
      int found[kNeighborhood];
      bricks.find_each<kNeighborhood>(around, found);
      for (int k = 0; k < kNeighborhood; ++k) ASSERT_EQ(found[k], bricks.find(around(k))) << "neighbour " << k;
    }
    const std::vector<uint64_t> signs = run.signs(features, bricks);
    const DenseField field(run, atoms);
    constexpr double kUnsure = 1e-4;
    size_t wrong = 0, inside = 0, active = 0, unsure = 0, mixed = 0, open = 0;
    for (int z = 0; z < field.size(2); ++z)
      for (int y = 0; y < field.size(1); ++y)
        for (int x = 0; x < field.size(0); ++x) {
          const double f = field.at(x, y, z);
          const PlaceInBrick p = place_of(bricks, x + field.low(0), y + field.low(1), z + field.low(2));
          if (p.brick >= 0) {
            ++active;
            const bool found = signs[size_t(p.brick) * kLeavesPerBrick + size_t(p.leaf)] >> p.bit & 1;
            if (std::abs(f) < kUnsure)
              ++unsure;
            else if (found != (f < 0) && ++wrong < 4)
              ADD_FAILURE() << "point " << x << " " << y << " " << z << " f " << f << (found ? " inside" : " outside");
            inside += found ? 1 : 0;
          }
          // A cell with both signs has all its corners in active bricks.
          if (x + 1 >= field.size(0) || y + 1 >= field.size(1) || z + 1 >= field.size(2)) continue;
          bool any = false, all = true, sure = true;
          int active_corners = 0;
          for (int c = 0; c < 8; ++c) {
            const int cx = x + (c & 1), cy = y + (c >> 1 & 1), cz = z + (c >> 2);
            const double g = field.at(cx, cy, cz);
            sure = sure && std::abs(g) >= kUnsure;
            any = any || g < 0;
            all = all && g < 0;
            const PlaceInBrick q = place_of(bricks, cx + field.low(0), cy + field.low(1), cz + field.low(2));
            active_corners += q.brick >= 0 ? 1 : 0;
          }
          if (!sure || !any || all) continue;
          ++mixed;
          open += active_corners < 8 ? 1 : 0;
        }
    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(open, 0u);
    EXPECT_GT(mixed, 20u);
    EXPECT_GT(inside, 0u);
    EXPECT_LT(inside, active);
    EXPECT_LT(unsure, 1 + active / 100);
  }
}

const qses_surface kSurfaces[] = {QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW};

TEST(Signs, OfFewAtoms) {
  Atoms atoms;
  atoms.add(0.31, -0.17, 0.23, 1.7);
  for (int n = 1; n <= 4; ++n) {
    for (qses_surface kind : kSurfaces)
      for (double h : {0.3, 0.5, 1.0}) check_lattice(atoms, settings(h, 1.4, kind));
    atoms.add(1.4 * n, 0.9 * (n % 2), 0.7 * (n % 3), 1.2 + 0.2 * n);
  }
}

TEST(Signs, OfAClusterAtManySpacings) {
  const Atoms atoms = cluster(60, 31);
  for (double h : {0.35, 0.5, 0.77, 1.0, 2.0}) check_lattice(atoms, settings(h));
  for (qses_surface kind : kSurfaces) check_lattice(atoms, settings(0.6, 1.4, kind));
}

TEST(Signs, WithManyProbes) {
  const Atoms atoms = cluster(50, 32);
  for (double p : {0.1, 0.5, 0.9, 2.2, 5.0}) check_lattice(atoms, settings(0.5, p));
}

TEST(Signs, OfLooseAtoms) {
  // Circles narrower than the probe, lone atoms, probes that just pass.
  Atoms atoms;
  std::mt19937 random(33);
  std::uniform_real_distribution<double> along(-7, 7);
  for (int k = 0; k < 30; ++k) atoms.add(along(random), along(random), along(random), 1.0 + 0.1 * (k % 9));
  for (double h : {0.4, 0.8}) check_lattice(atoms, settings(h));
}

TEST(Signs, FarFromTheOrigin) {
  check_lattice(surface_fixture::shifted(cluster(40, 34), 812.3, -955.1, 700.7), settings(0.5));
}

TEST(Signs, OnASparseSetOfBricks) {
  // So far apart that the table of bricks would be larger than is worth it; the box of the reference is thin.
  Atoms atoms;
  atoms.add(0, 0, 0, 1.7).add(1.5, 0, 0, 1.2).add(30, 30, 30000, 1.7);
  ExactRun run(atoms, settings(0.1));
  const FeatureView features = run.features();
  const BrickSet bricks = find_bricks(run.executor, features, run.lattice);
  ASSERT_EQ(bricks.table, nullptr);
  const std::vector<uint64_t> signs = run.signs(features, bricks);
  const exact_reference::Boundary boundary(atoms, static_cast<double>(1.4f));
  size_t inside = 0, outside = 0;
  for (uint32_t b = 0; b < bricks.count; ++b) {
    const glm::ivec3 first = run.lattice.first_point(bricks.place(b));
    for (int k = 0; k < kBrickPoints; k += 5) {
      const int x = k & 7, y = k >> 3 & 7, z = k >> 6;
      const double h = static_cast<double>(0.1f);
      const Point p = run.to_caller(h * (first.x + x), h * (first.y + y), h * (first.z + z));
      const double f = static_cast<double>(1.4f) - boundary.nearest(p).distance;
      const uint64_t word = signs[size_t(b) * kLeavesPerBrick + size_t(leaf_of(x, y, z))];
      const bool found = word >> leaf_bit(x & 3, y & 3, z & 3) & 1;
      // Single precision at 15,000 Å.
      ASSERT_TRUE(std::abs(f) < 4e-3 || found == (f < 0)) << f << " at " << p.x << " " << p.y << " " << p.z;
      ++(found ? inside : outside);
    }
  }
  EXPECT_GT(inside, 100u);
  EXPECT_GT(outside, 100u);
  for (uint32_t b = 0; b < bricks.count; ++b) ASSERT_EQ(bricks.find(bricks.place(b)), static_cast<int>(b));
  EXPECT_EQ(bricks.find(glm::ivec3(-1, 0, 0)), -1);
  EXPECT_EQ(bricks.find(run.lattice.brick_count), -1);
}

// A table too large to be made unasked, but smaller than the list of all visits, which are counted first: what that
// takes is free again.
TEST(Bricks, CountedVisitsLeaveNoMemoryBehind) {
  Atoms atoms;
  std::mt19937 random(35);
  std::uniform_real_distribution<double> along(0, 140);
  for (int k = 0; k < 2000; ++k) atoms.add(along(random), along(random), along(random), 10);
  ExactRun run(atoms, settings(0.1, 1.4, QSES_SURFACE_VDW));
  const FeatureView features = run.features();
  ASSERT_GT(run.lattice.table_size(), kSmallTable);
  const auto mark = run.executor.arena().mark();
  const uint64_t before = run.executor.arena().used();
  ASSERT_NE(find_bricks(run.executor, features, run.lattice).table, nullptr);
  const uint64_t taken = run.executor.arena().used() - before;
  run.executor.arena().rewind(mark);
  flag_bricks(run.executor, FeatureBricks{features, run.lattice}, run.lattice, "bricks");
  EXPECT_EQ(taken, run.executor.arena().used() - before);
}

// Rows of bricks that a shell passes, whether they are short or long, hollow or not, and cut by the border of the
// table.
TEST(Places, ArePackedInTheOrderOfLinearIndices) {
  constexpr int kMost = (1 << kPlaceBits) - 1;
  const glm::ivec3 rising[] = {{0, 0, 0},     {1, 0, 0}, {kMost, 0, 0}, {0, 1, 0},     {kMost, 1, 0},
                               {0, kMost, 0}, {0, 0, 1}, {5, 7, 9},     {0, 0, kMost}, {kMost, kMost, kMost}};
  for (const glm::ivec3 &place : rising) EXPECT_EQ(unpack_place(pack_place(place)), place);
  for (size_t k = 1; k < std::size(rising); ++k) EXPECT_LT(pack_place(rising[k - 1]), pack_place(rising[k]));
}

TEST(BricksOfAShell, AreTheOnesWhoseBoxesMeetIt) {
  Lattice lattice{};
  lattice.spacing = 0.25f;
  lattice.first_brick = glm::ivec3(-30, -25, -35);
  lattice.brick_count = glm::ivec3(70, 45, 60);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-45, 45), size(0, 40);
  size_t visited_in_all = 0, hollow = 0;
  for (int k = 0; k < 60; ++k) {
    const glm::vec3 center(place(random), place(random), place(random));
    const float outer = size(random), inner = k % 3 == 0 ? 0.f : k % 3 == 1 ? outer : outer * 0.7f;
    const int margin = 1 + k / 3 % 2;  // in spacings
    const float grown = static_cast<float>(margin);
    std::vector<int> visits(lattice.table_size(), 0);
    visit_bricks_of_shell(lattice, center, inner, outer, grown, RowRange{}, [&](uint64_t first, uint64_t count) {
      for (uint64_t b = first; b < first + count; ++b) ++visits.at(b);
    });
    std::vector<int> in_parts(lattice.table_size(), 0);
    const uint64_t rows = most_bricks_across(lattice, outer) * most_bricks_across(lattice, outer);
    const uint64_t most = 1 + static_cast<uint64_t>(k) * 7;  // rows in a part
    for (uint64_t row = 0; row < rows; row += most)
      visit_bricks_of_shell(lattice, center, inner, outer, grown, RowRange{row, row + most},
                            [&](uint64_t first, uint64_t count) {
                              for (uint64_t b = first; b < first + count; ++b) ++in_parts.at(b);
                            });
    ASSERT_EQ(in_parts, visits);
    for (uint64_t b = 0; b < lattice.table_size(); ++b) {
      const glm::ivec3 first = lattice.first_point(lattice.brick_at(b));
      const double h = 0.25;
      double near2 = 0, far2 = 0;
      for (int d = 0; d < 3; ++d) {
        const double low = (first[d] - margin) * h - center[d], high = low + (7 + 2 * margin) * h;
        near2 += std::pow(std::max({0.0, low, -high}), 2);
        far2 += std::pow(std::max(std::abs(low), std::abs(high)), 2);
      }
      ASSERT_LE(visits[b], 1);
      // The boxes are a little larger, so as not to miss one by rounding.
      constexpr double kSlack = 0.02;
      const double near = std::sqrt(near2), far = std::sqrt(far2);
      const bool meets = near <= outer && far >= inner;
      const bool is_clear = near > outer + kSlack || far < inner - kSlack;
      ASSERT_TRUE(meets ? visits[b] == 1 : !is_clear || visits[b] == 0) << b;
      visited_in_all += static_cast<size_t>(visits[b]);
      hollow += far < inner - kSlack ? 1 : 0;
    }
  }
  EXPECT_GT(visited_in_all, 10000u);
  EXPECT_GT(hollow, 10000u);
}

}  // namespace
