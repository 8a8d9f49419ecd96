// SPDX-License-Identifier: MIT
// The voxel method against definitions written out once more, point by point.
#include "parallel/cpu_executor.h"
#include "surface/grid_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace {

using namespace grid_fixture;
using GridRun = GridRunOn<CpuExecutor>;

// The lattice around some atoms, classified point by point in double precision, as a dense array.
class Reference {
 public:
  // reach: lattice points to either side of the cube.
  Reference(const GridRun &run, size_t atom_count, int reach)
      : run_(run), atom_count_(atom_count), reach_(reach), h_(run.lattice.spacing) {
    for (int d = 0; d < 3; ++d) {
      low_[d] = 1 << 28;
      high_[d] = -(1 << 28);
      for (size_t i = 0; i < atom_count; ++i) {
        const Sphere &s = run.spheres[i];
        low_[d] = std::min(low_[d], static_cast<int>(std::floor((s.center[d] - s.radius) / h_)) - 20);
        high_[d] = std::max(high_[d], static_cast<int>(std::ceil((s.center[d] + s.radius) / h_)) + 20);
      }
      size_[d] = high_[d] - low_[d] + 1;
    }
    outside_.assign(static_cast<size_t>(size_[0]) * size_[1] * size_[2], 1);
    for (int z = low_[2]; z <= high_[2]; ++z)
      for (int y = low_[1]; y <= high_[1]; ++y)
        for (int x = low_[0]; x <= high_[0]; ++x) outside_[at(x, y, z)] = depth(x, y, z) <= 0;
  }

  // How deep a lattice point is in the deepest ball.
  double depth(int x, int y, int z) const {
    double deepest = -1e9;
    for (size_t i = 0; i < atom_count_; ++i) {
      const Sphere &s = run_.spheres[i];
      const double dx = x * h_ - s.center.x, dy = y * h_ - s.center.y, dz = z * h_ - s.center.z;
      deepest = std::max(deepest, s.radius - std::sqrt(dx * dx + dy * dy + dz * dz));
    }
    return deepest;
  }

  bool contains(int x, int y, int z) const {
    const int p[3] = {x, y, z};
    for (int d = 0; d < 3; ++d)
      if (p[d] < low_[d] || p[d] > high_[d]) return false;
    return true;
  }
  bool outside(int x, int y, int z) const { return !contains(x, y, z) || outside_[at(x, y, z)]; }

  // -1: none in reach.
  int64_t distance2(int x, int y, int z) const {
    int64_t best = -1;
    for (int dz = -reach_; dz <= reach_; ++dz)
      for (int dy = -reach_; dy <= reach_; ++dy)
        for (int dx = -reach_; dx <= reach_; ++dx) {
          const int64_t d2 = int64_t(dx) * dx + int64_t(dy) * dy + int64_t(dz) * dz;
          if ((best < 0 || d2 < best) && outside(x + dx, y + dy, z + dz)) best = d2;
        }
    return best;
  }

  int low(int d) const { return low_[d]; }
  int high(int d) const { return high_[d]; }

 private:
  size_t at(int x, int y, int z) const {
    return static_cast<size_t>(x - low_[0]) +
           static_cast<size_t>(size_[0]) *
               (static_cast<size_t>(y - low_[1]) + static_cast<size_t>(size_[1]) * static_cast<size_t>(z - low_[2]));
  }
  const GridRun &run_;
  size_t atom_count_;
  int reach_;
  double h_;
  int low_[3], high_[3], size_[3];
  std::vector<uint8_t> outside_;
};

const std::vector<Atom> kOne = {{0.31, -0.17, 0.23, 1.7}};
const std::vector<Atom> kTwo = {{-1.32, 0.11, 0.27, 1.7}, {1.71, 0.43, -0.36, 1.52}};
const std::vector<Atom> kThree = {{0.05, 0.1, 0.2, 1.7}, {3.03, 0.4, -0.3, 1.55}, {1.4, 2.7, 0.9, 1.8}};
// Backbone and side-chain atoms of the first residues of crambin (1CRN).
const std::vector<Atom> kCrambin = {
    {17.047, 14.099, 3.625, 1.55}, {16.967, 12.784, 4.338, 1.7},  {15.685, 12.755, 5.133, 1.7},
    {15.268, 13.825, 5.594, 1.52}, {18.170, 12.703, 5.337, 1.7},  {19.334, 12.829, 4.463, 1.52},
    {18.150, 11.546, 6.304, 1.7},  {15.115, 11.555, 5.265, 1.55}, {13.856, 11.469, 6.066, 1.7},
    {14.164, 10.785, 7.379, 1.7},  {14.993, 9.862, 7.443, 1.52},  {12.732, 10.711, 5.261, 1.7},
    {13.308, 9.439, 4.926, 1.52},  {12.484, 11.442, 3.895, 1.7},  {13.488, 11.241, 8.417, 1.55},
    {13.660, 10.707, 9.787, 1.7},  {12.269, 10.431, 10.323, 1.7}, {11.393, 11.308, 10.185, 1.52},
    {14.368, 11.748, 10.691, 1.7}, {15.885, 12.426, 10.016, 1.8}, {12.019, 9.272, 10.928, 1.55},
    {10.646, 8.991, 11.408, 1.7},  {10.654, 8.793, 12.919, 1.7},  {11.659, 8.296, 13.491, 1.52},
    {10.057, 7.752, 10.682, 1.7},  {9.837, 8.018, 8.904, 1.8},    {9.561, 9.108, 13.563, 1.55},
    {9.448, 9.034, 15.012, 1.7},   {9.288, 7.670, 15.606, 1.7},   {9.490, 7.519, 16.819, 1.52}};

struct Case {
  const std::vector<Atom> *atoms;
  double probe, spacing;
  int reach;   // ceil(probe / spacing), by hand
  int stride;  // every how many lattice points are looked at
};

// All lattice points of all active bricks (every stride-th), and all corners of their cells.
void check_distances(const Case &c) {
  SCOPED_TRACE(testing::Message() << c.atoms->size() << " atoms, probe " << c.probe << ", spacing " << c.spacing);
  GridRun run(*c.atoms, static_cast<float>(c.probe), static_cast<float>(c.spacing));
  ASSERT_EQ(run.parameters.reach, c.reach);
  const Reference reference(run, run.spheres.size(), c.reach);
  const BrickSet &bricks = run.field.bricks;
  ASSERT_GT(bricks.count, 0u);
  constexpr int kEdge = kBrickEdge + 1, kPoints = kEdge * kEdge * kEdge;
  std::vector<int32_t> own(size_t(bricks.count) * kBrickPoints, -7), corners(size_t(bricks.count) * kPoints, -7);
  run.executor.for_each_brick<DistanceScratch<kBrickEdge>>(bricks.count,
                                                           StoreDistances<kBrickEdge>{run.field, 0, own.data()});
  run.executor.for_each_brick<DistanceScratch<kEdge>>(bricks.count,
                                                      StoreDistances<kEdge>{run.field, 0, corners.data()});
  std::vector<int32_t> by_rows = corners;
  if (has_near_rows(run.field))
    run.executor.for_each_brick<NearRows>(bricks.count, StoreRowDistances{run.field, by_rows.data()});

  size_t looked_at = 0, refined = 0, wrong = 0;
  std::map<std::array<int, 3>, bool> active;
  for (uint32_t b = 0; b < bricks.count; ++b) {
    const glm::ivec3 place = bricks.place(b), first = bricks.lattice.first_point(place);
    active[{first.x, first.y, first.z}] = true;
    for (int i = static_cast<int>(b) % c.stride; i < kPoints; i += c.stride) {
      const int x = i % kEdge, y = i / kEdge % kEdge, z = i / kEdge / kEdge;
      const int64_t expected = reference.distance2(first.x + x, first.y + y, first.z + z);
      const int32_t found = corners[size_t(b) * kPoints + static_cast<size_t>(i)];
      ++looked_at;
      refined += expected > 0 ? 1 : 0;
      const auto is_expected = [&](int32_t d2) { return expected < 0 ? d2 >= kNoneInReach : d2 == expected; };
      bool good = is_expected(found) && is_expected(by_rows[size_t(b) * kPoints + static_cast<size_t>(i)]);
      const bool inside =
          expected < 0 || static_cast<double>(expected) * c.spacing * c.spacing > c.probe * c.probe * (1 + 1e-9);
      if (x < kBrickEdge && y < kBrickEdge && z < kBrickEdge) {
        good = good && own[size_t(b) * kBrickPoints + static_cast<size_t>(x + 8 * (y + 8 * z))] == found;
        const uint64_t word = run.signs[size_t(b) * kLeavesPerBrick + static_cast<size_t>(leaf_of(x, y, z))];
        good = good && (word >> leaf_bit(x & 3, y & 3, z & 3) & 1) == (inside ? 1u : 0u);
      }
      if (!good && ++wrong < 5)
        ADD_FAILURE() << "point " << first.x + x << " " << first.y + y << " " << first.z + z << ": " << found
                      << " instead of " << expected;
    }
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(looked_at, 100u);
  EXPECT_TRUE(c.reach == 0 || refined > 10);

  // No point that some ball holds is outside the active bricks.
  for (int z = reference.low(2); z <= reference.high(2); ++z)
    for (int y = reference.low(1); y <= reference.high(1); ++y)
      for (int x = reference.low(0); x <= reference.high(0); ++x)
        ASSERT_TRUE(reference.outside(x, y, z) || active.count({x & ~7, y & ~7, z & ~7})) << x << " " << y << " " << z;
}

TEST(GridDistances, OfOneAtom) {
  check_distances({&kOne, 1.4, 0.7, 2, 1});
  check_distances({&kOne, 1.4, 0.35, 4, 1});
  check_distances({&kOne, 1.4, 0.5, 3, 1});
  check_distances({&kOne, 1.4, 1.0, 2, 1});
  check_distances({&kOne, 1.4, 0.2, 7, 5});
}
TEST(GridDistances, OfTwoAtoms) {
  check_distances({&kTwo, 1.4, 0.7, 2, 1});
  check_distances({&kTwo, 1.4, 0.35, 4, 3});
  check_distances({&kTwo, 1.4, 0.5, 3, 1});
  check_distances({&kTwo, 1.4, 1.0, 2, 1});
  check_distances({&kTwo, 1.4, 0.2, 7, 7});
}
TEST(GridDistances, OfThreeAtoms) {
  check_distances({&kThree, 1.4, 0.7, 2, 1});
  check_distances({&kThree, 1.4, 0.35, 4, 3});
  check_distances({&kThree, 1.4, 0.5, 3, 1});
  check_distances({&kThree, 1.4, 1.0, 2, 1});
  check_distances({&kThree, 1.4, 0.2, 7, 11});
}
TEST(GridDistances, OfThirtyAtoms) {
  check_distances({&kCrambin, 1.4, 0.7, 2, 1});
  check_distances({&kCrambin, 1.4, 0.35, 4, 5});
  check_distances({&kCrambin, 1.4, 0.5, 3, 1});
  check_distances({&kCrambin, 1.4, 1.0, 2, 1});
  check_distances({&kCrambin, 1.4, 0.2, 7, 97});
}
TEST(GridDistances, WithOtherProbes) {
  check_distances({&kTwo, 0.0, 0.5, 0, 1});
  check_distances({&kTwo, 0.3, 0.5, 1, 1});
  check_distances({&kTwo, 1.4, 3.0, 1, 1});
  check_distances({&kThree, 3.0, 0.5, 6, 7});    // 3 / 0.5 is a whole number as well
  check_distances({&kThree, 4.1, 0.5, 9, 23});   // more than one brick to either side
  check_distances({&kThree, 5.5, 0.5, 11, 23});  // the widest cube whose rows are words, and the next one
  check_distances({&kThree, 6.0, 0.5, 12, 23});
  check_distances({&kOne, 1.4, 0.1, 14, 1009});
  check_distances({&kTwo, 10.0, 0.5, 20, 4001});  // several tiles of rows and planes
  check_distances({&kOne, 14.0, 0.5, 28, 30011});
}

// A stray atom makes the table of bricks sparse; the distances of the others stay what they were.
TEST(GridDistances, WithAStrayAtom) {
  std::vector<Atom> atoms = kThree;
  atoms.push_back({20000.0, -20000.0, 15000.0, 1.7});
  GridRun run(atoms, 1.4f, 0.5f);
  const BrickSet &bricks = run.field.bricks;
  ASSERT_EQ(bricks.table, nullptr);
  const Reference reference(run, 3, 3);
  std::vector<int32_t> own(size_t(bricks.count) * kBrickPoints);
  run.executor.for_each_brick<DistanceScratch<kBrickEdge>>(bricks.count,
                                                           StoreDistances<kBrickEdge>{run.field, 0, own.data()});
  size_t near_by = 0, far_away = 0;
  for (uint32_t b = 0; b < bricks.count; ++b) {
    const glm::ivec3 first = bricks.lattice.first_point(bricks.place(b));
    if (!reference.contains(first.x, first.y, first.z)) {
      ++far_away;
      continue;
    }
    for (int i = 0; i < kBrickPoints; ++i) {
      const int64_t expected = reference.distance2(first.x + i % 8, first.y + i / 8 % 8, first.z + i / 64);
      const int32_t found = own[size_t(b) * kBrickPoints + static_cast<size_t>(i)];
      near_by += expected > 0 ? 1 : 0;
      ASSERT_EQ(found >= kNoneInReach ? -1 : found, expected);
    }
  }
  EXPECT_GT(near_by, 100u);
  EXPECT_GT(far_away, 7u);
  mesh_checks::Mesh mesh = run.mesh();
  EXPECT_EQ(mesh_checks::manifold_fault(mesh), "");
  EXPECT_EQ(mesh_checks::piece_count(mesh), 2u);
}

TEST(GridClasses, FollowTheirDefinition) {
  for (const std::vector<Atom> *atoms : {&kOne, &kTwo, &kThree, &kCrambin}) {
    GridRun run(*atoms, 1.4f, 0.5f);
    const Reference reference(run, atoms->size(), 0);
    const BrickSet &bricks = run.field.bricks;
    std::vector<uint64_t> outside(size_t(bricks.count) * kLeavesPerBrick);
    run.executor.for_each_brick<ClassifyScratch>(
        bricks.count, ClassifyBrick{{run.field.atoms, run.parameters.max_radius, 0.f}, bricks, outside.data()});
    size_t number[2] = {};
    for (uint32_t b = 0; b < bricks.count; ++b) {
      const glm::ivec3 first = bricks.lattice.first_point(bricks.place(b));
      for (int i = 0; i < kBrickPoints; ++i) {
        const int x = i % 8, y = i / 8 % 8, z = i / 64;
        const bool expected = reference.outside(first.x + x, first.y + y, first.z + z);
        ++number[expected ? 1 : 0];
        const size_t word = size_t(b) * kLeavesPerBrick + static_cast<size_t>(leaf_of(x, y, z));
        const int bit = leaf_bit(x & 3, y & 3, z & 3);
        ASSERT_EQ(outside[word] >> bit & 1, expected ? 1u : 0u);
      }
    }
    for (size_t n : number) EXPECT_GT(n, 10u);
    EXPECT_EQ(std::vector<uint64_t>(run.field.outside, run.field.outside + outside.size()), outside);
  }
}

// A list of more atoms than the scratch of a brick holds.
TEST(GridClasses, OfMoreAtomsInABrickThanAListHolds) {
  std::vector<Atom> atoms;
  for (int k = 0; k < 1000; ++k)
    atoms.push_back({0.01 * (k % 10), 0.01 * (k / 10 % 10), 0.01 * (k / 100), 1.2 + 0.0003 * k});
  GridRun run(atoms, 1.4f, 0.5f);
  const Reference reference(run, atoms.size(), 0);
  size_t outside = 0, points = 0;
  for (uint32_t b = 0; b < run.field.bricks.count; ++b) {
    const glm::ivec3 first = run.lattice.first_point(run.field.bricks.place(b));
    for (int i = 0; i < kBrickPoints; ++i, ++points) {
      const int x = i % 8, y = i / 8 % 8, z = i / 64;
      const uint64_t word = run.field.outside[size_t(b) * kLeavesPerBrick + static_cast<size_t>(leaf_of(x, y, z))];
      const bool out = reference.outside(first.x + x, first.y + y, first.z + z);
      outside += out ? 1 : 0;
      ASSERT_EQ(word >> leaf_bit(x & 3, y & 3, z & 3) & 1, out ? 1u : 0u);
    }
  }
  EXPECT_GT(outside, 100u);
  EXPECT_LT(outside, points - 100);
}

TEST(GridValue, ZeroIsOutside) {
  const struct {
    double probe, spacing;
    int32_t zero;  // (probe / spacing)²
  } cases[] = {{1.4, 0.7, 4},   {1.4, 0.35, 16}, {1.4, 0.2, 49}, {1.4, 0.14, 100},
               {1.4, 0.1, 196}, {1.5, 0.5, 9},   {1.4, 1.4, 1}};
  for (const auto &c : cases) {
    const GridParameters g = make_grid_parameters(static_cast<float>(c.probe), static_cast<float>(c.spacing), 3.1f);
    EXPECT_FALSE(grid_is_inside(g, c.zero)) << c.spacing;
    EXPECT_TRUE(grid_is_inside(g, c.zero + 1)) << c.spacing;
    EXPECT_GE(grid_value(g, c.zero), 0.f) << c.spacing;
    EXPECT_NEAR(grid_value(g, c.zero), 0.f, 1e-6f) << c.spacing;
    EXPECT_LT(grid_value(g, c.zero + 1), 0.f) << c.spacing;
    EXPECT_EQ(static_cast<int64_t>(g.reach) * g.reach, c.zero);
    EXPECT_EQ(grid_value(g, 0), static_cast<float>(c.probe));
    EXPECT_EQ(grid_value(g, kNoneInReach), -static_cast<float>(c.spacing));
  }
}

TEST(GridValue, TooFineASpacingIsRefused) {
  EXPECT_THROW(make_grid_parameters(100.f, 0.001f, 101.7f), Error);
  CpuExecutor executor(1);
  try {
    GridRun run(kOne, 80.f, 0.005f);
    FAIL() << "16,000 spacings of probe radius should be refused";
  } catch (const Error &e) {
    EXPECT_EQ(e.status(), QSES_TOO_FINE);
  }
}

// Each edge of the reference's lattice that changes sign has one vertex, where the field interpolated along it is zero.
void check_vertices(const std::vector<Atom> &atoms, double spacing, int reach) {
  GridRun run(atoms, 1.4f, static_cast<float>(spacing));
  const Reference reference(run, atoms.size(), reach);
  std::map<std::array<int, 3>, double> values;
  const auto value = [&](int x, int y, int z) {
    const auto known = values.find({x, y, z});
    if (known != values.end()) return known->second;
    const int64_t d2 = reference.distance2(x, y, z);
    // A zero must come out as one: 1.4 and the spacing are decimals.
    double f = d2 < 0 ? -spacing : 1.4 - spacing * std::sqrt(static_cast<double>(d2));
    if (std::abs(f) < 1e-9) f = 0;
    return values[{x, y, z}] = f;
  };
  std::vector<std::array<double, 3>> expected;
  for (int z = reference.low(2); z < reference.high(2); ++z)
    for (int y = reference.low(1); y < reference.high(1); ++y)
      for (int x = reference.low(0); x < reference.high(0); ++x)
        for (int axis = 0; axis < 3; ++axis) {
          const double f = value(x, y, z), g = value(x + (axis == 0), y + (axis == 1), z + (axis == 2));
          if ((f < 0) == (g < 0)) continue;
          std::array<double, 3> p = {spacing * x + run.lattice.center_x, spacing * y + run.lattice.center_y,
                                     spacing * z + run.lattice.center_z};
          p[static_cast<size_t>(axis)] += spacing * f / (f - g);
          expected.push_back(p);
        }
  const mesh_checks::Mesh mesh = run.mesh();
  ASSERT_GT(expected.size(), 50u);
  ASSERT_EQ(mesh.vertex_count(), expected.size());
  std::vector<std::array<double, 3>> found;
  for (size_t v = 0; v < mesh.vertex_count(); ++v) found.push_back(mesh.position(v));
  // Ordered on a coarser scale than the rounding.
  const auto key = [](const std::array<double, 3> &p) {
    return std::array<long, 3>{std::lround((p[0] + 1e-3 / 3) * 500), std::lround((p[1] + 1e-3 / 3) * 500),
                               std::lround((p[2] + 1e-3 / 3) * 500)};
  };
  const auto before = [&](const std::array<double, 3> &a, const std::array<double, 3> &b) { return key(a) < key(b); };
  std::sort(found.begin(), found.end(), before);
  std::sort(expected.begin(), expected.end(), before);
  for (size_t v = 0; v < found.size(); ++v)
    for (size_t d = 0; d < 3; ++d) ASSERT_NEAR(found[v][d], expected[v][d], 2.5e-3) << v;
  for (size_t v = 0; v < mesh.vertex_count(); ++v) {
    const auto p = mesh.position(v);
    double nearest = 1e9;
    for (const Atom &a : atoms) nearest = std::min(nearest, std::hypot(p[0] - a.x, p[1] - a.y, p[2] - a.z) - a.r);
    ASSERT_LT(mesh.owners[v], atoms.size());
    const Atom &owner = atoms[mesh.owners[v]];
    ASSERT_NEAR(std::hypot(p[0] - owner.x, p[1] - owner.y, p[2] - owner.z) - owner.r, nearest, 1e-5);
  }
}

TEST(GridVertices, InterpolateTheField) {
  check_vertices(kOne, 0.7, 2);
  check_vertices(kOne, 0.35, 4);
  check_vertices(kTwo, 0.5, 3);
  check_vertices(kThree, 0.5, 3);
  check_vertices(kThree, 1.0, 2);
}

TEST(GridMesh, IsClosedAndOriented) {
  const std::vector<Atom> crambin = read_pdb_atoms(std::string(QUICKSES_TEST_DATA_DIR) + "/1CRN.pdb");
  ASSERT_EQ(crambin.size(), 327u);
  const std::vector<Atom> cluster = random_cluster(200, 11);
  for (const std::vector<Atom> *atoms : {&kOne, &kTwo, &kThree, &kCrambin, &cluster, &crambin})
    for (float spacing : {0.7f, 0.35f, 0.5f, 1.0f, 1.4f}) {
      SCOPED_TRACE(testing::Message() << atoms->size() << " atoms, spacing " << spacing);
      GridRun run(*atoms, 1.4f, spacing, 0, 1);
      mesh_checks::Mesh mesh = run.mesh();
      ASSERT_GT(mesh.triangle_count(), 7u);
      EXPECT_EQ(mesh_checks::manifold_fault(mesh), "");
      EXPECT_GT(mesh_checks::signed_volume(mesh), 0.0);
      EXPECT_LT(mesh_checks::worst_normal_length(mesh), 1e-5);
      smooth_laplacian(run.executor, run.view(mesh), run.counts, spacing, 1, ring_sums(run.executor, run.counts));
      compute_normals(run.executor, run.view(mesh), run.counts, spacing, ring_sums(run.executor, run.counts));
      EXPECT_EQ(mesh_checks::manifold_fault(mesh), "");
      EXPECT_LT(mesh_checks::worst_normal_length(mesh), 1e-5);
    }
}

// At these spacings many lattice points lie exactly on the surface.
TEST(GridMesh, HasExactZeros) {
  for (float spacing : {0.7f, 0.35f}) {
    GridRun run(kCrambin, 1.4f, spacing);
    const mesh_checks::Mesh mesh = run.mesh();
    std::vector<std::array<double, 3>> points;
    for (size_t v = 0; v < mesh.vertex_count(); ++v) points.push_back(mesh.position(v));
    std::sort(points.begin(), points.end());
    EXPECT_LT(std::unique(points.begin(), points.end()) - points.begin(),
              static_cast<std::ptrdiff_t>(mesh.vertex_count()));
    EXPECT_EQ(mesh_checks::manifold_fault(mesh), "");
  }
}

// The volume of an atom's surface comes near that of the atom as the spacing shrinks.
TEST(GridMesh, EnclosesTheAtom) {
  GridRun run(kOne, 1.4f, 0.14f);
  const double ball = 4.0 / 3.0 * std::acos(-1.0) * 1.7 * 1.7 * 1.7;
  EXPECT_NEAR(mesh_checks::signed_volume(run.mesh()), ball, 0.12 * ball);
}

TEST(GridMesh, SlicesAndThreadsGiveTheSameBytes) {
  const std::vector<Atom> atoms = random_cluster(60, 5);
  GridRun whole(atoms, 1.4f, 0.5f, 0, 1);
  const mesh_checks::Mesh expected = whole.mesh();
  for (unsigned threads : {1u, 4u})
    for (uint32_t slice : {1u, 7u, 50u}) {
      GridRun run(atoms, 1.4f, 0.5f, slice, threads);
      ASSERT_GT(run.slices(slice).size(), 1u);
      const mesh_checks::Mesh mesh = run.mesh(slice);
      EXPECT_EQ(run.signs, whole.signs);
      EXPECT_EQ(mesh.positions, expected.positions);
      EXPECT_EQ(mesh.normals, expected.normals);
      EXPECT_EQ(mesh.owners, expected.owners);
      EXPECT_EQ(mesh.indices, expected.indices);
    }
}

}  // namespace
