// SPDX-License-Identifier: MIT
// Which spare buffers a pool of meshes keeps.
#include "surface/mesh/mesh_pool.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace {

using quickses::HostMemory;
using quickses::MeshBuffer;
using quickses::MeshLease;
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

// A machine with little memory: a mesh takes no more than it needs, at the cost of spares, before it is refused.
TEST(MeshPool, GivesUpSparesForAMeshThatHasNoRoomBesideThem) {
  size_t out = 0;
  MeshPool::Source source = MeshPool::source<HostMemory>();
  source.acquire = [&out](size_t bytes) -> void * {
    if (out + bytes > 9 * kUsual) return nullptr;
    out += bytes;
    return HostMemory::acquire(bytes);
  };
  source.release = [&out](MeshBuffer &buffer) {
    out -= buffer.size;
    HostMemory::release(buffer.memory);
  };
  MeshPool pool(std::move(source));
  std::unique_ptr<MeshBuffer> first = pool.take(kUsual), second = pool.take(kUsual);
  pool.give_back(std::move(first));
  pool.give_back(std::move(second));
  std::unique_ptr<MeshBuffer> large = pool.take(8 * kUsual);
  EXPECT_EQ(large->size, 8 * kUsual);
  EXPECT_THROW(pool.take(2 * kUsual), quickses::MemoryRefused);
  EXPECT_EQ(pool.bytes(), large->size);
  EXPECT_EQ(out, large->size);
  pool.give_back(std::move(large));
}

// Every byte is counted once, with what is said of a mesh besides its arrays, until it is released.
TEST(MeshPool, CountsWhatThereIs) {
  const auto pool = std::make_shared<MeshPool>(MeshPool::source<HostMemory>());
  const std::vector<char> numbers(3 * kUsual);
  MeshLease lease(pool, kUsual);
  const uint64_t without = pool->bytes();
  EXPECT_GE(without, kUsual);
  lease.add(MeshLease::kComponents, numbers.data(), kUsual);
  EXPECT_GE(pool->bytes(), without + kUsual);
  lease.add(MeshLease::kAtomAreas, numbers.data(), numbers.size());
  const uint64_t with = pool->bytes();
  EXPECT_GE(with, without + kUsual + numbers.size());
  lease.add(MeshLease::kComponents, numbers.data(), kUsual / 2);  // there is room
  EXPECT_EQ(pool->bytes(), with);
  lease.give_back();
  EXPECT_EQ(pool->bytes(), with) << "a spare";
  pool->drop_spares();
  EXPECT_EQ(pool->bytes(), 0u);
}

// Of a context that is gone; meshes that were kept may be given back much later.
TEST(MeshPool, KeepsNothingOnceItIsClosed) {
  MeshPool pool(MeshPool::source<HostMemory>());
  std::unique_ptr<MeshBuffer> first = pool.take(kUsual), second = pool.take(2 * kUsual);
  const uint64_t of_second = second->size;
  pool.give_back(pool.take(kUsual));
  pool.close();
  EXPECT_EQ(pool.bytes(), first->size + of_second);
  pool.give_back(std::move(first));
  EXPECT_EQ(pool.bytes(), of_second);
  pool.give_back(std::move(second));
  EXPECT_EQ(pool.bytes(), 0u);
}

}  // namespace
