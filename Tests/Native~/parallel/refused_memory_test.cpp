// SPDX-License-Identifier: MIT
// Whichever allocation is refused, nothing that was taken before is lost. This program has its own operator new, which
// fails when it is told to.
#include "parallel/cpu_executor.h"
#include "parallel/growing_buffer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <vector>

namespace {

// How many allocations succeed before one is refused; negative: all do.
std::atomic<long> successes_left{-1};

void *allocate(size_t bytes) {
  if (successes_left >= 0 && successes_left-- == 0) throw std::bad_alloc();
  void *const memory = std::malloc(bytes ? bytes : 1);
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace

void *operator new(size_t bytes) { return allocate(bytes); }
void *operator new[](size_t bytes) { return allocate(bytes); }
void operator delete(void *memory) noexcept { std::free(memory); }
void operator delete[](void *memory) noexcept { std::free(memory); }
void operator delete(void *memory, size_t) noexcept { std::free(memory); }
void operator delete[](void *memory, size_t) noexcept { std::free(memory); }

namespace {

using namespace quickses;

// Calls work() until nothing is refused any more: first its first allocation, then its second one, ... check() looks
// at what each failure leaves. Returns the number of failures.
template <class Work, class Check>
int refuse_each(const Work &work, const Check &check) {
  for (int k = 0;; ++k) {
    bool refused = false;
    successes_left = k;
    try {
      work();
    } catch (const std::bad_alloc &) {
      refused = true;
    }
    successes_left = -1;
    check();
    if (!refused) return k;
  }
}

// Counts the blocks that were not given back.
struct CountingMemory {
  static constexpr const char *kName = "the test";
  static inline int blocks = 0;
  static inline bool refuses = false;
  static uint64_t free_bytes() { return 0; }
  static void *acquire(size_t bytes) {
    if (refuses) return nullptr;
    ++blocks;
    return HostMemory::acquire(bytes);
  }
  static void release(void *memory) {
    if (memory) --blocks;
    HostMemory::release(memory);
  }
};

TEST(RefusedMemory, ArenasLoseNoBlock) {
  const int failures = refuse_each(
      [] {
        Arena<CountingMemory> arena;
        for (int k = 0; k < 5; ++k) arena.allocate(size_t(2) << 20);  // each a block of its own
        arena.reset();                                                // merged into one
        arena.allocate(size_t(30) << 20);
      },
      [] { ASSERT_EQ(CountingMemory::blocks, 0); });
  EXPECT_GE(failures, 3);
}

TEST(RefusedMemory, ArenasGoOnAfterwards) {
  Arena<CountingMemory> arena;
  refuse_each([&] { arena.allocate(size_t(2) << 20); },
              [&] {
                arena.reset();
                EXPECT_LE(arena.held(), size_t(4) << 20);
              });
  EXPECT_NE(arena.allocate(100), nullptr);
}

// As the GPU's memory after a fault.
struct FaultyMemory : CountingMemory {
  static inline bool has_fault = false;
  static void *acquire(size_t bytes) {
    if (has_fault) throw Error(QSES_DEVICE_ERROR, "a fault");
    return CountingMemory::acquire(bytes);
  }
};

TEST(RefusedMemory, AFaultLeavesABufferEmpty) {
  GrowingBuffer<FaultyMemory> buffer;
  EXPECT_NE(buffer.reserve(100), nullptr);
  FaultyMemory::has_fault = true;
  EXPECT_THROW(buffer.reserve(100000), Error);
  EXPECT_EQ(buffer.size(), 0u);
  EXPECT_THROW(buffer.reserve(100), Error) << "there is no memory";
  FaultyMemory::has_fault = false;
  EXPECT_NE(buffer.reserve(100), nullptr);
}

struct CountedScratch {
  static inline int alive = 0;
  std::vector<int> room = std::vector<int>(10);
  CountedScratch() { ++alive; }
  ~CountedScratch() { --alive; }
};

TEST(RefusedMemory, ExecutorsLoseNoScratch) {
  const int failures = refuse_each(
      [] {
        CpuExecutor executor(20);
        EXPECT_EQ(executor.scratches<CountedScratch>().size(), 20u);
      },
      [] { ASSERT_EQ(CountedScratch::alive, 0); });
  EXPECT_GE(failures, 40);
  CpuExecutor executor(20);
  refuse_each([&] { executor.scratches<CountedScratch>(); },
              [] { EXPECT_TRUE(CountedScratch::alive == 0 || CountedScratch::alive == 20); });
  EXPECT_EQ(CountedScratch::alive, 20);
  EXPECT_GE(executor.scratch_bytes(), 20 * sizeof(CountedScratch));
}

TEST(RefusedMemory, BuffersAreEmptyThen) {
  GrowingBuffer<CountingMemory> buffer;
  buffer.reserve(1000);
  CountingMemory::refuses = true;
  int refused = 0;
  const auto ask = [&] {
    try {
      buffer.reserve(100000);
      ADD_FAILURE() << "there was none to be had";
    } catch (const MemoryRefused &) {
      ++refused;
    }
  };
  refuse_each(ask, [&] {
    EXPECT_EQ(buffer.size(), 0u);
    EXPECT_EQ(buffer.data(), nullptr);
    EXPECT_EQ(CountingMemory::blocks, 0);
  });
  EXPECT_EQ(refused, 1);
  CountingMemory::refuses = false;
  EXPECT_NE(buffer.reserve(100), nullptr);
  buffer.release();
  EXPECT_EQ(CountingMemory::blocks, 0);
}

// What could not be made is made the next time.
TEST(RefusedMemory, ExecutorsMakeTheirScratchLater) {
  struct First {
    int number = 0;
  };
  struct Second {
    std::vector<int> numbers = std::vector<int>(100);
    uint64_t bytes() const { return 400; }
  };
  const CpuExecutor first(2);
  for (const unsigned threads : {1u, 2u}) {
    std::unique_ptr<CpuExecutor> executor;
    const int failures = refuse_each(
        [&] {
          if (!executor) executor = std::make_unique<CpuExecutor>(WorkerThreads(threads));
          executor->scratches<First>();
          executor->scratches<Second>();
        },
        [&] {
          if (executor) executor->scratch_bytes();
        });
    EXPECT_GT(failures, 2);
    EXPECT_EQ(executor->scratch_bytes(), threads * (sizeof(First) + sizeof(Second) + 400));
  }
}

}  // namespace
