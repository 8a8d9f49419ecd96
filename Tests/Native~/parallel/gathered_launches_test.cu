// SPDX-License-Identifier: MIT
// Kernels that are handed to the GPU as one graph do what they do one by one, whatever their arguments, and whatever
// else the stream is given in between.
#include "parallel/cuda_executor.cuh"
#include "parallel/second_stream.cuh"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <thread>
#include <vector>

namespace {

using namespace quickses;

// They don't commute, so that the order tells.
struct Add {
  uint32_t *values;
  uint32_t number;
  QSES_HOST_DEVICE void operator()(size_t i) const { values[i] += number; }
};
struct Multiply {
  uint32_t number;
  uint32_t *values;
  QSES_HOST_DEVICE void operator()(size_t i) const { values[i] *= number; }
};
struct Mix {
  uint32_t *values;
  uint32_t a, b, c;
  QSES_HOST_DEVICE void operator()(size_t i) const { values[i] = (values[i] ^ a) * b + c + static_cast<uint32_t>(i); }
};

struct Load {
  const uint32_t *values;
  QSES_HOST_DEVICE uint32_t operator()(size_t i) const { return values[i]; }
};

// An executor that computes beside another one.
class GatheredLaunches : public testing::Test {
 protected:
  void SetUp() override {
    const CudaDevice description = describe_cuda_device(0);
    if (!description.available) GTEST_SKIP() << "skipped: no CUDA device (" << description.reason << ")";
    executor = std::make_unique<CudaExecutor>(0);
    other = std::make_unique<CudaExecutor>(0);
    guard = std::make_unique<DeviceGuard>(0);
    others_run.emplace(*other, stop);
    begin();
  }
  void TearDown() override {
    run.reset();
    others_run.reset();
  }
  // A computation of the executor.
  void begin() {
    run.reset();
    run.emplace(*executor, stop);
    executor->run_ahead(true, true);
    executor->arena().reset();
  }

  // Kernels of some kinds on n values, each with numbers of its own. What they make of the values is known.
  class Chain {
   public:
    Chain(CudaExecutor &e, size_t n) : executor_(e), device_(e.allocate<uint32_t>(n)), host_(n, 0) {
      e.fill(device_, 0);
    }
    void launch(int kind) {
      const uint32_t a = random_() | 1, b = random_() | 1, c = random_();
      if (kind == 0) give(Add{device_.data, a}, Add{host_.data(), a});
      if (kind == 1) give(Multiply{a, device_.data}, Multiply{a, host_.data()});
      if (kind == 2) give(Mix{device_.data, a, b, c}, Mix{host_.data(), a, b, c});
    }
    void launch(const std::vector<int> &kinds) {
      for (const int kind : kinds) launch(kind);
    }
    void expect_all() {
      std::vector<uint32_t> found(host_.size());
      executor_.download(found.data(), device_.data, found.size());
      executor_.wait();
      EXPECT_EQ(found, host_);
    }
    uint32_t *device() { return device_.data; }
    uint32_t sum() const { return std::accumulate(host_.begin(), host_.end(), uint32_t(0)); }

   private:
    template <class F>
    void give(const F &on_device, const F &on_host) {
      executor_.for_each(host_.size(), on_device);
      for (size_t i = 0; i < host_.size(); ++i) on_host(i);
    }
    CudaExecutor &executor_;
    Span<uint32_t> device_;
    std::vector<uint32_t> host_;
    std::mt19937 random_{1};
  };

  std::atomic<bool> stop{false};
  std::unique_ptr<CudaExecutor> executor, other;
  std::unique_ptr<DeviceGuard> guard;
  std::optional<CudaExecutor::RunScope> run, others_run;
};

TEST_F(GatheredLaunches, DoTheSameWithOtherArgumentsAndSizes) {
  const uint64_t before = executor->graphs();
  constexpr int kFrames = 12;
  for (int frame = 0; frame < kFrames; ++frame) {
    begin();
    Chain chain(*executor, 1000 + 777 * static_cast<size_t>(frame));
    executor->wait();
    chain.launch({0, 1, 2, 2, 1, 0, 2});
    chain.expect_all();
  }
  EXPECT_GE(executor->graphs() - before, static_cast<uint64_t>(kFrames - 1));
}

TEST_F(GatheredLaunches, KeepTheirOrderWithCopiesAndOtherStreams) {
  for (int frame = 0; frame < 6; ++frame) {
    begin();
    constexpr size_t kMany = 150000;
    Chain chain(*executor, kMany);
    for (int part = 0; part < 3; ++part) {
      chain.launch({0, 1, 2, 1, 2, 0});
      chain.expect_all();  // a copy
      chain.launch({2, 1, 1, 0, 2});
      {
        SecondStream second(*executor);
        second.follow();
        second.queue([&] { chain.launch({1, 2, 0, 1, 2}); });
      }
      // Sums by CUB of what is there, a fill by the driver, and an upload.
      chain.launch({1, 2, 0, 1});
      const Span<uint32_t> sums = executor->allocate<uint32_t>(kMany + 1);
      executor->exclusive_scan(kMany, Load{chain.device()}, sums);
      const Span<uint32_t> large = executor->allocate<uint32_t>(kMany);
      for (int k = 0; k < 4; ++k) executor->for_each(kMany, Add{large.data, 1});
      executor->fill(large, 0);
      for (int k = 0; k < 4; ++k) executor->for_each(kMany, Add{large.data, 1});
      EXPECT_EQ(executor->fetch(large.data + kMany - 1), 4u);
      EXPECT_EQ(executor->fetch(sums.data + kMany), chain.sum());
      const uint32_t told = 5;
      for (int k = 0; k < 4; ++k) executor->for_each(kMany, Add{large.data, 1});
      executor->upload(large.data, &told, 1);
      for (int k = 0; k < 4; ++k) executor->for_each(kMany, Add{large.data, 1});
      EXPECT_EQ(executor->fetch(large.data), 9u);
    }
    chain.expect_all();
  }
  EXPECT_GT(executor->graphs(), 0u);
}

TEST_F(GatheredLaunches, MayBeFewOrVeryMany) {
  const uint64_t before = executor->graphs();
  for (int frame = 0; frame < 3; ++frame)
    for (const size_t count : {1u, 2u, 3u, 4u, 63u, 64u, 65u, 128u, 300u}) {
      begin();
      Chain chain(*executor, 500);
      for (size_t k = 0; k < count; ++k) chain.launch(static_cast<int>(k % 3));
      chain.expect_all();
    }
  EXPECT_GT(executor->graphs(), before + 10);
}

TEST_F(GatheredLaunches, MayBeOfMoreKindsThanAreKept) {
  std::vector<std::vector<int>> kinds;
  std::mt19937 random(2);
  for (int k = 0; k < 40; ++k) {
    kinds.emplace_back(4 + random() % 9);
    for (int &kind : kinds.back()) kind = static_cast<int>(random() % 3);
  }
  for (int frame = 0; frame < 120; ++frame) {
    begin();
    Chain chain(*executor, 2000);
    chain.launch(kinds[frame % 2 ? random() % 5 : random() % kinds.size()]);
    chain.expect_all();
  }
  EXPECT_GT(executor->graphs(), 40u);
}

TEST_F(GatheredLaunches, AreAskedForOneByOneAlone) {
  others_run.reset();
  const uint64_t before = executor->graphs();
  for (int frame = 0; frame < 3; ++frame) {
    begin();
    Chain chain(*executor, 1000);
    chain.launch({0, 1, 2, 2, 1, 0, 2});
    chain.expect_all();
  }
  EXPECT_EQ(executor->graphs(), before);
  // The other one may end while something is gathered.
  others_run.emplace(*other, stop);
  begin();
  Chain chain(*executor, 1000);
  chain.launch({0, 1, 2, 2});
  others_run.reset();
  chain.launch({1, 0, 2});
  chain.expect_all();
}

TEST_F(GatheredLaunches, AreGivenUpWithTheComputation) {
  Chain chain(*executor, 1000);
  chain.launch({0, 1, 2, 2, 1});
  chain.expect_all();
  const uint32_t first = executor->fetch(chain.device());
  for (int k = 0; k < 5; ++k) executor->for_each(1000, Add{chain.device(), 7});
  stop = true;
  EXPECT_THROW(executor->for_each(1000, Add{chain.device(), 7}), Cancelled);
  stop = false;
  run.reset();
  run.emplace(*executor, stop);
  EXPECT_EQ(executor->fetch(chain.device()), first);
}

// A frame that breaks off may not have had its zeros; the next one has them.
TEST_F(GatheredLaunches, LeaveZerosAsTheyAre) {
  constexpr size_t kMany = 90000;
  executor->open_counts(7, true);
  executor->fill(executor->allocate_zeros<uint32_t>(kMany), 1);
  executor->wait();
  begin();
  executor->open_counts(7, true);
  executor->allocate_zeros<uint32_t>(10);
  begin();  // nothing has begun before
  executor->open_counts(7, true);
  const Span<uint32_t> zeros = executor->allocate_zeros<uint32_t>(kMany);
  std::vector<uint32_t> found(kMany);
  executor->download(found.data(), zeros.data, kMany);
  executor->wait();
  EXPECT_EQ(found, std::vector<uint32_t>(kMany, 0));
  executor->open_counts(0);
}

TEST_F(GatheredLaunches, ComeBehindAnotherExecutors) {
  other->run_ahead(true, true);
  for (int frame = 0; frame < 5; ++frame) {
    begin();
    constexpr size_t kMany = 100000;
    const Span<uint32_t> values = executor->allocate<uint32_t>(kMany);
    executor->fill(values, 0);
    uint32_t expected = 0;
    for (uint32_t round = 1; round < 6; ++round) {
      for (int k = 0; k < 6; ++k, expected += round) executor->for_each(kMany, Add{values.data, round});
      other->go_behind(*executor);
      for (int k = 0; k < 6; ++k, expected *= 3) other->for_each(kMany, Multiply{3, values.data});
      executor->go_behind(*other);
    }
    for (const size_t i : {size_t(0), kMany / 2, kMany - 1}) EXPECT_EQ(executor->fetch(values.data + i), expected);
  }
  EXPECT_GT(executor->graphs(), 10u);
  EXPECT_GT(other->graphs(), 10u);
}

TEST_F(GatheredLaunches, OfManyThreadsAtOnce) {
  std::vector<std::thread> threads;
  for (int t = 0; t < 6; ++t)
    threads.emplace_back([this] {
      const DeviceGuard own_guard(0);
      CudaExecutor own(0);
      for (int frame = 0; frame < 40; ++frame) {
        const CudaExecutor::RunScope own_run(own, stop);
        own.run_ahead(true, true);
        own.arena().reset();
        Chain chain(own, 800 + 13 * static_cast<size_t>(frame));
        chain.launch({0, 1, 2, 2, 1, 0, 2, 1, 1, 2});
        chain.expect_all();
      }
      EXPECT_GT(own.graphs(), 30u);
    });
  for (std::thread &thread : threads) thread.join();
}

}  // namespace
