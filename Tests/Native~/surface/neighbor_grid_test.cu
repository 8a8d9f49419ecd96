// SPDX-License-Identifier: MIT
// The neighbour grid of the GPU against that of plain loops: the same order, whichever way it is found.
#include "parallel/cuda_executor.cuh"
#include "parallel/serial_executor.h"
#include "surface/stages/neighbor_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace {

using namespace quickses;

bool no_device() {
  int count = 0;
  return cudaGetDeviceCount(&count) != cudaSuccess || count == 0;
}

template <class T>
std::vector<T> to_host(CudaExecutor &executor, const T *device, size_t n) {
  std::vector<T> host(n);
  executor.fetch_all(host.data(), device, n);
  return host;
}

// Of `there` spheres, of which those from `real` on are no items.
struct SomeOf {
  const Sphere *items;
  size_t real;
  QSES_HOST_DEVICE Sphere operator()(size_t i) const { return i < real ? items[i] : no_item(); }
};

// Remembers what went where.
struct Remember {
  uint32_t *from;
  QSES_HOST_DEVICE void operator()(size_t place, size_t i) const { from[place] = static_cast<uint32_t>(i); }
};

std::vector<Sphere> random_spheres(size_t count, float extent, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> along(0.f, extent);
  std::vector<Sphere> spheres(count);
  for (size_t k = 0; k < count; ++k)
    spheres[k] = {glm::vec3(along(random), along(random), along(random)), static_cast<float>(k)};
  return spheres;
}

// large: so many of the spheres, which are told by their radii, are in no cell.
void compare(CudaExecutor &executor, std::vector<Sphere> spheres, size_t real, float extent, uint32_t large = 0) {
  SCOPED_TRACE(testing::Message() << real << " of " << spheres.size() << " spheres in a box of " << extent);
  const size_t n = spheres.size();
  for (size_t k = 0; large > 0 && k < n; ++k) spheres[k].radius = static_cast<float>(k * 7919 % n);
  const CellLayout cells =
      layout_cells(glm::vec3(0.f), glm::vec3(extent), 3.1f, {static_cast<float>(n - 1 - large), large});
  SerialExecutor host;
  const NeighborGridView expected = build_neighbor_grid(host, "crowded cell", n, cells, [&] {
    return SomeOf{spheres.data(), real};
  });
  executor.arena().reset();
  const Span<Sphere> on_device = executor.allocate<Sphere>(n);
  executor.upload(on_device.data, spheres.data(), n);
  const Span<uint32_t> from = executor.allocate<uint32_t>(n);
  const NeighborGridView grid = build_neighbor_grid(
      executor, "crowded cell", n, cells,
      [&] {
        return SomeOf{on_device.data, real};
      },
      Remember{from.data});
  ASSERT_EQ(grid.starts != nullptr, expected.starts != nullptr);
  const std::vector<uint32_t> order = to_host(executor, grid.order, n);
  ASSERT_TRUE(std::equal(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(real), expected.order));
  const std::vector<uint32_t> brought = to_host(executor, from.data, real);
  ASSERT_TRUE(std::equal(brought.begin(), brought.end(), order.begin()));
  const std::vector<Sphere> items = to_host(executor, grid.items, n + kBehindItems);
  for (size_t k = 0; k < items.size(); ++k) {
    ASSERT_EQ(items[k].center, expected.items[k].center) << k;
    ASSERT_EQ(items[k].radius, expected.items[k].radius) << k;
  }
  if (grid.starts) {
    const std::vector<uint32_t> starts = to_host(executor, grid.starts, cells.cells() + 1);
    EXPECT_TRUE(std::equal(starts.begin(), starts.end(), expected.starts));
  }
}

// Also as frames that follow each other, of which each goes on with what was counted in the one before.
TEST(NeighborGridCuda, IsThatOfPlainLoops) {
  if (no_device()) GTEST_SKIP() << "skipped: no CUDA device";
  const DeviceGuard guard(0);
  CudaExecutor executor(0);
  for (const bool follow : {false, true})
    for (const size_t n : {size_t(1), size_t(300), size_t(5000), size_t(100000)})
      for (const uint32_t crowd : {0u, kCrowd - 1, kCrowd + 1, 3 * kCrowd}) {
        std::vector<Sphere> spheres = random_spheres(n, 60.f, static_cast<unsigned>(n));
        for (uint32_t k = 0; k < crowd; ++k) spheres.push_back({glm::vec3(1.f, 2.f, 3.f), static_cast<float>(n + k)});
        for (int frame = 0; frame < 2; ++frame)
          for (;;) try {
              executor.open_counts(follow ? n + crowd : 0);
              compare(executor, spheres, spheres.size(), 60.f, static_cast<uint32_t>(n / 16));
              executor.send_counts();
              executor.verify_counts();
              break;
            } catch (const AnticipatedTooLittle &) {
              ASSERT_TRUE(follow);
            }
        executor.open_counts(0);
        compare(executor, spheres, spheres.size() / 2 + 1, 60.f);
        compare(executor, spheres, spheres.size(), 60.f);
        compare(executor, spheres, spheres.size(), 6000.f);  // too many cells to count in
        compare(executor, spheres, spheres.size(), 6000.f, static_cast<uint32_t>(n / 16));
      }
}

// Nothing is known of it when it comes; what is made of it until then has each item once.
TEST(NeighborGridCuda, BearsACrowdThatIsNotAnticipated) {
  if (no_device()) GTEST_SKIP() << "skipped: no CUDA device";
  const DeviceGuard guard(0);
  CudaExecutor executor(0);
  const CellLayout cells = layout_cells(glm::vec3(0.f), glm::vec3(60.f), 3.1f);
  std::vector<Sphere> spheres = random_spheres(4 * kCrowd, 60.f, 8);
  for (const bool crowded : {false, true}) {
    for (size_t k = 0; crowded && k < 3 * kCrowd; ++k) spheres[k].center = glm::vec3(1.f, 2.f, 3.f);
    executor.arena().reset();
    executor.open_counts(1);
    const Span<Sphere> on_device = executor.allocate<Sphere>(spheres.size());
    executor.upload(on_device.data, spheres.data(), spheres.size());
    const NeighborGridView grid = build_neighbor_grid(executor, on_device, cells);
    std::vector<uint32_t> order = to_host(executor, grid.order, spheres.size());
    std::sort(order.begin(), order.end());
    for (uint32_t k = 0; k < order.size(); ++k) ASSERT_EQ(order[k], k);
    executor.send_counts();
    if (crowded)
      EXPECT_THROW(executor.verify_counts(), AnticipatedTooLittle);
    else
      executor.verify_counts();
  }
}

}  // namespace
