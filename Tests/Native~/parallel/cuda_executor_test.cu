// SPDX-License-Identifier: MIT
// The verbs of the CUDA executor against plain loops, and how it fails.
#include "parallel/cuda_executor.cuh"
#include "parallel/cuda_stage_timer.cuh"
#include "parallel/second_stream.cuh"
#include "parallel/two_step_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <random>
#include <thread>

namespace {

using namespace quickses;

CudaExecutor *device() {
  static const CudaDevice description = describe_cuda_device(0);
  if (!description.available) return nullptr;
  static CudaExecutor executor(0);
  return &executor;
}

#define REQUIRE_DEVICE()                                                                               \
  if (!device()) GTEST_SKIP() << "skipped: no CUDA device (" << describe_cuda_device(0).reason << ")"; \
  CudaExecutor &executor = *device();                                                                  \
  executor.arena().reset()

// Also as many as one block scans, and one more.
const size_t kSizes[] = {1,
                         31,
                         128,
                         129,
                         5000,
                         gpu::kFewItems - 1,
                         gpu::kFewItems,
                         gpu::kFewItems + 1,
                         gpu::kSomeItems - 1,
                         gpu::kSomeItems,
                         gpu::kSomeItems + 1,
                         1000003};

template <class T>
std::vector<T> to_host(CudaExecutor &executor, Span<T> span) {
  std::vector<T> host(span.size);
  executor.download(host.data(), span.data, span.size);
  executor.wait();
  return host;
}
template <class T>
Span<T> to_device(CudaExecutor &executor, const std::vector<T> &host) {
  Span<T> span = executor.allocate<T>(host.size());
  executor.upload(span.data, host.data(), host.size());
  return span;
}

std::vector<uint32_t> random_numbers(size_t n, uint32_t limit) {
  std::mt19937 random(static_cast<unsigned>(n));
  std::vector<uint32_t> v(n);
  for (uint32_t &x : v) x = static_cast<uint32_t>(random() % limit);
  return v;
}

struct Square {
  uint64_t *out;
  QSES_HOST_DEVICE void operator()(size_t i) const { out[i] = i * i; }
};
struct Load {
  const uint32_t *in;
  QSES_HOST_DEVICE uint32_t operator()(size_t i) const { return in[i]; }
};
struct IsOdd {
  const uint32_t *in;
  QSES_HOST_DEVICE bool operator()(size_t i) const { return in[i] & 1; }
};
struct Root {
  QSES_HOST_DEVICE double operator()(size_t i) const { return 1.0 / (1.0 + static_cast<double>(i)); }
};
struct Histogram {
  int counts[256];
};
struct CountDigits {  // of 1000 numbers, by a team
  const uint32_t *in;
  uint32_t *out;
  template <class Team>
  QSES_HOST_DEVICE void operator()(Team team, Histogram &scratch, size_t item) const {
    for (int k = team.rank(); k < 256; k += team.size()) scratch.counts[k] = 0;
    team.sync();
    for (int k = team.rank(); k < 256; k += team.size())
      for (int j = 0; j < 1000; ++j)
        scratch.counts[k] += in[item * 1000 + static_cast<size_t>(j)] == static_cast<uint32_t>(k);
    team.sync();
    for (int k = team.rank(); k < 256; k += team.size())
      out[item * 256 + static_cast<size_t>(k)] = static_cast<uint32_t>(scratch.counts[255 - k]);
  }
};

TEST(CudaExecutor, ForEach) {
  REQUIRE_DEVICE();
  executor.for_each(0, Square{nullptr});
  for (size_t n : kSizes) {
    Span<uint64_t> out = executor.allocate<uint64_t>(n);
    executor.for_each(n, Square{out.data});
    const auto host = to_host(executor, out);
    for (size_t i = 0; i < n; ++i) ASSERT_EQ(host[i], i * i);
  }
}

TEST(CudaExecutor, ForEachBrick) {
  REQUIRE_DEVICE();
  const size_t n = 9000;  // more than there are blocks
  const auto in = random_numbers(n * 1000, 256);
  Span<uint32_t> out = executor.allocate<uint32_t>(n * 256);
  executor.for_each_brick<Histogram>(n, CountDigits{to_device(executor, in).data, out.data});
  const auto host = to_host(executor, out);
  std::vector<uint32_t> expected(n * 256, 0);
  for (size_t k = 0; k < in.size(); ++k) ++expected[k / 1000 * 256 + 255 - in[k]];
  EXPECT_EQ(host, expected);
}

// Every third item is left for the second step.
struct EveryThird {
  uint32_t *looks, *second;
  QSES_FN bool is_done_at_a_glance(size_t i) const {
    ++looks[i];
    return i % 3 != 0;
  }
  QSES_FN void finish(size_t i) const { ++second[i]; }
};
TEST(CudaExecutor, FinishesInASecondStepWhatIsLeft) {
  REQUIRE_DEVICE();
  for (size_t n : {size_t(1), size_t(127), size_t(128), size_t(129), size_t(3000001)}) {
    Span<uint32_t> looks = executor.allocate<uint32_t>(n), second = executor.allocate<uint32_t>(n);
    executor.fill(looks, 0);
    executor.fill(second, 0);
    for_each_in_two_steps(executor, n, EveryThird{looks.data, second.data});
    std::vector<uint32_t> expected(n, 1);
    EXPECT_EQ(to_host(executor, looks), expected);
    for (size_t i = 0; i < n; ++i) expected[i] = i % 3 == 0 ? 1 : 0;
    EXPECT_EQ(to_host(executor, second), expected);
  }
}

TEST(CudaExecutor, ExclusiveScan) {
  REQUIRE_DEVICE();
  Span<uint32_t> none = executor.allocate<uint32_t>(1);
  executor.exclusive_scan(0, Load{nullptr}, none);
  EXPECT_EQ(executor.fetch(none.data), 0u);
  for (size_t n : kSizes) {
    const auto in = random_numbers(n, 9000);
    Span<uint64_t> out = executor.allocate<uint64_t>(n + 1);
    executor.exclusive_scan(n, Load{to_device(executor, in).data}, out);
    std::vector<uint64_t> expected(n + 1, 0);
    for (size_t i = 0; i < n; ++i) expected[i + 1] = expected[i] + in[i];
    EXPECT_EQ(to_host(executor, out), expected);
    // In two parts.
    for (size_t first : {size_t(1), n / 3, n}) {
      if (first > n) continue;
      executor.fill(out, 255);
      executor.exclusive_scan(first, Load{to_device(executor, in).data}, out);
      executor.go_on_scanning(n - first, Load{to_device(executor, in).data + first},
                              Span<uint64_t>{out.data + first, n - first + 1});
      EXPECT_EQ(to_host(executor, out), expected) << n << " from " << first;
    }
  }
}

// Each step reads what the one before it wrote elsewhere.
struct WriteDigits {
  uint32_t *out;
  QSES_HOST_DEVICE void operator()(size_t i) const { out[i] = static_cast<uint32_t>(i % 5); }
};
struct Reverse {
  const uint64_t *in;
  size_t last;
  uint64_t *out;
  QSES_HOST_DEVICE void operator()(size_t i) const { out[i] = in[last - i]; }
};
struct CountLaunches : LaunchObserver {
  size_t launches = 0;
  CountLaunches() { current = this; }
  ~CountLaunches() override { current = nullptr; }
  void before(const Launch &) override { ++launches; }
  void after(const Launch &) override {}
};
struct AddTo {
  uint32_t *out;
  uint32_t value;
  QSES_HOST_DEVICE void operator()(size_t i) const { out[i] += value; }
};
// Takes so many clock cycles.
struct Spin {
  long long clocks;
  QSES_HOST_DEVICE void operator()(size_t) const {
#if defined(__CUDA_ARCH__)
    for (const long long start = clock64(); clock64() - start < clocks;) {
    }
#endif
  }
};
TEST(CudaExecutor, StepsInTurn) {
  REQUIRE_DEVICE();
  constexpr size_t kThreads = gpu::kFewThreads, kMost = gpu::kFewInTurn * kThreads;
  for (size_t n :
       {size_t(1), size_t(500), kThreads - 1, kThreads, kThreads + 1, kMost - 1, kMost, kMost + 1, size_t(40000)}) {
    Span<uint32_t> digits = executor.allocate<uint32_t>(n);
    Span<uint64_t> sums = executor.allocate<uint64_t>(n + 1), reversed = executor.allocate<uint64_t>(n + 1);
    size_t launches = 0;
    {
      const CountLaunches count;
      do_in_turn(executor, ForEach{n, WriteDigits{digits.data}}, Scan{n, Load{digits.data}, sums},
                 ForEach{n + 1, Reverse{sums.data, n, reversed.data}});
      launches = count.launches;
    }
    const bool together = n + 1 <= kMost;
    EXPECT_EQ(launches == 1, together) << n;
    std::vector<uint64_t> expected(n + 1, 0);
    for (size_t i = 0; i < n; ++i) expected[i + 1] = expected[i] + i % 5;
    std::reverse(expected.begin(), expected.end());
    EXPECT_EQ(to_host(executor, reversed), expected) << n;
  }
  // What may take too long for one launch is done step by step.
  const size_t n = 1000;
  Span<uint64_t> out = executor.allocate<uint64_t>(n);
  const CountLaunches count;
  do_in_turn(executor, ForEach{n, Square{out.data}, kThreadSteps}, ForEach{n, Square{out.data}});
  EXPECT_GE(count.launches, 2u);
}

// Those of a frame whose counts may be anticipated lie together, as far as there is room, and are filled by one launch:
// when the frame before is closed, or else at the beginning.
TEST(CudaExecutor, ZerosAreZerosInEachFrame) {
  REQUIRE_DEVICE();
  bool is_closed = false;
  for (const uint64_t kind : {uint64_t(0), uint64_t(7)})
    for (int frame = 0; frame < 6; ++frame) {
      executor.arena().reset();
      size_t launches = 0;
      {
        const CountLaunches count;
        executor.open_counts(kind);
        launches = count.launches;
      }
      if (is_closed) EXPECT_EQ(launches, 0u) << frame;
      std::vector<Span<uint32_t>> all;
      for (size_t n : {size_t(1), size_t(3), size_t(1000), size_t(90000), size_t(60000), size_t(17), size_t(500000)})
        all.push_back(executor.allocate_zeros<uint32_t>(n));
      all.push_back({executor.take_counts<uint32_t>(), 1});
      for (const Span<uint32_t> &zeros : all)
        ASSERT_EQ(to_host(executor, zeros), std::vector<uint32_t>(zeros.size, 0)) << zeros.size << ", frame " << frame;
      for (size_t k = 0; k < all.size(); ++k) executor.fill(all[k], static_cast<int>(k) + 1);
      // Filled apart: none reaches into another.
      for (size_t k = 0; k < all.size(); ++k)
        for (uint32_t word : to_host(executor, all[k])) ASSERT_EQ(word, 0x01010101u * (static_cast<uint32_t>(k) + 1));
      is_closed = frame % 2 == 1;
      if (is_closed) executor.close_counts();
    }
  executor.open_counts(0);
}

// What was asked for before the counts are closed is there after the next wait.
TEST(CudaExecutor, ClosedCountsAreNotWaitedFor) {
  REQUIRE_DEVICE();
  PinnedBuffer memory;
  constexpr size_t kMany = 100000;
  auto *const host = static_cast<uint32_t *>(memory.reserve(kMany * sizeof(uint32_t)));
  for (uint32_t frame = 1; frame < 20; ++frame) {
    executor.arena().reset();
    executor.open_counts(7, true);
    const Span<uint32_t> zeros = executor.allocate_zeros<uint32_t>(kMany / 2), out = executor.allocate<uint32_t>(kMany);
    executor.for_each(kMany, Spin{1000});
    executor.for_each(kMany / 2, AddTo{zeros.data, frame});
    executor.fill(out, static_cast<int>(frame));
    executor.download(host, zeros.data, zeros.size);
    executor.download(host + zeros.size, out.data, zeros.size);
    executor.close_counts();
    executor.wait();
    for (size_t k = 0; k < zeros.size; ++k) ASSERT_EQ(host[k], frame);
    for (size_t k = zeros.size; k < kMany; ++k) ASSERT_EQ(host[k], frame * 0x01010101u);
  }
  executor.open_counts(0);
}

// Whoever breaks off has its page-locked memory back when that is read by all kernels that were to read it.
TEST(CudaExecutor, WhatIsLentIsReadBeforeItIsTakenBack) {
  REQUIRE_DEVICE();
  PinnedBuffer memory;
  constexpr size_t kMany = 20000;
  auto *const host = static_cast<uint32_t *>(memory.reserve(kMany * sizeof(uint32_t)));
  for (const bool is_short : {false, true}) {
    executor.arena().reset();
    std::iota(host, host + kMany, 5u);
    const std::vector<uint32_t> expected(host, host + kMany);
    const Span<uint32_t> out = executor.allocate<uint32_t>(kMany);
    executor.fill(out, 0);
    {
      const std::atomic<bool> stop{false};
      const CudaExecutor::RunScope run(executor, stop);
      executor.run_ahead(is_short, false);
      executor.for_each(kMany, Spin{20000000});
      executor.for_each(kMany, gpu::CopyWords{out.data, executor.lend(host)});
      executor.end_lending();
    }
    std::fill_n(host, kMany, 0u);
    EXPECT_EQ(to_host(executor, out), expected) << is_short;
  }
  executor.run_ahead(false, false);
}

TEST(CudaExecutor, Reduce) {
  REQUIRE_DEVICE();
  EXPECT_EQ(executor.reduce(0, Root{}), 0.0);
  for (size_t n : kSizes) {
    double expected = 0;
    for (size_t i = 0; i < n; ++i) expected += Root{}(i);
    const double sum = executor.reduce(n, Root{});
    EXPECT_NEAR(sum, expected, 1e-11 * expected);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(executor.reduce(n, Root{}), sum);
  }
}

TEST(CudaExecutor, SortByKeyIsStable) {
  REQUIRE_DEVICE();
  for (size_t n : kSizes)
    for (int bits : {4, 17, 40}) {
      const auto random = random_numbers(n, 0xffffffffu);
      std::vector<uint64_t> keys(n);
      std::vector<uint32_t> values(n);
      for (size_t i = 0; i < n; ++i) keys[i] = (uint64_t(random[i]) * 77777) & ((uint64_t(1) << bits) - 1);
      std::iota(values.begin(), values.end(), 0u);
      Span<uint64_t> device_keys = to_device(executor, keys);
      Span<uint32_t> device_values = to_device(executor, values);
      executor.sort_by_key(device_keys, device_values);
      std::stable_sort(values.begin(), values.end(), [&](uint32_t a, uint32_t b) { return keys[a] < keys[b]; });
      std::stable_sort(keys.begin(), keys.end());
      EXPECT_EQ(to_host(executor, device_keys), keys);
      EXPECT_EQ(to_host(executor, device_values), values);
    }
}

TEST(CudaExecutor, Compact) {
  REQUIRE_DEVICE();
  EXPECT_EQ(executor.compact(0, IsOdd{nullptr}, Span<uint64_t>{}), 0u);
  for (size_t n : kSizes) {
    const auto in = random_numbers(n, 1000);
    std::vector<uint64_t> expected;
    for (size_t i = 0; i < n; ++i)
      if (in[i] & 1) expected.push_back(i);
    Span<uint64_t> out = executor.allocate<uint64_t>(n);
    out.size = executor.compact(n, IsOdd{to_device(executor, in).data}, out);
    EXPECT_EQ(to_host(executor, out), expected);
  }
}

TEST(CudaExecutor, CopiesAndFills) {
  REQUIRE_DEVICE();
  const auto in = random_numbers(1000, 5000);
  Span<uint32_t> span = to_device(executor, in);
  EXPECT_EQ(executor.fetch(span.data + 77), in[77]);
  std::vector<uint32_t> all(in.size());
  executor.fetch_all(all.data(), span.data, all.size());
  EXPECT_EQ(all, in);
  executor.fill(Span<uint32_t>{span.data, 500}, 0x11);
  const auto host = to_host(executor, span);
  EXPECT_EQ(host[499], 0x11111111u);
  EXPECT_EQ(host[500], in[500]);
}

// Few and many bytes, from any one on, and no others.
TEST(CudaExecutor, FillsTheBytesItIsGiven) {
  REQUIRE_DEVICE();
  const size_t most = 700000;
  Span<unsigned char> bytes = executor.allocate<unsigned char>(most);
  for (size_t first : {size_t(0), size_t(1), size_t(4), size_t(7)})
    for (size_t count : {size_t(0), size_t(1), size_t(3), size_t(4), size_t(1026), size_t(600001)}) {
      executor.fill(bytes, 0x55);
      executor.fill(Span<unsigned char>{bytes.data + first, count}, 0xfe);
      std::vector<unsigned char> expected(most, 0x55);
      std::fill_n(expected.begin() + static_cast<std::ptrdiff_t>(first), count, static_cast<unsigned char>(0xfe));
      ASSERT_EQ(to_host(executor, bytes), expected) << count << " bytes from " << first;
    }
}

TEST(CudaExecutor, RefusedMemoryIsAnErrorAndNothingElse) {
  REQUIRE_DEVICE();
  const auto status_of = [&](size_t bytes) {
    try {
      executor.allocate<char>(bytes);
    } catch (const Error &e) {
      EXPECT_NE(std::string(e.what()), "");
      return e.status();
    }
    return QSES_OK;
  };
  EXPECT_EQ(status_of(size_t(1) << 50), QSES_OUT_OF_MEMORY);
  executor.arena().set_budget(executor.arena().held() + 1000000);
  EXPECT_EQ(status_of(executor.arena().held() + 2000000), QSES_OUT_OF_MEMORY);
  executor.arena().set_budget(0);
  Span<uint64_t> out = executor.allocate<uint64_t>(1000);
  executor.for_each(1000, Square{out.data});
  EXPECT_EQ(executor.fetch(out.data + 999), 999u * 999u);
}

// One thread that takes some milliseconds, so that whoever does not wait for it comes too early.
struct WriteLate {
  uint32_t *out;
  uint32_t value;
  QSES_HOST_DEVICE void operator()(size_t) const {
    uint32_t x = value;
    for (int k = 0; k < 300000; ++k) x = x * 1664525u + 1013904223u;
    *out = x != 0 ? value : 0;
  }
};
struct CopyWord {
  const uint32_t *in;
  uint32_t *out;
  QSES_HOST_DEVICE void operator()(size_t) const { *out = *in; }
};

TEST(CudaExecutor, IsJoinedByItsSecondStream) {
  REQUIRE_DEVICE();
  const Span<uint32_t> words = executor.allocate<uint32_t>(2);
  const auto write_late = [&](uint32_t value) { executor.for_each(1, WriteLate{words.data, value}); };
  const auto expect_copied = [&](uint32_t value) {
    executor.for_each(1, CopyWord{words.data, words.data + 1});
    EXPECT_EQ(executor.fetch(words.data + 1), value);
  };
  const cudaStream_t first = executor.stream();
  for (uint32_t round = 1; round < 4; ++round) {
    executor.fill(words, 0);
    executor.wait();
    {
      SecondStream second(executor);
      second.queue([&] {
        EXPECT_NE(executor.stream(), first);
        write_late(round);
      });
      EXPECT_EQ(executor.stream(), first);
    }
    expect_copied(round);
  }
  // Also when it is left by an exception.
  try {
    SecondStream second(executor);
    second.queue([&] {
      write_late(99);
      throw Cancelled{};
    });
    FAIL();
  } catch (const Cancelled &) {
  }
  EXPECT_EQ(executor.stream(), first);
  expect_copied(99);
}

TEST(CudaExecutor, StageTimes) {
  REQUIRE_DEVICE();
  CudaStageTimer timer(executor);
  timer.begin("nothing");
  EXPECT_TRUE(timer.collect().empty());
  timer.enable(true);
  Span<uint64_t> out = executor.allocate<uint64_t>(1000000);
  for (int run = 0; run < 2; ++run) {
    timer.reset();
    for (const char *name : {"first", "second", "first"}) {
      timer.begin(name);
      executor.for_each(out.size, Square{out.data});
    }
    timer.end();
    const auto times = timer.collect();
    ASSERT_EQ(times.size(), 2u);
    EXPECT_STREQ(times[0].first, "first");
    EXPECT_STREQ(times[1].first, "second");
    EXPECT_GT(times[0].second, 0.0);
    EXPECT_GT(times[1].second, 0.0);
  }
}

// Hears of the launches of an executor that takes the GPU to have a single multiprocessor.
class SmallGpu : public LaunchObserver {
 public:
  SmallGpu() { current = this; }
  ~SmallGpu() override { current = nullptr; }
  unsigned multiprocessors(unsigned) override { return 1; }
  void before(const Launch &launch) override {
    ++launches;
    most_steps = std::max(most_steps, launch.steps);
  }
  void after(const Launch &) override {
    if (stop) *stop = true;
  }
  int launches = 0;
  uint64_t most_steps = 0;
  std::atomic<bool> *stop = nullptr;
};

TEST(CudaLaunches, AreCutBySteps) {
  REQUIRE_DEVICE();
  (void)executor;
  SmallGpu gpu;
  CudaExecutor small(0);
  ASSERT_EQ(small.multiprocessors(), 1u);
  const size_t n = 100003;
  for (const uint64_t steps : {uint64_t(1), uint64_t(5000), kThreadSteps}) {
    Span<uint64_t> out = small.allocate<uint64_t>(n);
    small.fill(out, 0);
    gpu.launches = 0;
    gpu.most_steps = 0;
    small.for_each(n, Square{out.data}, steps);
    const size_t threads = static_cast<size_t>(kLaunchSteps / steps) * 32;
    if (threads <= n)
      EXPECT_GE(static_cast<size_t>(gpu.launches), n / threads) << steps;
    else
      EXPECT_EQ(gpu.launches, 1);
    EXPECT_LE(gpu.most_steps, kLaunchSteps) << steps;
    const auto host = to_host(small, out);
    for (size_t i = 0; i < n; ++i) ASSERT_EQ(host[i], i * i) << steps;
  }
}

TEST(CudaLaunches, OfTeamsAndSumsAreCutToo) {
  REQUIRE_DEVICE();
  const size_t n = 300;
  const auto in = random_numbers(n * 1000, 256);
  std::vector<std::vector<uint32_t>> digits;
  std::vector<double> sums;
  SmallGpu gpu;
  CudaExecutor small(0);
  for (CudaExecutor *e : {&executor, &small}) {
    gpu.launches = 0;
    Span<uint32_t> out = e->allocate<uint32_t>(n * 256);
    e->for_each_brick<Histogram>(n, CountDigits{to_device(*e, in).data, out.data}, 8, kThreadSteps / 16);
    digits.push_back(to_host(*e, out));
    sums.push_back(e->reduce(1000003, Root{}, 60000));
    if (e == &small) EXPECT_GT(gpu.launches, 20);
    EXPECT_LE(gpu.most_steps, kLaunchSteps);
  }
  EXPECT_EQ(digits[0], digits[1]);
  EXPECT_EQ(sums[0], sums[1]);
}

TEST(CudaLaunches, EndWhereTheyAreToldTo) {
  REQUIRE_DEVICE();
  (void)executor;
  SmallGpu gpu;
  CudaExecutor small(0);
  std::atomic<bool> stop{false};
  const CudaExecutor::RunScope scope(small, stop);
  Span<uint64_t> out = small.allocate<uint64_t>(1000);
  gpu.stop = &stop;
  EXPECT_THROW(small.for_each(1000, Square{out.data}, kThreadSteps), Cancelled);
  EXPECT_EQ(gpu.launches, 1);
  gpu.stop = nullptr;
  stop = false;
  small.wait();
}

TEST(CudaDevices, DescriptionNamesWhatIsWrong) {
  int before = 0;
  const bool any = cudaGetDevice(&before) == cudaSuccess;
  const CudaDevice none = describe_cuda_device(1000);
  EXPECT_FALSE(none.available);
  EXPECT_NE(none.reason, "");
  const CudaDevice first = describe_cuda_device(0);
  EXPECT_EQ(first.available, first.reason.empty());
  if (first.available) {
    EXPECT_NE(first.name, "");
    EXPECT_GT(first.total_memory, 0u);
    EXPECT_LE(first.free_memory, first.total_memory);
  }
  int after = 0;
  if (any) {
    ASSERT_EQ(cudaGetDevice(&after), cudaSuccess);
    EXPECT_EQ(after, before);
  }
  EXPECT_EQ(cudaGetLastError(), any ? cudaSuccess : cudaGetLastError());
}

TEST(CudaDevices, FailuresAreNamedAndForgotten) {
  try {
    check_cuda(cudaErrorInvalidValue, "cudaSomething");
    FAIL();
  } catch (const Error &e) {
    EXPECT_EQ(e.status(), QSES_DEVICE_ERROR);
    EXPECT_NE(std::string(e.what()).find("cudaSomething"), std::string::npos);
  }
  try {
    check_cuda(cudaErrorMemoryAllocation, "cudaMalloc");
    FAIL();
  } catch (const Error &e) {
    EXPECT_EQ(e.status(), QSES_OUT_OF_MEMORY);
  }
}

TEST(CudaDevices, PinnedBufferGrowsOnly) {
  REQUIRE_DEVICE();
  (void)executor;
  PinnedBuffer buffer;
  void *first = buffer.reserve(1000);
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(buffer.reserve(10), first);
  EXPECT_GE(buffer.size(), 1000u);
  ASSERT_NE(buffer.reserve(1000000), nullptr);
  EXPECT_GE(buffer.size(), 1000000u);
  try {
    buffer.reserve(size_t(1) << 50);
    FAIL();
  } catch (const Error &e) {
    EXPECT_EQ(e.status(), QSES_OUT_OF_MEMORY);
  }
  EXPECT_EQ(cudaGetLastError(), cudaSuccess);
  EXPECT_NE(buffer.reserve(100), nullptr);
}

}  // namespace
