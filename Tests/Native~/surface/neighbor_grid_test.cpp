// SPDX-License-Identifier: MIT
// The neighbour grid against plain loops over all items.
#include "surface/stages/neighbor_grid.h"
#include "parallel/cpu_executor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace {

using namespace quickses;

struct Items {
  std::vector<Sphere> spheres;
  glm::vec3 low{1e9f}, high{-1e9f};
  void add(const glm::vec3 &p) {
    spheres.push_back({p, static_cast<float>(spheres.size())});
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  // Radii in another order, each once.
  void mix_radii() {
    for (size_t k = 0; k < spheres.size(); ++k) spheres[k].radius = static_cast<float>(k * 7919 % spheres.size());
  }
};

Items random_items(size_t count, float extent, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> along(-extent, extent);
  Items items;
  for (size_t k = 0; k < count; ++k) items.add(glm::vec3(along(random), 0.5f * along(random), 2.f * along(random)));
  return items;
}

// Items of the runs that a box meets, by their number and one after the other. None may come twice.
std::set<uint32_t> look_up(const NeighborGridView &grid, const glm::vec3 &low, const glm::vec3 &high) {
  const CellBox box = cells_around(grid.cells, Vec3<float>(low), Vec3<float>(high));
  std::set<uint32_t> found, again;
  for (int r = 0; r < grid.runs(box); ++r) {
    const ItemRun run = grid.run(box, r);
    EXPECT_LE(run.begin, run.end);
    EXPECT_LE(run.end, grid.count);
    for (uint32_t k = run.begin; k < run.end; ++k) EXPECT_TRUE(found.insert(grid.order[k]).second);
  }
  EXPECT_TRUE(grid.for_each_run(box, [&](const ItemRun &run) {
    for (uint32_t k = run.begin; k < run.end; ++k) again.insert(grid.order[k]);
    return true;
  }));
  EXPECT_EQ(found, again);
  return found;
}

// Remembers what went where.
struct Remember {
  std::vector<uint32_t> *from;
  void operator()(size_t place, size_t i) const { (*from)[place] = static_cast<uint32_t>(i); }
};

// large: so many of the items are in no cell.
void check_grid(Items items, float edge, bool dense, uint32_t large = 0) {
  if (large > 0) items.mix_radii();
  for (unsigned threads : {1u, 3u}) {
    CpuExecutor executor(threads);
    const size_t n = items.spheres.size();
    std::vector<uint32_t> from(n, ~uint32_t(0));
    const NeighborGridView grid = build_neighbor_grid(
        executor, "crowded cell", n,
        layout_cells(items.low, items.high, edge, {static_cast<float>(n - 1 - large), large}),
        [&] { return LoadItem{items.spheres.data()}; }, Remember{&from});
    ASSERT_TRUE(std::equal(from.begin(), from.end(), grid.order));
    ASSERT_EQ(grid.starts != nullptr, dense);
    ASSERT_EQ(grid.count, n);
    // A permutation, sorted by cell, with the large ones behind; within a cell, and of these, in the order given.
    std::set<uint32_t> numbers(grid.order, grid.order + n);
    ASSERT_EQ(numbers.size(), n);
    ASSERT_TRUE(n == 0 || *numbers.rbegin() == n - 1);
    for (size_t k = 0; k < n; ++k) {
      ASSERT_EQ(grid.items[k].radius, items.spheres[grid.order[k]].radius);
      ASSERT_EQ(grid.items[k].center, items.spheres[grid.order[k]].center);
      ASSERT_EQ(grid.items[k].radius > static_cast<float>(n - 1 - large), k >= n - large);
      if (k >= n - large) {
        ASSERT_TRUE(k == n - large || grid.order[k - 1] < grid.order[k]);
        continue;
      }
      const uint64_t cell = grid.cells.hash(grid.items[k].center);
      ASSERT_LT(cell, grid.cells.cells());
      if (!dense) {
        ASSERT_EQ(grid.sorted_keys[k], cell);
      }
      if (k == 0) continue;
      const uint64_t before = grid.cells.hash(grid.items[k - 1].center);
      ASSERT_TRUE(before < cell || (before == cell && grid.order[k - 1] < grid.order[k]));
    }
    // What is read behind the last item is far from everything.
    for (size_t k = n; k < n + 8; ++k) ASSERT_GT(glm::length(grid.items[k].center - items.high), 1e6f);

    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0.f, 1.f);
    for (int trial = 0; trial < 200; ++trial) {
      const Sphere &near = items.spheres[random() % n];
      const glm::vec3 size = 2.5f * edge * glm::vec3(unit(random), unit(random), unit(random));
      const glm::vec3 low = near.center - size * unit(random) - edge * (unit(random) - 0.5f), high = low + size;
      const std::set<uint32_t> found = look_up(grid, low, high);
      for (uint32_t i = 0; i < n; ++i) {
        const glm::vec3 &c = items.spheres[i].center;
        const bool within = glm::all(glm::greaterThanEqual(c, low)) && glm::all(glm::lessThanEqual(c, high));
        ASSERT_TRUE(!within || found.count(i));
        if (items.spheres[i].radius > static_cast<float>(n - 1 - large)) {  // met wherever it is
          ASSERT_TRUE(found.count(i));
          continue;
        }
        // Nothing further away than a cell on every side is listed. (The grid ends where the items do.)
        const glm::vec3 from = glm::clamp(low, items.low, items.high), to = glm::clamp(high, items.low, items.high);
        const glm::vec3 off = glm::max(from - c, c - to);
        ASSERT_TRUE(std::max({off.x, off.y, off.z}) < 1.01f * edge || !found.count(i));
      }
    }
    // A box around everything finds everything. (It is looked through row by row.)
    if (int64_t(grid.cells.count.y) * grid.cells.count.z > 1000000) continue;
    EXPECT_EQ(look_up(grid, items.low - 100.f, items.high + 100.f).size(), n);
  }
}

TEST(NeighborGrid, FindsWhatABoxHolds) {
  check_grid(random_items(500, 20.f, 1), 4.6f, true);
  check_grid(random_items(500, 3.f, 2), 4.6f, true);
  check_grid(random_items(30, 100.f, 3), 3.1f, true);
}

// Counted, sorted, and in a sparse grid.
TEST(NeighborGrid, LargeItemsAreMetByEveryLookUp) {
  check_grid(random_items(500, 20.f, 1), 4.6f, true, 7);
  check_grid(random_items(30, 100.f, 3), 3.1f, true, 29);
  Items crowded = random_items(500, 20.f, 6);
  for (uint32_t k = 0; k < kCrowd + 1; ++k) crowded.add(glm::vec3(1.f, 2.f, 3.f));
  check_grid(crowded, 4.6f, true, 20);
  Items scattered = random_items(400, 20.f, 4);
  scattered.add(glm::vec3(20000.f, 100.f, -15000.f));
  check_grid(scattered, 4.6f, false, 3);
}

TEST(NeighborGrid, LookUpsEndWhenTheyAreTold) {
  CpuExecutor executor(1);
  Items items = random_items(100, 20.f, 1);
  const NeighborGridView grid = build_neighbor_grid(executor, Span<Sphere>{items.spheres.data(), 100},
                                                    layout_cells(items.low, items.high, 4.6f, {98.f, 1}));
  const CellBox all = cells_around(grid.cells, Vec3<float>(items.low), Vec3<float>(items.high));
  for (int end = 1; end <= grid.runs(all); ++end) {
    int runs = 0;
    EXPECT_FALSE(grid.for_each_run(all, [&](const ItemRun &) { return ++runs < end; }));
    EXPECT_EQ(runs, end);
  }
}

// A cell with more items than are counted one against the other, and one with as many as just are.
TEST(NeighborGrid, CrowdsAreInOrder) {
  for (const uint32_t crowd : {kCrowd - 1, kCrowd, kCrowd + 1, 3 * kCrowd}) {
    Items items = random_items(3000, 20.f, 6);
    for (uint32_t k = 0; k < crowd; ++k) items.add(glm::vec3(1.f, 2.f, 3.f));
    check_grid(items, 4.6f, true);
  }
}

TEST(NeighborGrid, SparseOnesFindTheSame) {
  Items items = random_items(400, 20.f, 4);
  items.add(glm::vec3(20000.f, 100.f, -15000.f));
  check_grid(items, 4.6f, false);
  Items two;
  two.add(glm::vec3(-500000.f));
  two.add(glm::vec3(500000.f));
  check_grid(two, 3.f, false);
}

TEST(NeighborGrid, OfOneItemAndOfEqualOnes) {
  Items one;
  one.add(glm::vec3(3.f, -2.f, 1.f));
  check_grid(one, 3.1f, true);
  Items equal;
  for (int k = 0; k < 70; ++k) equal.add(glm::vec3(3.f, -2.f, 1.f));
  check_grid(equal, 3.1f, true);
  Items on_borders;  // whole numbers of edges
  for (int k = 0; k < 216; ++k) on_borders.add(4.f * glm::vec3(k % 6, k / 6 % 6, k / 36));
  check_grid(on_borders, 4.f, true);
}

TEST(NeighborGrid, LowerBound) {
  const std::vector<uint64_t> keys = {1, 3, 3, 3, 9, uint64_t(1) << 40, (uint64_t(1) << 40) + 1};
  for (uint64_t key : {uint64_t(0), uint64_t(1), uint64_t(2), uint64_t(3), uint64_t(4), uint64_t(9), uint64_t(10),
                       uint64_t(1) << 40, uint64_t(1) << 41})
    for (uint32_t n = 0; n <= keys.size(); ++n)
      EXPECT_EQ(lower_bound(keys.data(), n, key),
                static_cast<uint32_t>(std::lower_bound(keys.begin(), keys.begin() + n, key) - keys.begin()));
}

TEST(NeighborGrid, TablesStaySmall) {
  EXPECT_TRUE(dense_table_pays(1000, 1));
  EXPECT_FALSE(dense_table_pays(kMaxDenseCells + 1, uint64_t(1) << 40));
  EXPECT_FALSE(dense_table_pays(uint64_t(50) << 20, 100));
}

}  // namespace
