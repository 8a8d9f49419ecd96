// SPDX-License-Identifier: MIT
// Which spare buffers a pool of meshes keeps.
#include "surface/mesh/mesh_pool.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace {

using quickses::HostMemory;
using quickses::MeshBuffer;
using quickses::MeshPool;

constexpr size_t kLarge = size_t(64) << 20, kUsual = size_t(1) << 16;

void take_and_give_back(MeshPool *pool, size_t bytes, int times) {
  for (int k = 0; k < times; ++k) pool->give_back(pool->take(bytes));
}

// One large mesh, then small ones, which must not carry its buffer away: nobody will have it again.
TEST(MeshPool, GivesUpWhatMeshesHaveGrownOutOf) {
  MeshPool pool(MeshPool::source<HostMemory>());
  take_and_give_back(&pool, kLarge, 1);
  take_and_give_back(&pool, kUsual, 8);
  EXPECT_GE(pool.bytes(), kLarge) << "it may still be wanted";
  take_and_give_back(&pool, kUsual, 200);
  EXPECT_LT(pool.bytes(), kLarge / 16);
}

// Levels of a ladder, of which one is shown and one is on its way: each finds the buffer of the last time.
TEST(MeshPool, KeepsWhatIsUsedInTurn) {
  int acquired = 0;
  MeshPool::Source source = MeshPool::source<HostMemory>();
  source.acquire = [&acquired](size_t bytes) {
    ++acquired;
    return HostMemory::acquire(bytes);
  };
  MeshPool pool(std::move(source));
  std::vector<std::unique_ptr<MeshBuffer>> shown;
  for (int frame = 0; frame < 100; ++frame) {
    std::vector<std::unique_ptr<MeshBuffer>> made;
    for (const size_t bytes : {kUsual, 8 * kUsual, 64 * kUsual}) made.push_back(pool.take(bytes));
    for (auto &one : shown) pool.give_back(std::move(one));
    shown = std::move(made);
  }
  EXPECT_LE(acquired, 9);
  for (auto &one : shown) pool.give_back(std::move(one));
}

}  // namespace
